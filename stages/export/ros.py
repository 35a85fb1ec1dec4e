"""A parameter file for ROS: the noise as Kalibr, allan_variance_ros and their readers name it, and
the covariances of a sensor_msgs/Imu.

allan_variance_ros writes the same six keys as Kalibr reads (ori-drs/allan_variance_ros,
scripts/analysis.py), which open_vins and VINS take over. The covariances are those of one message,
nine numbers by rows, (rad/s)² and (m/s²)², as sensor_msgs/Imu has them and as drivers take them as
a parameter: density² × rate on the diagonal. robot_localization and imu_tools read them there.
"""

from typing import Any

import numpy as np

from inertial.tables import AXES
from inertial.text.messages import _
from stages.export.calibration import Calibration
from stages.export.document import as_yaml
from stages.export.header import commented, origin, verdicts
from stages.export.kalibr import (
    KEYS,
    KINDS,
    filter_values,
    noise_by_axis,
    noise_head,
    not_contained,
    remaining_without,
)

COVARIANCE = {
    "accelerometer": "linear_acceleration_covariance",
    "gyroscope": "angular_velocity_covariance",
}


def ros_yaml(calibration: Calibration) -> str:
    """The file ros.yaml; what was not measured is left as a comment."""
    head = list(origin(calibration, "ROS"))
    if calibration.not_exported:
        return "\n".join(commented(head)) + "\n"
    head += ["", *verdicts(calibration.best(kind)[1] for kind in KINDS)]
    keys, left_out = filter_values(calibration)
    values: dict[str, Any] = {**keys, **_covariances(calibration, keys.get("update_rate"))}
    head += [
        "",
        _(
            "Six keys as Kalibr and allan_variance_ros have them, and the covariances of a "
            "sensor_msgs/Imu by rows, for a driver to fill in. These are of one message, by the "
            "noise of each axis for a filter; a driver that averages messages divides by their "
            "number. The readings are to be corrected by the calibration first: "
            "truth = inverse (reading - bias)."
        ),
        "",
        _("Not contained in this file, because these programs read no such key:"),
        *not_contained(calibration),
        "",
        *remaining_without(calibration),
        "",
        _("To be filled in, or left out:"),
        *left_out,
        "",
        *noise_head(calibration),
        "",
    ]
    blanks = [f"# {key}:" for key in (*KEYS, *COVARIANCE.values()) if key not in values]
    text = as_yaml(values) if values else ""
    return "\n".join([*commented(head), text + "\n".join(blanks)]).rstrip("\n") + "\n"


def _covariances(calibration: Calibration, rate: float | None) -> dict[str, list[float]]:
    """Nine numbers by rows for each sensor whose three axes were measured."""
    matrices = {}
    for kind, key in COVARIANCE.items():
        densities = [one.density for one in noise_by_axis(calibration, kind)]
        if rate and len(densities) == len(AXES):
            matrices[key] = [float(v) for v in np.diag(np.square(densities) * rate).ravel()]
    return matrices
