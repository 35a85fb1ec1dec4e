"""Ripples of a turntable: lines against its angle, with one phase in all turns.

A table that is ahead of itself by a sin nθ + b cos nθ, rad, where its angle is θ turns at

    θ' + n θ' (a cos nθ − b sin nθ),

so in each turn with an amplitude that goes with the rate, and backward with the sign turned over.
θ is counted from the start of the turn. The sums over all turns are coherent: one a and one b.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.signal import czt

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
