"""Gyros that are late."""

from dataclasses import replace

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Truth, by_grade
from inertial.physics.motion import Motion
from inertial.text.messages import _


class GyroLatency(Effect):
    """ω(t − τ): the rate that is sensed lags by τ, ω −= τ dω/dt.

    It is there only while the rate changes, and over a whole turn it adds no angle. The angle of
    the table within a turn is known by nothing but the gyros, so a common delay is unseen: the
    table's encoder in the log would show it.
    """

    name = "gyro_latency"
    cause = _("the bandwidth of the gyros and the time that filters and transfer take")
    source = "Titterton & Weston 2004, bandwidth of gyroscopes"
    parameters = (Parameter("tau", "s", 1e-3, _("time by which the gyros lag behind the table")),)
    sizes = by_grade(1e-3, 5, 3, 5, 10)
    absorbed_by = _("the angle of the table in each block, which only the gyros tell")

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        return replace(truth, rate=truth.rate - values[0] * motion.alpha)
