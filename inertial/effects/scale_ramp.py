"""Scale factors of a sensor that drift evenly."""

from inertial.physics.drift import Ramp
from inertial.physics.effect import OfSensor, by_grade
from inertial.text.messages import _
from inertial.text.units import HOUR


class ScaleRamp(Ramp):
    """ω̃_i += k_i t ω_i, f̃_i += k_i t f_i, with t since the first sample of all logs.

    Shown by turns about one axis, or by the axis up and down, each at several times: a bias that
    drifts is the same in both directions. Where the temperature rises all the time it is not told
    from the temperature.
    """

    kind, letter, factor = "scale_ramp", "k", "t * s_{i}"
    of_scale = True
    gyro = OfSensor(
        _("drift of the scale factor of the {axis} gyro"),
        "1/s",
        1e-5 / HOUR,
        by_grade(1e-6 / HOUR, 5, 20, 100, 500),
        _("the scale factor of the gyros drifts, as the sensor warms up or ages"),
        "IEEE Std 952-1997, scale factor errors: instability",
    )
    accel = OfSensor(
        _("drift of the scale factor of the {axis} accelerometer"),
        "1/s",
        1e-5 / HOUR,
        by_grade(1e-6 / HOUR, 5, 20, 100, 500),
        _("the scale factor of the accelerometers drifts, as the sensor warms up or ages"),
        "IEEE Std 1293-2018, stability of bias and scale factor",
    )
    thinkable = 4.0  # 200 ppm/K that warms by 10 K in an hour
