"""The motions from each static position of unknown attitude to the next.

A motion is the blocks of phase `between`, one for each record, from the end of a rest to the
beginning of the next one in the same log. A few samples that are lost or masked here and there are
interpolated between those beside them; where more are missing, no attitude can be carried through.
Nor through a walk with the IMU between two rests: its errors, of vibration and of rates that change
between samples, are none that the other motions show.

The positions get the attitude that the accelerometers give them, so that every later stage has a
plan of rests that each have an upward direction. The azimuth stays unknown, and so does the tilt:
the direction is that of the readings themselves.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.noise_levels import NoiseLevels
from inertial.campaign.records import Clock, Manoeuvre, Part, Performed
from inertial.campaign.unknown_attitude import FreeStaticPosition, free_static_positions
from inertial.estimation.attitude import Passage
from inertial.estimation.between_positions import Stop
from inertial.physics.forward import Triad
from inertial.signal.runs import MAX_LOST_RUN
from inertial.tables import GYRO
from inertial.text.messages import _

if TYPE_CHECKING:
    from inertial.campaign.campaign_data import CampaignData

BETWEEN = "between"  # phase of the blocks from one rest to the next
MAX_LOST_SHARE = 0.1  # of a motion
LONG_PATH, TIMES_USUAL = 6 * np.pi, 5  # rad, and times the usual path, of what is no move by hand


@dataclass(frozen=True)
class RecordedPassage:
    """A motion, its place in the tables, and the time, s, and temperature, K, of each record."""

    part: Part
    log: str
    passage: Passage
    time: Array
    temperature: Array


def passages_of(
    positions: Sequence[FreeStaticPosition],
    blocks: pd.DataFrame,
    noise: NoiseLevels,
    clocks: Mapping[str, Clock],
) -> tuple[list[RecordedPassage], list[Part]]:
    """The motions from each rest to the next, and those left out with the reason."""
    moving = blocks[blocks["phase"] == BETWEEN].sort_values(["log", "from_record"])
    passages: list[RecordedPassage] = []
    left_out: list[Part] = []
    for i, (before, behind) in enumerate(pairwise(positions)):
        if before.log != behind.log:
            continue
        name = f"{before.label} to {behind.label}"
        inside = (moving["from_record"] >= before.after) & (moving["to_record"] <= behind.first)
        part = moving[inside & (moving["log"] == before.log)]
        density = noise.of(name, "rest", GYRO)
        if refusal := refusal_of(part, before, behind, density):
            left_out.append(Part(name, BETWEEN, refusal))
            continue
        part = _interpolated(part)
        seconds, time, temperature = (
            part[column].to_numpy(np.float64) for column in ("seconds", "time", "temperature")
        )
        rates, clock = part[GYRO].to_numpy(np.float64), clocks.get(before.log)
        timed = 0.0 if clock is None else clock.sigma
        passage = Passage(i, rates, seconds, density, before.log, timed)
        own = Part(name, BETWEEN)
        passages.append(RecordedPassage(own, before.log, passage, time, temperature))
    return without_walks(passages, left_out)


def without_walks(
    passages: Sequence[RecordedPassage], left_out: Sequence[Part]
) -> tuple[list[RecordedPassage], list[Part]]:
    """Without the motions on a path far longer than that of the others."""
    paths = [each.passage.path for each in passages]
    most = max(LONG_PATH, TIMES_USUAL * float(np.median(paths))) if paths else LONG_PATH
    walks = [
        Part(
            each.part.manoeuvre,
            BETWEEN,
            _(
                "it turns to and fro by {turned:.0f}° altogether, several times as far as from one "
                "position to the next, so no attitude is carried through",
                turned=np.degrees(path),
            ),
        )
        for each, path in zip(passages, paths, strict=True)
        if path > most
    ]
    kept = [each for each, path in zip(passages, paths, strict=True) if path <= most]
    return kept, [*left_out, *walks]


def refusal_of(
    part: pd.DataFrame, before: FreeStaticPosition, behind: FreeStaticPosition, density: Array
) -> str:
    """Why no attitude can be carried from one rest to the next; empty where it can."""
    if part.empty:
        return _("the motion between them is not recorded")
    ends = np.append(before.after, part["to_record"].to_numpy(np.int64))
    starts = np.append(part["from_record"].to_numpy(np.int64), behind.first)
    timed = np.append(part["missing_s"].to_numpy(np.float64), 0.0) != 0
    masked = int(np.where(timed, 0, starts - ends).max())
    if masked > MAX_LOST_RUN:  # fewer repeat one another, which takes no time
        return _(
            "{masked} records are masked while it moves, so no attitude is carried through",
            masked=masked,
        )
    lost = part["missing_s"].to_numpy(np.float64)
    step = float(part["seconds"].sum() / part["count"].sum())
    long = lost.max() > (MAX_LOST_RUN + 0.5) * step or lost.min() < -step / 2
    if long or lost.sum() > MAX_LOST_SHARE * float(part["seconds"].sum()):
        return _(
            "{lost:.2f} s of readings are lost or masked while it moves, up to {longest:.2f} s in "
            "one piece, so no attitude is carried through",
            lost=float(np.abs(lost).sum()),
            longest=float(np.abs(lost).max()),
        )
    if not np.isfinite(density).all() or part[[*GYRO, "seconds"]].isna().any(axis=None):
        return _("all three gyros and the time are needed to carry an attitude through")
    return ""


def _interpolated(part: pd.DataFrame) -> pd.DataFrame:
    """The blocks with one in each hole, between those beside it."""
    holes = np.flatnonzero(part["missing_s"].to_numpy(np.float64) > 0)
    if not len(holes):
        return part
    columns = [*GYRO, "seconds", "time", "temperature"]
    values = part[columns].to_numpy(np.float64)
    between = (values[holes - 1] + values[holes]) / 2
    between[:, columns.index("seconds")] = part["missing_s"].to_numpy(np.float64)[holes]
    return pd.DataFrame(np.insert(values, holes, between, axis=0), columns=columns)


# ---- The plan of rests that the attitudes by the accelerometers make.


@dataclass(frozen=True)
class Handled:
    """The positions of a session by hand in their order, and the motions between them."""

    stops: list[Stop]
    passages: list[RecordedPassage]


def with_attitudes(data: "CampaignData", accelerometer: Triad) -> "CampaignData":
    """The campaign with each of its static positions as a rest of the plan."""
    positions, _ = free_static_positions(data)
    if not positions:
        return data
    moving, _ = passages_of(positions, data.blocks, data.noise, data.clocks)
    blocks = data.blocks.copy()
    for position in positions:
        part = position.force.part
        own = (blocks["manoeuvre"] == part.manoeuvre) & (blocks["phase"] == part.phase)
        blocks.loc[own, ["manoeuvre", "phase"]] = [position.label, "rest"]
    turns = [m for m in data.plan if m.do == "turn" and m.up is not None]
    done = {position.label: Performed(position.label, "") for position in positions}
    return replace(
        data,
        plan=[*(_rest(position, accelerometer) for position in positions), *turns],
        performed={**data.performed, **done},
        blocks=blocks,
        by_hand=Handled([position.stop for position in positions], moving),
    )


def _rest(position: FreeStaticPosition, accelerometer: Triad) -> Manoeuvre:
    force = np.linalg.solve(accelerometer.matrix, position.rest.mean - accelerometer.bias)
    return replace(
        position.force.manoeuvre,
        name=position.label,
        do="rest",
        position=position.label,
        up=force / np.linalg.norm(force),
        mark=None,
        about=None,
        angle=None,
    )
