"""YAML of the noise: Kalibr's imu.yaml, and ros.yaml for drivers and filters of ROS.

Kalibr reads six keys, all of which it insists on: rostopic, update_rate (Hz), and for both triads
noise_density and random_walk, in continuous time: m/s²/√Hz and rad/s/√Hz, m/s³/√Hz and rad/s²/√Hz.
A sample has noise_density × √update_rate, a bias wanders by random_walk × √time (ethz-asl/kalibr,
kalibr_common/ConfigReader.py, class ImuParameters; wiki, IMU Noise Model). Matrices stand in
Kalibr's results alone, where its model scale-misalignment estimates them.

allan_variance_ros writes the same six keys (ori-drs/allan_variance_ros, scripts/analysis.py), which
open_vins and VINS take over. The covariances of ros.yaml are those of one message, nine numbers by
rows, (rad/s)² and (m/s²)², as sensor_msgs/Imu has them and as drivers take them as a parameter:
density² × rate on the diagonal. robot_localization and imu_tools read them there.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from inertial.tables import AXES
from inertial.text.messages import _
from stages.export.axis_correction import biases, cross_terms, remaining_errors, scale_errors
from stages.export.calibration import Calibration
from stages.export.document import as_yaml
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

KINDS = ("accelerometer", "gyroscope")
KEYS = (
    "rostopic",
    "update_rate",
    *(f"{kind}_{what}" for kind in KINDS for what in ("noise_density", "random_walk")),
)
COVARIANCE = {
    "accelerometer": "linear_acceleration_covariance",
    "gyroscope": "angular_velocity_covariance",
}

Content = tuple[dict[str, Any], list[str]]  # keys with values, and paragraphs of the head


def imu_yaml(calibration: Calibration) -> str:
    """The file imu.yaml, to be completed by hand where its head says so."""
    return _file(calibration, _("Kalibr (imu.yaml)"), KEYS, _of_kalibr)


def ros_yaml(calibration: Calibration) -> str:
    """The file ros.yaml; what was not measured is left as a comment."""
    return _file(calibration, "ROS", (*KEYS, *COVARIANCE.values()), _of_ros)


def _file(
    calibration: Calibration,
    target: str,
    keys: Sequence[str],
    content: Callable[[Calibration], Content],
) -> str:
    head = list(origin(calibration, target))
    if calibration.not_exported:
        return "\n".join(commented(head)) + "\n"
    values, paragraphs = content(calibration)
    head += ["", *verdicts(calibration.best(kind)[1] for kind in KINDS), "", *paragraphs]
    head += ["", *_noise_head(calibration), ""]
    blanks = [f"# {key}:" for key in keys if key not in values]
    text = as_yaml(values) if values else ""
    return "\n".join([*commented(head), text + "\n".join(blanks)]).rstrip("\n") + "\n"


def _of_kalibr(calibration: Calibration) -> Content:
    values, to_fill_in = _filter_values(calibration)
    return values, [
        _("To be filled in before Kalibr accepts this file:"),
        *to_fill_in,
        "",
        _("Not contained in this file, because Kalibr reads no such key:"),
        *_not_contained(calibration),
        _(
            "Kalibr estimates the biases anew, and by its model scale-misalignment also the "
            "matrices, from its own recording. To use the calibration itself, correct the "
            "readings before Kalibr reads them: truth = inverse (reading - bias)."
        ),
        "",
        *_remaining_without(calibration),
    ]


def _of_ros(calibration: Calibration) -> Content:
    values, left_out = _filter_values(calibration)
    return {**values, **_covariances(calibration, values.get("update_rate"))}, [
        _(
            "Six keys as Kalibr and allan_variance_ros have them, and the covariances of a "
            "sensor_msgs/Imu by rows, for a driver to fill in. These are of one message, by the "
            "noise of each axis for a filter; a driver that averages messages divides by their "
            "number. The readings are to be corrected by the calibration first: "
            "truth = inverse (reading - bias)."
        ),
        "",
        _("Not contained in this file, because these programs read no such key:"),
        *_not_contained(calibration),
        "",
        *_remaining_without(calibration),
        "",
        _("To be filled in, or left out:"),
        *left_out,
    ]


def _covariances(calibration: Calibration, rate: float | None) -> dict[str, list[float]]:
    """Nine numbers by rows for each sensor whose three axes were measured."""
    matrices = {}
    for kind, key in COVARIANCE.items():
        densities = [one.density for one in _noise_by_axis(calibration, kind)]
        if rate and len(densities) == len(AXES):
            matrices[key] = [float(v) for v in np.diag(np.square(densities) * rate).ravel()]
    return matrices


def _noise_head(calibration: Calibration) -> Iterator[str]:
    """Measured noise and that of the file, each axis, and why they differ."""
    by_kind = {kind: _noise_by_axis(calibration, kind) for kind in KINDS}
    if any(by_kind.values()):
        yield _(
            "Noise, as measured and for a filter; the file has one number for all three axes, that "
            "of the noisiest, so that none is given too much weight:"
        )
        yield from numbers(by_kind)
        yield from explanation(calibration.use, by_kind, corrected=True)


def _noise_by_axis(calibration: Calibration, kind: str) -> list[FilterNoise]:
    """The noise of the sensors of a kind, for readings that all of the result has corrected."""
    triad = calibration.best(kind)[1]
    return [] if triad.unusable else filter_noise(triad, calibration.noise, calibration.use)


def _filter_values(calibration: Calibration) -> tuple[dict[str, float], list[str]]:
    """The keys that the campaign determines, and in words those that it does not."""
    values: dict[str, float] = {}
    to_fill_in = [_("- rostopic: the topic of your recording; a turntable does not know it")]
    if rate := calibration.rate or calibration.campaign["rate"]:
        values["update_rate"] = float(rate)
    else:
        to_fill_in.append(
            _("- update_rate: left out, because the logs have no time and no rate is stated")
        )
    for kind in KINDS:
        found = _noise_by_axis(calibration, kind)
        walks = [one.walk for one in found if one.walk is not None]
        if reason := calibration.best(kind)[1].unusable:
            to_fill_in.append(
                _(
                    "- {kind}_noise_density, {kind}_random_walk: left out, because the {kind}s are "
                    "not usable: {reason}",
                    kind=kind,
                    reason=reason,
                )
            )
            continue
        if found:
            values[f"{kind}_noise_density"] = max(one.density for one in found)
        else:
            to_fill_in.append(
                _(
                    "- {kind}_noise_density: left out, because no static position or rate segment "
                    "is long enough to estimate the noise",
                    kind=kind,
                )
            )
        if walks:
            values[f"{kind}_random_walk"] = max(walks)
        else:
            to_fill_in.append(
                _(
                    "- {kind}_random_walk: left out, because {reason}",
                    kind=kind,
                    reason=not_measured(found),
                )
            )
    return values, to_fill_in


def _not_contained(calibration: Calibration) -> Iterator[str]:
    """The numbers of the calibration, of which the file has none."""
    chosen = [calibration.best(kind) for kind in KINDS]
    for _unused, triad in chosen:
        yield _("- bias of the {kind}s: {triad}", kind=triad.kind, triad=biases(triad))
        yield _(
            "- scale factor errors of the {kind}s: {triad}",
            kind=triad.kind,
            triad=scale_errors(triad),
        )
        yield _(
            "- cross-axis terms of the {kind}s: {triad}", kind=triad.kind, triad=cross_terms(triad)
        )
    yield from effect_terms(triad for _unused, triad in chosen)
    yield _("- the sigma of every number, their covariance, the temperature")
    yield from mounts(calibration, chosen)


def _remaining_without(calibration: Calibration) -> Iterator[str]:
    """How wrong readings are that are not corrected."""
    yield _("Errors that remain because of this, where the readings are not corrected first:")
    for kind in KINDS:
        yield from remaining_errors(calibration.best(kind)[1], np.zeros(3), np.ones(3))
