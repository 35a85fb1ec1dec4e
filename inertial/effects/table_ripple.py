"""A table whose rate ripples with its angle."""

from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Scan, Truth, of_tables
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND

LOWEST, HIGHEST, STEP = 1.5, 60.0, 0.25  # orders: periods in one turn


class TableRipple(Effect):
    """The table is at θ + a sin nθ + b cos nθ where it shows θ; the order n is scanned.

    Whole turns are free of it where n is whole. It is sought in the rates of the steady part, as a
    line against the angle; unlike an oscillation in time in turns at two rates, where its
    frequency n θ'/2π goes with the rate.
    """

    name = "table_ripple"
    cause = _("teeth of a gear, poles of the motor or balls of a bearing pass by")
    source = "IEEE Std 1554-2005, rate smoothness of tables"
    parameters = (
        Parameter(
            "a",
            "rad",
            5e-7,
            _("amplitude of the sine of n times the angle since the start of the turn"),
        ),
        Parameter("b", "rad", 5e-7, _("amplitude of the cosine of the same angle")),
    )
    sizes = of_tables(ARC_SECOND, 0.5, 5)
    sought_in = "spectrum"
    scan = Scan("n", "per turn", _("periods in one turn"))

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        ahead = motion.ripples(self.value(motion), values[0], values[1])
        return replace(truth, rate=truth.rate + ahead[:, None] * motion.about)

    def grid(self, motion: Motion) -> Array:
        return np.arange(LOWEST, HIGHEST + STEP / 2, STEP)
