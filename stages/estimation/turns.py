"""Rests and turns as the equations of the gyros take them, and which turns are refused."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import cos, degrees, sin

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts.records import Known, Manoeuvre, Performed
from stages.contracts.tables import GYRO
from stages.estimation.blocks import NONE, Blocks, by_manoeuvre
from stages.estimation.bridging import bridges, sigma_of
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.stills import Still, stills, stretch_of
from stages.inference import whole_turns
from stages.inference.whole_turns import Angle, Earth, Position, Steady, Turn
from stages.model.vectors import cross

Array = NDArray[np.float64]

TURNING = ("spin-up", "steady", "spin-down", "turning")


@dataclass(frozen=True)
class Recorded:
    """A turn of the plan, what was recorded of it, its blocks in motion, and why it is refused."""

    plan: Manoeuvre
    done: Performed
    blocks: Blocks
    refusal: str  # empty where it can be used

    @property
    def steady(self) -> Blocks:
        """Its blocks at the steady rate."""
        return self.blocks.those(self.blocks.steady)


@dataclass(frozen=True)
class GyroInputs:
    """All that a campaign gives the equations of the gyros, of one mount."""

    stills: list[Still]
    recorded: list[Recorded]
    turns: list[Turn]  # from rest to rest, with their angle known
    steadies: list[Steady]  # at a known rate
    earth: Earth
    position_sigma: float
    heading: float | None
    left_out: list[str]  # manoeuvres, each with the reason

    @property
    def usable(self) -> list[Recorded]:
        """The turns that are not refused."""
        return [one for one in self.recorded if not one.refusal]

    @property
    def used(self) -> list[str]:
        """Names of all that is used."""
        return [s.label for s in self.stills] + [one.plan.name for one in self.usable]

    @property
    def nothing(self) -> bool:
        """Whether there is neither a rest nor a turn."""
        return not (self.stills or self.turns or self.steadies)

    @cached_property
    def rests(self) -> list[whole_turns.Still]:
        """The rests as the equations have them."""
        return self.first_of_rests(np.inf)

    def first_of_rests(self, seconds: float) -> list[whole_turns.Still]:
        """The same of the first seconds of each."""
        return [still_of(still, self.heading, seconds) for still in self.stills]


def gyro_inputs(
    blocks: pd.DataFrame,
    plan: Sequence[Manoeuvre],
    done: Mapping[str, Performed],
    levels: NoiseLevels,
    known: Mapping[str, Known],
    shared_clock: bool = False,
) -> GyroInputs:
    """Gather the rests and turns of one mount; `shared_clock` as in `stills`."""
    found, left = stills(blocks, plan, done, levels, "gyro", shared_clock)
    recorded = recorded_turns(blocks, plan, done)
    left += [f"{one.plan.name}: {one.refusal}" for one in recorded if one.refusal]
    heading, rate_sigma = known["heading"].value, known["turn_rate"].scatter
    usable = [one for one in recorded if not one.refusal]
    up, level = known["earth_rate_up"], known["earth_rate_level"]
    given = (levels, heading, rate_sigma)
    return GyroInputs(
        found,
        recorded,
        [
            replace(turn_of(r, *given), stretch=stretch_of(r.plan.name, r.blocks, shared_clock))
            for r in usable
            if r.plan.recorded == "whole"
        ],
        [
            replace(steady_of(r, *given), stretch=stretch_of(r.plan.name, r.steady, shared_clock))
            for r in usable
            if r.plan.recorded == "steady"
        ],
        Earth(up.number, up.scatter, level.number),
        known["position"].scatter,
        heading,
        left,
    )


def recorded_turns(
    blocks: pd.DataFrame, plan: Sequence[Manoeuvre], done: Mapping[str, Performed]
) -> list[Recorded]:
    """Every turn of the plan."""
    moving = by_manoeuvre(blocks[blocks["phase"].isin(TURNING)])
    result = []
    for m in plan:
        if m.do == "turn":
            part = moving.get(m.name, NONE)
            result.append(Recorded(m, done[m.name], part, refusal_of(m, done[m.name], part)))
    return result


def refusal_of(m: Manoeuvre, done: Performed, part: Blocks) -> str:
    """Why a turn cannot be used; empty where it can."""
    if not done.found:
        return "not found in its log"
    if m.up is None:
        return "which way is up is not known"
    if not len(part) or np.isnan(part.seconds).any() or bool((part.counts == 0).any()):
        return "it has no time, so no angle can be summed"
    if m.recorded == "steady":
        return "" if bool(part.steady.any()) else "no steady rate was found"
    if not (done.complete or done.bridged):
        return f"the angle method needs the whole turn, and {done.sentence}"
    if m.angle is None or m.angle_sigma is None:
        return "its angle is not stated"
    if done.angle is None or done.angle * m.angle < 0:
        return f"it turned by {degrees(done.angle or 0.0):.1f}°, against the plan"
    return ""


def position_of(m: Manoeuvre, heading: float | None) -> Position:
    """The set position of a manoeuvre; north is known where mark and heading are."""
    up = m.up
    assert up is not None  # else it is refused
    if m.mark is None:
        return Position(m.position, up)
    mark = m.mark - up * (up @ m.mark)
    mark = mark / np.linalg.norm(mark)
    if heading is None:
        return Position(m.position, up, mark=mark)
    # The azimuth counts clockwise, so north lies counter-clockwise of the mark, seen from above.
    return Position(m.position, up, north=cos(heading) * mark + sin(heading) * cross(up, mark))


def still_of(still: Still, heading: float | None, seconds: float) -> whole_turns.Still:
    """A rest, or its first seconds."""
    position = position_of(still.manoeuvre, heading)
    mean, sigma = still.over(seconds)
    stretch = still.during(seconds)
    return whole_turns.Still(position, mean, sigma, still.about, still.angle, stretch=stretch)


def turn_of(one: Recorded, noise: NoiseLevels, heading: float | None, rate_sigma: float) -> Turn:
    """A turn from rest to rest with its blocks in motion; what is missing of it is bridged.

    `rate_sigma`: relative, of the table's rate.
    """
    m, part = one.plan, one.blocks
    missing = bridges(part)
    assert m.angle is not None and m.angle_sigma is not None  # else it is refused
    return Turn(
        position=position_of(m, heading),
        about=m.axis,
        angle=m.angle,
        angle_sigma=m.angle_sigma,
        sums=part.gyro * part.seconds[:, None],
        seconds=part.seconds,
        density=noise.of(m.name, "steady", GYRO),
        quiet_density=noise.of(m.name, "rest", GYRO),
        by_hand=bool((part.phase == "turning").any()),
        bridges=missing,
        bridged_sigma=sigma_of(part, missing, m.axis, m.name, noise, rate_sigma),
        unsteady=np.flatnonzero(~part.steady).tolist() if noise.rings(m.name, GYRO) else (),
    )


def steady_of(
    one: Recorded, noise: NoiseLevels, heading: float | None, rate_sigma: float
) -> Steady:
    m, part = one.plan, one.steady
    assert m.rate is not None  # the plan wants a rate of such a turn
    ends = np.cumsum(part.seconds + part.missing) - part.missing[0]
    return Steady(
        position=position_of(m, heading),
        about=m.axis,
        rate=m.rate,
        rate_sigma=abs(m.rate) * rate_sigma,
        seconds=part.seconds,
        elapsed=ends - part.seconds / 2,
        mean=np.average(part.gyro, weights=part.counts, axis=0),
        sigma=noise.of(m.name, "steady", GYRO) / np.sqrt(part.seconds.sum()),
    )


def angles_about(inputs: GyroInputs, i: int, noise: NoiseLevels) -> list[tuple[str, Angle]]:
    """The whole turns about body axis i while it points up or down, as their own gyro saw them.

    Each with the name of its manoeuvre. A turn that is bridged is not whole.
    """
    recorded = [r for r in inputs.usable if r.plan.recorded == "whole" and r.done.complete]
    whole = [r for r in recorded if _upright(r.plan, i)]
    angles = [(r.plan.name, _angle(r, i, noise)) for r in whole]
    return [(name, angle) for name, angle in angles if np.isfinite(angle.summed)]


def _upright(m: Manoeuvre, i: int) -> bool:
    """Whether a turn is about body axis i, and that axis points up or down."""
    up = m.up is not None and abs(float(m.up[i])) > 1 - 1e-9
    return up and abs(float(m.axis[i])) > 1 - 1e-9


def _angle(one: Recorded, i: int, noise: NoiseLevels) -> Angle:
    m, part = one.plan, one.blocks
    assert m.up is not None and m.angle is not None and m.angle_sigma is not None  # else refused
    return Angle(
        summed=float((part.gyro[:, i] * part.seconds).sum()),
        angle=m.angle * float(m.axis[i]),
        angle_sigma=m.angle_sigma,
        seconds=float(part.seconds.sum()),
        up=float(m.up[i]),
        density=float(noise.of(m.name, "rest", GYRO)[i]),
    )
