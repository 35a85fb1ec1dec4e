"""What stands beside a finding of the recording: the pictures that show it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from stages.reporting import expected, gap, pictures
from stages.reporting.close_ups import CloseUp, gaps_in
from stages.reporting.logs import Log
from stages.reporting.outline import Figure, Table
from stages.reporting.rows import Record, records

MOST_PICTURES = 25
CRITICISM = "criticism/"  # how the identifiers of findings about the model begin
OF_GAPS = frozenset({"gap", "incomplete_turn"})
Seen = tuple[str | int, ...]  # log, first and last record, channels


@dataclass(frozen=True)
class Evidence:
    """Figures and tables that show a finding."""

    parts: tuple[Figure | Table, ...] = ()


@dataclass(frozen=True)
class Recording:
    """What pictures of findings are taken from."""

    logs: Mapping[str, Log]
    close_ups: Mapping[str, CloseUp]
    gaps: pd.DataFrame
    masks: pd.DataFrame
    manoeuvres: pd.DataFrame
    performed: pd.DataFrame
    stated: expected.Stated


def evidence(rows: Sequence[Record], recording: Recording) -> dict[str, Evidence]:
    """What shows each finding, the worst first until there are enough pictures."""
    plan = {row["manoeuvre"]: row for row in records(recording.manoeuvres)}
    done = {row["manoeuvre"]: row for row in records(recording.performed)}
    found = {}
    drawn = 0
    seen: set[Seen] = set()
    for number, row in enumerate(rows, 1):
        parts: list[Figure | Table] = []
        if drawn < MOST_PICTURES:
            parts += _parts(row, f"finding-{number}", recording, seen)
            if compared := expected.compared(row, plan, done, recording.stated):
                parts.append(expected.figure(compared, f"finding-{number}-expected"))
            drawn += sum(isinstance(part, Figure) for part in parts)
        found[row["id"]] = Evidence(tuple(parts))
    return found


def _parts(
    row: Record, key: str, recording: Recording, seen: set[Seen]
) -> Iterator[Figure | Table]:
    """The picture of a finding, unless a worse one has shown the same samples: it leads there."""
    if row["id"].startswith(CRITICISM):
        return  # “What the model lacks” shows it
    close_up = recording.close_ups.get(row["id"])
    log = recording.logs.get(close_up.log if close_up else row["log"])
    if log is None:
        return
    span = _span(row, log, close_up, recording.gaps)
    place = pictures.Place(row, log, span, close_up, recording.gaps, recording.masks)
    if close_up is not None:
        samples = (log.name, *close_up.record[[0, -1]].tolist(), *place.channels)
        if samples in seen:
            return
        seen.add(samples)
    if shown := pictures.figure(place, key):
        yield shown
    if row["cause"] in OF_GAPS and close_up is not None:
        beside = gap.two_records(close_up, recording.gaps)
        if beside:
            yield beside


def _span(
    row: Record, log: Log, close_up: CloseUp | None, gaps: pd.DataFrame
) -> tuple[float, float] | None:
    """Where a finding is in its log: by its samples, where all of them are shown; else its time.

    A finding may stand for many: its time is then from the first to the last, its samples are
    those of the worst.
    """
    timed = log.timed and row["from_s"] is not None and row["log"] == log.name
    if close_up is not None and len(close_up.record):
        inside = np.flatnonzero(close_up.concerned)
        if not len(inside) and (after := gaps_in(close_up, gaps)):
            worst = max(after, key=lambda place: close_up.time[place] - close_up.time[place - 1])
            inside = np.array([worst - 1, worst])
        ends_within = len(inside) > 0 and inside[-1] < len(close_up.record) - 1
        along = close_up.time if log.timed else close_up.record
        if ends_within:
            return float(along[inside].min()), float(along[inside].max())
        if not timed:
            return float(along.min()), float(along.max())
    if not timed:
        return None
    return row["from_s"], row["from_s"] if row["to_s"] is None else row["to_s"]
