"""The rate segments of a campaign as inputs of the equations of the gyros."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from inertial.campaign.encoder import by_windows
from inertial.campaign.noise_levels import NoiseLevels
from inertial.campaign.recorded_turns import Rotation, gaps_of, mean_rate, recorded_turns, sigma_of
from inertial.campaign.records import Manoeuvre, Part
from inertial.campaign.static_positions import StaticPosition, level_axes_of, stretch_of
from inertial.estimation.gyroscope_observations import (
    Earth,
    Position,
    RateSegment,
    StaticRate,
    SteadyRate,
    WholeTurn,
)
from inertial.estimation.noise_model import SQRT2, sigma_of_mean
from inertial.estimation.turning_noise import with_turning_noise
from inertial.physics.motion import horizontal, north_of
from inertial.tables import GYRO

if TYPE_CHECKING:
    from inertial.campaign.campaign_data import CampaignData


@dataclass(frozen=True)
class GyroInputs:
    """The inputs of the equations of the gyros, of one mount."""

    static_positions: list[StaticPosition]
    recorded: list[Rotation]
    turns: list[RateSegment]  # from rest to rest, with their angle known
    steady_rates: list[SteadyRate]  # at a known rate
    # As the joint fit takes them: windows of the encoder where that gives parts of turns.
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
        turns = [r.plan for r in self.recorded if not r.refusal or r.in_part]
        return [s.part for s in self.static_positions] + [Part(plan.name) for plan in turns]

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
        return [static_rate_of(rest, self.heading, seconds) for rest in self.static_positions]


def gyro_inputs(data: "CampaignData") -> GyroInputs:
    """Gather the static positions and rate segments of one mount."""
    positions, left_out = data.gyro_positions
    recorded = recorded_turns(data)
    usable = [rotation for rotation in recorded if not rotation.refusal]
    given = (data.noise, data.heading, data.rate_sigma)
    shared = data.shared_clock
    angle_sigma = data.known["turn_angle"].scatter if "turn_angle" in data.known else 0.0

    def whole(r: Rotation) -> RateSegment:
        return replace(rate_segment_of(r, *given), stretch=stretch_of(r.plan, r.blocks, shared))

    turned = [r for r in usable if r.plan.recorded == "whole"]
    rests = [static_rate_of(rest, data.heading, np.inf) for rest in positions]
    turns = with_turning_noise([whole(r) for r in turned], rests)
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
    refused = [r for r in recorded if r.refusal and not r.in_part]
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
        left_out + [Part(r.plan.name, None, r.refusal) for r in refused],
    )


def position_of(m: Manoeuvre, heading: float | None) -> Position:
    """The set position of a manoeuvre; north is known where mark and heading are.

    The axis of a tumble is level and stays where it is, so its rests share the azimuth of it.
    """
    up = m.up
    if up is None:
        return Position(m.position, np.zeros(3))
    if m.mark is None and m.tumble is not None and m.tumble_axis is not None:
        return Position(m.position, up, horizontal(m.tumble_axis, up), azimuth=m.tumble)
    if m.mark is None and m.turned_on:
        return Position(m.position, up, mark=level_axes_of(m)[0], azimuth=m.position)
    if m.mark is None:
        return Position(m.position, up)
    mark = horizontal(m.mark, up)
    if heading is None:
        return Position(m.position, up, mark=mark)
    return Position(m.position, up, north=north_of(up, mark, heading))


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
        position = Position(position.name, position.up, azimuth=f"{m.name}, on the way")
    return RateSegment(
        position=position,
        about=m.axis,
        angle=np.nan if m.angle is None else m.angle,
        angle_sigma=np.nan if m.angle_sigma is None else m.angle_sigma,
        sums=part.gyro * part.seconds[:, None],
        seconds=part.seconds,
        density=noise.of(m.name, "steady", GYRO),
        quiet_density=noise.of(m.name, "rest", GYRO),
        quantisation=noise.quantisation("gyro"),
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
    """A turn at a known rate by the mean of its steady part; arguments as of `rate_segment_of`.

    What is stated of the rates of a table holds for each of them and for what they have in common;
    a rate that was measured has a sigma of its own alone.
    """
    m, part = rotation.plan, rotation.steady
    assert m.rate is not None  # the plan requires a rate of such a turn
    ends = np.cumsum(part.seconds + part.missing) - part.missing[0]
    stated = abs(m.rate) * rate_sigma
    return SteadyRate(
        position=position_of(m, heading),
        about=m.axis,
        rate=m.rate,
        rate_sigma=stated if m.rate_sigma is None else m.rate_sigma,
        seconds=part.seconds,
        elapsed=ends - part.seconds / 2,
        mean=mean_rate(part),
        sigma=sigma_of_mean(
            noise.of(m.name, "steady", GYRO), noise.quantisation("gyro"), part.seconds.sum()
        ),
        table_rate_sigma=stated if m.rate_sigma is None else 0.0,
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
        angle_sigma=float(np.hypot(m.angle_sigma, SQRT2 * noise.quantisation("gyro")[i])),
        seconds=float(rotation.weights @ part.seconds),
        up=float(m.up[i]),
        density=float(noise.of(m.name, "rest", GYRO)[i]),
        clock=m.log,
        clock_sigma=rotation.clock_sigma,
    )
