"""Ripples of a turntable: oscillations periodic in its angle."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import pinvh
from scipy.ndimage import median_filter
from scipy.optimize import minimize_scalar

from inertial.arrays import Array
from inertial.estimation.probability import chi2_isf, f_sf
from inertial.estimation.spectrum import WHITE, NoiseShape

ORDER_STEP = 0.25  # of the search; finer where the turns together are longer than two
MIN_PERIODS = 8.0  # in a turn; with fewer, bias and slope are not orthogonal to a line
MIN_REMAINING_SHARE = 1e-4  # of a shape after removal of bias, slope and gravity's harmonics
GRAVITY_ORDERS = (1.0, 2.0)  # at which gravity and the earth's rate act in tilted turns
WHITE_FROM = 0.5  # Hz, below which noise is not known to be white; as in its estimate
NEIGHBOURS = 129  # orders of the grid whose median is the level of an order
MIN_SEPARATION = 1.5  # periods, between an order and others that are independent of a line there
MIN_DETECTION_SIGMAS = 5.0
MIN_ORDER_WITH_NEIGHBOURS = 4.0  # from which there are enough of them for a level
STEPS_PER_PERIOD = 4.0  # of all turns together, in the search for a peak
MAX_ORDER_SHIFT = 0.5  # bins between an order in the search and refined
MIN_CHANCE_COMMON = 1e-3  # of turns that differ by more than noise
MAX_OWN_SHARE = 0.02  # of the energy, that the turns' own amplitudes add where they are the same


@dataclass(frozen=True)
class Course:
    """The residual rate in one direction over the steady part of one turn.

    A table whose angle is θ + a sin nθ + b cos nθ, rad, turns at

        θ' + n θ' (a cos nθ − b sin nθ),

    so in each turn with an amplitude proportional to the rate, and backward with opposite sign. θ
    is counted from the start of the turn. The sums over all turns are coherent: one a and one b.

    record : (n,), rad/s; angle : (n,), rad, signed, at the middle of each sample, evenly spaced
    rate : rad/s, signed; step : s, of a sample; averaged : whether a sample is a mean over it
    sigma : rad/s, noise of a sample, where its `shape` is 1; tilted : whether gravity rotates in
        body axes
    """

    record: Array
    angle: Array
    rate: float
    step: float
    averaged: bool
    sigma: float
    tilted: bool = False
    shape: NoiseShape = WHITE

    def noise(self, order: Array | float) -> Array:
        """Noise of a sample if it were white, and everywhere as at an order, rad/s."""
        return np.asarray(
            self.sigma * self.shape.at(np.asarray(order) * abs(self.rate) / 2 / np.pi)
        )

    @property
    def turned(self) -> float:
        """Its length in whole turns."""
        return abs(self.rate) * self.step * len(self.record) / (2 * np.pi)

    @property
    def highest(self) -> float:
        """The order of half the sample rate."""
        return float(np.pi / (abs(self.rate) * self.step))

    @cached_property
    def slow(self) -> Array:
        """Bias, slope and gravity's harmonics, (n, 2) or (n, 6), orthonormal."""
        columns = [np.ones_like(self.angle), self.angle - self.angle.mean()]
        for order in GRAVITY_ORDERS if self.tilted else ():
            columns += [np.cos(order * self.angle), np.sin(order * self.angle)]
        return np.asarray(np.linalg.qr(np.column_stack(columns))[0])

    @cached_property
    def rest(self) -> Array:
        """The record less its slow part, (n,)."""
        return self.less_slow(self.record)

    def less_slow(self, columns: Array) -> Array:
        """Columns less their projection on bias, slope and gravity's harmonics."""
        return np.asarray(columns - self.slow @ (self.slow.T @ columns))

    def gain(self, order: Array) -> Array:
        """Amplitude of the rate for an angle of 1 rad, rad/s; beyond `highest` that of an alias."""
        share = np.sinc(order / (2 * self.highest)) if self.averaged else 1.0
        return np.asarray(order * self.rate * share)

    def shapes(self, order: float) -> Array:
        """The rates for a and b of 1 rad, (n, 2), rad/s."""
        turned = order * self.angle
        gain = float(self.gain(np.asarray(order)))
        return np.column_stack([gain * np.cos(turned), -gain * np.sin(turned)])

    def normal_equations(self, order: float) -> tuple[Array, Array]:
        """Information of a and b, (2, 2), and its product with their estimates, (2,)."""
        shapes = self.shapes(order)
        remainder = self.less_slow(shapes)
        if np.sum(remainder**2) <= MIN_REMAINING_SHARE * np.sum(shapes**2):
            return np.zeros((2, 2)), np.zeros(2)
        variance = float(self.noise(order)) ** 2
        return remainder.T @ remainder / variance, remainder.T @ self.rest / variance


@dataclass(frozen=True)
class Orders:
    """The turns together at each order, (m,) each.

    drop : of chi-squared by one a and one b, two degrees of freedom
    own : (k, m), drop in each turn with an a and b of its own; zero without information
    sigma : rad, of a and b; hertz : (k, m), the frequency in each turn
    """

    order: Array
    drop: Array
    own: Array
    sigma: Array
    hertz: Array

    @cached_property
    def turns(self) -> Array:
        """The number of turns with information."""
        return np.asarray((self.own > 0).sum(axis=0))

    @cached_property
    def apart(self) -> Array:
        """Further drop with an own a and b for each turn."""
        return np.asarray(np.maximum(self.own.sum(axis=0) - self.drop, 0.0))


def span(courses: Sequence[Course]) -> float:
    """Whole turns between the least and the largest angle."""
    ends = [edge for course in courses for edge in (course.angle[0], course.angle[-1])]
    return float(max(ends) - min(ends)) / (2 * np.pi)


def grid(courses: Sequence[Course]) -> Array:
    """The orders of the search: from 1 up to half the sample rate of the slowest turn."""
    step = ORDER_STEP / max(np.ceil(span(courses) / 2 - 0.05), 1.0)
    return np.asarray(np.arange(1.0, max(course.highest for course in courses), step))


def search(courses: Sequence[Course]) -> Orders:
    """Every order of the grid."""
    orders = grid(courses)
    shortest = min(course.turned for course in courses)
    few = int(np.searchsorted(orders, MIN_PERIODS / shortest))
    information = np.zeros((len(courses), len(orders), 2, 2))
    product = np.zeros((len(courses), len(orders), 2))
    for i, course in enumerate(courses):
        for j in np.flatnonzero(orders[:few] < course.highest).tolist():
            information[i, j], product[i, j] = course.normal_equations(float(orders[j]))
        resolved = orders[few:] < course.highest
        noise = course.noise(orders[few:])
        gain = np.where(resolved, course.gain(orders[few:]), 0.0) / noise
        turned = gain * _transform(course, orders[few:]) / noise
        information[i, few:] = (len(course.record) * gain**2 / 2)[:, None, None] * np.eye(2)
        product[i, few:] = np.stack([turned.real, turned.imag], axis=-1)
    drop, inverse = _dropped(information.sum(axis=0), product.sum(axis=0))
    each, _ = _dropped(information, product)
    rates = np.array([abs(course.rate) for course in courses])
    return Orders(
        orders,
        drop,
        each,
        np.sqrt(np.maximum(inverse[:, 0, 0], inverse[:, 1, 1])),
        np.outer(rates, orders) / (2 * np.pi),
    )


def _transform(course: Course, orders: Array) -> NDArray[np.complex128]:
    """Σ y exp(−i n θ) at evenly spaced orders, by the chirp z-transform."""
    from scipy.signal import czt  # here, for it loads half of scipy

    if len(orders) == 0:
        return np.zeros(0, np.complex128)
    pace = course.rate * course.step
    space = orders[1] - orders[0] if len(orders) > 1 else 1.0
    summed = czt(
        course.rest, len(orders), np.exp(-1j * space * pace), np.exp(1j * orders[0] * pace)
    )
    return np.asarray(summed * np.exp(-1j * orders * course.angle[0]))


def _dropped(information: Array, product: Array) -> tuple[Array, Array]:
    """v' G⁻¹ v and G⁻¹ of G (…, 2, 2) and v (…, 2); zero and infinity for singular G."""
    observable = np.linalg.det(information) > 0
    safe = np.where(observable[..., None, None], information, np.eye(2))
    inverse = np.linalg.inv(safe)
    drop = np.einsum("...i,...ij,...j->...", product, inverse, product)
    inverse[~observable] = np.inf
    return np.where(observable, drop, 0.0), inverse


def log_chance(spectrum: Orders, turned: float) -> Array:
    """Natural logarithm of the p-value of each order's drop, (m,), without the search.

    For white noise the drop of chi-squared is exponentially distributed, 2 degrees of freedom.
    There are two exceptions. In a hump of the spectrum the level is that of the neighbouring
    orders, all turns by themselves. And below `WHITE_FROM` the noise is not known to be white:
    there it is estimated from the differences between turns and from the neighbouring orders, with
    an F-test. A line common to all turns is not caused by noise that differs from turn to turn.

    turned : length of a record in whole turns, which sets the separation of independent orders.
    """
    turns = np.maximum(spectrum.turns, 1)
    each = spectrum.drop + spectrum.apart
    level = median_filter(each / (2 * turns), NEIGHBOURS, mode="nearest")
    level /= chi2_isf(0.5, 2 * turns) / (2 * turns)
    chance = -spectrum.drop / 2 / np.maximum(level, 1.0)
    for i in _slow(spectrum):
        degrees, chi_squared = _noise_by_turns(spectrum, i, turned)
        ratio = spectrum.drop[i] / 2 / max(chi_squared / max(degrees, 1.0), 1.0)
        by_turns = -degrees / 2 * np.log1p(2 * ratio / degrees) if degrees else 0.0
        chance[i] = max(-spectrum.drop[i] / 2, by_turns)
    return np.asarray(np.where(spectrum.turns > 0, chance, 0.0))


def log_chance_of_own(spectrum: Orders, leaked: Array, turned: float) -> tuple[Array, Array]:
    """Drop with an a and b of each turn's own, (m,), and the logarithm of its p-value.

    For no one knows how the amplitude of a ripple goes with the rate, nor from which tooth of a
    gear a turn starts. Only turns count in which the frequency is not below `WHITE_FROM`. The level
    is the mean of the orders from half to twice, but for those that are not independent of a line:
    so what drifts is no line; an F-test.

    leaked : (k, m), what may remain in each turn of lines that were removed; turned : as in
    `log_chance`
    """
    white = (spectrum.hertz >= WHITE_FROM) & (spectrum.own > 0)
    drop = np.where(white, np.maximum(spectrum.own - leaked, 0.0), 0.0).sum(axis=0)
    turns = white.sum(axis=0)
    place = np.arange(len(drop))
    step = float(spectrum.order[1] - spectrum.order[0])
    apart, near = max(1 / turned / step, 1.0), round(MIN_SEPARATION / turned / step)

    def around(values: Array) -> Array:
        summed = np.append(0.0, np.cumsum(values))
        low = np.searchsorted(spectrum.order, spectrum.order / 2)
        high = np.searchsorted(spectrum.order, spectrum.order * 2, side="right")
        of_line = np.maximum(place - near, low), np.minimum(place + near + 1, high)
        whole = summed[high] - summed[low]
        return np.asarray(whole - (summed[of_line[1]] - summed[of_line[0]]))

    degrees = np.maximum(around(2.0 * turns), 1.0)
    level = around(np.where(white, spectrum.own, 0.0).sum(axis=0)) / degrees
    ratio = drop / np.maximum(2 * turns, 1) / np.maximum(level, 1.0)
    with np.errstate(divide="ignore"):
        chance = np.log(f_sf(ratio, 2 * np.maximum(turns, 1), np.maximum(degrees / apart, 1.0)))
    return drop, np.asarray(np.where(turns > 0, chance, 0.0))


def _slow(spectrum: Orders) -> list[int]:
    """The orders that are slower in every turn than white noise is known."""
    highest = np.where(spectrum.own > 0, spectrum.hertz, 0.0).max(axis=0)
    return [int(i) for i in np.flatnonzero(highest < WHITE_FROM)]


def detection_limit(spectrum: Orders, turned: float, level: float) -> Array:
    """Detection limit of an order in sigmas, (m,): 5, or that of its F-test at `level`.

    Infinite without an estimate of the noise: for a slow ripple in one turn.
    """
    limits = np.where(spectrum.turns > 0, MIN_DETECTION_SIGMAS, np.inf)
    for i in _slow(spectrum):
        degrees, _ = _noise_by_turns(spectrum, i, turned)
        limit = np.sqrt(degrees * (level ** (-2 / degrees) - 1)) if degrees else np.inf
        limits[i] = max(limits[i], limit)
    return np.asarray(limits)


def _noise_by_turns(spectrum: Orders, i: int, turned: float) -> tuple[float, float]:
    """Degrees of freedom of the noise estimate at an order, and their chi-squared."""
    degrees, chi_squared = 2.0 * max(spectrum.turns[i] - 1, 0), float(spectrum.apart[i])
    if spectrum.order[i] >= MIN_ORDER_WITH_NEIGHBOURS:
        around = _around(spectrum.order, i, turned)
        degrees += 2.0 * float(spectrum.turns[around].sum())
        chi_squared += float((spectrum.drop + spectrum.apart)[around].sum())
    return degrees, chi_squared


def _around(order: Array, i: int, turned: float) -> list[int]:
    """Orders from half to twice one, one period of the record apart from it and each other."""
    step = float(order[1] - order[0])
    apart = max(round(1 / turned / step), 1)
    first = max(round(MIN_SEPARATION / turned / step), 1)
    places = [*range(i - first, -1, -apart), *range(i + first, len(order), apart)]
    return [j for j in places if order[i] / 2 <= order[j] <= 2 * order[i]]


@dataclass(frozen=True)
class Ripple:
    """One order over all turns: a and b, rad, with their covariance and that of the order.

    own : (k, 2), a and b of each turn by itself, NaN without information; power : (k,), the
    squared signal-to-noise ratio of each turn for an angle of 1 rad; drop : of chi-squared by one
    a and b; apart : further drop by those of each turn.
    """

    order: float
    order_sigma: float  # 0 where it was not free
    values: Array
    covariance: Array
    drop: float
    apart: float
    own: Array
    power: Array

    @property
    def turns(self) -> int:
        """The number of turns with information."""
        return int(np.isfinite(self.own).all(axis=1).sum())

    @property
    def common(self) -> bool:
        """Whether one a and b explain all turns, to within noise or a small share."""
        others = self.turns - 1
        by_noise = float(chi2_isf(MIN_CHANCE_COMMON, 2 * others)) if others > 0 else 0.0
        return self.apart <= by_noise + MAX_OWN_SHARE * self.drop

    @property
    def amplitude(self) -> float:
        """√(a² + b²), rad; where each turn has its own, their root mean square without noise."""
        if self.common:
            return float(np.linalg.norm(self.values))
        return float(np.sqrt((self.drop + self.apart - 2 * self.turns) / self.power.sum()))

    @property
    def amplitude_sigma(self) -> float:
        """Its standard deviation, rad."""
        if not self.common:
            return float(self.power.sum() ** -0.5)
        along = self.values / self.amplitude
        return float(np.sqrt(along @ self.covariance @ along))


def fitted(courses: Sequence[Course], near: float, width: float) -> Ripple:
    """The order within `width` of `near` with the largest drop; for width 0 that order itself."""
    order = near
    if width:
        order = _best(courses, near, width)
    drop, values, information = _coherent(courses, order)
    own, power, each = [], [], 0.0
    for course in courses:
        matrix, product = course.normal_equations(order)
        observable = np.linalg.det(matrix) > 0
        own.append(np.linalg.solve(matrix, product) if observable else np.full(2, np.nan))
        power.append(float(np.trace(matrix)) / 2)
        each += float(product @ own[-1]) if observable else 0.0
    covariance, order_sigma = np.asarray(np.linalg.pinv(information)), 0.0
    if width:
        covariance, order_sigma = _with_order(courses, order, values)
    return Ripple(
        order,
        order_sigma,
        values,
        covariance,
        drop,
        max(each - drop, 0.0),
        np.array(own),
        np.array(power),
    )


def ripple_of(courses: Sequence[Course], order: float) -> Ripple:
    """The ripple near an order: one a and b where they explain all turns, else each its own.

    The sigma of the order is then that of the frequencies of the turns, Rife & Boorstyn (1974).
    """
    common = fitted(courses, order, MAX_ORDER_SHIFT / max(course.turned for course in courses))
    if common.common:
        return common
    each = fitted(courses, order, 0.0)
    turned = np.array([2 * np.pi * course.turned for course in courses])
    drops = np.nan_to_num(each.power * np.sum(each.own**2, axis=1))
    return replace(each, order_sigma=float(np.sqrt(12 / np.sum(drops * turned**2))))


def _best(courses: Sequence[Course], near: float, width: float) -> float:
    """The order with the largest drop; where several turns follow each other it has many peaks."""
    apart = 1 / (STEPS_PER_PERIOD * span(courses))
    tried = near + apart * np.arange(-np.ceil(width / apart), np.ceil(width / apart) + 1)
    tried = tried[tried > apart]
    best = float(tried[np.argmax([_coherent(courses, float(n))[0] for n in tried])])
    minimum = minimize_scalar(
        lambda n: -_coherent(courses, n)[0],
        bounds=(best - apart, best + apart),
        method="bounded",
        options={"xatol": 1e-5 * apart},
    )
    return float(minimum.x)


def _coherent(courses: Sequence[Course], order: float) -> tuple[float, Array, Array]:
    """Drop of chi-squared, a and b, and their information."""
    equations = [course.normal_equations(order) for course in courses]
    information = np.sum([matrix for matrix, _ in equations], axis=0)
    product = np.sum([vector for _, vector in equations], axis=0)
    values = pinvh(information) @ product
    return float(product @ values), values, information


def _with_order(courses: Sequence[Course], order: float, values: Array) -> tuple[Array, float]:
    """Covariance of a and b where the order is an unknown too, and the sigma of the order."""
    information = np.zeros((3, 3))
    small = 1e-6 * order
    for course in courses:
        change = (
            (course.shapes(order + small) - course.shapes(order - small)) @ values / (2 * small)
        )
        columns = course.less_slow(np.column_stack([course.shapes(order), change]))
        columns /= course.noise(order)
        information += columns.T @ columns
    # The order and the angles differ in size by powers of ten.
    size = np.sqrt(np.diag(information))
    covariance = np.linalg.pinv(information / np.outer(size, size)) / np.outer(size, size)
    return covariance[:2, :2], float(np.sqrt(covariance[2, 2]))
