"""The angle of the table's encoder: at the edges of stretches, in windows of turns, its jumps."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from inertial.arrays import Array, Integers
from inertial.campaign.masked_samples import Accumulator, Batch
from inertial.campaign.static_positions import Blocks
from inertial.campaign.sums import Stretches, rows_in
from inertial.estimation.gyroscope_observations import EncoderWindow, RateSegment
from inertial.physics.motion import component
from inertial.signal.scatter import MAD_TO_SIGMA
from inertial.tables import GYRO

# ---- The angle of the table's encoder where stretches of the records of a log begin and end.

EDGE_SAMPLES = 8  # by which the rate of the table at the edge of a block is known


@dataclass(frozen=True)
class Edges:
    """The encoder's angle, rad, and rate, rad/s, at the beginning and end of k stretches, (k,)."""

    angle_from: Array
    angle_to: Array
    rate_from: Array
    rate_to: Array


class EdgesOver:
    """The angle of the table's encoder where stretches of records begin and end.

    It is read at the end of a sample; where the first one began it was by its rate, which is that
    of a parabola through the first samples.
    """

    columns = ("time", "table_angle")

    def __init__(self, stretches: Stretches) -> None:
        self._stretches = stretches
        self._ends: dict[str, dict[int, tuple[Array, Array]]] = {log: {} for log in stretches}

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        read = np.column_stack([batch["time"], batch["table_angle"]])
        for k, start, end in stretches_with_angle(batch, self._stretches):
            own = self._ends[batch.log]
            first, last = own.get(k, (read[:0], read[:0]))
            more = read[start : min(end, start + EDGE_SAMPLES - len(first))]
            tail = np.concatenate([last, read[max(start, end - EDGE_SAMPLES) : end]])
            own[k] = np.concatenate([first, more]), tail[-EDGE_SAMPLES:]

    def result(self) -> dict[str, Edges]:
        """By log, in the order of the stretches; NaN where the encoder gives nothing."""
        result = {}
        for log, (first, _after) in self._stretches.items():
            found = np.full((len(first), 4), np.nan)
            for k, (head, tail) in self._ends[log].items():
                step = (tail[-1, 0] - tail[0, 0]) / max(len(tail) - 1, 1)
                found[k, [0, 2]] = _at_edge(head, head[0, 0] - step)
                found[k, [1, 3]] = _at_edge(tail, tail[-1, 0])
            result[log] = Edges(*found.T)
        return result


def stretches_with_angle(batch: Batch, stretches: Stretches) -> Iterator[tuple[int, int, int]]:
    """The stretches of which a batch with the encoder's angle has rows [start, end)."""
    if np.isnan(batch["table_angle"]).all():
        return
    if found := rows_in(batch, stretches):
        for k, start, end in zip(found.stretches, found.starts, found.ends, strict=True):
            yield int(k), int(start), int(end)


def _at_edge(read: Array, time: float) -> tuple[float, float]:
    """Angle and rate at an edge by samples next to it: n times and angles, (n, 2)."""
    if len(read) < 4 or not np.isfinite(read).all():
        return np.nan, np.nan
    near = int(np.argmin(np.abs(read[:, 0] - time)))
    curved, rate, _angle = np.polyfit(read[:, 0] - time, read[:, 1], 2)
    ago = float(read[near, 0] - time)
    return float(read[near, 1] - rate * ago - curved * ago**2), float(rate)


# ---- Windows of the angle of a turn, by the table's encoder.

MAX_WINDOWS = 24  # of a turn: enough for what repeats with each turn of the encoder


def windows_of(part: Blocks, about: Array) -> list[EncoderWindow]:
    """The windows of a turn by its k blocks, none where the encoder is not used in all of them.

    They meet in the steady part alone, where the rate of the table is the same on both sides, so
    that a delay does not matter there; or they end at a gap.
    """
    encoder = part.encoder
    if not len(part) or not np.isfinite(encoder).all() or (part.phase == "turning").any():
        return []
    read = np.nan_to_num(part.gyro) @ about * part.seconds
    sense = float(np.sign(read @ (encoder[:, 1] - encoder[:, 0])))
    steady, apart = part.steady, part.missing != 0
    least = max(1, -(-len(part) // MAX_WINDOWS))
    edges = [0]
    for i in range(1, len(part)):
        if apart[i] or (steady[i - 1] and steady[i] and i - edges[-1] >= least):
            edges.append(i)
    angles = sense * encoder[:, :2]
    windows: list[EncoderWindow] = []
    for first, after in pairwise([*edges, len(part)]):
        joins = windows and not apart[first]
        start = windows[-1].end if joins else float(angles[first, 0])
        change = sense * float(encoder[after - 1, 3] - encoder[first, 2])
        windows.append(
            EncoderWindow(first, after, start, float(angles[after - 1, 1]), change, sense)
        )
    return windows


def by_windows(segment: RateSegment, part: Blocks, angle_sigma: float) -> RateSegment:
    """A turn, or a part of one, by the angle of the encoder; as it is where that is not used.

    What the gyros scatter by in motion beyond their noise at rest is an oscillation, of which a
    window may hold any phase at either end.
    """
    windows = windows_of(part, segment.about)
    if not windows:
        return segment
    excess = np.nan_to_num(segment.density**2 - segment.quiet_density**2) @ segment.about**2
    swing = max(float(excess), 0.0) * float(np.median(part.seconds))
    angle_sigma = float(np.sqrt(angle_sigma**2 + swing))
    middle = windows[0].sense * part.encoder[:, :2].mean(axis=1)
    course = np.asarray(middle - windows[0].start)
    return replace(segment, windows=windows, course=course, angle_sigma=angle_sigma)


# ---- Jumps of the angle of the table's encoder that the gyros do not feel, in stretches of
# records.

JUMP_SECONDS = 0.1  # within which an encoder jumps, in its log of 10 Hz or more
MIN_SCATTERS = 10.0  # of the differences over that time, from which one is a jump
MAX_EVEN_PAUSE = 1.5  # sample intervals: over more nothing is known of what the gyros felt
MIN_OWN_SHARE = 0.5  # of a jump, by which the encoder leaves its own steady course


@dataclass(frozen=True)
class Jump:
    """By how much an encoder jumps, its sigma, and at which angle it does, rad.

    before, after : records, the last that reads as before the jump, the first that reads as after
    """

    size: float
    sigma: float
    at: float
    before: int
    after: int


class JumpsOver:
    """The jumps of the encoder against the gyros in each of some stretches of records.

    An encoder and the gyros differ by a scale factor, a bias and a delay, so slowly but at the
    edges of a steady part: an encoder that is late still accelerates there, and one that is early
    slows down already. What they differ by elsewhere within a tenth of a second, beyond its median
    and ten times its scatter, is a jump of the count, for no table turns so and no gyro feels it.

    about : by log the axis of each stretch, (k, 3), unit vectors in body axes
    """

    columns = ("time", "table_angle", *GYRO)

    def __init__(self, stretches: Stretches, about: dict[str, Array]) -> None:
        self._stretches, self._about = stretches, about
        self._jumps: dict[str, list[list[Jump]]] = {
            log: [[] for _axis in axes] for log, axes in about.items()
        }

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        rates = np.column_stack([batch[name] for name in GYRO])
        for k, start, end in stretches_with_angle(batch, self._stretches):
            part, axis = slice(start, end), self._about[batch.log][k]
            along = component(rates[part], axis)
            read = batch["record"][part], batch["time"][part], batch["table_angle"][part]
            self._jumps[batch.log][k] += jumps_of(*read, along)

    def result(self) -> dict[str, list[list[Jump]]]:
        """By log, in the order of the stretches."""
        return self._jumps


def jumps_of(record: Integers, time: Array, angle: Array, rate: Array) -> list[Jump]:
    """The jumps of an encoder beyond its scatter against a gyro, in their order.

    record : (n,), ascending
    time, angle, rate : (n,), s, rad, of the encoder, and rad/s, of the gyro about the same axis
    """
    pause = np.diff(time)
    if len(pause) < 2 or not (np.isfinite(pause).all() and np.isfinite(angle).all()):
        return []
    step = float(np.median(pause))
    span = round(JUMP_SECONDS / step) if step > 0 else 0
    if span < 1 or len(time) <= 4 * span:
        return []
    sense = np.sign(np.nansum(rate * np.append(pause, step)) * (angle[-1] - angle[0]))
    off = np.diff(angle) - sense * rate[1:] * pause
    off[pause > MAX_EVEN_PAUSE * step] = np.nan  # and with it every difference over it
    own = np.diff(angle) - float(np.median(np.diff(angle) / pause)) * pause
    beyond, scatter = _differences(off, span)
    high = np.flatnonzero(np.abs(beyond) > MIN_SCATTERS * scatter)
    pad, jumps = span // 4, []
    for run in np.split(high, np.flatnonzero(np.diff(high) > span) + 1):
        # What is off for longer than the jump takes, and the window, is no jump.
        if not len(run) or run[-1] - run[0] >= 2 * span:
            continue
        # What is off from the very edge on is an encoder that is late: there it still accelerates.
        if run[0] <= pad or run[-1] >= len(beyond) - 1 - pad:
            continue
        first, last = sorted((int(run[0]) + span - 1, int(run[-1])))
        start, length = max(first - pad, 0), last - first + 1 + 2 * pad
        sums, sigma = _differences(off, length)
        size = float(sums[min(start, len(sums) - 1)])
        # Nor is what comes back, or what the encoder does not show by itself: a glitch of the gyro.
        whole = float(np.sum(off[run[0] : run[-1] + span] - np.nanmedian(off)))
        shown = float(np.sum(own[start : start + length]))
        if min(whole * size, shown * size) > MIN_OWN_SHARE * size**2:
            place = (int(record[first]), int(record[last + 1]))
            jumps.append(Jump(size, sigma, float(angle[first]), *place))
    return jumps


def _differences(off: Array, length: int) -> tuple[Array, float]:
    """What is off over so many samples, beyond its median, (n − length + 1,), and its scatter."""
    beyond = np.convolve(off, np.ones(length), "valid")
    known = np.isfinite(beyond)
    if known.sum() <= 3 * length:
        return np.zeros(len(beyond)), 0.0
    beyond = np.where(known, beyond - np.median(beyond[known]), 0.0)
    return beyond, MAD_TO_SIGMA * float(np.median(np.abs(beyond[known])))


class WithoutJumps:
    """What takes in records, with the angle of the encoder as if it had not jumped.

    jumps : by log, each of which changes all angles after it
    """

    def __init__(self, of: Accumulator, jumps: dict[str, list[Jump]]) -> None:
        self._of, self._jumps = of, jumps
        self.columns = of.columns

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        record, angle = batch["record"], batch["table_angle"]
        for jump in self._jumps.get(batch.log, ()):
            angle = angle - np.interp(record, (jump.before, jump.after), (0.0, jump.size))
        self._of.add(replace(batch, columns={**batch.columns, "table_angle": angle}))
