"""An IMU that is put down in one attitude after another, with exact physics but for noise."""

from dataclasses import dataclass, field
from itertools import combinations, product

import numpy as np
from scipy.spatial.transform import Rotation

from inertial.estimation.between_positions import Passage, Prior, Stop
from inertial.estimation.gyroscope_observations import Earth
from inertial.estimation.multi_position import PAIRS, FreeRest
from inertial.physics.site import EARTH_RATE

FACES = np.array([sign * axis for axis in np.eye(3) for sign in (1, -1)])
EDGES = np.array(
    [
        (a * np.eye(3)[i] + b * np.eye(3)[j]) / np.sqrt(2)
        for i, j in combinations(range(3), 2)
        for a, b in product((1, -1), repeat=2)
    ]
)
CORNERS = np.array(list(product((1, -1), repeat=3))) / np.sqrt(3)
TWENTY_FOUR = np.vstack([FACES, EDGES, CORNERS[:6]])

GRAVITY, GRAVITY_SIGMA = 9.7936174, 5e-5
LATITUDE = np.radians(30.5278)
UP, LEVEL = EARTH_RATE * np.sin(LATITUDE), EARTH_RATE * np.cos(LATITUDE)
GIVEN = Prior(GRAVITY, GRAVITY_SIGMA, 0.0, Earth(UP, 1e-10, LEVEL))
RATE, FINE, LASTS = 100, 10, 2.0  # Hz; steps in a sample; s, of a motion

# The noise of data/simulated/demo.yaml, m/s²/√Hz and rad/√s.
DEMO = (0.0064 / 60, np.radians(0.012) / 60)
MPU6050 = (0.0035, 1.5e-4)  # as mpu6050_cuyo has it


@dataclass
class Imu:
    """P and M_g, biases, and white noise per √s of accelerometers and gyros."""

    rng: np.random.Generator
    noise: tuple[float, float] = DEMO
    errors: float = 5e-3
    bias: tuple[float, float] = (1e-2, 1e-5)
    symmetric: np.ndarray = field(init=False)
    gyro: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        askew = self.errors * self.rng.standard_normal((2, 3, 3))
        self.symmetric = np.eye(3) + (askew[0] + askew[0].T) / 2
        self.gyro = np.eye(3) + askew[1]
        self.force_bias, self.rate_bias = (b * self.rng.standard_normal(3) for b in self.bias)

    @property
    def free(self) -> np.ndarray:
        """What `free_positions` should find."""
        return np.array([*(self.symmetric[i, j] for i, j in PAIRS), *self.force_bias])

    @property
    def rates(self) -> np.ndarray:
        """What `between_positions.fit` should find."""
        return np.append(self.gyro.ravel(), self.rate_bias)

    def rest(self, name: str, up: np.ndarray, seconds: float) -> FreeRest:
        sigma = np.full(3, self.noise[0] / np.sqrt(seconds))
        mean = self.symmetric @ (GRAVITY * up) + self.force_bias
        return FreeRest(name, mean + sigma * self.rng.standard_normal(3), sigma)

    def stop(self, rest: FreeRest, earth: np.ndarray, seconds: float) -> Stop:
        sigma = np.full(3, self.noise[1] / np.sqrt(seconds))
        mean = self.gyro @ earth + self.rate_bias + sigma * self.rng.standard_normal(3)
        return Stop(rest, mean, sigma, seconds)

    def passage(self, first: int, truth: np.ndarray) -> Passage:
        """`truth`: (k, 3), true mean rates of the samples."""
        noise = self.noise[1] * np.sqrt(RATE) * self.rng.standard_normal(truth.shape)
        rates = truth @ self.gyro.T + self.rate_bias + noise
        seconds = np.full(len(rates), 1 / RATE)
        return Passage(first, rates, seconds, np.full(3, self.noise[1]))


def attitudes(rng: np.random.Generator, ups: np.ndarray, scatter: float) -> list[Rotation]:
    """Attitudes, body to earth with z up, about given upward directions, (n, 3), any heading.

    `scatter`: rad, of each direction.
    """
    found = []
    for up in ups + scatter * rng.standard_normal(ups.shape):
        stands = Rotation.align_vectors([[0, 0, 1]], [up])[0]
        found.append(Rotation.from_rotvec([0, 0, rng.uniform(0, 2 * np.pi)]) * stands)
    return found


def rests(imu: Imu, ups: np.ndarray, seconds: float, scatter: float) -> list[FreeRest]:
    """The accelerometers alone."""
    turned = attitudes(imu.rng, ups, scatter)
    up = [one.inv().apply([0, 0, 1]) for one in turned]
    return [imu.rest(f"rest-{i:02d}", up[i], seconds) for i in range(len(up))]


def by_hand(rng: np.random.Generator, start: Rotation, end: Rotation) -> Rotation:
    """A smooth way from one attitude to another, with a swing to the side and back."""
    phase = np.linspace(0, 2 * np.pi, int(LASTS * RATE) * FINE + 1)
    done = (phase - np.sin(phase)) / (2 * np.pi)
    swing = 0.3 * np.outer(1 - np.cos(phase), rng.standard_normal(3))
    swing += 0.05 * np.outer(1 - np.cos(2 * phase), rng.standard_normal(3))
    way = Rotation.from_rotvec(np.outer(done, (start.inv() * end).as_rotvec()))
    return start * way * Rotation.from_rotvec(swing)


def handled(
    imu: Imu, ups: np.ndarray, seconds: float, scatter: float = np.radians(0.1)
) -> tuple[list[Stop], list[Passage]]:
    """Rests of so many seconds in these attitudes, one after another, and what lies between."""
    turned = attitudes(imu.rng, ups, scatter)
    azimuth = imu.rng.uniform(0, 2 * np.pi)
    earth = np.array([LEVEL * np.cos(azimuth), LEVEL * np.sin(azimuth), UP])
    stops, passages = [], []
    for i, here in enumerate(turned):
        rest = imu.rest(f"rest-{i:02d}", here.inv().apply([0, 0, 1]), seconds)
        stops.append(imu.stop(rest, here.inv().apply(earth), seconds))
        if i + 1 < len(turned):
            way = by_hand(imu.rng, here, turned[i + 1])
            rates = (way[:-1].inv() * way[1:]).as_rotvec() * RATE * FINE
            rates += way[:-1].inv().apply(earth)
            passages.append(imu.passage(i, rates.reshape(-1, FINE, 3).mean(axis=1)))
    return stops, passages
