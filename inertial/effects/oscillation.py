"""A case that rings while the table turns."""

from inertial.physics.effect import Effect, Parameter, of_tables
from inertial.text.messages import _


class Oscillation(Effect):
    """ω_i += A sin(2πf t), on one axis; the others see it through M.

    Faster than a block: it is sought in the spectrum of the full-rate residuals, against time, with
    a phase of its own in each turn. Over a whole turn it adds no angle. What rings with one phase
    against the table's angle, and about its axis, is a ripple of the table.
    """

    name = "oscillation"
    cause = _("the case, the table's drive or a loose screw vibrates about one axis")
    source = "the Wuhan University laboratory report of 2023, figures 5-14 to 5-16"
    parameters = (
        Parameter("frequency", "Hz", 1.0, _("frequency, or an alias of it")),
        Parameter("amplitude", "rad/s", 1e-4, _("amplitude of the rate")),
    )
    sizes = of_tables(1, 1e-5, 1e-2)
    sought_in = "spectrum"
