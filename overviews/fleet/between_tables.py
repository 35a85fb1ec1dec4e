"""What tables do to all gyros, or all accelerometers, alike, as rows of the fleet's tables."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import hypot

from inertial.campaign.records import Row
from inertial.model_selection.common_scale import (
    TABLE,
    Comparison,
    TableDifference,
    comparisons,
)
from inertial.model_selection.fleet_search import FleetLaw
from inertial.sensors import SENSORS
from inertial.text.messages import listed
from overviews.fleet.members import Member, scale_factors_of

# What is a scale factor of all gyros alike, by how their turns were recorded.
OF_TURNS = {"steady": "table_speed_error", "whole": "table_angle_scale"}
REFERENCE = {"table_speed_error": "rate", "table_angle_scale": "angle", "gravity_error": "gravity"}
OF_ACCELEROMETERS = ("gravity_error", "clock_scale")


@dataclass(frozen=True)
class BetweenTables:
    """The search in one sensor; `effects`: of the catalogue, that scale all its axes alike."""

    sensor: str
    effects: tuple[str, ...]
    comparison: Comparison

    @property
    def hypotheses(self) -> int:
        """How many are searched."""
        return len(self.comparison.hypotheses)


def between_tables(members: Sequence[Member]) -> list[BetweenTables]:
    """The tables that can be compared, for IMUs were on several of them."""
    return [
        BetweenTables(sensor, _effects(sensor, members, comparison), comparison)
        for sensor in SENSORS
        for comparison in comparisons(scale_factors_of(members, sensor))
    ]


def _effects(sensor: str, members: Sequence[Member], comparison: Comparison) -> tuple[str, ...]:
    if sensor == "accel":
        return OF_ACCELEROMETERS
    turns = {how for m in members if m.table in comparison.tables for how in m.references.turns}
    return tuple(effect for how, effect in OF_TURNS.items() if how in turns)


def difference_rows(
    searches: Sequence[BetweenTables], members: Sequence[Member], law: FleetLaw, already: int
) -> Iterator[tuple[str, Row]]:
    """Rows of the tables by name; `already`: how many effects are found by other searches."""
    for search in searches:
        if not search.effects:
            continue
        for one in search.comparison.found(law.share, already):
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
                "sensor": search.sensor,
                "more": listed(one.more),
                "less": listed(one.less),
                "value": one.value,
                "sigma": one.sigma,
                "stated": _stated(search, one, members),
                "imus": one.imus,
                "axes": one.axes,
            }
            yield "table_differences", row


def _finding(identifier: str, search: BetweenTables, one: TableDifference, law: FleetLaw) -> Row:
    return {
        "finding": identifier,
        "effect": search.effects[0],
        "level": TABLE,
        "group": None,
        "statistic": (one.value / one.sigma) ** 2,
        "degrees": 1,
        "p_value": law.of_any(one.chance),
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
