"""ArduPilot's calibration parameters as a parameter file: NAME,VALUE, comments begin with #.

ArduPilot corrects (ardupilot, libraries/AP_InertialSensor/AP_InertialSensor_Backend.cpp,
_rotate_and_correct_accel and _rotate_and_correct_gyro)

    accelerometer: board rotation · ((data − INS_ACCOFFS) × INS_ACCSCAL), axis by axis
    gyro:          board rotation · (data − INS_GYROFFS)

with data in m/s² and rad/s after the rotation of the sensor that its driver states.
"""

from stages.exporting.autopilot import Autopilot, parameters
from stages.exporting.calibration import Calibration
from stages.exporting.comments import commented
from stages.exporting.diagonal import number

ARDUPILOT = Autopilot(
    "ArduPilot",
    {
        "accelerometer": {"offset": "INS_ACCOFFS_{}", "scale": "INS_ACCSCAL_{}"},
        "gyroscope": {"offset": "INS_GYROFFS_{}"},
    },
    (
        "To be loaded by Mission Planner or MAVProxy. ArduPilot corrects the accelerometers as"
        " (reading - INS_ACCOFFS) * INS_ACCSCAL and the gyros as reading - INS_GYROFFS, each axis"
        " by itself, m/s^2 and rad/s.",
        "",
        "To be filled in and checked before you load it:",
        "- INS_ACC_ID and INS_GYR_ID: the device ids of the IMU, which a turntable does not know."
        " ArduPilot does not arm where they are not those of its sensors. Take them from your"
        " vehicle; where the IMU is not the first one there, rename the parameters: INS_ACC2OFFS_X,"
        " INS_ACC2SCAL_X, INS_GYR2OFFS_X and so on.",
        "- INS_GYR_CAL must be 0, or ArduPilot measures the gyro offsets anew at every start.",
        "- Axes: x, y, z are those of the IMU's data sheet; no axis was exchanged or turned over"
        " for ArduPilot's forward, right, down. ArduPilot applies the numbers after the rotation"
        " that its driver states for the sensor and before AHRS_ORIENTATION. With +x up, the x"
        " accelerometer must read +9.8 there; turned about +x by the right hand, the x gyro must"
        " read positive; likewise y and z. Where the driver exchanges axes, exchange the numbers;"
        " where it turns one over, change the sign of its offset, not of its scale factor.",
        "- The driver must use the count size of the campaign, or the scale factors are wrong.",
        "- Where INS_TCAL1_ENABLE is set, ArduPilot adds a temperature correction of its own.",
    ),
)


def ardupilot(calibration: Calibration) -> str:
    """The parameter file, to be completed by hand where its head says so."""
    found = parameters(calibration, ARDUPILOT)
    lines = commented(found.head)
    if not calibration.nothing:
        lines += ["#", "# INS_ACC_ID,", "# INS_GYR_ID,"]
    lines += [f"{name},{number(value)}" for name, value in found.values.items()]
    return "\n".join(lines) + "\n"
