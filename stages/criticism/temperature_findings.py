"""Findings about readings that depend on temperature, where only means at temperatures exist.

Without time there is no noise, and the joint fit determines nothing; so readings are compared
with the temperature itself. A finding for each sensor and manoeuvre: readings along a polynomial up
to the third degree follow a law, and the effects that may be it are named; what no such law
describes is structure, and a knee is sought.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import acos, degrees, sin, sqrt

import numpy as np
import pandas as pd

from inertial.campaign.effect_sentences import Estimated
from inertial.campaign.records import Manoeuvre
from inertial.effects import CATALOGUE
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS, UNKNOWN_STRUCTURE
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, p_is, plus_minus, significant
from inertial.text.units import DEGREE, ICE_POINT, STANDARD_GRAVITY
from stages.criticism.finding_rows import (
    ONLY_CONSISTENT,
    TableRow,
    finding_id,
    finding_row,
    member_rows,
    parameter_row,
    snr_of,
)
from stages.criticism.temperature_models import (
    ACCELEROMETERS,
    GYROS,
    MIN_SENSITIVITY,
    SCALE,
    AxisModel,
    TemperatureDependence,
    curve_rows,
    sweeps,
    temperature_dependences,
)

MIN_UPRIGHT = 0.99  # cosine from which an accelerometer is taken to be along the vertical
CURVES = {1: _("a straight line"), 2: _("a parabola"), 3: _("a cubic")}

CHANGE = _("From {cold} to {warm} °C ({manoeuvre}) {readings} change, {axis} by {change},")
NO_LAW = _(
    "but not along a straight line nor {curve} ({p_value}): {curve} leaves "
    "{residual}, neighbours scatter by {noise}."
)
NO_KNEE = _("A knee does not fit significantly better.")
KNEE = _(
    "A knee at {at} °C ({low} to {high}) fits better: {below} below, {above} above; "
    "it leaves {residual}."
)
LAW = _("along {curve} ({p_value}): {slope} at {at} °C.")
SLOPES = _(
    "The slope goes from {cold} in the cold to {warm} in the warm; a straight line "
    "would leave {residual}, neighbours scatter by {noise}."
)
IDENTIFIED = _("The cause is {effects}.")
AMBIGUOUS = _("The cause is {effects}: this campaign cannot distinguish them.")
OMITTED = _("Omitted: {means} of fewer than {least:.0f} samples.")
NO_TILT = _(
    "No tilt changes {axis} so: it would take {angle:.0f}° and change horizontal "
    "axes by {expected}, not by {change}."
)
CONSEQUENCE = _(
    "The finding “temperature drift” of the log reports the change; this one what "
    "it does to the model. Parameters without a temperature are in error by up to "
    "{changes} over this range; with a straight line {residuals} rms would remain. "
    "The log has no times: a drift during the one sweep would look the same."
)
INTERPOLATE = _(
    "Correct by the curve of the result, or by interpolating between the means, for no polynomial "
    "up to a cubic describes them. To know more, {split}."
)
CORRECT = _("Correct by {curve} of the temperature. To know more, {split}.")
WITH_TIMES = _(
    "record the sweep with times, cooling after warming: that distinguishes drift and hysteresis"
)
WITH_RESTS = _(
    "record the sweep with static positions of the same attitude, and with the "
    "table's angle or the time of whole turns"
)
WITH_ANGLE = _("record the sweep with the table's angle or the time of whole turns")
OTHER_ATTITUDES = _(
    "record the same sweep upside down and with another axis up: a bias stays, what "
    "depends on gravity changes its sign; {with_times}"
)


@dataclass(frozen=True)
class Kind:
    """The quantity that changes with the temperature, its SI unit, and its unit in sentences."""

    readings: str
    si: str
    unit: str
    size: float

    def of(self, value: float, digits: int = 2) -> str:
        """A size in the unit of sentences."""
        return f"{significant(value / self.size, digits)} {self.unit}"

    def per_kelvin(self, slope: float, sigma: float) -> str:
        """A slope with its sigma."""
        return f"{plus_minus(slope / self.size, sigma / self.size)} {self.unit} per K"


KINDS = {
    ACCELEROMETERS: Kind(_("the accelerometers"), "m/s²", "mg", STANDARD_GRAVITY * 1e-3),
    GYROS: Kind(_("the gyros at rest"), "rad/s", "°/s", DEGREE),
    SCALE: Kind(_("the scale factors of the gyros"), "1", "ppm", 1e-6),
}


def temperature_rows(
    blocks: pd.DataFrame, plan: Sequence[Manoeuvre], level: float, mount: str
) -> Iterator[TableRow]:
    """The findings of one mount; none where times were recorded, for the equations include them.

    `level`: accepted probability of a law where there is none, and of a structure.
    """
    for dependence in temperature_dependences(sweeps(blocks, plan), level):
        yield from _finding(dependence, mount)
        yield from curve_rows(dependence, mount)


def _finding(dependence: TemperatureDependence, mount: str) -> Iterator[TableRow]:
    sweep, best, effects = dependence.sweep, dependence.best, members(dependence)
    if dependence.structured:
        verdict, p_value = UNKNOWN_STRUCTURE, best.p_beyond
        statistic, count = best.curve.residual_chi_squared()
    else:
        verdict, p_value = ONE_OF_CLASS if len(effects) > 1 else FOUND, best.p_value
        statistic, count = best.curve.drop(range(1, best.degree + 1)), best.degree
    split = _split(dependence)
    cause = UNKNOWN_STRUCTURE if dependence.structured else next(iter(effects))
    identifier = finding_id(f"temperature/{sweep.manoeuvre.name}/{sweep.kind}", mount)
    yield finding_row(
        cause,
        mount,
        id=identifier,
        sensor=sweep.sensor,
        axis=best.axis,
        log=sweep.manoeuvre.log,
        manoeuvre=sweep.manoeuvre.name,
        size=best.change,
        unit=KINDS[sweep.kind].si,
        p_value=p_value,
        sentence=_sentence(dependence, effects),
        consequence=_consequence(dependence),
        action=_action(dependence, split),
        verdict=verdict,
        statistic=statistic,
        degrees=count,
        snr=snr_of(statistic, count),
        split_manoeuvre=split,
        split_stated=True,
        predictor="temperature",
    )
    yield from member_rows(identifier, mount, list(effects))
    for parameter in _parameters(dependence):
        yield parameter_row(mount, cause, parameter, identifier, identifier)


def members(dependence: TemperatureDependence) -> dict[str, list[str]]:
    """The effects that may be it, the likeliest first, each with the axes that it can change.

    A tilt changes an accelerometer across the vertical by g · angle, one along it by half the
    square of the angle; it is considered up to the largest of the catalogue.
    """
    sweep, axes = dependence.sweep, [model.axis for model in dependence.axes]
    if sweep.kind == SCALE:
        effects = {"gyro_scale_temperature": axes, "table_speed_error": axes}
        return effects if sweep.unbiased else effects | {"gyro_bias_temperature": axes}
    if sweep.kind != ACCELEROMETERS:
        return {"gyro_bias_temperature": axes}
    effects = {"accel_bias_temperature": axes}
    if upright := [axis for axis in axes if not sweep.along(axis) < MIN_SENSITIVITY]:
        effects["accel_scale_temperature"] = upright
    tilts = dependence.tilts
    if tilts and np.linalg.norm([*tilts.values()]) <= CATALOGUE["table_tilt"].largest:
        effects["table_tilt"] = [*tilts]
    return effects


def _parameters(dependence: TemperatureDependence) -> Iterator[Estimated]:
    """Coefficients about a temperature; or a knee with slopes."""
    yield Estimated(
        "T0", "K", _("temperature about which polynomials are given"), dependence.middle
    )
    unit = f"{KINDS[dependence.sweep.kind].si}/K"
    for model in dependence.axes:
        axis, knee = model.axis, model.knee
        if knee is not None:
            at = _("temperature of the knee of {axis}", axis=axis)
            below, above = (
                _("slope of {axis} {side} the knee", axis=axis, side=side)
                for side in ("below", "above")
            )
            yield Estimated(f"knee_{axis}", "K", at, knee.at, knee.sigma)
            yield Estimated(f"below_{axis}", unit, below, knee.slopes[0], knee.sigmas[0])
            yield Estimated(f"above_{axis}", unit, above, knee.slopes[1], knee.sigmas[1])
            continue
        values, sigmas = model.curve.coefficients(model.described_degree, dependence.middle)
        for power, (value, sigma) in enumerate(zip(values, sigmas, strict=True), 1):
            powers = unit if power == 1 else f"{unit}{'²³'[power - 2]}"
            meaning = (
                _("change of {axis} per kelvin", axis=axis)
                if power == 1
                else _("of {axis}, times (T − T0)^{power}", axis=axis, power=power)
            )
            yield Estimated(f"k{power}_{axis}", powers, meaning, float(value), float(sigma))


# ---- Sentences.


def _sentence(dependence: TemperatureDependence, effects: Mapping[str, Sequence[str]]) -> str:
    """What depends on the temperature, along which curve, and what the cause may be."""
    sweep, best = dependence.sweep, dependence.best
    kind = KINDS[sweep.kind]
    cold, warm = (_celsius(best.curve.at[end]) for end in (0, -1))
    sentence = [
        CHANGE.format(
            cold=cold,
            warm=warm,
            manoeuvre=sweep.manoeuvre.name,
            readings=kind.readings,
            axis=best.axis,
            change=kind.of(best.change, 3),
        )
    ]
    sentence += _structure(best, kind) if best.structure else _law(best, kind, dependence.middle)
    sentence.append(_causes(dependence, effects))
    sentence += _no_tilt(dependence)
    if sweep.poor:
        sentence.append(OMITTED.format(means=counted(sweep.poor, "mean"), least=sweep.least))
    return " ".join(sentence)


def _structure(best: AxisModel, kind: Kind) -> Iterator[str]:
    highest = best.curve.highest
    yield NO_LAW.format(
        curve=CURVES[highest],
        p_value=p_is(best.p_beyond),
        residual=kind.of(best.curve.residual_rms(highest)),
        noise=kind.of(best.curve.noise),
    )
    knee = best.knee
    if knee is None:
        yield NO_KNEE
        return
    low, high = (_celsius(place) for place in knee.between)
    below, above = (
        kind.per_kelvin(slope, sigma) for slope, sigma in zip(knee.slopes, knee.sigmas, strict=True)
    )
    at, residual = _celsius(knee.at), kind.of(knee.residual_rms)
    yield KNEE.format(at=at, low=low, high=high, below=below, above=above, residual=residual)


def _law(best: AxisModel, kind: Kind, middle: float) -> Iterator[str]:
    values, sigmas = best.curve.coefficients(best.degree, middle)
    slope = kind.per_kelvin(float(values[0]), float(sigmas[0]))
    curve, p_value = CURVES[best.degree], p_is(best.p_value)
    yield LAW.format(curve=curve, p_value=p_value, slope=slope, at=_celsius(middle))
    if best.degree > 1:
        ends = best.curve.at[0], best.curve.at[-1]
        cold, warm = (significant(best.curve.slope(best.degree, e) / kind.size, 2) for e in ends)
        residual, noise = kind.of(best.curve.residual_rms(1)), kind.of(best.curve.noise)
        yield SLOPES.format(cold=cold, warm=warm, residual=residual, noise=noise)


def _causes(dependence: TemperatureDependence, effects: Mapping[str, Sequence[str]]) -> str:
    """The effects that may be it; with the axes where it changes only some."""
    names = []
    for effect, axes in effects.items():
        where = f" ({', '.join(axes)})" if len(axes) < len(dependence.axes) else ""
        if effect == "table_tilt":
            angle = degrees(sqrt(sum(tilt**2 for tilt in dependence.tilts.values())))
            where = f" ({', '.join(axes)}: {significant(angle, 2)}°)"
        names.append(f"{in_words(effect)}{where}")
    listed = _(" or ").join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)
    if dependence.structured:
        return ONLY_CONSISTENT.format(effects=listed)
    return (IDENTIFIED if len(names) == 1 else AMBIGUOUS).format(effects=listed)


def _no_tilt(dependence: TemperatureDependence) -> Iterator[str]:
    """Why the accelerometer along the vertical is not changed by a tilt."""
    if dependence.sweep.kind != ACCELEROMETERS:
        return
    kind, tilts = KINDS[ACCELEROMETERS], dependence.tilts
    change = max((model.change for model in dependence.axes if model.axis in tilts), default=0.0)
    for model in dependence.axes:
        upright = dependence.sweep.along(model.axis) >= MIN_UPRIGHT
        if upright and model.change < STANDARD_GRAVITY:
            angle = acos(1 - model.change / STANDARD_GRAVITY)
            expected = STANDARD_GRAVITY * sin(angle)
            if expected > change:
                yield NO_TILT.format(
                    axis=model.axis,
                    angle=degrees(angle),
                    expected=kind.of(expected),
                    change=kind.of(change),
                )


def _consequence(dependence: TemperatureDependence) -> str:
    """The effect on the model."""
    kind = KINDS[dependence.sweep.kind]
    return CONSEQUENCE.format(
        changes=", ".join(f"{model.axis} {kind.of(model.change)}" for model in dependence.axes),
        residuals=", ".join(
            f"{model.axis} {kind.of(model.curve.residual_rms(1))}" for model in dependence.axes
        ),
    )


def _action(dependence: TemperatureDependence, split: str) -> str:
    """How to correct for it, and what to record."""
    if dependence.structured:
        return INTERPOLATE.format(split=split)
    return CORRECT.format(curve=CURVES[dependence.best.degree], split=split)


def _split(dependence: TemperatureDependence) -> str:
    """What would distinguish the members, and temperature from time."""
    if dependence.sweep.kind == SCALE:
        return WITH_ANGLE if dependence.sweep.unbiased else WITH_RESTS
    if dependence.sweep.kind == GYROS:
        return WITH_TIMES
    return OTHER_ATTITUDES.format(with_times=WITH_TIMES)


def _celsius(kelvin: float) -> str:
    return fixed(kelvin - ICE_POINT, 1)
