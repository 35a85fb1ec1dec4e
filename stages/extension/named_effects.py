"""The effects that criticism has named for one mount, and its unexplained findings."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from inertial.effects import CATALOGUE
from inertial.physics.effect import Effect

Row = dict[str, Any]

NAMED = ("found", "one_of_class")
UNKNOWN = "unknown_structure"
UNEXPLAINED = "unexplained"
WALK = "_random_walk"  # what the causes of a bias that walks end with


@dataclass(frozen=True)
class Named:
    """What criticism says of one mount.

    `in_blocks`: the effects that equations can hold, each with the value of what is scanned;
    `in_spectrum`: the parameters of the others by effect and name; `classes`: by the name of an
    effect those that do the same to the data; `alarms`: by sensor, gyro or accel, the causes of
    findings that say that the model with the effects is not the whole truth.
    """

    in_blocks: tuple[Effect, ...]
    in_spectrum: dict[str, dict[str, float]]
    classes: dict[str, tuple[str, ...]]
    alarms: dict[str, tuple[str, ...]]


def named_of(findings: Sequence[Row], effects: Sequence[Row], suffix: str) -> Named:
    """Read the findings of the mount whose methods end with `suffix`.

    Of a class the likeliest member stands for all: the others would do the same to the data. A
    bias that walks is in the covariance of the joint result, so it is no alarm.
    """
    own = [row for row in findings if _mount(row["id"].split("/")) == suffix]
    values: dict[str, dict[str, float]] = {}
    for row in effects:
        if _mount(row["id"].split("/")) == suffix and row["value"] is not None:
            values.setdefault(row["effect"], {})[row["parameter"]] = row["value"]
    causes = {row["cause"]: row for row in own if row["verdict"] in NAMED}
    found = {name: CATALOGUE[name] for name in causes if name in CATALOGUE}
    alarms: dict[str, tuple[str, ...]] = {}
    for row in own:
        if _alarms(row):
            alarms[row["sensor"]] = (*alarms.get(row["sensor"], ()), row["cause"])
    return Named(
        tuple(
            _fixed(effect, values.get(name, {}))
            for name, effect in found.items()
            if effect.sought_in == "blocks"
        ),
        {name: values.get(name, {}) for name, e in found.items() if e.sought_in == "spectrum"},
        {name: _members(row) for name, row in causes.items() if len(_members(row)) > 1},
        alarms,
    )


def _mount(parts: Sequence[str]) -> str:
    """What the identifier of a finding or of a parameter of an effect says of the mount."""
    at = [part.partition("@")[2] for part in parts if "@" in part]
    return f"@{at[0]}" if at else ""


def _members(row: Row) -> tuple[str, ...]:
    return tuple((row["members"] or "").split(", "))


def _alarms(row: Row) -> bool:
    if row["cause"].endswith(WALK):
        return False
    return bool(row["verdict"] == UNKNOWN or row["cause"] == UNEXPLAINED)


def _fixed(effect: Effect, values: dict[str, float]) -> Effect:
    """The effect with the value that was found of what is scanned."""
    at = values.get(effect.scan.name) if effect.scan else None
    return effect if at is None else effect.fixed(at)
