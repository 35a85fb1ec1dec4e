"""A table whose angles are all too large by the same share."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Truth, of_tables
from inertial.physics.motion import Motion, cross, turned, turned_all
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND, DEGREE


class TableAngleScale(Effect):
    """θ becomes (1 + e) θ:   ω += e Ω,   f −= e ϑ × f,   ω −= e ϑ × ω.

    ϑ is by how much the table has turned since the position was set, in a tumble or in turns. Of
    turns about the vertical it is a scale factor that all gyros have in common, and nothing tells
    the two apart but an encoder that closes after a whole turn, or another table. In turns about
    a level axis, and in a tumble, the case stands e ϑ too far, which the accelerometers see.
    """

    name = "table_angle_scale"
    cause = _("the scale of the encoder, or where a turn starts and stops, is off")
    source = "IEEE Std 1554-2005, position accuracy of tables"
    parameters = (Parameter("e", "1", 1e-5, _("relative error of all angles")),)
    sizes = of_tables(ARC_SECOND / (360 * DEGREE), 3, 15)
    absorbed_by = _("the scale factors of the gyros")

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        further = values[0] * (motion.tumbled + _turned_since_set(motion))
        return Truth(
            rate=truth.rate + values[0] * motion.omega - cross(further, truth.rate),
            force=truth.force - cross(further, truth.force),
        )


def _turned_since_set(motion: Motion) -> Array:
    """The rotation by the turns since the position was set, (n, 3), rad, in body axes."""
    about = np.broadcast_to(motion.about, motion.up.shape)
    rotation = motion.angle[:, None] * about
    before, position = np.zeros(3), None
    places = np.floor(motion.visit)
    for place in np.unique(places):
        own = np.flatnonzero(places == place)
        if motion.position[own[0]] != position:
            before, position = np.zeros(3), motion.position[own[0]]
        rotation[own] += turned_all(before, about[own], motion.angle[own])
        last = own[np.argmax(np.abs(motion.angle[own]))]
        whole = float(motion.angle[last] + motion.rate[last] * motion.seconds[last] / 2)
        before = turned(before, about[last], whole) + whole * about[last]
    return rotation
