"""Reduction of chi-squared by the effects."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.least_squares import EffectInformation, System
from inertial.estimation.periodic_in_time import without_line
from inertial.physics.forward import Triad
from inertial.tables import AXES
from stages.extension.channels import Channels, Mean, system_of
from stages.extension.cross_validation import HeldOut, drop_of, fold, snr_squared
from stages.extension.models import SENSORS, Models

# ---- By how much the effects bring the model nearer to the data: of a sensor, and of each
# channel.

Row = dict[str, Any]

FITTED, HELD_OUT = "fitted", "held-out"


def gain(models: Models, found: dict[str, HeldOut], mount: str) -> Iterator[Row]:
    """The rows of each sensor that shows the effects, then those of its channels."""
    channels = Channels(models.extended, models.effects)
    for number, sensor in enumerate(SENSORS):
        if sensor not in found:
            continue
        one = found[sensor]
        names = dict.fromkeys(
            name.partition(".")[0].partition("@")[0] for name in one.whole.effects.names
        )
        shared = {"mount": mount, "effects": ", ".join(names)}
        yield from (shared | row for row in _of_sensor(one))
        walk = models.extended.solution.walks[number]
        means = channels.means(sensor)
        for channel, axis in enumerate(AXES):
            rows = _of_channel(one, means, channels.names, channel, walk)
            yield from (shared | {"sensor": f"{sensor} {axis}"} | row for row in rows)


def _of_sensor(one: HeldOut) -> Iterator[Row]:
    whole = one.whole
    fitted = drop_of(best_of(whole.effects), whole.effects)
    shared = {"sensor": one.sensor}
    yield (
        shared
        | row_of(FITTED, whole.plain.chi_squared, fitted, whole.plain.degrees)
        | {"snr_squared": one.snr_squared, "walked": whole.walked}
    )
    chi_squared = sum(whole.plain.chi_squared - told.plain.chi_squared for _, told in one.counted)
    degrees = sum(whole.plain.degrees - told.plain.degrees for _, told in one.counted)
    yield (
        shared
        | row_of(HELD_OUT, chi_squared, one.drop, degrees)
        | {
            "snr_squared": one.at_stake,
            "walked": one.walked,
            "folds": len(one.folds),
            "counted": len(one.counted),
            "taken_away": ", ".join(name for fold, _ in one.counted for name in fold.manoeuvres),
            "left_out": ", ".join(one.left_out),
        }
    )


def _of_channel(
    one: HeldOut, means: Sequence[Mean], names: Sequence[str], channel: int, walk: float
) -> Iterator[Row]:
    """The effects are as all channels have them; held-out: as those of the other manoeuvres."""
    shown = one.whole.effects.names

    def told(but: Sequence[str]) -> tuple[float, int, EffectInformation] | None:
        some = [mean for mean in means if mean.manoeuvre not in but]
        system = system_of(some, names, channel, shown, walk)
        return None if system is None else _told(system)

    whole = told(())
    if whole is None:
        return
    chi_squared, degrees, reduced = whole
    yield row_of(FITTED, chi_squared, drop_of(best_of(one.whole.effects), reduced), degrees)
    before, drop, rows = 0.0, 0.0, 0
    for counted, _ in one.counted:
        part = told(counted.manoeuvres)
        if part is not None:
            before += chi_squared - part[0]
            drop += drop_of(counted.beta, reduced) - drop_of(counted.beta, part[2])
            rows += degrees - part[1]
    yield row_of(HELD_OUT, before, drop, rows)


def _told(system: System) -> tuple[float, int, EffectInformation]:
    """Chi-squared and degrees without the effects, and what is said of them."""
    reduced = system.effect_information()
    kept = [i for i, (kind, _) in enumerate(system.names) if kind != "effect"]
    joint = System(
        system.design[:, kept],
        system.observed,
        system.sigma,
        system.prior[kept],
        system.prior_sigma[kept],
        system.parameters,
        tuple(system.names[i] for i in kept),
    ).solve()
    return joint.chi_squared, joint.degrees, reduced


def best_of(told: EffectInformation) -> np.ndarray:
    """The parameters as the data have them; zero where they are not shown."""
    values, _ = told.estimate(range(len(told.names)))
    return np.asarray(np.nan_to_num(values))


def row_of(scope: str, before: float, drop: float, degrees: int) -> Row:
    """What every row has: chi-squared without and with the effects, and the rms of either."""

    def rms(squares: float) -> float | None:
        return float(np.sqrt(max(squares, 0.0) / degrees)) if degrees > 0 else None

    return {
        "scope": scope,
        "rows": degrees,
        "before": before,
        "after": before - drop,
        "drop": drop,
        "snr_squared": None,
        "walked": None,
        "folds": None,
        "counted": None,
        "taken_away": "",
        "left_out": "",
        "rms_before": rms(before),
        "rms_after": rms(before - drop),
        "unit": "sigma",
    }


# ---- What modelling an oscillation gains.

# ---- What an oscillation explains of the full-rate residuals of the turns.

Array = NDArray[np.float64]


def gain_of_line(
    turns: Sequence[tuple[str, Array]],
    step_of: Mapping[str, float],
    frequency: float,
    gyro: Triad,
    mount: str,
) -> Iterator[Row]:
    """What it explains about its axis, the axis that is the loudest.

    Held-out: the frequency is that of all turns and the amplitude that of the other turns; only
    the phase is the turn's own, for nothing could foretell it.

    Parameters
    ----------
    turns : name and residuals of the gyros, (n, 3), rad/s; `step_of`: s, of a sample of each
    frequency : Hz
    """
    inverse = np.linalg.inv(gyro.matrix)
    truths = {name: residuals @ inverse.T for name, residuals in turns}
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
    for scope in ("fitted", "held-out"):
        after = 0.0
        for name, part in parts.items():
            rest = [a for other, a in amplitudes.items() if other != name]
            size = amplitudes[name] if scope == "fitted" or not rest else float(np.mean(rest))
            after += float(np.sum(part.less(size) ** 2))
        yield {
            "sensor": f"gyro {'xyz'[axis]}",
            "mount": mount,
            "effects": "oscillation",
            "scope": scope,
            "rows": samples,
            "before": before / samples,
            "after": after / samples,
            "drop": (before - after) / samples,
            "rms_before": float(np.sqrt(before / samples)),
            "rms_after": float(np.sqrt(after / samples)),
            "unit": "rad/s",
        }


# ---- What a ripple of the table explains of the full-rate residuals of the turns.

ORDERS = {"table_eccentricity": 1.0}  # the order of an effect that has none to scan


def gain_of_ripple(
    turns: Sequence[SteadyTurn], effect: str, values: dict[str, float], mount: str
) -> Iterator[Row]:
    """What one sine and one cosine of the table's angle explain about its axis, in all turns.

    Bias and slope are each turn's own, and the noise is white. Held-out: each turn with the ripple
    of the others; only the order is that of all. `values`: of the effect's parameters, with n.
    """
    order = ORDERS.get(effect, values.get("n"))
    courses = {t.name: t.course(t.about) for t in turns if np.isfinite(t.rate)}
    if order is None or not courses:
        return
    said = {name: course.says(order) for name, course in courses.items()}
    squares = {n: float(np.sum(c.rest**2)) / c.sigma**2 for n, c in courses.items()}
    degrees = {n: len(c.record) - c.slow.shape[1] for n, c in courses.items()}

    def told(names: Sequence[str]) -> EffectInformation:
        return EffectInformation(
            ("a", "b"),
            sum((said[name][0] for name in names), np.zeros((2, 2))),
            sum((said[name][1] for name in names), np.zeros(2)),
            sum(squares[name] for name in names),
            sum(degrees[name] for name in names),
        )

    whole = told(list(said))
    folds = [fold([name], whole, told([o for o in said if o != name])) for name in said]
    counted = [one for one in folds if one.counts]
    shared = {"sensor": "gyro", "mount": mount, "effects": effect}
    fitted = float(best_of(whole) @ whole.right)
    yield (
        shared
        | row_of("fitted", whole.chi_squared, fitted, whole.degrees)
        | {"snr_squared": snr_squared(whole)}
    )
    names = [name for one in counted for name in one.manoeuvres]
    foretold = told(names)
    drop = sum(one.drop for one in counted)
    yield (
        shared
        | row_of("held-out", foretold.chi_squared, drop, foretold.degrees)
        | {
            "snr_squared": sum(one.at_stake for one in counted),
            "folds": len(folds),
            "counted": len(counted),
            "taken_away": ", ".join(names),
            "left_out": ", ".join(name for name in said if name not in names),
        }
    )
