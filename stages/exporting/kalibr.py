"""Kalibr's imu.yaml: noise densities and the sample rate, and nothing of the calibration itself.

Kalibr reads six keys, all of which it insists on: rostopic, update_rate (Hz), and for both triads
noise_density and random_walk, in continuous time: m/s²/√Hz and rad/s/√Hz, m/s³/√Hz and rad/s²/√Hz.
A sample has noise_density × √update_rate (ethz-asl/kalibr, kalibr_common/ConfigReader.py, class
ImuParameters), so noise_density is the random walk of the noise table. Matrices stand in Kalibr's
results alone, where its model scale-misalignment estimates them.
"""

from collections.abc import Iterator

import numpy as np

from stages.exporting import effects
from stages.exporting.calibration import Calibration
from stages.exporting.comments import commented
from stages.exporting.heading import heading, mounts
from stages.exporting.remainder import biases, cross_terms, scale_errors, told
from stages.exporting.yaml_text import yaml_text

KINDS = {"accelerometer": "accel", "gyroscope": "gyro"}


def kalibr(calibration: Calibration) -> str:
    """The file imu.yaml, to be completed by hand where its head says so."""
    head = list(heading(calibration, "Kalibr (imu.yaml)"))
    if calibration.nothing:
        return "\n".join(commented(head)) + "\n"
    found, left_out = _numbers(calibration)
    head += ["", "To be filled in before Kalibr takes this file:", *left_out]
    head += ["", "What this file cannot carry, for Kalibr reads no such key:"]
    head += [*_losses(calibration), ""]
    text = yaml_text(found) if found else ""
    return "\n".join(commented(head)) + "\n" + text + "\n".join(_blank(found)) + "\n"


def _numbers(calibration: Calibration) -> tuple[dict[str, float], list[str]]:
    """The keys that the campaign determines, and in words those that it does not."""
    found: dict[str, float] = {}
    left_out = ["- rostopic: the topic of your recording; a turntable does not know it"]
    stated = calibration.about["rate"]
    if rate := calibration.rate or stated:
        found["update_rate"] = float(rate)
    else:
        left_out.append("- update_rate: left out, for the logs have no time and no rate is stated")
    for kind, sensor in KINDS.items():
        levels = [row["density"] for row in calibration.noise if row["channel"].startswith(sensor)]
        if levels:
            found[f"{kind}_noise_density"] = max(levels)
        else:
            left_out.append(
                f"- {kind}_noise_density: left out, for no stretch at rest or at a steady rate is"
                " long enough to tell the noise"
            )
        left_out.append(
            f"- {kind}_random_walk: left out, for it was not measured: how the bias wanders shows"
            " in an Allan deviation over hours at rest"
        )
    return found, left_out


def _losses(calibration: Calibration) -> Iterator[str]:
    chosen = [calibration.best(kind) for kind in KINDS]
    for _, sensors in chosen:
        yield f"- bias of the {sensors.kind}s: {biases(sensors)}"
        yield f"- scale factor errors of the {sensors.kind}s: {scale_errors(sensors)}"
        yield f"- cross-axis terms of the {sensors.kind}s: {cross_terms(sensors)}"
    for kind, sensor in KINDS.items():
        own = [row for row in calibration.noise if row["channel"].startswith(sensor)]
        if own:
            each = ", ".join(f"{row['channel'][-1]}={row['density']:.4g}" for row in own)
            yield (
                f"- noise densities of the single {kind}s: {each}; the file has one for all three,"
                " that of the noisiest, so that Kalibr trusts none too much"
            )
    yield from effects.told(sensors for _, sensors in chosen)
    yield "- the sigma of every number, their covariance, the temperature"
    yield from mounts(calibration, chosen)
    yield (
        "Kalibr estimates the biases anew, and by its model scale-misalignment also the matrices,"
        " from its own recording. To use the calibration itself, correct the readings before Kalibr"
        " sees them: truth = inverse (reading - bias)."
    )
    yield ""
    yield "What this file cannot carry leaves, where the readings are not corrected first:"
    for _, sensors in chosen:
        yield from told(sensors, np.zeros(3), np.ones(3))


def _blank(found: dict[str, float]) -> Iterator[str]:
    """The missing keys as comments, ready to be filled in."""
    keys = ["rostopic", "update_rate"]
    keys += [f"{kind}_{what}" for kind in KINDS for what in ("noise_density", "random_walk")]
    yield from (f"# {key}:" for key in keys if key not in found)
