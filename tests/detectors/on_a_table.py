"""What an IMU on a table reads, as arrays: rests, turns with ramps, increments with carry."""

import numpy as np
from recorded_by_hand import COUNT, GRAVITY, INTERVAL, NOISE, log, piece, stamps

from inertial.signal.detector import Log, Piece

BIAS = np.array([0.0693, 0.005, -0.0419, 1.3e-6, -2.1e-6, 0.9e-6])  # m/s², rad/s
RATE = np.radians(10)
RAMP = np.radians(5)  # rad/s²


def carried(truth: np.ndarray, seed: int, noise: np.ndarray = NOISE) -> np.ndarray:
    """Increments of a truth and white noise, with carry: a count's rest goes on, (n, 6)."""
    sums = np.cumsum(truth + noise * np.random.default_rng(seed).standard_normal(truth.shape), 0)
    return np.diff(np.rint(sums / COUNT), axis=0, prepend=0.0) * COUNT


def rest(n: int, seed: int = 1, up: int = 2, noise: np.ndarray = NOISE) -> np.ndarray:
    """A rest with the axis `up` upwards, (n, 6)."""
    truth = np.tile(BIAS, (n, 1))
    truth[:, up] += GRAVITY
    return carried(truth, seed, noise)


def profile(still: int = 1000, steady: int = 3400) -> np.ndarray:
    """The rate of a table that rests, turns and rests, with ramps of 5 °/s² to 10 °/s, (n,)."""
    up = np.arange(RAMP * INTERVAL, RATE, RAMP * INTERVAL)
    zero = np.zeros(still)
    return np.concatenate([zero, up, np.full(steady, RATE), up[::-1], zero])


def turn(seed: int = 1, about: int = 2, noise: np.ndarray = NOISE, **parts: int) -> np.ndarray:
    """A turn about the axis that points up, (n, 6)."""
    rate = profile(**parts)
    truth = np.tile(BIAS, (len(rate), 1))
    truth[:, about] += GRAVITY
    truth[:, 3 + about] += rate
    return carried(truth, seed, noise)


def tumble(seed: int = 1, noise: np.ndarray = NOISE) -> np.ndarray:
    """A turn about x, which lies level: gravity goes round in y and z, (n, 6)."""
    rate = profile()
    angle = np.cumsum(rate) * INTERVAL
    truth = np.tile(BIAS, (len(rate), 1))
    truth[:, 1] += GRAVITY * np.sin(angle)
    truth[:, 2] += GRAVITY * np.cos(angle)
    truth[:, 3] += rate
    return carried(truth, seed, noise)


def askew(values: np.ndarray, degrees: float = 5.0) -> np.ndarray:
    """The same, mounted askew about an axis between all three, in whole counts."""
    axis = np.radians(degrees) * np.array([1, -1, 1]) / np.sqrt(3)
    x, y, z = axis
    small = np.eye(3) + np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turned = np.hstack([values[:, :3] @ small.T, values[:, 3:] @ small.T])
    return np.rint(turned / COUNT) * COUNT


def recorded(values: np.ndarray, **of_log: object) -> tuple[Piece, Log]:
    """These readings as a piece with even stamps, and the log that it is."""
    one = piece(values, stamps(len(values)))
    return one, log(one, increments=True, **of_log)
