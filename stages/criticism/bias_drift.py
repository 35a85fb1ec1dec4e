"""Drift of the biases of a sensor given the named effects: random walk and half waves."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import PRIOR_SIZE, Campaign
from inertial.campaign.scatter_given_effects import likely_walk
from inertial.estimation.probability import chi2_sf
from inertial.estimation.scatter_and_random_walk import sigma_of
from inertial.model_selection.walk_odds import Equations, walk
from inertial.physics.drift import without_clock
from inertial.physics.effect import Effect, Reading, Truth, parameters_by_axis
from inertial.physics.motion import Motion
from inertial.sensors import SENSORS
from inertial.text.messages import _

# ---- Random walk of the biases of a sensor given the named effects.


def likely_random_walks(campaign: Campaign, effects: Sequence[Effect]) -> tuple[float, float]:
    """The most likely random walks of gyros and accelerometers; 0 where none is significant."""
    gyro, accel = (likely_random_walk(campaign, sensor, effects) for sensor in SENSORS)
    return gyro, accel


def likely_random_walk(campaign: Campaign, sensor: str, effects: Sequence[Effect]) -> float:
    """The most likely random walk of one sensor; 0 where none is significant."""
    return likely_walk(campaign, sensor, effects, PRIOR_SIZE)


@dataclass(frozen=True)
class Walk:
    """A random walk of the biases of a sensor, and its sigma, rad/s/√s or m/s²/√s.

    p_value: that chance makes one of either sensor so much likelier than none.
    """

    size: float
    sigma: float
    p_value: float


def random_walks_with_sigmas(campaign: Campaign, effects: Sequence[Effect]) -> dict[str, Walk]:
    """The random walks in the equations of a campaign, by sensor."""
    sizes = zip(SENSORS, campaign.solution.random_walks, strict=True)
    return {sensor: _walk(campaign, sensor, size, effects) for sensor, size in sizes if size}


def _walk(campaign: Campaign, sensor: str, size: float, effects: Sequence[Effect]) -> Walk:
    """A random walk of a sensor with its sigma and p-value.

    A size cannot be negative, so the statistic is zero in half of all draws without a random walk
    (Self & Liang 1987); the factor of two for the two sensors cancels this.
    """
    deviance = campaign.deviance_of_random_walk(sensor, effects, PRIOR_SIZE)
    drop = max(deviance(0.0) - deviance(size), 0.0)
    return Walk(size, sigma_of(deviance, size), len(SENSORS) * float(chi2_sf(drop, 1)) / 2)


def walk_evidence(campaign: Campaign, sensor: str, effects: Sequence[Effect]) -> float:
    """Log evidence of a random walk of all axes alike or of each, of any size, against none.

    `effects`: that are fitted as well. By more half waves than a drift without a law has, for the
    eight of that leave out how fast a walk may change.
    """
    waves = list(half_waves(sensor, WALK_WAVES))
    total = evidence(campaign, [*effects, *waves]).total
    place = {name: i for i, name in enumerate(total.names)}
    known = [place[name] for effect in effects for name in effect.columns]
    equations = Equations(total.information, total.right).given(known)
    axes = [[place[f"{wave.label}.c_{axis}"] for wave in waves] for axis in "xyz"]
    return walk(equations, axes).log_evidence


# ---- Drift without a law: half waves over the campaign, of one sensor.

WALK_WAVES = 32  # of a random walk: what is faster is less than the noise of a stretch
MAX_HALF_WAVES = 8  # in the campaign: the fastest that is distinguishable from a jump
TYPICAL_SIZE = {"gyro": ("rad/s", 5e-6), "accel": ("m/s²", 1e-4)}  # a degree per hour, 10 µg


class _BiasChange(Effect):
    """A change of the biases of a sensor that no law of the catalogue has; `at`: which one."""

    thinkable = 1e4

    def __init__(self, name: str, sensor: str, at: int) -> None:
        unit, size = TYPICAL_SIZE[sensor]
        self.name, self.sensor, self.at = name, sensor, float(at)
        of_axis = _("of the {axis} reading")
        self.parameters = parameters_by_axis("c", unit, size, of_axis)
        self.sizes = {"usual": size}


class HalfWave(_BiasChange):
    """Reading += c cos(k π t/T): no physical effect, but a component of a drift without a law.

    It replaces several effects that together would only imitate it.
    """

    cause = _("the bias drifts, by no law of the catalogue")
    source = "Fourier, by cosines over the time of the campaign"

    def __init__(self, sensor: str, count: int) -> None:
        super().__init__(drift_name(sensor), sensor, count)

    def blind(self, motion: Motion) -> str:
        return without_clock(motion)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        if without_clock(motion) or self.at is None:
            return reading
        first, last = motion.time.min(), motion.time.max()
        phase = np.pi * self.at * (motion.time - first) / max(last - first, 1.0)
        wave = np.outer(np.cos(phase), values)
        return reading.plus(self.sensor, wave)


class BiasOfRun(_BiasChange):
    """Reading += c in one run of the instrument: its bias is another one after each switch-on.

    That of the first run is the bias itself.
    """

    cause = _("the bias is another one after each switch-on")
    source = "IEEE Std 528-2019, 'bias repeatability'"

    def __init__(self, sensor: str, run: int) -> None:
        super().__init__(per_log_name(sensor), sensor, run)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        step = np.outer(motion.run == self.at, values)
        return reading.plus(self.sensor, step)


def per_log_name(sensor: str) -> str:
    """The name of biases of a sensor that differ from run to run."""
    return f"{sensor}_bias_per_log"


def biases_of_runs(sensor: str, motion: Motion) -> tuple[BiasOfRun, ...]:
    """The bias of each run but the first; none where there is a single one."""
    return tuple(BiasOfRun(sensor, int(run)) for run in np.unique(motion.run)[1:])


def drift_name(sensor: str) -> str:
    """The name of a drift without a law of a sensor."""
    return f"{sensor}_drift"


def half_waves(sensor: str, count: int = MAX_HALF_WAVES) -> Iterator[HalfWave]:
    """The half waves of a sensor."""
    return (HalfWave(sensor, k) for k in range(1, count + 1))
