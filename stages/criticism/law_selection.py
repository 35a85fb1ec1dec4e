"""Laws in place of what is unexplained, and the effects of the catalogue beside them."""

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from inertial.campaign.equations import Campaign
from inertial.effects import TEMPERATURE_MODELS
from inertial.effects.law import Law
from inertial.model_selection.cause import LAW, ONE_OF_CLASS, Cause
from inertial.physics.effect import Effect
from inertial.sensors import SENSORS
from stages.criticism.bias_drift import drift_name
from stages.criticism.effect_selection import select_with_scatter
from stages.criticism.law_search import FoundLaw, find_law
from stages.criticism.residual_structure import Tested, structure_tests
from stages.criticism.selection import Selection

OF_CLASS = ("members", "member_values", "weights", "captured", "p_value")  # fields of a cause


def with_laws(
    selection: Selection,
    tested: Tested,
    campaign: Campaign,
    effects: Sequence[Effect],
    level: float,
    structure_level: float,
    degrees: float,
) -> tuple[Selection, Tested]:
    """The selection with a law in each sensor that is unexplained and has one.

    A law counts where the residuals of the sensor have no structure beside it. `campaign`,
    `effects`, `level`: of the selection; `structure_level`: of the tests of structure.
    """
    for sensor in unexplained(selection, tested):
        found = find_law(selection, sensor, level)
        if found is None:
            continue
        before = [e for e in selection.effects if e.name in TEMPERATURE_MODELS or _is_law(e)]
        again = select_with_scatter(campaign, effects, level, degrees, [*before, found.law])
        checked = structure_tests(again.campaign, again.fitted, degrees, structure_level)
        if not checked.of(sensor):
            known = {c.effect: c for c in selection.named.causes if c.verdict == LAW}
            selection, tested = _named(again, found, known), checked
    return selection, tested


def unexplained(selection: Selection, tested: Tested) -> list[str]:
    """The sensors with a structure, a random walk, a drift without a law, or several effects.

    Several effects of the catalogue together may imitate one that is in none.
    """
    own = [selection.sensor(cause) for cause in selection.named.causes]
    drifts: Collection[str] = {cause.effect for cause in selection.named.causes}
    walks = zip(SENSORS, selection.random_walks, strict=True)
    return [
        sensor
        for sensor, walk in walks
        if walk or tested.of(sensor) or drift_name(sensor) in drifts or own.count(sensor) > 1
    ]


def _is_law(effect: Effect) -> bool:
    return isinstance(effect, Law)


def _named(selection: Selection, found: FoundLaw, known: dict[str, Cause]) -> Selection:
    """The selection in which the law is named with its class; `known`: laws of other sensors."""

    def named(cause: Cause) -> Cause:
        if cause.effect in known:
            old = known[cause.effect]
            again = {name: getattr(old, name) for name in OF_CLASS}
            return replace(cause, verdict=LAW, **again)
        if cause.effect != found.law.name:
            return cause
        share = 1 / (1 + float(np.exp(found.odds))) if found.walk else 0.0
        walk = (found.walk,) if found.walk else ()
        return replace(
            cause,
            verdict=ONE_OF_CLASS if found.walk else LAW,
            members=(*found.members, *walk),
            member_values=(0,) * (len(found.members) + len(walk)),
            weights=(*(w * (1 - share) for w in found.weights), *([share] if walk else [])),
            captured=(*found.captured, *([1.0] if walk else [])),
            p_value=found.p_value,
        )

    causes = tuple(named(cause) for cause in selection.named.causes)
    return replace(selection, named=replace(selection.named, causes=causes))
