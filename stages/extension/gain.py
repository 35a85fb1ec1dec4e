"""By how much the effects bring the model nearer to the data: of a sensor, and of each channel."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from inertial.estimation.least_squares import Reduced, System
from inertial.tables import AXES
from stages.extension.channel_equations import system_of
from stages.extension.channels import Channels, Mean
from stages.extension.folds import drop_of
from stages.extension.held_out import HeldOut
from stages.extension.models import SENSORS, Models

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

    def told(but: Sequence[str]) -> tuple[float, int, Reduced] | None:
        some = [mean for mean in means if mean.manoeuvre not in but]
        system = system_of(some, names, channel, shown, walk)
        return None if system is None else _told(system)

    whole = told(())
    if whole is None:
        return
    chi_squared, degrees, reduced = whole
    yield row_of(FITTED, chi_squared, drop_of(best_of(one.whole.effects), reduced), degrees)
    before, drop, rows = 0.0, 0.0, 0
    for fold, _ in one.counted:
        part = told(fold.manoeuvres)
        if part is not None:
            before += chi_squared - part[0]
            drop += drop_of(fold.beta, reduced) - drop_of(fold.beta, part[2])
            rows += degrees - part[1]
    yield row_of(HELD_OUT, before, drop, rows)


def _told(system: System) -> tuple[float, int, Reduced]:
    """Chi-squared and degrees without the effects, and what is said of them."""
    reduced = system.reduced()
    kept = [i for i, (kind, _) in enumerate(system.names) if kind != "effect"]
    joint = System(
        system.design[:, kept],
        system.observed,
        system.sigma,
        system.prior[kept],
        system.prior_sigma[kept],
        system.sought,
        tuple(system.names[i] for i in kept),
    ).solve()
    return joint.chi_squared, joint.degrees, reduced


def best_of(told: Reduced) -> np.ndarray:
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
