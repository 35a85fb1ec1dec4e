"""The stamps of a log: one for each sample, their order, and the sensors that they are of."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from inertial.signal.detector import Array, Booleans, Integers, Log, Piece

STAMP_DIGIT_S = 1e-9  # s, the last digit of a stamp at best
MAX_RATE_ERROR = 0.01  # of the stated rate: more than any crystal is off


@dataclass(frozen=True)
class Stamps:
    """The stamps of k samples.

    place: (k,), where in the piece; time: (k,), s; apart: (k − 1,), how many sample intervals
    lie from one to the next, 0 where time goes back.
    """

    place: Integers
    time: Array
    apart: Integers

    def __len__(self) -> int:
        return len(self.time)


def stamps_of(piece: Piece, log: Log) -> Stamps:
    """The stamps of one sensor, each once: another sensor may come in rows of its own.

    Records of which nothing is to be used any more are left out.
    """
    accel = np.isfinite(log.least[:3]).any()
    own = piece.values[:, :3] if accel else piece.values[:, 3:]
    place = np.flatnonzero(np.isfinite(own).any(axis=1) & np.isfinite(piece.time))
    if len(place):
        place = place[np.append(True, np.diff(piece.time[place]) != 0)]
    time = piece.time[place]
    step = np.diff(time)
    apart = np.where(step > 0, np.maximum(np.rint(step / log.interval), 1), 0)
    return Stamps(place, time, apart.astype(np.int64))


def unit_of(steps: Array) -> float:
    """Of what these steps between stamps, (m,), s, are whole multiples, s; at least 1 ns."""
    ticks = np.rint(steps / STAMP_DIGIT_S).astype(np.int64)
    return float(max(np.gcd.reduce(ticks), 1)) * STAMP_DIGIT_S if len(ticks) else STAMP_DIGIT_S


MAX_INTERVALS = 1.5  # intervals: a longer one is a gap, or the stamps jump ahead
MAX_DISORDERS = 1000  # stretches of a piece that are distinguished


@dataclass(frozen=True)
class Disorder:
    """Records [start, end) of a piece whose stamps are off by `size`, s, ahead or behind."""

    start: int
    end: int
    size: float
    ahead: bool


def disorders(time: Array, reached: float, interval: float) -> list[Disorder]:
    """The stretches of stamps, (n,), that are out of order; time had come to `reached` before."""
    if not np.isfinite(time).all():
        return []
    corrected = time
    disordered: list[Disorder] = []
    start = 0
    while len(disordered) < MAX_DISORDERS:
        behind = _behind(corrected, reached)
        start += int(np.argmax(behind[start:])) if behind[start:].any() else len(time)
        if start >= len(time):
            break
        end = start + int(np.argmin(np.append(behind[start:], False)))
        after = start - int(np.argmax(corrected[:start][::-1] <= corrected[start])) if start else 0
        jump = corrected[after] - corrected[after - 1] if 0 < after < start else 0.0
        if jump > MAX_INTERVALS * interval and start - after < end - start:
            off = float(time[after] - corrected[after - 1] - interval)
            disordered.append(Disorder(after, start, off, ahead=True))
            corrected = corrected.copy()
            corrected[after:start] = corrected[after - 1]
            start = after
        else:
            before = max(reached, float(corrected[:start].max(initial=-np.inf)))
            disordered.append(Disorder(start, end, before - float(time[start]), ahead=False))
            start = end
    return disordered


def _behind(time: Array, reached: float) -> Booleans:
    """Which stamps lie before one that came earlier, (n,)."""
    former = np.maximum.accumulate(np.append(reached, time[:-1]))
    return np.asarray(time < former)


def kinds(piece: Piece) -> Iterator[tuple[Integers, Integers]]:
    """For each set of channels that are recorded together: the places, (m,), and the channels.

    Records of which nothing is to be used any more are in none.
    """
    there = np.isfinite(piece.values)
    if there.all():
        yield np.arange(len(piece)), np.arange(there.shape[1])
        return
    code = there @ (1 << np.arange(there.shape[1]))
    for each in np.unique(code[code > 0]):
        channels = np.flatnonzero(each >> np.arange(there.shape[1]) & 1)
        yield np.flatnonzero(code == each), channels
