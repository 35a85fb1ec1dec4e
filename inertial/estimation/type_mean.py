"""The mean of tables that differ by a spread which few of them tell.

    y_t = μ + u_t + e_t,    u ~ N(0, θ I),  e ~ N(0, A)

With two tables the spread has one degree of freedom: its likeliest value is often zero, and a mean
that takes it for true is too sure. Here μ is averaged over the θ that the y leave possible. At the
true θ

    Q(θ) = min_μ (y - μ)ᵀ (A + θ I)⁻¹ (y - μ)

is chi-squared with one degree less than there are tables, so that the probability of a larger Q is
a cumulative distribution of θ (Viechtbauer 2007, Statist. Med. 26, 37), with what is left at zero.
No prior is in it. The interval of μ is a generalised confidence interval (Weerahandi 1993, JASA 88,
899; Iyer, Wang & Mathew 2004, JASA 99, 1060), for equal tables that of Behrens and Fisher.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from inertial.arrays import Array
from inertial.estimation.probability import chi2_sf, t_isf, t_sf

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
