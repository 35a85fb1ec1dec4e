"""Findings about readings that depend on temperature."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import acos, degrees, sin, sqrt
from typing import Any

import numpy as np
import pandas as pd

from inertial.campaign.records import Manoeuvre
from inertial.effects import CATALOGUE
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS, UNKNOWN_STRUCTURE
from inertial.text.cause_names import in_words
from inertial.text.numbers import counted, decimals_of, fixed, p_is, significant, with_sigma
from inertial.text.units import DEGREE, STANDARD_GRAVITY
from stages.criticism.temperature_models import (
    ACCELEROMETERS,
    GYROS,
    ICE_POINT,
    SCALE,
    SHOWS,
    Channel,
    Moving,
    moving,
    sweeps,
)

# ---- What is said of readings that go with the temperature.

UPRIGHT = 0.99  # cosine from which an accelerometer stands along the vertical
CURVES = {1: "a straight line", 2: "a parabola", 3: "a cubic"}


@dataclass(frozen=True)
class Kind:
    """How a sweep is told: what goes with the temperature, its SI unit, and the people's."""

    what: str
    si: str
    unit: str
    size: float

    def of(self, value: float, digits: int = 2) -> str:
        """A size in the people's unit."""
        return f"{significant(value / self.size, digits)} {self.unit}"

    def per_kelvin(self, slope: float, sigma: float) -> str:
        """A slope with its sigma."""
        scatter = sigma / self.size
        numbers = with_sigma(slope / self.size, scatter, decimals_of(scatter))
        return f"{' ± '.join(numbers)} {self.unit} per K"


UNITS = {
    ACCELEROMETERS: Kind("the accelerometers", "m/s²", "mg", STANDARD_GRAVITY * 1e-3),
    GYROS: Kind("the gyros at rest", "rad/s", "°/s", DEGREE),
    SCALE: Kind("the scale factors of the gyros", "1", "ppm", 1e-6),
}


def _sentence(told: Moving, able: Mapping[str, Sequence[str]]) -> str:
    """What goes with the temperature, along which curve, and what it may be."""
    kind, best = UNITS[told.sweep.kind], told.best
    cold, warm = (_celsius(best.curve.at[end]) for end in (0, -1))
    begin = (
        f"From {cold} to {warm} °C ({told.sweep.manoeuvre.name}) {kind.what} move,"
        f" {best.axis} by {kind.of(best.change, 3)}"
    )
    said = [*_structure(best, kind)] if best.structure else [*_law(best, kind, told.about)]
    said.append(_causes(told, able))
    said += _no_tilt(told)
    if told.sweep.poor:
        fewer = f"{counted(told.sweep.poor, 'mean')} of fewer than {told.sweep.least:.0f} samples"
        said.append(f"Left out: {fewer}.")
    return f"{begin}, {' '.join(said)}"


def _structure(best: Channel, kind: Kind) -> Iterator[str]:
    highest = best.curve.highest
    yield (
        f"but not along a straight line nor {CURVES[highest]} ({p_is(best.chance_beyond)}):"
        f" {CURVES[highest]} leaves {kind.of(best.curve.left(highest))}, neighbours scatter by"
        f" {kind.of(best.curve.noise)}."
    )
    knee = best.knee
    if knee is None:
        yield "A knee does not fit clearly better."
        return
    low, high = (_celsius(place) for place in knee.between)
    below, above = (
        kind.per_kelvin(slope, sigma) for slope, sigma in zip(knee.slopes, knee.sigmas, strict=True)
    )
    yield (
        f"A knee at {_celsius(knee.at)} °C ({low} to {high}) fits better: {below} below, {above}"
        f" above; it leaves {kind.of(knee.left)}."
    )


def _law(best: Channel, kind: Kind, about: float) -> Iterator[str]:
    values, sigmas = best.curve.coefficients(best.degree, about)
    slope = kind.per_kelvin(float(values[0]), float(sigmas[0]))
    yield f"along {CURVES[best.degree]} ({p_is(best.chance)}): {slope} at {_celsius(about)} °C."
    if best.degree > 1:
        ends = best.curve.at[0], best.curve.at[-1]
        cold, warm = (significant(best.curve.slope(best.degree, e) / kind.size, 2) for e in ends)
        yield (
            f"The slope goes from {cold} in the cold to {warm} in the warm; a straight line would"
            f" leave {kind.of(best.curve.left(1))}, neighbours scatter by"
            f" {kind.of(best.curve.noise)}."
        )


def _causes(told: Moving, able: Mapping[str, Sequence[str]]) -> str:
    """The effects that may be it; of each that moves some of the axes alone, which."""
    named = []
    for cause, axes in able.items():
        where = f" ({', '.join(axes)})" if len(axes) < len(told.channels) else ""
        if cause == "table_tilt":
            angle = degrees(sqrt(sum(lean**2 for lean in told.leaning.values())))
            where = f" ({', '.join(axes)}: {significant(angle, 2)}°)"
        named.append(f"{in_words(cause)}{where}")
    listed = " or ".join([", ".join(named[:-1]), named[-1]] if len(named) > 1 else named)
    if told.structured:
        return f"The data are no more than consistent with {listed}."
    if len(named) == 1:
        return f"That is {listed}."
    return f"That is {listed}: this campaign cannot tell them apart."


def _no_tilt(told: Moving) -> Iterator[str]:
    """Why the accelerometer along the vertical is not moved by a tilt."""
    if told.sweep.kind != ACCELEROMETERS:
        return
    kind = UNITS[ACCELEROMETERS]
    moved = max((one.change for one in told.channels if one.axis in told.leaning), default=0.0)
    for one in told.channels:
        if told.sweep.along(one.axis) >= UPRIGHT and one.change < STANDARD_GRAVITY:
            angle = acos(1 - one.change / STANDARD_GRAVITY)
            level = STANDARD_GRAVITY * sin(angle)
            if level > moved:
                yield (
                    f"No tilt moves {one.axis} so: it would take {degrees(angle):.0f}° and move"
                    f" level axes by {kind.of(level)}, not by {kind.of(moved)}."
                )


def _consequence(told: Moving) -> str:
    """What it does to the model."""
    kind = UNITS[told.sweep.kind]
    moved = ", ".join(f"{one.axis} {kind.of(one.change)}" for one in told.channels)
    straight = ", ".join(f"{one.axis} {kind.of(one.curve.left(1))}" for one in told.channels)
    return (
        "The finding “temperature drift” of the log says that something is there; this one what it"
        " does to the model. Parameters without a temperature are off by"
        f" up to {moved} over this range; with a straight line {straight} rms would be left. The"
        " log has no times: a drift during the one sweep would look the same."
    )


def _action(told: Moving, split: str) -> str:
    """How to correct for it, and what to record."""
    best = told.best
    if told.structured:
        cure = "Correct by interpolating between the means, for no polynomial up to a cubic holds."
    else:
        cure = f"Correct by {CURVES[best.degree]} of the temperature."
    return f"{cure} To know more, {split_manoeuvre}."


def split_manoeuvre(told: Moving) -> str:
    """What would tell the members apart, and temperature from time."""
    again = "record the sweep with times, cooling after warming: that tells drift and hysteresis"
    if told.sweep.kind == SCALE:
        more = "" if told.sweep.unbiased else "with rests of the same attitude, and "
        return f"record the sweep {more}with the table's angle or the time of whole turns"
    if told.sweep.kind == GYROS:
        return again
    return (
        "record the same sweep upside down and with another axis up: a bias stays, what goes with"
        f" gravity turns its sign; {again}"
    )


def _parameters(told: Moving) -> Iterator[str]:
    """All numbers in SI: coefficients about a temperature; or a knee with slopes."""
    yield f"T0 = {told.about:.6g} K"
    unit = f"{UNITS[told.sweep.kind].si}/K"
    for one in told.channels:
        knee = one.knee
        if knee is not None:
            yield _in_si(f"knee_{one.axis}", knee.at, knee.sigma, "K")
            yield _in_si(f"below_{one.axis}", knee.slopes[0], knee.sigmas[0], unit)
            yield _in_si(f"above_{one.axis}", knee.slopes[1], knee.sigmas[1], unit)
            continue
        values, sigmas = one.curve.coefficients(one.told, told.about)
        for power, (value, sigma) in enumerate(zip(values, sigmas, strict=True), 1):
            powers = unit if power == 1 else f"{unit}{'²³'[power - 2]}"
            yield _in_si(f"k{power}_{one.axis}", float(value), float(sigma), powers)


def _in_si(name: str, value: float, sigma: float, unit: str) -> str:
    return f"{name} = {value:.6g} ± {sigma:.2g} {unit}"


def _celsius(kelvin: float) -> str:
    return fixed(kelvin - ICE_POINT, 1)


# ---- What goes with the temperature where only means at temperatures were recorded.
#
# Without time there is no noise, and the joint estimate determines nothing; so readings are held
# against the temperature itself. A finding for each sensor and manoeuvre: along a polynomial up
# to the third degree it has a law, and the effects that may be it are named; what no such law
# holds is structure, and a knee is looked for.

Row = dict[str, Any]


def findings(
    blocks: pd.DataFrame, plan: Sequence[Manoeuvre], level: float, suffix: str
) -> Iterator[Row]:
    """The findings of one mount; none where times were recorded, for there equations tell it.

    `level`: accepted chance of a law where there is none, and of a structure.
    """
    for told in moving(sweeps(blocks, plan), level):
        yield _finding(told, suffix)


def _finding(told: Moving, suffix: str) -> Row:
    sweep, best, able = told.sweep, told.best, members(told)
    if told.structured:
        verdict, p_value = UNKNOWN_STRUCTURE, best.chance_beyond
        statistic, degrees = best.curve.left_chi_squared()
    else:
        verdict, p_value = ONE_OF_CLASS if len(able) > 1 else FOUND, best.chance
        statistic, degrees = best.curve.drop(range(1, best.degree + 1)), best.degree
    split = split_manoeuvre(told)
    return {
        "id": f"criticism/temperature/{sweep.manoeuvre.name}/{sweep.kind}{suffix}",
        "cause": UNKNOWN_STRUCTURE if told.structured else next(iter(able)),
        "sensor": sweep.sensor,
        "axis": best.axis,
        "log": sweep.manoeuvre.log,
        "manoeuvre": sweep.manoeuvre.name,
        "count": 1,
        "size": best.change,
        "unit": UNITS[sweep.kind].si,
        "p_value": p_value,
        "severity": 2,
        "sentence": _sentence(told, able),
        "consequence": _consequence(told),
        "action": _action(told, split),
        "verdict": verdict,
        "members": ", ".join(able),
        "statistic": statistic,
        "degrees": degrees,
        "snr": float(np.sqrt(max(statistic - degrees, 0.0))),
        "parameters": "; ".join(_parameters(told)),
        "split_manoeuvre": split,
    }


def members(told: Moving) -> dict[str, list[str]]:
    """The effects that may be it, the likeliest first, each with the axes that it can move.

    A tilt moves an accelerometer across the vertical by g · angle, one along it by half the square
    of the angle; it is thought of up to the largest one of the catalogue.
    """
    sweep, axes = told.sweep, [channel.axis for channel in told.channels]
    if sweep.kind == SCALE:
        able = {"gyro_scale_temperature": axes, "table_speed_error": axes}
        return able if sweep.unbiased else able | {"gyro_bias_temperature": axes}
    if sweep.kind != ACCELEROMETERS:
        return {"gyro_bias_temperature": axes}
    able = {"accel_bias_temperature": axes}
    if upright := [axis for axis in axes if not sweep.along(axis) < SHOWS]:
        able["accel_scale_temperature"] = upright
    leaning = told.leaning
    if leaning and np.linalg.norm([*leaning.values()]) <= CATALOGUE["table_tilt"].largest:
        able["table_tilt"] = [*leaning]
    return able
