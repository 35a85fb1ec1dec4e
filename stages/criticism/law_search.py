"""The law of what no effect of the catalogue explains in one sensor.

Weighed are: a law, with all, one or none of the effects that were named in this sensor beside it;
these effects alone; a random walk of the biases, with these effects and without. All by evidence in
the same equations, without a random walk in their covariance. Every effect of the catalogue is as
likely beforehand, and so is every law.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.campaign.equations import Campaign
from inertial.effects import LAWS
from inertial.effects.law import ALL, TELEGRAPH, Law, law_name
from inertial.model_selection import walk_odds
from inertial.model_selection.evidence import SearchedEffect, searched_effect
from inertial.model_selection.law_evidence import (
    LawOdds,
    best_paths,
    chance_of,
    law_class,
    law_odds,
    log_paths,
)
from inertial.model_selection.walk_odds import Equations
from inertial.physics import laws
from inertial.physics.effect import Effect
from inertial.sensors import SENSORS
from inertial.text.parameters import AXES
from stages.criticism.bias_drift import WALK_WAVES, half_waves
from stages.criticism.residual_structure import MIN_INFORMATION, Functions
from stages.criticism.rivals import MAX_LOG_ODDS
from stages.criticism.selection import Selection, walk_name

OF_LEVELS = (TELEGRAPH, "time")
MIN_OF_PATH = 0.98  # of what the most probable path explains, with fewer changes
FINER = (-0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75)  # of the step of a grid
UNMOVED = FINER.index(0.0)
ROUNDS = 3
Shape = tuple[float, ...]


@dataclass(frozen=True)
class FoundLaw:
    """A law of one sensor.

    `members`: the laws that may replace it, the most probable first, with their shares and what
    they capture of it; `p_value`: probability that noise alone reaches such odds; `odds`:
    logarithm, against everything else; `walk`: the random walk that is as likely, or none.
    """

    law: Law
    members: tuple[str, ...]
    weights: tuple[float, ...]
    captured: tuple[float, ...]
    p_value: float
    odds: float
    walk: str = ""


@dataclass(frozen=True)
class Columns:
    """The equations of a sensor on all laws.

    `laws`, `shapes`: the columns and the shapes of the candidates of each; `steps`: the columns of
    a step at each of `times`, h, in each axis; `waves`: of the half waves of each axis.
    """

    equations: Equations
    place: dict[str, int]
    laws: tuple[SearchedEffect, ...]
    shapes: tuple[Sequence[Shape], ...]
    steps: tuple[Sequence[int], ...]
    times: Array
    waves: tuple[Sequence[int], ...]

    def given(self, effects: Sequence[Effect]) -> Equations:
        """The equations given some effects."""
        own = [self.place[name] for effect in effects for name in effect.columns]
        return self.equations.given(own)


def find_law(selection: Selection, sensor: str, level: float) -> FoundLaw | None:
    """The law of a sensor; None where something else is likelier, or noise."""
    campaign = selection.campaign.without_random_walks()
    if campaign.handled or not np.isfinite(campaign.motion.time).all():
        return None
    if sensor not in selection.evidence.labels:
        return None
    own = [c.effect for c in selection.named.causes if selection.sensor(c) == sensor]
    named = [effect for effect in selection.effects if effect.name in own]
    others = [effect for effect in selection.fitted if effect not in named]
    columns = columns_with(campaign, sensor, others, named)
    prior = {e.name: _prior(e, campaign, len(selection.searched)) for e in named}

    def weighed(beside: Sequence[Effect]) -> Weighed:
        jumped = any(effect.name == f"{sensor}_bias_jump" for effect in beside)
        found = searched(columns, columns.given(beside), 1 if jumped else 2)
        law, gain = refined(campaign, found.most_probable, [*others, *beside])
        score = _catalogue(columns, beside, prior) + found.odds.total + gain
        return Weighed(score, found, law)

    # One after the other, for each has equations of some thousand columns.
    best = max(map(weighed, _subsets(named)), key=lambda one: one.score)
    score, found = best.score, best.found
    alone = _catalogue(columns, named, prior)
    walk = max(_walk_beside(columns, []), alone + _walk_beside(columns, named))
    # Where the effects are all there is, odds of 1/level occur in that share of campaigns at most.
    if score - alone < -np.log(level) or score < walk:  # a walk that is likelier is named itself
        return None
    p_value = chance_of(found.equations, found.odds, found.paths)
    if p_value > level:
        return None
    group = law_class(found.equations, found.odds)
    return FoundLaw(
        best.law,
        tuple(found.laws[i].name for i in group.members),
        group.weights,
        group.captured,
        p_value,
        score - max(walk, alone),
        walk_name(SENSORS.index(sensor)) if score - walk < MAX_LOG_ODDS else "",
    )


def _shaped(law: Law, shape: Shape) -> Law:
    return Law(law.sensor, law.axis, law.family, law.state, shape)


# ---- The equations on all laws.


def columns_with(
    campaign: Campaign, sensor: str, others: Sequence[Effect], named: Sequence[Effect]
) -> Columns:
    """The equations given the `others`; on named effects, half waves, and laws."""
    motion, part = campaign.motion, campaign.stretches(sensor)
    times, waves = laws.steps(motion, laws.STEPS), list(half_waves(sensor, WALK_WAVES))
    before = [*others, *named, *waves]
    first = sum(len(effect.parameters) for effect in before)
    found: list[Functions] = []
    steps: list[Sequence[int]] = []
    places: dict[tuple[str, str], dict[str, list[list[int]]]] = {}  # by axis, of each shape
    shapes: dict[tuple[str, str], Sequence[Shape]] = {}
    for i, axis in enumerate(AXES):
        values: list[Array] = []
        for law in laws.LAWS:
            if law == OF_LEVELS or not laws.known(law[1], motion, i):
                continue
            shapes[law] = laws.grid(*law, motion)
            if not shapes[law]:
                continue
            own = places.setdefault(law, {}).setdefault(axis, [])
            for shape in shapes[law]:
                values.append(laws.functions(*law, shape, motion, i))
                own.append(list(range(first, first + values[-1].shape[1])))
                first += values[-1].shape[1]
        values += [laws.after(motion, float(time))[:, None] for time in times]
        steps.append(range(first, first + len(times)))
        first += len(times)
        found.append(_functions(sensor, i, values, part))
    equations, place = _equations(campaign, sensor, [*before, *found])
    made: list[SearchedEffect] = []
    of_each: list[Sequence[Shape]] = []
    for law, axes in places.items():
        joint = [[i for one in every for i in one] for every in zip(*axes.values(), strict=True)]
        together = {ALL: joint} if len(axes) == len(AXES) else {}
        for axis, candidates in (together if law[1] in laws.OWN else axes | together).items():
            made.append(searched_effect(law_name(sensor, axis, *law), *candidates))
            of_each.append(shapes[law])
    known = [place[name] for effect in others for name in effect.columns]
    return Columns(
        equations.given(known),
        place,
        tuple(made),
        tuple(of_each),
        tuple(steps),
        times,
        tuple([place[f"{wave.label}.c_{axis}"] for wave in waves] for axis in AXES),
    )


def _functions(sensor: str, axis: int, values: Sequence[Array], part: slice) -> Functions:
    """The functions, of the stretches of the sensor."""
    every = np.hstack(values)
    whole = np.zeros_like(every)
    whole[part] = every[part]
    return Functions(sensor, axis, f"law_{AXES[axis]}", whole)


def _equations(
    campaign: Campaign, sensor: str, effects: Sequence[Effect]
) -> tuple[Equations, dict[str, int]]:
    """The normal equations of a sensor on effects, zero of what is fitted already."""
    found = campaign.information(sensor, effects)
    assert found is not None  # the sensor has equations
    reduced, raw, _ = found
    kept = np.diag(reduced.information) > MIN_INFORMATION * raw
    equations = Equations(reduced.information * np.outer(kept, kept), reduced.right * kept)
    return equations, {name: i for i, name in enumerate(reduced.names)}


# ---- The search, given some effects.


@dataclass(frozen=True)
class Searched:
    """The odds of all laws, with the best paths of telegraphs as further columns; see `Columns`."""

    equations: Equations
    laws: tuple[SearchedEffect, ...]
    shapes: tuple[Sequence[Shape], ...]
    paths: Array
    odds: LawOdds

    @property
    def most_probable(self) -> Law:
        """The most probable law in its best shape of the grid."""
        first = int(np.argmax(self.odds.of_each))
        shape = self.shapes[first][int(self.odds.candidates.value[self.odds.best[first]])]
        return _shaped(LAWS[self.laws[first].name], shape)


@dataclass(frozen=True)
class Weighed:
    """A law beside some of the named effects.

    `score`: the log evidence of these and of any law; `law`: the most probable. By the shapes of a
    grid alone effects of the catalogue that make up for its steps would be likelier.
    """

    score: float
    found: Searched
    law: Law


def searched(columns: Columns, equations: Equations, fewest: int) -> Searched:
    """The odds of all laws in these equations.

    Two levels in all axes have the path of one of them; `fewest`: the changes of a path at least.
    """
    sensor, size = columns.laws[0].name.partition("_")[0], len(equations.right)
    count = len(columns.times)
    paths = {
        axis: _path(equations, steps, fewest)
        for axis, steps in zip(AXES, columns.steps, strict=True)
    }
    made, shapes = list(columns.laws), list(columns.shapes)
    ways = [0.0] * len(made)
    added = np.zeros((len(AXES) ** 2, size))
    for number, (axis, path) in enumerate(paths.items()):
        first = len(AXES) * number
        for row, steps in enumerate(columns.steps, first):
            added[row, [steps[i] for i in path]] = (-1.0) ** np.arange(len(path))
        own, every = [size + first + number], range(size + first, size + first + len(AXES))
        for name, places in ((axis, own), (ALL, every)):
            made.append(searched_effect(law_name(sensor, name, *OF_LEVELS), places))
            shapes.append([tuple(float(columns.times[i]) for i in path)])
            ways.append(log_paths(count, len(path)))
    across = added @ equations.information
    equations = Equations(
        np.block([[equations.information, across.T], [across, across @ added.T]]),
        np.append(equations.right, added @ equations.right),
    )
    odds = law_odds(equations, made, np.array(ways))
    return Searched(equations, tuple(made), tuple(shapes), np.array(ways), odds)


def _path(equations: Equations, steps: Sequence[int], fewest: int) -> tuple[int, ...]:
    """The most probable path of a telegraph, or one of fewer changes that explains nearly as much.

    Where a level is large, further changes make up for times that are off by a part of the grid.
    """
    found = best_paths(equations, steps, fewest)
    best = max(found, key=lambda path: found[path] / 2 - log_paths(len(steps), len(path)))
    return min((path for path in found if found[path] >= MIN_OF_PATH * found[best]), key=len)


# ---- The rivals.


def _subsets(named: Sequence[Effect]) -> list[Sequence[Effect]]:
    """None of the effects, each, and all."""
    return [[], *([effect] for effect in named), *([named] if len(named) > 1 else [])]


def _prior(effect: Effect, campaign: Campaign, count: int) -> float:
    """Log prior of an effect of the catalogue of `count`, and of the value of what it scans."""
    return -float(np.log(count * max(len(effect.grid(campaign.motion)), 1)))


def _catalogue(columns: Columns, kept: Sequence[Effect], prior: Mapping[str, float]) -> float:
    """The log evidence of some of the named effects."""
    own = [[columns.place[name] for name in effect.columns] for effect in kept]
    evidence = walk_odds.laws(columns.equations, [([one], np.ones(1)) for one in own])
    return evidence + sum(prior[effect.name] for effect in kept)


def _walk_beside(columns: Columns, named: Sequence[Effect]) -> float:
    """The log evidence of a random walk, alone or beside the named effects."""
    known = [columns.place[name] for effect in named for name in effect.columns]
    own = [*known, *(i for axis in columns.waves for i in axis)]
    equations = columns.equations.of(own).given(range(len(known)))
    axes = np.arange(len(known), len(own)).reshape(len(AXES), -1)
    return walk_odds.walk(equations, axes.tolist()).log_evidence


# ---- The shape of a law between the values of its grid.


def refined(campaign: Campaign, law: Law, beside: Sequence[Effect]) -> tuple[Law, float]:
    """The law with each value of its shape moved within a step of its grid while that is better.

    And by how much its log evidence grows, less that of so many trials.
    """
    part, axes = campaign.stretches(law.sensor), [AXES.index(axis) for axis in law.axes]
    grid = (
        [(float(time),) for time in laws.steps(campaign.motion, laws.STEPS)]
        if law.family == TELEGRAPH
        else laws.grid(law.family, law.state, campaign.motion)
    )
    if not law.shape or law.family == "polynomial" or len(grid) < 2:
        return law, 0.0
    gain = 0.0
    values = np.array(grid)[:, 0]
    scale = 1.0
    for _round in range(ROUNDS):
        for k in range(len(law.shape)):
            near = np.sort(np.abs(values - law.shape[k]))
            step = scale * float(near[near > 1e-9 * np.ptp(values)][0])
            tried = [
                _shaped(law, (*law.shape[:k], law.shape[k] + share * step, *law.shape[k + 1 :]))
                for share in FINER
            ]
            law, more = _best(campaign, tried, beside, part, axes)
            gain += more
        scale /= 4
    trials = len(law.shape) * float(np.log(ROUNDS * len(FINER)))
    return law, max(gain - trials, 0.0)


def _best(
    campaign: Campaign,
    tried: Sequence[Law],
    beside: Sequence[Effect],
    part: slice,
    axes: Sequence[int],
) -> tuple[Law, float]:
    """The one that explains most, and by how much its log evidence exceeds the unmoved one's."""
    motion, found, first = campaign.motion, [], sum(len(e.parameters) for e in beside)
    columns: list[list[int]] = [[] for _ in tried]
    for axis in axes:
        values = [laws.functions(o.family, o.state, o.shape, motion, axis) for o in tried]
        for own, one in zip(columns, values, strict=True):
            own += range(first, first + one.shape[1])
            first += one.shape[1]
        found.append(_functions(tried[0].sensor, axis, values, part))
    equations, place = _equations(campaign, tried[0].sensor, [*beside, *found])
    equations = equations.given([place[n] for e in beside for n in e.columns])
    candidates = law_odds(
        equations, [searched_effect("", own) for own in columns], np.zeros(len(tried))
    )
    odds = candidates.of_each
    best = int(np.argmax(odds))
    # A power of the grid, such as 3, is simpler than one between.
    simple = tried[best].family.endswith("power") and odds[best] < odds[UNMOVED] + MAX_LOG_ODDS
    best = UNMOVED if simple else best
    return tried[best], float(odds[best] - odds[UNMOVED])
