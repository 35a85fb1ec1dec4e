"""What the campaigns of a fleet show together, as rows of its tables."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import atanh, hypot, sqrt

import numpy as np

from inertial.campaign.records import Row
from inertial.estimation.consistency import normal_p_value
from inertial.estimation.fleet_components import LEVELS, shares
from inertial.estimation.type_population import of_new_imu, type_population
from inertial.model_selection.common_scale import TABLE, Comparison, TableDifference, comparisons
from inertial.model_selection.fleet_evidence import EVERY, FleetEvidence, Shared
from inertial.model_selection.fleet_search import (
    FleetEffect,
    FleetLaw,
    FleetSearch,
    fleet_law,
    smallest_of,
)
from inertial.model_selection.outlying_changes import OutlyingChange, without_outlying
from inertial.sensors import SENSORS, unit_of
from inertial.tables.fleet import FLEET
from inertial.text.messages import listed
from overviews.fleet.members import (
    PARAMETERS,
    Member,
    Place,
    campaigns_of_type,
    evidence_of,
    of_references,
    scale_factors_of,
)

Rows = dict[str, list[Row]]
EQUAL = 0.9999  # a correlation of what is equal by a convention, as the axes of a case by hand
OF_FISHER_Z = 3  # degrees of freedom that a correlation takes


def results_of(
    members: Sequence[Member], *, false_discoveries: float, outliers: float
) -> tuple[Rows, int]:
    """The rows of all tables, and how many hypotheses were searched.

    Parameters
    ----------
    false_discoveries : accepted share of false ones among the findings
    outliers : accepted probability of calling any IMU of a type an outlier
    """
    rows: Rows = {name: [] for name in FLEET}
    rows["campaigns"] = [
        {
            "campaign": m.campaign,
            "mount": m.mount,
            "type": m.type,
            "imu": m.imu,
            "table": m.table,
            "pooled": not m.reason,
            "reason": m.reason,
        }
        for m in members
    ]
    pooled = [member for member in members if not member.reason]
    showing = [member for member in pooled if member.score]
    compared = between_tables(pooled, outliers)
    further, already = sum(search.hypotheses for search in compared), 0
    law = FleetLaw(false_discoveries, smallest_of(further, false_discoveries), further)
    if len(showing) > 1:
        evidence, places = evidence_of(showing)
        law = fleet_law(evidence, false_discoveries, further)
        found = FleetSearch(evidence, law).found()
        already = len(found)
        units = {place: unit for member in showing for place, unit in member.units.items()}
        for name, row in _effects(evidence, found, places, units):
            row |= _named_by(row, evidence, showing) if name == "findings" else {}
            rows[name].append(row)
    for name, row in difference_rows(compared, pooled, law, already):
        rows[name].append(row)
    for kind in dict.fromkeys(member.type for member in pooled):
        for name, row in _population([m for m in pooled if m.type == kind], outliers):
            rows[name].append(row)
    return rows, law.hypotheses


# ---- Effects.


def _effects(
    evidence: FleetEvidence,
    found: Sequence[FleetEffect],
    places: Mapping[str, Sequence[Place]],
    units: Mapping[Place, str],
) -> Iterator[tuple[str, Row]]:
    names = evidence.names
    model = as_likeliest(found)
    ids = [_id(evidence, one) for one in model]
    for identifier, one, own in zip(ids, found, model, strict=True):
        yield (
            "findings",
            {
                "finding": identifier,
                "effect": names[own.effect],
                "level": own.level,
                "group": _group(evidence, own),
                "statistic": one.statistic,
                "degrees": one.degrees,
                "p_value": one.p_value,
            },
        )
        for effect, weight in one.members.items():
            row = {"finding": identifier, "effect": names[effect], "probability": weight}
            yield "members", row
        for level, weight in one.sharings.items():
            row = {"finding": identifier, "level": level, "probability": weight}
            yield "sharings", row | {"possible": level in one.levels}
    for effect in dict.fromkeys(one.effect for one in model):
        for levels, (share, sigma) in shares(evidence.sharing(model, effect)).items():
            row = {"effect": names[effect], "levels": " + ".join(levels)}
            yield "shares", row | {"share": share, "sigma": sigma}
    if model:
        yield from _sizes(evidence, ids, model, places, units)


def _named_by(row: Row, evidence: FleetEvidence, members: Sequence[Member]) -> Row:
    own = evidence.levels[row["level"]]
    asked = [
        member
        for member, group in zip(members, own.of, strict=True)
        if row["group"] in (None, own.labels[group])
        and any(effect == row["effect"] for effect, _ in member.score)
    ]
    return {"named_by": sum(row["effect"] in m.named for m in asked), "asked": len(asked)}


def as_likeliest(found: Sequence[FleetEffect]) -> list[Shared]:
    """Each finding as its likeliest member, which need not be the one that it was found by.

    Where another finding is that already it stays as it was found.
    """
    model = [one.hypothesis for one in found]
    for i, one in enumerate(found):
        likeliest = replace(model[i], effect=max(one.members, key=lambda name: one.members[name]))
        if likeliest not in model:
            model[i] = likeliest
    return model


def _sizes(
    evidence: FleetEvidence,
    ids: Sequence[str],
    model: Sequence[Shared],
    places: Mapping[str, Sequence[Place]],
    units: Mapping[Place, str],
) -> Iterator[tuple[str, Row]]:
    values, covariance = evidence.estimate(model)
    numbers = zip(values.tolist(), np.sqrt(np.diag(covariance)).tolist(), strict=True)
    for identifier, one in zip(ids, model, strict=True):
        for group in evidence.groups_of(one):
            for place in places[evidence.names[one.effect]]:
                value, sigma = next(numbers)
                if sigma:
                    row = {"finding": identifier, "parameter": place[1], "unit": units[place]}
                    row |= {"group": evidence.levels[one.level].labels[group]}
                    yield "sizes", row | {"value": value, "sigma": sigma}


def _group(evidence: FleetEvidence, one: Shared) -> str | None:
    return None if one.group == EVERY else evidence.levels[one.level].labels[one.group]


def _id(evidence: FleetEvidence, one: Shared) -> str:
    return "/".join((evidence.names[one.effect], one.level, _group(evidence, one) or "each"))


# ---- The population of a type.


def _population(members: Sequence[Member], level: float) -> Iterator[tuple[str, Row]]:
    kind = members[0].type
    found = type_population(campaigns_of_type(members), level)
    left_out = {one.imu for one in found.outliers}
    for odd in found.outliers:
        row = _place(kind, PARAMETERS[odd.parameter])
        yield "outliers", row | {"imu": odd.imu, "size": odd.size, "p_value": odd.p_value}
    kept = [member for member in members if member.imu not in left_out]
    for place, one, common, values in zip(
        PARAMETERS,
        found.parameters,
        of_references(kept),
        np.array([m.values for m in kept]).T,
        strict=True,
    ):
        if one is None:
            continue
        of = one.with_known(common)
        unit = unit_of(*place)
        imus = {m.imu for m, value in zip(kept, values, strict=True) if np.isfinite(value)}
        row = _place(kind, place) | {"imus": len(imus), "unit": unit}
        row |= {"mean": of.mean, "mean_sigma": of.mean_sigma}
        sigma, degrees = of_new_imu(of) or (None, np.inf)
        row |= {"mean_degrees": _finite(of.mean_degrees)}
        row |= {"prior_sigma": sigma, "prior_degrees": _finite(degrees)}
        yield "population", row
        for spread in of.spreads:
            row = _place(kind, place) | {"levels": _levels(spread.levels), "unit": unit}
            row |= {"groups": spread.groups, "value": spread.value}
            yield "spreads", row | {"sigma": None if np.isnan(spread.sigma) else spread.sigma}
    for i, j in zip(*np.triu_indices(len(PARAMETERS), 1), strict=True):
        r = float(found.correlation[i, j])
        if np.isfinite(r) and abs(r) < EQUAL and found.imus > OF_FISHER_Z:
            row = {"instrument": kind, "first": " ".join(PARAMETERS[i])}
            row |= {"second": " ".join(PARAMETERS[j]), "correlation": r}
            row |= {"sigma": (1 - r**2) / sqrt(found.imus - 1)}
            yield (
                "correlations",
                row | {"p_value": normal_p_value(atanh(r) * sqrt(found.imus - OF_FISHER_Z))},
            )


def _finite(degrees: float) -> float | None:
    return degrees if np.isfinite(degrees) else None


def _levels(levels: Sequence[str]) -> str:
    return " + ".join(level for level in LEVELS if level in levels)


def _place(kind: str, place: Place) -> Row:
    return {"instrument": kind, "sensor": place[0], "parameter": place[1]}


# ---- What tables do to all gyros, or all accelerometers, alike.

# What is a scale factor of all gyros alike, by how their turns were recorded.
OF_TURNS = {"steady": "table_speed_error", "whole": "table_angle_scale"}
REFERENCE = {"table_speed_error": "rate", "table_angle_scale": "angle", "gravity_error": "gravity"}
OF_ACCELEROMETERS = ("gravity_error", "clock_scale")


@dataclass(frozen=True)
class BetweenTables:
    """The search in one sensor; `effects`: of the catalogue, that scale all its axes alike.

    `outlying`: scale factors that changed by more than the others, in no comparison.
    """

    sensor: str
    effects: tuple[str, ...]
    comparison: Comparison
    outlying: Sequence[OutlyingChange]

    @property
    def hypotheses(self) -> int:
        """How many are searched."""
        return len(self.comparison.hypotheses)


def between_tables(members: Sequence[Member], level: float) -> list[BetweenTables]:
    """The tables that can be compared, for IMUs were on several of them.

    `level`: accepted probability of calling any change of a sensor an outlier.
    """
    found = []
    for sensor in SENSORS:
        for every in comparisons(scale_factors_of(members, sensor)):
            kept, outlying = without_outlying(every, level)
            effects = _scaled_alike(sensor, members, kept)
            found.append(BetweenTables(sensor, effects, kept, outlying))
    return found


def _scaled_alike(
    sensor: str, members: Sequence[Member], comparison: Comparison
) -> tuple[str, ...]:
    if sensor == "accel":
        return OF_ACCELEROMETERS
    turns = {how for m in members if m.table in comparison.tables for how in m.references.turns}
    return tuple(effect for how, effect in OF_TURNS.items() if how in turns)


def difference_rows(
    searches: Sequence[BetweenTables], members: Sequence[Member], law: FleetLaw, already: int
) -> Iterator[tuple[str, Row]]:
    """Rows of the tables by name; `already`: how many effects are found by other searches."""
    for search in searches:
        yield from _outlying_rows(search)
        if not search.effects:
            continue
        found, others = search.comparison.searched(law.share, already)
        for one in others:
            yield "tables_alike", _alike(search, one, law)
        for one in found:
            already += 1
            identifier = "/".join((search.effects[0], TABLE, *one.more, "-", *one.less))
            yield "findings", _finding(identifier, search, one, law)
            for effect in search.effects:
                row: Row = {"finding": identifier, "effect": effect}
                yield "members", row | {"probability": 1 / len(search.effects)}
            for level, probability in one.sharings.items():
                row = {"finding": identifier, "level": level, "probability": probability}
                yield "sharings", row | {"possible": level in one.possible}
            row = {
                "finding": identifier,
                **_between(search, one),
                "stated": _stated(search, one, members),
                "imus": one.imus,
                "axes": one.axes,
            }
            yield "table_differences", row


def _between(search: BetweenTables, one: TableDifference) -> Row:
    return {
        "sensor": search.sensor,
        "more": listed(one.more),
        "less": listed(one.less),
        "value": one.value,
        "sigma": one.sigma,
    }


def _alike(search: BetweenTables, one: TableDifference, law: FleetLaw) -> Row:
    return {
        **_between(search, one),
        "p_value": law.of_any(one.chance),
        "as_well": one.chance <= law.share and not one.of_tables,
        "change": sqrt(search.comparison.turn_on),
    }


def _outlying_rows(search: BetweenTables) -> Iterator[tuple[str, Row]]:
    for one in search.outlying:
        yield (
            "outlying_changes",
            {
                "sensor": search.sensor,
                "imu": one.imu,
                "axis": "xyz"[one.axis],
                "campaign": one.campaign,
                "others": listed(one.others),
                "value": one.size,
                "sigma": one.sigma,
                "p_value": one.p_value,
            },
        )


def _finding(identifier: str, search: BetweenTables, one: TableDifference, law: FleetLaw) -> Row:
    return {
        "finding": identifier,
        "effect": search.effects[0],
        "level": TABLE,
        "group": None,
        "statistic": None,
        "degrees": None,
        "p_value": law.of_any(one.chance),
        "named_by": None,
        "asked": None,
    }


def _stated(search: BetweenTables, one: TableDifference, members: Sequence[Member]) -> float | None:
    """Sigma of the difference by what is stated of both sides, the error of each table being one.

    The largest of several statements; None where one side states nothing.
    """
    key = REFERENCE[search.effects[0]]
    sides = [
        [
            m.references.sigmas[key]
            for m in members
            if m.table in side and key in m.references.sigmas
        ]
        for side in (one.more, one.less)
    ]
    return hypot(*map(max, sides)) if all(sides) else None
