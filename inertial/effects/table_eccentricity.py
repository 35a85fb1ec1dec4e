"""An encoder that does not sit in the middle of its axis."""

from dataclasses import replace

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Truth, of_tables
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND


class TableEccentricity(Effect):
    """The table is at θ + a sin θ + b cos θ where it shows θ.

    Whole turns are free of it; a half turn is off by up to 2b. In between only the gyros tell the
    angle, so it is sought in the rates of the steady part, as a line against the angle: the
    table's drive follows its encoder evenly. At 10 °/s one turn of it is 36 s long, and slow
    drifts of the gyros look much alike.
    """

    name = "table_eccentricity"
    cause = _("the encoder of the table is mounted off its axis")
    source = "IEEE Std 1554-2005, position accuracy of tables"
    parameters = (
        Parameter(
            "a", "rad", 1e-5, _("amplitude of the sine of the angle since the start of the turn")
        ),
        Parameter("b", "rad", 1e-5, _("amplitude of the cosine of the same angle")),
    )
    sizes = of_tables(ARC_SECOND, 3, 30)
    sought_in = "spectrum"

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        ahead = motion.ripples(1.0, values[0], values[1])
        return replace(truth, rate=truth.rate + ahead[:, None] * motion.about)
