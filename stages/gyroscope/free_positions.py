"""The gyros from the motions between rests of unknown attitude: blocks as inference takes them.

The method is `free_positions`, as that of the accelerometers, in whose axes its result is. A motion
is the blocks of phase `between`, one for each record, from the end of a rest to the beginning of
the next one in the same log; where one of them is missing, no attitude can be carried through.
"""

from collections.abc import Sequence
from functools import partial
from itertools import pairwise

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.estimates import Estimates, reasons
from inertial.campaign.noise_levels import NoiseLevels
from inertial.campaign.records import Part, omissions
from inertial.campaign.unknown_attitude import (
    METHOD,
    FreeStaticPosition,
    fitted_to,
    free_static_positions,
)
from inertial.estimation.between_positions import Passage, Prior, Stop, between_rests
from inertial.estimation.variance_components import with_scatter
from inertial.tables import GYRO
from inertial.text.messages import _

Array = NDArray[np.float64]

BETWEEN = "between"  # phase of the blocks from one rest to the next
SCATTER_RANGE = (1e-11, 0.1)  # rad/s: how much rests and motions may differ beyond the noise
CURES = {
    "bias": _("no rest shows it: add a rest"),
    "matrix": _(
        "between the rests the IMU hardly turned about {axis} while {axis} was horizontal: "
        "add turns of 90° or more about {axis}, there and back"
    ),
}


def add_free_gyros(estimates: Estimates, data: CampaignData) -> None:
    """The rows of the method; none where the plan states every attitude."""
    positions, left_out = free_static_positions(data)
    stops = [_stop(position) for position in positions]
    recorded = np.isfinite(np.array([stop.mean for stop in stops]).reshape(-1, 3)).any(axis=0)
    if not recorded.any():
        if left_out or positions:
            estimates.add_nothing(METHOD, omissions(left_out) or _("no gyro is recorded"))
        return
    passages, moving, broken = passages_of(positions, data.blocks, data.noise)
    between = fitted_to(data, positions).scatter
    prior = Prior(data.gravity.number, data.gravity.scatter, between, data.earth)
    fits = [
        with_scatter(
            partial(between_rests, stops, passages, prior, sways=sways),
            between=SCATTER_RANGE,
            noise_degrees=data.noise.degrees,
        )
        for sways in (False, True)
    ]
    fitted = min(fits, key=lambda fit: fit.estimate.deviance)
    why = reasons(fitted.estimate.determined, recorded, "gyro", CURES)
    estimates.add_triad(METHOD, fitted.estimate, why)
    used = [position.force.part for position in positions] + moving
    estimates.add_fit(METHOD, fitted, used, left_out + broken)


def _stop(position: FreeStaticPosition) -> Stop:
    return Stop(position.rest, *position.rate.over(), float(position.rate.seconds.sum()))


def passages_of(
    positions: Sequence[FreeStaticPosition], blocks: pd.DataFrame, noise: NoiseLevels
) -> tuple[list[Passage], list[Part], list[Part]]:
    """The motions from each rest to the next, their blocks, and those left out with the reason."""
    moving = blocks[blocks["phase"] == BETWEEN].sort_values(["log", "from_record"])
    passages: list[Passage] = []
    used: list[Part] = []
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
        seconds = part["seconds"].to_numpy(np.float64)
        passages.append(Passage(i, part[GYRO].to_numpy(np.float64), seconds, density))
        used.append(Part(name, BETWEEN))
    return passages, used, left_out


def refusal_of(
    part: pd.DataFrame, before: FreeStaticPosition, behind: FreeStaticPosition, density: Array
) -> str:
    """Why no attitude can be carried from one rest to the next; empty where it can."""
    if part.empty:
        return _("the motion between them is not recorded")
    ends = np.append(before.after, part["to_record"].to_numpy(np.int64))
    starts = np.append(part["from_record"].to_numpy(np.int64), behind.first)
    masked = int((starts - ends).sum())
    if masked:
        return _(
            "{masked} records are masked while it moves, so no attitude is carried through",
            masked=masked,
        )
    lost = float(part["missing_s"].sum())
    if lost:
        return _(
            "{lost:.2f} s are lost while it moves, so no attitude is carried through", lost=lost
        )
    if not np.isfinite(density).all() or part[[*GYRO, "seconds"]].isna().any(axis=None):
        return _("all three gyros and the time are needed to carry an attitude through")
    return ""
