"""Logs of an IMU that is put down by hand in many positions, as numbers, with a known truth."""

from dataclasses import dataclass

import numpy as np
from moved_by_hand import EDGES, FACES, FINE, GRAVITY, LEVEL, RATE, UP, Imu, attitudes, by_hand
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

REST_S = 4.0
FORCE_NOISE, RATE_NOISE = 0.03, 0.003  # m/s², rad/s, of a sample
HAND = 1.0  # m/s², of the accelerations of the hand
FIELD = np.array([0.2, 0.0, -0.4])  # gauss, in the room


@dataclass(frozen=True)
class ByHand:
    """What the sensors read, (n, 3) each: m/s², rad/s, gauss; and the IMU, which is the truth."""

    imu: Imu
    force: np.ndarray
    rate: np.ndarray
    field: np.ndarray
    positions: int


EIGHTEEN = np.vstack([EDGES, FACES])


def by_hand_log(
    seed: int,
    bias: tuple[float, float] = (0.1, 0.01),
    ups: np.ndarray = EIGHTEEN,
    degrees: float = 3.0,
) -> ByHand:
    """Twelve edges and six faces, or other `ups`, one after another, each for four seconds.

    `degrees`: the scatter of each attitude.
    """
    rng = np.random.default_rng(seed)
    imu = Imu(rng, errors=0.01, bias=bias)
    ups = ups[rng.permutation(len(ups))]
    turned = attitudes(rng, ups, np.radians(degrees))
    pieces = []
    for i, here in enumerate(turned):
        pieces.append(Rotation.concatenate([here] * int(REST_S * RATE)))
        if i + 1 < len(turned):
            pieces.append(by_hand(rng, here, turned[i + 1])[::FINE][:-1])
    way = Rotation.concatenate(pieces)
    rate = np.vstack([(way[:-1].inv() * way[1:]).as_rotvec() * RATE, np.zeros(3)])
    earth = way.inv().apply([LEVEL, 0, UP])
    moves = gaussian_filter1d((np.linalg.norm(rate, axis=1) > 0.05).astype(float), 5)
    pushed = gaussian_filter1d(rng.standard_normal((len(way), 3)), 10, axis=0)
    pushed *= HAND / pushed.std() * moves[:, None]
    middle = way * Rotation.from_rotvec(rate / RATE / 2)  # a sample is the mean over its interval
    force = (
        middle.inv().apply(pushed + np.array([0, 0, GRAVITY])) @ imu.symmetric.T + imu.force_bias
    )
    return ByHand(
        imu,
        force + FORCE_NOISE * rng.standard_normal(force.shape),
        (rate + earth) @ imu.gyro.T + imu.rate_bias + RATE_NOISE * rng.standard_normal(rate.shape),
        middle.inv().apply(FIELD) + 0.002 * rng.standard_normal(force.shape),
        len(turned),
    )
