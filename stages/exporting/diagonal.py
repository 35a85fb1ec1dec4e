"""What an autopilot can take: an offset, and for accelerometers a scale factor, of each axis.

    corrected = (reading − offset) × scale,   offset = bias,   scale = 1 / M_ii

which is right along the axis of the sensor itself. The autopilots store single precision.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from inertial.tables import AXES
from stages.exporting.calibration import Sensors

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Diagonal:
    """Offsets (3,), in the unit of the reading, and scale factors (3,), of single precision.

    NaN where left out; `left_out` says why: ("offset" or "scale", axis) → reason.
    """

    offset: Array
    scale: Array
    left_out: dict[tuple[str, str], str] = field(default_factory=dict)

    def numbers(self, what: str) -> Iterator[tuple[str, float]]:
        """Axis and number of the offsets, or scale factors, that are there."""
        values = self.offset if what == "offset" else self.scale
        for axis, value in zip(AXES, values, strict=True):
            if np.isfinite(value):
                yield axis, float(value)


def diagonal(sensors: Sensors, *, scaled: bool) -> Diagonal:
    """The part of a calibration that stands on the diagonal; the scale is 1 where none is taken."""
    found = Diagonal(_single(sensors.bias), np.ones(3))
    for i, axis in enumerate(AXES):
        if not np.isfinite(found.offset[i]):
            found.left_out["offset", axis] = sensors.reasons[f"bias_{axis}"]
        if not scaled:
            continue
        element = sensors.matrix[i, i]
        if not np.isfinite(element):
            found.left_out["scale", axis] = sensors.reasons[f"scale_{axis}"]
        elif element <= 0:
            found.left_out["scale", axis] = (
                f"M_{axis}{axis} is {element:.3g}: the sensor reads the other way round than the"
                " campaign names its axis, and no negative scale factor is taken"
            )
        found.scale[i] = 1 / element if element > 0 else np.nan
    return Diagonal(found.offset, _single(found.scale), found.left_out)


def number(value: float) -> str:
    """A number of single precision with all its digits."""
    return f"{value:.9g}"


def _single(values: Array) -> Array:
    return values.astype(np.float32).astype(np.float64)
