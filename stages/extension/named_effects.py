"""The named effects of one mount, each with the other members of its class."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from inertial.effects import KNOWN, LAWS
from inertial.model_selection.size_after_selection import NOT_SELECTED, Selected, selected
from inertial.physics.effect import Effect, in_sequence

Row = Mapping[str, Any]

NAMED = ("found", "one_of_class", "law")


class Member(NamedTuple):
    """An effect that may be what was found; `probability`: posterior, None: not compared."""

    effect: Effect
    probability: float | None


@dataclass(frozen=True)
class NamedClass:
    """A finding and the effects that it may be, the named one first.

    That one has the value of its scanned variable, the others have none yet. `positions`: at which
    an effect of a single position may be, and the reduction of chi-squared there; `selected`: how
    having been named by its size changes the estimate of the named one.
    """

    finding: str
    members: tuple[Member, ...]
    positions: tuple[tuple[str, float], ...] = ()
    selected: Selected = NOT_SELECTED


@dataclass(frozen=True)
class NamedEffects:
    """The named effects of one mount.

    `classes`: of the effects that equations can hold; `in_spectrum`: the parameters of the others
    by effect and name.
    """

    classes: tuple[NamedClass, ...]
    in_spectrum: Mapping[str, Mapping[str, float]]


def named_of(
    findings: Iterable[Row],
    effects: Iterable[Row],
    members: Iterable[Row],
    positions: Iterable[Row],
    mount: str,
) -> NamedEffects:
    """The findings of a mount, with the parameters in `effects` and the `members` of classes.

    `positions`: at which a finding about a single position may be.
    Of several oscillations the first counts.
    """
    values: dict[str, dict[str, float]] = {}
    for row in effects:
        if row["finding"] and row["value"] is not None:
            values.setdefault(row["finding"], {})[row["parameter"]] = row["value"]
    of_class: dict[str, list[Row]] = {}
    for row in sorted(members, key=lambda row: int(row["rank"])):
        of_class.setdefault(row["finding"], []).append(row)
    places: dict[str, list[tuple[str, float]]] = {}
    for row in sorted(positions, key=lambda row: int(row["rank"])):
        places.setdefault(row["finding"], []).append((row["position"], row["statistic"]))
    first: dict[str, str] = {}  # effect → finding
    by_size: dict[str, Selected] = {}
    for row in findings:
        if row["mount"] == mount and row["verdict"] in NAMED and row["cause"] in KNOWN:
            first.setdefault(row["cause"], row["id"])
            if row["threshold"] is not None:
                by_size[row["id"]] = selected(row["statistic"], row["degrees"], row["threshold"])
    in_blocks = {
        name: finding for name, finding in first.items() if KNOWN[name].sought_in == "blocks"
    }
    named = in_sequence(
        [KNOWN[name].as_named(values.get(of, {})) for name, of in in_blocks.items()]
    )
    return NamedEffects(
        tuple(
            replace(
                _class_of(effect, finding, of_class.get(finding, ())),
                positions=tuple(places.get(finding, ())),
                selected=by_size.get(finding, NOT_SELECTED),
            )
            for effect, finding in zip(named, in_blocks.values(), strict=True)
        ),
        {
            name: values.get(finding, {})
            for name, finding in first.items()
            if KNOWN[name].sought_in == "spectrum"
        },
    )


def _class_of(named: Effect, finding: str, rows: Sequence[Row]) -> NamedClass:
    probability = {row["effect"]: row["probability"] for row in rows}
    others = [
        Member(KNOWN[effect], probability[effect])
        for effect in probability
        if effect in KNOWN
        and effect != named.name
        and KNOWN[effect].sought_in == "blocks"
        # Of another law no shape is known.
        and effect not in LAWS
    ]
    return NamedClass(finding, (Member(named, probability.get(named.name)), *others))
