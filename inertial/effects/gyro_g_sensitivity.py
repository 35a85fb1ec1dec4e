"""A gyro that feels acceleration."""

from inertial.arrays import Array
from inertial.physics.effect import OfSensed, Parameter, Term, Truth, by_grade
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR, STANDARD_GRAVITY

UNIT = DEGREE_PER_HOUR / STANDARD_GRAVITY


class GyroGSensitivity(OfSensed):
    """ω̃_i += Σ_j G_ij f_j.

    Told from a constant bias by positions: it changes sign when the table turns the
    axis over. Without level gyros that sense the earth's rate in a known direction, an error of
    the latitude does much the same.
    """

    name = "gyro_g_sensitivity"
    sensor = "gyro"
    cause = _(
        "the bias of the gyro depends on the specific force: mass unbalance, or stress of the "
        "package"
    )
    source = "IEEE Std 528-2019, 'acceleration-sensitive drift rate'"
    parameters = tuple(
        Parameter(
            f"g_{i}{j}",
            "(rad/s)/(m/s²)",
            1.0 * UNIT,
            _("response of the {i} gyro to specific force along {j}", i=i, j=j),
        )
        for i in "xyz"
        for j in "xyz"
    )
    terms = tuple(Term(f"gyro_{i}", f"g_{i}{j}", f"f_{j}") for i in "xyz" for j in "xyz")
    sizes = by_grade(UNIT, 0.05, 1, 11, 100)

    def change(self, truth: Truth, values: Array) -> Array:
        return truth.force @ values.reshape(3, 3).T
