"""Detectors at work on overlapping pieces of logs, their events joined over the borders."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, groupby, pairwise
from operator import itemgetter

import numpy as np

from inertial.campaign.masked_samples import Columns, pieces
from inertial.signal.detector import Detector, Event, Given, Log, Piece
from inertial.tables import CHANNELS
from inertial.tables.parquet import Stream

# ---- A log in pieces that overlap, so that a detector sees what is on both sides of a record.

LENGTH = 1 << 17  # records of a piece, which bound the memory
BESIDE = 1 << 12  # records on each side that it shares with its neighbours
COLUMNS = ["record", "line", "time", "status", "temperature", *CHANNELS]
Stretch = tuple[str, int, int]  # log, first record, record after the last
Key = tuple[str, str, int]  # name, log, number of the stretch


def of_logs(samples: Stream) -> Iterator[tuple[str, Piece]]:
    """Every log from its first record to its last.

    Another label is another stretch of recording; nothing is compared across.
    """

    def parts() -> Iterator[tuple[Key, Columns]]:
        number = 0
        label = None
        for log, columns in pieces(samples, [*COLUMNS, "label"]):
            labels = columns.pop("label")
            edges = [0, *(np.flatnonzero(labels[1:] != labels[:-1]) + 1).tolist(), len(labels)]
            for start, end in pairwise(edges):
                number += labels[start] != label
                label = labels[start]
                yield (
                    (log, log, number),
                    {name: values[start:end] for name, values in columns.items()},
                )

    for key, piece in _overlapping(parts()):
        yield key[0], piece


def of_stretches(
    samples: Stream, stretches: Mapping[str, Sequence[Stretch]]
) -> Iterator[tuple[str, Piece]]:
    """Each stretch by itself, under its name; a name may have several."""
    by_log: dict[str, list[tuple[int, int, str]]] = {}
    for name, own in stretches.items():
        for log, first, after in own:
            by_log.setdefault(log, []).append((first, after, name))

    def parts() -> Iterator[tuple[Key, Columns]]:
        for log, columns in pieces(samples, COLUMNS):
            record = columns["record"]
            for first, after, name in sorted(by_log.get(log, [])):
                start, end = np.searchsorted(record, [first, after])
                if end > start:
                    part = {column: values[start:end] for column, values in columns.items()}
                    yield (name, log, first), part

    for key, piece in _overlapping(parts()):
        yield key[0], piece


def _overlapping(parts: Iterable[tuple[Key, Columns]]) -> Iterator[tuple[Key, Piece]]:
    """Parts with equal keys joined, and cut so that each piece sees beside itself."""
    for key, own in groupby(parts, key=itemgetter(0)):
        waiting: Columns = {}
        seen = 0
        reached = -np.inf
        for _, columns in own:
            waiting = {
                name: np.concatenate([waiting[name], values]) if waiting else values
                for name, values in columns.items()
            }
            while len(waiting["record"]) >= seen + LENGTH + BESIDE:
                after = seen + LENGTH
                here = {name: values[: after + BESIDE] for name, values in waiting.items()}
                yield key, _piece(here, seen, after, reached)
                time = waiting["time"][: after - BESIDE]
                # Of two stamps in a row: a single one that is far ahead says nothing of the rest.
                reached = max(reached, np.minimum(time[1:], time[:-1]).max())
                waiting = {name: values[after - BESIDE :] for name, values in waiting.items()}
                seen = BESIDE
        if len(waiting["record"]) > seen:
            yield key, _piece(waiting, seen, len(waiting["record"]), reached)


def _piece(columns: Columns, first: int, after: int, reached: float) -> Piece:
    return Piece(
        columns["record"],
        columns["line"],
        columns["time"],
        np.column_stack([columns[channel] for channel in CHANNELS]),
        columns["status"].astype(np.float64),
        columns["temperature"],
        first,
        after,
        reached,
    )


# ---- Detectors at work on pieces of logs: what they see, put together over the borders of pieces.

# By detector, name of what was shown (empty for the campaign as a whole) and channel.
Seen = dict[tuple[Detector, str, int | None], list[Event]]


@dataclass(frozen=True)
class Watched:
    """What the detectors saw in stretches of logs, each stretch under its name."""

    seen: Seen
    logs: Mapping[str, Log]  # by the same names


def watch(
    detectors: Sequence[Detector],
    cut: Iterable[tuple[str, Piece]],
    logs: Mapping[str, Log],
    given: Given,
) -> Watched:
    """Show every piece to every detector; what one masks those after it do not see.

    Parameters
    ----------
    cut : pieces of logs, or of rests, each under its name
    logs : the log of each name
    """
    seen: Seen = {}
    for name, piece in cut:
        shown = piece
        first = int(piece.record[piece.first])
        after = int(piece.record[piece.after - 1]) + 1
        for detector in detectors:
            events = list(detector.finds(shown, logs[name]))
            if detector.masks:
                shown = shown.without(events)
            for event in events:
                # A piece answers for its own records; an event without records, for a border.
                if (event.after > first and event.first < after) or first <= event.first < after:
                    _add(seen.setdefault((detector, name, event.channel), []), event)
    for detector in detectors:
        for event in chain(detector.judges(given), detector.compares(logs)):
            seen.setdefault((detector, "", event.channel), []).append(event)
        for name, log in logs.items():
            for event in detector.concludes(log):
                _add(seen.setdefault((detector, name, event.channel), []), event)
    return Watched(seen, logs)


def _add(events: list[Event], event: Event) -> None:
    """Join an event with the one before where a border of pieces cut it."""
    if events and event.first < events[-1].after:
        last = events[-1]
        size = max(last.size, event.size, key=abs)
        if event.after > last.after:
            events[-1] = replace(last, after=event.after, to_s=event.to_s, size=size)
    else:
        events.append(event)
