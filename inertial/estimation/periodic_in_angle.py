"""Ripples of a turntable: oscillations periodic in its angle."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter
from scipy.optimize import minimize_scalar

from inertial.estimation.probability import chi2_isf

# ---- Ripples of a turntable: lines against its angle, with one phase in all turns.
#
# A table that is ahead of itself by a sin nθ + b cos nθ, rad, where its angle is θ turns at
#
#     θ' + n θ' (a cos nθ − b sin nθ),
#
# so in each turn with an amplitude that goes with the rate, and backward with the sign turned
# over. θ is counted from the start of the turn. The sums over all turns are coherent: one a and
# one b.

Array = NDArray[np.float64]

STEP = 0.25  # of the orders that are tried; finer where the turns together are longer than two
PERIODS = 8.0  # in a turn; with fewer bias and slope are not at right angles to a line
SHARE = 1e-4  # of a shape that bias, slope and what gravity turns leave of it, else none is seen
TIMES_OF_GRAVITY = (1.0, 2.0)  # orders at which gravity and the earth's rate act in tilted turns


@dataclass(frozen=True)
class Course:
    """The residual rate in one direction over the steady part of one turn.

    record : (n,), rad/s; angle : (n,), rad, signed, at the middle of each sample, evenly spaced
    rate : rad/s, signed; step : s, of a sample; averaged : whether a sample is a mean over it
    sigma : rad/s, white noise of a sample; tilted : whether gravity goes round in the case
    """

    record: Array
    angle: Array
    rate: float
    step: float
    averaged: bool
    sigma: float
    tilted: bool = False

    @property
    def turned(self) -> float:
        """How many whole turns it is long."""
        return abs(self.rate) * self.step * len(self.record) / (2 * np.pi)

    @property
    def highest(self) -> float:
        """The order of half the sample rate."""
        return float(np.pi / (abs(self.rate) * self.step))

    @cached_property
    def slow(self) -> Array:
        """Bias, slope and what is fixed to the laboratory, (n, 2) or (n, 6), orthonormal."""
        columns = [np.ones_like(self.angle), self.angle - self.angle.mean()]
        for order in TIMES_OF_GRAVITY if self.tilted else ():
            columns += [np.cos(order * self.angle), np.sin(order * self.angle)]
        return np.asarray(np.linalg.qr(np.column_stack(columns))[0])

    @cached_property
    def rest(self) -> Array:
        """The record less what is slow, (n,)."""
        return self.less_slow(self.record)

    def less_slow(self, columns: Array) -> Array:
        """Columns less their share of bias, slope and what is fixed to the laboratory."""
        return np.asarray(columns - self.slow @ (self.slow.T @ columns))

    def gain(self, order: Array) -> Array:
        """Amplitude of the rate for an angle of 1 rad, rad/s; zero from half the sample rate on."""
        share = np.sinc(order / (2 * self.highest)) if self.averaged else 1.0
        return np.asarray(np.where(order < self.highest, order * self.rate * share, 0.0))

    def shapes(self, order: float) -> Array:
        """What a and b of 1 rad do, (n, 2), rad/s."""
        turned = order * self.angle
        gain = float(self.gain(np.asarray(order)))
        return np.column_stack([gain * np.cos(turned), -gain * np.sin(turned)])

    def says(self, order: float) -> tuple[Array, Array]:
        """Information of a and b, (2, 2), and its product with their estimates, (2,)."""
        shapes = self.shapes(order)
        left = self.less_slow(shapes)
        if np.sum(left**2) <= SHARE * np.sum(shapes**2):
            return np.zeros((2, 2)), np.zeros(2)
        return left.T @ left / self.sigma**2, left.T @ self.rest / self.sigma**2


@dataclass(frozen=True)
class Orders:
    """What the turns together say of each order, (m,) each.

    drop : of chi-squared by one a and one b, two degrees of freedom
    apart : further drop where each turn has its own; turns : how many say something
    sigma : rad, of a and b; hertz : the highest frequency at which a turn shows it
    """

    order: Array
    drop: Array
    apart: Array
    turns: Array
    sigma: Array
    hertz: Array


def span(courses: Sequence[Course]) -> float:
    """How many whole turns lie between the least and the largest angle."""
    ends = [edge for one in courses for edge in (one.angle[0], one.angle[-1])]
    return float(max(ends) - min(ends)) / (2 * np.pi)


def grid(courses: Sequence[Course]) -> Array:
    """The orders that are tried: from 1 up to half the sample rate of the slowest turn."""
    step = STEP / max(np.ceil(span(courses) / 2 - 0.05), 1.0)
    return np.asarray(np.arange(1.0, max(one.highest for one in courses), step))


def search(courses: Sequence[Course]) -> Orders:
    """Every order of the grid."""
    orders = grid(courses)
    shortest = min(one.turned for one in courses)
    few = int(np.searchsorted(orders, PERIODS / shortest))
    information = np.zeros((len(courses), len(orders), 2, 2))
    product = np.zeros((len(courses), len(orders), 2))
    for i, one in enumerate(courses):
        for j in range(few):
            information[i, j], product[i, j] = one.says(float(orders[j]))
        gain = one.gain(orders[few:]) / one.sigma
        turned = gain * _transform(one, orders[few:]) / one.sigma
        information[i, few:] = (len(one.record) * gain**2 / 2)[:, None, None] * np.eye(2)
        product[i, few:] = np.stack([turned.real, turned.imag], axis=-1)
    drop, inverse = _dropped(information.sum(axis=0), product.sum(axis=0))
    each, _ = _dropped(information, product)
    rates = np.array([abs(one.rate) for one in courses])
    seen = information[..., 0, 0] > 0
    return Orders(
        orders,
        drop,
        np.maximum(each.sum(axis=0) - drop, 0.0),
        seen.sum(axis=0),
        np.sqrt(np.maximum(inverse[:, 0, 0], inverse[:, 1, 1])),
        orders * (rates[:, None] * seen).max(axis=0) / (2 * np.pi),
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
    """v' G⁻¹ v and G⁻¹ of G (…, 2, 2) and v (…, 2); zero and infinity where nothing is seen."""
    seen = np.linalg.det(information) > 0
    safe = np.where(seen[..., None, None], information, np.eye(2))
    inverse = np.where(seen[..., None, None], np.linalg.inv(safe), np.inf)
    drop = np.einsum("...i,...ij,...j->...", product, np.linalg.inv(safe), product)
    return np.where(seen, drop, 0.0), inverse


# ---- What noise alone brings forth in a search against the table's angle.
#
# Where the noise is white the drop of chi-squared of an order is exponentially distributed, 2
# degrees of freedom. Two things may be worse. A hump of the spectrum: the level is then that of
# the orders around, all turns by themselves. And below the band in which the noise was read
# nothing says that it is white: there the turns tell it by how they differ among themselves, and
# by the orders around, with an F-test. What is the same in all turns cannot be had from noise
# that differs from turn to turn.

WHITE_FROM = 0.5  # Hz, below which noise is not known to be white; as where it is read
AROUND = 129  # orders of the grid whose median is the level of one
APART = 1.5  # periods by which another order must differ to know nothing of a line
SUFFICES = 5.0  # sigmas: what can be seen
FROM = 4.0  # order from which the orders around are enough to tell a level


def log_chance(said: Orders, turned: float) -> Array:
    """Natural logarithm of the chance of each order's drop by noise, (m,), without the search.

    turned : whole turns that a record is long, which says how far apart orders must be.
    """
    each = said.drop + said.apart
    turns = np.maximum(said.turns, 1)
    level = median_filter(each / (2 * turns), AROUND, mode="nearest")
    level /= chi2_isf(0.5, 2 * turns) / (2 * turns)
    chance = -said.drop / 2 / np.maximum(level, 1.0)
    for i in np.flatnonzero(said.hertz < WHITE_FROM).tolist():
        degrees, left = _told_by_turns(said, i, turned)
        ratio = said.drop[i] / 2 / max(left / max(degrees, 1.0), 1.0)
        by_turns = -degrees / 2 * np.log1p(2 * ratio / degrees) if degrees else 0.0
        chance[i] = max(-said.drop[i] / 2, by_turns)
    return np.asarray(np.where(said.turns > 0, chance, 0.0))


def sigmas_seen(said: Orders, turned: float, level: float) -> Array:
    """From how many sigmas on an order is seen, (m,): 5, or what its F-test asks for at `level`.

    Infinite where nothing tells the noise: of a slow ripple in one turn.
    """
    seen = np.where(said.turns > 0, SUFFICES, np.inf)
    for i in np.flatnonzero(said.hertz < WHITE_FROM).tolist():
        degrees, _ = _told_by_turns(said, i, turned)
        asked = np.sqrt(degrees * (level ** (-2 / degrees) - 1)) if degrees else np.inf
        seen[i] = max(seen[i], asked)
    return np.asarray(seen)


def _told_by_turns(said: Orders, i: int, turned: float) -> tuple[float, float]:
    """Degrees of freedom that tell the noise at an order, and their chi-squared."""
    degrees, left = 2.0 * max(said.turns[i] - 1, 0), float(said.apart[i])
    if said.order[i] >= FROM:
        around = _around(said.order, i, turned)
        degrees += 2.0 * float(said.turns[around].sum())
        left += float((said.drop + said.apart)[around].sum())
    return degrees, left


def _around(order: Array, i: int, turned: float) -> list[int]:
    """Orders from half to twice one, one period of the record apart from it and each other."""
    step = float(order[1] - order[0])
    apart = max(round(1 / turned / step), 1)
    first = max(round(APART / turned / step), 1)
    places = [*range(i - first, -1, -apart), *range(i + first, len(order), apart)]
    return [j for j in places if order[i] / 2 <= order[j] <= 2 * order[i]]


# ---- One ripple of a turntable over all turns: its order, its a and b, with sigmas.

FINER = 4.0  # steps over a period of all turns together, in which a peak is looked for


@dataclass(frozen=True)
class Ripple:
    """One order over all turns: a and b, rad, with their covariance beside that of the order.

    own : (k, 2), a and b of each turn by itself, NaN where it shows none; power : (k,), the
    squared signal-to-noise ratio of each turn for an angle of 1 rad.
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
    def amplitude(self) -> float:
        """√(a² + b²), rad."""
        return float(np.linalg.norm(self.values))

    @property
    def amplitude_sigma(self) -> float:
        """Its standard deviation, rad."""
        along = self.values / self.amplitude
        return float(np.sqrt(along @ self.covariance @ along))

    def beyond(self, tolerance: float) -> float:
        """Chi-squared of the turns' own a and b about the common ones.

        The angle at which each turn starts is known to `tolerance`, rad, one sigma.
        """
        seen = np.isfinite(self.own).all(axis=1)
        ratio = (self.own[seen] @ [1, 1j]) / (self.values @ [1, 1j])
        power = self.power[seen] * self.amplitude**2
        turned = ratio.imag**2 / (1 + power * (self.order * tolerance) ** 2)
        return float(np.sum(power * ((ratio.real - 1) ** 2 + turned)))


def fitted(courses: Sequence[Course], near: float, width: float) -> Ripple:
    """The order within `width` of `near` that explains most; of width 0 that order itself."""
    order = near
    if width:
        order = _best(courses, near, width)
    drop, values, information = _coherent(courses, order)
    own, power, each = [], [], 0.0
    for one in courses:
        matrix, product = one.says(order)
        seen = np.linalg.det(matrix) > 0
        own.append(np.linalg.solve(matrix, product) if seen else np.full(2, np.nan))
        power.append(float(np.trace(matrix)) / 2)
        each += float(product @ own[-1]) if seen else 0.0
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


def _best(courses: Sequence[Course], near: float, width: float) -> float:
    """The order that explains most; where several turns follow each other it has many peaks."""
    apart = 1 / (FINER * span(courses))
    tried = near + apart * np.arange(-np.ceil(width / apart), np.ceil(width / apart) + 1)
    tried = tried[tried > apart]
    best = float(tried[np.argmax([_coherent(courses, float(n))[0] for n in tried])])
    found = minimize_scalar(
        lambda n: -_coherent(courses, n)[0],
        bounds=(best - apart, best + apart),
        method="bounded",
        options={"xatol": 1e-5 * apart},
    )
    return float(found.x)


def _coherent(courses: Sequence[Course], order: float) -> tuple[float, Array, Array]:
    """Drop of chi-squared, a and b, and their information."""
    said = [one.says(order) for one in courses]
    information = np.sum([matrix for matrix, _ in said], axis=0)
    product = np.sum([vector for _, vector in said], axis=0)
    values = np.linalg.pinv(information) @ product
    return float(product @ values), values, information


def _with_order(courses: Sequence[Course], order: float, values: Array) -> tuple[Array, float]:
    """Covariance of a and b where the order is an unknown too, and the sigma of the order."""
    information = np.zeros((3, 3))
    small = 1e-6 * order
    for one in courses:
        change = (one.shapes(order + small) - one.shapes(order - small)) @ values / (2 * small)
        columns = one.less_slow(np.column_stack([one.shapes(order), change])) / one.sigma
        information += columns.T @ columns
    # The order and the angles differ in size by powers of ten.
    size = np.sqrt(np.diag(information))
    covariance = np.linalg.pinv(information / np.outer(size, size)) / np.outer(size, size)
    return covariance[:2, :2], float(np.sqrt(covariance[2, 2]))
