"""The stamps of a piece, one for each sample, whichever way the sensors are written."""

from dataclasses import dataclass

import numpy as np

from stages.detectors.detector import Array, Integers, Log, Piece

PRINTED = 1e-9  # s, the last digit of a stamp at best


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
    ticks = np.rint(steps / PRINTED).astype(np.int64)
    return float(max(np.gcd.reduce(ticks), 1)) * PRINTED if len(ticks) else PRINTED
