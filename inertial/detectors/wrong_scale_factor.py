"""Readings that are in another unit, or in the counts of another instrument."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Detector, Event, Given, Log, Words
from inertial.text.numbers import significant
from inertial.text.units import DEGREE, STANDARD_GRAVITY

# Of gravity. A consumer accelerometer may be off by 80 mg and 3 % (MPU-6050, PS-MPU-6000A), an old
# one by 110 mg; the smallest wrong factor is 2.
TOLERANCE = {"accel": 0.15, "gyro": 0.05}  # of a gyro, whose bias is not in the rate of a turn: 3 %
ALIKE = 0.01  # factors that differ by less explain the same
COUNTS = 50.0  # times what it should be: what no sensor reads in any unit
SCALES = (2, 4, 8, 16)  # steps of full scale
UNITS = {
    "accel": {
        STANDARD_GRAVITY: "the values are in m/s² but are read as g",
        1 / STANDARD_GRAVITY: "the values are in g but are read as m/s²",
    },
    "gyro": {
        1 / DEGREE: "the values are in degrees but are read as radians",
        DEGREE: "the values are in radians but are read as degrees",
    },
}


class WrongScaleFactor(Detector):
    """The specific force at rest is not gravity, by more than any bias explains."""

    name = "wrong_scale_factor"
    cause = "another unit, another full scale, or the counts of another instrument"
    source = "design study 41e; S0 names the iMAR-FSAS, but its gyro counts are 57.3 times as large"
    costs = "every parameter is wrong by this factor"
    unit = "1"
    sensor = "accel"
    severity = 3

    def concludes(self, log: Log) -> Iterator[Event]:
        force = force_at_rest(log)
        ratio = force / log.given.gravity
        if np.isfinite(ratio) and abs(ratio - 1) > TOLERANCE["accel"]:
            # A count of a receiver is an increment, which its interval has made a rate.
            increments = log.recorded_on is not None
            count = float(np.nanmedian(log.count[:3])) * log.step if increments else np.nan
            why = explanations(ratio, "accel", log.given, count)
            yield log.event(ratio, facts=(force, why))

    def tells(self, event: Event, name: str) -> Words:
        force, why = event.facts
        return Words(
            f"{name}: at rest the specific force is {significant(force)} m/s²,"
            f" {significant(event.size)} times gravity: {why}.",
            f"Bias, scale factors and cross-axis terms of the accelerometers are"
            f" {significant(event.size)} times what they should be.",
            "Nothing is changed. Correct the unit, counts_per_unit or count size, or the name of"
            " the instrument in the campaign.",
        )


def explanations(ratio: float, sensor: str, given: Given, count: float = np.nan) -> str:
    """What explains that a sensor reads `ratio` times what it should; in words, never empty.

    Parameters
    ----------
    sensor : accel or gyro
    count : m/s or rad, what one count is by the campaign; where it is not given, the counts of
        any two listed instruments are compared
    """
    explained = dict(_known(sensor, given, count, ratio))
    off = {factor: abs(np.log(abs(ratio) / factor)) for factor in explained}
    nearest = min(off, key=lambda factor: off[factor], default=1.0)
    if explained and off[nearest] < np.log1p(TOLERANCE[sensor]):
        near = [factor for factor in off if abs(factor / nearest - 1) < ALIKE]
        return ", or ".join(explained[factor] for factor in sorted(near, key=lambda f: off[f]))
    if abs(ratio) > COUNTS:
        return "the values are counts, and counts_per_unit is missing"
    if sensor == "accel":
        return "no known unit explains it; the bias may be large, or the IMU was not at rest"
    return "no known unit, full scale or instrument explains it"


def _known(sensor: str, given: Given, count: float, ratio: float) -> Iterator[tuple[float, str]]:
    """Factors that are known to happen, and what makes each."""
    yield from UNITS[sensor].items()
    for scale in SCALES:
        for factor, what in ((float(scale), "small"), (1 / scale, "large")):
            said = f"counts_per_unit is {scale} times too {what}, as of another full scale"
            if sensor == "gyro" and scale == SCALES[0]:
                said += f", or the sample rate is off by {scale}"
            yield factor, said
    yield from _instruments(sensor, given, count, ratio)


def _instruments(
    sensor: str, given: Given, count: float, ratio: float
) -> Iterator[tuple[float, str]]:
    """The factors between the count that is taken and those of the listed instruments."""
    size = {name: sizes[sensor == "gyro"] for name, sizes in given.count_sizes.items()}
    taken = [count] if np.isfinite(count) else sorted(set(size.values()))
    for one in taken:
        others: dict[float, list[str]] = {}
        for name, other in size.items():
            if abs(one / other - 1) > ALIKE:
                others.setdefault(one / other, []).append(name)
        for factor, names in others.items():
            # A hair beside the factor itself, which may be that of a unit as well.
            yield factor * (1 + 1e-12), f"the counts are those of {' or '.join(names)}"


def force_at_rest(log: Log) -> float:
    """The median of |f| where a log is quiet, m/s²; NaN where not all axes are recorded."""
    windows = log.windows
    force = np.linalg.norm(windows.mean[:, :3], axis=1)
    there = np.isfinite(force)
    if not there.any():
        return np.nan
    restless = np.nansum(windows.variance[there], axis=1)
    quiet = restless <= 4 * np.quantile(restless, 0.25)
    return float(np.median(force[there][quiet]))
