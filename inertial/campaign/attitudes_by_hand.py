"""The static positions of unknown attitude with the attitude that the accelerometers give them.

So every later stage has a plan of rests that each have an upward direction. The azimuth stays
unknown, and so does the tilt: the direction is that of the readings themselves.
"""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from inertial.campaign.passages import RecordedPassage, passages_of
from inertial.campaign.records import Manoeuvre, Performed
from inertial.campaign.unknown_attitude import FreeStaticPosition, free_static_positions
from inertial.estimation.between_positions import Stop
from inertial.physics.forward import Triad

if TYPE_CHECKING:
    from inertial.campaign.campaign_data import CampaignData


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
