"""Biases and matrix elements as functions of the temperature, each of its own shape."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR, ICE_POINT, MICROGRAVITY, PPM

Curve = Callable[[Array, float], Array]  # T and its reference, K → change of the parameter


@dataclass(frozen=True)
class TemperatureCurves(Effect):
    """f̃_i += Σ_j m_ij(T) f_j + b_i(T), and so the gyros; T of these sensors, not that recorded.

    Each curve is a polynomial k₁ ΔT + k₂ ΔT² + … of any order, ΔT from the temperature at which
    `truth` specifies the parameter, or a knee: one slope below a temperature and another above.
    accelerometer, gyro: a curve for the bias, (row, None), or for the element, (row, column).
    Source: IEEE Std 1293-2018 and 952-1997, model equations, terms of temperature.
    """

    accelerometer: Mapping[tuple[int, int | None], Curve]
    gyro: Mapping[tuple[int, int | None], Curve]

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        accelerometer, gyro = (parameters.get(kind, {}) for kind in ("accelerometer", "gyro"))
        return cls(
            _curves(accelerometer, "bias_micro_g", MICROGRAVITY),
            _curves(gyro, "bias_deg_h", DEGREE / HOUR),
        )

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading(
            _added(self.accelerometer, "accelerometer", truth, truth.force),
            _added(self.gyro, "gyro", truth, truth.rate),
        )


def _curves(
    written: Mapping[str, Any], bias: str, unit: float
) -> dict[tuple[int, int | None], Curve]:
    return {
        ("xyz".index(name[0]), "xyz".index(name[1]) if name[1:] else None): _curve(curve, of)
        for key, of in ((bias, unit), ("matrix_ppm", PPM))
        for name, curve in written.get(key, {}).items()
    }


def _curve(written: Mapping[str, Any], unit: float) -> Curve:
    if "powers" in written:
        polynomial = np.polynomial.Polynomial([0.0, *(unit * np.array(written["powers"], float))])
        return lambda at, reference: np.asarray(polynomial(at - reference))
    knee = written["knee_deg_c"] + ICE_POINT
    below, above = written["below"] * unit, written["above"] * unit

    def bent(at: Array) -> Array:
        return np.asarray(np.where(at < knee, below, above) * (at - knee))

    return lambda at, reference: bent(at) - bent(np.asarray(reference))


def _added(
    curves: Mapping[tuple[int, int | None], Curve], node: str, truth: Truth, felt: Array
) -> Array:
    added = np.zeros_like(felt)
    if curves:
        at = truth.warmer(node) + truth.temperature.reference
        for (row, column), curve in curves.items():
            change = curve(at, truth.temperature.reference)
            added[:, row] += change if column is None else change * felt[:, column]
    return added
