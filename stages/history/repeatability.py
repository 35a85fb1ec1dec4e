"""How well the parameters of one IMU repeat over its calibrations, and what the next may be."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import date, timedelta
from math import hypot

import numpy as np
import pandas as pd

from inertial.arrays import Array, finite_or_none
from inertial.campaign.records import Row
from inertial.estimation.consistency import holm_rejections, normal_p_value
from inertial.estimation.history_of_values import (
    MIN_VALUES,
    Component,
    History,
    Jump,
    Prediction,
    components,
    drift,
    jump,
    predicted,
)
from inertial.sensors import PLURAL, unit_of
from inertial.tables import AXES, STATIC_PHASES, UNITS
from inertial.text import units
from inertial.text.messages import _
from inertial.text.numbers import plus_minus
from inertial.text.parameters import JOINT, PARTS, sign_of

YEAR = 365.25  # days
LEAST_OWN = 1e-3  # of a sigma: no less than rounding leaves where nearly all is a reference's
MEAN_SECONDS = 10.0  # s, of the means of which the bias stability is the scatter
MIN_MEANS = 6
LONGEST_AHEAD = 10.0  # years, within which a due date is sought
DATES_AHEAD = 40
LATEST = 60  # calibrations of which components, jumps and the next one are found: n³ of work
SEED = 20261123  # of histories without a jump: the same data give the same numbers
UNKNOWN = "unknown"
ONE_GROUP = _("all calibrations share one {name}, so nothing is known of it")
NAMES = {"day": _("day"), "mounting": _("mounting"), "switch_on": _("switch-on")}
TOO_FEW = _("a prediction needs {least} dated calibrations")
NO_TOLERANCE = _("no tolerance is stated, by may_change of the campaign or in config.yaml")
NOT_DUE = _("the interval stays within the tolerance for ten years")
ALREADY_DUE = _("the tolerance is smaller than what is known to vary by the last calibration")
ONE_DAY = _("all calibrations are of one day")


@dataclass(frozen=True)
class Observed:
    """One value of a parameter: of a calibration and mount, with its sigma.

    `shared`: by reference, what of the sigma is its error, which others may contain alike.
    """

    campaign: str
    date: str
    mounting: str
    switch_on: str
    value: float
    sigma: float
    shared: Mapping[str, float] = field(default_factory=dict)


Series = dict[tuple[str, str], list[Observed]]  # by sensor and parameter


def series_of(calibrations: Sequence[tuple[Row, Sequence[Row]]]) -> Series:
    """The values by sensor and parameter, in the order of their dates, unknown ones first.

    calibrations : facts of a calibration, and the rows of its result
    """
    series: Series = {}
    order = sorted(calibrations, key=lambda one: (one[0]["date"] != UNKNOWN, one[0]["date"]))
    for facts, rows in order:
        for row in rows:
            if row["sigma"] is None or not row["sigma"] > 0:
                continue
            # Where nothing is stated each campaign was mounted and switched on anew.
            own = f"{facts['campaign']} {row['mount']}"
            observed = Observed(
                facts["campaign"],
                facts["date"],
                _label(facts.get("mounting"), own),
                _label(facts.get("switch_on"), facts["campaign"]),
                float(row["value"]),
                float(row["sigma"]),
                row.get("shared", {}),
            )
            series.setdefault((row["sensor"], row["quantity"]), []).append(observed)
    return series


def _label(stated: object, otherwise: str) -> str:
    """A label of the archive, where what is not stated may be NaN."""
    return stated if isinstance(stated, str) else otherwise


def repeatability_rows(series: Series, blocks: pd.DataFrame) -> Iterator[Row]:
    """The rows of the table: components between calibrations, and stability within this one."""
    for (sensor, quantity), every in series.items():
        values = every[-LATEST:]
        key = _key(sensor, quantity, len(values))
        if len(values) < 2:
            continue
        y, own, shared = _arrays(values)
        within = float(np.sqrt(np.mean(own**2)))
        yield key | {"component": "within", "groups": len(values), "value": within}
        spread = float(np.std(y, ddof=1))
        sigma = spread / np.sqrt(2 * (len(y) - 1))
        yield key | {"component": "repeatability", "value": spread, "sigma": sigma}
        alike = {
            "day": [v.date if v.date != UNKNOWN else v.campaign for v in values],
            "mounting": [v.mounting for v in values],
            "switch_on": [v.switch_on for v in values],
        }
        found = components(y, own, alike, shared)
        for component in found.found:
            yield key | _component(component)
        for name in found.one:
            reason = ONE_GROUP.format(name=NAMES[name])
            yield key | {"component": name, "groups": 1, "reason": reason}
    yield from _stability(blocks)


def _key(sensor: str, quantity: str, count: int) -> Row:
    return {
        "sensor": sensor,
        "quantity": quantity,
        "unit": unit_of(sensor, quantity),
        "calibrations": count,
        "groups": count,
        **dict.fromkeys(("value", "sigma", "upper")),
        "reason": "",
    }


def _component(component: Component) -> Row:
    return {
        "component": " + ".join(component.names),
        "groups": component.groups,
        "value": component.value,
        "sigma": finite_or_none(component.sigma),
        "upper": finite_or_none(component.upper),
    }


def power_cycle_rows(fits: Sequence[Row]) -> Iterator[Row]:
    """What biases differ by between the switch-ons of this campaign; `fits`: of both sensors."""
    for fit in fits:
        for axis in AXES if fit["switch_ons"] > 1 and fit["method"] == JOINT else ():
            value, sigma, upper = (fit[f"switch_on_{axis}{of}"] for of in ("", "_sigma", "_upper"))
            if value is not None:
                yield (
                    _key(fit["sensor"], f"bias_{axis}", 1)
                    | {"component": "power_cycle", "groups": fit["switch_ons"]}
                    | {"value": value, "sigma": sigma, "upper": upper}
                )


def _stability(blocks: pd.DataFrame) -> Iterator[Row]:
    """The scatter of means over ten seconds in the longest rest of this campaign."""
    rests = blocks[blocks["phase"].isin(STATIC_PHASES) & blocks["seconds"].notna()]
    if rests.empty:
        return
    by_rest = [own for _name, own in rests.groupby(["manoeuvre", "phase"], sort=False)]
    own = max(by_rest, key=lambda rest: float(rest["seconds"].sum()))
    together = max(round(MEAN_SECONDS / float(own["seconds"].median())), 1)
    count = len(own) // together
    if count < MIN_MEANS:
        return
    weights = own["count"].to_numpy(np.float64)[: count * together].reshape(count, together)
    for sensor in UNITS:
        for axis in AXES:
            values = own[f"{sensor}_{axis}"].to_numpy(np.float64)[: count * together]
            means = np.average(values.reshape(count, together), axis=1, weights=weights)
            if np.isfinite(means).all():
                scatter = float(np.std(means, ddof=1))
                yield _key(sensor, f"bias_{axis}", 1) | {
                    "component": "stability",
                    "groups": count,
                    "value": scatter,
                    "sigma": scatter / np.sqrt(2 * (count - 1)),
                }


def _arrays(values: Sequence[Observed]) -> tuple[Array, Array, Array]:
    """n values, their own sigmas, and what the errors of r references add to these, (n, r)."""
    references = list(dict.fromkeys(name for v in values for name in v.shared))
    rows = [[v.shared.get(name, 0.0) for name in references] for v in values]
    shared = np.array(rows, np.float64).reshape(len(values), len(references))
    sigma = np.array([v.sigma for v in values])
    own = np.sqrt(np.maximum(sigma**2 - np.sum(shared**2, axis=1), (LEAST_OWN * sigma) ** 2))
    return np.array([v.value for v in values]), own, shared


# ---- Jumps, and what the next calibration may find.


def jumps_of(series: Series, level: float) -> dict[tuple[str, str], tuple[Jump, list[Observed]]]:
    """The jumps by sensor and parameter whose chance, of any in all of them, is below the level."""
    generator = np.random.default_rng(SEED)
    found = {}
    dated = {key: _dated(values) for key, values in series.items()}
    for key, values in dated.items():
        history = _history(values)
        jumped = jump(history, generator) if len(values) else None
        if jumped is not None and jumped.p_value * len(dated) < level:
            found[key] = (jumped, values)
    return found


def jump_rows(
    jumps: Mapping[tuple[str, str], tuple[Jump, list[Observed]]], tested: int
) -> Iterator[Row]:
    """The rows of the table of jumps."""
    for (sensor, quantity), (jumped, values) in jumps.items():
        before, after = values[jumped.before], values[jumped.before + 1]
        unit = _key(sensor, quantity, 0)["unit"]
        shown = units.quantity(quantity, unit).laboratory
        yield {
            "sensor": sensor,
            "quantity": quantity,
            "unit": unit,
            "after": before.date,
            "after_campaign": before.campaign,
            "until": after.date,
            "until_campaign": after.campaign,
            "size": jumped.size,
            "sigma": jumped.sigma,
            "p_value": min(jumped.p_value * tested, 1.0),
            "sentence": _(
                "{quantity} of the {sensor} jumped between {after} and {until}, by {size} {unit}.",
                quantity=sign_of(quantity),
                sensor=PLURAL[sensor],
                after=before.date,
                until=after.date,
                size=plus_minus(shown.of(jumped.size), shown.of(jumped.sigma)),
                unit=shown.name,
            ),
        }


def tolerances(settings: Mapping[str, float], stated: Sequence[Row]) -> dict[str, float]:
    """By how much parameters may change, by sensor_kind: as stated, otherwise by the settings.

    stated : rows of the table of allowed changes
    """
    return {**settings, **{f"{row['sensor']}_{row['kind']}": row["limit"] for row in stated}}


def forecast_rows(
    series: Series,
    jumps: Mapping[tuple[str, str], tuple[Jump, list[Observed]]],
    tolerance: Mapping[str, float],
) -> Iterator[Row]:
    """Drift, the interval of the next calibration, and when it leaves the tolerance."""
    for (sensor, quantity), every in series.items():
        values = _dated(every)
        key = {
            "sensor": sensor,
            "quantity": quantity,
            "unit": _key(sensor, quantity, 0)["unit"],
            "calibrations": len(values),
            "tolerance": tolerance.get(f"{sensor}_{PARTS[quantity].kind}"),
        }
        distinct = sorted({_day(v) for v in values})
        if len(values) < MIN_VALUES or len(distinct) < 2:
            few = len(values) < MIN_VALUES
            reason = TOO_FEW.format(least=MIN_VALUES) if few else ONE_DAY
            yield _NOTHING | key | {"reason": reason}
            continue
        found = jumps.get((sensor, quantity))
        history = _history(values, found[0] if found else None)
        gap = float(np.median(np.diff([day.toordinal() for day in distinct])))
        ahead = np.append(gap / YEAR, np.linspace(0, LONGEST_AHEAD, DATES_AHEAD + 1))
        last = float(history.times[-1])
        prediction = predicted(history, last + ahead, history.unit)
        steady = drift(history)
        yield (
            _NOTHING
            | key
            | {
                "from_date": distinct[0].isoformat(),
                "to_date": distinct[-1].isoformat(),
                "drift": steady.rate,
                "drift_sigma": steady.sigma,
                "at": (distinct[-1] + timedelta(days=round(gap))).isoformat(),
                "low": float(prediction.low[0]),
                "median": float(prediction.median[0]),
                "high": float(prediction.high[0]),
                **_due(key["tolerance"], values[-1], distinct[-1], prediction),
            }
        )


_NOTHING: Row = dict.fromkeys(
    ("from_date", "to_date", "drift", "drift_sigma", "at", "low", "median", "high", "due")
) | {"reason": ""}


def _due(tolerance: float | None, last: Observed, day: date, prediction: Prediction) -> Row:
    """When the interval of the next calibration leaves the tolerance about the last value."""
    if tolerance is None:
        return {"reason": NO_TOLERANCE}
    low, high = (limits[1:] for limits in (prediction.low, prediction.high))
    left = np.flatnonzero((low < last.value - tolerance) | (high > last.value + tolerance))
    if not len(left):
        return {"reason": NOT_DUE}
    if left[0] == 0:
        return {"due": day.isoformat(), "reason": ALREADY_DUE}
    # Whichever limit leaves first, on the straight line between two dates.
    over = np.maximum(last.value - low, high - last.value)[left[0] - 1 : left[0] + 1] - tolerance
    years = LONGEST_AHEAD / DATES_AHEAD * (left[0] - 1 + over[0] / (over[0] - over[1]))
    return {"due": (day + timedelta(days=int(years * YEAR))).isoformat()}


def _dated(values: Sequence[Observed]) -> list[Observed]:
    """The latest values with a date."""
    return [v for v in values if v.date != UNKNOWN][-LATEST:]


def _day(value: Observed) -> date:
    return date.fromisoformat(value.date)


def _history(values: Sequence[Observed], jumped: Jump | None = None) -> History:
    y, own, shared = _arrays(values)
    times = np.array([_day(v).toordinal() for v in values], np.float64) / YEAR
    step = None
    if jumped is not None:
        step = (np.arange(len(y)) > jumped.before).astype(np.float64)
    return History(y, own, times, step, shared)


# ---- What changed from one calibration of an IMU to the next, by more than chance.


@dataclass(frozen=True)
class Change:
    """A parameter in two calibrations: `size`, second less first, with its sigma.

    `p_value`: chance of one so large, either way, if the two are equal; `beyond`: more than chance,
    of all parameters of the two (Holm 1979).
    """

    sensor: str
    quantity: str
    size: float
    sigma: float
    p_value: float
    beyond: bool


def change(before: Observed, after: Observed) -> tuple[float, float]:
    """The difference of two values and its sigma: an error of a reference of both is in neither."""
    own = [one.sigma**2 - sum(size**2 for size in one.shared.values()) for one in (before, after)]
    names = {*before.shared, *after.shared}
    shared = [after.shared.get(name, 0.0) - before.shared.get(name, 0.0) for name in names]
    sigma = hypot(*(max(variance, 0.0) ** 0.5 for variance in own), *shared)
    return after.value - before.value, max(sigma, LEAST_OWN * hypot(before.sigma, after.sigma))


def changes(series: Series, first: str, second: str, level: float) -> list[Change]:
    """All parameters with one value in each of two campaigns: several mounts are not told apart."""
    compared = []
    for key, values in series.items():
        of = [[one for one in values if one.campaign == name] for name in (first, second)]
        if [len(own) for own in of] == [1, 1]:
            size, sigma = change(of[0][0], of[1][0])
            compared.append((*key, size, sigma, normal_p_value(size / sigma)))
    if not compared:
        return []
    beyond = holm_rejections([one[-1] for one in compared], level)
    return [Change(*one, bool(is_beyond)) for one, is_beyond in zip(compared, beyond, strict=True)]


def change_rows(changed: list[Change], before: Row) -> Iterator[Row]:
    """The rows of the table of changes since the calibration `before`, its facts."""
    for one in changed:
        since = {"since": before["date"], "since_campaign": before["campaign"]}
        yield {**asdict(one), "unit": unit_of(one.sensor, one.quantity), **since}
