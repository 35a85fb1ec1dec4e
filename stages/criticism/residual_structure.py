"""Whether the residuals beside the named effects have a structure."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.equations import Campaign
from inertial.model_selection.cause import UNKNOWN_STRUCTURE
from inertial.model_selection.structure_tests import TESTS, Answer, Structure, Where, structures
from inertial.physics.effect import Array, Effect, Parameter, Reading
from inertial.physics.motion import Motion
from inertial.text.cause_names import in_words
from inertial.text.numbers import p_is, significant

# ---- Whether what the named effects leave of the readings still has a structure.
#
# A function of the motion that a reading may contain is asked about like an effect: how much of
# it do the equations leave, all else fitted? So tilts, gravity and random walks count as they do
# there.

Integers = NDArray[np.int64]

WIDE = 1e4  # sigma of a named effect's parameters beforehand, in their typical sizes
SOLVED = {"gyro": "gyro", "accel": "accelerometer"}  # of a sensor in the joint result
AXES = "xyz"
BINS = 60  # of a picture
SEEN = 1e-6  # of the information of a function on its own: what is less is taken as fitted


class Functions(Effect):
    """Functions of one motion, (n, k), that the reading of one axis may contain; no effect."""

    cause = "unknown"
    source = "score test (Rao)"
    sizes = MappingProxyType({"usual": 1.0})

    def __init__(self, sensor: str, axis: int, name: str, functions: Array) -> None:
        self.sensor, self.axis, self.functions = sensor, axis, functions
        self.name = name  # type: ignore[misc]
        count = functions.shape[1]
        self.parameters = tuple(  # type: ignore[misc]
            Parameter(str(i), "", 1.0, "") for i in range(count)
        )

    def signature(self, motion: Motion) -> Reading:
        traces = {name: np.zeros((len(motion.rate), 3, len(self.parameters))) for name in SOLVED}
        traces[self.sensor][:, self.axis] = self.functions
        return Reading(**traces)


@dataclass(frozen=True)
class Tested:
    """The six tests of what one mount leaves beside the named effects."""

    campaign: Campaign
    named: Sequence[Effect]
    tests: Sequence[Structure]

    @property
    def firing(self) -> list[Structure]:
        """The tests that found a structure, the clearest first."""
        return sorted((test for test in self.tests if test.fires), key=lambda test: test.p_value)

    def of(self, sensor: str) -> list[Structure]:
        """Those in the readings of a sensor, `gyro` or `accel`."""
        return [test for test in self.firing if test.channel.startswith(sensor)]


@dataclass(frozen=True)
class Point:
    """What is left of the readings of an axis about one value of what they may be a function of.

    `x`: s, rad, rad/s, K, or rad from upright; `left`, `sigma`, and `structure`, what the functions
    of the test would leave there: rad/s or m/s².
    """

    x: float
    left: float
    sigma: float
    structure: float


def tested(campaign: Campaign, named: Sequence[Effect], noise_degrees: float) -> Tested:
    """The tests of what is left beside the named effects."""
    answers = [
        answer
        for sensor in SOLVED
        for axis in range(3)
        for answer in _answers(campaign, named, sensor, axis, noise_degrees)
    ]
    return Tested(campaign, named, structures(answers))


def points(told: Tested, test: Structure) -> Iterator[Point]:
    """What is to be seen of a structure: each bin of readings by itself, all else as fitted."""
    sensor, axis = test.channel.split()
    own = told.campaign.stretches(sensor)
    where = where_of(told.campaign.motion, own, sensor, AXES.index(axis))
    across = _across(where, test.kind, AXES.index(axis))
    bins = [group for group in _bins(across) if len(group)]
    chosen, values = test.values
    assert test.answer is not None  # it fires
    shown = np.zeros((len(across), 1 + len(bins)))
    shown[:, 0] = test.answer.question.functions[:, chosen] @ values
    for column, group in enumerate(bins, 1):
        shown[group, column] = 1.0
    rest, columns, _ = _left(told.campaign, told.named, sensor, AXES.index(axis), [shown])
    for column, group in enumerate(bins, 1):
        mine = columns[:, column]
        known = float(mine @ mine)
        if known > 0:
            yield Point(
                float(across[group].mean()),
                float(mine @ rest) / known,
                float(known**-0.5),
                float(mine @ columns[:, 0]) / known,
            )


def _across(where: Where, kind: str, axis: int) -> Array:
    """What a picture of the structure goes along, (n,)."""
    if kind in ("time", "change"):
        return where.time
    if kind == "attitude":
        return np.asarray(np.arccos(np.clip(where.up[:, axis], -1.0, 1.0)))
    return np.asarray(getattr(where, kind))


def _bins(across: Array) -> list[Integers]:
    """The readings in bins of equal width, those of no known place in none."""
    known = np.isfinite(across)
    low, high = float(np.min(across[known])), float(np.max(across[known]))
    width = (high - low) / BINS or 1.0
    place = np.where(known, np.minimum((across - low) / width, BINS - 1), -1).astype(np.int64)
    return [np.flatnonzero(place == number) for number in range(BINS)]


def _answers(
    campaign: Campaign, named: Sequence[Effect], sensor: str, axis: int, noise_degrees: float
) -> Iterator[Answer]:
    if getattr(campaign.solution, SOLVED[sensor]) is None:
        return
    where = where_of(campaign.motion, campaign.stretches(sensor), sensor, axis)
    questions = [(kind, one) for kind, test in TESTS.items() for one in test(where)]
    asked = [question.functions for _, question in questions]
    rest, columns, degrees = _left(campaign, named, sensor, axis, asked)
    first = 0
    for kind, question in questions:
        some = slice(first, first + question.functions.shape[1])
        left = columns[:, some]
        yield Answer(
            kind,
            f"{sensor} {AXES[axis]}",
            question,
            left.T @ left,
            left.T @ rest,
            float(rest @ rest),
            degrees,
            noise_degrees,
        )
        first = some.stop


def _left(
    campaign: Campaign,
    named: Sequence[Effect],
    sensor: str,
    axis: int,
    asked: Sequence[Array],
) -> tuple[Array, Array, int]:
    """The residuals, (m,), and what all that is fitted leaves of functions, (m, k); the degrees.

    `asked`: of the stretches of the sensor.
    """
    whole = np.zeros((len(campaign.motion.rate), sum(each.shape[1] for each in asked)))
    whole[campaign.stretches(sensor)] = np.hstack(list(asked))
    system = campaign.system(sensor, [*named, Functions(sensor, axis, "asked", whole)], WIDE)
    assert system is not None  # else nothing is asked
    rest, columns, raw = system.projected(sum(len(effect.parameters) for effect in named))
    fitted = np.sum(columns**2, axis=0) < SEEN * raw
    return rest, np.where(fitted, 0.0, columns), system.rows - system.parameters


def where_of(motion: Motion, some: slice, sensor: str, axis: int) -> Where:
    """What the readings of one axis may be functions of, in some stretches of the motion."""
    angle = np.where(motion.rate != 0, motion.angle, np.nan)
    rate = motion.omega[:, axis] if sensor == "gyro" else motion.rate
    each = (motion.time, angle, rate, motion.up, motion.temperature)
    return Where(*(values[some] for values in each))


# ---- The rows that criticism writes of structures that are left: tests, pictures and findings.

Row = dict[str, Any]

CAUSE = "unknown_structure"
SENSOR_WORDS = {"gyro": "gyros", "accel": "accelerometers"}
UNITS = {"gyro": "rad/s", "accel": "m/s²"}
ACROSS = {"time": "s", "change": "s", "angle": "rad", "rate": "rad/s", "attitude": "rad"}


def test_rows(told: Tested, method: str) -> Iterator[Row]:
    """The six tests."""
    for test in told.tests:
        yield {
            "method": method,
            "kind": test.kind,
            "channel": test.channel,
            "place": test.where if np.isfinite(test.where) else None,
            "statistic": test.statistic,
            "degrees": test.degrees,
            "p_value": test.p_value,
            "fires": test.fires,
        }


def point_rows(told: Tested, method: str) -> Iterator[Row]:
    """What there is to be seen of each structure that was found."""
    for test in told.firing:
        for point in points(told, test):
            yield {
                "method": method,
                "kind": test.kind,
                "channel": test.channel,
                "x": point.x,
                "x_unit": ACROSS.get(test.kind, "K"),
                "left": point.left,
                "sigma": point.sigma,
                "structure": point.structure,
                "unit": UNITS[test.channel.split()[0]],
            }


def findings(told: Tested, named: Mapping[str, Sequence[str]], suffix: str) -> Iterator[Row]:
    """A finding for each sensor that has a structure.

    `named`: of each sensor the effects with which the data are no more than consistent.
    """
    for sensor, words in SENSOR_WORDS.items():
        found = told.of(sensor)
        if not found:
            continue
        best = found[0]
        consistent = [in_words(name) for name in named.get(sensor, ())]
        said = [f"What the model leaves of the {words} is not noise: {_where(best)}."]
        if others := [_about(test) for test in found[1:]]:
            said.append(f"It shows in {' and in '.join(others)} too.")
        if consistent:
            said.append(f"The data are no more than consistent with {' and '.join(consistent)}.")
        yield {
            "id": f"criticism/{CAUSE}/{sensor}{suffix}",
            "cause": CAUSE,
            "sensor": sensor,
            "count": len(found),
            "size": best.statistic**0.5,
            "unit": "sigma",
            "p_value": best.p_value,
            "severity": 2,
            "sentence": " ".join(said),
            "consequence": "The joint result stands as it is: no effect by name is added to it for"
            " this sensor, and its sigmas do not know of what is left.",
            "action": "Look at the picture of what is left; record the manoeuvres concerned again.",
            "verdict": UNKNOWN_STRUCTURE,
            "members": ", ".join(named.get(sensor, ())),
            "statistic": best.statistic,
            "degrees": best.degrees,
            "snr": float(np.sqrt(max(best.statistic - best.degrees, 0.0))),
        }


def _where(test: Structure) -> str:
    """The clearest structure, for a person."""
    axis = test.channel.split()[1]
    place = {
        "time": f"about {axis} it oscillates in time, every {significant(1 / test.where)} s"
        if test.where > 0
        else f"about {axis} it drifts smoothly with time",
        "angle": f"about {axis} it goes with the angle of the table, {test.where:g} times in a turn"
        if test.where > 0
        else f"about {axis} it goes with the angle of the table",
        "rate": f"on {axis} it goes with the rate of the turns",
        "attitude": f"on {axis} it goes with the attitude",
        "temperature": f"on {axis} it goes with the temperature",
        "change": f"on {axis} it changes at {test.where:.0f} s",
    }[test.kind]
    return f"{place} ({p_is(test.p_value)})"


def _about(test: Structure) -> str:
    return f"{'a change in time' if test.kind == 'change' else test.kind} ({test.channel})"
