"""What means at temperatures in one attitude show of the parameters: their change from T0.

A level stays unknown, and what one attitude does not separate from a bias changes with it: along
the vertical g times the scale factor, across it g times a tilt. The sigma is that of the fitted
curve, the residuals counting as noise, and what the curve leaves beyond the scatter of neighbours.
"""

from collections.abc import Iterator

import numpy as np

from inertial.arrays import Array
from inertial.text.messages import _
from stages.criticism.finding_rows import TableRow
from stages.criticism.temperature_models import (
    ACCELEROMETERS,
    MIN_SENSITIVITY,
    SCALE,
    AxisModel,
    Sweep,
    TemperatureDependence,
)

TEMPERATURES = 41  # of a curve, from the coldest to the warmest
UNITS = {ACCELEROMETERS: "m/s²", SCALE: "1"}
OR_SCALE = _("or the scale factor error of this axis times gravity")
OR_TILT = _("or a tilt times gravity")
OR_SPEED = _("or an error of the table's speed")


def curve_rows(dependence: TemperatureDependence, mount: str) -> Iterator[TableRow]:
    """The change of each parameter that depends on the temperature."""
    sweep = dependence.sweep
    for model in dependence.axes:
        at = np.linspace(model.curve.at[0], model.curve.at[-1], TEMPERATURES)
        value, sigma = _changes(model, at, dependence.middle)
        for temperature, here, scatter in zip(at, value, sigma, strict=True):
            yield (
                "temperature_curves",
                {
                    "mount": mount,
                    "sensor": sweep.sensor,
                    "parameter": f"{'scale' if sweep.kind == SCALE else 'bias'}_{model.axis}",
                    "temperature": float(temperature),
                    "value": float(here),
                    "sigma": float(scatter),
                    "unit": UNITS.get(sweep.kind, "rad/s"),
                    "order": 1 if model.knee else model.described_degree,
                    "knot": model.knee.at if model.knee else None,
                    "probability": None,
                    "relative_to": dependence.middle,
                    "not_separated": _not_separated(sweep, model.axis),
                },
            )


def _changes(model: AxisModel, at: Array, middle: float) -> tuple[Array, Array]:
    """The change from the middle to each temperature, and its sigma, (m,) each."""
    curve, places = model.curve, np.append(at, middle)
    if model.knee is None:
        degree = model.described_degree
        design = np.vander(curve.at - middle, degree + 1, increasing=True)
        wanted = np.vander(places - middle, degree + 1, increasing=True)
        rms = curve.residual_rms(degree)
    else:
        knee, (below, above) = model.knee.at, model.knee.slopes
        design, wanted = (
            np.column_stack(
                [
                    np.ones(len(each)),
                    np.minimum(each - knee, 0.0),
                    np.maximum(each - knee, 0.0),
                    -np.where(each < knee, below, above),  # a shift of the knee
                ]
            )
            for each in (curve.at, places)
        )
        rms = model.knee.residual_rms
    inverse = np.linalg.pinv(design.T @ design)
    change = wanted[:-1] - wanted[-1]
    values = inverse @ design.T @ curve.readings
    if model.knee is not None:
        values = np.array([0.0, *model.knee.slopes, 0.0])
    beyond = max(rms**2 - curve.noise**2, 0.0)
    variance = rms**2 * np.einsum("ti,ij,tj->t", change, inverse, change) + beyond
    return change @ values, np.sqrt(variance)


def _not_separated(sweep: Sweep, axis: str) -> str | None:
    """What else the readings of this attitude may be."""
    if sweep.kind == SCALE:
        return OR_SPEED
    if sweep.kind != ACCELEROMETERS:
        return None
    return OR_SCALE if not sweep.along(axis) < MIN_SENSITIVITY else OR_TILT
