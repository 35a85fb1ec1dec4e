"""Which stamps of a log are out of order."""

from dataclasses import dataclass

import numpy as np

from stages.detectors.detector import Array, Booleans

AHEAD = 1.5  # intervals: a longer one is a gap, or the stamps jump ahead
GLITCHES = 1000  # stretches of a piece that are told apart


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
    left = time
    found: list[Disorder] = []
    start = 0
    while len(found) < GLITCHES:
        behind = _behind(left, reached)
        start += int(np.argmax(behind[start:])) if behind[start:].any() else len(time)
        if start >= len(time):
            break
        end = start + int(np.argmin(np.append(behind[start:], False)))
        after = start - int(np.argmax(left[:start][::-1] <= left[start])) if start else 0
        jump = left[after] - left[after - 1] if 0 < after < start else 0.0
        if jump > AHEAD * interval and start - after < end - start:
            off = float(time[after] - left[after - 1] - interval)
            found.append(Disorder(after, start, off, ahead=True))
            left = left.copy()
            left[after:start] = left[after - 1]
            start = after
        else:
            before = max(reached, float(left[:start].max(initial=-np.inf)))
            found.append(Disorder(start, end, before - float(time[start]), ahead=False))
            start = end
    return found


def _behind(time: Array, reached: float) -> Booleans:
    """Which stamps lie before one that came earlier, (n,)."""
    former = np.maximum.accumulate(np.append(reached, time[:-1]))
    return np.asarray(time < former)
