"""Which effects are fitted together: of every class the likeliest member, then each of the others.

The members of a class do the same to the data, but not to the 24 parameters. With several classes
one is varied at a time, the others at their likeliest, so that the number of fits stays small.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import prod

import numpy as np
from scipy.special import logsumexp

from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.estimation.effect_information import EffectInformation
from inertial.model_selection.effect_classes import log_evidence
from inertial.physics.effect import Effect
from stages.extension.named_effects import Member, NamedClass

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
    return replace(
        own,
        members=tuple(
            Member(
                family[int(np.argmax(each))] if scanned else member.effect,
                float(weight) if unknown else member.probability,
            )
            for member, family, each, scanned, weight in zip(
                own.members, families, odds, open_scan, weights, strict=True
            )
        ),
    )


def _family(campaign: Campaign, effect: Effect) -> list[Effect]:
    """The effect, once for every value of what is scanned."""
    if effect.sought_in != "blocks":
        return [effect]
    return [effect, *campaign.candidates([effect])[effect.name]] if effect.scan else [effect]


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
