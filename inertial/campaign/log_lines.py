"""Where the data that a fit used stand in the logs: records, lines, bytes and times."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from inertial.campaign.masked_samples import Columns, pieces
from inertial.campaign.records import TURNING, Part, rows_of
from inertial.tables.parquet import Stream


@dataclass(frozen=True)
class RecordRange:
    """Records `first` up to but without `after` of a log."""

    log: str
    first: int
    after: int


@dataclass(frozen=True)
class UsedPhase:
    """One phase of a manoeuvre: its blocks, and the records of which they are means."""

    label: str  # as the fit names it
    phase: str
    blocks: int
    samples: float  # number of samples in the means
    records: RecordRange
    findings: list[str]  # identifiers of the findings that mask some of its records


@dataclass(frozen=True)
class LogLines:
    """The lines of a range of records: first and last, each with its first byte and its time, s.

    Times are NaN where the log has none. `decoded`: how many lines became samples.
    """

    from_line: int
    to_line: int
    from_byte: int
    to_byte: int
    from_s: float
    to_s: float
    decoded: int

    @property
    def of_text(self) -> bool:
        """Whether they are lines of the file; rows of a container have no first byte."""
        return self.to_byte > 0 or self.to_line == 1


def used_phases(
    parts: Sequence[Part], blocks: pd.DataFrame, manoeuvres: pd.DataFrame, masks: pd.DataFrame
) -> list[UsedPhase]:
    """The phases of the parts that a fit has used, in its order.

    A part without a phase is a turn as a whole, without the rests beside it; of one that is
    recorded `steady` only the steady part, because its rate is known and its angle is not.
    """
    recorded = dict(zip(manoeuvres["manoeuvre"], manoeuvres["recorded"], strict=True))
    used: dict[Part, list[UsedPhase]] = {part: [] for part in parts}
    for (manoeuvre, phase, log), rows in blocks.groupby(["manoeuvre", "phase", "log"], sort=False):
        whole = phase == "steady" if recorded.get(manoeuvre) == "steady" else phase in TURNING
        candidates = [Part(str(manoeuvre), str(phase)), *([Part(str(manoeuvre))] if whole else [])]
        first, after = int(rows["from_record"].min()), int(rows["to_record"].max())
        records = RecordRange(str(log), first, after)
        samples = float(rows["count"].sum())
        for part in candidates:
            if part in used:
                findings = _masking_findings(masks, records)
                used[part].append(
                    UsedPhase(part.label, str(phase), len(rows), samples, records, findings)
                )
    return [phase for part in parts for phase in used[part]]


def _masking_findings(masks: pd.DataFrame, records: RecordRange) -> list[str]:
    rows = rows_of(masks[masks["log"] == records.log])
    return sorted(
        {
            row["finding"]
            for row in rows
            if row["from_record"] < records.after and row["to_record"] > records.first
        }
    )


def lines_of(samples: Stream, ranges: Sequence[RecordRange]) -> dict[RecordRange, LogLines]:
    """The lines of each range, in one pass over the samples; none where all were refused."""
    lines: dict[RecordRange, LogLines] = {}
    for log, piece in pieces(samples, ["record", "line", "offset", "time"]):
        for records in ranges:
            if records.log == log:
                ends = (records.first, records.after)
                first, after = np.searchsorted(piece["record"], ends).tolist()
                if after > first:
                    part = _lines(piece, first, after - 1)
                    lines[records] = _joined(lines[records], part) if records in lines else part
    return lines


def _lines(piece: Columns, first: int, last: int) -> LogLines:
    line, byte, time = piece["line"], piece["offset"], piece["time"]
    return LogLines(
        from_line=int(line[first]),
        to_line=int(line[last]),
        from_byte=int(byte[first]),
        to_byte=int(byte[last]),
        from_s=float(time[first]),
        to_s=float(time[last]),
        decoded=last - first + 1,
    )


def _joined(first: LogLines, second: LogLines) -> LogLines:
    return replace(
        first,
        to_line=second.to_line,
        to_byte=second.to_byte,
        to_s=second.to_s,
        decoded=first.decoded + second.decoded,
    )
