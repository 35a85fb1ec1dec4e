"""Readings that are set right: axes by gravity, sizes of counts, rates of the plan.

And what that makes of the properties of a log and of the table of the manoeuvres.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.masked_samples import Repairs
from inertial.campaign.records import Manoeuvre
from inertial.signal.axis_permutations import AS_NAMED, Permutation
from inertial.signal.detector import Given, Log
from inertial.signal.gravity_turned import MAX_ARM, Turned, turned
from inertial.signal.misread_axes import determinant
from inertial.signal.plan_detector import Misread
from inertial.signal.rests_and_motions import steady_part
from inertial.signal.scale_factor import (
    FULL_SCALE_FACTORS,
    MAX_RATIO_SPREAD,
    MAX_SCALE_ERROR,
    factors_near,
)
from inertial.tables import AXES
from inertial.text.messages import _
from stages.segment.located import Located
from stages.segment.matching import motion
from stages.segment.recording_explanations import ExplainedRecording
from stages.segment.steps import BY_GRAVITY, Step, axes_step
from stages.segment.windows import Binned

# ---- Axes and signs by which the gyros turn gravity as the accelerometers see it, without a plan.


def axes_by_gravity(binned: Sequence[Binned], level: Array) -> Turned | None:
    """How the gyros turn gravity; `level`: (3,), rad/s, the gyros at rest."""
    stretches = [
        (one.forces, one.read_rates - level, one.bin_seconds) for one in binned if one.bins
    ]
    return turned(stretches, MAX_ARM)


def misread_by_gravity(binned: Sequence[Binned], seen: Turned) -> list[Misread]:
    """What explains that the gyros turn gravity otherwise than it turns; each does it alone.

    If the gyros' triad is left-handed beside the accelerometers', only they explain it, for
    accelerometers that read A f turn by det(A)·A ω, which is right-handed. Else both may: of the
    accelerometers those with the fewest signs, for all of them reversed turn alike.
    """
    if seen.axes is None or seen.axes == AS_NAMED:
        return []
    names = [m.name for one in binned for m in one.window.manoeuvres]
    explained = [("gyro", seen.axes)]
    if determinant(seen.axes) > 0:
        explained.append(("accel", _of_accelerometers(seen.axes)))
    return [
        Misread(sensor, axes, "", names, _step(sensor, axes).id, spans=seen.spans)
        for sensor, axes in explained
    ]


def step_of(misread: Misread) -> Step:
    """The repair that sets it right."""
    return _step(misread.sensor, misread.axes)


def _step(sensor: str, axes: Permutation) -> Step:
    step = axes_step(sensor, axes)
    return Step(f"{step.id}/{BY_GRAVITY}", step.repair, sensor, axes)


def _of_accelerometers(gyros: Permutation) -> Permutation:
    """What the accelerometers' readings need in place of `gyros`, right-handed."""
    right = gyros.inverse
    left = Permutation(right.sources, tuple(-sign for sign in right.signs))
    return min((right, left), key=lambda axes: axes.signs.count(-1))


# ---- Sizes of counts that are wrong by a known factor.

# Rests of one attitude do not tell a bias from a full scale that is another: two at 60° do.
MAX_COSINE = 0.5
MAX_ROUNDING = 1e-6  # relative: factors that are one, but for their last digits
FULL_SCALES = (*FULL_SCALE_FACTORS, *(1 / factor for factor in FULL_SCALE_FACTORS))


@dataclass(frozen=True)
class Multiple:
    """How many times too large a sensor reads in a log; of a turn in angle and in rate.

    ratio : its rate or force over what it should be, 1
    angle : the same of its angle, NaN where it is not known
    direction : (3,), of the force at rest, unit vector; None of a turn
    """

    name: str
    log: str
    ratio: float
    angle: float = np.nan
    direction: Array | None = None


@dataclass(frozen=True)
class Scale:
    """A sensor that reads `factor` times too large in a log, or in all where that is empty.

    others : factors that explain the same ratio to the accuracy of the sensor; why: in words
    """

    sensor: str
    log: str
    factor: float
    others: Sequence[float]
    why: str
    seen: Sequence[Multiple]

    @property
    def fitting(self) -> tuple[int, int, int]:
        """How many observations fit as recorded, with the factor undone, and how many are seen."""
        most = MAX_SCALE_ERROR[self.sensor]
        ratios = np.array([one.ratio for one in self.seen])
        as_read, undone = (np.abs(ratios / by - 1) <= most for by in (1.0, self.factor))
        return int(as_read.sum()), int(undone.sum()), len(ratios)


def scales_of(
    explained: ExplainedRecording,
    level: Array,
    given: Given,
    counts: Mapping[str, Mapping[str, float]],
) -> Iterator[Scale]:
    """The sensors whose readings are a known multiple of what they should be.

    A large bias or scale error is none: it is no known factor, or not the same in all attitudes.

    Parameters
    ----------
    level : (3,), rad/s, the gyros at rest
    counts : by sensor and log, what a count is by the campaign, m/s and rad
    """
    by_sensor = {
        "accel": list(_forces(explained.located, given.gravity)),
        "gyro": list(_turns(explained.located, level)),
    }
    for sensor, seen in by_sensor.items():
        logs = list(dict.fromkeys(one.log for one in seen))
        whole = _scale(sensor, "", seen, given, counts[sensor])
        if whole is not None:
            yield whole
        elif len(logs) > 1:
            for log in logs:
                own = [one for one in seen if one.log == log]
                alone = _scale(sensor, log, own, given, counts[sensor])
                if alone is not None:
                    yield alone


def _scale(
    sensor: str, log: str, seen: Sequence[Multiple], given: Given, counts: Mapping[str, float]
) -> Scale | None:
    """The known factor by which all that is seen is too large; None if there is none."""
    most = MAX_SCALE_ERROR[sensor]
    ratios = np.array([one.ratio for one in seen])
    ratios = ratios[np.isfinite(ratios) & (ratios > 0)]
    if not len(ratios):
        return None
    ratio = float(np.median(ratios))
    if abs(np.log(ratio)) <= np.log1p(most) or np.abs(ratios / ratio - 1).max() > most:
        return None
    angles = np.array([one.angle for one in seen])
    # A turn of which a part is missing may be short, but most of them are whole.
    angle = float(np.nanmedian(angles)) if np.isfinite(angles).any() else ratio
    if abs(angle / ratio - 1) > MAX_RATIO_SPREAD:
        return None
    known = [counts[one.log] for one in seen if np.isfinite(counts.get(one.log, np.nan))]
    count = float(np.median(known)) if known else np.nan
    near = factors_near(ratio, sensor, given, count)
    if not near:
        return None
    factor = next(iter(near))
    of_full_scale = any(abs(factor / scale - 1) < MAX_ROUNDING for scale in FULL_SCALES)
    if of_full_scale and not _shows_full_scale(sensor, seen):
        return None
    others = [other for other in near if abs(other / factor - 1) > MAX_ROUNDING]
    # The unit itself is exact, where the count of an instrument is the same to its last digits.
    return Scale(sensor, log, factor, others, _(", or ").join(near.values()), seen)


def _shows_full_scale(sensor: str, seen: Sequence[Multiple]) -> bool:
    """Whether a bias, or one turn that is planned otherwise than it was done, is excluded."""
    if sensor == "gyro":
        return len(seen) > 1
    directions = np.array([one.direction for one in seen])
    return bool((directions @ directions.T).min() < MAX_COSINE)


def _forces(windows: Sequence[Located], gravity: float) -> Iterator[Multiple]:
    """The specific force at every rest, over gravity."""
    for located in windows:
        for observation in located.observed:
            length = float(np.linalg.norm(observation.force))
            if not observation.moves and np.isfinite(length) and length > 0:
                log = located.binned.window.log
                yield Multiple("", log, length / gravity, direction=observation.force / length)


def _turns(windows: Sequence[Located], level: Array) -> Iterator[Multiple]:
    """Every turn that was found, over its plan; where no rate is planned, its angle.

    Where its gyro is cut off, its rate and angle are those of the range, not of the turn.
    """
    for located in windows:
        for m in located.plan:
            place = located.place(m)
            if m.do != "turn" or place is None or _cut_off(located, place, m):
                continue
            angle = np.nan
            if m.angle and m.recorded == "whole":
                turned = np.nan_to_num(located.observed[place].turned)
                angle = abs(float(turned @ m.axis) / m.angle)
            rate = _rate(located, place, m, level) if m.rate else np.nan
            rate = rate if np.isfinite(rate) else angle
            if np.isfinite(rate):
                yield Multiple(m.name, located.binned.window.log, rate, angle)


def _cut_off(located: Located, place: int, m: Manoeuvre) -> bool:
    """Whether a gyro about the axis of a turn is cut off in it."""
    first, after = motion(located.binned, located.stretches, place)
    return located.binned.cuts_off(m.axis, first, after)


def _rate(located: Located, place: int, m: Manoeuvre, level: Array) -> float:
    """The rate of the steady part of a turn over the planned one; NaN where there is none."""
    assert m.rate
    first, after = motion(located.binned, located.stretches, place)
    about = located.binned.about(m.axis, level)[first:after]
    about = about[np.isfinite(about)]
    if not len(about):
        return np.nan
    start, stop = steady_part(about)
    return abs(float(np.median(about[start:stop])) / m.rate) if stop > start else np.nan


# ---- Rates of the plan.


@dataclass(frozen=True)
class Restated:
    """Turns through their planned angles whose rates are `ratio` times the planned ones."""

    ratio: float
    names: Sequence[str]


def rates_of(explained: ExplainedRecording, level: Array, tolerance: float) -> Restated | None:
    """The turns whose rate alone is misstated, if it is so by one ratio."""
    off = [
        one
        for one in _turns(explained.located, level)
        if abs(one.angle - 1) <= tolerance < abs(one.ratio - 1)
    ]
    if not off:
        return None
    ratios = np.array([one.ratio for one in off])
    ratio = float(np.median(ratios))
    if len(off) < 2 or np.abs(ratios / ratio - 1).max() > MAX_RATIO_SPREAD:
        return None
    return Restated(ratio, [one.name for one in off])


# ---- The plan as a table, and the properties of a log, after what was wrong is set right.


def plan_as_taken(stated: pd.DataFrame, plan: Sequence[Manoeuvre]) -> pd.DataFrame:
    """The table of the manoeuvres with what the repairs have changed."""
    table = stated.set_index("manoeuvre").loc[[m.name for m in plan]].reset_index()
    places = ("log", "from_s", "to_s", "from_row", "to_row", "label")
    for name in (*places, "angle", "rate", "rate_sigma", "turned_on"):
        values = pd.Series([getattr(m, name) for m in plan], dtype=object)
        table[name] = values.where(values.notna(), None)
    for name in ("up", "mark", "about", "tumbled"):
        vectors = [getattr(m, name) for m in plan]
        for i, axis in enumerate(AXES):
            table[f"{name}_{axis}"] = [None if vector is None else vector[i] for vector in vectors]
    return table[list(stated.columns)]


def log_as_read(log: Log, repairs: Repairs) -> Log:
    """A log whose channels are set right: their steps, noise and limits go with them."""
    source, factor = repairs.channels(log.name)
    size = np.abs(factor)
    ends = np.sort([factor * log.least[source], factor * log.most[source]], axis=0)
    return replace(
        log,
        quantum=size * log.quantum[source],
        noise=size * log.noise[source],
        equal=log.equal[source],
        least=ends[0],
        most=ends[1],
        limit=size * log.limit[source],
        count=size * log.count[source],
    )
