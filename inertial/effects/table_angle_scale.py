"""A table whose angles are all too large by the same share."""

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Truth, of_tables
from inertial.physics.motion import Motion, cross
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND, DEGREE


class TableAngleScale(Effect):
    """θ becomes (1 + e) θ:   ω += e Ω,   and after a tumble by ϑ   f −= e ϑ × f, ω −= e ϑ × ω.

    Of turns it is a scale factor that all gyros have in common, and nothing tells the two apart but
    an encoder that closes after a whole turn, or another table. A rest of a tumble stands e ϑ too
    far from where it began, which the accelerometers see.
    """

    name = "table_angle_scale"
    cause = _("the scale of the encoder, or where a turn starts and stops, is off")
    source = "IEEE Std 1554-2005, position accuracy of tables"
    parameters = (Parameter("e", "1", 1e-5, _("relative error of all angles")),)
    sizes = of_tables(ARC_SECOND / (360 * DEGREE), 3, 15)
    absorbed_by = _("the scale factors of the gyros")

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        further = values[0] * motion.tumbled
        return Truth(
            rate=truth.rate + values[0] * motion.omega - cross(further, truth.rate),
            force=truth.force - cross(further, truth.force),
        )
