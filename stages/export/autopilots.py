"""Parameter files of the autopilots PX4 and ArduPilot.

Both correct axis by axis, with data in m/s² and rad/s:

    accelerometer: rotation · ((data − offset) × scale)        gyro: rotation · (data − offset)

PX4 (PX4-Autopilot, src/lib/sensor_calibration, Correct() of Accelerometer and Gyroscope) subtracts
a thermal offset as well. A line of its file for QGroundControl: vehicle, component, name, value,
MAVLink type, with tabs between; 9 is a float, 6 an integer. QGroundControl
(ParameterManager::readParametersFromStream) ignores lines that begin with #.

ArduPilot (ardupilot, libraries/AP_InertialSensor/AP_InertialSensor_Backend.cpp,
_rotate_and_correct_accel and _rotate_and_correct_gyro) rotates by the orientation of the board,
after the rotation of the sensor that its driver states. A line of its file: NAME,VALUE.

The filters of both add (number · dt)² to the variance of an angle, a velocity or a bias in each of
their steps of dt (PX4-Autopilot, src/modules/ekf2/EKF/covariance.cpp, predictCovariance; ardupilot,
libraries/AP_NavEKF3/AP_NavEKF3_core.cpp, CovariancePrediction). So the numbers that go with a
density N and a random walk K are N/√dt and K/√dt. They stand in the files as comments, for a table
does not show the vibration of the vehicle, and too little makes a filter refuse good measurements.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import sqrt

from inertial.text.messages import _
from stages.export.axis_correction import (
    AxisCorrection,
    Cubic,
    ardupilot_values,
    axis_correction,
    cross_terms,
    cubic_of,
    notes_on,
    px4_values,
    remaining_errors,
    scale_errors,
    whole,
)
from stages.export.calibration import Calibration, Triad
from stages.export.filter_noise import FilterNoise, filter_noise
from stages.export.header import (
    commented,
    effect_terms,
    explanation,
    mounts,
    not_measured,
    numbers,
    origin,
    verdicts,
)


@dataclass(frozen=True)
class Autopilot:
    """How an autopilot names its parameters, and what its user must know.

    parameters : accelerometer or gyroscope → offset or scale → the name, {} for X, Y or Z
    line : of a parameter, by name and value
    to_fill_in : lines of comment after the head, for what the user must add; whole_number : line of
        a parameter that is one
    temperature : the parameters of cubics by kind of triad, by name and value
    filter_name, period : of its filter, s
    filter_numbers : accelerometer or gyroscope → names of the numbers for density and random walk
    """

    name: str
    parameters: Mapping[str, Mapping[str, str]]
    notes: Sequence[str]
    line: str
    to_fill_in: Sequence[str]
    temperature: Callable[[Mapping[str, Cubic]], Iterator[tuple[str, float]]]
    filter_name: str
    period: float
    filter_numbers: Mapping[str, tuple[str, str]]
    whole_number: str = ""


PX4 = Autopilot(
    "PX4",
    {
        "accelerometer": {"offset": "CAL_ACC0_{}OFF", "scale": "CAL_ACC0_{}SCALE"},
        "gyroscope": {"offset": "CAL_GYRO0_{}OFF"},
    },
    (
        _(
            "To be loaded by QGroundControl. PX4 corrects the accelerometers as (reading - offset) "
            "* scale and the gyros as reading - offset, each axis by itself, m/s^2 and rad/s."
        ),
        "",
        _("To be filled in and checked before you load it:"),
        _(
            "- CAL_ACC0_ID and CAL_GYRO0_ID: the device ids of the IMU, which a turntable "
            "does not know. PX4 applies a calibration only to the sensor with its id. Take "
            "them from your vehicle; where the IMU has another number than 0 there, rename "
            "CAL_ACC0_ and CAL_GYRO0_."
        ),
        _(
            "- Vehicle and component are 1; QGroundControl refuses the file for a vehicle "
            "with another id."
        ),
        _(
            "- Axes: x, y, z are those of the IMU's data sheet; no axis was exchanged or "
            "reversed for PX4's forward, right, down. PX4 applies the numbers to "
            "sensor_accel and sensor_gyro, before CAL_ACC0_ROT and the rotation of the "
            "board. With +x up, x of sensor_accel must read +9.8; turned about +x by the "
            "right hand, x of sensor_gyro must read positive; likewise y and z. Where the "
            "driver exchanges axes, exchange the numbers; where it reverses one, change the "
            "sign of its offset, not of its scale factor."
        ),
        _("- The driver must use the count size of the campaign, or the scale factors are wrong."),
        _("- Set SENS_IMU_AUTOCAL to 0, or PX4 replaces the offsets by its own estimates."),
        _(
            "- Restart after loading: while it runs, PX4 ignores changes of the offsets "
            "below 0.01 m/s^2 or 0.01 rad/s, and of the scale factors below 0.01; older "
            "versions ignore them even at their start."
        ),
    ),
    line="1\t1\t{name}\t{value}\t9",
    to_fill_in=(
        "#",
        _("# Vehicle-Id Component-Id Name Value Type"),
        _("# 1	1	CAL_ACC0_ID		6"),
        _("# 1	1	CAL_GYRO0_ID		6"),
    ),
    temperature=px4_values,
    whole_number="1\t1\t{name}\t{value}\t6",
    filter_name="EKF2",
    period=0.01,  # s, EKF2_PREDICT_US
    filter_numbers={
        "accelerometer": ("EKF2_ACC_NOISE", "EKF2_ACC_B_NOISE"),
        "gyroscope": ("EKF2_GYR_NOISE", "EKF2_GYR_B_NOISE"),
    },
)
ARDUPILOT = Autopilot(
    "ArduPilot",
    {
        "accelerometer": {"offset": "INS_ACCOFFS_{}", "scale": "INS_ACCSCAL_{}"},
        "gyroscope": {"offset": "INS_GYROFFS_{}"},
    },
    (
        _(
            "To be loaded by Mission Planner or MAVProxy. ArduPilot corrects the "
            "accelerometers as (reading - INS_ACCOFFS) * INS_ACCSCAL and the gyros as "
            "reading - INS_GYROFFS, each axis by itself, m/s^2 and rad/s."
        ),
        "",
        _("To be filled in and checked before you load it:"),
        _(
            "- INS_ACC_ID and INS_GYR_ID: the device ids of the IMU, which a turntable does "
            "not know. ArduPilot does not arm where they are not those of its sensors. Take "
            "them from your vehicle; where the IMU is not the first one there, rename the "
            "parameters: INS_ACC2OFFS_X, INS_ACC2SCAL_X, INS_GYR2OFFS_X and so on."
        ),
        _("- INS_GYR_CAL must be 0, or ArduPilot measures the gyro offsets anew at every start."),
        _(
            "- Axes: x, y, z are those of the IMU's data sheet; no axis was exchanged or "
            "reversed for ArduPilot's forward, right, down. ArduPilot applies the numbers "
            "after the rotation that its driver states for the sensor and before "
            "AHRS_ORIENTATION. With +x up, the x accelerometer must read +9.8 there; turned "
            "about +x by the right hand, the x gyro must read positive; likewise y and z. "
            "Where the driver exchanges axes, exchange the numbers; where it reverses one, "
            "change the sign of its offset, not of its scale factor."
        ),
        _("- The driver must use the count size of the campaign, or the scale factors are wrong."),
    ),
    line="{name},{value}",
    to_fill_in=("#", _("# INS_ACC_ID,"), _("# INS_GYR_ID,")),
    temperature=ardupilot_values,
    filter_name="EKF3",
    period=0.012,  # s, EKF_TARGET_DT
    filter_numbers={
        "accelerometer": ("EK3_ACC_P_NSE", "EK3_ABIAS_P_NSE"),
        "gyroscope": ("EK3_GYRO_P_NSE", "EK3_GBIAS_P_NSE"),
    },
)


def parameter_file(calibration: Calibration, autopilot: Autopilot) -> str:
    """The parameter file, to be completed by hand where its head says so.

    A parameter that was not determined is left out.
    """
    head = list(origin(calibration, autopilot.name))
    if calibration.not_exported:
        return "\n".join(commented(head)) + "\n"
    cubics: dict[str, Cubic] = {}
    chosen = []
    for kind in autopilot.parameters:
        mount, triad = calibration.best(kind)
        triad, cubic = cubic_of(triad, calibration)
        chosen.append((mount, triad))
        if cubic is not None:
            cubics[kind] = cubic
    accelerometer, gyroscope = (triad for _unused, triad in chosen)
    head += [
        *verdicts(triad for _unused, triad in chosen),
        "",
        *autopilot.notes,
        *notes_on(cubics, autopilot.name),
        *mounts(calibration, chosen),
        "",
        _("Not contained in this file, because {name} has no such parameter:", name=autopilot.name),
        _(
            "- cross-axis terms of the accelerometers: {accelerometer}",
            accelerometer=cross_terms(accelerometer),
        ),
        _("- scale factor errors of the gyros: {gyroscope}", gyroscope=scale_errors(gyroscope)),
        _("- cross-axis terms of the gyros: {gyroscope}", gyroscope=cross_terms(gyroscope)),
        *effect_terms(_not_contained(triad, cubics.get(triad.kind)) for _unused, triad in chosen),
        _("- the sigma of every number, their covariance"),
        "",
        _("Errors that remain because of this:"),
    ]
    lines: list[str] = []
    left_out: dict[str, list[str]] = {}
    for _unused, triad in chosen:
        names = autopilot.parameters[triad.kind]
        correction = axis_correction(triad, scaled="scale" in names)
        head += remaining_errors(triad, correction.offset, correction.scale)
        for name, value in _values(names, correction):
            lines.append(autopilot.line.format(name=name, value=f"{value:.9g}"))
        for (quantity, axis), reason in correction.left_out.items():
            left_out.setdefault(reason, []).append(names[quantity].format(axis.upper()))
    for name, value in autopilot.temperature(cubics):
        line = autopilot.whole_number if name.endswith("_ENABLE") else ""
        lines.append((line or autopilot.line).format(name=name, value=f"{value:.9g}"))
    if left_out:
        head += ["", _("Left out:")]
        head += [f"- {', '.join(names)}: {reason}" for reason, names in left_out.items()]
    parts = [_not_contained(triad, cubics.get(triad.kind)) for _unused, triad in chosen]
    of_filter = _of_filter(autopilot, parts, calibration)
    return "\n".join([*commented(head), *of_filter, *autopilot.to_fill_in, *lines]) + "\n"


def _of_filter(
    autopilot: Autopilot, triads: Sequence[Triad], calibration: Calibration
) -> list[str]:
    """Comments: the numbers of its filter, and what they are; nothing without noise."""
    noise = {}
    for triad in triads:
        correction = axis_correction(triad, scaled="scale" in autopilot.parameters[triad.kind])
        left = correction.offset, correction.scale
        found = filter_noise(triad, calibration.noise, calibration.use, left)
        if found and not triad.unusable:
            noise[triad.kind] = found
    if not noise:
        return []
    lines = [f"# {line}" for line in _filter_lines(autopilot, noise)]
    return [*commented(["", *_filter_head(autopilot, noise, calibration)]), "#", *lines]


def _filter_lines(autopilot: Autopilot, noise: Mapping[str, list[FilterNoise]]) -> Iterator[str]:
    """The numbers of its filter, by the noisiest axis of each sensor."""
    for kind, found in noise.items():
        density_name, walk_name = autopilot.filter_numbers[kind]
        walks = [one.walk for one in found if one.walk is not None]
        for name, values in ((density_name, [one.density for one in found]), (walk_name, walks)):
            if values:
                number = max(values) / sqrt(autopilot.period)
                yield autopilot.line.format(name=name, value=f"{number:.4g}")


def _filter_head(
    autopilot: Autopilot, noise: Mapping[str, list[FilterNoise]], calibration: Calibration
) -> Iterator[str]:
    """What the numbers of the filter are, and why they are comments."""
    yield _(
        "Noise for {filter_name}, at the end of this head as comments: remove the # to use a "
        "number, after a test in the vehicle. They are of an IMU at rest on a table, and contain "
        "what these parameters cannot correct, such as cross-axis terms; {name}'s defaults contain "
        "the vibration of a vehicle. Keep the larger of the two, as far as the range of the "
        "parameter goes: with too small a number {filter_name} refuses good measurements. "
        "{filter_name} adds (number * dt)^2 to a variance in each step of dt = {period:g} s, so a "
        "number is the density, or the random walk, divided by sqrt dt; of the noisiest axis:",
        filter_name=autopilot.filter_name,
        name=autopilot.name,
        period=autopilot.period,
    )
    yield from numbers(noise)
    for kind, found in noise.items():
        if all(one.walk is None for one in found):
            yield _(
                "- random walk of the bias of the {kind}s: left out, because {reason}",
                kind=kind,
                reason=not_measured(found),
            )
    yield from explanation(calibration.use, noise, corrected=False)


def _not_contained(triad: Triad, cubic: Cubic | None) -> Triad:
    """The triad with those of its effects of which the cubic is not all."""
    if cubic is None:
        return triad
    return replace(
        triad, effects=[one for one in triad.effects if not whole(one, triad.kind, cubic)]
    )


def _values(names: Mapping[str, str], correction: AxisCorrection) -> Iterator[tuple[str, float]]:
    for quantity, name in names.items():
        for axis, value in correction.values(quantity):
            yield name.format(axis.upper()), value
