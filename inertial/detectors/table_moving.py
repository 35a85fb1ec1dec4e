"""A table that moves while it should rest, and what gyros still read after a turn."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.special import stdtr

from inertial.arrays import Array
from inertial.sensors import COLUMNS
from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.signal.scatter import MAD_TO_SIGMA
from inertial.signal.static_tilt import (
    CAMPAIGN_RESTS,
    FALSE_ALARM_LEVEL,
    KNOCKED,
    UNCONFIRMED,
    Agreement,
    Jump,
    Resting,
    jumps,
    quiet_force,
    shaken,
)
from inertial.signal.steps import MAX_SIDE_S
from inertial.text.messages import _
from inertial.text.numbers import fixed, significant
from inertial.text.units import ARC_SECOND

BLOCK_S = 1.0  # s of the means in which a creep is sought
MAX_BLOCKS = 64  # at most; a longer rest has longer ones
MIN_BLOCKS = 8  # blocks in which a creep can be distinguished from noise
# What an accelerometer's own bias may do within a rest and resemble a tilt. 30″ are 0.15 mg, more
# than the in-run stability of a tactical unit (0.05 to 0.1 mg). A noisier one is less stable: 15
# times what its means over a second scatter by is 44″ of 20 µg/√Hz, 440″ of 200 µg/√Hz.
MIN_TILT = 30 * ARC_SECOND
MIN_TILT_SIGMA = 15.0
MIN_DRIFT_RATIO = (
    5.0  # times the drift of the upright accelerometer: then the level ones did not just drift
)
# Times what the noise of the readings makes means scatter by: there is more
MIN_COLOURED_RATIO = 1.5
MEDIAN_EFFICIENCY = 0.37  # of the blocks count for the median by which their scatter is had
MAX_DEGREES = 1000.0  # degrees of freedom of a scatter that is well known
MAX_STILL_SIGMA = 3.0  # sigmas within which a block stands as another one does
MAX_STILL_SHARE = 0.02  # of the whole motion, likewise
MAX_SUDDEN_S = 4.0  # s, blocks of a second at both ends included: what is no creep
MIN_HEADING_RATIO = (
    5.0  # times the drift of the gyros about the vertical, for them to confirm a tilt
)


@dataclass(frozen=True)
class Motion:
    """A motion of the table within a rest: places [first, after), and by how much, rad.

    kind: knock, tilt or creep; off: rad, by which the mean attitude of the rest differs from that
    before the motion; agreement: how much of it the gyros turn.
    """

    first: int
    after: int
    kind: str
    size: float
    off: float
    agreement: Agreement
    p_value: float | None = None


@dataclass(frozen=True)
class Moved:
    """A motion, with the uncertainty of a set position, rad, and gravity, m/s².

    attitude_set: whether the plan states the attitude of the rest; gyros: whether any is recorded.
    """

    motion: Motion
    position: float
    gravity: float
    attitude_set: bool = True
    gyros: bool = True


class TableMoving(Detector):
    """The direction of gravity changes in the case during a rest, or the case is knocked.

    A tilt that the gyros show as well is one, however small, where it is clear of the noise and
    larger than the position's own uncertainty. One that is too slow for the gyros must be larger
    than what an accelerometer's bias does by itself, and larger than what the upright
    accelerometer shows. About the vertical nothing is seen.

    Cause: the table creeps, a brake slips, or somebody touches it. The attitude of the rest is
    wrong, hence biases and cross-axis terms.
    """

    name = "table_moving"
    source = "design study, 2b; S1: at rest an accelerometer reads gravity alone"
    unit = "″"
    severity = 2
    alike = "event"

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        resting, own = jumps(piece, log)
        if not np.isfinite(log.interval):
            return
        position = log.given.position_sigma
        motions = list(_knocks(resting))
        if resting.recorded("accel"):
            motions += _sudden(resting, [jump for jump in own if jump.moved], position)
            motions += _creep(resting, own, position)
        for motion in _joined(motions, round(BLOCK_S / log.interval)):
            stated, gyros = log.given.attitude_set, resting.recorded("gyro")
            moved = Moved(motion, position, log.given.gravity, stated, gyros)
            yield piece.event(
                motion.first,
                motion.after,
                motion.size / ARC_SECOND,
                p_value=motion.p_value,
                facts=moved,
                severity=1 if motion.kind == "knock" or _harmless(moved) else None,
            )

    def describe(self, event: Event, name: str) -> Description:
        moved: Moved = event.facts
        motion = moved.motion
        size = f"{significant(event.size, 3)}″"
        span = _(
            "between {from_s} s and {to_s} s",
            from_s=fixed(event.from_s, 2),
            to_s=fixed(event.to_s, 2),
        )
        if motion.kind == "knock":
            return Description(
                _(
                    "{name}: the IMU is knocked {span}; it swings by {size} and stands again.",
                    name=name,
                    span=span,
                    size=size,
                ),
                _("The mean of this rest hardly changes; its noise does."),
                _(
                    "The rest is used as it is. Touch neither it nor what it stands on while it "
                    "records."
                ),
            )
        if motion.agreement.knocked:
            confirmation = _("and the gyros read a spike at that place, which is masked: a knock")
        elif motion.agreement.conclusive:
            share = motion.agreement.share
            confirmation = _("the gyros turn along ({share:.0%} of it)", share=share)
        else:
            confirmation = _(
                "too slowly for the gyros to confirm, and by more than the biases of the "
                "accelerometers do by themselves"
            )
        kind = _("tilts") if motion.kind == "tilt" else _("creeps")
        return Description(
            _(
                "{name}: {what} {kind} by {size} {span}, while it should rest: the direction "
                "of gravity turns in the case, {confirmation}.",
                name=name,
                what=_("the table, or the IMU on it,") if moved.attitude_set else _("the IMU"),
                kind=kind,
                size=size,
                span=span,
                confirmation=confirmation,
            ),
            _cost(moved),
            _("The rest is used as it is. Record it again, on what does not give way."),
        )


def _harmless(moved: Moved) -> bool:
    """Whether nothing depends on the attitude: none is stated, and no gyro carries it."""
    return not moved.attitude_set and not moved.gyros


def _cost(moved: Moved) -> str:
    """What the motion does to the result."""
    angle = moved.motion.off
    off = significant(angle / ARC_SECOND, 3)
    if moved.attitude_set:
        times = _(
            ", {significant} times the stated uncertainty of a",
            significant=significant(angle / moved.position, 2) if moved.position > 0 else "",
        )
        times = times + _(" position") if moved.position > 0 else ""
        return _(
            "The mean attitude of this rest is off by {off}″{times}: its level axes by up "
            "to {significant} m/s², with them biases and cross-axis terms.",
            off=off,
            times=times,
            significant=significant(angle * moved.gravity, 2),
        )
    shorter = _(
        "No attitude is stated of this rest. Its mean direction is off by {off}″, and the length "
        "of its mean force, by which alone it counts for the accelerometers, by {size} m/s².",
        off=off,
        size=significant(angle**2 / 2 * moved.gravity, 2),
    )
    if not moved.gyros:
        return shorter
    return _(
        "{of_forces} The motions before and after it end beside it by as much, with them scale "
        "factors and cross terms of the gyros.",
        of_forces=shorter,
    )


def _knocks(resting: Resting) -> Iterator[Motion]:
    blocks = np.flatnonzero(shaken(resting))
    if not len(blocks):
        return
    length = len(resting) // len(shaken(resting))
    for group in np.split(blocks, np.flatnonzero(np.diff(blocks) > 3) + 1):
        first, after = int(group[0]) * length, (int(group[-1]) + 1) * length
        size = np.nan
        if resting.recorded("gyro"):
            rate = resting.rate[first:after] - np.median(resting.rate, axis=0)
            swing = np.cumsum(rate, axis=0) * resting.interval
            size = float(np.linalg.norm(np.ptp(swing, axis=0)))
        yield Motion(first, after, "knock", size, 0.0, UNCONFIRMED)


def _sudden(resting: Resting, own: list[Jump], position: float) -> Iterator[Motion]:
    """Jumps of a channel that are a motion: of an accelerometer a tilt, of a gyro a turn."""
    n, longest = len(resting), round(MAX_SIDE_S / resting.interval)
    for jump in own:
        step = jump.step
        if jump.channel < 3:
            tilt, agreement = resting.shifted(0, step.earliest, step.latest, n)
            size = float(np.linalg.norm(tilt))
            first, after = step.earliest, max(step.latest, step.earliest + 1)
            off = size * min(1 - after / n, 1.0)
            motion = Motion(first, after, "tilt", size, off, agreement, step.p_value)
        else:
            ends = [j.step.place for j in own if j.channel >= 3 and j.step.place > step.place]
            after = min([n, *ends])
            before = resting.rate[max(step.place - longest, 0) : step.place].mean(axis=0)
            turned = (resting.rate[step.place : after] - before).sum(axis=0) * resting.interval
            size = float(np.linalg.norm(turned))
            off = size * (1 - (step.place + after) / (2 * n))
            agreement = jump.agreement
            motion = Motion(step.place, after, "creep", size, off, agreement, step.p_value)
        if motion.size > position:
            yield motion


def _creep(resting: Resting, own: list[Jump], position: float) -> Iterator[Motion]:
    """A change of the tilt over the rest, without what sudden jumps do to it."""
    length = max(round(BLOCK_S / resting.interval), -(-len(resting) // MAX_BLOCKS))
    length = min(length, len(resting) // MIN_BLOCKS)
    k = len(resting) // max(length, 1)
    if length < 1 or k < MIN_BLOCKS:
        return
    blocks = _quiet_means(resting, own, k, length)
    blocks = blocks - blocks.mean(axis=0)
    tilt = resting.tilt(blocks)
    upright = blocks @ resting.up / np.linalg.norm(resting.force.mean(axis=0))
    scatter = np.array([_scatter(series) for series in (*tilt.T, upright)])
    white = resting.tilt_noise(length)
    sigma = max(float(np.linalg.norm(scatter[:3]) / np.sqrt(2)), white, 1e-300)
    # The noise of the readings is well known; what exceeds it is known from few blocks only.
    degrees = MAX_DEGREES if sigma < MIN_COLOURED_RATIO * white else MEDIAN_EFFICIENCY * k
    i, j, size = _farthest(tilt)
    size -= sigma  # the farthest two of many are a little too far apart
    pairs = k * (k - 1) / 2
    chance = float(stdtr(degrees, -size / (np.sqrt(2) * sigma))) * pairs * CAMPAIGN_RESTS
    if chance > FALSE_ALARM_LEVEL:
        return
    _, _, drift = _farthest(upright[:, None])
    least = max(position, MIN_DRIFT_RATIO * (drift - 5 * float(scatter[3])))
    way = _moving(tilt, i, j, max(MAX_STILL_SIGMA * sigma, MAX_STILL_SHARE * size))
    agreement = _agreement(resting, own, tilt, length, way)
    if not agreement.conclusive:
        second = sigma * np.sqrt(length * resting.interval)
        least = max(least, MIN_TILT, MIN_TILT_SIGMA * second)
    elif not agreement.moved:
        return
    if size > least:
        if not agreement.conclusive and _even(tilt, sigma):
            first, after = 0, len(resting)
            slope = np.polynomial.polynomial.polyfit(np.arange(k) / k, tilt, 1)[1]
            size = float(np.linalg.norm(slope))
            off = size / 2
        else:
            i, j = way
            first, after = i * length, min((j + 1) * length, len(resting))
            stood = tilt[: i + 1].mean(axis=0)
            size = float(np.linalg.norm(tilt[j:].mean(axis=0) - stood))
            off = float(np.linalg.norm(tilt.mean(axis=0) - stood))
        kind = "tilt" if (after - first) * resting.interval <= MAX_SUDDEN_S else "creep"
        yield Motion(first, after, kind, size, off, agreement, chance)


def _quiet_means(resting: Resting, own: list[Jump], k: int, length: int) -> Array:
    """The force in k blocks, (k, 3), without jumps, and what jerks where something else is left."""
    force = quiet_force(resting)
    if np.isnan(force[: k * length]).reshape(k, length, 3).all(axis=1).any():
        force = resting.force.copy()
    for jump in own:
        if jump.channel < 3:
            force[jump.step.place :, jump.channel] -= jump.step.size
    return np.asarray(np.nanmean(force[: k * length].reshape(k, length, 3), axis=1))


def _scatter(series: Array) -> float:
    """Sigma of the values of a series about what changes slowly."""
    change = np.diff(series)
    return MAD_TO_SIGMA / float(np.sqrt(2)) * float(np.median(np.abs(change - np.median(change))))


def _farthest(series: Array) -> tuple[int, int, float]:
    """The two rows of (k, c) that are farthest apart, and how far."""
    apart = np.linalg.norm(series[:, None] - series[None], axis=2)
    i, j = sorted(np.unravel_index(int(np.argmax(apart)), apart.shape))
    return int(i), int(j), float(apart[i, j])


def _even(tilt: Array, sigma: float) -> bool:
    """Whether a tilt in k blocks, (k, 3), grows evenly from the first to the last."""
    return bool(
        np.sqrt(np.sum((_uneven(len(tilt)) @ tilt) ** 2) / len(tilt)) < MAX_STILL_SIGMA * sigma
    )


def _uneven(k: int) -> Array:
    """What takes a level and an even drift off a series of k values, (k, k)."""
    even = np.column_stack([np.ones(k), np.arange(k)])
    return np.asarray(np.eye(k) - even @ np.linalg.pinv(even))


def _moving(tilt: Array, i: int, j: int, still: float) -> tuple[int, int]:
    """From the last block that stands as block i does to the first that stands as block j."""
    way = tilt[j] - tilt[i]
    along = tilt @ way / float(np.linalg.norm(way))
    first = int(np.flatnonzero(along[i:j] < along[i] + still)[-1]) + i
    last = int(np.flatnonzero(along[first:] > along[j] - still)[0]) + first
    return first, last


def _agreement(
    resting: Resting, own: list[Jump], tilt: Array, length: int, way: tuple[int, int]
) -> Agreement:
    """How much of a tilt the gyros confirm: over the rest, or of a short motion from its blocks."""
    first, after = way[0] * length, (way[1] + 1) * length
    if resting.masked[first:after].any():
        return KNOCKED
    whole = _turned(resting, own, tilt, length)
    if whole.conclusive or (after - first) * resting.interval > MAX_SUDDEN_S:
        return whole
    return resting.shifted(0, first, after, len(resting))[1]


def _turned(resting: Resting, own: list[Jump], tilt: Array, length: int) -> Agreement:
    """How much of a tilt in k blocks, (k, 3), the gyros confirm; its linear part they cannot.

    Their biases and the earth's rate equal an even turn. Their drift about the vertical, to which
    the tilt is insensitive, gives the uncertainty of the rest. Jumps of their biases are
    subtracted.
    """
    if not resting.recorded("gyro"):
        return UNCONFIRMED
    k = len(tilt)
    rate = resting.rate.copy()
    for jump in own:
        if jump.channel >= 3 and not jump.moved:
            rate[jump.step.place :, jump.channel - 3] -= jump.step.size
    rates = rate[: k * length].reshape(k, length, 3).sum(axis=1) * resting.interval
    turned = np.cumsum(rates, axis=0) - rates / 2
    uneven, rotation = _uneven(k) @ tilt, _uneven(k) @ turned
    size = float(np.sum(uneven**2))
    level = resting.level(rotation)
    wander = float(np.sum((rotation @ resting.up) ** 2))
    white = float(np.max(resting.mean_noise[COLUMNS["gyro"]])) * resting.interval
    wander = max(wander, k / 15 * white**2 * k * length)
    if size <= 0:
        return UNCONFIRMED
    return Agreement(
        float(np.sum(level * uneven)) / size, MIN_HEADING_RATIO / 4 * float(np.sqrt(wander / size))
    )


def _joined(motions: list[Motion], near: int) -> list[Motion]:
    """Motions that touch, as one: that which is larger, from the first record to the last."""
    ordered = sorted(motions, key=lambda motion: motion.first)
    borders = [b.first > a + near for a, b in pairwise_reached(ordered)]
    groups: list[list[Motion]] = []
    for number, motion in enumerate(ordered):
        if number == 0 or borders[number - 1]:
            groups.append([])
        groups[-1].append(motion)
    return [_largest_of(group) for group in groups]


def pairwise_reached(ordered: list[Motion]) -> Iterator[tuple[int, Motion]]:
    """For every motion but the first: how far those before it have reached, and itself."""
    reached = 0
    for earlier, later in pairwise(ordered):
        reached = max(reached, earlier.after)
        yield reached, later


def _largest_of(group: list[Motion]) -> Motion:
    order = {"knock": 0, "tilt": 1, "creep": 2}
    largest = max(group, key=lambda motion: (motion.kind != "knock", np.nan_to_num(motion.size)))
    kind = max((motion.kind for motion in group), key=lambda motion: order[motion])
    return Motion(
        min(motion.first for motion in group),
        max(motion.after for motion in group),
        kind,
        largest.size,
        max(motion.off for motion in group),
        largest.agreement,
        largest.p_value,
    )


# ---- What the gyros still read after a turn has stopped.

MIN_TURNS = 4  # whose scatter tells the mean from chance
MAX_CHANCE = 1e-4  # of clean campaigns


class MotionAfterTurns(PlanDetector):
    """In the rest after a turn the gyros read another rate than before it, with the sense of turns.

    By Student's test of what whole turns have in common, so that noise of any colour is allowed
    for. A drift does not change its sign with the sense of the turn.

    Cause: the table overshoots and creeps back, or the gyros themselves relax after a turn. The
    angle from start to stop is not the planned one, or the biases of the rests are not those of the
    turns; gyros in a turn about the vertical cannot tell which.
    """

    name = "motion_after_turns"
    source = "IEEE Std 1293-2018, 12: readings are taken once the table has settled"
    unit = "rad"
    severity = 3
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        angle = recorded.after_stop[np.isfinite(recorded.after_stop)]
        if len(angle) < MIN_TURNS or (np.sign(angle) == np.sign(angle[0])).mean() < 1:
            return
        mean, sigma = float(np.mean(angle)), float(np.std(angle, ddof=1) / np.sqrt(len(angle)))
        if sigma > 0 and 2 * float(stdtr(len(angle) - 1, -abs(mean) / sigma)) < MAX_CHANCE:
            yield Deviation(None, "", mean, self.sensor, count=len(angle), facts=sigma)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        assert deviation.size is not None
        whole = float(np.nanmin(np.abs(recorded.angle)))
        return Description(
            _(
                "After {count} turns have stopped the gyros read a rotation of {angle} ± {sigma} "
                "arcsec more, {sense}: the table overshoots and settles, or the gyros relax.",
                count=deviation.count,
                angle=significant(abs(deviation.size) / ARC_SECOND, 3),
                sigma=significant(deviation.facts / ARC_SECOND, 2),
                sense=_("with the turn") if deviation.size > 0 else _("back against the turn"),
            ),
            _(
                "If it is the table, the angle from start to stop is off by as much, and scale "
                "factors by up to {ppm} ppm; if it is the gyros, biases at rest are not those in "
                "turns.",
                ppm=significant(1e6 * abs(deviation.size) / whole, 2),
            ),
            _(
                "Nothing is changed. Record the same turn with a slower acceleration and with a "
                "longer rest after it: what the table does becomes less with the first, what gyros "
                "do stays."
            ),
        )
