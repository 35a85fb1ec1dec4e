"""An encoder that does not sit in the middle of its axis, as the rests of a tumble show it."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Truth, of_tables
from inertial.physics.motion import Motion, cross
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND


class TumbleEccentricity(Effect):
    """A tumble stands at θ + a sin θ + b (cos θ − 1) where it shows θ:   f −= λ × f, ω −= λ × ω.

    λ is that error along the axis of the tumble, as `TableEccentricity` has it in turns. Of a
    level axis the accelerometers across it see f_y f_z on one and f_y² or f_z² on the other, which
    their own nonlinearity shows too, but not in this proportion.
    """

    name = "tumble_eccentricity"
    cause = _("the encoder or the circle of the table is mounted off its axis")
    source = "IEEE Std 1554-2005, position accuracy of tables"
    parameters = (
        Parameter(
            "a", "rad", 1e-5, _("amplitude of the sine of the angle since the start of the tumble")
        ),
        Parameter("b", "rad", 1e-5, _("amplitude of the cosine of the same angle")),
    )
    sizes = of_tables(ARC_SECOND, 3, 30)

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        angle = np.linalg.norm(motion.tumbled, axis=1)
        about = motion.tumbled / np.where(angle > 0, angle, 1.0)[:, None]
        ahead = values[0] * np.sin(angle) + values[1] * (np.cos(angle) - 1.0)
        further = ahead[:, None] * about
        return Truth(
            rate=truth.rate - cross(further, truth.rate),
            force=truth.force - cross(further, truth.force),
        )

    def blind(self, motion: Motion) -> str:
        return "" if motion.tumbled.any() else _("There is no tumble.")
