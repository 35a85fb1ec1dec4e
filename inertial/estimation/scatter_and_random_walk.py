"""Differences between stretches beyond noise: scatter and random walk by restricted likelihood.

Unmodelled effects make every stretch (a static position, a rate segment) differ from the others by
more than the noise, and sigmas of noise alone would be too small. A scatter is an offset N(0,
scatter²) of each stretch, independent of all others. A random walk moves the bias further the more
time passes. The size of each is that of largest restricted likelihood (REML, Patterson & Thompson
1971), and each is included only if the deviance, −2 log likelihood, decreases by
`MIN_DEVIANCE_DROP`: effects are sought beside no more than the data show. But the sigmas of
positions by hand contain a scatter that no test shows, too: one as large as the noise of a position
is not found in half of the sessions of 20 positions. Stretches near in time are often alike for
other reasons: at the same position or attitude, so that a sensor that responds to gravity resembles
a random walk of its bias; and so does a steady drift. Where one of these alternatives is clearly
more likely there is no random walk, and the stretches have a scatter.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq, minimize, minimize_scalar
from scipy.special import ndtri, stdtrit

from inertial.arrays import Array
from inertial.estimation.least_squares import Estimate
from inertial.estimation.probability import f_sf
from inertial.estimation.random_walk import COMMON_CLOCK, Stretch

# ---- By what the bias of a sensor differs from one switch-on to the next, within one campaign.
#
# The bias of each part of the campaign that lies between two switch-ons is one of q independent
# deviations d ~ N(0, τ²) from a common one. All other unknowns eliminated, the equations say N d =
# r. With the eigenvalues λ and vectors V of N and s = Vᵀ r, −2 log of the restricted likelihood is
#
#     Σ log(1 + τ² λ) − Σ τ² s² / (1 + τ² λ),
#
# and the expected information of τ² is ½ Σ λ²/(1 + τ² λ)² (Patterson & Thompson 1971; Searle,
# Casella & McCulloch 1992). One eigenvalue is 0, for a common deviation is the bias: so q − 1 are
# free.
#
# τ of few switch-ons is not well known, so a bias is off by Student's distribution of q − 1
# degrees. The covariance gets the normal one with the same interval of 95 % (GUM G.3).

TWO_SIDED = 0.975  # quantile at the end of an interval of 95 %
ONE_SIDED = 2.706  # rise of the deviance at the one-sided limit of 95 %
NO_INFORMATION = 1e-9  # relative to the largest eigenvalue
# Of the variance that is sought, relative to the smallest and the largest of the deviations: some
# combinations are known a million times better than others, where few positions lie between two.
RANGE = (1e-8, 1e4)


@dataclass(frozen=True, eq=False)
class SwitchOns:
    """Of each axis, (3,), unit of the readings; NaN where it is not recorded.

    `count`: of switch-ons; `value`: standard deviation between them; `sigma`: of that, NaN where 0
    is the likeliest; `upper`: one-sided 95 %.
    """

    count: int
    value: Array
    sigma: Array
    upper: Array

    @property
    def covering(self) -> Array:
        """The standard deviation in the covariance, (3,); 0 where none is known."""
        return covering(self.value, self.count)


def covering(value: Array, count: int) -> Array:
    """The normal standard deviation whose interval of 95 % is that of Student's distribution."""
    return np.nan_to_num(value) * float(stdtrit(count - 1, TWO_SIDED) / ndtri(TWO_SIDED))


def between(information: Array, right: Array) -> tuple[float, float, float]:
    """The standard deviation of q biases, its sigma and upper limit; N, (q, q), and r, (q,)."""
    values, vectors = np.linalg.eigh(information)
    there = values > NO_INFORMATION * max(float(values[-1]), 0.0)
    if not there.any():
        return np.nan, np.nan, np.nan
    values, squares = values[there], (vectors.T @ right)[there] ** 2

    def deviance(variance: float) -> float:
        grown = 1 + variance * values
        return float(np.sum(np.log(grown)) - np.sum(variance * squares / grown))

    sizes = squares / values**2 + 1 / values
    low, high = np.log(RANGE[0] * sizes.min()), np.log(RANGE[1] * sizes.max())
    found = minimize_scalar(lambda x: deviance(np.exp(x)), bounds=(low, high), method="bounded")
    best = float(np.exp(found.x)) if found.fun < 0 and found.x > low + 1 else 0.0

    def rise(x: float) -> float:
        return deviance(np.exp(x)) - deviance(best) - ONE_SIDED

    start = np.log(best) if best else low
    upper = float(np.exp(brentq(rise, start, high) / 2)) if rise(high) > 0 else np.inf
    information_of_variance = 0.5 * float(np.sum((values / (1 + best * values)) ** 2))
    sigma = 1 / np.sqrt(information_of_variance) / (2 * np.sqrt(best)) if best else np.nan
    return float(np.sqrt(best)), float(sigma), upper


# ---- Scatter and random walk by restricted likelihood.

Deviance = Callable[[float], float]  # as a function of one size

MIN_CONSISTENT_P_VALUE = 0.01  # below it the residuals are larger than the noise
MIN_DEVIANCE_DROP = 6.6  # for a further variance: 1 % of chi-squared of 1 degree of freedom
MAX_DEVIANCE_RISE = 20.0  # above the smallest so far: where the search for the scatter ends
MAX_GRID_LOSS = 3.0  # of the deviance: the minimum is at most so far below that of the grid
GRID_RATIO = 4.0  # of one size to the next in the search for the largest likelihood
SIZE_TOLERANCE = 0.05  # relative, of a size at the largest likelihood
CURVATURE_STEP = 0.2  # relative change of a size, for the curvature of the likelihood
MIN_SIZE, MAX_SIZE = 0.1, 1e3  # in units of the noise of a stretch
MIN_STRETCHES = 4  # for a random walk


@dataclass(frozen=True)
class ScatterFit:
    """An estimate with its variance components, and the p-value of the fit with noise alone.

    `scatter`, in the unit of the readings; `scatter_seconds`: of the rest that has it, where it is
    the less the longer a rest is, None where all have it; `random_walk`: of the bias, per √s, and
    its sigma; `switch_ons`: what biases differ by between them, None where the sensor ran on.
    """

    estimate: Estimate
    scatter: float
    p_value: float
    random_walk: float = 0.0
    random_walk_sigma: float = 0.0
    switch_ons: SwitchOns | None = None
    scatter_seconds: float | None = None


@dataclass(frozen=True)
class Deviances:
    """The deviance as a function of a scatter alone, of a random walk alone, and of both."""

    of_scatter: Deviance
    of_walk: Deviance
    of_both: Callable[[float, float], float]


def with_scatter(
    fit: Callable[[float], Estimate],
    between: tuple[float, float],
    noise_degrees: float,
    deviance: Deviance | None = None,
    *,
    tested: bool = True,
) -> ScatterFit:
    """The fit with a scatter where noise alone cannot explain the residuals.

    Of several local maxima of the restricted likelihood the smallest scatter is taken: with a
    larger one nothing may be common to the stretches any more, and any parameters would fit.

    Parameters
    ----------
    fit : the estimate as a function of the scatter
    between : smallest and largest scatter, in the unit of the readings
    noise_degrees : see `Estimate.p_value`
    deviance : of the estimate, as a function of the scatter, where there is a shorter way to it
    tested : else with the likeliest scatter, which may be 0, be it significant or not
    """
    deviance = deviance or (lambda scatter: fit(scatter).deviance)
    noise_only = fit(0.0)
    p_value = noise_only.p_value(noise_degrees)
    if tested and p_value >= MIN_CONSISTENT_P_VALUE:
        return ScatterFit(noise_only, 0.0, p_value)

    grid = _grid(between)
    deviances: list[float] = []
    for size in grid:
        deviances.append(deviance(float(np.exp(size))))
        if deviances[-1] > min(deviances) + MAX_DEVIANCE_RISE:
            break
    scatter, smallest = _minimum(deviance, grid, int(np.argmin(deviances)))
    if deviance(0.0) - smallest < (MIN_DEVIANCE_DROP if tested else 0.0):
        return ScatterFit(noise_only, 0.0, p_value)
    return ScatterFit(fit(scatter), scatter, p_value)


@dataclass(frozen=True)
class WalkSearch:
    """Where a random walk is searched for, from the times of the stretches.

    `noise`: of the mean reading of a stretch; `span`: s from first to last; `common_clock`: whether
    all times are of one clock; `largest`: random walk, per √s: more, as by hand, is a scatter.
    """

    noise: float
    span: float
    common_clock: bool
    largest: float = np.inf

    @property
    def bounds(self) -> tuple[float, float]:
        """Smallest and largest random walk, per √s."""
        unit = self.noise / float(np.sqrt(self.span))
        return MIN_SIZE * unit, max(min(MAX_SIZE * unit, self.largest), 2 * MIN_SIZE * unit)


def walk_search(stretches: Sequence[Stretch], noise: float, largest: float) -> WalkSearch | None:
    """None where too few stretches have times; `noise`, `largest` as in `WalkSearch`."""
    timed = [stretch for stretch in stretches if np.isfinite(stretch.end)]
    if len(timed) < MIN_STRETCHES or not noise > 0:
        return None
    span = max(stretch.end for stretch in timed) - min(stretch.start for stretch in timed)
    common = all(stretch.clock == COMMON_CLOCK for stretch in timed)
    return WalkSearch(noise, span, common, largest)


def with_random_walk(
    fit: Callable[[float, float], Estimate],
    likely: Deviances,
    between: tuple[float, float],
    search: WalkSearch | None,
    alternatives: Sequence[Deviance],
    noise_degrees: float,
) -> ScatterFit:
    """The fit with the scatter and the random walk of largest restricted likelihood.

    Parameters
    ----------
    fit : the estimate as a function of both; `likely`: its deviance
    between : smallest and largest scatter, in the unit of the readings
    search : None where the times are not known: then no random walk
    alternatives : deviance by the size of other differences that resemble a random walk
    noise_degrees : see `Estimate.p_value`
    """
    scattered = with_scatter(
        lambda scatter: fit(scatter, 0.0), between, noise_degrees, likely.of_scatter
    )
    if search is None:
        return scattered
    noise_only = likely.of_scatter(0.0)
    walk, deviance = most_likely(likely.of_walk, search.bounds, noise_only)
    if noise_only - deviance < MIN_DEVIANCE_DROP:
        return scattered
    # Without a common clock the times from log to log are unknown, and little distinguishes a
    # random walk from the alternatives: then it must be clearly more likely than all of them.
    margin = -MIN_DEVIANCE_DROP if search.common_clock else MIN_DEVIANCE_DROP
    sizes = (MIN_SIZE * search.noise, MAX_SIZE * search.noise)
    scatter, scatter_deviance = most_likely(likely.of_scatter, sizes, np.inf)
    others = [most_likely(alternative, sizes, np.inf)[1] for alternative in alternatives]
    if min(scatter_deviance, *others) - margin < deviance:
        if scattered.scatter or noise_only - scatter_deviance < MIN_DEVIANCE_DROP:
            return scattered
        return replace(scattered, estimate=fit(scatter, 0.0), scatter=scatter)
    scatter, walk = _joint_maximum(
        likely.of_both, (scattered.scatter or search.noise, walk), deviance
    )
    return replace(
        scattered,
        estimate=fit(scatter, walk),
        scatter=scatter,
        random_walk=walk,
        random_walk_sigma=_random_walk_sigma(likely, scatter, walk),
    )


def most_likely(
    deviance: Deviance, bounds: tuple[float, float], noise_only: float
) -> tuple[float, float]:
    """The size of smallest deviance, and that deviance.

    Only to the next grid point where `noise_only`, the deviance without, is about as small.
    """
    grid = _grid(bounds)
    deviances = [deviance(float(np.exp(size))) for size in grid]
    best = int(np.argmin(deviances))
    if noise_only - deviances[best] < MIN_DEVIANCE_DROP - MAX_GRID_LOSS:
        return float(np.exp(grid[best])), deviances[best]
    return _minimum(deviance, grid, best)


def _grid(bounds: tuple[float, float]) -> Array:
    """Natural logarithms of the sizes that are tried."""
    low, high = np.log(bounds)
    return np.linspace(low, high, int(np.ceil((high - low) / np.log(GRID_RATIO))) + 1)


def _minimum(deviance: Deviance, grid: Array, best: int) -> tuple[float, float]:
    """The size of smallest deviance next to a grid point, and that deviance."""
    minimum = minimize_scalar(
        lambda size: deviance(float(np.exp(size))),
        bounds=(grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]),
        method="bounded",
        options={"xatol": SIZE_TOLERANCE},
    )
    return float(np.exp(minimum.x)), float(minimum.fun)


def sigma_of(deviance: Deviance, size: float) -> float:
    """The sigma of a size by the curvature of its likelihood."""
    factors = np.exp(CURVATURE_STEP * np.array([-1, 0, 1]))
    below, here, above = (deviance(size * float(factor)) for factor in factors)
    curvature = (above - 2 * here + below) / CURVATURE_STEP**2
    return size * float(np.sqrt(2 / curvature)) if curvature > 0 else float("nan")


def _joint_maximum(
    of_both: Callable[[float, float], float], start: tuple[float, float], deviance: float
) -> tuple[float, float]:
    """Scatter and random walk of largest likelihood; no scatter unless it adds to that."""

    def joint(sizes: Array) -> float:
        return of_both(float(np.exp(sizes[0])), float(np.exp(sizes[1])))

    first = np.log(np.array(start))
    if deviance - joint(first) < -MIN_DEVIANCE_DROP:
        return 0.0, start[1]
    minimum = minimize(
        joint,
        first,
        method="Nelder-Mead",
        options={"xatol": SIZE_TOLERANCE, "fatol": SIZE_TOLERANCE, "maxfev": 60},
    )
    if deviance - float(minimum.fun) < MIN_DEVIANCE_DROP:
        return 0.0, start[1]
    return float(np.exp(minimum.x[0])), float(np.exp(minimum.x[1]))


def _random_walk_sigma(likely: Deviances, scatter: float, walk: float) -> float:
    """The sigma of the random walk by the curvature of the likelihood, the scatter fitted too."""
    sizes = np.array([walk, scatter] if scatter else [walk])

    def deviance(steps: Array) -> float:
        changed, *scatters = (sizes * np.exp(CURVATURE_STEP * steps)).tolist()
        return likely.of_both(scatters[0], changed) if scatters else likely.of_walk(changed)

    unit = np.eye(len(sizes))
    curvature = np.zeros((len(sizes), len(sizes)))
    for i, j in np.ndindex(curvature.shape):
        mixed = deviance(unit[i] + unit[j]) + deviance(-unit[i] - unit[j])
        mixed -= deviance(unit[i] - unit[j]) + deviance(unit[j] - unit[i])
        curvature[i, j] = mixed / (2 * CURVATURE_STEP) ** 2
    variance = float(2 * np.linalg.inv(curvature)[0, 0])
    return walk * float(np.sqrt(variance)) if variance > 0 else float("nan")


# ---- What rests and motions by hand differ by beyond noise.
#
# Rests differ by a rate, such as the g-sensitivity of a gyro, or by an angle: the IMU sways in the
# hand, so its mean rate is the smaller the longer it rests. So does a motion; and it may not begin
# and end exactly where the accelerometers determined the directions: an angle besides, its swing.
# Each is a variance component of the equations, by restricted likelihood. A rest, or a motion, that
# is far off all others was something else, such as a slip, a shock, or vibration: it is left out.

RATE_RANGE = (1e-8, 0.1)  # rad/s
SWING_RANGE = (1e-6, 0.3)  # rad
ROUNDS = 3  # of one after the other
SETTLED = 0.02  # relative change of a scatter
FALSE_OMISSIONS = 1e-3  # of a session in which all are alike
FITTED = (3, 9)  # parameters that rests, and motions, determine: biases, and M


@dataclass(frozen=True)
class Scatter:
    """Of rests, rad/s, where the IMU `sways` for a rest of the usual length; `swing`, rad."""

    rate: float = 0.0
    sways: bool = False
    swing: float = 0.0

    def of_rate(self, seconds: float, usual: float) -> float:
        """Of the mean rates of a rest or a motion of so many seconds, rad/s."""
        return self.rate * usual / seconds if self.sways else self.rate


def likeliest(
    fit: Callable[[Scatter], Estimate], noise_degrees: float, *, tested: bool = True
) -> tuple[ScatterFit, Scatter]:
    """The scatters of largest restricted likelihood; `fit`: the estimate as a function of them.

    `tested`: as in `with_scatter`.
    """
    found = Scatter()
    p_value = fit(found).p_value(noise_degrees)
    fitted: ScatterFit | None = None
    for _round in range(ROUNDS):
        swung = with_scatter(_swinging(fit, found), SWING_RANGE, noise_degrees, tested=tested)
        found = replace(found, swing=swung.scatter)
        fits = [
            (
                with_scatter(_resting(fit, found, sways), RATE_RANGE, noise_degrees, tested=tested),
                sways,
            )
            for sways in (False, True)
        ]
        before = fitted
        fitted, sways = min(fits, key=lambda each: each[0].estimate.deviance)
        found = replace(found, rate=fitted.scatter, sways=sways)
        if before and abs(before.scatter - fitted.scatter) <= SETTLED * fitted.scatter:
            break
    assert fitted is not None  # there is a round
    return replace(fitted, p_value=p_value), found


def _swinging(fit: Callable[[Scatter], Estimate], about: Scatter) -> Callable[[float], Estimate]:
    return lambda size: fit(replace(about, swing=size))


def _resting(
    fit: Callable[[Scatter], Estimate], about: Scatter, sways: bool
) -> Callable[[float], Estimate]:
    return lambda size: fit(replace(about, rate=size, sways=sways))


def contradicting(
    residuals: Sequence[Array], stops: Sequence[int], firsts: Sequence[int]
) -> list[int]:
    """The places of rests and motions that contradict all others, the worst first.

    The share of one in the sum of squares of its kind follows the F distribution; without those
    that are too large the next is compared with the others. Of two beside each other the worse one
    alone, for its error is in both.

    Parameters
    ----------
    residuals : in units of their sigma, of the rests `stops`, by number, and of the motions from
        the rests `firsts` to the next
    """
    rests = len(stops)
    found: list[tuple[float, int]] = []
    for fitted, first, some in zip(
        FITTED, (0, rests), (residuals[:rests], residuals[rests:]), strict=True
    ):
        squares = np.array([float(each @ each) for each in some])
        counts = np.array([len(each) for each in some])
        left = int(counts.sum()) - fitted, float(squares.sum())
        for worst in np.argsort(-squares).tolist():
            degrees, own = left[0], int(counts[worst])
            if degrees <= 2 * fitted:
                break
            others = max(left[1] - float(squares[worst]), np.finfo(float).tiny)
            ratio = float(squares[worst]) / own / others * (degrees - own)
            p_value = float(f_sf(ratio, own, degrees - own)) * len(squares)
            if p_value >= FALSE_OMISSIONS:
                break
            found.append((p_value, first + worst))
            left = degrees - own, others
    ends = [{stop} for stop in stops] + [{first, first + 1} for first in firsts]
    apart, touched = list[int](), set[int]()
    for _p_value, place in sorted(found):
        if not ends[place] & touched:
            apart.append(place)
        touched |= {stop + k for stop in ends[place] for k in (-1, 0, 1)}
    return apart
