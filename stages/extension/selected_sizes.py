"""Sizes of the named effects in the models, corrected for their having been selected.

Criticism named an effect by the equations of both sensors; by how much its size is on average too
large then, it tells by the statistic and its threshold. Here each sensor is fitted by itself, and
other members of a class in place of the named effect. What was too large of the named effect the
fit of another model took up as well: its parameters move by A δ, A = F⁻¹ F_n, F the information of
the sensor on its own effects and F_n that between these and the named ones. The twelve parameters
of the sensor move with the effects of the model, as the conditional mean of a Gaussian.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from operator import add

import numpy as np

from inertial.arrays import Array
from inertial.estimation.effect_information import EffectInformation, whitening
from inertial.estimation.least_squares import Estimate, System
from inertial.model_selection.size_after_selection import corrected, regressed
from stages.extension.models import SensorEvidence
from stages.extension.named_effects import NamedClass


@dataclass(frozen=True)
class SelectedSizes:
    """By how much the named effects change after selection.

    `evidence`: of each sensor on the effects of all candidates; `names`: of the columns of the
    named effects, (k,); `shift`: of their values, (k,); `change`: of their covariance, (k, k).
    """

    evidence: Mapping[str, SensorEvidence | None]
    names: tuple[str, ...]
    shift: Array
    change: Array

    def applied(self, sensor: str, system: System, estimate: Estimate) -> Estimate:
        """The estimate of the equations of a sensor with the effects of a model, corrected."""
        evidence = self.evidence[sensor]
        own = [i for i, (kind, _) in enumerate(system.names) if kind == "effect"]
        if evidence is None or not own or not self.shift.any():
            return estimate
        follows = self._follows(evidence.effects, [system.names[i][1] for i in own])
        covariance = estimate.covariance
        follows = regressed(covariance[:, own], covariance[np.ix_(own, own)]) @ follows
        values = estimate.values.copy()
        values[: len(follows)] += follows @ self.shift
        added = follows @ self.change @ follows.T
        return replace(estimate, values=values, covariance=covariance + added)

    def _follows(self, effects: EffectInformation, own: Sequence[str]) -> Array:
        """What a sensor's estimate of own columns moves by per unit of the named ones, (m, k)."""
        whole = _of(effects, tuple(dict.fromkeys((*own, *self.names)))).information
        column = {name: i for i, name in enumerate(dict.fromkeys((*own, *self.names)))}
        mine, named = [column[name] for name in own], [column[name] for name in self.names]
        basis = whitening(whole[np.ix_(mine, mine)])
        return np.asarray(basis @ (basis.T @ whole[np.ix_(mine, named)]))


def selected_sizes(
    evidence: Mapping[str, SensorEvidence | None], classes: Sequence[NamedClass]
) -> SelectedSizes:
    """The correction of the first members of the classes, fitted together to both sensors."""
    columns = [each.members[0].effect.columns for each in classes]
    names = tuple(name for own in columns for name in own)
    known = [_of(each.effects, names) for each in evidence.values() if each is not None]
    if not known:
        return SelectedSizes(evidence, names, np.zeros(len(names)), np.zeros((len(names),) * 2))
    values, covariance = reduce(add, known).estimate(range(len(names)))
    places = {name: i for i, name in enumerate(names)}
    effects = {
        tuple(places[name] for name in own): each.selected
        for own, each in zip(columns, classes, strict=True)
    }
    after, changed = corrected(values, covariance, effects)
    return SelectedSizes(
        evidence, names, np.nan_to_num(after - values), np.nan_to_num(changed - covariance)
    )


def _of(effects: EffectInformation, names: tuple[str, ...]) -> EffectInformation:
    """The information on some columns, none on those that a sensor does not show."""
    place = {name: i for i, name in enumerate(effects.names)}
    there = [(i, place[name]) for i, name in enumerate(names) if name in place]
    new, old = (list(each) for each in zip(*there, strict=True)) if there else ([], [])
    information, right = np.zeros((len(names), len(names))), np.zeros(len(names))
    information[np.ix_(new, new)] = effects.information[np.ix_(old, old)]
    right[new] = effects.right[old]
    return replace(effects, names=names, information=information, right=right)
