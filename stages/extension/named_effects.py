"""The named effects of one mount, each with the other members of its class."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import prod
from typing import Any, NamedTuple

import numpy as np
from scipy.special import logsumexp

from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.effects import KNOWN, LAWS
from inertial.estimation.effect_information import EffectInformation
from inertial.model_selection.effect_classes import log_evidence
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


# ---- Which effects are fitted together: of every class the likeliest member, then each of the
# others.
#
# The members of a class do the same to the data, but not to the 24 parameters. With several classes
# one is varied at a time, the others at their likeliest, so that the number of fits stays small.

MIN_SHARE = 0.01  # of the probability of an effect of one position: less likely ones are left out
MAX_OTHERS = 7  # combinations besides that of the likeliest members


@dataclass(frozen=True)
class Combination:
    """One member of every class; `probability`: the product of theirs, not normalised."""

    members: tuple[Member, ...]
    findings: tuple[str, ...]

    @property
    def probability(self) -> float:
        """Of all members together, each class by itself."""
        return prod(member.probability or 0.0 for member in self.members)

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The effects, as they stand in the equations."""
        return tuple(member.effect for member in self.members)


def combinations_of(classes: Sequence[NamedClass]) -> list[Combination]:
    """The likeliest members, then the others, the most probable first.

    An effect stands in a combination once, though it may be a member of several classes.
    """
    findings = tuple(each.finding for each in classes)
    likeliest = tuple(each.members[0] for each in classes)
    others = [
        Combination((*likeliest[:i], member, *likeliest[i + 1 :]), findings)
        for i, each in enumerate(classes)
        for member in each.members[1:]
    ]
    others = [one for one in others if len({e.name for e in one.effects}) == len(classes)]
    ranked = sorted(others, key=lambda one: -one.probability)[:MAX_OTHERS]
    return [Combination(likeliest, findings), *ranked] if classes else []


def compared(campaign: Campaign, classes: Sequence[NamedClass]) -> list[NamedClass]:
    """The classes whose members all have a value of what is scanned, and a probability.

    A member whose scanned value is not known has that of the largest reduction of chi-squared,
    beside the likeliest of the other classes. Where criticism compared no probabilities, they
    follow from the reductions, every effect being equally probable beforehand, and so is every
    value of a scan. An effect of a single position is a member once for each position that may be
    it.
    """
    placed = [_placed(campaign, each) for each in classes]
    return [
        _compared(campaign, each, [other.members[0].effect for other in placed if other != each])
        for each in placed
    ]


def _placed(campaign: Campaign, own: NamedClass) -> NamedClass:
    """The class with its first member at each of its positions, as likely as chi-squared says."""
    first, *others = own.members
    probability = first.probability if others else 1.0
    if len(own.positions) < 2 or first.effect.at is None or probability is None:
        return own
    places = campaign.places(first.effect)
    at = [places.index(position) for position, _ in own.positions]
    likelihood = np.array([statistic / 2 for _, statistic in own.positions])
    shares = probability * np.exp(likelihood - logsumexp(likelihood))
    each = [
        Member(first.effect.fixed(float(place)), float(share))
        for place, share in zip(at, shares, strict=True)
    ]
    each.sort(key=lambda member: member.effect.at != first.effect.at)  # the named one stays first
    return replace(own, members=(*each, *others))


def _compared(campaign: Campaign, own: NamedClass, others: Sequence[Effect]) -> NamedClass:
    unknown = any(member.probability is None for member in own.members)
    open_scan = [m.effect.scan is not None and m.effect.at is None for m in own.members]
    if len(own.members) == 1:
        return replace(own, members=(own.members[0]._replace(probability=1.0),))
    if not unknown and not any(open_scan):
        return own
    families = [
        _family(campaign, member.effect) if unknown or scanned else (member.effect,)
        for member, scanned in zip(own.members, open_scan, strict=True)
    ]
    every = {e.label: e for family in (*families, others) for e in family}
    equations = evidence(campaign, list(every.values()))
    information = equations.total if equations.sensors else None  # such as of means alone
    odds = [[_odds(information, [e, *others], others) for e in family] for family in families]
    log_odds = np.array([logsumexp(each) - np.log(len(each)) for each in odds])
    if not np.isfinite(log_odds).any():  # no reading depends on any of them
        log_odds = np.zeros(len(odds))
    weights = np.exp(log_odds - logsumexp(log_odds))
    members: list[Member] = []
    for member, family, each, scanned, weight in zip(
        own.members, families, odds, open_scan, weights, strict=True
    ):
        probability = float(weight) if unknown else member.probability
        known = [member._replace(probability=probability)]
        members += _at_each(family, each, probability) if scanned else known
    return replace(own, members=tuple(members))


def _at_each(
    family: Sequence[Effect], odds: Sequence[float], probability: float | None
) -> list[Member]:
    """The member with the best value of its scan; of one position, with each that is likely."""
    best = family[int(np.argmax(odds))]
    several = best.scan is not None and not best.scan.between and np.isfinite(odds).any()
    if probability is None or not several:
        return [Member(best, probability)]
    shares = np.exp(np.array(odds) - logsumexp(odds))
    pairs = sorted(zip(shares, family, strict=True), key=lambda pair: -pair[0])
    likely = [(share, effect) for share, effect in pairs if share > MIN_SHARE]
    whole = sum(share for share, _effect in likely)
    return [Member(effect, float(probability * share / whole)) for share, effect in likely]


def _family(campaign: Campaign, effect: Effect) -> list[Effect]:
    """The effect, once for every value of what is scanned."""
    if effect.sought_in != "blocks" or effect.scan is None:
        return [effect]
    every = campaign.candidates([effect])[effect.name]
    return [*every] if every and effect.at is None else [effect, *every]


def _odds(
    information: EffectInformation | None, effects: Sequence[Effect], others: Sequence[Effect]
) -> float:
    """Logarithm of the odds for the first effect beside the others."""
    if information is None or effects[0].sought_in != "blocks":
        return -np.inf
    drop, degrees = information.drop(_columns(information, effects))
    known, used = information.drop(_columns(information, others)) if others else (0.0, 0)
    return float(log_evidence(np.array([drop - known]), np.array([degrees - used]))[0])


def _columns(information: EffectInformation, effects: Sequence[Effect]) -> list[int]:
    place = {name: i for i, name in enumerate(information.names)}
    return [place[name] for effect in effects for name in effect.columns]
