"""Detectors at work on overlapping pieces of logs, their events joined across the borders."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, pairwise

import numpy as np

from inertial.arrays import Array
from inertial.campaign.log_lines import RecordRange
from inertial.campaign.masked_samples import Batch, Columns, Masks
from inertial.signal.detector import Detector, Event, Given, Log, Piece
from inertial.tables import CHANNELS

PIECE_RECORDS = 1 << 17  # of a piece, which bound the memory
SHARED_RECORDS = 1 << 12  # on each side, that a piece shares with its neighbours
COLUMNS = ("line", "time", "status", "temperature", *CHANNELS)

Subject = tuple[str, str, int]  # name of what is examined, log, number or first record
# By detector, name of what was examined (empty for the campaign as a whole) and channel.
Events = dict[tuple[Detector, str, int | None], list[Event]]


class _Cutter:
    """Cuts what streams by into pieces that share records with their neighbours.

    So a detector sees what is on both sides of a record. A piece never holds two subjects.
    """

    def __init__(self) -> None:
        self._subject: Subject | None = None
        self._start()

    def _start(self) -> None:
        self._waiting: list[Columns] = []
        self._records = 0  # that wait
        self._done = 0  # of these, records of the piece before
        self._latest = -np.inf

    def add(self, subject: Subject, columns: Columns) -> Iterator[tuple[str, Piece]]:
        """The pieces that are complete with these records."""
        if subject != self._subject:
            yield from self.rest()
            self._subject = subject
        self._waiting.append(columns)
        self._records += len(columns["record"])
        while self._records >= self._done + PIECE_RECORDS + SHARED_RECORDS:
            waiting = self._joined()
            after = self._done + PIECE_RECORDS
            piece = {name: values[: after + SHARED_RECORDS] for name, values in waiting.items()}
            yield subject[0], _piece(piece, self._done, after, self._latest)
            time = waiting["time"][: after - SHARED_RECORDS]
            # Of two stamps in a row: a single one that is far ahead does not count.
            self._latest = max(self._latest, np.minimum(time[1:], time[:-1]).max())
            left = {name: values[after - SHARED_RECORDS :] for name, values in waiting.items()}
            self._waiting, self._records = [left], len(left["record"])
            self._done = SHARED_RECORDS

    def rest(self) -> Iterator[tuple[str, Piece]]:
        """The last piece of the present subject."""
        if self._subject is not None and self._records > self._done:
            yield self._subject[0], _piece(self._joined(), self._done, self._records, self._latest)
        self._start()

    def _joined(self) -> Columns:
        if len(self._waiting) == 1:
            return self._waiting[0]
        return {
            name: np.concatenate([columns[name] for columns in self._waiting])
            for name in self._waiting[0]
        }


def _piece(columns: Columns, first: int, after: int, latest: float) -> Piece:
    status = columns["status"].astype(np.float64)
    return Piece(**{**columns, "status": status}, first=first, after=after, reached=latest)


def _columns_of(batch: Batch, rows: slice, values: Array) -> Columns:
    """The arrays of a piece; `values`: (n, 6), of the whole batch."""
    names = ("record", "line", "time", "status", "temperature")
    return {**{name: batch[name][rows] for name in names}, "values": values[rows]}


class Examination:
    """Shows every piece to every detector; what one masks those after it do not see.

    Parameters
    ----------
    logs : the log of each name under which pieces are shown
    """

    def __init__(
        self, detectors: Sequence[Detector], logs: Mapping[str, Log], given: Given | None
    ) -> None:
        self._detectors = detectors
        self.logs = logs
        self._given = given
        self._events: Events = {}

    def examine(self, name: str, piece: Piece) -> None:
        """Show a piece of the log or stretch of this name."""
        first = int(piece.record[piece.first])
        after = int(piece.record[piece.after - 1]) + 1
        log = self.logs[name]
        for detector in self._detectors:
            events = list(detector.detect(piece, log))
            if detector.masks and events:
                piece = piece.without(events)
            for event in events:
                # A piece answers for its own records; an event without records, for a border.
                if (event.after > first and event.first < after) or first <= event.first < after:
                    _append(self._events.setdefault((detector, name, event.channel), []), event)

    def events(self) -> Events:
        """All events, with those that concern whole logs or the campaign."""
        events = self._events
        for detector in self._detectors:
            of_campaign = detector.detect_in_campaign(self._given) if self._given else ()
            for event in chain(of_campaign, detector.detect_between_logs(self.logs)):
                events.setdefault((detector, event.log, event.channel), []).append(event)
            for name, log in self.logs.items():
                for event in detector.detect_in_log(log):
                    _append(events.setdefault((detector, name, event.channel), []), event)
        return events


def _append(events: list[Event], event: Event) -> None:
    """Join an event with the one before where a border of pieces cut it."""
    if events and event.first < events[-1].after:
        last = events[-1]
        size = max(last.size, event.size, key=abs)
        if event.after > last.after:
            events[-1] = replace(last, after=event.after, to_s=event.to_s, size=size)
    else:
        events.append(event)


class _Examined:
    """What is cut into pieces, and examined piece by piece."""

    def __init__(self, examination: Examination) -> None:
        self._examination = examination
        self._cutter = _Cutter()

    def _add(self, subject: Subject, columns: Columns) -> None:
        for name, piece in self._cutter.add(subject, columns):
            self._examination.examine(name, piece)

    def events(self) -> Events:
        """All events, once every batch was added."""
        for name, piece in self._cutter.rest():
            self._examination.examine(name, piece)
        return self._examination.events()


class ExaminationOfLogs(_Examined):
    """Examines every log from its first record to its last.

    Where the label changes another stretch of recording begins; nothing is compared across.
    """

    columns = (*COLUMNS, "label")

    def __init__(self, examination: Examination) -> None:
        super().__init__(examination)
        self._label: str | None = None
        self._stretch = 0

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        labels = batch["label"]
        edges = [0, *(np.flatnonzero(labels[1:] != labels[:-1]) + 1).tolist(), len(labels)]
        for start, end in pairwise(edges):
            self._stretch += labels[start] != self._label
            self._label = labels[start]
            subject = (batch.log, batch.log, self._stretch)
            columns = _columns_of(batch, slice(start, end), batch.readings)
            self._add(subject, columns)


class ExaminationOfStretches(_Examined):
    """Examines stretches of logs, each by itself under its name, without what is masked.

    Parameters
    ----------
    stretches : by name
    """

    columns = COLUMNS

    def __init__(
        self, examination: Examination, stretches: Mapping[str, RecordRange], masks: Masks
    ) -> None:
        super().__init__(examination)
        self._masks = masks
        self._by_log: dict[str, list[tuple[int, int, str]]] = {}
        for name, own in stretches.items():
            self._by_log.setdefault(own.log, []).append((own.first, own.after, name))
        for ranges in self._by_log.values():
            ranges.sort()

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        record, log = batch["record"], batch.log
        own = [
            (first, *np.searchsorted(record, [first, after]).tolist(), name)
            for first, after, name in self._by_log.get(log, ())
            if first <= record[-1] and record[0] < after
        ]
        if not own:
            return
        masked = self._masks.of(log, record)
        gone = masked.channels | masked.whole[:, None]
        values = np.where(gone, np.nan, batch.readings) if gone.any() else batch.readings
        for first, start, end, name in own:
            if end > start:
                columns = _columns_of(batch, slice(start, end), values)
                self._add((name, log, first), columns)
