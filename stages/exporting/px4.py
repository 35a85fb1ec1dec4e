"""PX4's calibration parameters as a parameter file of QGroundControl.

PX4 corrects (PX4-Autopilot, src/lib/sensor_calibration, Correct() of Accelerometer and Gyroscope)

    accelerometer: rotation · ((data − thermal offset − offset) × scale), axis by axis
    gyro:          rotation · (data − thermal offset − offset)

with data in m/s² and rad/s as the driver publishes them. A line of the file: vehicle, component,
name, value, MAVLink type, with tabs between; 9 is a float, 6 an integer. QGroundControl
(ParameterManager::readParametersFromStream) leaves lines out that begin with #.
"""

from stages.exporting.autopilot import Autopilot, parameters
from stages.exporting.calibration import Calibration
from stages.exporting.comments import commented
from stages.exporting.diagonal import number

VEHICLE, COMPONENT, FLOAT, INTEGER = 1, 1, 9, 6
PX4 = Autopilot(
    "PX4",
    {
        "accelerometer": {"offset": "CAL_ACC0_{}OFF", "scale": "CAL_ACC0_{}SCALE"},
        "gyroscope": {"offset": "CAL_GYRO0_{}OFF"},
    },
    (
        "To be loaded by QGroundControl. PX4 corrects the accelerometers as (reading - offset) *"
        " scale and the gyros as reading - offset, each axis by itself, m/s^2 and rad/s.",
        "",
        "To be filled in and checked before you load it:",
        "- CAL_ACC0_ID and CAL_GYRO0_ID: the device ids of the IMU, which a turntable does not"
        " know. PX4 applies a calibration only to the sensor with its id. Take them from your"
        " vehicle; where the IMU has another number than 0 there, rename CAL_ACC0_ and CAL_GYRO0_.",
        "- Vehicle and component are 1; QGroundControl refuses the file for a vehicle with another"
        " id.",
        "- Axes: x, y, z are those of the IMU's data sheet; no axis was exchanged or turned over"
        " for PX4's forward, right, down. PX4 applies the numbers to sensor_accel and sensor_gyro,"
        " before CAL_ACC0_ROT and the rotation of the board. With +x up, x of sensor_accel must"
        " read +9.8; turned about +x by the right hand, x of sensor_gyro must read positive;"
        " likewise y and z. Where the driver exchanges axes, exchange the numbers; where it turns"
        " one over, change the sign of its offset, not of its scale factor.",
        "- The driver must use the count size of the campaign, or the scale factors are wrong.",
        "- Set SENS_IMU_AUTOCAL to 0, or PX4 replaces the offsets by its own estimates.",
        "- Restart after loading: while it runs, PX4 takes up no change of the offsets below 0.01"
        " m/s^2 or 0.01 rad/s, nor of the scale factors below 0.01; older versions not even at"
        " their start.",
    ),
)


def px4(calibration: Calibration) -> str:
    """The file for QGroundControl, to be completed by hand where its head says so."""
    found = parameters(calibration, PX4)
    lines = commented(found.head)
    if not calibration.nothing:
        lines += ["#", "# Vehicle-Id Component-Id Name Value Type"]
        for name in ("CAL_ACC0_ID", "CAL_GYRO0_ID"):
            lines.append(f"# {VEHICLE}\t{COMPONENT}\t{name}\t\t{INTEGER}")
    for name, value in found.values.items():
        lines.append(f"{VEHICLE}\t{COMPONENT}\t{name}\t{number(value)}\t{FLOAT}")
    return "\n".join(lines) + "\n"
