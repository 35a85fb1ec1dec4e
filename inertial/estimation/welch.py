"""Welch's power spectrum of static stretches, from pieces, for drawing beside the model.

Segments of a stretch that overlap by half, less their means and Hann-weighted; no segment spans a
gap, and a stretch shorter than a segment does not contribute. For frequencies below the segments'
the same is done with means over 4 samples, and over 4 of those; of these only what is below a
sixteenth of their sampling rate is used, where a mean changes the density by 1.3 % at the most.

The degrees of freedom account for the overlap and for neighbouring bins, which a Hann window
correlates: by (1/6)² and by (2/3)², (1/6)² (P. D. Welch, IEEE Trans. Audio Electroacoust. 15, 1967,
70; G. Heinzel et al., Spectrum and spectral density estimation by the DFT, 2002).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.estimation.spectrum import periodogram

MEAN_OF = 4  # values of a level make one of the next
OVERSAMPLED = 16  # sampling rate of a level over its highest frequency, except for the first
SEGMENTS = (64, 1024)  # values of a segment, at the least and at the most
LONGEST_SEGMENTS = 4  # segments in the longest stretch, at the least
FIRST_BIN = 2.5  # bins: below it, what is slower than a segment leaks in
BATCH = 16  # segments that are transformed together
BINS_PER_DECADE = 30  # of the drawn spectrum
OVERLAP = (1 / 6) ** 2  # squared correlation of segments that overlap by half
NEIGHBOUR = ((2 / 3) ** 2, (1 / 6) ** 2)  # and of a bin with the next, and the next but one


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Power density in b bins of frequency.

    frequency: (b,), Hz, mean of the bin; edges: (b, 2), Hz; density: (b, c), both-sided, U²/Hz, as
    N² of a white noise N; degrees: (b,), equivalent degrees of freedom.
    """

    frequency: Array
    edges: Array
    density: Array
    degrees: Array

    def in_ranges(self, ranges: Array) -> Booleans:
        """Which bins lie in one of the ranges of frequency, (l, 2), Hz, at least in part: (b,)."""
        touched = (self.edges[:, :1] <= ranges[:, 1]) & (self.edges[:, 1:] >= ranges[:, 0])
        return np.asarray(touched.any(axis=1))


def segment_for(lengths: Sequence[int]) -> int:
    """The length of the segments for stretches of so many samples, a power of two."""
    least, most = SEGMENTS
    longest = max(lengths, default=0) // LONGEST_SEGMENTS
    return int(np.clip(2 ** int(np.log2(max(longest, 1))), least, most))


class WelchSums:
    """Sums of periodograms, from consecutive pieces of one stretch after the other."""

    def __init__(self, channels: int, interval: float, segment: int) -> None:
        """`channels`: c; `interval`: s, between samples; `segment`: samples."""
        self.channels, self.interval, self.segment = channels, interval, segment
        self._power: list[Array] = []
        self._count: list[int] = []
        self.end()

    def end(self) -> None:
        """The stretch ends: the next piece belongs to another one."""
        self._held: list[Array] = []
        self._unaveraged: list[Array] = []

    def add(self, piece: Array) -> None:
        """The next samples of the stretch, (n, c), at a regular interval, none missing."""
        values = np.asarray(piece, np.float64)
        level = 0
        while len(values):
            if level == len(self._held):
                self._held.append(np.zeros((0, self.channels)))
                self._unaveraged.append(np.zeros((0, self.channels)))
            self._held[level] = self._segments(level, np.concatenate([self._held[level], values]))
            values = np.concatenate([self._unaveraged[level], values])
            whole = len(values) // MEAN_OF * MEAN_OF
            self._unaveraged[level] = values[whole:]
            values = values[:whole].reshape(-1, MEAN_OF, self.channels).mean(axis=1)
            level += 1

    def _segments(self, level: int, values: Array) -> Array:
        """Add the segments of a level; what the next one needs is returned."""
        half = self.segment // 2
        count = len(values) // half - 1
        if count < 1:
            return values
        if level == len(self._power):
            self._power.append(np.zeros((half - 1, self.channels)))
            self._count.append(0)
        rate = 1 / (self.interval * MEAN_OF**level)
        windows = np.lib.stride_tricks.sliding_window_view(values, self.segment, axis=0)[::half]
        for start in range(0, count, BATCH):  # a few at a time: memory
            some = windows[start : min(start + BATCH, count)]
            centred = some - some.mean(axis=-1, keepdims=True)
            self._power[level] += periodogram(centred, rate).sum(axis=0).T
        self._count[level] += count
        return values[count * half :]

    def spectrum(self, per_decade: int = BINS_PER_DECADE) -> Spectrum:
        """The mean of all segments of all stretches, in bins of frequency."""
        rows = []
        for level, (power, count) in enumerate(zip(self._power, self._count, strict=True)):
            rate = 1 / (self.interval * MEAN_OF**level)
            frequency = np.arange(1, self.segment // 2) * rate / self.segment
            last = level + 1 == len(self._power)
            lowest = FIRST_BIN * rate / self.segment
            used = frequency >= (lowest if last else max(rate / MEAN_OF / OVERSAMPLED, lowest))
            used &= frequency < rate / (OVERSAMPLED if level else 2)
            name = np.floor(np.log10(frequency * self.interval) * per_decade)
            independent = count / (1 + 2 * OVERLAP * (1 - 1 / count))
            for one in np.unique(name[used]):
                own = used & (name == one)
                bins = int(own.sum())
                alike = 1 + 2 * sum(
                    share * max(1 - (i + 1) / bins, 0) for i, share in enumerate(NEIGHBOUR)
                )
                half_width = rate / self.segment / 2
                rows.append(
                    (
                        float(frequency[own].mean()),
                        (frequency[own].min() - half_width, frequency[own].max() + half_width),
                        power[own].mean(axis=0) / count,
                        2 * independent * bins / alike,
                    )
                )
        rows.sort(key=lambda row: row[0])
        return Spectrum(
            np.array([row[0] for row in rows]),
            np.array([row[1] for row in rows]).reshape(-1, 2),
            np.array([row[2] for row in rows]).reshape(-1, self.channels),
            np.array([row[3] for row in rows]),
        )
