"""A log in pieces that overlap, so that a detector sees what is on both sides of a record."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby, pairwise
from operator import itemgetter

import numpy as np

from stages.contracts.parquet import Stream
from stages.contracts.samples import Columns, pieces
from stages.contracts.tables import CHANNELS
from stages.detectors.detector import Piece

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
