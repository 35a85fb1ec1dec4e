"""The temperature correction of autopilots: a cubic for the bias of each axis.

    PX4        offset = X0 + X1 d + X2 d² + X3 d³,   d = T − TREF
    ArduPilot  offset = P(T − 35 °C) − P(CALTEMP − 35 °C),   P(d) = 1e-6 (c1 d + c2 d² + c3 d³)

T in °C and not beyond TMIN and TMAX; both subtract it from the reading together with the constant
offset, before the scale factor (PX4-Autopilot, src/modules/temperature_compensation,
calc_thermal_offsets_3D; ardupilot, libraries/AP_InertialSensor/AP_InertialSensor_tempcal.cpp,
TCal::correct_sensor). So that no bias is taken off twice, the cubic is zero at the temperature for
which the constant offset is exported: TREF and CALTEMP are that, and X0 is 0.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array
from inertial.campaign.measurement import EffectOfResult
from inertial.physics.effect import COLDEST, MEAN_TEMPERATURE, WARMEST, Reading, Truth
from inertial.physics.motion import stretches
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.parameters import SENSOR_OF
from inertial.text.units import ICE_POINT
from stages.export.calibration import Calibration, Triad

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
