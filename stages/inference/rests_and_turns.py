"""Rests and turns of a campaign as the equations of the gyros take them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.inference.random_walk import Stretch
from stages.inference.traces import NONE, Traces

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Earth:
    """The earth's rate at the site, rad/s: upward part, its sigma, size of the level part."""

    up: float
    up_sigma: float
    level: float


@dataclass(frozen=True)
class Position:
    """A set position: where up is, and what is known of north, in body axes.

    `north` where mark and heading are given; `mark` where only the mark is; else
    the azimuth is an unknown of this position.
    """

    name: str
    up: Array
    mark: Array | None = None
    north: Array | None = None


@dataclass(frozen=True)
class Still:
    """A rest: mean rates (3,), rad/s, and their sigma; `angle` turned since the start, rad."""

    position: Position
    mean: Array
    sigma: Array
    about: Array
    angle: float = 0.0
    traces: Traces = NONE
    stretch: Stretch | None = None


@dataclass(frozen=True)
class Bridge:
    """A missing stretch of a turn, before the block `before`.

    The table turned in it by the sum of `shares` (k,) times the angles of the blocks;
    `seconds`: how long it is.
    """

    before: int
    seconds: float
    shares: Array


@dataclass(frozen=True)
class Turn:
    """A whole turn from rest to rest, in blocks.

    `sums`: (k, 3), rad; `seconds`: (k,); `angle`, `angle_sigma`: rad; `density` and
    `quiet_density`: (3,), rad/√s, white noise while turning and at rest. `by_hand`: the
    axis sways on the way, so only the sums over the whole turn are used. `bridges`: what is
    missing between the blocks; `bridged_sigma`: rad, of the angle that the table turned there.
    `unsteady`: blocks in which the case rings ever more, or less, where it rings.
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
    bridges: Sequence[Bridge] = ()
    bridged_sigma: float = 0.0
    unsteady: Sequence[int] = ()
    traces: Traces = NONE
    stretch: Stretch | None = None

    @property
    def weights(self) -> Array:
        """How often each block counts in the turn as a whole, (k,)."""
        return np.ones(len(self.seconds)) + sum((b.shares for b in self.bridges), np.zeros(1))

    @property
    def alone(self) -> NDArray[np.bool_]:
        """Which blocks count by themselves too, (k,): those that no missing stretch cuts short.

        In a full block a steady oscillation of the case averages out; beside a gap it may not.
        """
        cut = [b.before - side for b in self.bridges for side in (0, 1)] + list(self.unsteady)
        return ~np.isin(np.arange(len(self.seconds)), cut) | self.by_hand

    @property
    def elapsed(self) -> Array:
        """The middle of each block since the first began, (k,), s."""
        return self._past(self.seconds, [b.seconds for b in self.bridges])

    def turned(self, angle: Array) -> Array:
        """The angle of the table at the middle of each block, (k,), from those of the blocks."""
        return self._past(angle, [float(b.shares @ angle) for b in self.bridges])

    def _past(self, own: Array, missing: Sequence[float]) -> Array:
        """What has passed at the middle of each block: of the blocks, and of what is missing."""
        past = np.cumsum(own) - own / 2
        for bridge, passed in zip(self.bridges, missing, strict=True):
            past[bridge.before :] += passed
        return np.asarray(past)


@dataclass(frozen=True)
class Steady:
    """A stretch of a turn at a known rate: mean rates (3,), rad/s, sigma, rate and its sigma.

    `seconds`, `elapsed`: (k,), of its blocks, how long each is and when its middle is, s.
    """

    position: Position
    about: Array
    rate: float
    rate_sigma: float
    seconds: Array
    elapsed: Array
    mean: Array
    sigma: Array
    traces: Traces = NONE
    stretch: Stretch | None = None
