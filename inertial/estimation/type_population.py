"""The population of a type of IMU: mean, spread and correlations of its parameters, and outliers.

    x_j = μ + u_table + v_imu + w_j + e_j,    v ~ N(0, Σ),  w_j ~ N(0, Ω),  e_j ~ N(0, C_j)

with the covariance C_j that campaign j states. Spreads are of largest restricted likelihood, one
parameter at a time, see `sharing`; correlations of v by EM (Dempster, Laird & Rubin 1977) with
these spreads. An outlier is an IMU of which the others do not predict a parameter (externally
studentised residual, Cook & Weisberg 1982); the clearest is left out, the others are tried again.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.estimation.fleet_components import MIN_DEGREES, Population, population
from inertial.estimation.probability import norm_sf, t_sf

MIN_IMUS = 4  # for correlations and outliers: of less none could be significant
ROUNDS = 300  # of EM
MIN_EIGENVALUE = 1e-6  # of a correlation matrix; what is smaller is known no better
MAX_OUTLIERS_SHARE = 0.25  # of the IMUs


@dataclass(frozen=True)
class Campaigns:
    """Values (c, n), NaN where not determined, their covariances (c, n, n), and labels by level."""

    values: Array
    covariance: Array
    labels: Mapping[str, Sequence[str]]

    def some(self, kept: Booleans) -> "Campaigns":
        """Some of the campaigns."""
        labels = {
            level: [label for label, keep in zip(own, kept, strict=True) if keep]
            for level, own in self.labels.items()
        }
        return Campaigns(self.values[kept], self.covariance[kept], labels)


@dataclass(frozen=True)
class Outlier:
    """An IMU that the others do not predict.

    `parameter`: number of the parameter; `size`: by how much it differs from the mean of the
    others, in sigmas of a new IMU; `p_value`: of any IMU and parameter (Bonferroni).
    """

    imu: str
    parameter: int
    size: float
    p_value: float


@dataclass(frozen=True)
class TypePopulation:
    """What is known of a type.

    `parameters`: n, None where fewer than two campaigns have a value; `correlation`: (n, n)
    between IMUs, NaN where not known; `outliers`: left out of all numbers; `imus`: the others.
    """

    parameters: tuple[Population | None, ...]
    correlation: Array
    outliers: tuple[Outlier, ...]
    imus: int


def type_population(campaigns: Campaigns, level: float) -> TypePopulation:
    """`level`: accepted probability of calling any IMU of a population an outlier."""
    every = len(set(campaigns.labels["imu"]))
    outliers: list[Outlier] = []
    while True:
        found = _fitted(campaigns)
        imus = list(dict.fromkeys(campaigns.labels["imu"]))
        worst = None
        if len(imus) >= MIN_IMUS and len(outliers) < MAX_OUTLIERS_SHARE * every:
            worst = min(_tests(campaigns, found), key=lambda one: one.p_value, default=None)
        if worst is None or worst.p_value > level:
            correlation = _correlation(campaigns, found)
            return TypePopulation(found, correlation, tuple(outliers), len(imus))
        outliers.append(worst)
        campaigns = campaigns.some(np.array([i != worst.imu for i in campaigns.labels["imu"]]))


def _fitted(campaigns: Campaigns) -> tuple[Population | None, ...]:
    def of(number: int) -> Population | None:
        kept = np.isfinite(campaigns.values[:, number])
        if kept.sum() < 2:
            return None
        own = campaigns.some(kept)
        sigma = np.sqrt(own.covariance[:, number, number])
        return population(own.values[:, number], sigma, own.labels)

    return tuple(of(number) for number in range(campaigns.values.shape[1]))


def spread_of(found: Population) -> float:
    """The standard deviation between IMUs."""
    return float(np.sqrt(sum(s.value**2 for s in found.spreads if "imu" in s.levels)))


def of_new_imu(found: Population) -> tuple[float, float] | None:
    """Sigma of a new IMU of the type about the mean, and its degrees of freedom (Satterthwaite).

    In one campaign on one table, beside the sigma of that campaign; None for a single IMU, of
    which the spread of the type is not known. The errors of the variance S of the components and
    of that of the mean, m², have the same causes, so that they are taken to add up:

        √(2/ν) (S + m²) = √(2/ν_S) S + √(2/ν_m) m²,    ν < number of campaigns
    """
    if not any("imu" in spread.levels for spread in found.spreads):
        return None
    variance = sum(s.value**2 for s in found.spreads)
    of_mean = found.mean_sigma**2
    fewest = min((s.groups - 1 for s in found.spreads if s.value), default=found.campaigns - 1)
    degrees = fewest if np.isnan(found.mean_degrees) else found.mean_degrees
    part = variance / np.sqrt(_degrees_of_sum(found, fewest)) + of_mean / np.sqrt(degrees)
    whole = variance + of_mean
    if not part:
        return float(np.sqrt(whole)), np.inf
    return float(np.sqrt(whole)), float(min((whole / part) ** 2, found.campaigns - 1))


def _degrees_of_sum(found: Population, fewest: int) -> float:
    """Of the sum of the components, by the covariance of their estimates: 2 S² / var(S).

    `fewest`: of any component alone, where that covariance is not known.
    """
    parts = np.array([s.value**2 for s in found.spreads])
    shown = np.flatnonzero(parts > 0)
    errors = 4 * found.errors[np.ix_(shown, shown)]  # of the logarithms of the variances
    if not len(shown) or not np.isfinite(errors).all():
        return float(fewest)
    own = parts[shown]
    return float(max(2 * own.sum() ** 2 / (own @ errors @ own), MIN_DEGREES))


def _imu_means(
    campaigns: Campaigns, found: Sequence[Population | None]
) -> tuple[list[str], Array, Array]:
    """Names, information (i, n, n) and information times value about the mean (i, n) of each IMU.

    Without the parts of the tables; the campaigns' own spread is in it.
    """
    place = {imu: i for i, imu in enumerate(dict.fromkeys(campaigns.labels["imu"]))}
    names, n = list(place), campaigns.values.shape[1]
    information, score = np.zeros((len(names), n, n)), np.zeros((len(names), n))
    own = np.zeros(n)
    values = campaigns.values.copy()
    for number, fitted in enumerate(found):
        if fitted is None:
            values[:, number] = np.nan
            continue
        own[number] = sum(s.value**2 for s in fitted.spreads if s.levels == ("campaign",))
        kept = np.flatnonzero(np.isfinite(values[:, number]))
        tables = np.array(campaigns.labels["table"])[kept]
        of_table = np.unique(tables, return_inverse=True)[1]
        values[kept, number] -= fitted.mean + fitted.tables[of_table]
    for row, imu in enumerate(campaigns.labels["imu"]):
        kept = np.flatnonzero(np.isfinite(values[row]))
        block = campaigns.covariance[row][np.ix_(kept, kept)] + np.diag(own[kept])
        inverse = _inverse(block)
        information[place[imu]][np.ix_(kept, kept)] += inverse
        score[place[imu]][kept] += inverse @ values[row, kept]
    return names, information, score


def _inverse(matrix: Array) -> Array:
    """Of positive matrices (…, n, n), zero where a row is; a convention may leave them singular.

    The triads of a campaign by hand are symmetric, so their cross terms are equal in pairs.
    """
    size = np.sqrt(np.diagonal(matrix, axis1=-2, axis2=-1))
    safe = np.where(size > 0, size, 1.0)
    scale = safe[..., :, None] * safe[..., None, :]
    values, vectors = np.linalg.eigh(matrix / scale)
    kept = (1 / np.maximum(values, MIN_EIGENVALUE))[..., None, :]
    shown = (size > 0)[..., :, None] & (size > 0)[..., None, :]
    return np.where(shown, (vectors * kept) @ np.swapaxes(vectors, -1, -2) / scale, 0.0)


def _tests(campaigns: Campaigns, found: Sequence[Population | None]) -> Iterator[Outlier]:
    """Each IMU by each parameter, against the others."""
    names, information, score = _imu_means(campaigns, found)
    count = sum(fitted is not None for fitted in found) * len(names)
    for number, fitted in enumerate(found):
        if fitted is None:
            continue
        weight = information[:, number, number]
        shown = np.flatnonzero(weight > 0)
        if len(shown) < MIN_IMUS:
            continue
        # Of each IMU alone, other parameters as its own covariance has them.
        inverse = _inverse(information[shown])
        values = np.einsum("inm,im->in", inverse, score[shown])[:, number]
        between = spread_of(fitted)
        sizes, chances = _studentised(values, inverse[:, number, number], between)
        for place, size, chance in zip(shown, sizes, chances, strict=True):
            p_value = min(float(chance) * count, 1.0)
            yield Outlier(names[place], number, float(size), p_value)


def _studentised(values: Array, variance: Array, between: float) -> tuple[Array, Array]:
    """Of each value the difference from the others in sigmas, and its two-sided chance, (i,).

    `between`: known spread of the values beyond their variances, estimated from them.
    """
    whole = variance + between**2
    weights = 1 / whole
    others = weights.sum() - weights
    mean = ((weights * values).sum() - weights * values) / others
    sizes = (values - mean) / np.sqrt(whole + 1 / others)
    if not between:
        return sizes, 2 * norm_sf(np.abs(sizes))
    n = len(values)
    # The spread contains the value itself: externally studentised (Cook & Weisberg 1982).
    square = np.minimum(sizes**2 * (n - 1) / n, n - 1 - 1e-9)
    outside = np.sign(sizes) * np.sqrt(square * (n - 2) / (n - 1 - square))
    return outside, 2 * t_sf(np.abs(outside), n - 2)


def _correlation(campaigns: Campaigns, found: Sequence[Population | None]) -> Array:
    """Correlations between IMUs of the parameters that differ by more than their sigmas, (n, n)."""
    n = len(found)
    correlation = np.full((n, n), np.nan)
    names, information, score = _imu_means(campaigns, found)
    spreads = np.array([spread_of(f) if f is not None else 0.0 for f in found])
    median = np.median(np.diagonal(information, axis1=1, axis2=2), axis=0)
    shown = np.flatnonzero((spreads > 0) & (spreads**2 * median > 1))
    if len(names) < MIN_IMUS or not len(shown):
        return correlation
    scale = spreads[shown]
    own = information[:, shown[:, None], shown] * np.outer(scale, scale)
    right = score[:, shown] * scale
    sigma = np.eye(len(shown))
    for _ in range(ROUNDS):
        inverse = np.linalg.inv(sigma)
        posterior = np.linalg.inv(inverse + own)
        mean = np.einsum("inm,im->in", posterior, right)
        centred = mean - mean.mean(axis=0)
        sigma = posterior.mean(axis=0) + centred.T @ centred / (len(names) - 1)
    root = np.sqrt(np.diag(sigma))
    correlation[np.ix_(shown, shown)] = sigma / np.outer(root, root)
    return correlation
