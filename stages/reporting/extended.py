"""Which result of a sensor counts, the joint or the extended one, in words and as estimates."""

from collections.abc import Iterator, Sequence

from inertial.campaign.final_result import EXTENDED, STAGES
from inertial.text import numbers
from inertial.text.cause_names import in_words
from stages.reporting.gained import effects_of
from stages.reporting.outline import Paragraph, Tone
from stages.reporting.parameters import Estimate
from stages.reporting.rows import Record


def paragraphs(decision: Sequence[Record]) -> Iterator[Paragraph]:
    """The decision of every sensor that shows an effect, or beside which something is wrong."""
    for row in decision:
        if row["effects"] or row["alarms"]:
            tone: Tone = "good" if row["result"] == EXTENDED else "fair"
            yield Paragraph(numbers.shortened(_said(row), 900), tone)


def _said(row: Record) -> str:
    """The decision in words, with its mount where there are several."""
    return f"Mount {row['mount']}: {row['sentence']}" if row["mount"] else str(row["sentence"])


def counting(
    joint: Sequence[Estimate], extended: Sequence[Estimate], decision: Sequence[Record]
) -> list[Estimate]:
    """The estimates, those of the joint fit replaced where the extended ones count.

    `extended`: as the extension has them, with the sensor's stage and mount.
    """
    counts = {
        (STAGES[row["sensor"]], row["mount"] or "") for row in decision if row["result"] == EXTENDED
    }
    better = {(one.stage, one.mount): one for one in extended}
    return [
        better.get((one.stage, one.mount), one)
        if one.kind == "joint" and (one.stage, one.mount) in counts
        else one
        for one in joint
    ]


def estimates(parameters: Sequence[Record], fit: Sequence[Record]) -> list[Estimate]:
    """The results of the extension, one for each sensor and mount; its effects left out."""
    fits = {row["method"]: row for row in fit}
    found = []
    for method in dict.fromkeys(row["method"] for row in parameters):
        stage, _, mount = method.partition("@")
        own = [row for row in parameters if row["method"] == method and "." not in row["parameter"]]
        name = f"{EXTENDED}@{mount}" if mount else EXTENDED
        found.append(Estimate(stage, name, tuple(own), fits.get(method)))
    return found


def effects_in(estimate: Estimate, decision: Sequence[Record]) -> list[str]:
    """The effects in the model of an estimate, in words; none of a joint fit."""
    if estimate.kind != EXTENDED:
        return []
    return [
        in_words(name)
        for row in decision
        if (STAGES[row["sensor"]], row["mount"] or "") == (estimate.stage, estimate.mount)
        for name in effects_of(row)
    ]
