"""The gyros from turns and rests: bias, scale factors, cross terms, mounting, with covariance."""

from collections.abc import Iterator
from math import cos, degrees, sin
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts import tables
from stages.contracts.stage import Stage, Tables
from stages.estimation.estimates import Estimates, reasons
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.stills import Still, averaging_times, stills, vector
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
    given = known.set_index("quantity")
    up, up_sigma = (float(given.loc["earth_rate_up", c]) for c in ("value", "sigma"))
    earth = Earth(up, up_sigma, float(given.loc["earth_rate_level", "value"]))
    heading = given.loc["heading", "value"]
    tilt = float(given.loc["position", "sigma"])
    rate_sigma = float(given.loc["turn_rate", "sigma"])
    levels = NoiseLevels(noise)
    estimates = Estimates("gyroscope")
    for mount, plan in manoeuvres.groupby("mount", sort=False):
        suffix = "" if manoeuvres["mount"].nunique() == 1 else f"@{mount}"
        found, left = stills(blocks, plan, performed, levels, "gyro")
        rows = list(_recorded_turns(blocks, plan, performed))
        turns, steadies, refused = _turns(rows, levels, heading, rate_sigma)
        if not (found or turns or steadies):
            estimates.add_nothing(f"joint{suffix}", "; ".join([*left, *refused.values()]))
            continue
        moving = (turns, steadies, earth, tilt)
        resting = [_still(still, heading) for still in found]
        fitted = with_scatter(
            lambda scatter, resting=resting, moving=moving: joint(resting, *moving, scatter),
            SCATTER,
            levels.degrees,
        )
        estimate, scatter, _ = fitted
        readings = [s.over()[0] for s in found] + [t.sums.sum(axis=0) for t in turns]
        readings += [steady.mean for steady in steadies]
        recorded = np.isfinite(readings).any(axis=0)
        why = reasons(estimate.determined, recorded, "gyro", CURES)
        estimates.add_triad(f"joint{suffix}", estimate, why)
        used = [still.label for still in found]
        used += [row["manoeuvre"] for row, _ in rows if row["manoeuvre"] not in refused]
        left += [f"{name}: {reason}" for name, reason in refused.items()]
        estimates.add_fit(f"joint{suffix}", fitted, used, left)
        for seconds in averaging_times(found, averaging_steps):
            part = [_still(still, heading, seconds) for still in found]
            shorter = joint(part, *moving, scatter, start=estimate)
            estimates.add_averaging(f"joint{suffix}", seconds, shorter)
        _add_known_angle(estimates, f"turns{suffix}", rows, refused, levels, earth, scatter)
    return estimates.tables()


def _position(row: dict[str, Any], up: Array, heading: float | None) -> Position:
    """The set position of a manoeuvre; north is known where mark and heading are."""
    mark = vector(row, "mark")
    if mark is None:
        return Position(row["position"], up)
    mark = mark - up * (up @ mark)
    mark = mark / np.linalg.norm(mark)
    if heading is None or pd.isna(heading):
        return Position(row["position"], up, mark=mark)
    # The azimuth counts clockwise, so north lies counter-clockwise of the mark, seen from above.
    north = cos(heading) * mark + sin(heading) * np.cross(up, mark)
    return Position(row["position"], up, north=north)


def _still(still: Still, heading: float | None, seconds: float = np.inf) -> whole_turns.Still:
    position = _position(still.row, still.up, heading)
    return whole_turns.Still(position, *still.over(seconds), still.about, still.angle)


def _recorded_turns(
    blocks: pd.DataFrame, plan: pd.DataFrame, performed: pd.DataFrame
) -> Iterator[tuple[dict[str, Any], pd.DataFrame]]:
    """Every turn of the plan with what was performed of it, and its blocks in motion."""
    moving = dict(list(blocks[blocks["phase"].isin(TURNING)].groupby("manoeuvre")))
    for row in plan.merge(performed, on="manoeuvre", suffixes=("", "_done")).to_dict("records"):
        if row["do"] == "turn":
            yield row, moving.get(row["manoeuvre"], blocks.iloc[:0])


def _turns(
    rows: list[tuple[dict[str, Any], pd.DataFrame]],
    noise: NoiseLevels,
    heading: float | None,
    rate_sigma: float,
) -> tuple[list[Turn], list[Steady], dict[str, str]]:
    """Turns of a known angle, turns of a known rate, and those that are neither, with the reason."""
    turns: list[Turn] = []
    steadies: list[Steady] = []
    refused: dict[str, str] = {}
    for row, part in rows:
        name, about, up = row["manoeuvre"], vector(row, "about"), vector(row, "up")
        assert about is not None  # the plan refuses a turn without an axis
        steady_only = row["recorded"] == "steady"
        reason = _refusal(row, part, up)
        if reason:
            refused[name] = reason
            continue
        assert up is not None  # else refused
        position = _position(row, up, heading)
        resting = noise.of(name, "rest", GYRO)
        turning = noise.of(name, "steady", GYRO)
        if steady_only:
            part = part[part["phase"] == "steady"]
            seconds = float(part["seconds"].sum())
            mean = np.average(part[GYRO], weights=part["count"], axis=0)
            sigma = turning / np.sqrt(seconds)
            rate = float(row["rate"])
            steadies.append(
                Steady(position, about, rate, abs(rate) * rate_sigma, seconds, mean, sigma)
            )
        else:
            seconds_of = part["seconds"].to_numpy()
            sums = part[GYRO].to_numpy() * seconds_of[:, None]
            angle = (float(row["angle"]), float(row["angle_sigma"]))
            by_hand = bool((part["phase"] == "turning").any())
            turns.append(Turn(position, about, *angle, sums, seconds_of, turning, resting, by_hand))
    return turns, steadies, refused


def _refusal(row: dict[str, Any], part: pd.DataFrame, up: Array | None) -> str:
    """Why a turn cannot be used; empty where it can."""
    if not row["found"]:
        return "not found in its log"
    if up is None:
        return "which way is up is not known"
    if part.empty or part["seconds"].isna().any() or (part["count"] == 0).any():
        return "it has no time, so no angle can be summed"
    if row["recorded"] == "steady":
        return "" if (part["phase"] == "steady").any() else "no steady rate was found"
    if not row["complete"]:
        return f"the angle method needs the whole turn, and {row['sentence']}"
    if pd.isna(row["angle"]):
        return "its angle is not stated"
    if (row["angle_done"] > 0) != (row["angle"] > 0):
        return f"it turned by {degrees(row['angle_done']):.1f}°, against the plan"
    return ""


def _add_known_angle(
    estimates: Estimates,
    method: str,
    rows: list[tuple[dict[str, Any], pd.DataFrame]],
    refused: dict[str, str],
    noise: NoiseLevels,
    earth: Earth,
    scatter: float,
) -> None:
    """S0's formulas, axis by axis: they need whole turns both ways about the axis that is up."""
    for i, axis in enumerate(tables.AXES):
        turns = []
        for row, part in rows:
            about, up = vector(row, "about"), vector(row, "up")
            whole = row["manoeuvre"] not in refused and row["recorded"] == "whole"
            if (
                not whole
                or about is None
                or up is None
                or min(abs(about[i]), abs(up[i])) < 1 - 1e-9
            ):
                continue
            seconds = float(part["seconds"].sum())
            turns.append(
                Angle(
                    summed=float((part[GYRO[i]] * part["seconds"]).sum()),
                    angle=float(row["angle"] * about[i]),
                    angle_sigma=float(row["angle_sigma"]),
                    seconds=seconds,
                    up=float(up[i]),
                    density=float(noise.of(row["manoeuvre"], "rest", GYRO)[i]),
                )
            )
        turns = [turn for turn in turns if np.isfinite(turn.summed)]
        names = (f"bias_{axis}", f"scale_{axis}")
        if len({np.sign(turn.angle) for turn in turns}) == 2:
            estimate = whole_turns.known_angle(turns, earth, scatter)
            estimates.add(method, names, estimate.values[:2], estimate.covariance[:2, :2], {})
        elif any(about_axis(row, i) for row, _ in rows):
            missing = [n for n in refused if about_axis_named(rows, n, i)]
            reason = f"the formula needs whole turns about {axis} forward and backward"
            reason += f"; not whole: {', '.join(missing)}" if missing else ""
            nothing = (np.zeros(2), np.zeros((2, 2)))
            estimates.add(method, names, *nothing, dict.fromkeys(names, reason))


def about_axis(row: dict[str, Any], i: int) -> bool:
    """Whether a turn of the plan is about body axis i."""
    about = vector(row, "about")
    return about is not None and abs(about[i]) > 1 - 1e-9


def about_axis_named(rows: list[tuple[dict[str, Any], pd.DataFrame]], name: str, i: int) -> bool:
    """Whether the turn `name` is about body axis i."""
    return any(row["manoeuvre"] == name and about_axis(row, i) for row, _ in rows)


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
