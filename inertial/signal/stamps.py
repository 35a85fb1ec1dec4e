"""The stamps of a log: one for each sample, their order, and the sensors that they are of.

And the true interval of increments, from the specific force at rest, without the stamps: there an
increment of a receiver is gravity times the true interval: design study, 41b.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Booleans, Integers
from inertial.signal.detector import Log, Piece
from inertial.signal.scale_factor import force_at_rest

STAMP_DIGIT_S = 1e-9  # s, the last digit of a stamp at best
MAX_RATE_ERROR = 0.01  # of the stated rate: more than any crystal is off


def samples_passed(time: Array, step: float) -> Array:
    """Samples from each stamp to the next, (n − 1,): 0 where one repeats, 1 where time goes back.

    There a counter begins again, or the clock is set: that samples were lost is not known.
    """
    passed = np.round(np.diff(time) / step)
    return np.asarray(np.where(passed < 0, 1.0, passed))


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
    """Of what these stamps or steps of them, (m,), s, are whole multiples, s; at least 1 ns."""
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


SIDE_RECORDS = 2000  # records on either side of a change in which the specific force is compared
MEAN_RECORDS = 25  # records of a mean that shows whether the IMU is at rest
MIN_MEANS = 3  # of these means
MAX_REST_RANGE = 0.02  # m/s²: at rest these means keep to it
FORCE_SIGMA = (
    3e-3  # of gravity: uncertainty of the specific force at rest by bias and scale factor, 3 mg
)
MIN_SIGMA = 4.0  # sigma


@dataclass(frozen=True)
class StampEvidence:
    """The change of |f| per record, 1, and its sigma; NaN where the readings do not show it.

    stamps: True where the stamps are off, False where the sampling is, None where either may be.
    """

    stamps: bool | None = None
    change: float = np.nan
    sigma: float = np.nan


def evidence_of_log(log: Log, away: float) -> StampEvidence:
    """Whether the specific force of a log is off gravity because its stamps are off by `away`."""
    if log.recorded_on is None:
        return StampEvidence()  # readings are no increments
    force = force_at_rest(log) / log.given.gravity - 1
    # Made with an interval that is too long, the specific force is too small.
    if abs(away) > FORCE_SIGMA and min(abs(force + away), abs(force)) < abs(away) / 3:
        return StampEvidence(bool(abs(force + away) < abs(force)), force, FORCE_SIGMA)
    return StampEvidence()


def evidence_of_part(piece: Piece, log: Log, start: int, end: int, away: float) -> StampEvidence:
    """Whether the specific force changes at the ends of records [start, end).

    There the interval by the stamps is longer by `away`, relative.
    """
    if log.recorded_on is None:
        return StampEvidence()
    sides = (
        (slice(max(start - SIDE_RECORDS, 0), start), slice(start, min(start + SIDE_RECORDS, end))),
        (slice(end, end + SIDE_RECORDS), slice(max(end - SIDE_RECORDS, start), end)),
    )
    for outside, inside in sides:
        change, sigma = _change(piece.values[outside, :3], piece.values[inside, :3])
        if np.isfinite(change):
            stamps = bool(abs(change) < abs(change - away))
            return StampEvidence(stamps if abs(away) > MIN_SIGMA * sigma else None, change, sigma)
    return StampEvidence()


def _change(before: Array, after: Array) -> tuple[float, float]:
    """The change of |f| from (n, 3) to (m, 3), relative, and its sigma; NaN unless at rest."""
    means, forces = [], []
    for values in (before, after):
        values = values[np.isfinite(values).all(axis=1)]
        k = len(values) // MEAN_RECORDS
        if k < MIN_MEANS:
            return np.nan, np.nan
        means.append(values[: k * MEAN_RECORDS].reshape(k, MEAN_RECORDS, 3).mean(axis=1))
        forces.append(np.linalg.norm(values, axis=1))
    if (np.ptp(np.concatenate(means), axis=0) > MAX_REST_RANGE).any():
        return np.nan, np.nan
    first, last = (float(force.mean()) for force in forces)
    sigmas = [float(force.std()) / np.sqrt(len(force)) for force in forces]
    return last / first - 1, float(np.hypot(*sigmas) / first)


def sent_again(time: Array | Integers, values: Array) -> Booleans:
    """Which records are the one before, that came twice and is stamped as it came, (n,).

    They have its readings, (n, c), within half of an interval, in which nothing is sampled; unless
    most that come so soon have readings of their own.
    """
    soon = np.zeros(len(time), bool)
    step = np.diff(time)
    if not np.isfinite(step).any():
        return soon
    soon[1:] = (step > 0) & (step < np.nanmedian(step) / 2)
    late = np.flatnonzero(soon)
    now, before = values[late], values[late - 1]
    same = (now == before) | (np.isnan(now) & np.isnan(before))
    again = np.zeros(len(time), bool)
    again[late] = same.all(axis=1) & np.isfinite(now).any(axis=1)
    few = 2 * np.count_nonzero(again) <= len(late)
    return np.zeros(len(time), bool) if few else again
