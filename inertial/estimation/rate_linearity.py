"""Whether gyros on a rate table follow a straight line, and in which way they do not.

    mean reading of gyro i = Kᵢ ω + bᵢ + what is tested

One form that all gyros share points to the table, one that each has for itself to the gyros; on one
table the two cannot be told apart by rate alone. Needs several rates both ways: two rates per gyro
leave no degree of freedom, and then nothing is tested.
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

OWN = 1 - 1e-9  # cosine between axis of the table and axis of the gyro


@dataclass(frozen=True)
class OwnAxis:
    """What each gyro read while the table turned about its own axis; n rows.

    `gyro`: (n,), 0, 1, 2; `run`: (n,), which of the runs; `rate`, `mean`, `sigma`: (n,), rad/s,
    along the axis of the gyro.
    """

    gyro: Integers
    run: Integers
    rate: Array
    mean: Array
    sigma: Array

    @property
    def straight(self) -> Array:
        """The model that is tested: a scale factor and a bias for each gyro, (n, 2 per gyro)."""
        each = self.gyro[:, None] == np.unique(self.gyro)[None, :]
        return np.hstack([each * self.rate[:, None], each.astype(np.float64)])

    def less(self, rows: Sequence[int]) -> "OwnAxis":
        """The same without some rows."""
        keep = np.delete(np.arange(len(self.rate)), rows)
        real = (self.rate[keep], self.mean[keep], self.sigma[keep])
        return OwnAxis(self.gyro[keep], self.run[keep], *real)


def own_axis(runs: Sequence[SteadyRate], earth: Earth, scatter: float = 0.0) -> OwnAxis:
    """Gather the runs about an axis of a gyro, of one mount or of several, the earth taken out.

    `scatter`, rad/s, is by what the readings differ from run to run beyond noise and rate.
    """
    rows = []
    for number, run in enumerate(runs):
        gyro = int(np.argmax(np.abs(run.about)))
        there = np.isfinite(run.mean[gyro]) and np.isfinite(run.sigma[gyro])
        if abs(run.about[gyro]) < OWN or not there:
            continue
        share = run.seconds / run.seconds.sum()
        seen = summed_earth_rate(earth, run.position, run.about, run.rate * run.elapsed, share)
        sigma = np.sqrt(run.sigma[gyro] ** 2 + run.rate_sigma**2 + scatter**2)
        signed = run.rate * np.sign(run.about[gyro])
        rows.append((gyro, number, signed, run.mean[gyro] - seen.known[gyro], sigma))
    columns = np.array(rows, dtype=np.float64).reshape(-1, 5).T
    return OwnAxis(columns[0].astype(np.int64), columns[1].astype(np.int64), *columns[2:])


def columns_of(data: OwnAxis) -> dict[str, Array]:
    """The forms that are tested, by name, (n, q) each.

    `cubic`: ω³, so that the scale factor changes by c ω², one c for all, s²/rad²; `cubic of each`:
    one c for each gyro; `bent`: ω|ω|, one for all, s/rad; `asymmetry`: |ω|, half of what the scale
    factors forward and backward differ by, one for all; `table`: the table's rate is off by a share
    of its own at each set rate, the same both ways.
    """
    rate, size = data.rate, np.abs(data.rate)
    each = data.gyro[:, None] == np.unique(data.gyro)[None, :]
    set_rates = np.unique(np.round(size, 9))
    at = np.abs(size[:, None] - set_rates[None, :]) < 1e-9
    return {
        "cubic": rate[:, None] ** 3,
        "cubic of each": each * rate[:, None] ** 3,
        "bent": (rate * size)[:, None],
        "asymmetry": size[:, None],
        "table": at * rate[:, None],
    }


def nonlinearities(data: OwnAxis) -> dict[str, NestedTest]:
    """The F test of each form beside the straight lines, by name; what cannot be tested is absent.

    The coefficients of `table` are NaN: one share that is common to all rates is a scale factor.
    """
    tests = {
        name: nested_test(data.straight, columns, data.mean, data.sigma)
        for name, columns in columns_of(data).items()
    }
    return {name: test for name, test in tests.items() if test is not None}
