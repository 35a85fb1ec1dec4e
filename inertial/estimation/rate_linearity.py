"""Tests of the linearity of gyros on a rate table.

    mean reading of gyro i = Kᵢ ω + bᵢ + tested term

A term that all gyros share points to the table, one of its own for each gyro to the gyros; on one
table the two cannot be separated by rate alone. Needs several rates in both directions: two rates
per gyro leave no degree of freedom, and nothing is tested.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.gyroscope_observations import Earth, SteadyRate
from inertial.estimation.horizontal_earth_rate import summed_earth_rate
from inertial.estimation.regression import NestedTest, nested_test

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

MIN_AXIS_COSINE = 1 - 1e-9  # between the axis of the table and that of the gyro


@dataclass(frozen=True)
class OwnAxis:
    """Readings of each gyro while the table turned about its own axis; n rows.

    `gyro`: (n,), 0, 1, 2; `run`: (n,), number of the run; `rate`, `mean`, `sigma`: (n,), rad/s,
    along the axis of the gyro.
    """

    gyro: Integers
    run: Integers
    rate: Array
    mean: Array
    sigma: Array

    @property
    def straight(self) -> Array:
        """The null hypothesis: a scale factor and a bias for each gyro, (n, 2 per gyro)."""
        each = self.gyro[:, None] == np.unique(self.gyro)[None, :]
        return np.hstack([each * self.rate[:, None], each.astype(np.float64)])

    def less(self, rows: Sequence[int]) -> "OwnAxis":
        """The same without some rows."""
        keep = np.delete(np.arange(len(self.rate)), rows)
        values = (self.rate[keep], self.mean[keep], self.sigma[keep])
        return OwnAxis(self.gyro[keep], self.run[keep], *values)


def own_axis(runs: Sequence[SteadyRate], earth: Earth, scatter: float = 0.0) -> OwnAxis:
    """Gather the runs about an axis of a gyro, of one mount or of several, less the earth rate.

    `scatter`, rad/s: between runs, beyond noise and rate.
    """
    rows = []
    for number, run in enumerate(runs):
        gyro = int(np.argmax(np.abs(run.about)))
        recorded = np.isfinite(run.mean[gyro]) and np.isfinite(run.sigma[gyro])
        if abs(run.about[gyro]) < MIN_AXIS_COSINE or not recorded:
            continue
        share = run.seconds / run.seconds.sum()
        earth_rate = summed_earth_rate(
            earth, run.position, run.about, run.rate * run.elapsed, share
        )
        sigma = np.sqrt(run.sigma[gyro] ** 2 + run.rate_sigma**2 + scatter**2)
        signed = run.rate * np.sign(run.about[gyro])
        rows.append((gyro, number, signed, run.mean[gyro] - earth_rate.known[gyro], sigma))
    columns = np.array(rows, dtype=np.float64).reshape(-1, 5).T
    return OwnAxis(columns[0].astype(np.int64), columns[1].astype(np.int64), *columns[2:])


def columns_of(data: OwnAxis) -> dict[str, Array]:
    """The tested terms, by name, (n, q) each.

    `cubic`: ω³, so that the scale factor changes by c ω², one c for all, s²/rad²; `cubic of each`:
    one c for each gyro; `bent`: ω|ω|, one for all, s/rad; `asymmetry`: |ω|, half of the difference
    of the scale factors forward and backward, one for all; `table`: a relative error of the table's
    rate at_rate each set rate, the same in both directions.
    """
    rate, magnitude = data.rate, np.abs(data.rate)
    each = data.gyro[:, None] == np.unique(data.gyro)[None, :]
    set_rates = np.unique(np.round(magnitude, 9))
    at_rate = np.abs(magnitude[:, None] - set_rates[None, :]) < 1e-9
    return {
        "cubic": rate[:, None] ** 3,
        "cubic of each": each * rate[:, None] ** 3,
        "bent": (rate * magnitude)[:, None],
        "asymmetry": magnitude[:, None],
        "table": at_rate * rate[:, None],
    }


def nonlinearities(data: OwnAxis) -> dict[str, NestedTest]:
    """The F test of each term, by name; what cannot be tested is absent.

    The coefficients of `table` are NaN: a relative error common to all rates is a scale factor.
    """
    tests = {
        name: nested_test(data.straight, columns, data.mean, data.sigma)
        for name, columns in columns_of(data).items()
    }
    return {name: test for name, test in tests.items() if test is not None}
