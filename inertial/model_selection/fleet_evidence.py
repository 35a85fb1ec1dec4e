"""What several campaigns say together of each effect, and of what has it in common.

Campaign j says of the effects, all else fitted, b_j ~ N(F_j β_j, F_j). Campaigns are of one type of
IMU, were made on one table, are of one IMU: these are levels, and each divides the campaigns into
groups. An effect may be the same in all campaigns of a group,

    b_g = Σ_j b_j,  F_g = Σ_j F_j       over the campaigns of group g,

or of a size of its own in each group of a level. What a hypothesis (an effect, and a group or a
whole level) explains beside others follows from these sums and those of the campaigns that two
groups share, so that every campaign is read once and costs the same.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Booleans, Integers
from inertial.estimation.effect_information import whitening
from inertial.estimation.fleet_components import LEVELS, Sharing
from inertial.model_selection.search import MIN_EIGENVALUE

EVERY = -1  # for the group of a hypothesis: each group of its level has a size of its own


@dataclass(frozen=True, order=True)
class Shared:
    """An effect, by number, that a group of a level shares; or of a size of its own in EVERY."""

    effect: int
    level: str
    group: int


@dataclass(frozen=True)
class Groups:
    """The sums of a level: `of`: (c,) the group of each campaign; F (g, k, k) and b (g, k)."""

    of: Integers
    labels: tuple[str, ...]
    information: Array
    right: Array


@dataclass(frozen=True)
class Given:
    """What the hypotheses in a model take from the groups of each level.

    `across`: (g, k, r) information of the columns of a group with r independent combinations of
    the model, each of unit information; `right`: (g, k) what remains of b.
    """

    across: Mapping[str, Array]
    right: Mapping[str, Array]


class FleetEvidence:
    """The evidence of c campaigns on effects of k columns in all.

    Parameters
    ----------
    effects : the columns of each effect, by its name
    information, right : F (c, k, k) and b (c, k), zero where a campaign does not show a column
    labels : of each level in LEVELS the label of each campaign; the last level has one for each
    """

    def __init__(
        self,
        effects: Mapping[str, Sequence[int]],
        information: Array,
        right: Array,
        labels: Mapping[str, Sequence[str]],
    ) -> None:
        self.names = tuple(effects)
        self.columns = [np.array(columns, np.int64) for columns in effects.values()]
        self.information, self.right = information, right
        self.levels = {level: self._summed(labels[level]) for level in LEVELS}

    def _summed(self, labels: Sequence[str]) -> Groups:
        place = {label: i for i, label in enumerate(dict.fromkeys(labels))}
        names, of = tuple(place), np.array([place[label] for label in labels], np.int64)
        information = np.zeros((len(names), *self.information.shape[1:]))
        right = np.zeros((len(names), self.right.shape[1]))
        np.add.at(information, of, self.information)
        np.add.at(right, of, self.right)
        return Groups(of, names, information, right)

    def groups_of(self, one: Shared) -> range:
        """The groups of a hypothesis."""
        every = range(len(self.levels[one.level].labels))
        return every if one.group == EVERY else range(one.group, one.group + 1)

    # ---- Joint models.

    def _joint(self, model: Sequence[Shared], across: Mapping[str, Array]) -> tuple[Array, Array]:
        """F (s, s) and b (s,) of all parameters of a model, group by group of each hypothesis."""
        parts = [(one, group) for one in model for group in self.groups_of(one)]
        information = [across[one.level][g][self.columns[one.effect]] for one, g in parts]
        right = [self.levels[one.level].right[g][self.columns[one.effect]] for one, g in parts]
        return np.vstack(information), np.concatenate(right)

    def _across(self, level: str, model: Sequence[Shared]) -> Array:
        """Information of the columns of each group with the parameters of a model, (g, k, s)."""
        groups = self.levels[level]
        parts = []
        for one in model:
            others, columns = self.levels[one.level], self.columns[one.effect]
            for group in self.groups_of(one):
                members = np.flatnonzero(others.of == group)
                part = np.zeros((len(groups.labels), self.right.shape[1], len(columns)))
                np.add.at(part, groups.of[members], self.information[members][:, :, columns])
                parts.append(part)
        return np.concatenate(parts, axis=2)

    def given(self, model: Sequence[Shared]) -> Given:
        """What a model leaves."""
        if not model:
            return Given(
                {
                    level: np.zeros((*groups.right.shape, 0))
                    for level, groups in self.levels.items()
                },
                {level: groups.right for level, groups in self.levels.items()},
            )
        across = {level: self._across(level, model) for level in LEVELS}
        information, right = self._joint(model, across)
        white = whitening(information, MIN_EIGENVALUE)
        along = white.T @ right
        projected = {level: part @ white for level, part in across.items()}
        return Given(
            projected,
            {level: self.levels[level].right - projected[level] @ along for level in LEVELS},
        )

    def estimate(self, model: Sequence[Shared]) -> tuple[Array, Array]:
        """Values (s,) and covariance (s, s) of all parameters of a model."""
        across = {level: self._across(level, model) for level in LEVELS}
        information, right = self._joint(model, across)
        white = whitening(information, MIN_EIGENVALUE)
        return white @ (white.T @ right), white @ white.T

    def sharing(self, model: Sequence[Shared], effect: int) -> Sharing:
        """What the campaigns say of an effect, the other effects of a model as they are fitted."""
        values, _ = self.estimate(model)
        sizes = np.zeros_like(self.right)
        first = 0
        for one in model:
            columns, of = self.columns[one.effect], self.levels[one.level].of
            for group in self.groups_of(one):
                if one.effect != effect:
                    members = np.flatnonzero(of == group)
                    sizes[np.ix_(members, columns)] += values[first : first + len(columns)]
                first += len(columns)
        own = self.columns[effect]
        right = self.right[:, own] - np.einsum("cpk,ck->cp", self.information[:, own], sizes)
        labels = {
            level: [groups.labels[i] for i in groups.of] for level, groups in self.levels.items()
        }
        return Sharing(self.information[:, own[:, None], own], right, labels)

    # ---- What each hypothesis explains beside a model.

    def drops(self, effect: int, level: str, given: Given) -> tuple[Array, Integers]:
        """Drop of chi-squared and its degrees by each group of a level, and by all of them last.

        Both (g + 1,): each group alone, then a size of its own in each.
        """
        columns, groups = self.columns[effect], self.levels[level]
        block = groups.information[:, columns[:, None], columns]
        across, right = given.across[level][:, columns], given.right[level][:, columns]
        scale = _scale(block)
        alone, degrees = _explained(block - across @ across.transpose(0, 2, 1), scale, right)
        if not across.shape[2]:
            return np.append(alone, alone.sum()), np.append(degrees, degrees.sum())
        white, seen = whitened(block)
        along, mixed = (white @ right[:, :, None])[:, :, 0], white @ across
        taken = np.einsum("gpr,gps->rs", mixed, mixed)
        left, directions = np.linalg.eigh(np.eye(len(taken)) - taken)
        projected = directions.T @ np.einsum("gpr,gp->r", mixed, along)
        free = left > MIN_EIGENVALUE
        extra = np.where(free, 1 / np.where(free, left, 1.0), -1.0) * projected**2
        together = max(float(np.sum(along**2) + extra.sum()), 0.0)
        return np.append(alone, together), np.append(degrees, seen.sum() - np.sum(~free))


def _scale(block: Array) -> Array:
    """Roots of the diagonals of matrices (g, p, p), (g, p)."""
    return np.sqrt(np.maximum(np.diagonal(block, axis1=1, axis2=2), np.finfo(float).tiny))


def whitened(block: Array) -> tuple[Array, Booleans]:
    """W of matrices (g, p, p) with W F Wᵀ = 1 where they are positive, (g, p); which that are."""
    scale = _scale(block)
    values, vectors = np.linalg.eigh(block / (scale[:, :, None] * scale[:, None, :]))
    seen = values > MIN_EIGENVALUE
    white = np.where(seen, 1 / np.sqrt(np.where(seen, values, 1.0)), 0.0)[:, None, :] * vectors
    return (white / scale[:, :, None]).transpose(0, 2, 1), seen


def _explained(block: Array, scale: Array, right: Array) -> tuple[Array, Integers]:
    """rᵀ D⁺ r of matrices (g, p, p), and their ranks."""
    values, vectors = np.linalg.eigh(block / (scale[:, :, None] * scale[:, None, :]))
    seen = values > MIN_EIGENVALUE
    along = np.einsum("gpq,gp->gq", vectors, right / scale)
    return np.sum(np.where(seen, along**2 / np.where(seen, values, 1.0), 0.0), axis=1), np.sum(
        seen, axis=1
    )
