"""Showing the rests that were found to their detectors, without what quality has masked."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from inertial.campaign.detection import Stretch, of_stretches, watch
from inertial.campaign.events import Told, tell
from inertial.campaign.masked_samples import Masks
from inertial.campaign.records import rows_of
from inertial.signal.detector import Detector, Log, Piece
from inertial.tables.parquet import Stream


@dataclass(frozen=True)
class Rest:
    """A stretch at rest, of which manoeuvre it is, and the name under which it is told."""

    name: str
    manoeuvre: str
    stretch: Stretch


def rests_of(segments: pd.DataFrame) -> list[Rest]:
    """The rests among the segments; those beside a turn are told with their phase."""
    found = []
    for row in rows_of(segments):
        if row["phase"].startswith("rest"):
            manoeuvre = row["manoeuvre"]
            name = manoeuvre if row["phase"] == "rest" else f"{manoeuvre} ({row['phase']})"
            found.append(Rest(name, manoeuvre, (row["log"], row["from_record"], row["to_record"])))
    return found


def screen(
    stage: str,
    detectors: Sequence[Detector],
    samples: Stream,
    rests: Sequence[Rest],
    masks: Masks,
    logs: Mapping[str, Log],
) -> list[Told]:
    """Everything that these detectors see in the rests."""
    known = [rest for rest in rests if rest.stretch[0] in logs]
    if not known:
        return []
    cut = of_stretches(samples, {rest.name: [rest.stretch] for rest in known})
    log_of = {rest.name: rest.stretch[0] for rest in known}
    shown = without_masked(cut, masks, log_of)
    given = logs[known[0].stretch[0]].given
    watched = watch(detectors, shown, {rest.name: logs[log_of[rest.name]] for rest in known}, given)
    owner = {rest.name: rest.manoeuvre for rest in known}
    return [
        replace(one, finding=replace(one.finding, manoeuvre=owner[str(one.finding.manoeuvre)]))
        for one in tell(stage, watched, of_manoeuvres=True)
    ]


def without_masked(
    cut: Iterator[tuple[str, Piece]], masks: Masks, log_of: Mapping[str, str]
) -> Iterator[tuple[str, Piece]]:
    """Pieces whose masked readings are NaN."""
    for name, piece in cut:
        masked = masks.of(log_of[name], piece.record)
        gone = masked.channels | masked.whole[:, None]
        values = np.where(gone, np.nan, piece.values) if gone.any() else piece.values
        yield name, replace(piece, values=values)
