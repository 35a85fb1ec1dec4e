"""Records that come again, stamp and all."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from inertial.signal.detector import (
    Array,
    Booleans,
    Description,
    Detector,
    Event,
    Integers,
    Log,
    Piece,
)
from inertial.signal.runs import runs
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed

# Share of stamps that stand still while the readings change: above it the stamps are so coarse
# that equal readings with equal stamps may be another sample.
MAX_CHANCE_EQUAL = 0.05


class Duplicate(Detector):
    """A record whose stamp and readings were in the log before.

    Right before, where a line was written twice; or farther back, where logs were joined that
    overlap. What lies farther back than the piece shows is not seen.
    """

    name = "duplicate"
    cause = _("a record was written twice, or logs were joined that overlap")
    source = "design study, 41c: by chance six readings are equal once in 10⁷ pairs or less"
    costs = _("a sum counts it twice: at 10 °/s and 100 Hz a turn gains 0.1° with each")
    unit = "records"
    severity = 1
    masks = True
    repeats = True

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        repeated = _repeated(piece)
        for start, end in runs(repeated):
            far = bool(piece.time[start] < np.nanmax(piece.time[:start]))
            yield piece.event(start, end, float(end - start), facts=far)

    def describe(self, event: Event, name: str) -> Description:
        single = event.size == 1
        what = _(
            "{counted} from line {line}",
            counted=counted(int(event.size), "record"),
            line=event.line,
        )
        does = "repeats" if single else "repeat"
        where = (
            _("earlier ones, stamps and all") if event.facts else _("the one before, stamp and all")
        )
        many = "it" if single else "them"
        return Description(
            f"{name}: {what} {does} {where}, at {fixed(event.from_s, 3)} s.",
            _(
                "A sum over time would count {value} twice: the angle of a turn by the rate "
                "times {counted}; the mean of a rest hardly moves.",
                value=many,
                counted=counted(int(event.size), "sample interval"),
            ),
            _(
                "{value} masked, and no time is counted for {value_2}.",
                value="It is" if single else "They are",
                value_2=many,
            ),
        )


def _repeated(piece: Piece) -> Booleans:
    """Which records were there before, (n,)."""
    repeated = np.zeros(len(piece), bool)
    time = np.where(np.isnan(piece.time), np.inf, piece.time)
    again = np.zeros(len(piece), bool)
    again[1:] = time[1:] <= np.maximum.accumulate(time)[:-1]
    again &= np.isfinite(piece.time)
    if not again.any():
        return repeated
    concerned = np.flatnonzero(np.isin(piece.time, piece.time[again]))
    concerned = concerned[np.isfinite(piece.values[concerned]).any(axis=1)]
    if not len(concerned):
        return repeated
    stamps, values = piece.time[concerned], piece.values[concerned]
    # Accelerometers and gyros may come in rows of their own, with one stamp.
    kinds = np.isnan(values) @ (1 << np.arange(6))
    same_stamp = _seen_before(np.column_stack([stamps, kinds]))
    whole = _seen_before(np.column_stack([stamps, np.nan_to_num(values, nan=np.inf)]))
    if _coarse(stamps, same_stamp & ~whole, len(piece)):
        return repeated
    repeated[concerned[whole]] = True
    return repeated


def _seen_before(rows: Array) -> Booleans:
    """Which of n rows are equal to one before them, (n,)."""
    first: Integers = np.unique(rows, axis=0, return_index=True)[1]
    before: NDArray[np.bool_] = np.ones(len(rows), bool)
    before[first] = False
    return before


def _coarse(stamps: Array, changed: Booleans, records: int) -> bool:
    """Whether time often stands still while the readings change."""
    still = np.append(False, np.diff(stamps) == 0) & changed
    return bool(np.count_nonzero(still) > MAX_CHANCE_EQUAL * records)
