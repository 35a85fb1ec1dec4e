"""What stands beside a finding: the pictures that show it, and what it costs in numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from stages.contracts.parquet import Stream
from stages.notation import numbers
from stages.notation.causes import in_words
from stages.reporting import expected, gap, oscillation, pictures
from stages.reporting.close_ups import CloseUp, gaps_in
from stages.reporting.lacks import Shift
from stages.reporting.logs import Log
from stages.reporting.outline import Figure, Table
from stages.reporting.rows import Record, records

MOST_PICTURES = 25
OSCILLATION = "oscillation"
CRITICISM = "criticism"  # of its findings the place is the model
OF_GAPS = frozenset({"gap", "incomplete_turn"})
Seen = tuple[str | int, ...]  # log, first and last record, channels
STAGE = {"gyro": "gyroscope", "accel": "accelerometer"}


@dataclass(frozen=True)
class Evidence:
    """Figures and tables that show a finding, and sentences with numbers."""

    parts: tuple[Figure | Table, ...] = ()
    measure: tuple[str, ...] = ()


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


@dataclass(frozen=True)
class Model:
    """What the numbers of findings about the model are taken from."""

    simulated: Stream
    lines: pd.DataFrame
    gain: pd.DataFrame
    joint: Sequence[Record]  # parameters of the gyros by the joint fit
    shifts: Sequence[Shift]


def evidence(rows: Sequence[Record], recording: Recording, model: Model) -> dict[str, Evidence]:
    """What shows each finding, the worst first until there are enough pictures."""
    plan = {row["manoeuvre"]: row for row in records(recording.manoeuvres)}
    done = {row["manoeuvre"]: row for row in records(recording.performed)}
    found = {}
    drawn = 0
    seen: set[Seen] = set()
    for number, row in enumerate(rows, 1):
        parts: list[Figure | Table] = []
        if drawn < MOST_PICTURES:
            parts += _parts(row, f"finding-{number}", recording, model, seen)
            if compared := expected.compared(row, plan, done, recording.stated):
                parts.append(expected.figure(compared, f"finding-{number}-expected"))
            drawn += sum(isinstance(part, Figure) for part in parts)
        found[row["id"]] = Evidence(tuple(parts), tuple(_measure(row, recording, model)))
    return found


def _parts(
    row: Record, key: str, recording: Recording, model: Model, seen: set[Seen]
) -> Iterator[Figure | Table]:
    """The picture of a finding, unless a worse one has shown the same samples: it leads there."""
    if row["cause"] == OSCILLATION and row["id"].startswith(CRITICISM):
        if ringing := oscillation.figure(model.simulated, model.lines, recording.manoeuvres, key):
            yield ringing
        return
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


def _measure(row: Record, recording: Recording, model: Model) -> Iterator[str]:
    """What it costs, where other tables than that of findings tell it."""
    if not row["id"].startswith(CRITICISM):
        return
    if row["cause"] == OSCILLATION:
        yield from oscillation.harm(model.lines, recording.manoeuvres, model.gain, model.joint)
        return
    yield from _gained(row, model)


def _gained(row: Record, model: Model) -> Iterator[str]:
    """How much nearer the model comes with an effect, and how far the parameters move."""
    own = [
        line
        for line in records(model.gain)
        if row["cause"] in line["effects"].split(", ") and line["sensor"] in STAGE
    ]
    for line in own:
        if line["scope"] == "held-out":
            names = " and ".join(in_words(name) for name in line["effects"].split(", "))
            before, after = (
                numbers.significant(line[name], 3) for name in ("rms_before", "rms_after")
            )
            unit = "σ" if line["unit"] == "sigma" else line["unit"]
            yield (
                f"With {names} in the model the residuals of manoeuvres that were held out fall "
                f"from {before} {unit} to {after} {unit} rms."
            )
    stage = STAGE.get(row["sensor"] or "")
    shifts = [one for one in model.shifts if stage in (None, one.stage)]
    if own and shifts:
        most = max(shifts, key=lambda one: abs(one.sigmas))
        yield (
            f"Of the parameters, {most.name} moves most: by {numbers.fixed(most.sigmas, 1)} σ of "
            "the joint fit."
        )
