"""The motion of the table in each static position and rate segment."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from inertial.arrays import Array, Booleans, nearest_axis
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.rate_segments import position_of
from inertial.campaign.recorded_turns import Rotation
from inertial.campaign.records import Manoeuvre, runs_of
from inertial.campaign.static_positions import Blocks, StaticPosition, by_manoeuvre
from inertial.effects.gyro_hysteresis import BREAK_AWAY
from inertial.estimation.gyroscope_observations import RateSegment, SteadyRate
from inertial.physics.forward import UNKNOWN_TRIAD, measured_angles
from inertial.physics.motion import Motion, Profile, turning
from inertial.signal.rests_and_motions import bridged
from inertial.signal.stamps import samples_passed
from inertial.tables import ACCEL
from inertial.text.messages import _

# --- One static position, a rotation block by block, a rotation sample by sample ---


MAX_ANGLE_OFF = 1e-3  # relative, of a turn by the gyros, to which first-order effects are exact
MAX_RATE_OFF = 0.1  # relative, of the rate of a turn, beyond which it was another than stated
MIN_BEND = 0.002  # rad/s, off a straight line in a block; less is a ramp without a corner


def at_rest(data: CampaignData, position: StaticPosition, time: float) -> Motion:
    """A static position as one stretch of time, about its middle `time`, s."""
    m = position.manoeuvre
    set_position = position_of(m, data.heading)
    up, north = data.result.upright(m), data.result.north(set_position)
    zero = np.zeros(1)
    rest = turning(
        position.about,
        up,
        north,
        np.array([position.angle]),
        zero,
        zero,
        np.array([time]),
        np.array([position.seconds.sum()]),
    )
    tumbled = np.zeros(3) if m.tumbled is None else m.tumbled
    surveyed = np.array([set_position.north is not None])
    return replace(rest, surveyed=surveyed, tumbled=tumbled[None])


def in_blocks(data: CampaignData, m: Manoeuvre, turn: RateSegment, time: Array) -> Motion:
    """A rotation in the k blocks of its sums, with the angles that the gyros measured.

    Where these are far from the known angle, as of a scale factor that goes with the rate, they are
    scaled to it: effects depend on the rate of the table, and not on what the gyros make of it.
    """
    solution, set_position = data.result.since(m.switch_on), position_of(m, data.heading)
    up, north = solution.upright(m), solution.north(set_position)
    assert solution.gyro is not None  # else nothing is simulated
    earth = solution.site.earth_rate(up, north)
    angle = measured_angles(
        turn.sums, turn.seconds, m.axis, earth, solution.gyro, turn.turned, 1 / turn.density
    )
    known = turn.angle / float(turn.weights @ angle) if not turn.by_hand else np.nan
    if abs(known - 1) > MAX_ANGLE_OFF and turn.course is None:
        angle = known * angle
    rate = angle / turn.seconds
    missing = np.zeros(len(rate))
    missing[[gap.before for gap in turn.gaps]] = [gap.seconds for gap in turn.gaps]
    first, last = between_blocks(rate, turn.seconds, missing)[:2]
    acceleration = (last - first) / turn.seconds
    blocks = turning(m.axis, up, north, turn.turned(angle), rate, acceleration, time, turn.seconds)
    return replace(blocks, surveyed=np.full(len(time), set_position.north is not None))


def between_blocks(rate: Array, seconds: Array, missing: Array) -> tuple[Array, Array, Array]:
    """The rate where each of the k blocks of a turn begins and ends; at its ends it is at rest.

    It continues straight from the blocks on both sides, or, near the corner of a ramp, from those
    on the side away from it. Where samples are `missing` before a block, (k,), s, it has changed by
    when that begins. The third: how far the blocks beside each edge are off a straight line,
    (k + 1,), rad/s; if they are, a corner may be so near that the rate is another.
    """
    length, gap = np.pad(seconds, 1, "edge"), np.append(missing, 0.0)
    apart = (length[1:] + length[:-1]) / 2 + gap
    slope = np.diff(np.pad(rate, 1)) / apart
    bend = np.abs(np.diff(np.pad(slope, 1))) * length  # of the rest before, the blocks, the rest
    earlier, later, gap = bend[:-3], bend[3:], gap[1:-1]
    straighter = [later < earlier - MIN_BEND, earlier < later - MIN_BEND]

    def at(since: Array) -> Array:
        """After a time since the block before each inner edge ended, (k − 1,)."""
        before = rate[:-1] + slope[:-2] * (seconds[:-1] / 2 + since)
        behind = rate[1:] - slope[2:] * (seconds[1:] / 2 + gap - since)
        return np.asarray(np.select(straighter, [behind, before], (before + behind) / 2))

    off = np.fmin(bend[1:-2], bend[2:-1])
    return np.append(0.0, at(gap)), np.append(at(0 * gap), 0.0), np.pad(off, 1)


def at_rate(data: CampaignData, m: Manoeuvre, steady: SteadyRate, time: Array) -> Motion:
    """A rotation at a known rate in k blocks; its angle counts from its first record."""
    solution, set_position = data.result.since(m.switch_on), position_of(m, data.heading)
    angle, rate = steady.rate * steady.elapsed, np.full(len(time), steady.rate)
    directions = solution.upright(m), solution.north(set_position)
    zero = np.zeros(len(time))
    blocks = turning(m.axis, *directions, angle, rate, zero, time, steady.seconds)
    return replace(blocks, surveyed=np.full(len(time), set_position.north is not None))


def in_samples(
    data: CampaignData,
    m: Manoeuvre,
    increments: Array,
    step: float,
    steady: Booleans,
    time: Array,
) -> tuple[Motion, str]:
    """A rotation from rest to rest, sample by sample, and the origin of its profile.

    With a stated rate and acceleration the rate is a trapezoid, whose middle in time is
    estimated from the steady part of the gyros' angle; of a turn that was done at another rate, it
    is at that. Otherwise the angle is that of the gyros, scaled to the stated one.

    Parameters
    ----------
    increments : (n, 3), rad, of the gyros, NaN where they are masked; `step`, s, of each
    steady : (n,), which samples are at the steady rate
    time : (n,), s; where it jumps, samples were lost
    """
    solution = data.result.since(m.switch_on)
    up, north = solution.upright(m), solution.north(position_of(m, data.heading))
    assert solution.gyro is not None and m.angle is not None  # else it is not simulated
    passed = np.append(1.0, samples_passed(time, step))
    counts, lost = np.minimum(passed, 1.0), np.maximum(passed - 1.0, 0.0)
    increments = bridged(increments) * counts[:, None]
    ends = step * np.cumsum(passed)

    def so_far(angle: Array) -> Array:
        """The angle of the table at the end of each sample; lost ones as those beside them."""
        beside = (angle + np.append(angle[:1], angle[:-1])) / 2
        if steady.any():
            beside[steady & np.append(False, steady[:-1])] = angle[steady].mean()
        return np.asarray(np.cumsum(angle + lost * beside))

    measured = measured_angles(
        increments,
        step * counts,
        m.axis,
        solution.site.earth_rate(up, north),
        solution.gyro,
        lambda angle: so_far(angle) - angle / 2,
    )
    if m.rate is not None and m.acceleration is not None and steady.any():
        after = so_far(measured)
        stated = np.copysign(m.rate, m.angle)
        share = m.angle / after[-1] if after[-1] else np.nan  # of what the gyros read
        read = float(np.median(measured[steady]) / step * share)
        rate_had = read if abs(read / stated - 1) > MAX_RATE_OFF else stated
        middle = float(np.mean(ends[steady] - (after[steady] - m.angle / 2) / rate_had))
        profile = Profile(abs(m.angle), abs(rate_had), m.acceleration)
        sign, start = np.sign(m.angle), middle - profile.seconds / 2
        edges = [sign * np.stack(profile.at(edge - start)) for edge in (ends - step, ends)]
        (first, after), (rate, rate_after) = zip(*edges, strict=True)
        how = "trapezoid"
    else:
        angles = np.append(0.0, np.cumsum(measured)) * (m.angle / float(measured.sum()))
        rates = np.gradient(angles, step)
        first, after, rate, rate_after = angles[:-1], angles[1:], rates[:-1], rates[1:]
        how = _("as the gyros have it")
    motion = turning(
        m.axis,
        up,
        north,
        (first + after) / 2,
        (after - first) / step,
        (rate_after - rate) / step,
        time,
        np.full(len(time), step),
    )
    return motion, how


# --- The stretches of a campaign, with time, temperature and vibration ---

MOVING, AFTER = 1 / 3, 2 / 3  # of a visit: the rotation, and the static position after it
MIN_UPRIGHT_COSINE = 1 - 1e-6  # cosine of an axis to the vertical


class CampaignMotions:
    """The stretches of one mount; without a clock that the logs share, no time is given."""

    def __init__(self, data: CampaignData) -> None:
        self._data = data
        self._visits = {m.name: float(place) for place, m in enumerate(data.plan)}
        names = positions_of(data.plan)
        self._places = {m.name: float(names.index(m.position)) for m in data.plan}
        runs = runs_of(dict.fromkeys(m.log for m in data.plan), data.clocks, data.shared_clock)
        self._runs = {m.name: float(runs[m.log]) for m in data.plan}
        self._switched_on = {m.name: data.switched_on.get(m.switch_on, 0.0) for m in data.plan}
        self._switches_per_log = not data.shared_clock and _switches_per_log(data.plan)
        self._turns = LastTurns(data)
        self._at_rest: dict[tuple[str, float], Motion] = {}

    def at_rest(self, position: StaticPosition) -> Motion:
        """A static position as one stretch."""
        name, log_time = position.manoeuvre.name, position.mean_of(position.time)
        time = log_time if self._data.shared_clock else np.nan
        later = AFTER if position.part.phase == "rest-after" else 0.0
        place = (name, position.angle)  # all pieces of a position have one attitude
        if place not in self._at_rest:
            self._at_rest[place] = at_rest(self._data, position, time)
        peaks, senses = self._on_the_way(name, 1)
        since, turned = self._turns.before(position.manoeuvre, np.array([log_time]))
        return replace(
            self._at_rest[place],
            time=np.array([time]),
            log_time=np.array([log_time if self._switches_per_log else np.nan]),
            seconds=np.array([position.seconds.sum()]),
            switched_on=np.array([self._switched_on[name]]),
            visit=np.array([self._visits[name] + later]),
            position=np.array([self._places[name]]),
            run=np.array([self._runs[name]]),
            temperature=np.array([position.mean_of(position.temperature)]),
            vibration=self._data.noise.of_samples(name, "rest", ACCEL)[None],
            peaks=peaks,
            senses=senses,
            since=since,
            turned=turned,
        )

    def turning(self, rotation: Rotation, turn: RateSegment) -> Motion:
        """A rotation from rest to rest in its blocks."""
        blocks = rotation.blocks
        motion = in_blocks(self._data, rotation.plan, turn, self._time_of(blocks))
        return self._placed(rotation.plan, motion, rotation.blocks, turn)

    def at_rate(self, rotation: Rotation, steady: SteadyRate) -> Motion:
        """The part of a rotation at a known rate in its blocks."""
        motion = at_rate(self._data, rotation.plan, steady, self._time_of(rotation.steady))
        return self._placed(rotation.plan, motion, rotation.steady, steady)

    def _time_of(self, blocks: Blocks) -> Array:
        return blocks.time if self._data.shared_clock else np.full(len(blocks), np.nan)

    def _placed(
        self, m: Manoeuvre, motion: Motion, blocks: Blocks, turn: RateSegment | SteadyRate
    ) -> Motion:
        """With its place in the plan; the vibration is known only where the axis is vertical.

        From rest to the steady rate the table is taken to shake in proportion to its rate.
        """
        time, name = motion.time, m.name
        upright = abs(float(turn.position.up @ turn.about)) > MIN_UPRIGHT_COSINE
        still, steady = (self._data.noise.of_samples(name, at, ACCEL) for at in ("rest", "steady"))
        rate = np.abs(motion.rate)[:, None]
        fastest = np.median(rate[blocks.steady]) if blocks.steady.any() else rate.max()
        share = np.minimum(rate / fastest, 1.0) ** 2
        quiet = np.where(np.isfinite(still), still, steady) ** 2
        vibration = np.sqrt(quiet + share * (steady**2 - quiet) if upright else np.nan * rate)
        peaks, senses = self._on_the_way(name, len(time))
        since, turned = self._turns.before(m, blocks.time)
        return replace(
            motion,
            log_time=blocks.time if self._switches_per_log else np.full(len(time), np.nan),
            switched_on=np.full(len(time), self._switched_on[name]),
            visit=np.full(len(time), self._visits[name] + MOVING),
            position=np.full(len(time), self._places[name]),
            run=np.full(len(time), self._runs[name]),
            temperature=blocks.temperature,
            vibration=np.broadcast_to(vibration, (len(time), 3)),
            peaks=peaks,
            senses=senses,
            since=since,
            turned=turned,
            measured_force=self._measured_force(m, blocks),
        )

    def _measured_force(self, m: Manoeuvre, blocks: Blocks) -> Array:
        """The specific force in the blocks of a turn as measured, (k, 3), m/s²; or NaN."""
        triad = self._data.result.since(m.switch_on).accelerometer or UNKNOWN_TRIAD
        return np.asarray((blocks.accel - triad.bias) @ np.linalg.inv(triad.matrix).T)

    def _on_the_way(self, name: str, count: int) -> tuple[Array, Array]:
        """Peaks and senses on the way to a manoeuvre, (count, 3) each; see `Motion`."""
        done, unknown = self._data.performed.get(name), np.full(3, np.nan)
        both = (unknown, unknown) if done is None else (done.peaks, done.senses)
        peaks, senses = (np.tile(each, (count, 1)) for each in both)
        return peaks, senses


def _switches_per_log(plan: Sequence[Manoeuvre]) -> bool:
    """Whether every log after the first begins with a stated switch-on, and has no other."""
    parts = {(m.log, m.switch_on) for m in plan}
    return len(parts) == len({log for log, _ in parts}) == len({on for _, on in parts})


def positions_of(plan: Sequence[Manoeuvre]) -> list[str]:
    """The positions of a plan in their order."""
    return list(dict.fromkeys(m.position for m in plan))


class Merged:
    """Stretches one after another, some of which are merged into one from each of `starts` on.

    `weights`: (n,), s, their durations.
    """

    def __init__(self, weights: Array, starts: Iterable[int]) -> None:
        self._weights, self.starts = weights, list(starts)
        self.seconds = np.add.reduceat(weights, self.starts)

    def mean(self, values: Array) -> Array:
        """The mean of each, (m, …), of values (n, …)."""
        shape = (-1, *(1,) * (values.ndim - 1))
        sums = np.add.reduceat(values * self._weights.reshape(shape), self.starts)
        return np.asarray(sums / self.seconds.reshape(shape))


def mean_motions(motion: Motion, merged: Merged) -> list[Motion]:
    """The mean motion of each of the merged stretches."""
    names = [field.name for field in fields(Motion) if field.name != "about"]
    means: dict[str, Any] = {name: merged.mean(getattr(motion, name)) for name in names}
    means["seconds"] = merged.seconds
    for name in (
        "surveyed",
        "switched_on",
        "position",
        "run",
        "peaks",
        "senses",
        "tumbled",
        "turned",
    ):
        means[name] = getattr(motion, name)[merged.starts]
    return [
        Motion(about=motion.about, **{name: values[i : i + 1] for name, values in means.items()})
        for i in range(len(merged.starts))
    ]


# --- When, and in which sense, the table last turned about each axis before a moment of a log ---


@dataclass(frozen=True)
class _Turn:
    """A turn: when it began and ended, s of its log, and its sense about each axis, (3,), or 0."""

    begin: float
    end: float
    senses: Array


class LastTurns:
    """The turns in each log of a campaign: those of the plan, and those on the way between."""

    def __init__(self, data: CampaignData) -> None:
        blocks = by_manoeuvre(data.blocks)
        self._of_log: dict[str, list[_Turn]] = {}
        for m in data.plan:
            turns = self._of_log.setdefault(m.log, [])
            done = data.performed.get(m.name)
            if done is not None and done.stopped is not None:
                turns.append(_Turn(done.stopped, done.stopped, np.nan_to_num(done.senses)))
            turn = turn_in(blocks[m.name]) if m.do == "turn" and m.name in blocks else None
            if turn is not None:
                turns.append(turn)

    def before(self, m: Manoeuvre, time: Array) -> tuple[Array, Array]:
        """`since` and `turned` of `Motion` at the middles of stretches of a log, s, (k, 3) each."""
        since, turned = np.full((len(time), 3), np.nan), np.zeros((len(time), 3))
        for turn in self._of_log.get(m.log, ()):
            later = (time >= turn.begin)[:, None] & (turn.senses != 0)
            past = (time - turn.end)[:, None]
            latest = later & ~(since < past)  # NaN is no time
            since, turned = np.where(latest, past, since), np.where(latest, turn.senses, turned)
        return since, turned


def turn_in(blocks: Blocks) -> _Turn | None:
    """The turn in the blocks of a manoeuvre, in their order; None where nothing turns.

    In the last block that moves it brakes evenly from the rate at its start, which continues that
    of the two blocks before: it stops after twice the angle over that rate.
    """
    rates = np.nan_to_num(blocks.gyro)
    moving = np.flatnonzero((np.abs(rates) > BREAK_AWAY).any(axis=1))
    if not len(moving):
        return None
    first, last = int(moving[0]), int(moving[-1])
    axis = nearest_axis(rates[last])
    rate, seconds = np.abs(rates[:, axis]), blocks.seconds
    lasting = float(seconds[last])
    if last >= first + 2:
        apart = (seconds[last - 2] + seconds[last - 1]) / 2
        slope = min((rate[last - 1] - rate[last - 2]) / apart, 0.0)
        start = float(rate[last - 1] + slope * seconds[last - 1] / 2)
        if start > rate[last]:
            lasting = min(lasting, 2 * float(rate[last]) * lasting / start)
    begins = blocks.time - seconds / 2
    turned = rates[moving]
    senses = np.sign(turned.sum(axis=0)) * (np.abs(turned) > BREAK_AWAY).any(axis=0)
    return _Turn(float(begins[first]), float(begins[last]) + lasting, senses)
