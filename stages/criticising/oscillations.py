"""Oscillations of the case, from the full-rate residuals of the turns: rows and findings."""

from collections.abc import Iterator, Sequence
from math import degrees, pi
from typing import Any

import numpy as np

from stages.effects import CATALOGUE
from stages.estimation.ringing import Oscillating, Ringing
from stages.inference.naming.named import FOUND

Row = dict[str, Any]

EFFECT = CATALOGUE["oscillation"]
SUFFICES = 5.0  # sigmas: what a campaign can see


def score(heard: Sequence[Oscillating], rings: Sequence[Ringing]) -> Row:
    """How the oscillation was judged."""
    best = min((ring.line.p_value * len(rings) for ring in rings), default=1.0)
    ratio = max((r.line.amplitude / r.line.sigma_amplitude for r in rings), default=0.0)
    return {
        "effect": EFFECT.name,
        "cause": EFFECT.cause,
        "sought_in": "spectrum",
        "statistic": float(ratio**2),
        "degrees": 3 if rings else 0,
        "p_value": min(best, 1.0),
        "named": bool(heard),
        "verdict": FOUND if heard else "",
        "members": EFFECT.name if heard else "",
        "snr": float(ratio) if heard else None,
        "at": None,
        "sentence": _sentence(heard, rings),
    }


def findings(heard: Sequence[Oscillating], rings: Sequence[Ringing], suffix: str) -> Iterator[Row]:
    """The finding, if there is one."""
    for one in heard[:1]:
        told = score(heard, rings)
        yield {
            "id": f"criticism/{EFFECT.name}{suffix}",
            "cause": EFFECT.name,
            "sensor": "gyro",
            "count": 1,
            "size": one.amplitude,
            "unit": "rad/s",
            "p_value": one.p_value,
            "severity": 2,
            "sentence": told["sentence"],
            "consequence": "The model without it is not the whole truth; see what the extension"
            " gains.",
            "action": "It is added to the model by the extension.",
            "parameters": f"frequency = {one.frequency:.6g} ± {one.frequency_sigma:.2g} Hz;"
            f" amplitude = {one.amplitude:.6g} ± {one.amplitude_sigma:.2g} rad/s",
        } | {key: told[key] for key in ("verdict", "members", "statistic", "degrees", "snr")}


def _sentence(heard: Sequence[Oscillating], rings: Sequence[Ringing]) -> str:
    if not rings:
        return (
            "This campaign cannot show an oscillation: no whole turn at a steady rate was recorded."
        )
    if not heard:
        return "No oscillation stands out of the noise of the turns."
    one = heard[0]
    arc = degrees(one.amplitude / (2 * pi * one.frequency)) * 3600
    return (
        f"The case oscillates about {one.axis} while the table turns: {one.frequency:.3f} ±"
        f" {one.frequency_sigma:.1g} Hz, {one.amplitude:.5f} ± {one.amplitude_sigma:.1g} rad/s"
        f" ({arc:.1f}″), in {', '.join(one.manoeuvres)}. The other axes see it through their"
        " cross terms. Over a whole turn it adds no angle."
    )


def effects(heard: Sequence[Oscillating], rings: Sequence[Ringing], suffix: str) -> Iterator[Row]:
    """Its parameters, and the amplitude that could have been seen."""
    sigmas = [ring.line.sigma_amplitude for ring in rings]
    visible = {"amplitude": SUFFICES * float(np.median(sigmas))} if rings else {}
    values: dict[str, tuple[float, float]] = {}
    for one in heard[:1]:
        values["frequency"] = (one.frequency, one.frequency_sigma)
        values["amplitude"] = (one.amplitude, one.amplitude_sigma)
    for parameter in EFFECT.parameters:
        value, sigma = values.get(parameter.name, (None, None))
        yield {
            "id": f"criticism/{EFFECT.name}{suffix}/{parameter.name}",
            "effect": EFFECT.name,
            "parameter": parameter.name,
            "value": value,
            "sigma": sigma,
            "visible": visible.get(parameter.name),
            "unit": parameter.unit,
            "meaning": parameter.meaning,
        }


def lines(rings: Sequence[Ringing]) -> Iterator[Row]:
    """The strongest line of each axis in each turn."""
    for ring in rings:
        yield {
            "manoeuvre": ring.manoeuvre,
            "axis": ring.axis,
            "frequency": ring.line.frequency,
            "frequency_sigma": ring.line.sigma_frequency,
            "amplitude": ring.line.amplitude,
            "amplitude_sigma": ring.line.sigma_amplitude,
            "p_value": ring.line.p_value,
        }
