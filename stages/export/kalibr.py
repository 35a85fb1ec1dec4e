"""Kalibr's imu.yaml: noise densities, random walks and the sample rate, and nothing of the
calibration itself.

Kalibr reads six keys, all of which it insists on: rostopic, update_rate (Hz), and for both triads
noise_density and random_walk, in continuous time: m/s²/√Hz and rad/s/√Hz, m/s³/√Hz and rad/s²/√Hz.
A sample has noise_density × √update_rate, a bias wanders by random_walk × √time (ethz-asl/kalibr,
kalibr_common/ConfigReader.py, class ImuParameters; wiki, IMU Noise Model). Matrices stand in
Kalibr's results alone, where its model scale-misalignment estimates them.
"""

from collections.abc import Iterator

import numpy as np

from inertial.text.messages import _
from stages.export.axis_correction import biases, cross_terms, remaining_errors, scale_errors
from stages.export.calibration import Calibration
from stages.export.document import as_yaml
from stages.export.filter_noise import FilterNoise, filter_noise
from stages.export.header import commented, effect_terms, mounts, origin, verdicts
from stages.export.noise_sentences import explanation, not_measured, numbers

KINDS = ("accelerometer", "gyroscope")
KEYS = (
    "rostopic",
    "update_rate",
    *(f"{kind}_{what}" for kind in KINDS for what in ("noise_density", "random_walk")),
)


def imu_yaml(calibration: Calibration) -> str:
    """The file imu.yaml, to be completed by hand where its head says so."""
    head = list(origin(calibration, _("Kalibr (imu.yaml)")))
    if calibration.not_exported:
        return "\n".join(commented(head)) + "\n"
    head += ["", *verdicts(calibration.best(kind)[1] for kind in KINDS)]
    values, to_fill_in = filter_values(calibration)
    head += ["", _("To be filled in before Kalibr accepts this file:"), *to_fill_in]
    head += ["", _("Not contained in this file, because Kalibr reads no such key:")]
    head += [
        *not_contained(calibration),
        _(
            "Kalibr estimates the biases anew, and by its model scale-misalignment also the "
            "matrices, from its own recording. To use the calibration itself, correct the "
            "readings before Kalibr reads them: truth = inverse (reading - bias)."
        ),
        "",
        *remaining_without(calibration),
        "",
        *noise_head(calibration),
        "",
    ]
    blanks = [f"# {key}:" for key in KEYS if key not in values]
    text = as_yaml(values) if values else ""
    return "\n".join([*commented(head), text + "\n".join(blanks)]).rstrip("\n") + "\n"


def noise_head(calibration: Calibration) -> Iterator[str]:
    """Measured noise and that of the file, each axis, and why they differ."""
    by_kind = {kind: noise_by_axis(calibration, kind) for kind in KINDS}
    if any(by_kind.values()):
        yield _(
            "Noise, as measured and for a filter; the file has one number for all three axes, that "
            "of the noisiest, so that none is given too much weight:"
        )
        yield from numbers(by_kind)
        yield from explanation(calibration.use, by_kind, corrected=True)


def noise_by_axis(calibration: Calibration, kind: str) -> list[FilterNoise]:
    """The noise of the sensors of a kind, for readings that all of the result has corrected."""
    triad = calibration.best(kind)[1]
    return [] if triad.unusable else filter_noise(triad, calibration.noise, calibration.use)


def filter_values(calibration: Calibration) -> tuple[dict[str, float], list[str]]:
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
        found = noise_by_axis(calibration, kind)
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


def not_contained(calibration: Calibration) -> Iterator[str]:
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


def remaining_without(calibration: Calibration) -> Iterator[str]:
    """How wrong readings are that are not corrected."""
    yield _("Errors that remain because of this, where the readings are not corrected first:")
    for kind in KINDS:
        yield from remaining_errors(calibration.best(kind)[1], np.zeros(3), np.ones(3))
