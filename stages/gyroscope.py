"""The gyros from turns and rests: bias, scale factors, cross terms, mounting, with covariance."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from math import cos, degrees, sin

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts import tables
from stages.contracts.records import (
    Manoeuvre,
    Performed,
    known_of,
    manoeuvres_of,
    performed_of,
)
from stages.contracts.stage import Stage, Tables
from stages.estimation.estimates import Estimates, by_mount, reasons
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.stills import Still, averaging_times, stills
from stages.inference import whole_turns
from stages.inference.least_squares import with_scatter
from stages.inference.whole_turns import Angle, Earth, Position, Steady, Turn, joint

Array = NDArray[np.float64]

GYRO = [f"gyro_{axis}" for axis in tables.AXES]
CURES = {
    "bias": "neither a rest nor a turn there and back shows it: add a rest",
    "matrix": "no whole turn about {axis} was recorded: add one of 360° about {axis}",
}
SCATTER = (1e-11, 0.1)  # rad/s: how much manoeuvres may differ beyond the noise
TURNING = ("spin-up", "steady", "spin-down", "turning")


@dataclass(frozen=True)
class Recorded:
    """A turn of the plan, what was recorded of it, its blocks in motion, and why it is refused."""

    plan: Manoeuvre
    done: Performed
    blocks: pd.DataFrame
    refusal: str  # empty where it can be used


def gyroscope(
    blocks: pd.DataFrame,
    manoeuvres: pd.DataFrame,
    performed: pd.DataFrame,
    noise: pd.DataFrame,
    known: pd.DataFrame,
    *,
    averaging_steps: int,
) -> Tables:
    """Parameters of the joint estimate and of S0's turns of a known angle, with covariance.

    Each mount has parameters of its own, for its mounting rotation is one of them.
    """
    given, done, levels = known_of(known), performed_of(performed), NoiseLevels(noise)
    up, level = given["earth_rate_up"], given["earth_rate_level"]
    earth = Earth(up.number, up.scatter, level.number)
    heading, rate_sigma = given["heading"].value, given["turn_rate"].scatter
    estimates = Estimates("gyroscope")
    for suffix, plan in by_mount(manoeuvres_of(manoeuvres)):
        found, left = stills(blocks, plan, done, levels, "gyro")
        recorded = _recorded(blocks, plan, done)
        left += [f"{one.plan.name}: {one.refusal}" for one in recorded if one.refusal]
        usable = [one for one in recorded if not one.refusal]
        if not (found or usable):
            estimates.add_nothing(f"joint{suffix}", "; ".join(left))
            continue
        whole = [_turn(r, levels, heading) for r in usable if r.plan.recorded == "whole"]
        steady = [
            _steady(r, levels, heading, rate_sigma) for r in usable if r.plan.recorded == "steady"
        ]
        moving = (whole, steady, earth, given["position"].scatter)
        rests = [_still(still, heading) for still in found]
        fitted = with_scatter(
            partial(joint, rests, *moving), between=SCATTER, noise_degrees=levels.degrees
        )
        why = reasons(fitted.estimate.determined, _channels(rests, moving), "gyro", CURES)
        estimates.add_triad(f"joint{suffix}", fitted.estimate, why)
        used = [still.label for still in found] + [one.plan.name for one in usable]
        estimates.add_fit(f"joint{suffix}", fitted, used, left)
        for seconds in averaging_times(found, averaging_steps):
            part = [_still(still, heading, seconds) for still in found]
            shorter = joint(part, *moving, fitted.scatter, start=fitted.estimate)
            estimates.add_averaging(f"joint{suffix}", seconds, shorter)
        _add_known_angle(estimates, f"turns{suffix}", recorded, levels, earth, fitted.scatter)
    return estimates.tables()


def _channels(
    rests: Sequence[whole_turns.Still], moving: tuple[list[Turn], list[Steady], Earth, float]
) -> NDArray[np.bool_]:
    """Which gyros are in the logs, (3,)."""
    turns, steadies, _, _ = moving
    readings = [rest.mean for rest in rests] + [steady.mean for steady in steadies]
    readings += [turn.sums.sum(axis=0) for turn in turns]
    return np.asarray(np.isfinite(np.array(readings)).any(axis=0))


# ---- turns and rests as the inference takes them


def _recorded(
    blocks: pd.DataFrame, plan: Sequence[Manoeuvre], done: dict[str, Performed]
) -> list[Recorded]:
    moving = dict(list(blocks[blocks["phase"].isin(TURNING)].groupby("manoeuvre")))
    result = []
    for m in plan:
        if m.do == "turn":
            part = moving.get(m.name, blocks.iloc[:0])
            result.append(Recorded(m, done[m.name], part, _refusal(m, done[m.name], part)))
    return result


def _refusal(m: Manoeuvre, done: Performed, part: pd.DataFrame) -> str:
    """Why a turn cannot be used; empty where it can."""
    if not done.found:
        return "not found in its log"
    if m.up is None:
        return "which way is up is not known"
    if part.empty or part["seconds"].isna().any() or bool((part["count"] == 0).any()):
        return "it has no time, so no angle can be summed"
    if m.recorded == "steady":
        return "" if bool((part["phase"] == "steady").any()) else "no steady rate was found"
    if not done.complete:
        return f"the angle method needs the whole turn, and {done.sentence}"
    if m.angle is None or m.angle_sigma is None:
        return "its angle is not stated"
    if done.angle is None or done.angle * m.angle < 0:
        return f"it turned by {degrees(done.angle or 0.0):.1f}°, against the plan"
    return ""


def _position(m: Manoeuvre, heading: float | None) -> Position:
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
    return Position(m.position, up, north=cos(heading) * mark + sin(heading) * np.cross(up, mark))


def _still(still: Still, heading: float | None, seconds: float = np.inf) -> whole_turns.Still:
    position = _position(still.manoeuvre, heading)
    return whole_turns.Still(position, *still.over(seconds), still.about, still.angle)


def _turn(one: Recorded, noise: NoiseLevels, heading: float | None) -> Turn:
    m, part = one.plan, one.blocks
    assert m.angle is not None and m.angle_sigma is not None  # else it is refused
    seconds = part["seconds"].to_numpy(np.float64)
    return Turn(
        position=_position(m, heading),
        about=m.axis,
        angle=m.angle,
        angle_sigma=m.angle_sigma,
        sums=part[GYRO].to_numpy(np.float64) * seconds[:, None],
        seconds=seconds,
        density=noise.of(m.name, "steady", GYRO),
        quiet_density=noise.of(m.name, "rest", GYRO),
        by_hand=bool((part["phase"] == "turning").any()),
    )


def _steady(one: Recorded, noise: NoiseLevels, heading: float | None, rate_sigma: float) -> Steady:
    m, part = one.plan, one.blocks[one.blocks["phase"] == "steady"]
    assert m.rate is not None  # the plan wants a rate of such a turn
    seconds = float(part["seconds"].sum())
    return Steady(
        position=_position(m, heading),
        about=m.axis,
        rate=m.rate,
        rate_sigma=abs(m.rate) * rate_sigma,
        seconds=seconds,
        mean=np.average(part[GYRO].to_numpy(np.float64), weights=part["count"], axis=0),
        sigma=noise.of(m.name, "steady", GYRO) / np.sqrt(seconds),
    )


def _add_known_angle(
    estimates: Estimates,
    method: str,
    recorded: Sequence[Recorded],
    noise: NoiseLevels,
    earth: Earth,
    scatter: float,
) -> None:
    """S0's formulas, axis by axis: they need whole turns both ways about the axis that is up."""
    for i, axis in enumerate(tables.AXES):
        own = [r for r in recorded if abs(r.plan.axis[i]) > 1 - 1e-9 and r.plan.recorded == "whole"]
        angles = [_angle(r, i, noise) for r in own if not r.refusal and _upright(r.plan, i)]
        turns = [turn for turn in angles if np.isfinite(turn.summed)]
        names = (f"bias_{axis}", f"scale_{axis}")
        if len({np.sign(turn.angle) for turn in turns}) == 2:
            estimate = whole_turns.known_angle(turns, earth, scatter)
            estimates.add(method, names, estimate.values[:2], estimate.covariance[:2, :2], {})
        elif own:
            reason = f"the formula needs whole turns about {axis} forward and backward"
            refused = [r.plan.name for r in own if r.refusal]
            reason += f"; not whole: {', '.join(refused)}" if refused else ""
            nothing = (np.zeros(2), np.zeros((2, 2)))
            estimates.add(method, names, *nothing, dict.fromkeys(names, reason))


def _upright(m: Manoeuvre, i: int) -> bool:
    """Whether body axis i points up or down."""
    return m.up is not None and abs(float(m.up[i])) > 1 - 1e-9


def _angle(one: Recorded, i: int, noise: NoiseLevels) -> Angle:
    m, part = one.plan, one.blocks
    assert m.up is not None and m.angle is not None and m.angle_sigma is not None  # else refused
    return Angle(
        summed=float((part[GYRO[i]] * part["seconds"]).sum()),
        angle=m.angle * float(m.axis[i]),
        angle_sigma=m.angle_sigma,
        seconds=float(part["seconds"].sum()),
        up=float(m.up[i]),
        density=float(noise.of(m.name, "rest", GYRO)[i]),
    )


STAGE = Stage(
    gyroscope,
    reads={
        "blocks": tables.BLOCKS,
        "manoeuvres": tables.MANOEUVRES,
        "performed": tables.PERFORMED,
        "noise": tables.NOISE,
        "known": tables.KNOWN,
    },
    writes={
        "parameters": tables.PARAMETERS,
        "covariance": tables.COVARIANCE,
        "fit": tables.FIT,
        "averaging": tables.AVERAGING,
    },
)

if __name__ == "__main__":
    STAGE.command_line()
