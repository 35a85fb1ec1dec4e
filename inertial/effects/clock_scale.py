"""A clock of the instrument that is fast or slow."""

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Truth, by_grade, known_earth
from inertial.physics.motion import Motion
from inertial.text.messages import _


class ClockScale(Effect):
    """An interval of T lasts (1 + e) T: increments over it are larger by e, f += e f, ω_earth too.

    The angle of a turn is the sum of its increments, whatever the clock, so of the gyros only the
    earth's rate shows it. To the accelerometers it is a scale factor that all have in common.
    Turns that are known by their rate and others known by their angle differ by e; time tags of
    GPS tell it at once.
    """

    name = "clock_scale"
    cause = _("the oscillator that counts the sample interval is off its frequency")
    source = "Allan, Ashby & Hodge 1997, The Science of Timekeeping, quartz oscillators"
    parameters = (Parameter("e", "1", 2e-5, _("by how much an interval is longer than stated")),)
    sizes = by_grade(1e-6, 1, 20, 20, 50)
    absorbed_by = _(
        "the scale factors of the accelerometers where increments are logged, of the gyros where "
        "rates are"
    )

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        upward, level = known_earth(truth, motion)
        rate = truth.rate + values[0] * (upward + level)
        return Truth(rate, truth.force * (1 + values[0]))
