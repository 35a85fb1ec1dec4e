"""The rate segments of a campaign as inputs of the equations of the gyros."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from math import cos, degrees, sin
from typing import TYPE_CHECKING

import numpy as np

from inertial.arrays import Array
from inertial.campaign.noise_levels import NoiseLevels
from inertial.campaign.records import Manoeuvre, Part, Performed
from inertial.campaign.static_positions import (
    NO_BLOCKS,
    Blocks,
    StaticPosition,
    by_manoeuvre,
    stretch_of,
)
from inertial.estimation.gyroscope_observations import (
    Earth,
    EncoderWindow,
    Gap,
    Position,
    RateSegment,
    StaticRate,
    SteadyRate,
    WholeTurn,
)
from inertial.estimation.spectrum import rate_deviation
from inertial.physics.motion import cross
from inertial.tables import GYRO
from inertial.text.messages import _

if TYPE_CHECKING:
    from inertial.campaign.campaign_data import CampaignData

# --- Interpolation of missing samples of a rotation, and the sigma of its angle ---
#
# In the steady part the angle is the mean recorded rate times the missing time, in a ramp the
# integral of the straight line between the neighbouring blocks. Their noise is in the equations;
# the other errors of the angle are:
#
# - the mean rate while samples are missing differs from the recorded one: by the stated sigma of
#   the table's rate, or by the variation in the data, whichever is larger. It is the same
#   for all gaps of a rotation, and does not average out;
# - an oscillation of the case faster than a block appears in the scatter of samples only: the
#   recorded part may end at any phase of it;
# - in a ramp the acceleration may change between the neighbouring blocks: the straight line is
#   wrong by up to a quarter of the change of rate between them.


def gaps_of(part: Blocks) -> list[Gap]:
    """The gaps between the k blocks of a turn, interpolated from the neighbouring blocks."""
    seconds, steady = part.seconds, part.steady
    gaps = []
    for i in np.flatnonzero(part.missing).tolist():
        lost = float(part.missing[i])
        shares = np.zeros(len(part))
        if steady[i - 1] and steady[i]:
            shares[steady] = lost / seconds[steady].sum()
        else:
            # The straight line through the means of both blocks, at the middle of the gap.
            weight = (seconds[i - 1] + lost) / (seconds[i - 1] + 2 * lost + seconds[i])
            shares[i - 1 : i + 1] = lost * np.array([1 - weight, weight]) / seconds[i - 1 : i + 1]
        gaps.append(Gap(i, lost, shares))
    return gaps


def weights_of(part: Blocks) -> Array:
    """The weights of the k blocks of a turn in its sums, (k,), so that these have no gaps."""
    return np.ones(len(part)) + sum((gap.shares for gap in gaps_of(part)), np.zeros(1))


def sigma_of(
    part: Blocks,
    gaps: Sequence[Gap],
    about: Array,
    name: str,
    noise: NoiseLevels,
    rate_sigma: float,
) -> float:
    """The sigma of the interpolated angle of all gaps together, rad, without noise.

    Parameters
    ----------
    about : (3,), axis of the turn; `name` of its manoeuvre
    rate_sigma : relative, of the table's rate
    """
    if not gaps:
        return 0.0
    seconds, steady = part.seconds, part.steady
    rate = np.nan_to_num(part.gyro) @ about
    elapsed = np.cumsum(seconds + part.missing) - seconds / 2
    density = np.nan_to_num(noise.of(name, "steady", GYRO))
    oscillation = _oscillation(name, noise, about, float(seconds.sum() / part.counts.sum()))
    # An oscillation slower than one period in a block is visible in the blocks.
    longest = float(np.median(seconds)) / (2 * np.pi)
    variance = sum(2 * (oscillation * min(gap.seconds, longest)) ** 2 for gap in gaps)

    steady_gaps = [gap for gap in gaps if steady[gap.before - 1] and steady[gap.before]]
    if steady_gaps:
        longest_gap = max(steady_gaps, key=lambda gap: gap.seconds)
        deviation = rate_deviation(
            rate[steady],
            seconds[steady],
            elapsed[steady],
            np.flatnonzero(steady) < longest_gap.before,
            longest_gap.seconds,
            float(np.linalg.norm(about * density)),
        )
        stated = rate_sigma * abs(float(np.average(rate[steady], weights=seconds[steady])))
        variance += (max(deviation, stated) * sum(gap.seconds for gap in steady_gaps)) ** 2
    change = np.abs(np.diff(rate)) / np.diff(elapsed)  # rad/s², from block to block
    for gap in gaps:
        if not any(gap is other for other in steady_gaps):
            largest = change[max(gap.before - 2, 0) : gap.before + 1].max()
            interval = elapsed[gap.before] - elapsed[gap.before - 1]
            variance += (largest * interval / 4 * gap.seconds) ** 2
    return float(np.sqrt(variance))


def _oscillation(name: str, noise: NoiseLevels, about: Array, step: float) -> float:
    """Scatter of the samples of the steady part about the axis beyond white noise, rad/s."""
    white = noise.of(name, "steady", GYRO) ** 2 / step
    excess = np.maximum(np.nan_to_num(noise.of_samples(name, "steady", GYRO) ** 2 - white), 0.0)
    return float(np.sqrt(about**2 @ excess))


# --- Windows of the angle of a turn, by the table's encoder ---

MAX_WINDOWS = 24  # of a turn: enough for what repeats with each turn of the encoder


def windows_of(part: Blocks, about: Array) -> list[EncoderWindow]:
    """The windows of a turn by its k blocks, none where the encoder is not used in all of them.

    They meet in the steady part alone, where the rate of the table is the same on both sides, so
    that a delay does not matter there; or they end at a gap.
    """
    encoder = part.encoder
    if not len(part) or not np.isfinite(encoder).all() or (part.phase == "turning").any():
        return []
    read = np.nan_to_num(part.gyro) @ about * part.seconds
    sense = float(np.sign(read @ (encoder[:, 1] - encoder[:, 0])))
    steady, apart = part.steady, part.missing != 0
    least = max(1, -(-len(part) // MAX_WINDOWS))
    edges = [0]
    for i in range(1, len(part)):
        if apart[i] or (steady[i - 1] and steady[i] and i - edges[-1] >= least):
            edges.append(i)
    angles = sense * encoder[:, :2]
    windows: list[EncoderWindow] = []
    for first, after in pairwise([*edges, len(part)]):
        joins = windows and not apart[first]
        start = windows[-1].end if joins else float(angles[first, 0])
        change = sense * float(encoder[after - 1, 3] - encoder[first, 2])
        windows.append(
            EncoderWindow(first, after, start, float(angles[after - 1, 1]), change, sense)
        )
    return windows


def by_windows(segment: RateSegment, part: Blocks, angle_sigma: float) -> RateSegment:
    """A turn, or a part of one, by the angle of the encoder; as it is where that is not used.

    What the gyros scatter by in motion beyond their noise at rest is an oscillation, of which a
    window may hold any phase at either end.
    """
    windows = windows_of(part, segment.about)
    if not windows:
        return segment
    excess = np.nan_to_num(segment.density**2 - segment.quiet_density**2) @ segment.about**2
    swing = max(float(excess), 0.0) * float(np.median(part.seconds))
    angle_sigma = float(np.sqrt(angle_sigma**2 + swing))
    middle = windows[0].sense * part.encoder[:, :2].mean(axis=1)
    course = np.asarray(middle - windows[0].start)
    return replace(segment, windows=windows, course=course, angle_sigma=angle_sigma)


# --- The inputs of the equations of the gyros; rotations that cannot be used ---

TURNING = ("spin-up", "steady", "spin-down", "turning")


@dataclass(frozen=True)
class Rotation:
    """A rotation of the plan, its record, its blocks in motion, and why it is refused.

    `begun`: whether the rest before it is in its record; one that is recorded in part and has
    none begins at another azimuth than that of the set position. `clock_sigma`: of the rate of the
    clock of its log, relative.
    """

    plan: Manoeuvre
    done: Performed
    blocks: Blocks
    refusal: str  # empty where it can be used
    begun: bool = True
    clock_sigma: float = 0.0

    @property
    def steady(self) -> Blocks:
        """The blocks at the steady rate."""
        return self.blocks.those(self.blocks.steady)

    @property
    def in_part(self) -> bool:
        """Whether it is refused as a turn, but the encoder gives the angle of what is recorded."""
        lacks = self.done.found and not (self.done.complete or self.done.bridged)
        whole = self.plan.recorded == "whole" and self.done.angle is not None
        return bool(lacks and whole and windows_of(self.blocks, self.plan.axis))

    @property
    def by_encoder(self) -> bool:
        """Whether the encoder gives the angle of its steady part."""
        return bool(windows_of(self.steady, self.plan.axis))

    @property
    def weights(self) -> Array:
        """How often each block counts in the turn, (k,): with its share of what is missing."""
        return weights_of(self.blocks)


@dataclass(frozen=True)
class GyroInputs:
    """The inputs of the equations of the gyros, of one mount."""

    static_positions: list[StaticPosition]
    recorded: list[Rotation]
    turns: list[RateSegment]  # from rest to rest, with their angle known
    steady_rates: list[SteadyRate]  # at a known rate
    # As the joint estimate takes them: windows of the encoder where that gives parts of turns.
    segments: list[RateSegment]
    set_rates: list[SteadyRate]
    earth: Earth
    position_sigma: float
    heading: float | None
    left_out: list[Part]

    @property
    def usable(self) -> list[Rotation]:
        """The turns that are not refused."""
        return [rotation for rotation in self.recorded if not rotation.refusal]

    @property
    def whole_turns(self) -> list[Rotation]:
        """Those of them that are recorded from rest to rest."""
        return [rotation for rotation in self.usable if rotation.plan.recorded == "whole"]

    @property
    def of_known_attitude(self) -> "GyroInputs":
        """The same without turns of which only the axis is known, which cannot be simulated."""
        return replace(
            self,
            static_positions=[p for p in self.static_positions if p.manoeuvre.up is not None],
            recorded=[r for r in self.recorded if r.plan.up is not None],
            turns=[turn for turn in self.turns if turn.position.is_known],
            steady_rates=[steady for steady in self.steady_rates if steady.position.is_known],
            segments=[part for part in self.segments if part.position.is_known],
            set_rates=[steady for steady in self.set_rates if steady.position.is_known],
        )

    @property
    def used(self) -> list[Part]:
        """The manoeuvres of the equations."""
        return [s.part for s in self.static_positions] + [
            Part(rotation.plan.name)
            for rotation in self.recorded
            if not rotation.refusal or rotation.in_part
        ]

    @property
    def is_empty(self) -> bool:
        """Whether there is neither a static position nor a rotation."""
        return not (self.static_positions or self.segments or self.steady_rates)

    @cached_property
    def static_rates(self) -> list[StaticRate]:
        """The static positions as observations of the equations."""
        return self.first_static_rates(np.inf)

    def first_static_rates(self, seconds: float) -> list[StaticRate]:
        """The same from the first `seconds` of each."""
        return [
            static_rate_of(position, self.heading, seconds) for position in self.static_positions
        ]


def gyro_inputs(data: "CampaignData") -> GyroInputs:
    """Gather the static positions and rate segments of one mount."""
    positions, left_out = data.gyro_positions
    recorded = list(_recorded_turns(data))
    usable = [rotation for rotation in recorded if not rotation.refusal]
    given = (data.noise, data.heading, data.rate_sigma)
    shared = data.shared_clock
    angle_sigma = data.known["turn_angle"].scatter if "turn_angle" in data.known else 0.0

    def whole(r: Rotation) -> RateSegment:
        return replace(rate_segment_of(r, *given), stretch=stretch_of(r.plan, r.blocks, shared))

    turned = [r for r in usable if r.plan.recorded == "whole"]
    turns = [whole(r) for r in turned]
    steady = [r for r in usable if r.plan.recorded == "steady"]
    rates = [
        replace(steady_rate_of(r, *given), stretch=stretch_of(r.plan, r.steady, shared))
        for r in steady
    ]
    parts = [r for r in recorded if r.in_part]
    parts += [replace(r, blocks=r.steady, begun=True) for r in steady if r.by_encoder]
    in_windows = parts or any(r.blocks.missing.any() for r in turned)
    segments = [
        by_windows(segment, r.blocks, angle_sigma) if in_windows else segment
        for segment, r in zip([*turns, *map(whole, parts)], [*turned, *parts], strict=True)
    ]
    return GyroInputs(
        positions,
        recorded,
        turns,
        rates,
        segments,
        [rate for r, rate in zip(steady, rates, strict=True) if not r.by_encoder],
        data.earth,
        data.position_sigma,
        data.heading,
        left_out
        + [Part(r.plan.name, None, r.refusal) for r in recorded if r.refusal and not r.in_part],
    )


def _recorded_turns(data: "CampaignData") -> Iterator[Rotation]:
    """Every turn of the plan."""
    moving = by_manoeuvre(data.blocks[data.blocks["phase"].isin(TURNING)])
    begun = set(data.blocks.loc[data.blocks["phase"] == "rest-before", "manoeuvre"])
    for m in data.plan:
        if m.do == "turn":
            done, part = data.performed[m.name], moving.get(m.name, NO_BLOCKS)
            clock = data.clocks.get(m.log)
            timed = 0.0 if clock is None else clock.sigma
            yield Rotation(m, done, part, refusal_of(m, done, part), m.name in begun, timed)


def refusal_of(m: Manoeuvre, done: Performed, part: Blocks) -> str:
    """Why a turn cannot be used; empty where it can."""
    if not done.found:
        return _("not found in its log")
    if not len(part) or np.isnan(part.seconds).any() or bool((part.counts == 0).any()):
        return _("it has no time, so no angle can be summed")
    if m.recorded == "steady":
        return "" if bool(part.steady.any()) else _("no steady rate was found")
    if not (done.complete or done.bridged):
        return _("the angle method needs the whole turn, and {sentence}", sentence=done.sentence)
    if m.angle is None or m.angle_sigma is None:
        return _("its angle is not stated")
    if done.angle is None:
        return _("its angle is not measured: {sentence}", sentence=done.sentence)
    if done.angle * m.angle < 0:
        return _("it turned by {degrees:.1f}°, against the plan", degrees=degrees(done.angle))
    return ""


def position_of(m: Manoeuvre, heading: float | None) -> Position:
    """The set position of a manoeuvre; north is known where mark and heading are."""
    up = m.up
    if up is None:
        return Position(m.position, np.zeros(3))
    if m.mark is None:
        return Position(m.position, up)
    mark = m.mark - up * (up @ m.mark)
    mark = mark / np.linalg.norm(mark)
    if heading is None:
        return Position(m.position, up, mark=mark)
    # The azimuth counts clockwise, so north lies counter-clockwise of the mark, seen from above.
    return Position(m.position, up, north=cos(heading) * mark + sin(heading) * cross(up, mark))


def static_rate_of(position: StaticPosition, heading: float | None, seconds: float) -> StaticRate:
    """The observation of a static position, or of its first `seconds`."""
    set_position = position_of(position.manoeuvre, heading)
    mean, sigma = position.over(seconds)
    stretch = position.during(seconds)
    return StaticRate(set_position, mean, sigma, position.about, position.angle, stretch=stretch)


def rate_segment_of(
    rotation: Rotation, noise: NoiseLevels, heading: float | None, rate_sigma: float
) -> RateSegment:
    """A turn from rest to rest with its blocks in motion; gaps are interpolated.

    `rate_sigma`: relative, of the table's rate.
    """
    m, part = rotation.plan, rotation.blocks
    missing = gaps_of(part)
    position = position_of(m, heading)
    if rotation.in_part and not rotation.begun:
        position = Position(position.name, position.up, start=f"{m.name}, on the way")
    return RateSegment(
        position=position,
        about=m.axis,
        angle=np.nan if m.angle is None else m.angle,
        angle_sigma=np.nan if m.angle_sigma is None else m.angle_sigma,
        sums=part.gyro * part.seconds[:, None],
        seconds=part.seconds,
        density=noise.of(m.name, "steady", GYRO),
        quiet_density=noise.of(m.name, "rest", GYRO),
        by_hand=bool((part.phase == "turning").any()),
        gaps=missing,
        gap_sigma=sigma_of(part, missing, m.axis, m.name, noise, rate_sigma),
        unsteady=np.flatnonzero(~part.steady).tolist() if noise.oscillates(m.name, GYRO) else (),
        clock=m.log,
        clock_sigma=rotation.clock_sigma,
    )


def steady_rate_of(
    rotation: Rotation, noise: NoiseLevels, heading: float | None, rate_sigma: float
) -> SteadyRate:
    m, part = rotation.plan, rotation.steady
    assert m.rate is not None  # the plan requires a rate of such a turn
    ends = np.cumsum(part.seconds + part.missing) - part.missing[0]
    return SteadyRate(
        position=position_of(m, heading),
        about=m.axis,
        rate=m.rate,
        rate_sigma=abs(m.rate) * rate_sigma if m.rate_sigma is None else m.rate_sigma,
        seconds=part.seconds,
        elapsed=ends - part.seconds / 2,
        mean=np.average(part.gyro, weights=part.counts, axis=0),
        sigma=noise.of(m.name, "steady", GYRO) / np.sqrt(part.seconds.sum()),
    )


def angles_about(data: "CampaignData", i: int) -> list[tuple[str, WholeTurn]]:
    """The complete rotations about body axis i while it is vertical, by its gyro, with names."""
    complete = [r for r in data.gyro_inputs.whole_turns if r.done.complete]
    whole = [r for r in complete if _upright(r.plan, i)]
    angles = [(r.plan.name, _angle(r, i, data.noise)) for r in whole]
    return [(name, angle) for name, angle in angles if np.isfinite(angle.summed)]


def _upright(m: Manoeuvre, i: int) -> bool:
    """Whether a turn is about body axis i, and that axis points up or down."""
    up = m.up is not None and abs(float(m.up[i])) > 1 - 1e-9
    return up and abs(float(m.axis[i])) > 1 - 1e-9


def _angle(rotation: Rotation, i: int, noise: NoiseLevels) -> WholeTurn:
    m, part = rotation.plan, rotation.blocks
    assert m.up is not None and m.angle is not None and m.angle_sigma is not None  # else refused
    return WholeTurn(
        summed=float((part.gyro[:, i] * part.seconds * rotation.weights).sum()),
        angle=m.angle * float(m.axis[i]),
        angle_sigma=m.angle_sigma,
        seconds=float(rotation.weights @ part.seconds),
        up=float(m.up[i]),
        density=float(noise.of(m.name, "rest", GYRO)[i]),
        clock=m.log,
        clock_sigma=rotation.clock_sigma,
    )
