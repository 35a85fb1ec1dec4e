"""Which stretches of the logs a method has used, by what its fit says it has used."""

from collections.abc import Sequence
from dataclasses import dataclass

import pandas as pd

from inertial.campaign.records import rows_of
from stages.tracing.lines import Stretch

BESIDE = ("rest-before", "rest-after")  # phases that a fit names with their turn: `turn (phase)`


@dataclass(frozen=True)
class Used:
    """One phase of a manoeuvre: its blocks, and the records that they are means of."""

    label: str  # as the fit names it
    phase: str
    blocks: int
    samples: float  # number of samples in the means
    stretch: Stretch
    findings: list[str]  # identifiers of the findings that mask some of its records


def used(
    labels: Sequence[str], blocks: pd.DataFrame, manoeuvres: pd.DataFrame, masks: pd.DataFrame
) -> list[Used]:
    """What a fit names as used by `labels`, in its order, each phase by itself.

    Of a turn that is recorded `steady` only the steady part counts: its rate is known and its
    angle is not.
    """
    recorded = dict(zip(manoeuvres["manoeuvre"], manoeuvres["recorded"], strict=True))
    by_label: dict[str, list[Used]] = {}
    for (manoeuvre, phase, log), rows in blocks.groupby(["manoeuvre", "phase", "log"], sort=False):
        beside = phase in BESIDE
        if beside or phase in ("rest", "steady") or recorded.get(manoeuvre) != "steady":
            label = f"{manoeuvre} ({phase})" if beside else str(manoeuvre)
            ends = int(rows["from_record"].min()), int(rows["to_record"].max())
            stretch = Stretch(str(log), *ends)
            count = float(rows["count"].sum())
            findings = _findings(masks, stretch)
            one = Used(label, str(phase), len(rows), count, stretch, findings)
            by_label.setdefault(label, []).append(one)
    return [one for label in labels for one in by_label.get(label, [])]


def _findings(masks: pd.DataFrame, stretch: Stretch) -> list[str]:
    rows = rows_of(masks[masks["log"] == stretch.log])
    return sorted(
        {
            row["finding"]
            for row in rows
            if row["from_record"] < stretch.after and row["to_record"] > stretch.first
        }
    )
