"""One ripple of a turntable over all turns: its order, its a and b, with sigmas."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from stages.inference.orders import Course, span

Array = NDArray[np.float64]

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
