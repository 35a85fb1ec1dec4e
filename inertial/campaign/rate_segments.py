"""The rate segments of a campaign as inputs of the equations of the gyros."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from math import cos, degrees, sin
from typing import TYPE_CHECKING

import numpy as np

from inertial.arrays import Array
from inertial.campaign.interpolated_gaps import gaps_of, sigma_of, weights_of
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
    Position,
    RateSegment,
    StaticRate,
    SteadyRate,
    WholeTurn,
)
from inertial.estimation.turn_outliers import off_rate, off_ratio
from inertial.physics.motion import cross
from inertial.tables import GYRO
from inertial.text.messages import _
from inertial.text.numbers import significant

if TYPE_CHECKING:
    from inertial.campaign.campaign_data import CampaignData

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

TURNING = ("spin-up", "steady", "spin-down", "settling", "turning")


@dataclass(frozen=True)
class Rotation:
    """A rotation of the plan, its record, its blocks in motion, and why it is refused.

    `begun`: whether the rest before it is in its record; one that is recorded in part and has
    none begins at another azimuth than that of the set position. `clock_sigma`: of the rate of the
    clock of its log, relative; `off_ratio`: to its stated rate or angle, where by the other turns
    it was another.
    """

    plan: Manoeuvre
    done: Performed
    blocks: Blocks
    refusal: str  # empty where it can be used
    begun: bool = True
    clock_sigma: float = 0.0
    off_ratio: float | None = None

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
    recorded = _without_others(list(_recorded_turns(data)), data.noise)
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


def _without_others(rotations: Sequence[Rotation], noise: NoiseLevels) -> list[Rotation]:
    """The turns; one is refused that by the others was at another rate, or by another angle."""
    result = list(rotations)
    axes: dict[tuple[float, ...], list[int]] = {}
    whole: list[int] = []
    for place, turn in enumerate(rotations):
        if turn.refusal:
            continue
        if turn.plan.recorded == "steady" and not turn.by_encoder:
            axes.setdefault(_line_of(turn), []).append(place)
        elif turn.plan.recorded == "whole" and turn.done.complete:
            whole.append(place)
    for places in axes.values():
        runs = [rotations[i] for i in places]
        stated, read, sigma = np.transpose([_rates(run, noise) for run in runs])
        if (found := off_rate(stated, read, sigma)) is not None:
            number, rate = found
            ratio = rate / float(stated[number])
            why = _("by the other runs it turned at {read} °/s, not at {stated} °/s")
            result[places[number]] = _refused(runs[number], why, runs[number].plan.rate, ratio)
    turned = [(rotations[i].done.angle, rotations[i].plan.angle) for i in whole]
    ratios = np.array([angle / planned for angle, planned in turned if angle and planned])
    lines = [_line_of(rotations[i]) for i in whole]
    if len(ratios) == len(whole) and (one := off_ratio(ratios, lines)) is not None:
        ratio = float(ratios[one] / np.median(ratios))
        why = _("by the other turns it turned by {read}°, not by {stated}°")
        place = whole[one]
        result[place] = _refused(rotations[place], why, rotations[place].plan.angle, ratio)
    return result


def _line_of(turn: Rotation) -> tuple[float, ...]:
    """Its axis, whichever way it points."""
    return tuple(np.abs(turn.plan.axis).round(3).tolist())


def _rates(run: Rotation, noise: NoiseLevels) -> tuple[float, float, float]:
    """Stated and read about the axis, without its sign, and the sigma, rad/s."""
    m, part = run.plan, run.steady
    sign = 1.0 if m.axis.sum() > 0 else -1.0
    density = float(np.max(noise.of(m.name, "steady", GYRO)))
    read = float(m.axis @ mean_rate(part))
    return sign * (m.rate or 0.0), sign * read, density / float(part.seconds.sum()) ** 0.5


def _refused(one: Rotation, why: str, stated: float | None, ratio: float) -> Rotation:
    said = degrees(stated or 0.0)
    why = why.format(read=significant(ratio * said, 4), stated=significant(said, 4))
    return replace(one, refusal=why, off_ratio=ratio)


def mean_rate(part: Blocks) -> Array:
    """The mean reading of the gyros in some blocks, rad/s, (3,)."""
    return np.asarray(np.average(part.gyro, weights=part.counts, axis=0))


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
        mean=mean_rate(part),
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
