"""Correction axis by axis, and the errors that remain where no more of M is applied.

    corrected = (reading − offset) × scale,   offset = bias,   scale = 1 / M_ii
    remaining = scale · (M · truth + bias − offset) − truth,   sensor by sensor

for a truth of ±1 g, or ±100 °/s, along each axis in turn. The autopilots store single precision.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import product
from math import radians

import numpy as np

from inertial.arrays import Array
from inertial.campaign.measurement import EffectOfResult
from inertial.physics.effect import COLDEST, MEAN_TEMPERATURE, WARMEST, Reading, Truth
from inertial.physics.motion import stretches
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.parameters import PARTS, SENSOR_OF
from inertial.text.units import ICE_POINT, STANDARD_GRAVITY
from stages.export.calibration import PARAMETERS, Calibration, Triad

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
            yield _(
                "- {axis} {sensor}: up to {errors:.3g} {unit}, with {value}{probe} along {axes}",
                axis=axis,
                sensor=sensor,
                errors=errors[largest, i],
                unit=unit,
                value="+" if sign > 0 else "-",
                probe=probe,
                axes=AXES[along],
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


# ---- The temperature correction of autopilots: a cubic for the bias of each axis.
#
#     PX4        offset = X0 + X1 d + X2 d² + X3 d³,   d = T − TREF
#     ArduPilot  offset = P(T − 35 °C) − P(CALTEMP − 35 °C),   P(d) = 1e-6 (c1 d + c2 d² + c3 d³)
#
# T in °C and not beyond TMIN and TMAX; both subtract it from the reading together with the
# constant offset, before the scale factor (PX4-Autopilot, src/modules/temperature_compensation,
# calc_thermal_offsets_3D; ardupilot, libraries/AP_InertialSensor/AP_InertialSensor_tempcal.cpp,
# TCal::correct_sensor). So that no bias is taken off twice, the cubic is zero at the temperature
# for which the constant offset is exported: TREF and CALTEMP are that, and X0 is 0.

ORDER = 3
# The constants of effects of temperature, and what was recorded where they have none.
RANGE = {MEAN_TEMPERATURE: "mean", COLDEST: "lowest", WARMEST: "highest"}
POINTS = 241  # temperatures at which the cubic is fitted
MAX_ROUNDING = 1e-6  # of the whole change, from which an error is stated
ARDUPILOT_REFERENCE = 35.0 + ICE_POINT  # K, TEMP_REFERENCE
ARDUPILOT_UNIT = 1e-6  # INV_SCALE_FACTOR


@dataclass(frozen=True)
class Cubic:
    """Change of the biases with the temperature, as an autopilot takes it off.

    reference : K, where it is zero; lowest, highest : K, its range
    powers : (3, 3), of d = T − reference in K; row: the power 1 to 3; column: the axis; NaN where
        the bias is not determined
    error : (3,), the largest difference from the effects in its range, in the unit of the reading
    change : (3,), by how much the bias changes in its range
    """

    reference: float
    lowest: float
    highest: float
    powers: Array
    error: Array
    change: Array

    def about(self, reference: float) -> Array:
        """The powers 1 to 3 of T − reference of the same curves, less a constant, (3, 3)."""
        s, (one, two, three) = reference - self.reference, self.powers
        return np.array([one + 2 * s * two + 3 * s**2 * three, two + 3 * s * three, three])


def cubic_of(triad: Triad, calibration: Calibration) -> tuple[Triad, Cubic | None]:
    """The triad with its bias at the reference, and the cubic; none without a dependence."""
    recorded = calibration.temperature
    missing = ~np.isfinite(triad.bias)
    if recorded is None or missing.all():
        return triad, None
    constants = {n: row["value"] for one in triad.removable for n, row in one.constants.items()}
    reference, lowest, highest = (
        float(constants.get(name) or recorded[otherwise]) for name, otherwise in RANGE.items()
    )
    at = np.linspace(lowest, highest, POINTS)
    own = [one for one in triad.removable if _of_the_bias(one, triad.kind, at)]
    if not own:
        return triad, None
    every = np.append(at, reference)
    added = np.sum([_added(one, triad.kind, every) for one in own], axis=0)
    constant, curve = added[-1], added[:-1] - added[-1]
    powers, error = _fitted(at - reference, curve)
    powers[:, missing] = np.nan
    cubic = Cubic(
        reference,
        lowest,
        highest,
        powers,
        error,
        np.ptp(curve, axis=0),
    )
    return replace(triad, bias=triad.bias + constant), cubic


def _added(one: EffectOfResult, kind: str, at: Array, felt: float = 0.0) -> Array:
    """What an effect adds at temperatures to sensors that feel as much on every axis, (k, 3)."""
    zero, truth = np.zeros((len(at), 3)), np.full((len(at), 3), felt)
    motion = stretches(np.zeros(len(at)), np.full(len(at), 1e-6), at)
    reading = one.effect.reads(Reading(zero, zero), Truth(truth, truth), motion, one.values)
    return np.asarray(getattr(reading, SENSOR_OF[kind]))


def _of_the_bias(one: EffectOfResult, kind: str, at: Array) -> bool:
    """Whether an effect changes the biases with the temperature."""
    return bool(np.ptp(_added(one, kind, at), axis=0).any())


def whole(one: EffectOfResult, kind: str, cubic: Cubic) -> bool:
    """Whether the cubic is all that an effect adds: nothing of it goes with what is felt."""
    at = np.linspace(cubic.lowest, cubic.highest, POINTS)
    alike = np.array_equal(_added(one, kind, at), _added(one, kind, at, felt=1.0))
    return alike and _of_the_bias(one, kind, at)


def _fitted(d: Array, curve: Array) -> tuple[Array, Array]:
    """Least squares through zero at d = 0 of the lowest order that suffices, (3, 3) and (3,)."""
    span = np.abs(d).max()
    for order in range(1, ORDER + 1):
        design = (d[:, None] / span) ** np.arange(1, order + 1)
        scaled = np.linalg.lstsq(design, curve, rcond=None)[0]
        error = np.abs(design @ scaled - curve).max(axis=0)
        if (error <= MAX_ROUNDING * np.ptp(curve, axis=0).max()).all():
            break
    powers = np.zeros((ORDER, curve.shape[1]))
    powers[:order] = scaled / span ** np.arange(1, order + 1)[:, None]
    return powers, error


def px4_values(cubics: Mapping[str, Cubic]) -> Iterator[tuple[str, float]]:
    """Name and value of the parameters of PX4; by kind of triad."""
    for kind, cubic in cubics.items():
        letter = "A" if kind == "accelerometer" else "G"
        yield f"TC_{letter}_ENABLE", 1
        for name, kelvin in zip(
            ("TREF", "TMIN", "TMAX"), (cubic.reference, cubic.lowest, cubic.highest), strict=True
        ):
            yield f"TC_{letter}0_{name}", kelvin - ICE_POINT
        for power, row in enumerate((np.zeros(3), *cubic.powers)):
            for i, value in enumerate(np.nan_to_num(row)):
                yield f"TC_{letter}0_X{power}_{i}", float(value)


def ardupilot_values(cubics: Mapping[str, Cubic]) -> Iterator[tuple[str, float]]:
    """Name and value of the parameters of ArduPilot; by kind of triad.

    Those of the other kind are zero, because one switch is for both.
    """
    if not cubics:
        return
    yield "INS_TCAL1_ENABLE", 1
    yield "INS_TCAL1_TMIN", max(cubic.lowest for cubic in cubics.values()) - ICE_POINT
    yield "INS_TCAL1_TMAX", min(cubic.highest for cubic in cubics.values()) - ICE_POINT
    for kind, short in (("accelerometer", "ACC"), ("gyroscope", "GYR")):
        powers = np.zeros((ORDER, 3))
        if kind in cubics:
            yield f"INS_{short}1_CALTEMP", cubics[kind].reference - ICE_POINT
            powers = np.nan_to_num(cubics[kind].about(ARDUPILOT_REFERENCE)) / ARDUPILOT_UNIT
        for power, row in enumerate(powers, 1):
            for axis, value in zip(AXES, row, strict=True):
                yield f"INS_TCAL1_{short}{power}_{axis.upper()}", float(value)


def notes_on(cubics: Mapping[str, Cubic], target: str) -> Iterator[str]:
    """What the user must know about the temperature, one item each."""
    px4 = target == "PX4"
    if not cubics:
        yield (
            _(
                "- Where TC_A_ENABLE or TC_G_ENABLE is set, PX4 subtracts a thermal offset as "
                "well. Set TC_A0_ID and TC_G0_ID to 0, or the bias is taken off twice."
            )
            if px4
            else _(
                "- Where INS_TCAL1_ENABLE is set, ArduPilot adds a temperature correction of its "
                "own. Set it to 0, or learn it anew after loading: it belongs to other offsets."
            )
        )
        return
    for kind, cubic in cubics.items():
        yield _(
            "- Temperature of the {kind}s: valid from {lowest:.1f} to {highest:.1f} °C; beyond, "
            "the correction stays as it is there. The offsets are those at {reference:.2f} °C, and "
            "the cubic is zero there, so nothing is taken off twice.",
            kind=kind,
            lowest=cubic.lowest - ICE_POINT,
            highest=cubic.highest - ICE_POINT,
            reference=cubic.reference - ICE_POINT,
        )
        if (cubic.error > MAX_ROUNDING * cubic.change.max()).any():
            yield _(
                "- No cubic follows the bias of the {kind}s over the temperature, which has a "
                "knee. The best one is off by up to {errors} {unit} for x, y, z.",
                kind=kind,
                errors=", ".join(f"{value:.2g}" for value in cubic.error),
                unit="m/s²" if kind == "accelerometer" else "rad/s",
            )
    yield (
        _(
            "- TC_A0_ID and TC_G0_ID are the same device ids as above; without them PX4 leaves the "
            "temperature out. The firmware must contain the module temperature_compensation."
        )
        if px4
        else _(
            "- The offsets belong to INS_ACC1_CALTEMP and INS_GYR1_CALTEMP. A calibration in the "
            "vehicle replaces both, and is then without this one."
        )
    )
