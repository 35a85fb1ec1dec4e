"""Where an oscillation begins and ends, to the record."""

import numpy as np

from stages.detectors.detector import Array

FITTED = 512  # readings at the most, inside, from which amplitude and phase are had
LONGEST = 101  # readings of the moving mean that is taken off


def edges(
    values: Array, time: Array, inside: tuple[int, int], outside: tuple[int, int], frequency: float
) -> tuple[int, int]:
    """The first reading of an oscillation, and the one after its last.

    From readings well inside it the oscillation s is continued to the outside. Each reading y says
    by (y − s/2) s whether it has it or not (the logarithm of the likelihood ratio in white noise);
    the edge is where the sum of this over all readings within is largest.

    Parameters
    ----------
    values : (n,), readings
    time : (n,), intervals
    inside : places between which it certainly is
    outside : places beyond which it is not looked for
    frequency : cycles per interval
    """
    level = _levelled(values, frequency)
    first, after = inside
    length = min(after - first, FITTED)
    start = _edge(level, time, slice(first, first + length), outside[0], frequency)
    end = _edge(
        level[::-1],
        time[::-1],
        slice(len(level) - after, len(level) - after + length),
        len(level) - outside[1],
        frequency,
    )
    return start, len(level) - end


def _edge(level: Array, time: Array, inside: slice, outside: int, frequency: float) -> int:
    """The first place of an oscillation that is there `inside`, and not before `outside`."""
    # Times are large where a log is long; the phase is counted from the reading that is nearest.
    phase = 2 * np.pi * frequency * (time - time[inside.start])
    columns = np.column_stack([np.cos(phase), np.sin(phase)])
    parts = np.linalg.lstsq(columns[inside], level[inside], rcond=None)[0]
    tone = columns[outside : inside.start] @ parts
    # The corner of a ramp leaves more than any oscillation; no reading says more than twice its.
    most = 2 * float(np.linalg.norm(parts))
    says = (np.clip(level[outside : inside.start], -most, most) - tone / 2) * tone
    # Summed from the inside out; nothing more than what is inside is one of the choices.
    together = np.append(0.0, np.cumsum(says[::-1]))
    return int(inside.start) - int(np.argmax(together))


def _levelled(values: Array, frequency: float) -> Array:
    """Readings less their moving mean over as near to whole periods as an odd number may be."""
    lengths = np.arange(3, min(int(4 / frequency) + 3, LONGEST, len(values)) + 1, 2)
    passed = np.abs(np.sin(np.pi * frequency * lengths) / (lengths * np.sin(np.pi * frequency)))
    length = int(lengths[np.argmin(passed)])
    padded = np.pad(values - values.mean(), length // 2, mode="reflect", reflect_type="odd")
    sums = np.append(0.0, np.cumsum(padded))
    return np.asarray(values - values.mean() - (sums[length:] - sums[:-length]) / length)
