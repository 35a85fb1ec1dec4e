"""The manoeuvre that alone carries an effect: an outlier, the only one that shows it, or none."""

import numpy as np
import pytest

from inertial.estimation.least_squares import Estimate, System
from stages.extension.cross_validation import SensorEvidence, carrier

NAMES = ("a", "b", "c", "d", "e", "f")
READINGS = 10  # of each manoeuvre, with a noise of 1
COLUMNS = ("first", "second")


class Readings:
    """Readings of six manoeuvres: a bias, and two effects."""

    def __init__(self, columns: np.ndarray, observed: np.ndarray, size: int = 1) -> None:
        self.columns, self.observed = columns, observed
        self.folds = [NAMES[i : i + size] for i in range(0, len(NAMES), size)]
        self.left_out: list[tuple[str, ...]] = []

    @property
    def whole(self) -> dict[str, SensorEvidence]:
        return {"gyro": self.evidence(())}

    def without(self, held_out: tuple[str, ...], sensor: str) -> SensorEvidence:
        self.left_out.append(held_out)
        return self.evidence(held_out)

    def evidence(self, held_out: tuple[str, ...]) -> SensorEvidence:
        there = np.repeat([name not in held_out for name in NAMES], READINGS)
        count, effects = int(there.sum()), len(COLUMNS)
        names = [("parameter", "bias"), *(("effect", name) for name in COLUMNS)]
        system = System(
            np.column_stack([np.ones(count), self.columns[there]]),
            self.observed[there],
            np.ones(count),
            np.zeros(1 + effects),
            np.full(1 + effects, 1e4),
            1,
            tuple(names),
        )
        estimate = Estimate(np.zeros(1), np.eye(1), np.ones(1, bool), 0.0, 0, 0.0, 0)
        return SensorEvidence(estimate, system.effect_information(), 0.0)


def columns() -> np.ndarray:
    """The first effect alternates from reading to reading, the second acts in c alone."""
    only_in_c = np.repeat([float(name == "c") for name in NAMES], READINGS)
    return np.column_stack([np.tile([1.0, -1.0], 30), only_in_c])


def carried(observed: np.ndarray, effect: str, size: int = 1) -> tuple[str | None, Readings]:
    readings = Readings(columns(), observed, size)
    return carrier(readings, "gyro", COLUMNS, [effect]), readings


@pytest.mark.parametrize("size", [1, 2, 3])
def test_an_effect_of_all_manoeuvres_is_carried_by_none(size):
    # 0.7 in each of 60 readings is a chi-squared of 29, and 24 without ten of them.
    assert carried(0.7 * columns()[:, 0], "first", size)[0] is None


@pytest.mark.parametrize("size", [1, 2, 3])
def test_one_that_contradicts_the_others_carries_it(size):
    """The others could show the effect, and do not; single ones are left out where needed."""
    inside = np.repeat([name == "e" for name in NAMES], READINGS)
    name, readings = carried(3.0 * columns()[:, 0] * inside, "first", size)
    assert name == "e"
    singles = {one for one in readings.left_out if len(one) == 1}
    assert len(singles) == (6 if size == 1 else size)


def test_the_only_one_that_shows_it_carries_it_beside_an_effect_of_all():
    observed = columns() @ [5.0, 5.0]
    assert carried(observed, "second")[0] == "c"
    assert carried(observed, "first")[0] is None


def test_what_is_not_detected_at_all_nobody_carries():
    # 0.4 in each of 60 readings: 9.6, less than 9 and one degree of freedom.
    assert carried(0.4 * columns()[:, 0], "first")[0] is None


def test_two_that_are_both_needed_are_named_by_the_one_that_matters_more():
    """Detected only with both: 0.16 · 60 = 9.6 of the pair alone is not; c has the larger part."""
    sizes = {"b": 1.0, "c": 1.4}
    strength = np.repeat([sizes.get(name, 0.0) for name in NAMES], READINGS)
    parts = columns()
    parts[:, 0] *= np.repeat([float(name in sizes) for name in NAMES], READINGS)
    readings = Readings(parts, parts[:, 0] * strength * 0.7)
    # 0.7² (10 + 19.6) = 14.5 of a mean over both; 4.9 and 9.6 of one alone.
    assert carrier(readings, "gyro", COLUMNS, ["first"]) == "c"


def test_a_campaign_of_one_manoeuvre_carries_what_it_shows():
    class Alone(Readings):
        def without(self, held_out: tuple[str, ...], sensor: str) -> None:
            return None

    assert carrier(Alone(columns(), columns()[:, 0], 6), "gyro", COLUMNS, ["first"]) == "a"
