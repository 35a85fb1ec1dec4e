"""Kalibr's imu.yaml: noise densities and the sample rate, and nothing of the calibration itself.

Kalibr reads six keys, all of which it insists on: rostopic, update_rate (Hz), and for both triads
noise_density and random_walk, in continuous time: m/s²/√Hz and rad/s/√Hz, m/s³/√Hz and rad/s²/√Hz.
A sample has noise_density × √update_rate (ethz-asl/kalibr, kalibr_common/ConfigReader.py, class
ImuParameters), so noise_density is the random walk of the noise table. Matrices stand in Kalibr's
results alone, where its model scale-misalignment estimates them.
"""

from collections.abc import Iterator

import numpy as np

from inertial.tables import CHANNEL_PARTS
from inertial.text.messages import _
from inertial.text.parameters import SENSOR_OF
from stages.export.axis_correction import biases, cross_terms, remaining_errors, scale_errors
from stages.export.calibration import Calibration
from stages.export.document import as_yaml
from stages.export.header import commented, effect_terms, mounts, origin, verdicts

KINDS = ("accelerometer", "gyroscope")


def imu_yaml(calibration: Calibration) -> str:
    """The file imu.yaml, to be completed by hand where its head says so."""
    head = list(origin(calibration, _("Kalibr (imu.yaml)")))
    if calibration.not_exported:
        return "\n".join(commented(head)) + "\n"
    head += ["", *verdicts(calibration.best(kind)[1] for kind in KINDS)]
    values, to_fill_in = _values(calibration)
    head += ["", _("To be filled in before Kalibr accepts this file:"), *to_fill_in]
    head += ["", _("Not contained in this file, because Kalibr reads no such key:")]
    head += [*_not_contained(calibration), ""]
    keys = ["rostopic", "update_rate"]
    keys += [f"{kind}_{what}" for kind in KINDS for what in ("noise_density", "random_walk")]
    blanks = [f"# {key}:" for key in keys if key not in values]
    text = as_yaml(values) if values else ""
    return "\n".join(commented(head)) + "\n" + text + "\n".join(blanks) + "\n"


def _values(calibration: Calibration) -> tuple[dict[str, float], list[str]]:
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
        levels = list(_densities(calibration, kind).values())
        if reason := calibration.best(kind)[1].unusable:
            to_fill_in.append(
                _(
                    "- {kind}_noise_density: left out, because the {kind}s are not usable: "
                    "{reason}",
                    kind=kind,
                    reason=reason,
                )
            )
        elif levels:
            values[f"{kind}_noise_density"] = max(levels)
        else:
            to_fill_in.append(
                _(
                    "- {kind}_noise_density: left out, because no static position or rate segment "
                    "is long enough to estimate the noise",
                    kind=kind,
                )
            )
        to_fill_in.append(
            _(
                "- {kind}_random_walk: left out, because it was not measured: the instability "
                "of the bias is seen in an Allan deviation over hours at rest",
                kind=kind,
            )
        )
    return values, to_fill_in


def _densities(calibration: Calibration, kind: str) -> dict[str, float]:
    """Axis → noise density of the sensors of a kind."""
    parts = [(*CHANNEL_PARTS[row["channel"]], row["density"]) for row in calibration.noise]
    return {axis: density for sensor, axis, density in parts if sensor == SENSOR_OF[kind]}


def _not_contained(calibration: Calibration) -> Iterator[str]:
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
    for kind in KINDS:
        by_axis = _densities(calibration, kind)
        if by_axis:
            densities = ", ".join(f"{axis}={density:.4g}" for axis, density in by_axis.items())
            yield (
                _(
                    "- noise densities of the single {kind}s: {densities}; the file has "
                    "one for all "
                    "three, that of the noisiest, so that Kalibr does not give any too much weight",
                    kind=kind,
                    densities=densities,
                )
            )
    yield from effect_terms(triad for _unused, triad in chosen)
    yield _("- the sigma of every number, their covariance, the temperature")
    yield from mounts(calibration, chosen)
    yield (
        _(
            "Kalibr estimates the biases anew, and by its model scale-misalignment also the "
            "matrices, from its own recording. To use the calibration itself, correct the "
            "readings before Kalibr reads them: truth = inverse (reading - bias)."
        )
    )
    yield ""
    yield _("Errors that remain because of this, where the readings are not corrected first:")
    for _unused, triad in chosen:
        yield from remaining_errors(triad, np.zeros(3), np.ones(3))
