"""Oscillations of a piece of a log: where, of what frequency, in which channels, how large."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.fft import rfft

from inertial.arrays import Array, Booleans, Integers
from inertial.signal.detector import Log, Piece
from inertial.signal.runs import new_readings, records_of_a_reading
from inertial.signal.spectral_lines import (
    HOP,
    PART_BINS,
    STRETCH_WINDOWS,
    WINDOW,
    Line,
    edges,
    hann,
    in_windows,
    line_of_one,
    lines,
    phasors,
    windows,
)

MIN_FREQUENCY = 2.0  # Hz: what is slower is motion
# Sigma: what another channel has of an oscillation at the least, to be named
MIN_COUPLING_SIGMA = 5.0
MAX_INTERPOLATED = 8  # intervals between two readings at the most, to be interpolated
MIN_RECORDED_SHARE = 0.5  # of the readings of a channel at the least
EXCERPT_READINGS = (24, 64)  # readings of a log that is examined as a whole
MIN_FULL_SHARE = 0.9  # of the usual size: a window in which the oscillation is there all the time
MIN_FULL_WINDOWS = 2  # such windows


@dataclass(frozen=True)
class Tone:
    """An oscillation in the places [start, end) of a piece.

    frequency, resolved: Hz; amplitude: unit of its channel; clear: the amplitude in units of the
    noise of one reading; others: channels in step with it, and their amplitudes; rate: samples per
    second; p_value: chance of it, the search of a campaign paid for.
    """

    channel: int
    start: int
    end: int
    frequency: float
    resolved: float
    amplitude: float
    clear: float
    others: tuple[tuple[int, float], ...]
    rate: float
    p_value: float
    by_window: "ByWindow"


@dataclass(frozen=True, eq=False)
class ByWindow:
    """An oscillation in the k windows of its stretch.

    places: (k, 2), of the first and last reading in the piece; squares: (k,), of its amplitude;
    noise: what noise alone has of these on the mean.
    """

    places: Integers
    squares: Array
    noise: float

    def size(self, within: Booleans) -> tuple[float, float]:
        """The square of the amplitude over some of the windows, and its sigma by noise."""
        count = int(within.sum())
        # Of windows that overlap by half about one in two is independent.
        return (
            float(self.squares[within].mean()) - self.noise,
            self.noise * float(np.sqrt(2 / count)),
        )


@dataclass(frozen=True, eq=False)
class Triad:
    """The readings of a sensor as an even row.

    places: (n,), in the piece; values: (n, 3), single readings that are missing interpolated, NaN
    where too many are; time: (n,), intervals; rate: readings per second; window: readings.
    """

    first_channel: int
    places: Integers
    values: Array
    time: Array
    rate: float
    window: int

    def cut(self, axis: int, line: Line | None = None) -> Array:
        """The windows of an axis, (k, window), all or those of a line."""
        return windows(self.values[self._part(line), axis], self.window)

    def times(self, line: Line | None = None) -> Array:
        """The times of the same, (k, window)."""
        return in_windows(self.time[self._part(line)], self.window)

    def _part(self, line: Line | None) -> slice:
        if line is None:
            return slice(None)
        return slice(line.first * HOP, (line.after - 1) * HOP + self.window)


@dataclass(frozen=True, eq=False)
class AxisLine:
    """A line of one axis of a triad, its amplitude and that in units of the noise."""

    triad: Triad
    axis: int
    line: Line
    amplitude: float
    clear: float

    @property
    def frequency(self) -> float:
        """Hz."""
        return self.line.frequency * self.triad.rate

    @property
    def resolved(self) -> float:
        """Hz, the width of a bin."""
        return self.triad.rate / self.triad.window

    @property
    def extent(self) -> tuple[int, int]:
        """Its windows as places of the piece, first and last."""
        last = (self.line.after - 1) * HOP + self.triad.window - 1
        return int(self.triad.places[self.line.first * HOP]), int(self.triad.places[last])


def tones(piece: Piece, log: Log) -> Iterator[Tone]:
    """The oscillations of a piece, each with the channel in which it is largest."""
    triads = [triad for sensor in range(2) for triad in _triads(piece, log, sensor)]
    remaining = [
        line for triad in triads for axis in range(3) for line in _axis_lines(triad, axis, log)
    ]
    while remaining:
        strongest = max(remaining, key=lambda line: line.clear)
        alike = [line for line in remaining if _same(line, strongest)]
        remaining = [line for line in remaining if line not in alike]
        own = [line for line in alike if line.triad is strongest.triad]
        largest = max(own, key=lambda line: line.amplitude)
        yield _tone(largest, alike, triads, log)


def _triads(piece: Piece, log: Log, sensor: int) -> Iterator[Triad]:
    """The accelerometers, 0, or the gyros, 1, if they are recorded, in even steps of time.

    Of a sensor that is slower than its log, readings alone: held from one to the next they have
    images of every motion beside the frequency of the sensor, which are in step as a tone is.
    """
    first_channel = 3 * sensor
    readings = piece.values[:, first_channel : first_channel + 3]
    there = np.isfinite(readings)
    places = np.flatnonzero(there.any(axis=1))
    records = records_of_a_reading(float(log.held[sensor]))
    if records > 1:
        places = places[new_readings(readings[places])]
    steps = np.rint(np.diff(piece.time[places]) / log.interval)
    if not len(places) or not np.isfinite(steps).all():
        return
    # Stamps may jitter; what counts is how many intervals lie between two readings. One that is
    # held for 1.25 records is there once or twice.
    steps = np.floor((np.maximum(steps, 1.0) - 1) / records) + 1
    interval = records * log.interval
    read = np.append(0.0, np.cumsum(steps))
    # A few that are missing are interpolated like single channels; a longer gap stays one.
    known = np.repeat(
        np.arange(len(steps)), np.where(steps <= MAX_INTERPOLATED, steps, 1).astype(np.int64)
    )
    since = np.arange(len(known)) - np.searchsorted(known, known)
    time = np.append(read[known] + since, read[-1])
    values = np.full((len(time), 3), np.nan)
    for axis in range(3):
        own = there[places, axis]
        if own.mean() > MIN_RECORDED_SHARE:
            values[:, axis] = np.interp(time, read[own], readings[places[own], axis])
    excerpt = EXCERPT_READINGS[0] <= len(time) <= EXCERPT_READINGS[1]
    if excerpt or len(time) >= WINDOW + (STRETCH_WINDOWS[0] - 1) * HOP:
        even = np.append(places[known], places[-1])
        window = len(time) if excerpt else WINDOW
        yield Triad(first_channel, even, values, time, 1 / interval, window)


def _axis_lines(triad: Triad, axis: int, log: Log) -> Iterator[AxisLine]:
    """The lines of one axis that are faster than a motion and larger than rounding makes them."""
    if not np.isfinite(triad.values[:, axis]).all():
        return
    cut, time = triad.cut(axis), triad.times()
    count = float(np.nan_to_num(log.quantum[triad.first_channel + axis]))
    for line in lines(cut, time) if triad.window == WINDOW else line_of_one(cut, time):
        # Windows at its ends may hold but part of it.
        inner = 1 if line.after - line.first > STRETCH_WINDOWS[0] else 0
        part = slice(line.first + inner, line.after - inner)
        amplitude, noise = _size(cut[part], time[part], line.frequency)
        if line.frequency * triad.rate >= MIN_FREQUENCY and (
            amplitude > count or noise > count / 2
        ):
            yield AxisLine(triad, axis, line, amplitude, amplitude / noise)


def _size(cut: Array, time: Array, frequency: float) -> tuple[float, float]:
    """The amplitude of a line over windows, and the noise of one reading."""
    weights = hann(cut.shape[1])
    power = np.abs(rfft(cut, axis=1)[:, PART_BINS:-1]) ** 2
    variance = float(np.median(power) / np.log(2) / (weights @ weights))
    square = float(np.mean(np.abs(phasors(cut, time, frequency)) ** 2))
    # What noise adds to the square of a phasor.
    square -= 4 * variance * float(weights @ weights) / weights.sum() ** 2
    return float(np.sqrt(max(square, 0.0))), float(np.sqrt(max(variance, 1e-300)))


def _same(line: AxisLine, other: AxisLine) -> bool:
    """Whether two lines may be one oscillation: the same frequency at the same time."""
    (start, end), (begin, finish) = line.extent, other.extent
    shared = min(end, finish) - max(start, begin)
    shorter = min(end - start, finish - begin)
    near = abs(line.frequency - other.frequency) < max(line.resolved, other.resolved)
    return near and shared > shorter / 2


def _tone(largest: AxisLine, alike: list[AxisLine], triads: list[Triad], log: Log) -> Tone:
    """A line with the other channels that have it."""
    triad, frequency = largest.triad, largest.line.frequency
    line, start, end = largest.line, 0, len(triad.places)
    if triad.window == WINDOW:
        start, end = _extent(largest)
        # Windows that lie within it as a whole give its amplitude.
        line = replace(line, first=-(-start // HOP), after=(end - WINDOW) // HOP + 1)
        line = line if line.after - line.first >= MIN_FULL_WINDOWS else largest.line
    amplitude, noise = _size(triad.cut(largest.axis, line), triad.times(line), frequency)
    # An increment is the mean over its interval, which is less than the rate at an instant.
    whole = 1 / float(np.sinc(frequency)) if log.increments else 1.0
    shares = _shares(replace(largest, line=line), alike, triads)
    return Tone(
        channel=triad.first_channel + largest.axis,
        start=int(triad.places[start]),
        end=int(triad.places[end - 1]) + 1,
        frequency=largest.frequency,
        resolved=largest.resolved,
        amplitude=whole * amplitude,
        clear=amplitude / noise,
        others=tuple((channel, whole * amplitude * share) for channel, share in shares),
        rate=triad.rate,
        p_value=min(other.line.p_value for other in alike),
        by_window=_by_window(triad, largest.axis, line, noise, whole),
    )


def _by_window(triad: Triad, axis: int, line: Line, noise: float, whole: float) -> ByWindow:
    """A line by windows; `noise`: of a reading; `whole`: the rate's amplitude by a reading's."""
    if triad.window != WINDOW:
        return ByWindow(np.zeros((0, 2), np.int64), np.zeros(0), 0.0)
    cut, weights = triad.cut(axis, line), hann(triad.window)
    squares = np.abs(phasors(cut, triad.times(line), line.frequency)) ** 2
    starts = HOP * np.arange(line.first, line.first + len(cut))
    places = np.column_stack([triad.places[starts], triad.places[starts + WINDOW - 1]])
    by_noise = 4 * noise**2 * float(weights @ weights) / weights.sum() ** 2
    return ByWindow(places, whole**2 * squares, whole**2 * by_noise)


def _extent(largest: AxisLine) -> tuple[int, int]:
    """The readings of a line: the first, and the one after the last."""
    triad, line = largest.triad, largest.line
    sizes = np.abs(phasors(triad.cut(largest.axis, line), triad.times(line), line.frequency))
    whole = line.first + np.flatnonzero(sizes > MIN_FULL_SHARE * np.median(sizes))
    inside = int(whole[0]) * HOP + WINDOW // 2, int(whole[-1]) * HOP + WINDOW // 2
    outside = line.first * HOP - WINDOW, (line.after + 1) * HOP + WINDOW
    return edges(
        triad.values[:, largest.axis],
        triad.time,
        inside,
        (max(outside[0], 0), min(outside[1], len(triad.time))),
        line.frequency,
    )


def _shares(
    largest: AxisLine, alike: list[AxisLine], triads: list[Triad]
) -> Iterator[tuple[int, float]]:
    """The other channels that have an oscillation, and their part of its amplitude."""
    line, time = largest.line, largest.triad.times(largest.line)
    own = phasors(largest.triad.cut(largest.axis, line), time, line.frequency)
    square = float(np.vdot(own, own).real)
    for triad in triads:
        amplitudes = {
            other_line.axis: other_line.amplitude
            for other_line in alike
            if other_line.triad is triad
        }
        for axis in range(3):
            if (triad is largest.triad and axis == largest.axis) or np.isnan(triad.values[0, axis]):
                continue
            if len(own) == 1 or not np.array_equal(triad.places, largest.triad.places):
                share, clear = amplitudes.get(axis, 0.0) / largest.amplitude, axis in amplitudes
            else:
                other = phasors(triad.cut(axis, line), time, line.frequency)
                in_step = np.vdot(own, other) / square
                left = float(np.linalg.norm(other - in_step * own)) / np.sqrt(len(own) - 1)
                share = float(np.abs(in_step))
                clear = share * np.sqrt(square) > MIN_COUPLING_SIGMA * left
            if clear:
                yield triad.first_channel + axis, share
