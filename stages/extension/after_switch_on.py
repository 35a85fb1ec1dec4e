"""Biases after the instrument is switched on: how long they settle, and by what runs differ.

Each settles from the first sample until it stays within a band about its last value. That is known
by the effects of the model: an exponential in time, functions of a temperature that rises. In a
chamber that also cools it is not defined, and without such an effect nothing warms up. Where the
instrument was switched on again, time counts from the last switch-on, and a temperature, whose
course may be another each time, tells nothing.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from inertial.arrays import Array
from inertial.campaign.equations import Campaign
from inertial.effects.restarts import Restarts
from inertial.estimation.scatter_and_random_walk import SwitchOns, between
from inertial.estimation.triad import UNKNOWNS
from inertial.physics.effect import Effect, Reading, Truth
from inertial.physics.motion import Motion
from inertial.sensors import SINGULAR, UNITS
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.numbers import plus_minus, significant
from inertial.text.units import quantity
from stages.extension.estimates import Solved
from stages.extension.named_effects import NamedClass

Row = Mapping[str, Any]

MAX_COOLING = 1.0  # K below the warmest so far, in a campaign that warms up
MAX_SHARE = 0.9  # of the campaign: a bias that leaves the band later has not settled in it
OF_TIME, OF_TEMPERATURE = "warm_up", "temperature"  # ends of the names of effects
SETTLED = _("The bias of the {axis} {sensor} stays within {band} of its last value from {time} on.")
UNSETTLED = _("The bias of the {axis} {sensor} does not settle to {band} in this campaign.")


def warm_up_rows(
    solution: Solved, effects: Sequence[Effect], motion: Motion, band: float
) -> Iterator[Row]:
    """The rows of the three axes of a sensor; `band`: in SI, to either side."""
    of_temperature = any(effect.name.endswith(OF_TEMPERATURE) for effect in effects)
    if (motion.switched_on.any() and of_temperature) or not _warms(motion):
        return
    if not of_temperature and not any(effect.name.endswith(OF_TIME) for effect in effects):
        return
    time, order = np.unique(motion.time - motion.switched_on, return_index=True)
    columns, values, covariance = _biases(solution, effects, motion)
    if not len(values):
        return
    away = columns[order] - columns[order[-1]]  # (n, 3, p)
    unit = quantity("bias", UNITS[solution.sensor]).laboratory
    for i, axis in enumerate(AXES):
        if not away[:, i].any():  # no term of the model changes this bias: nothing is known of it
            continue
        change = away[:, i] @ values
        outside = np.flatnonzero(np.abs(change) > band)
        words = {"axis": axis, "sensor": SINGULAR[solution.sensor]}
        words |= {"band": f"{significant(band / unit.size, 2)} {unit.name}"}
        own = {"mount": solution.mount, "sensor": solution.sensor, "axis": axis, "band": band}
        own |= {"unit": UNITS[solution.sensor]}
        if not len(outside):
            words |= {"time": _("the first sample")}
            yield {**own, "seconds": 0.0, "sigma": None, "sentence": SETTLED.format_map(words)}
            continue
        last = int(outside[-1])
        slope = (change[last + 1] - change[last]) / (time[last + 1] - time[last])
        at = time[last] + (np.copysign(band, change[last]) - change[last]) / slope
        if at - time[0] > MAX_SHARE * (time[-1] - time[0]):
            nothing = {"seconds": None, "sigma": None}
            yield {**own, **nothing, "sentence": UNSETTLED.format_map(words)}
            continue
        variance = float(away[last, i] @ covariance @ away[last, i])
        sigma = float(np.sqrt(variance) / abs(slope))
        words |= {"time": f"{plus_minus(at, sigma)} s"}
        seconds = {"seconds": float(at), "sigma": sigma}
        yield {**own, **seconds, "sentence": SETTLED.format_map(words)}


def _warms(motion: Motion) -> bool:
    """Whether the temperature, where it is recorded, never falls by more than a little."""
    if not np.isfinite(motion.time).all():
        return False
    course = motion.temperature[np.argsort(motion.time, kind="stable")]
    course = course[np.isfinite(course)]
    return not len(course) or float(np.max(np.maximum.accumulate(course) - course)) <= MAX_COOLING


def _biases(
    solution: Solved, effects: Sequence[Effect], motion: Motion
) -> tuple[Array, Array, Array]:
    """What each estimated parameter adds to the biases, (n, 3, p), values, and covariance."""
    rows = {row["parameter"]: i for i, row in enumerate(solution.rows) if i >= UNKNOWNS}
    n = len(motion.time)
    none = np.zeros((n, 3))
    columns, places = [], []
    for effect in effects:
        if type(effect).moves is not Effect.moves:
            continue
        for number, parameter in enumerate(effect.parameters):
            place = rows.get(f"{effect.name}.{parameter.name}")
            if place is None or not solution.rows[place]["sigma"]:
                continue
            one = np.eye(len(effect.parameters))[number]
            read = effect.reads(Reading(none, none), Truth(none, none), motion, one)
            columns.append(getattr(read, solution.sensor))
            places.append(place)
    values = np.array([solution.rows[place]["value"] for place in places], np.float64)
    stacked = np.stack(columns, axis=2) if columns else np.zeros((n, 3, 0))
    return np.nan_to_num(stacked), values, solution.covariance[np.ix_(places, places)]


# ---- By what the biases of runs differ that restarts of the IMU part, beside other effects.
#
# Then the result is that of stated switch-ons: of the mean of the biases, about which those of the
# runs scatter by what they show themselves. Two runs do not show how well biases repeat: the mean
# holds for these two alone, and its sigma is half their difference.

MIN_RUNS = 3  # that show how well biases repeat: one difference has 6 times the interval of many


def with_spreads(campaign: Campaign, classes: Sequence[NamedClass]) -> tuple[NamedClass, ...]:
    """The classes, whose restarts have biases that scatter by as much as they do."""
    known = [each.members[0].effect for each in classes]
    known = [effect for effect in known if effect.scan is None or effect.at is not None]

    def sized(effect: Effect) -> Effect:
        if not isinstance(effect, Restarts) or (spread := _spread(campaign, effect, known)) is None:
            return effect
        return effect.with_spread(spread)

    return tuple(
        replace(
            each,
            members=tuple(member._replace(effect=sized(member.effect)) for member in each.members),
        )
        for each in classes
    )


def _spread(campaign: Campaign, restarts: Restarts, known: Sequence[Effect]) -> Array | None:
    """Sigma of the biases of runs about their mean, (3,), by restricted likelihood."""
    others = [effect for effect in known if effect.name != restarts.name]
    information = campaign.information(restarts.sensor, [restarts, *others])
    if information is None:
        return None
    whole = information.on_effects
    place = {name: i for i, name in enumerate(whole.names)}
    rest = whole.given([place[name] for effect in others for name in effect.columns])
    found = []
    for axis in range(3):
        own = [place[name] for name in restarts.columns[axis::3]]
        found.append(between(rest.information[np.ix_(own, own)], rest.right[own]))
    runs = SwitchOns(len(restarts.times) + 1, *np.array(found).T)
    return runs.covering if runs.count >= MIN_RUNS else np.nan_to_num(runs.value)
