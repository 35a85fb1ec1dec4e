"""Names in the tables: parameters of a triad with kind and axes, results, sensors and stages."""

from typing import NamedTuple

from inertial.text.messages import _

AXES = ("x", "y", "z")


class Parts(NamedTuple):
    """What a parameter is one of, and its axes: of cross_xy that of the sensor, then of input."""

    kind: str
    axes: str

    @property
    def sensor_axis(self) -> str:
        """The axis of the sensor whose reading it changes."""
        return self.axes[0]

    @property
    def input_axis(self) -> str:
        """The axis of the input; of a bias that of the sensor."""
        return self.axes[-1]


PARTS = {
    f"{kind}_{axes}": Parts(kind, axes)
    for kind, each in (
        ("bias", AXES),
        ("scale", AXES),
        ("cross", tuple(row + column for row in AXES for column in AXES if row != column)),
        ("mounting", AXES),
        ("symmetric", ("xx", "yy", "zz", "xy", "xz", "yz")),
    )
    for axes in each
}
BIAS, SCALE, CROSS, MOUNTING, SYMMETRIC = (
    tuple(name for name, parts in PARTS.items() if parts.kind == kind)
    for kind in ("bias", "scale", "cross", "mounting", "symmetric")
)

# What the parameters of a triad are written with where a person reads them.
SIGNS = {"bias": "b", "scale": "s", "cross": "m", "mounting": "ρ", "symmetric": "p"}
# Letters that parameters of effects are written with where a person reads them.
LETTERS = {
    **{"theta": "θ", "phi": "φ", "tau": "τ", "delta": "δ", "zeta": "ζ"},
    **{"dphi": "Δφ", "dpsi": "Δψ", "dg": "Δg"},
}

# The coefficients of a function of temperature by the ends of their names.
OF_TEMPERATURE = {
    **{"1": _("per K"), "2": _("per K²"), "3": _("per K³"), "bend": _("beyond the knot")},
    **{"shift": _("at the knot"), "bend_below": _("beyond the lower knot")},
    "bend_above": _("beyond the upper knot"),
}

JOINT, EXTENDED = "joint", "extended"  # results: of the joint fit, with the unmodelled effects
MIXTURE = "mixture"  # of several members of a class, each by its probability
WITHOUT_ONE = "without_one"  # of the joint fit without the manoeuvre that alone is disturbed
FREE = "free_positions"  # of static positions of unknown attitude
STAGES = {"gyro": "gyroscope", "accel": "accelerometer"}  # by the sensor as columns call it
SENSOR_OF = {"accelerometer": "accel", "gyroscope": "gyro"}


def sign_of(parameter: str) -> str:
    """A parameter as it is written: m_xy for cross_xy, θ_x for theta_x, Δφ for dphi.

    Of a coefficient of a function of temperature, bias_x_2, the parameter and what it is of.
    """
    if parameter in PARTS:
        kind, axes = PARTS[parameter]
        return f"{SIGNS[kind]}_{axes}"
    for ending, words in OF_TEMPERATURE.items():
        function = parameter.removesuffix(f"_{ending}")
        if function != parameter and function in PARTS:
            return f"{sign_of(function)} {words}"
    letter, underscore, axes = parameter.partition("_")
    return LETTERS.get(letter, letter) + underscore + axes
