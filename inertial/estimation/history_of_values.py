"""The values of a parameter over a history of calibrations: drift, the next one, and jumps.

Each of n calibrations has a value y with a known sigma of its own, at a time t, and

    y = a + b t + w(t) + d + e        e: its own error, d: of the day, N(0, τ²)

e of several calibrations have in common what is the error of a reference that they share, and the
next shares those of the last. w is a random walk, K² per time, and b N(0, s²). What is not known is
integrated over: a with equal density everywhere; τ, K and s each absent with a probability, else
with the density 1/(x + u), u the size that would be as large as the sigmas, on a grid of the
restricted likelihood (Patterson & Thompson 1971). So an interval for the next calibration is as
wide as what few of them leave open: where only the days differ it is about Student's, whose origin
is the density 1/x (Box & Tiao, Bayesian Inference in Statistical Analysis, 1973, 2.8); where the
sigmas explain all, a normal one. The probabilities of absence are such that intervals of 95 % hold
in 95 of 100 histories (docs/repeatability.md).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, minimize
from scipy.special import ndtr

from inertial.arrays import Array

POINTS = 10  # of the grid, for each of τ, K and s
ABSENT = {"day": 0.5, "walk": 0.7, "slope": 0.7}  # probability that there is none
LARGEST = 5.0  # size up to which they are sought, in spreads of the values
PROBABILITY = 0.95  # of the interval of a prediction
MIN_VALUES = 3  # calibrations, for a prediction
MIN_FOR_JUMP = 5  # calibrations, for a jump
MIN_TIMES = 3  # different ones, for a jump: of two a jump and a drift are one
MIN_DROP = 6.0  # of the deviance, for a jump: of a smaller one no chance is drawn
BISECTIONS = 60
LEAST_WEIGHT = 1e-12  # of a point of the grid, of that of all
BOOTSTRAP = 2000  # histories without a jump
TAIL = 0.1  # of them, by whose excess the chance of a rarer one is extrapolated


@dataclass(frozen=True)
class History:
    """n values in the order of their times: (n,) each; `step`: (n,), 1 after a jump that is known.

    `times` in years, or any other unit. `sigma`: of the own errors; `shared`: (n, r), by how much
    a standard deviation of the error of each of r references moves each value.
    """

    values: Array
    sigma: Array
    times: Array
    step: Array | None = None
    shared: Array | None = None

    @property
    def errors(self) -> Array:
        """The covariance of the errors of all calibrations, (n, n)."""
        own = np.diag(self.sigma**2)
        return own if self.shared is None else own + self.shared @ self.shared.T

    @property
    def design(self) -> Array:
        """The columns of what is determined without a prior, (n, 1 or 2)."""
        columns = [np.ones(len(self.values)), *([] if self.step is None else [self.step])]
        return np.column_stack(columns)

    @property
    def unit(self) -> float:
        """The usual sigma."""
        return float(np.sqrt(np.mean(self.sigma**2)))

    @property
    def span(self) -> float:
        """From the first time to the last; where there is none, the unit of time."""
        return float(np.ptp(self.times)) or 1.0


@dataclass(frozen=True)
class Prediction:
    """Of the value at m times: median and limits of the interval, (m,) each."""

    median: Array
    low: Array
    high: Array


@dataclass(frozen=True)
class _Sizes:
    """Points of the grid: τ, K and s, (g,) each, and their prior weight."""

    day: Array
    walk: Array
    slope: Array
    prior: Array

    @property
    def days(self) -> Array:
        """The different τ, which vary slowest."""
        return np.unique(self.day)

    @property
    def without_days(self) -> "_Sizes":
        """The points of one τ, without it."""
        count = len(self.day) // len(self.days)
        none = np.zeros(count)
        return _Sizes(none, self.walk[:count], self.slope[:count], self.prior[:count])

    def covariance(self, one: Array, other: Array) -> Array:
        """Of walk and slope between times, (g, n, m)."""
        first, second = one[:, None], other[None, :]
        start = min(one.min(), other.min())
        common = np.minimum(first, second) - start
        return np.asarray(
            self.walk[:, None, None] ** 2 * common
            + self.slope[:, None, None] ** 2 * (first - start) * (second - start)
        )


def _grid(history: History) -> _Sizes:
    unit, span = history.unit, history.span
    largest = LARGEST * (float(np.ptp(history.values)) + unit) / unit
    sizes = unit * np.expm1(np.linspace(0, np.log1p(largest), POINTS))
    day, walk, slope = np.meshgrid(sizes, sizes / np.sqrt(span), sizes / span, indexing="ij")
    shares = [_weights(ABSENT[name]) for name in ("day", "walk", "slope")]
    prior = np.einsum("i,j,k->ijk", *shares)
    return _Sizes(day.ravel(), walk.ravel(), slope.ravel(), prior.ravel())


def _weights(absent: float) -> Array:
    """Of the points of one size: the first is 0."""
    own = np.ones(POINTS)
    own[[0, -1]] = 0.5
    own *= (1 - absent) / own.sum()
    own[0] += absent
    return own


def predicted(history: History, times: Array, sigma: float) -> Prediction:
    """The next calibration at one of these times, (m,), its own sigma that of its noise.

    With the covariance A of all but the days, A = Q diag(λ) Qᵀ, that of the values is
    Q diag(λ + τ²) Qᵀ: each walk and slope is solved once for all τ.
    """
    sizes, n = _grid(history), len(history.values)
    x, y = history.design, history.values
    at = np.concatenate([history.times, times])
    place = np.append(np.arange(n), np.full(len(times), n - 1))
    shared = np.zeros((n, 0)) if history.shared is None else history.shared
    own = np.diag(np.append(history.sigma**2, np.full(len(times), sigma**2)))
    alike = sizes.without_days
    covariance = alike.covariance(at, at) + own + shared[place] @ shared[place].T
    values, vectors = np.linalg.eigh(covariance[:, :n, :n])
    turned = vectors.transpose(0, 2, 1)
    by_x, by_y, by_across = turned @ x, turned @ y, turned @ covariance[:, :n, n:]
    alone = np.diagonal(covariance[:, n:, n:], axis1=1, axis2=2)
    ahead = np.ones((x.shape[1], len(times)))  # after a jump, too
    logarithms, means, variances = [], [], []
    for day in sizes.days:
        spectrum = values + day**2  # (g, n)
        weighted = by_x / spectrum[..., None]
        information = weighted.transpose(0, 2, 1) @ by_x
        inverse = np.linalg.inv(information)
        estimate = np.einsum("gpq,gnq,gn->gp", inverse, weighted, by_y, optimize=True)
        residual = by_y - np.einsum("gnp,gp->gn", by_x, estimate)
        misfit = np.sum(residual**2 / spectrum, axis=1)
        logarithms.append(np.log(spectrum).sum(axis=1) + np.linalg.slogdet(information)[1] + misfit)
        of_across = by_across / spectrum[..., None]
        means.append(estimate @ ahead + np.einsum("gnm,gn->gm", of_across, residual))
        open_part = ahead - by_x.transpose(0, 2, 1) @ of_across
        variances.append(
            alone
            + day**2
            - np.sum(by_across * of_across, axis=1)
            + np.einsum("gpm,gpq,gqm->gm", open_part, inverse, open_part, optimize=True)
        )
    logarithm, mean, variance = map(np.concatenate, (logarithms, means, variances))
    weights = sizes.prior * np.exp(-(logarithm - logarithm.min()) / 2)
    shown = weights > LEAST_WEIGHT * weights.sum()
    weights = weights[shown] / weights[shown].sum()
    mean, spread = mean[shown], np.sqrt(variance[shown])
    tail = (1 - PROBABILITY) / 2
    quantiles = [_quantile(q, weights, mean, spread) for q in (0.5, tail, 1 - tail)]
    return Prediction(*quantiles)


def _quantile(q: float, weights: Array, mean: Array, spread: Array) -> Array:
    """Of mixtures of normal distributions, (m,); mean, spread: (g, m)."""
    wide = 40 * spread.max(axis=0)
    low, high = mean.min(axis=0) - wide, mean.max(axis=0) + wide
    for _unused in range(BISECTIONS):
        middle = (low + high) / 2
        below = weights @ ndtr((middle - mean) / spread) < q
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.asarray((low + high) / 2)


@dataclass(frozen=True)
class Drift:
    """The steady change per time by weighted regression, and its sigma with what the days add."""

    rate: float
    sigma: float


def drift(history: History) -> Drift:
    """By the scatter of the days of largest restricted likelihood; no random walk beside it."""
    design = np.column_stack([history.design, history.times - history.times.mean()])
    spread = float(np.ptp(history.values)) + history.unit
    sizes = np.append(0.0, np.geomspace(0.05 * history.unit, spread, 60))
    best, smallest = None, np.inf
    for size in sizes:
        covariance = history.errors + size**2 * np.eye(len(design))
        weighted = np.linalg.solve(covariance, design)
        information = design.T @ weighted
        inverse = np.linalg.inv(information)
        estimate = inverse @ (weighted.T @ history.values)
        residual = history.values - design @ estimate
        misfit = float(residual @ np.linalg.solve(covariance, residual))
        logarithms = np.linalg.slogdet(covariance)[1] + np.linalg.slogdet(information)[1]
        deviance = misfit + logarithms
        if deviance < smallest:
            smallest = deviance
            best = Drift(float(estimate[-1]), float(np.sqrt(inverse[-1, -1])))
    assert best is not None
    return best


@dataclass(frozen=True)
class Jump:
    """A step of the level from calibration `before` to the next; the chance of such a one."""

    before: int
    size: float
    sigma: float
    p_value: float


class _Steps:
    """Deviances of values without a step and with one at any place, beside drift, walk and days."""

    def __init__(self, history: History) -> None:
        n, unit = len(history.values), history.unit
        spread = float(np.ptp(history.values)) + unit
        days = np.append(0.0, np.geomspace(0.3 * unit, spread, 7))
        walks = np.append(0.0, np.geomspace(0.3 * unit, spread, 4)) / np.sqrt(history.span)
        day, walk = (each.ravel() for each in np.meshgrid(days, walks, indexing="ij"))
        sizes = _Sizes(day, walk, np.zeros(len(day)), np.ones(len(day)))
        self.covariance = sizes.covariance(history.times, history.times) + (
            history.errors + day[:, None, None] ** 2 * np.eye(n)
        )
        self.plain = np.column_stack([np.ones(n), history.times - history.times.mean()])
        self.inverse = np.linalg.inv(self.covariance)
        self.logarithm = np.linalg.slogdet(self.covariance)[1]
        self.projection = _projection(self.inverse, self.plain)
        # By how much each step would be known beside what is there without one, (g, n - 1).
        summed = np.cumsum(self.projection[:, ::-1, ::-1], axis=1).cumsum(axis=2)
        self.known = np.diagonal(summed, axis1=1, axis2=2)[:, -2::-1]

    def design(self, before: int) -> Array:
        """With a step behind a calibration, (n, 3)."""
        return np.column_stack([self.plain, np.arange(len(self.plain)) > before])

    def without_a_step(self, values: Array, generator: np.random.Generator) -> Array:
        """Histories as these values may be from if there is none, (d, n): sizes by their weight."""
        information = self.plain.T @ self.inverse @ self.plain
        misfit = np.einsum("n,gnm,m->g", values, self.projection, values)
        restricted = misfit + self.logarithm + np.linalg.slogdet(information)[1]
        weights = np.exp(-(restricted - restricted.min()) / 2)
        sizes = generator.choice(len(weights), size=BOOTSTRAP, p=weights / weights.sum())
        factors = np.linalg.cholesky(self.covariance)
        normal = generator.normal(size=(BOOTSTRAP, len(values)))
        return np.asarray(np.einsum("dnm,dm->dn", factors[sizes], normal))

    def misfits(self, values: Array) -> Array:
        """Of draws (d, n) without a step and with one at each place, (g, d, n).

        A step z takes (zᵀ P y)² / zᵀ P z off yᵀ P y; zᵀ P y is a sum of the last of P y.
        """
        projected = values @ self.projection  # (g, d, n)
        plain = np.einsum("dn,gdn->gd", values, projected)
        steps = projected[..., :0:-1].cumsum(axis=2)[..., ::-1]
        stepped = plain[..., None] - steps**2 / self.known[:, None]
        return np.asarray(np.concatenate([plain[..., None], stepped], axis=2))

    def deviances(self, values: Array) -> Array:
        """The smallest of any sizes, (d, n); values: (d, n)."""
        return np.asarray((self.misfits(values) + self.logarithm[:, None, None]).min(axis=0))


def _projection(inverse: Array, design: Array) -> Array:
    """V⁻¹ − V⁻¹ X (Xᵀ V⁻¹ X)⁻¹ Xᵀ V⁻¹ of each V, (g, n, n)."""
    weighted = inverse @ design
    between = np.linalg.inv(design.T @ weighted)
    return np.asarray(inverse - weighted @ between @ weighted.transpose(0, 2, 1))


def jump(history: History, generator: np.random.Generator) -> Jump | None:
    """The likeliest step; none where there are too few values, or no step improves anything.

    Its chance is that of the largest at any place, by histories drawn from what these may be from
    without one; of one that is rarer than all of these, by the exponential tail of their deviances.
    """
    n = len(history.values)
    if n < MIN_FOR_JUMP or len(np.unique(history.times)) < MIN_TIMES:
        return None
    steps = _Steps(history)
    centred = history.values - history.values.mean()
    deviances = steps.deviances(centred[None])[0]
    before = int(np.argmin(deviances[1:]))
    drop = float(deviances[0] - deviances[1 + before])
    if drop < MIN_DROP:
        return None
    draws = steps.without_a_step(centred, generator)
    drawn = steps.deviances(draws)
    drops = drawn[:, 0] - drawn[:, 1:].min(axis=1)
    edge = float(np.quantile(drops, 1 - TAIL))
    excess = float(np.mean(drops[drops > edge] - edge))
    if drop > edge:
        p_value = TAIL * float(np.exp(-(drop - edge) / excess))
    else:
        p_value = float(np.mean(drops >= drop))
    design = steps.design(before)
    own = steps.misfits(centred[None])[:, 0, 1 + before]
    covariance = steps.covariance[int(np.argmin(own + steps.logarithm))]
    weighted = np.linalg.solve(covariance, design)
    inverse = np.linalg.inv(design.T @ weighted)
    size = float((inverse @ (weighted.T @ centred))[-1])
    return Jump(before, size, float(np.sqrt(inverse[-1, -1])), p_value)


# ---- Variance components of a parameter over several calibrations, by restricted likelihood.
#
# n values y with known sigmas of their own differ by more than these: by the day, the mounting, the
# switch-on, as groups of calibrations that share one. With Z_c the groups of a component,
#
#     V = diag(σ²) + L Lᵀ + Σ τ_c² Z_c Z_cᵀ
#
# L is what the errors of references that several of them share move each by; the τ_c are those of
# largest restricted likelihood (Patterson & Thompson 1971), with the sigma of the expected
# information, ½ tr(P Z_c Z_cᵀ P Z_d Z_dᵀ), and an upper limit by the profile of the likelihood
# (Searle, Casella & McCulloch, Variance Components, 1992, chapter 6).

ONE_SIDED = 2.706  # rise of the deviance at the one-sided limit of 95 %
MIN_CALIBRATIONS = 2
STARTS = (0.05, 0.5)  # of the search, in spreads of the values
MAX_SPREADS = 1e3  # upper limit that is sought, in spreads of the values


@dataclass(frozen=True)
class Component:
    """A standard deviation between groups; `names`: of what is alike in each of the `groups`.

    `sigma`: NaN where the largest likelihood is at zero; `upper`: one-sided 95 %.
    """

    names: tuple[str, ...]
    groups: int
    value: float
    sigma: float
    upper: float


@dataclass(frozen=True)
class Components:
    """What the values show; `one`: names of which there is a single group, so nothing is known."""

    found: Sequence[Component]
    one: tuple[str, ...]


def components(
    values: Array,
    sigma: Array,
    alike: Mapping[str, Sequence[str]],
    shared: Array | None = None,
) -> Components:
    """The components of n values with their sigmas, (n,).

    What divides the values in the same way is one component: nothing tells its parts apart.

    Parameters
    ----------
    alike : name of a component → the group of each value
    shared : (n, r), by how much a standard deviation of r common errors moves each value
    """
    divisions: dict[tuple[int, ...], list[str]] = {}
    for name, labels in alike.items():
        places = {label: place for place, label in enumerate(dict.fromkeys(labels))}
        divisions.setdefault(tuple(places[label] for label in labels), []).append(name)
    one = tuple(divisions.pop((0,) * len(values), ()))
    squares = [np.equal.outer(np.array(d), np.array(d)).astype(float) for d in divisions]
    if not squares or len(values) < MIN_CALIBRATIONS:
        return Components([], one)
    spread = float(np.ptp(values) + np.sqrt(np.mean(sigma**2)))
    common = np.zeros((len(values), 0)) if shared is None else shared
    errors = (np.diag(sigma**2) + common @ common.T) / spread**2
    model = _Restricted(values / spread, errors, squares)
    best, smallest = model.largest()
    errors = model.sigmas(best)
    found = [
        Component(
            tuple(names),
            max(division) + 1,
            spread * float(best[i]),
            spread * float(errors[i]),
            spread * model.upper(i, best, smallest),
        )
        for i, (division, names) in enumerate(divisions.items())
    ]
    return Components(found, one)


class _Restricted:
    """The restricted likelihood of values about a common mean; sizes in units of the spread."""

    def __init__(self, values: Array, errors: Array, squares: Sequence[Array]) -> None:
        self.values, self.own, self.squares = values, errors, squares

    def projection(self, sizes: Array) -> tuple[Array, float]:
        """P = V⁻¹ less the mean, and log |V| + log (1ᵀ V⁻¹ 1)."""
        covariance = self.own + sum(
            size**2 * square for size, square in zip(sizes, self.squares, strict=True)
        )
        inverse = np.linalg.inv(covariance)
        weights = inverse.sum(axis=0)
        logarithm = float(np.linalg.slogdet(covariance)[1] + np.log(weights.sum()))
        return inverse - np.outer(weights, weights) / weights.sum(), logarithm

    def deviance(self, sizes: Array) -> tuple[float, Array]:
        """−2 log likelihood, and its derivative by each size."""
        projection, logarithm = self.projection(sizes)
        residual = projection @ self.values
        by_variance = [
            np.sum(projection * square) - residual @ square @ residual for square in self.squares
        ]
        return float(self.values @ residual + logarithm), 2 * sizes * np.array(by_variance)

    def largest(self, kept: tuple[int, float] | None = None) -> tuple[Array, float]:
        """The sizes of smallest deviance, one of them `kept` where it is given."""
        count = len(self.squares)
        bounds = [(0.0, MAX_SPREADS)] * count
        if kept is not None:
            bounds[kept[0]] = (kept[1], kept[1])
        fits = [
            minimize(
                self.deviance,
                np.clip(np.full(count, start), *np.transpose(bounds)),
                jac=True,
                method="L-BFGS-B",
                bounds=bounds,
            )
            for start in STARTS
        ]
        best = min(fits, key=lambda fit: float(fit.fun))
        return np.asarray(best.x), float(best.fun)

    def sigmas(self, sizes: Array) -> Array:
        """Of each size by the expected information of the variances; NaN at zero."""
        inside = [i for i, size in enumerate(sizes) if size > 0]
        result = np.full(len(sizes), np.nan)
        if not inside:
            return result
        projection, _logarithm = self.projection(sizes)
        scaled = [projection @ self.squares[i] for i in inside]
        information = np.array([[np.sum(a * b.T) / 2 for a in scaled] for b in scaled])
        variance = np.diagonal(np.linalg.pinv(information))
        result[inside] = np.sqrt(variance) / (2 * sizes[inside])
        return result

    def upper(self, i: int, best: Array, smallest: float) -> float:
        """The size above the best at which the profile of the deviance has risen to the limit."""

        def rise(size: float) -> float:
            return self.largest((i, size))[1] - smallest - ONE_SIDED

        low = float(best[i])
        high = max(2 * low, 0.1)
        while rise(high) < 0:
            if high > MAX_SPREADS / 4:
                return float("inf")
            low, high = high, 4 * high
        return float(brentq(rise, low, high, rtol=1e-3))
