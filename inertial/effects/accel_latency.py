"""Accelerometers that are late."""

from dataclasses import replace

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Truth, by_grade
from inertial.physics.motion import Motion, cross
from inertial.text.messages import _


class AccelLatency(Effect):
    """f(t − τ): the force that is sensed lags by τ behind the rates, f −= τ df/dt.

    Where gravity rotates in the case df/dt = −ω × f, so they see the attitude of a moment ago. The
    angle of the table within a turn follows from the gyros; where it is they that lag, τ is
    negative. Unseen at rest, and in turns about the vertical.
    """

    name = "accel_latency"
    cause = _("the time that filters and transfer take differs between accelerometers and gyros")
    source = "Titterton & Weston 2004, bandwidth of accelerometers"
    parameters = (
        Parameter("tau", "s", 1e-3, _("time by which the accelerometers lag behind the gyros")),
    )
    sizes = by_grade(1e-3, 5, 3, 5, 10)
    stays = _("set the stamps of one sensor right by it instead")

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        return replace(truth, force=truth.force + values[0] * cross(motion.omega, truth.force))
