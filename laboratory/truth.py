"""What a perfect IMU would sense on the moving case."""

from collections.abc import Iterable
from dataclasses import dataclass

from laboratory.arrays import Array
from laboratory.motion import Motion
from laboratory.site import Site


@dataclass(frozen=True)
class Pull:
    """A specific force beyond gravity's: at the instants, and over every sample; body axes."""

    force: Array  # m/s², (m, 3)
    velocity: Array  # m/s, (n, 3): its integral, exact where the force jumps


@dataclass(frozen=True)
class Truth:
    """Angular rate and specific force of the case; m instants, n samples, body axes."""

    motion: Motion
    rate: Array  # rad/s, (m, 3), against inertial space
    force: Array  # m/s², (m, 3), +g on the axis that points up
    turned: Array  # rad, (n, 3): integral of the rate over every sample
    velocity: Array  # m/s, (n, 3): integral of the force over every sample
    warmer: Array  # K, (m,): than where M and bias of the sensors hold

    @property
    def time(self) -> Array:
        """Time of the instants since the campaign's first sample, (m,), s."""
        return self.motion.instants.time


def sense(motion: Motion, site: Site, pulls: Iterable[Pull], warmer: Array) -> Truth:
    """ω = ω_table + Cᵀ ω_e,  f = Cᵀ (0, 0, g) + whatever else pulls at the case."""
    integral = motion.instants.integral
    earth, force = motion.seen(site.earth_rate), motion.seen(site.reaction)
    velocity = integral(force)
    for pull in pulls:
        force = force + pull.force
        velocity = velocity + pull.velocity
    turned = motion.turned + integral(earth)
    return Truth(motion, motion.rate + earth, force, turned, velocity, warmer)
