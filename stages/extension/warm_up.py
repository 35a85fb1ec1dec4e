"""How long each bias takes from the first sample until it stays within a band about its last value.

By the effects of the model: an exponential in time, functions of a temperature that rises. In a
chamber that also cools it is not defined, and without such an effect nothing warms up. Where the
instrument was switched on again, time counts from the last switch-on, and a temperature, whose
course may be another each time, tells nothing.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from inertial.arrays import Array
from inertial.estimation.triad import UNKNOWNS
from inertial.physics.effect import Effect, Reading, Truth
from inertial.physics.motion import Motion
from inertial.sensors import SINGULAR, UNITS
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.numbers import plus_minus, significant
from inertial.text.units import quantity
from stages.extension.estimates import Solved

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
