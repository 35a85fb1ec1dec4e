"""A latitude of the other hemisphere."""

from dataclasses import replace

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Truth, known_earth, usually
from inertial.physics.motion import Motion
from inertial.text.messages import _


class LatitudeSign(Effect):
    """ω −= 2 ω_e sinφ up: the upward part of the earth's rate has the other sign.

    It is there as a whole or not at all. A g-sensitivity alike on all axes does exactly the same.
    """

    name = "latitude_sign"
    cause = _(
        "attitudes, or each `up` of the plan, were taken from accelerometers that read −g on the "
        "axis that points up; or the sign of the latitude is wrong: south was taken for north, or "
        "north for south; or the axes of both sensors are left-handed"
    )
    source = "Titterton & Weston 2004, earth's rate in the local frame"
    parameters = (Parameter("s", "1", 1.0, _("1 on the other hemisphere, 0 on the stated one")),)
    sizes = usually(1.0)
    thinkable = 1.0
    only = 1.0

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        upward, _level = known_earth(truth, motion)
        return replace(truth, rate=truth.rate - 2 * values[0] * upward)
