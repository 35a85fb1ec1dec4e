"""The part of a rest that is used, where the table tilts in it: that before the tilt.

So it is where all other rests of its position stand as that part does. Then the table was set as
the plan says, it moved, and it was back in the next rest; a mean over both parts would be of an
attitude that was never there. Where the others stand as the part behind the tilt, either the table
settled or it stayed tilted, and which part is at the stated attitude is not known.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.findings import Detection
from inertial.campaign.records import Manoeuvre, Row
from inertial.detectors.table_moving import Moved, TableMoving
from inertial.signal.detector import Event
from inertial.tables import AXES, STATIC_PHASES
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.units import ARC_SECOND

REST = "rest"  # the phase of a manoeuvre that is nothing else
FORCES = [f"accel_{axis}" for axis in AXES]  # columns of blocks
KNOCK = "knock"  # after which the table stands as before
USED_WHOLE = _("Used whole, this rest would have a mean attitude that is off by {off}″.")
USED = _(
    "Only what was recorded before it is used: there this rest stands as the others of its "
    "position do. Record it again, on what does not give way."
)


def masked_tilts(
    detections: Sequence[Detection], blocks: pd.DataFrame, plan: Sequence[Manoeuvre]
) -> tuple[list[Detection], list[Row]]:
    """The detections, those whose rest loses what follows the tilt saying so, and its masks.

    Parameters
    ----------
    blocks : of all manoeuvres, nothing of these tilts masked
    """
    stated = {m.name: m for m in plan if m.up is not None}
    static = blocks[blocks["phase"].isin(STATIC_PHASES)]
    told, masks = [], []
    for each in detections:
        name = str(each.finding.manoeuvre)
        own = static[(static["manoeuvre"] == name) & (static["phase"] == REST)]
        tilts = list(_tilts(each)) if name in stated and len(own) else []
        beside = [
            m.name for m in stated.values() if m.name != name and _shared(m, stated.get(name))
        ]
        others = static[static["manoeuvre"].isin(beside)]
        if tilts and _others_stand_as_before(own, tilts[0], others):
            off = max(tilt.facts.motion.off for tilt in tilts) / ARC_SECOND
            would = USED_WHOLE.format(off=significant(off, 3))
            each = replace(each, finding=replace(each.finding, consequence=would, action=USED))
            masks.append(
                {
                    "log": own["log"].iloc[0],
                    "from_record": tilts[0].first,
                    "to_record": int(own["to_record"].max()),
                    "sensor": None,
                    "axis": None,
                    "repeated": False,
                    "censored": False,
                    "finding": each.finding.id,
                }
            )
        told.append(each)
    return told, masks


def _tilts(detection: Detection) -> Iterator[Event]:
    """The events by which a table of stated attitude tilts, in their order."""
    if isinstance(detection.detector, TableMoving):
        events = sorted((event for _log, event in detection.events), key=lambda e: e.first)
        for event in events:
            moved: Moved = event.facts
            if moved.attitude_set and moved.motion.kind != KNOCK:
                yield event


def _shared(other: Manoeuvre, own: Manoeuvre | None) -> bool:
    return own is not None and (other.position, other.mount) == (own.position, own.mount)


def _others_stand_as_before(own: pd.DataFrame, tilt: Event, others: pd.DataFrame) -> bool:
    """Whether each other rest is nearer to the part before the tilt than to the one behind it."""
    before = own[own["to_record"] <= tilt.first]
    behind = own[own["from_record"] >= tilt.after]
    if before.empty or behind.empty or others.empty:
        return False
    stood, way = _force(before), _force(behind) - _force(before)
    rests = [_force(rest) for _key, rest in others.groupby(["manoeuvre", "phase"])]
    return all((rest - stood) @ way < 0.5 * (way @ way) for rest in rests)


def _force(blocks: pd.DataFrame) -> Array:
    """The mean force of some blocks, (3,), m/s²."""
    weights = blocks["seconds"].to_numpy()
    return np.asarray(weights @ blocks[FORCES].to_numpy() / weights.sum())
