"""The named effects of one mount, and the findings that contradict the model with them."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from inertial.effects import CATALOGUE
from inertial.physics.effect import Effect

Row = Mapping[str, Any]

NAMED = ("found", "one_of_class")
UNKNOWN = "unknown_structure"
UNEXPLAINED = "unexplained"
RANDOM_WALKS = ("gyro_random_walk", "accel_random_walk")  # in the covariance of the joint result


class Alarm(NamedTuple):
    """A finding that no named effect explains, and its cause."""

    finding: str
    cause: str


@dataclass(frozen=True)
class Named:
    """The named effects of one mount.

    `in_blocks`: the effects that equations can hold, each with the value of the scanned variable;
    `in_spectrum`: the parameters of the others by effect and name; `classes`: by the name of an
    effect those that do the same to the data; `alarms`: by sensor, gyro or accel, the findings
    by which the model with the effects is not complete.
    """

    in_blocks: tuple[Effect, ...]
    in_spectrum: Mapping[str, Mapping[str, float]]
    classes: Mapping[str, Sequence[str]]
    alarms: Mapping[str, Sequence[Alarm]]


def named_of(
    findings: Iterable[Row], effects: Iterable[Row], members: Iterable[Row], mount: str
) -> Named:
    """The findings of a mount, with the parameters in `effects` and the `members` of classes.

    Of a class the likeliest member stands for all: the others would do the same to the data. Of
    several oscillations the first counts. A random walk of the biases is in the covariance of the
    joint result, so it is no alarm.
    """
    own = [row for row in findings if row["mount"] == mount]
    values: dict[str, dict[str, float]] = {}
    for row in effects:
        if row["finding"] and row["value"] is not None:
            values.setdefault(row["finding"], {})[row["parameter"]] = row["value"]
    classes: dict[str, list[str]] = {}
    for row in members:
        classes.setdefault(row["finding"], []).append(row["effect"])
    first: dict[str, str] = {}  # effect → finding
    alarms: dict[str, list[Alarm]] = {}
    for row in own:
        if row["verdict"] in NAMED and row["cause"] in CATALOGUE:
            first.setdefault(row["cause"], row["id"])
        if _alarms(row):
            alarms.setdefault(row["sensor"], []).append(Alarm(row["id"], row["cause"]))
    of = {name: values.get(finding, {}) for name, finding in first.items()}
    return Named(
        tuple(
            _fixed(CATALOGUE[name], values)
            for name, values in of.items()
            if CATALOGUE[name].sought_in == "blocks"
        ),
        {name: v for name, v in of.items() if CATALOGUE[name].sought_in == "spectrum"},
        {name: classes[f] for name, f in first.items() if len(classes.get(f, ())) > 1},
        alarms,
    )


def _alarms(row: Row) -> bool:
    if row["cause"] in RANDOM_WALKS:
        return False
    return bool(row["verdict"] == UNKNOWN or row["cause"] == UNEXPLAINED)


def _fixed(effect: Effect, values: Mapping[str, float]) -> Effect:
    """The effect with the estimate of its scanned variable."""
    at = values.get(effect.scan.name) if effect.scan else None
    return effect if at is None else effect.fixed(at)
