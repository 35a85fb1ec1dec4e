"""The reduction of chi-squared by the effects: of a sensor, and of each of its channels.

Fitted: all manoeuvres by the fit to all. Held-out: each manoeuvre by the fit to the others.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from inertial.arrays import Array
from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.effect_information import EffectInformation
from inertial.estimation.least_squares import System, with_columns
from inertial.estimation.periodic_in_time import without_line
from inertial.estimation.random_walk import MeasuredDrift
from inertial.sensors import SENSORS
from inertial.tables import AXES
from stages.extension.channels import Channels, Mean, system_of
from stages.extension.cross_validation import CrossValidation, Fold, drop_of, fold_of, snr_squared
from stages.extension.models import Models

Row = Mapping[str, Any]
TableRow = tuple[str, Row]  # the name of a table that the stage writes, and a row of it

FITTED, HELD_OUT = "fitted", "held-out"
BLOCKS = "blocks"  # the model of all effects that are fitted to means of blocks


def gain(models: Models, validated: dict[str, CrossValidation], mount: str) -> Iterator[TableRow]:
    """The rows of each sensor that shows the effects, then those of its channels."""
    channels = Channels(models.extended, models.effects)
    effect_of = {
        f"{effect.label}.{parameter.name}": effect.name
        for effect in models.effects
        for parameter in effect.parameters
    }
    for number, sensor in enumerate(SENSORS):
        if sensor not in validated:
            continue
        validation = validated[sensor]
        shared = {"mount": mount, "sensor": sensor, "model": BLOCKS}
        for effect in dict.fromkeys(effect_of[name] for name in validation.whole.effects.names):
            yield "gain_effects", shared | {"effect": effect}
        yield from (("gain", {**shared, "axis": None, **row}) for row in _of_sensor(validation))
        counted = [fold for fold, _ in validation.counted]
        yield from _fold_rows(shared, [(fold, fold in counted) for fold, _ in validation.folds])
        drifts = (models.extended.solution.random_walks[number], models.extended.drifts[sensor])
        means = channels.means(sensor)
        for channel, axis in enumerate(AXES):
            for row in _of_channel(validation, means, channels.names, channel, *drifts):
                yield "gain", {**shared, "axis": axis, **row}


def _fold_rows(shared: Row, folds: Sequence[tuple[Fold, bool]]) -> Iterator[TableRow]:
    for number, (fold, counted) in enumerate(folds, 1):
        for name in fold.manoeuvres:
            yield "held_out", {**shared, "fold": number, "manoeuvre": name, "counted": counted}


def _of_sensor(validation: CrossValidation) -> Iterator[Row]:
    whole = validation.whole
    fitted = drop_of(best_of(whole.effects), whole.effects)
    yield row_of(FITTED, whole.plain.chi_squared, fitted, whole.plain.degrees) | {
        "snr_squared": validation.snr_squared,
        "random_walk_drop": whole.walk_drop,
    }
    trained = [training.plain for _, training in validation.counted]
    chi_squared = sum(whole.plain.chi_squared - plain.chi_squared for plain in trained)
    degrees = sum(whole.plain.degrees - plain.degrees for plain in trained)
    yield row_of(HELD_OUT, chi_squared, validation.drop, degrees) | {
        "snr_squared": validation.expected_drop,
        "random_walk_drop": validation.walk_drop,
        "folds": len(validation.folds),
        "counted": len(validation.counted),
    }


def _of_channel(
    validation: CrossValidation,
    means: Sequence[Mean],
    names: Sequence[str],
    channel: int,
    random_walk: float,
    measured: MeasuredDrift,
) -> Iterator[Row]:
    """With the estimate from all channels; held-out: with that from the other manoeuvres."""
    shown = validation.whole.effects.names

    def fitted(without: Sequence[str]) -> tuple[float, int, EffectInformation] | None:
        some = [mean for mean in means if mean.manoeuvre not in without]
        system = system_of(some, names, channel, shown, random_walk, measured)
        return None if system is None else _fitted(system)

    whole = fitted(())
    if whole is None:
        return
    chi_squared, degrees, reduced = whole
    yield row_of(FITTED, chi_squared, drop_of(best_of(validation.whole.effects), reduced), degrees)
    before, drop, rows = 0.0, 0.0, 0
    for fold, _ in validation.counted:
        part = fitted(fold.manoeuvres)
        if part is not None:
            before += chi_squared - part[0]
            drop += drop_of(fold.beta, reduced) - drop_of(fold.beta, part[2])
            rows += degrees - part[1]
    yield row_of(HELD_OUT, before, drop, rows)


def _fitted(system: System) -> tuple[float, int, EffectInformation]:
    """Chi-squared and degrees without the effects, and the information about them."""
    reduced = system.effect_information()
    joint = with_columns(system, frozenset()).solve()
    return joint.chi_squared, joint.degrees, reduced


def best_of(effects: EffectInformation) -> Array:
    """The estimates of the parameters; zero where they are not determined."""
    values, _ = effects.estimate(range(len(effects.names)))
    return np.asarray(np.nan_to_num(values))


def row_of(scope: str, before: float, drop: float, degrees: int) -> dict[str, Any]:
    """Common columns: chi-squared without and with the effects, and the rms of either."""

    def rms(squares: float) -> float | None:
        return float(np.sqrt(max(squares, 0.0) / degrees)) if degrees > 0 else None

    return {
        "scope": scope,
        "rows": degrees,
        "before": before,
        "after": before - drop,
        "drop": drop,
        "rms_before": rms(before),
        "rms_after": rms(before - drop),
        "unit": "sigma",
    }


# ---- The full-rate residuals of the turns: an oscillation in time.


def gain_of_line(turns: Sequence[SteadyTurn], frequency: float, mount: str) -> Iterator[TableRow]:
    """The reduction by an oscillation about its axis, that of the largest standard deviation.

    Held-out: the frequency, Hz, is that of all turns and the amplitude that of the other turns;
    only the phase is the turn's own, for nothing could predict it.
    """
    truths, step_of = {t.name: t.truth for t in turns}, {t.name: t.step for t in turns}
    if not truths:
        return
    spread = np.mean([truth.std(axis=0) for truth in truths.values()], axis=0)
    axis = int(np.argmax(spread))
    parts = {
        name: without_line(truth[:, axis], 1 / step_of[name], frequency)
        for name, truth in truths.items()
    }
    amplitudes = {name: part.amplitude for name, part in parts.items()}
    samples = sum(len(truth) for truth in truths.values())
    before = sum(float(np.sum(part.record**2)) for part in parts.values())
    shared = {"mount": mount, "sensor": "gyro", "model": "oscillation"}
    yield "gain_effects", shared | {"effect": "oscillation"}
    for scope in (FITTED, HELD_OUT):
        after = 0.0
        for name, part in parts.items():
            rest = [a for other, a in amplitudes.items() if other != name]
            size = amplitudes[name] if scope == FITTED or not rest else float(np.mean(rest))
            after += float(np.sum(part.less(size) ** 2))
        yield (
            "gain",
            {
                **shared,
                "axis": AXES[axis],
                "scope": scope,
                "rows": samples,
                "before": before / samples,
                "after": after / samples,
                "drop": (before - after) / samples,
                "rms_before": float(np.sqrt(before / samples)),
                "rms_after": float(np.sqrt(after / samples)),
                "unit": "rad/s",
            },
        )


# ---- The full-rate residuals of the turns: a ripple of the table.

RATE_SHARE = 0.01  # within which two rates are the same
ORDERS = {"table_eccentricity": 1.0}  # the order of an effect that has none to scan


def gain_of_ripple(
    turns: Sequence[SteadyTurn], effect: str, values: Mapping[str, float], mount: str
) -> Iterator[TableRow]:
    """The reduction by a sine and a cosine of the table's angle about its axis, in all turns.

    Bias and slope are each turn's own, and the noise is white. Held-out: each turn with the ripple
    of the others; only the order is that of all. `values`: of the effect's parameters, with n; and
    with a and b where these are the same in all turns. Else only the amplitude is that of the
    others, of those at its rate where there are any.
    """
    order = ORDERS.get(effect, values.get("n"))
    courses = {t.name: t.course(t.about) for t in turns if np.isfinite(t.rate)}
    if order is None or not courses:
        return
    equations = {name: course.normal_equations(order) for name, course in courses.items()}
    squares = {n: float(np.sum(c.rest**2)) / c.sigma**2 for n, c in courses.items()}
    degrees = {n: len(c.record) - c.slow.shape[1] for n, c in courses.items()}

    def summed(names: Sequence[str]) -> EffectInformation:
        return EffectInformation(
            ("a", "b"),
            sum((equations[name][0] for name in names), np.zeros((2, 2))),
            sum((equations[name][1] for name in names), np.zeros(2)),
            sum(squares[name] for name in names),
            sum(degrees[name] for name in names),
        )

    whole = summed(list(courses))
    folds = [
        fold_of([n], whole, summed([other for other in courses if other != n])) for n in courses
    ]
    fitted, snr = drop_of(best_of(whole), whole), snr_squared(whole)
    if "n" in values and "a" not in values:
        each = {name: summed([name]) for name in courses}
        folds = _with_own_phases(each, {name: abs(c.rate) for name, c in courses.items()})
        fitted = sum(drop_of(best_of(one), one) for one in each.values())
        snr = sum(snr_squared(one) for one in each.values())
    counted = [fold for fold in folds if fold.counts]
    shared = {"mount": mount, "sensor": "gyro", "model": effect}
    yield "gain_effects", shared | {"effect": effect}
    row = row_of(FITTED, whole.chi_squared, fitted, whole.degrees)
    yield "gain", {**shared, "axis": None, **row, "snr_squared": snr}
    predicted = summed([name for fold in counted for name in fold.manoeuvres])
    drop = sum(fold.drop for fold in counted)
    row = row_of(HELD_OUT, predicted.chi_squared, drop, predicted.degrees)
    row |= {"snr_squared": sum(fold.expected_drop for fold in counted)}
    row |= {"folds": len(folds), "counted": len(counted)}
    yield "gain", {**shared, "axis": None, **row}
    yield from _fold_rows(shared, [(fold, fold.counts) for fold in folds])


def _with_own_phases(
    turns: Mapping[str, EffectInformation], rates: Mapping[str, float]
) -> list[Fold]:
    """Each turn by the mean amplitude of the others at its rate, or of all, and its own phase."""
    own = {name: best_of(one) for name, one in turns.items()}
    folds = []
    for name, one in turns.items():
        others = [other for other in turns if other != name]
        alike = [other for other in others if np.isclose(rates[other], rates[name], RATE_SHARE)]
        sizes = [np.linalg.norm(own[other]) for other in alike or others]
        amplitude = float(np.mean(sizes)) if sizes else 0.0
        beta = own[name] * amplitude / max(float(np.linalg.norm(own[name])), np.finfo(float).tiny)
        kept = 1.0 if sizes else 0.0
        folds.append(Fold((name,), kept, beta, drop_of(beta, one), snr_squared(one)))
    return folds
