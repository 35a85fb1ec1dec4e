"""S0's campaign with exact physics, noise, and biases of the gyros that walk: what tests solve."""

from dataclasses import dataclass, field

import numpy as np

from inertial.estimation.gyroscope_observations import Earth, Position, RateSegment, StaticRate
from inertial.estimation.random_walk import COMMON_CLOCK, Stretch
from inertial.physics.site import earth_rate

UP, LEVEL = earth_rate(np.radians(30.5278))
EARTH = Earth(UP, 1e-12, LEVEL)
NOISE = np.radians(0.012 / 60)  # rad/√s, as S0's data have it
DEGREE_PER_HOUR = np.radians(1) / 3600
UNIT = DEGREE_PER_HOUR / 60  # 1 °/h/√h, in rad/s/√s
REST, STILL, PAUSE = 300.0, 10.0, 60.0  # s
BLOCKS, BLOCK = 190, 0.2  # of a turn; s
TILT = 1e-5  # rad, sigma of positions and angles


@dataclass
class Walk:
    """K W(t) of three axes: where it is, and its exact means over stretches of time."""

    size: float
    rng: np.random.Generator
    time: float = 0.0
    value: np.ndarray = field(default_factory=lambda: np.zeros(3))
    reached: list[tuple[float, np.ndarray]] = field(default_factory=list)

    def over(self, seconds: float) -> np.ndarray:
        """The mean over the next so many seconds, given where it began and ends."""
        before, step = self.value, self.size * np.sqrt(seconds)
        self.value = before + step * self.rng.standard_normal(3)
        self.time += seconds
        self.reached.append((self.time, self.value))
        return (before + self.value) / 2 + step / np.sqrt(12) * self.rng.standard_normal(3)


@dataclass(frozen=True)
class Campaign:
    """Rests and turns, the true M and bias; the bias as it is in the middle of the campaign."""

    stills: list[StaticRate]
    turns: list[RateSegment]
    matrix: np.ndarray
    bias: np.ndarray


def campaign(
    seed: int, walk: float = 0.0, g_sensitivity: float = 0.0, *, one_clock: bool = True
) -> Campaign:
    """Six rests of 300 s, then about each axis a turn forward and one backward.

    `walk`: rad/s/√s; `g_sensitivity`: rad/s per g, of each gyro to its own axis.
    """
    rng = np.random.default_rng(seed)
    matrix = np.eye(3) + 5e-3 * rng.standard_normal((3, 3))
    bias = 1e-5 * rng.standard_normal(3)
    path = Walk(walk, rng)
    stills: list[StaticRate] = []
    turns: list[RateSegment] = []

    def rest(position, stretch, about, angle=0.0):
        up = position.up
        sigma = np.full(3, NOISE / np.sqrt(stretch.seconds))
        drift = path.over(stretch.seconds) + g_sensitivity * up + sigma * rng.standard_normal(3)
        mean = matrix @ (UP * up + LEVEL * level_of(up)) + bias + drift
        stills.append(StaticRate(position, mean, sigma, about, angle, stretch=stretch))

    def stretch(name, seconds):
        return Stretch(
            name, COMMON_CLOCK if one_clock else name.partition(" ")[0], path.time, seconds
        )

    for axis in range(3):
        for sign in (1.0, -1.0):
            up = sign * np.eye(3)[axis]
            rest(Position(f"{axis}{sign}", up), stretch(f"rest{axis}{sign}", REST), up)
            path.over(PAUSE)
    for axis in range(3):
        for sign in (1.0, -1.0):
            up, name = np.eye(3)[axis], f"turn{axis}{sign}"
            position = Position(name, up)
            rest(position, stretch(f"{name} before", STILL), up)
            moving = stretch(name, BLOCKS * BLOCK)
            rate = np.interp(np.arange(BLOCKS), [0, 10, 180, 190], [0, 1, 1, 0])
            rate *= sign * 2 * np.pi / rate.sum()
            angle = np.cumsum(rate) - rate / 2
            level = level_of(up)
            side = np.cross(up, level)
            north = LEVEL * (np.outer(np.cos(angle), level) - np.outer(np.sin(angle), side))
            truth = np.outer(rate, up) + BLOCK * (UP * up + north)
            drifts = np.array([path.over(BLOCK) for _ in range(BLOCKS)]) + g_sensitivity * up
            noise = NOISE * np.sqrt(BLOCK) * rng.standard_normal((BLOCKS, 3))
            sums = truth @ matrix.T + BLOCK * (bias + drifts) + noise
            density, seconds = np.full(3, NOISE), np.full(BLOCKS, BLOCK)
            turned = sign * 2 * np.pi
            about = (position, up, turned, TILT, sums, seconds, density, density)
            turns.append(RateSegment(*about, stretch=moving))
            rest(position, stretch(f"{name} after", STILL), up, turned)
            path.over(PAUSE)
    middle = (stills[0].stretch.start + stills[-1].stretch.end) / 2
    ends = {one.stretch.end for one in (*stills, *turns)}
    then = [(abs(time - middle), value) for time, value in path.reached if time in ends]
    return Campaign(stills, turns, matrix, bias + min(then, key=lambda one: one[0])[1])


def level_of(up: np.ndarray) -> np.ndarray:
    """The level direction that is north at the start of every manoeuvre."""
    return np.cross(up, np.roll(np.abs(up), 1))
