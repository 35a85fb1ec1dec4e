"""How the noise of a record goes with the frequency.

A filter of the sensor, or a vibration, colours the noise. A line is judged by the noise about its
own frequency: by that of the whole band, of which a filter takes the upper part, every wave of the
noise below would be a line.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.probability import chi2_sf
from inertial.estimation.spectrum import (
    BINS_PER_INDEPENDENT_BIN,
    WHITE,
    NoiseShape,
    detrended,
    periodogram,
)

Array = NDArray[np.float64]

CELL_BINS = 8.0  # of each record in a cell of the spectrum; a line fills three or four
CELL_RATIO = 1.1  # of the ends of a cell, at least
MAX_CHANCE = 1e-4  # that white noise counts as coloured
MEDIAN_VARIANCE = 1 / np.log(2) ** 2  # relative, times n, of the median of n exponential bins


def noise_shape(records: Sequence[Array], rate: float, lowest: float) -> NoiseShape:
    """The shape that records have in common; `WHITE` where they differ from that by chance alone.

    By the median in each cell of the spectrum, to which a line adds too few bins to count.

    Parameters
    ----------
    records : each (n,), samples without gaps; their levels may differ
    rate : Hz, samples per second; lowest : Hz, below which the noise may be drift
    """
    frequencies, levels = [], []
    for record in records:
        density = periodogram(detrended(record[:, None]).T, rate)[0]
        frequency = np.arange(1, len(density) + 1) * rate / len(record)
        frequencies.append(frequency[frequency >= lowest])
        levels.append(density[frequency >= lowest])
    return shape_of(frequencies, levels)


def shape_of(frequencies: Sequence[Array], levels: Sequence[Array]) -> NoiseShape:
    """The same by the periodogram of each record: frequencies, Hz, and levels, (bins,) each."""
    there = [(f, level) for f, level in zip(frequencies, levels, strict=True) if level.any()]
    edges = _cells([frequency for frequency, _level in there])
    if len(edges) < 3:
        return WHITE
    frequency = np.concatenate([frequency for frequency, _level in there])
    level = np.concatenate([level / np.median(level[level > 0]) for _frequency, level in there])
    order = np.argsort(np.searchsorted(edges[1:-1], frequency, side="right"), kind="stable")
    counts = np.bincount(np.searchsorted(edges[1:-1], frequency, side="right"))
    cells = np.split(level[order], np.cumsum(counts)[:-1])
    medians = np.array([np.median(cell) if len(cell) else 0.0 for cell in cells])
    known = medians > 0
    found, count = np.log(medians[known]), counts[known] / BINS_PER_INDEPENDENT_BIN
    weight = count / MEDIAN_VARIANCE
    apart = float(weight @ (found - np.average(found, weights=weight)) ** 2)
    if chi2_sf(apart, len(found) - 1) > MAX_CHANCE:
        return WHITE
    about = np.pad(found, 1, mode="reflect", reflect_type="odd")
    smooth = np.convolve(about, (0.25, 0.5, 0.25), "valid")
    middle = (edges[1:] + edges[:-1]) / 2
    return NoiseShape(middle[: len(known)][known], np.exp(smooth / 2))


def _cells(frequencies: Sequence[Array]) -> Array:
    """The ends of the cells, Hz, in each of which the usual record has bins enough."""
    longest = [frequency for frequency in frequencies if len(frequency) > 1]
    if not longest:
        return np.zeros(0)
    bin_width = float(np.median([frequency[1] - frequency[0] for frequency in longest]))
    edges = [float(min(frequency[0] for frequency in longest))]
    highest = float(max(frequency[-1] for frequency in longest))
    while True:
        following = max(edges[-1] * CELL_RATIO, edges[-1] + CELL_BINS * bin_width)
        if following + CELL_BINS * bin_width / 2 > highest:
            return np.array([*edges, highest])
        edges.append(following)
