"""Variance components of what campaigns share: by type, table and IMU, and of each campaign.

Campaign j says of p quantities b_j ~ N(F_j β_j, F_j), where

    β_j = μ_type + u_table + v_imu + w_j,     each N(0, θ I) with the variance θ of its level.

The campaigns' own part is eliminated in each campaign and the IMUs' in each IMU, so that the
restricted likelihood costs the same for each campaign; types and tables, which are few, are solved
together (Searle, Casella & McCulloch, Variance Components, 1992, chapter 7).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.optimize import OptimizeResult, brentq, minimize

from inertial.arrays import Array, Booleans
from inertial.estimation.probability import chi2_sf, t_isf, t_sf

LEVELS = ("type", "table", "imu", "campaign")
FLAT = 1e8  # variance of the mean of a type that is free, in variances of the values
SMALLEST, LARGEST = 1e-7, 1e3  # variances that are sought, in variances of the values
STARTS = (0.01, 0.3)
# Of the search: a deviance of precise values is large, and its last digits tell.
DIFFERENCE, CONVERGED = 1e-4, 1e-13
STEP = 0.05  # relative, of standard deviations, for the curvature of the likelihood
MIN_SHOWN = 1e-5  # of the variance of the values: a component of less is zero
MIN_DEGREES = 1.0  # of freedom, of a spread between two
ADAPTING, DRAWS = 1000, 4000  # of the sampler
ACCEPTED = 0.3  # share of its steps
SCALES = (0.2, 1.0, 3.0)  # of its steps, by chance: components differ in how well they are known
TOTALS = (1e-3, 1e3)  # range of the mean square of an effect, in units of its first estimate


@dataclass(frozen=True)
class Solved:
    """Given all variances: −2 log likelihood, and the parts of types and tables with covariance.

    `types`: (y, p); `tables`: (t, p); `covariance`: of both, (y + t) p square.
    """

    deviance: float
    types: Array
    tables: Array
    covariance: Array


class Sharing:
    """The evidence of c campaigns on p quantities.

    Parameters
    ----------
    information, right : F (c, p, p) and b (c, p)
    labels : of each level but the last the group of each campaign
    """

    def __init__(
        self, information: Array, right: Array, labels: Mapping[str, Sequence[str]]
    ) -> None:
        self.information, self.right = information, right
        self.of = {
            level: np.unique(np.array(labels[level]), return_inverse=True)[1]
            for level in LEVELS[:-1]
        }
        self.of[LEVELS[-1]] = np.arange(len(right))

    def distinct(self) -> dict[str, tuple[str, ...]]:
        """The levels that divide the campaigns differently, each with those that do as it does."""
        divisions: dict[bytes, list[str]] = {}
        for level in LEVELS:
            _, first = np.unique(self.of[level], return_index=True)
            order = np.argsort(np.argsort(first))
            divisions.setdefault(order[self.of[level]].tobytes(), []).append(level)
        return {levels[0]: tuple(levels) for levels in divisions.values()}

    def solved(self, variance: Mapping[str, float]) -> Solved:
        """The likelihood of the variances of the levels, none: zero."""
        information, right, deviance = _eliminated(
            self.information, self.right, variance.get("campaign", 0.0)
        )
        p, own = right.shape[1], self.of["imu"]
        count = {level: int(self.of[level].max()) + 1 for level in ("type", "table")}
        size = p * sum(count.values())
        imus, spread = int(own.max()) + 1, variance.get("imu", 0.0)
        of_imu, score = np.zeros((imus, p, p)), np.zeros((imus, p))
        np.add.at(of_imu, own, information)
        np.add.at(score, own, right)
        across = np.zeros((imus, size, p))
        matrix, vector = np.zeros((size, size)), np.zeros(size)
        start = {"type": 0, "table": p * count["type"]}
        for level, first in start.items():
            at = first + p * self.of[level][:, None] + np.arange(p)
            np.add.at(across, (own[:, None], at), information)
            np.add.at(vector, at, right)
            for other, second in start.items():
                beside = second + p * self.of[other][:, None] + np.arange(p)
                np.add.at(matrix, (at[:, :, None], beside[:, None, :]), information)
        # (F + 1/θ)⁻¹ = θ (1 + θ F)⁻¹
        inverse = spread * np.linalg.inv(np.eye(p) + spread * of_imu)
        deviance += float(np.sum(np.linalg.slogdet(np.eye(p) + spread * of_imu)[1]))
        deviance -= float(np.einsum("np,npq,nq->", score, inverse, score))
        matrix -= np.einsum("nap,npq,nbq->ab", across, inverse, across)
        vector -= np.einsum("nap,npq,nq->a", across, inverse, score)
        root = np.sqrt(
            np.repeat(
                [variance.get(level, 0.0) for level in ("type", "table")],
                [p * count["type"], p * count["table"]],
            )
        )
        scaled = np.eye(size) + root[:, None] * matrix * root
        covariance = root[:, None] * np.linalg.inv(scaled) * root
        values = covariance @ vector
        deviance += float(np.linalg.slogdet(scaled)[1] - vector @ values)
        split = p * count["type"]
        return Solved(
            deviance, values[:split].reshape(-1, p), values[split:].reshape(-1, p), covariance
        )


def _eliminated(information: Array, right: Array, variance: float) -> tuple[Array, Array, float]:
    """F (1 + θ F)⁻¹ and (1 + θ F)⁻¹ b of each campaign, and what that adds to the deviance."""
    if not variance:
        return information, right, 0.0
    grown = np.eye(right.shape[1]) + variance * information
    inverse = np.linalg.inv(grown)
    deviance = float(np.sum(np.linalg.slogdet(grown)[1]))
    kept = np.einsum("cpq,cq->cp", inverse, right)
    return information @ inverse, kept, deviance - variance * float(np.sum(right * kept))


# ---- Shares of an effect.


def shares(sharing: Sharing, seed: int = 0) -> dict[tuple[str, ...], tuple[float, float]]:
    """Which share of the mean square of an effect each level has, with sigma.

    Levels that divide the campaigns in the same way have one share together. Mean and standard
    deviation of the posterior, all shares being equally probable beforehand and the mean square
    uniform in its logarithm; by random-walk Metropolis sampling, the steps adapted at first.
    """
    levels = sharing.distinct()
    random = np.random.default_rng(seed)
    first = _mean_square(sharing)
    low, high = np.log(first) + np.log(TOTALS)

    def logarithm(sizes: Array) -> float:
        """Of the posterior density of the logarithms of the variances."""
        total = float(np.logaddexp.reduce(sizes))
        if not low < total < high:
            return -np.inf
        deviance = sharing.solved(dict(zip(levels, np.exp(sizes).tolist(), strict=True))).deviance
        return float(np.sum(sizes - total)) - deviance / 2

    place = np.full(len(levels), np.log(first / len(levels)))
    here, step = logarithm(place), 1.0
    drawn = []
    for number in range(ADAPTING + DRAWS):
        trial = place + step * random.normal(size=len(place)) * random.choice(SCALES, len(place))
        there = logarithm(trial)
        accepted = np.log(random.random()) < there - here
        if accepted:
            place, here = trial, there
        if number < ADAPTING:
            step *= np.exp((float(accepted) - ACCEPTED) / np.sqrt(number + 1))
        else:
            drawn.append(np.exp(place - np.logaddexp.reduce(place)))
    mean, sigma = np.mean(drawn, axis=0), np.std(drawn, axis=0)
    return {
        names: (float(m), float(s))
        for names, m, s in zip(levels.values(), mean, sigma, strict=True)
    }


def _mean_square(sharing: Sharing) -> float:
    """A first estimate of the mean square of a parameter of the effect."""
    count, quantities = sharing.right.shape
    alone = np.linalg.pinv(sharing.information, hermitian=True)
    excess = float(np.einsum("cp,cpq,cq->", sharing.right, alone, sharing.right)) / (
        count * quantities
    )
    information = float(np.trace(sharing.information.sum(axis=0))) / (count * quantities)
    return float(max(excess - 1, 1 / count) / information)


# ---- The mean of tables that differ by a spread which few of them tell.
#
#     y_t = μ + u_t + e_t,    u ~ N(0, θ I),  e ~ N(0, A)
#
# With two tables the spread has one degree of freedom: its likeliest value is often zero, and a
# mean that takes it for true is too sure. Here μ is averaged over the θ that the y leave possible.
# At the true θ
#
#     Q(θ) = min_μ (y - μ)ᵀ (A + θ I)⁻¹ (y - μ)
#
# is chi-squared with one degree less than there are tables, so that the probability of a larger Q
# is a cumulative distribution of θ (Viechtbauer 2007, Statist. Med. 26, 37), with what is left at
# zero. No prior is in it. The interval of μ is a generalised confidence interval (Weerahandi 1993,
# JASA 88, 899; Iyer, Wang & Mathew 2004, JASA 99, 1060), for equal tables that of Behrens and
# Fisher.

SQUARES = np.r_[0.0, np.geomspace(1e-8, 1e10, 250)]  # θ, in variances of the values
INNER, OUTER = 0.3173, 0.05  # chances outside the two intervals that a Student's t is to share
DEGREES = (0.5, 1e6)  # that are sought


@dataclass(frozen=True)
class TableMeans:
    """Means of tables (t,), in standard deviations of the values, and their covariance (t, t)."""

    values: Array
    covariance: Array

    def mean(self, squares: Array) -> tuple[Array, Array]:
        """μ and its variance, if θ is one of these: (k,) each."""
        inverse, ones, values = self._rotated(squares)
        variance = 1 / (inverse @ ones**2)
        return variance * (inverse @ (ones * values)), variance

    def squares(self) -> tuple[Array, Array]:
        """Values of θ and the probability of each, (k,)."""
        if len(self.values) == 1:
            return np.zeros(1), np.ones(1)
        inverse, _, values = self._rotated(SQUARES)
        mean, variance = self.mean(SQUARES)
        statistic = inverse @ values**2 - mean**2 / variance
        up_to = chi2_sf(statistic, len(values) - 1)
        up_to[-1] = 1.0
        middles = np.sqrt(SQUARES[:-1] * SQUARES[1:])
        return np.r_[0.0, middles], np.diff(up_to, prepend=0.0)

    def _rotated(self, squares: Array) -> tuple[Array, Array, Array]:
        """1 / (a + θ) of the eigenvalues a of A, (k, t); ones and values in its vectors, (t,)."""
        own, vectors = np.linalg.eigh(self.covariance)
        return 1 / (own + squares[:, None]), vectors.sum(axis=0), vectors.T @ self.values


@dataclass(frozen=True)
class Mixture:
    """One of several Student's t by chance: probabilities, centres, sigmas and degrees, (k,).

    Degrees: NaN where not known.
    """

    weights: Array
    centres: Array
    sigmas: Array
    degrees: Array

    @property
    def mean(self) -> float:
        """Mean of the centres."""
        return float(self.weights @ self.centres)

    def with_known(self, sigma: float) -> "Mixture":
        """With a further error, whose sigma is known."""
        whole = np.hypot(self.sigmas, sigma)
        return replace(self, sigmas=whole, degrees=self.degrees * (whole / self.sigmas) ** 4)

    def half_width(self, outside: float) -> float:
        """Of the interval about the mean that leaves so much outside."""
        degrees = np.where(np.isnan(self.degrees), np.inf, self.degrees)
        off = self.centres - self.mean

        def excess(width: float) -> float:
            chances = t_sf((width - off) / self.sigmas, degrees)
            chances += t_sf((width + off) / self.sigmas, degrees)
            return float(self.weights @ chances) - outside

        high = float(self.sigmas.max())
        while excess(high) > 0:
            high *= 2
        return float(brentq(excess, 0.0, high))

    def student(self) -> tuple[float, float]:
        """Sigma and degrees of the Student's t that has the same 68 % and 95 % intervals."""
        inner, outer = self.half_width(INNER), self.half_width(OUTER)
        if np.isnan(self.degrees).any():
            return inner / float(t_isf(INNER / 2, np.inf)), np.nan

        def excess(logarithm: float) -> float:
            n = np.exp(logarithm)
            return float(t_isf(OUTER / 2, n) / t_isf(INNER / 2, n)) - outer / inner

        low, high = np.log(DEGREES)
        if excess(high) >= 0:
            return outer / float(t_isf(OUTER / 2, np.inf)), np.inf
        degrees = float(np.exp(brentq(excess, low, high)))
        return outer / float(t_isf(OUTER / 2, degrees)), degrees


# ---- Mean and spread of a quantity.


@dataclass(frozen=True)
class Spread:
    """A standard deviation between the groups of some levels that the campaigns do not tell apart.

    `sigma`: NaN where the largest likelihood is at zero.
    """

    levels: tuple[str, ...]
    groups: int
    value: float
    sigma: float


@dataclass(frozen=True)
class Population:
    """A quantity of a type: the law of its mean, its spreads; `tables`: the part of each table.

    `errors`: covariance of the logarithms of the spreads, NaN in the rows of those at 0, or where
    it is not known; `campaigns`: how many have a value.

    Sigma and degrees of freedom of the mean are those of a Student's t with its 68 % and 95 %
    intervals; degrees are infinite without spreads, NaN where their errors are not known.
    """

    law: Mixture
    spreads: tuple[Spread, ...]
    tables: Array
    errors: Array
    campaigns: int

    @property
    def mean(self) -> float:
        """Of the type."""
        return self.law.mean

    @cached_property
    def student(self) -> tuple[float, float]:
        """Sigma and degrees of freedom of the mean."""
        return self.law.student()

    @property
    def mean_sigma(self) -> float:
        """Of Student's t with `mean_degrees`."""
        return self.student[0]

    @property
    def mean_degrees(self) -> float:
        """Of freedom, of `mean_sigma`."""
        return self.student[1]

    def with_known(self, sigma: float) -> "Population":
        """With a further error of the mean, whose sigma is known."""
        return replace(self, law=self.law.with_known(sigma))


def population(values: Array, sigma: Array, labels: Mapping[str, Sequence[str]]) -> Population:
    """Mean and spreads of a quantity over the campaigns of one type, by restricted likelihood.

    `values`, `sigma`: (c,), of each campaign, independent. The spread between types is not sought.
    The mean is averaged over the spreads between tables that are possible, see above.
    """
    scale = max(float(np.var(values)), float(np.median(sigma**2)))
    information = (scale / sigma**2)[:, None, None]
    right = (values - np.median(values))[:, None] * np.sqrt(scale) / sigma[:, None] ** 2
    sharing = Sharing(information, right, labels)
    levels = {
        first: names
        for first, names in sharing.distinct().items()
        if not sharing.of[first].max() < 1
    }

    def with_mean(sizes: Array) -> dict[str, float]:
        return {"type": FLAT, **dict(zip(levels, np.exp(sizes).tolist(), strict=True))}

    def deviance(sizes: Array) -> float:
        return sharing.solved(with_mean(sizes)).deviance

    bounds = [(np.log(SMALLEST), np.log(LARGEST))] * len(levels)

    def search(start: float) -> OptimizeResult:
        first = np.full(len(levels), np.log(start))
        return minimize(
            deviance, first, bounds=bounds, options={"eps": DIFFERENCE, "ftol": CONVERGED}
        )

    best = min(map(search, STARTS), key=lambda found: float(found.fun))
    sizes = np.where(np.exp(best.x) < MIN_SHOWN, -np.inf, best.x)
    errors = _relative_errors(deviance, sizes)
    sigmas = np.exp(sizes / 2) * np.sqrt(np.diag(errors))
    root = float(np.sqrt(scale))
    spreads = tuple(
        Spread(names, int(sharing.of[first].max()) + 1, root * float(np.exp(size / 2)), root * s)
        for (first, names), size, s in zip(levels.items(), sizes, sigmas, strict=True)
    )
    law = _law_of_mean(sharing, dict(zip(levels, sizes.tolist(), strict=True)), errors)
    in_units = replace(
        law, centres=float(np.median(values)) + root * law.centres, sigmas=root * law.sigmas
    )
    tables = root * sharing.solved(with_mean(sizes)).tables[:, 0]
    return Population(in_units, spreads, tables, errors, len(values))


def _law_of_mean(sharing: Sharing, sizes: Mapping[str, float], errors: Array) -> Mixture:
    """Of the mean of a type, tables being free to differ.

    `sizes`: logarithms of the variances of the levels; `errors`: of the standard deviations.
    """
    others = [level for level in sizes if level != "table"]

    def tables(at: Array) -> TableMeans:
        own = dict(zip(others, np.exp(at).tolist(), strict=True))
        solved = sharing.solved({"table": FLAT, **own})
        count = len(solved.tables)
        return TableMeans(solved.tables[:, 0], solved.covariance[-count:, -count:])

    at = np.array([sizes[level] for level in others])
    means = tables(at)
    squares, weights = means.squares()
    centres, variances = means.mean(squares)
    known = _given(errors, np.array([level == "table" for level in sizes], bool))
    degrees = _satterthwaite(lambda at: tables(at).mean(squares)[1], at, known)
    return Mixture(weights, centres, np.sqrt(variances), degrees)


def _given(errors: Array, known: Booleans) -> Array:
    """The covariance of the others if some were known; NaN in the rows of what is at 0."""
    kept = errors[np.ix_(~known, ~known)].copy()
    beside = known & np.isfinite(np.diag(errors))
    across = errors[np.ix_(~known, beside)]
    return kept - across @ np.linalg.solve(errors[np.ix_(beside, beside)], across.T)


def _relative_errors(deviance: Callable[[Array], float], sizes: Array) -> Array:
    """Covariance of the logarithms of the standard deviations by the curvature of the likelihood.

    `sizes`: logarithms of the variances, (l,); NaN in the rows of those at 0, or without a maximum.
    """
    shown = np.flatnonzero(np.isfinite(sizes))
    errors = np.full((len(sizes), len(sizes)), np.nan)
    unit = np.eye(len(sizes))[shown]

    def at(steps: Array) -> float:
        return deviance(_stepped(sizes, steps))

    curvature = (
        np.array(
            [[at(i + j) + at(-i - j) - at(i - j) - at(j - i) for j in unit] for i in unit]
        ).reshape(len(shown), len(shown))
        / (2 * STEP) ** 2
    )
    if len(shown) and np.all(np.linalg.eigvalsh(curvature) > 0):
        errors[np.ix_(shown, shown)] = 2 * np.linalg.inv(curvature)
    return errors


def _stepped(sizes: Array, steps: Array) -> Array:
    """Logarithms of variances after so many steps of the standard deviations."""
    return np.asarray(sizes + 2 * np.log1p(STEP * steps))


def _satterthwaite(variance: Callable[[Array], Array], sizes: Array, errors: Array) -> Array:
    """Degrees of freedom of variances (k,) that are functions of estimated ones: 2 φ² / var(φ).

    With var(φ) = gᵀ A g of the derivatives g and the covariance A of the estimates (Giesbrecht &
    Burns 1985, Biometrics 41, 477; Fai & Cornelius 1996, J. Statist. Comput. Simul. 54, 363). No
    fewer than two values have: near zero a variance is known worse than its derivative says.
    """
    here = variance(sizes)
    shown = np.flatnonzero(np.isfinite(sizes))
    unit = np.eye(len(sizes))[shown]
    derivative = np.array(
        [variance(_stepped(sizes, i)) - variance(_stepped(sizes, -i)) for i in unit]
    ).reshape(len(shown), len(here)) / (2 * STEP)
    of_variance = np.einsum("ik,ij,jk->k", derivative, errors[np.ix_(shown, shown)], derivative)
    with np.errstate(divide="ignore"):
        return np.asarray(np.maximum(2 * here**2 / of_variance, MIN_DEGREES))
