"""What one would say of a drift who knows its equations and no more than the stages do.

The likelihood-ratio test knows both sizes, and that there is one of the two. Who knows neither has
a prior: silence, a random walk or an effect of the catalogue, each as likely; the logarithm of its
signal-to-noise ratio uniform from 2 to 40; in one axis or in all, as likely; any value of its scan.
He names what is most probable, but nothing where all of it together is no more probable than in
a share LEVEL of draws of noise alone. No test with this prior is right more often on what is drawn
from it; on draws of one ratio it tells what not knowing it costs.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaln, ive, logsumexp
from walk_draws import IN_BLOCKS, LEVEL, half_waves, quiet

from inertial.arrays import Array
from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.physics.effect import Effect

WALK, SILENCE = "walk", ""
LEAST, MOST, STEPS = 2.0, 40.0, 60  # signal-to-noise ratios
NULLS = 2000  # draws of noise
LENGTHS = np.linspace(1e-3, 100.0, 4000)  # of b, a signal-to-noise ratio
MIN_SEEN = 1e-6  # of the information of a column alone; less is rounding


@dataclass(frozen=True)
class Hypothesis:
    """Some columns of one size: `gains`: (STEPS, r), of b² along r combinations `white` (r, k)."""

    name: str
    log_prior: float
    white: Array
    gains: Array
    constants: Array
    directed: bool  # any direction is as likely; else each combination has its own variance

    def log_evidence(self, right: Array) -> Array:
        """Of draws (k, n), (n,)."""
        along = self.white @ right
        if self.directed:
            lengths = np.sqrt(np.sum(along**2, axis=0))
            return np.asarray(np.interp(lengths, LENGTHS, _of_any_direction(len(along))))
        logs = self.gains @ along**2 - self.constants[:, None]
        return np.asarray(logsumexp(logs, axis=0) - np.log(STEPS))


@cache
def _of_any_direction(count: int) -> Array:
    """Log evidence by the length of b along `count` combinations, of `LENGTHS`."""
    half, sizes = count / 2, np.geomspace(LEAST, MOST, STEPS)[:, None]
    z = sizes * LENGTHS
    bessel = np.log(ive(half - 1, z)) + z - (half - 1) * np.log(z / 2) + gammaln(half)
    return np.asarray(logsumexp(bessel - sizes**2 / 2, axis=0) - np.log(STEPS))


@dataclass(frozen=True)
class Guesser:
    """All hypotheses of a plan; `least`: what noise alone seldom exceeds of all of them."""

    effects: Sequence[Effect]
    hypotheses: Sequence[Hypothesis]
    least: float

    def says(self, campaign: Campaign) -> str:
        """The name of an effect, that it is a walk, or nothing."""
        said = evidence(campaign, self.effects).total.right[:, None]
        names, logs = _probable(self.hypotheses, said)
        best = int(np.argmax(logs[:, 0]))
        return names[best] if logsumexp(logs[:, 0]) > self.least else SILENCE


def _probable(hypotheses: Sequence[Hypothesis], right: Array) -> tuple[list[str], Array]:
    names = list(dict.fromkeys(one.name for one in hypotheses))
    logs = np.full((len(names), right.shape[1]), -np.inf)
    for one in hypotheses:
        row = names.index(one.name)
        logs[row] = np.logaddexp(logs[row], one.log_prior + one.log_evidence(right))
    return names, logs


@cache
def guesser(plan: str) -> Guesser:
    """Of a plan, by its clean campaign."""
    campaign = quiet(plan).campaign
    families = campaign.candidates(IN_BLOCKS)
    waves = half_waves()
    every = [*(effect for family in families.values() for effect in family), *waves]
    said = evidence(campaign, every, np.inf).observable().total
    information, place = said.information, {name: i for i, name in enumerate(said.names)}

    def columns(effect: Effect) -> list[int]:
        return [place[f"{effect.label}.{one.name}"] for one in effect.parameters]

    made = _walks(information, np.array([columns(wave) for wave in waves]), quiet(plan).variances)
    for name, family in families.items():
        kinds = [[columns(effect) for effect in family]]
        if len(kinds[0][0]) == 3:
            kinds.append([[column] for own in kinds[0] for column in own])
        for values in kinds:
            prior = -float(np.log(len(kinds) * len(values)))
            made += [one for own in values if (one := _of(information, own, name, prior))]
    root = _root(information)
    noise = root @ np.random.default_rng(1).standard_normal((root.shape[1], NULLS))
    nulls = logsumexp(_probable(made, noise)[1], axis=0)
    return Guesser(every, made, float(np.quantile(nulls, 1 - LEVEL)))


def _of(information: Array, own: Sequence[int], name: str, prior: float) -> Hypothesis | None:
    root, white = _modes(information[np.ix_(own, own)])
    if not root.shape[1]:
        return None
    whole = np.zeros((len(white), len(information)))
    whole[:, own] = white
    return Hypothesis(name, prior, whole, np.empty(0), np.empty(0), directed=True)


def _walks(information: Array, waves: NDArray[np.int64], variances: Array) -> list[Hypothesis]:
    """Of one axis and of all; `waves`: columns (n, 3)."""
    made = []
    for axes, prior in (([0], 1 / 6), ([1], 1 / 6), ([2], 1 / 6), ([0, 1, 2], 1 / 2)):
        own = waves[:, axes].ravel()
        root = np.sqrt(np.repeat(variances, len(axes)))
        block = information[np.ix_(own, own)] * np.outer(root, root)
        values, vectors = np.linalg.eigh(block)
        sizes = np.geomspace(LEAST, MOST, STEPS)[:, None] ** 2 / np.trace(block)
        spread = 1 + sizes * np.maximum(values, 0.0)
        whole = np.zeros((len(own), len(information)))
        whole[:, own] = vectors.T * root
        constants = np.sum(np.log(spread), axis=1) / 2
        made.append(
            Hypothesis(WALK, np.log(prior), whole, sizes / spread / 2, constants, directed=False)
        )
    return made


def _modes(block: Array) -> tuple[Array, Array]:
    """Root R of a block, F = R Rᵀ, without what is not seen, and combinations of variance 1."""
    size = np.sqrt(np.maximum(np.diag(block), 0.0))
    scale = np.where(size > 0, size, 1.0)
    values, vectors = np.linalg.eigh(block / np.outer(scale, scale))
    seen = values > MIN_SEEN
    root = size[:, None] * vectors[:, seen] * np.sqrt(values[seen])
    return root, (vectors[:, seen] / np.sqrt(values[seen])).T / scale


def _root(information: Array) -> Array:
    return _modes(information)[0]
