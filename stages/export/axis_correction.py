"""Correction axis by axis, and the errors that remain where no more of M is applied.

    corrected = (reading − offset) × scale,   offset = bias,   scale = 1 / M_ii
    remaining = scale · (M · truth + bias − offset) − truth,   sensor by sensor

for a truth of ±1 g, or ±100 °/s, along each axis in turn. The autopilots store single precision.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import product
from math import radians

import numpy as np

from inertial.arrays import Array
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.parameters import PARTS
from inertial.text.units import STANDARD_GRAVITY
from stages.export.calibration import PARAMETERS, Triad

# Per triad: the truth, its name, and the unit in which the error is stated.
PROBES = {
    "accelerometer": (STANDARD_GRAVITY, "1 g", 1e-3 * STANDARD_GRAVITY, "mg"),
    "gyroscope": (radians(100), "100 deg/s", radians(1), "deg/s"),
}


@dataclass(frozen=True)
class AxisCorrection:
    """Offsets (3,), in the unit of the reading, and scale factors (3,), of single precision.

    NaN where left out; `left_out` says why: ("offset" or "scale", axis) → reason.
    """

    offset: Array
    scale: Array
    left_out: dict[tuple[str, str], str] = field(default_factory=dict)

    def values(self, quantity: str) -> Iterator[tuple[str, float]]:
        """Axis and value of the offsets, or of the scale factors, that are not left out."""
        values = self.offset if quantity == "offset" else self.scale
        for axis, value in zip(AXES, values, strict=True):
            if np.isfinite(value):
                yield axis, float(value)


def axis_correction(triad: Triad, *, scaled: bool) -> AxisCorrection:
    """Offset and scale factor of each axis; the scale factors are 1 unless `scaled`."""
    scale, left_out = np.ones(3), {}
    for i, axis in enumerate(AXES):
        if not np.isfinite(triad.bias[i]):
            left_out["offset", axis] = triad.reasons[f"bias_{axis}"]
        if not scaled:
            continue
        element = triad.matrix[i, i]
        if not np.isfinite(element):
            left_out["scale", axis] = triad.reasons[f"scale_{axis}"]
        elif element <= 0:
            left_out["scale", axis] = _(
                "M_{axis}{axis} is {element:.3g}: the sensor reads the other way round than the "
                "campaign names its axis, and a negative scale factor is not accepted",
                axis=axis,
                element=element,
            )
        scale[i] = 1 / element if element > 0 else np.nan
    return AxisCorrection(_single_precision(triad.bias), _single_precision(scale), left_out)


def _single_precision(values: Array) -> Array:
    return values.astype(np.float32).astype(np.float64)


def remaining_errors(triad: Triad, offset: Array, scale: Array) -> Iterator[str]:
    """The largest remaining error of each sensor in words, one item each.

    offset, scale : (3,), what is subtracted from a reading and what it is then multiplied by
    """
    size, probe, unit_size, unit = PROBES[triad.kind]
    probes = list(product(range(3), (1, -1)))
    truth = size * np.array([sign * np.eye(3)[axis] for axis, sign in probes])  # (6, 3)
    reading = truth @ triad.matrix.T + triad.bias
    errors = np.abs(scale * (reading - offset) - truth) / unit_size
    sensor = "gyro" if triad.kind == "gyroscope" else triad.kind
    for i, axis in enumerate(AXES):
        if np.isfinite(errors[:, i]).all():
            largest = int(np.argmax(errors[:, i]))
            along, sign = probes[largest]
            yield (
                _(
                    "- {axis} {sensor}: up to {errors:.3g} {unit}, with {value}{probe} "
                    "along {axes}",
                    axis=axis,
                    sensor=sensor,
                    errors=errors[largest, i],
                    unit=unit,
                    value="+" if sign > 0 else "-",
                    probe=probe,
                    axes=AXES[along],
                )
            )
        else:
            missing = [n for n in PARAMETERS if n in triad.reasons and PARTS[n].sensor_axis == axis]
            verb = "was" if len(missing) == 1 else "were"
            subject = f"{', '.join(missing)} {verb}" if missing else _("it was")
            yield _(
                "- {axis} {sensor}: not known, because {subject} not determined",
                axis=axis,
                sensor=sensor,
                subject=subject,
            )


def cross_terms(triad: Triad) -> str:
    """The six off-diagonal elements of M."""
    pairs = [(i, j) for i, j in product(range(3), repeat=2) if i != j]
    return _listed([f"M_{AXES[i]}{AXES[j]}" for i, j in pairs], [triad.matrix[p] for p in pairs])


def scale_errors(triad: Triad) -> str:
    """The three scale factor errors M_xx − 1, M_yy − 1, M_zz − 1, in parts per million."""
    return f"{_listed(AXES, 1e6 * (np.diag(triad.matrix) - 1))} ppm"


def biases(triad: Triad) -> str:
    """The three biases with their unit."""
    return f"{_listed(AXES, triad.bias)} {triad.unit}"


def _listed(names: Iterable[str], values: Iterable[float]) -> str:
    return ", ".join(
        f"{name}={value:+.6g}" if np.isfinite(value) else f"{name}=unknown"
        for name, value in zip(names, values, strict=True)
    )
