"""The use for which the noise that filters get is right: a time and a motion."""

from dataclasses import dataclass
from math import exp


@dataclass(frozen=True)
class Use:
    """The use for which a filter is to be right.

    seconds : T, over which the filter integrates before something else corrects it
    rate_rms, force_rms : rad/s and m/s², of the motion about and along each axis, mean 0
    correlation : τ, s, after which the motion is another one
    """

    seconds: float
    rate_rms: float
    force_rms: float
    correlation: float

    def rms(self, kind: str) -> float:
        """The rms of what the sensors of a kind feel of the motion."""
        return self.rate_rms if kind == "gyroscope" else self.force_rms

    @property
    def moving(self) -> float:
        """Variance of the integral over T of a motion with rms 1, over T, s."""
        t, tau = self.seconds, self.correlation
        return 2 * tau * (1 - tau / t * (1 - exp(-t / tau)))
