"""A table whose heading is not what it is taken to be."""

from inertial.arrays import Array
from inertial.physics.effect import Parameter, Truth, TurnedEarthRate, known_earth, usually
from inertial.physics.motion import Motion, cross
from inertial.text.messages import _
from inertial.text.units import DEGREE


class HeadingError(TurnedEarthRate):
    """ω += Δψ up × ω_level: viewed from above, north lies Δψ further counter-clockwise of the mark.

    Told by the level gyros at rest. Where no heading is stated the gyros tell the azimuth
    themselves, and there is none to be wrong.
    """

    name = "heading_error"
    cause = _("the azimuth of the table's zero mark was taken wrong")
    source = "Titterton & Weston 2004, gyrocompassing"
    parameters = (
        Parameter("dpsi", "rad", DEGREE, _("true azimuth of the mark less the known one")),
    )
    sizes = usually(DEGREE)
    thinkable = 180.0

    def parts(self, truth: Truth, motion: Motion) -> tuple[Array, Array]:
        _, level = known_earth(truth, motion)
        return level, cross(motion.up, level)

    def blind(self, motion: Motion) -> str:
        return "" if motion.surveyed.any() else _("No heading of the table is stated.")
