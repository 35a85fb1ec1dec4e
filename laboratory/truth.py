"""The input of the sensors: rate and specific force of the moving case."""

from collections.abc import Iterable
from dataclasses import dataclass

from laboratory.arrays import Array
from laboratory.motion import Motion
from laboratory.site import Site
from laboratory.temperature import Temperature


@dataclass(frozen=True)
class ExtraForce:
    """A specific force in addition to that at rest, body axes."""

    force: Array  # m/s², (m, 3), at the instants
    velocity: Array  # m/s, (n, 3): its integral over every sample, exact where the force jumps


@dataclass(frozen=True)
class Truth:
    """Angular rate and specific force of the case; m instants, n samples, body axes."""

    motion: Motion
    rate: Array  # rad/s, (m, 3), against inertial space
    force: Array  # m/s², (m, 3), +g on the axis that points up
    turned: Array  # rad, (n, 3): integral of the rate over every sample
    velocity: Array  # m/s, (n, 3): integral of the force over every sample
    temperature: Temperature

    @property
    def time(self) -> Array:
        """Time of the instants since the campaign's first sample, (m,), s."""
        return self.motion.instants.time

    def warmer(self, node: str) -> Array:
        """How much accelerometer or gyro is above the reference of M and bias, (m,), K."""
        return self.temperature.course(node, self.motion.instants) - self.temperature.reference


def sense(
    motion: Motion, site: Site, extra_forces: Iterable[ExtraForce], temperature: Temperature
) -> Truth:
    """ω = ω_table + Cᵀ ω_e,  f = Cᵀ (0, 0, g) + extra forces."""
    integral = motion.instants.integral
    earth, force = motion.seen(site.earth_rate), motion.seen(site.reaction)
    velocity = integral(force)
    for extra in extra_forces:
        force = force + extra.force
        velocity = velocity + extra.velocity
    turned = motion.turned + integral(earth)
    return Truth(motion, motion.rate + earth, force, turned, velocity, temperature)
