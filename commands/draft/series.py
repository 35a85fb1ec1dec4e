"""The readings of both sensors of one recording in short means, and where they rest and move."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from inertial.arrays import Array, Integers
from inertial.signal.rests_and_motions import (
    MIN_HAND_RATE,
    MIN_MOTION_SIGMA,
    BinStretch,
    level_of_each_rest,
    moving,
    rest_level,
    stretches,
    stretches_of,
    with_slow_ends,
)
from inertial.text.messages import _
from inertial.text.numbers import significant

BIN_S, MIN_BINS = 0.1, 20  # s; of a short recording shorter ones
MIN_REST_S = 1.0  # s, of a static position
MARGIN_S = 0.5  # s, beside a motion, that belong to no static position
MIN_AS_LONG = 0.98  # of |f|, that the mean force of a rest has: gravity does not turn in it
MIN_MOVED_SHARE = 0.02  # of the largest readings of gyros whose unit is not known, to be a motion


@dataclass(frozen=True)
class Series:
    """Accelerometers (n, 3) and gyros (m, 3) over the same time, at their own rates, Hz.

    Empty where a sensor is not recorded.
    """

    accel: Array
    gyro: Array
    accel_hz: float
    gyro_hz: float

    @property
    def seconds(self) -> float:
        """How long it lasts, s."""
        return max(len(self.accel) / self.accel_hz, len(self.gyro) / self.gyro_hz)

    @property
    def bins(self) -> int:
        """How many short means."""
        most = max(len(self.accel), len(self.gyro), 1)
        return min(max(round(self.seconds / BIN_S), MIN_BINS), most)

    def bin_seconds(self) -> float:
        """The length of a mean, s."""
        return self.seconds / self.bins

    def means(self, values: Array) -> Array:
        """Short means of a sensor, (k, 3); NaN where it is not recorded."""
        if not len(values):
            return np.full((self.bins, 3), np.nan)
        edges = self.edges(values)
        counts = np.maximum(np.diff(edges), 1)[:, None]
        sums = np.add.reduceat(values, np.minimum(edges[:-1], len(values) - 1))
        return np.asarray(sums / counts)

    def edges(self, values: Array) -> Integers:
        """The rows of a sensor at which the bins begin and end, (k + 1,)."""
        return np.round(np.linspace(0, len(values), self.bins + 1)).astype(np.int64)


@dataclass(frozen=True)
class Still:
    """A static position: bins [first, after), mean readings of both sensors, (3,), and seconds."""

    first: int
    after: int
    seconds: float
    accel: Array
    gyro: Array


@dataclass(frozen=True)
class Divided:
    """A recording cut into stretches that rest or move; `level`: (3,), the gyros at rest."""

    series: Series
    forces: Array
    rates: Array
    level: Array
    stretches: Sequence[BinStretch]

    @property
    def rests(self) -> list[Still]:
        """The static positions that are long enough."""
        return list(self._rests())

    def _rests(self) -> Iterator[Still]:
        step = self.series.bin_seconds()
        for stretch in self.stretches:
            seconds = (stretch.after - stretch.first) * step
            if stretch.moves or seconds < min(MIN_REST_S, self.series.seconds / 2):
                continue
            first, after = self.inside(stretch)
            if len(self.series.accel) and not self.forces[first:after].any():
                continue  # zeros that a recorder filled up with
            yield Still(
                stretch.first,
                stretch.after,
                seconds,
                self.forces[first:after].mean(axis=0),
                self.rates[first:after].mean(axis=0),
            )

    def inside(self, rest: "BinStretch | Still") -> tuple[int, int]:
        """The bins of a rest without half a second beside a motion, which still moves."""
        room = min(round(MARGIN_S / self.series.bin_seconds()), (rest.after - rest.first) // 4)
        first = rest.first + (room if rest.first else 0)
        return first, rest.after - (room if rest.after < self.series.bins else 0)

    def passages(self) -> Iterator[tuple[Still, Still]]:
        """Each static position and the next."""
        yield from pairwise(self.rests)


def divided(series: Series, level: tuple[Array, float] | None, *, known_units: bool) -> Divided:
    """The recording in stretches; `level`: what gyros read at rest, and its scatter.

    Where units are not known, the share of the largest reading decides what is a motion.
    """
    forces, rates = series.means(series.accel), series.means(series.gyro)
    step = series.bin_seconds()
    if len(series.gyro):
        rest, scatter = rest_level(rates) if level is None else level
        noise = MIN_MOTION_SIGMA * scatter
        if known_units:
            lowest = MIN_HAND_RATE
        else:
            away = np.linalg.norm(rates - rest, axis=1)
            lowest = MIN_MOVED_SHARE * float(np.quantile(away, 0.95))
        moves = moving(rates, forces, rest, max(lowest, noise))
        levels = level_of_each_rest(stretches(moves, step, forces), rates, rest, noise)
        above = moving(rates, forces, levels, noise)
    else:
        rest = np.full(3, np.nan)
        size = 1.0 if known_units else 9.8 / float(np.median(np.linalg.norm(forces, axis=1)))
        moves = above = moving(rates, forces * size, rest, 0.0)
    found = with_slow_ends(stretches(moves, step, forces), above, step, swings=False)
    return Divided(series, forces, rates, rest, _where_gravity_stays(found, forces))


def _where_gravity_stays(found: Sequence[BinStretch], forces: Array) -> list[BinStretch]:
    """The stretches, of which those in which gravity turns are motions, however slow."""
    moves = []
    for stretch in found:
        own = forces[stretch.first : stretch.after]
        turns = np.linalg.norm(own.mean(axis=0)) < MIN_AS_LONG * np.linalg.norm(own, axis=1).mean()
        moves += [stretch.moves or bool(turns)] * len(own)
    return stretches_of(np.array(moves))


# ---- Gravity as accelerometers read it: how long it is, about which zero, and where that is in
# doubt.
#
# It has one length wherever it points, so static positions lie on a sphere about the biases.

MIN_POINTS = 4  # static positions that show a centre
MIN_SPREAD = 0.3  # of their directions, the least one to the largest
MIN_CHECKED = 6  # static positions about whose centre lengths are compared: two more than unknowns
MAX_OFF = 0.1  # of the length of a static position to the others', about their centre
MAX_OFF_BIASED = 0.15  # the same about zero: biases are in it


@dataclass(frozen=True)
class Gravity:
    """Centre, (3,), and length in the unit of the readings; `seen`: what says so; `doubt`: a
    question where static positions differ in length, else empty.
    """

    centre: Array
    length: float
    seen: str
    doubt: str = ""


def sphere(points: Array) -> tuple[Array, float, float]:
    """Centre, (3,), radius and scatter of the sphere through points (n, 3).

    About zero where the points do not show a centre. The radius is the median of their distances,
    which one point that is no static position does not change.
    """
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    centre = np.zeros(3)
    if len(points) >= MIN_POINTS and spread[-1] > MIN_SPREAD * spread[0]:
        design = np.column_stack([2 * points, np.ones(len(points))])
        centre = np.linalg.lstsq(design, np.sum(points**2, axis=1), rcond=None)[0][:3]
    lengths = np.linalg.norm(points - centre, axis=1)
    return centre, float(np.median(lengths)), float(np.std(lengths))


def gravity_in(recordings: Sequence[Divided], zero: float = 0.0) -> Gravity:
    """By the static positions; `zero`: of counts."""
    rests = np.array([rest.accel for own in recordings for rest in own.rests])
    if not len(rests):
        readings = np.concatenate([own.series.accel for own in recordings])
        length = float(np.median(np.linalg.norm(readings - zero, axis=1)))
        seen = _("nothing rests; the median of |f| is {length}", length=significant(length))
        return Gravity(np.zeros(3), length, seen)
    centre, length, _scatter = sphere(rests - zero)
    seen = _("|f| at rest is {length}", length=significant(length))
    return Gravity(centre, length, seen, _doubt(rests - zero, centre))


def _doubt(rests: Array, centre: Array) -> str:
    """A question where static positions, (n, 3), differ in length by more than biases explain."""
    checked = len(rests) >= MIN_CHECKED and bool(centre.any())
    lengths = np.linalg.norm(rests - (centre if checked else 0.0), axis=1)
    if np.abs(lengths / np.median(lengths) - 1).max() <= (MAX_OFF if checked else MAX_OFF_BIASED):
        return ""
    return _(
        "in {count} static positions |f| is {least} to {most}, and gravity has one length; is "
        "each of them a static position, with all samples in one unit?",
        count=len(lengths),
        least=significant(float(lengths.min())),
        most=significant(float(lengths.max())),
    )
