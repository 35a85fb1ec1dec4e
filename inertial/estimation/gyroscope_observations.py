"""Static positions and rate segments of a campaign as the equations of the gyros take them."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.estimation.effect_information import NO_SENSITIVITIES, Sensitivities
from inertial.estimation.noise_model import SQRT2
from inertial.estimation.random_walk import Stretch

EARTH_UP = ("earth", "up")  # the name of the unknown: the upward component
TABLE = "the table"  # the position that all share whose mark is known, and no heading


@dataclass(frozen=True)
class Earth:
    """The earth's rate at the site, rad/s: upward component, its sigma, horizontal component."""

    up: float
    up_sigma: float
    level: float

    def level_beside(self, up: float) -> float:
        """The horizontal component beside this upward one, rad/s: of both the sum is known.

        Without a latitude `level` and `up_sigma` are those of a direction of which nothing is
        known; its squares still have the sum of the earth's.
        """
        return float(np.sqrt(max(self.up**2 + self.up_sigma**2 + self.level**2 - up**2, 0.0)))


@dataclass(frozen=True)
class Position:
    """A set position: the upward direction, and what is known of north, in body axes.

    `north` is known where mark and heading are given; else an azimuth is an unknown: that of the
    level direction `mark`, which positions share, or without one that of this position. `azimuth`
    is the name of the unknown, where it is neither that of the table's zero mark nor that of the
    position: the axis of a tumble, or the attitude in which a record begins on the way. Where
    nothing is known of the attitude, `up` is zero and all three components of the earth's rate are
    unknowns.
    """

    name: str
    up: Array
    mark: Array | None = None
    north: Array | None = None
    azimuth: str = ""

    @property
    def is_known(self) -> bool:
        """Whether it is known which way is up."""
        return bool(self.up.any())


@dataclass(frozen=True)
class StaticRate:
    """Mean rates (3,) at rest, rad/s, and their sigma; `angle` turned since the start, rad."""

    position: Position
    mean: Array
    sigma: Array
    about: Array
    angle: float = 0.0
    sensitivities: Sensitivities = NO_SENSITIVITIES
    stretch: Stretch | None = None


@dataclass(frozen=True)
class Gap:
    """A missing part of a rate segment, before the block `before`.

    The angle of the table in it is interpolated: the sum of `shares` (k,) times the angles of the
    blocks; `seconds`: its duration.
    """

    before: int
    seconds: float
    shares: Array


@dataclass(frozen=True)
class EncoderWindow:
    """What the encoder reads while some consecutive blocks last, `first` up to `after`.

    `start`, `end`: rad, its readings; `change`: rad/s, of the rate of the table from its beginning
    to its end. All about the axis of the turn by the right-hand rule, which the encoder itself
    counts in the same `sense`, 1, or in the other, -1.
    """

    first: int
    after: int
    start: float
    end: float
    change: float
    sense: float

    @property
    def waves(self) -> tuple[float, float]:
        """By how much an error of the encoder in sine and cosine of its angle changes, (2,)."""
        own = self.sense * np.array([self.start, self.end])
        sine, cosine = (float(np.diff(wave(own))[0]) for wave in (np.sin, np.cos))
        return self.sense * sine, self.sense * cosine


@dataclass(frozen=True)
class RateSegment:
    """A whole turn from rest to rest, or a part of one that the encoder knows, in k blocks.

    `sums`: (k, 3), rad; `seconds`: (k,); `angle`, `angle_sigma`: rad; `density` and
    `quiet_density`: (3,), rad/√s, white noise while turning and at rest; `quantisation`: (3,), rad,
    white noise of the angle at every edge of the blocks. `by_hand`: the
    axis sways on the way, so only the sums over the whole turn are used. `gaps`: missing parts
    between the blocks; `gap_sigma`: rad, of the interpolated angle.
    `unsteady`: blocks in which the amplitude of an oscillation of the case changes.
    `clock`: of its log, whose rate is uncertain by `clock_sigma`, relative.
    `windows`: by the encoder, with `course`, (k,), rad, which it has turned by at the middle of
    each block; then `angle` and what is interpolated are not used, and `angle_sigma` is a window's.
    """

    position: Position
    about: Array
    angle: float
    angle_sigma: float
    sums: Array
    seconds: Array
    density: Array
    quiet_density: Array
    by_hand: bool = False
    gaps: Sequence[Gap] = ()
    gap_sigma: float = 0.0
    unsteady: Sequence[int] = ()
    sensitivities: Sensitivities = NO_SENSITIVITIES
    stretch: Stretch | None = None
    clock: str = ""
    clock_sigma: float = 0.0
    windows: Sequence[EncoderWindow] = ()
    course: Array | None = None
    quantisation: Array = field(default_factory=partial(np.zeros, 3))

    @property
    def weights(self) -> Array:
        """The weight of each block in the whole turn, (k,), 1 without gaps."""
        return np.ones(len(self.seconds)) + sum((gap.shares for gap in self.gaps), np.zeros(1))

    @property
    def usable_blocks(self) -> Booleans:
        """Which blocks give equations of their own, (k,): those that no gap cuts short.

        In a full block a steady oscillation of the case averages out; next to a gap it may not.
        """
        cut = [gap.before - side for gap in self.gaps for side in (0, 1)] + list(self.unsteady)
        return ~np.isin(np.arange(len(self.seconds)), cut) | self.by_hand

    @property
    def elapsed(self) -> Array:
        """The middle of each block since the first began, (k,), s."""
        return self._cumulated(self.seconds, [gap.seconds for gap in self.gaps])

    @property
    def noise_of_sum(self) -> Array:
        """Sigma of the weighted sum of the readings by their noise at rest, (3,), rad."""
        white = self.quiet_density * np.sqrt(self.weights**2 @ self.seconds)
        return np.hypot(white, SQRT2 * self.quantisation)

    @property
    def angle_walk(self) -> float:
        """Sigma of the sum of the readings about the axis by their white noise, rad."""
        variance = np.nan_to_num(self.density) ** 2 @ self.about**2
        return float(np.sqrt(variance * self.seconds.sum()))

    def turned(self, angle: Array) -> Array:
        """The angle of the table at the middle of each block, (k,), from those of the blocks."""
        if self.course is not None:
            return self.course
        return self._cumulated(angle, [float(gap.shares @ angle) for gap in self.gaps])

    def _cumulated(self, own: Array, missing: Sequence[float]) -> Array:
        """Sum up to the middle of each block, of the blocks and of the gaps."""
        total = np.cumsum(own) - own / 2
        for gap, amount in zip(self.gaps, missing, strict=True):
            total[gap.before :] += amount
        return np.asarray(total)


@dataclass(frozen=True)
class SteadyRate:
    """A part of a rate segment at a known rate: mean rates (3,), rad/s, sigma, rate and its sigma.

    `seconds`, `elapsed`: (k,), duration and middle of its blocks, s. `rate_sigma`: rad/s, of its
    own; `table_rate_sigma`: rad/s, of the error that all rates of the table have as one share.
    """

    position: Position
    about: Array
    rate: float
    rate_sigma: float
    seconds: Array
    elapsed: Array
    mean: Array
    sigma: Array
    sensitivities: Sensitivities = NO_SENSITIVITIES
    stretch: Stretch | None = None
    table_rate_sigma: float = 0.0


@dataclass(frozen=True)
class WholeTurn:
    """A whole turn by the gyro along its axis: summed angle of that gyro, known angle, duration.

    `clock`, `clock_sigma`: as in `RateSegment`.
    """

    summed: float  # rad
    angle: float  # rad, along the axis
    angle_sigma: float
    seconds: float
    up: float  # +1 where the axis points up, −1 where it points down
    density: float  # rad/√s
    clock: str = ""
    clock_sigma: float = 0.0
