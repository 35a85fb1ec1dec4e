"""A bias of the accelerometers that jumps once."""

from inertial.physics.drift import Drift, after, evenly
from inertial.physics.effect import Array, Parameter, Scan, by_grade, on_each_axis
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY

CANDIDATES = 72  # times of the jump: one between two of them loses 2 to 4 % of its SNR²


class AccelBiasJump(Drift):
    """Reading += b H(t − t₀); t₀ is scanned.

    Unlike a drift it is instantaneous. A jump between logs is observable only if they share a
    clock.
    """

    name = "accel_bias_jump"
    sensor = "accel"
    cause = _(
        "stress is released, the electronics switch, or the instrument is knocked or restarted"
    )
    source = "Basseville & Nikiforov 1993, Detection of Abrupt Changes, chapter 2"
    parameters = tuple(
        Parameter(
            f"b_{axis}",
            "m/s²",
            1e-5 * STANDARD_GRAVITY,
            _("of the {axis} specific force", axis=axis),
        )
        for axis in "xyz"
    )
    terms = on_each_axis("accel", "b_{i}", "(t > t0)")
    sizes = by_grade(1e-6 * STANDARD_GRAVITY, 20, 100, 200, 1000)
    scan = Scan("t0", "s", _("time of the jump since the first sample of all logs"))

    def grid(self, motion: Motion) -> Array:
        return evenly(motion, CANDIDATES)

    def course(self, motion: Motion) -> Array:
        return after(motion, self.value(motion))
