"""Typical sizes of effects, by the grade of a sensor or the quality of a table."""

from collections.abc import Mapping

FOG, TACTICAL, MTI, CONSUMER = "fog", "tactical", "mti", "consumer"
GOOD, POOR = "good table", "poor table"
USUAL = "usual"


def by_grade(
    unit: float, fog: float, tactical: float, mti: float, consumer: float
) -> Mapping[str, float]:
    """Sizes by the grade of the sensor; `unit`: of the numbers, in SI.

    fog: fibre-optic gyros and their accelerometers; tactical: MEMS of the STIM300
    class; mti: of the MTi-100 class; consumer: as in smartphones.
    """
    numbers = zip((FOG, TACTICAL, MTI, CONSUMER), (fog, tactical, mti, consumer), strict=True)
    return {grade: number * unit for grade, number in numbers}


def of_tables(unit: float, good: float, poor: float) -> Mapping[str, float]:
    """Sizes of a good and of a poor table of a laboratory; `unit`: of the numbers, in SI."""
    return {GOOD: good * unit, POOR: poor * unit}


def usually(size: float) -> Mapping[str, float]:
    """The typical size, in SI."""
    return {USUAL: size}
