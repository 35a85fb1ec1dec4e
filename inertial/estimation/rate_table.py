"""The gyros on a rate table: least squares of steady runs, and their departure from a line."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Integers, nearest_axis
from inertial.estimation.gyroscope_equations import TABLE_RATE
from inertial.estimation.gyroscope_formulas import Readings, Solution
from inertial.estimation.gyroscope_observations import Earth, SteadyRate
from inertial.estimation.horizontal_earth_rate import summed_earth_rate
from inertial.estimation.least_squares import pseudo_inverse
from inertial.estimation.regression import NestedTest, nested_test
from inertial.estimation.triad import linear_names
from inertial.text.messages import _
from inertial.text.parameters import AXES, PARTS

# ---- The gyros from many steady runs of a rate table: S4's least squares, with sigma and rank.
#
#     mean reading = M · (ω u + E) + bias + noise,   [M | b] = Ω̃ Wᵀ (W Wᵀ)⁻¹
#
# The columns of W are (ω u, 1): the rate of the table about its axis u in body axes, and 1. All
# runs have the same weight. The earth's rate E, which S4 does not mention, is subtracted
# beforehand. A gyro that was recorded only while the table turned about its own axis has a W of
# rank 2: its scale factor and bias are those of a straight line, its cross terms are not
# determined.


COLUMNS = 4  # the rates about x, y, z, and 1
EARTH_ITERATIONS = 3  # the earth's rate is sensed through M, which is an unknown


@dataclass(frozen=True)
class RateTable:
    """The gyros by the runs.

    `solution`: M and bias; `ranks`: (3,), rank of the inputs of each gyro, of 4; `recorded`: (3,),
    runs of each gyro; `residuals`: (k, 3), rad/s, NaN where not recorded.
    """

    solution: Solution
    ranks: Integers
    recorded: Integers
    residuals: Array

    @property
    def degrees(self) -> Integers:
        """Degrees of freedom of the residuals of each gyro, (3,)."""
        return self.recorded - self.ranks

    @property
    def rms(self) -> Array:
        """Standard deviation of a run by the residuals of each gyro, (3,), rad/s.

        NaN where no degree of freedom is left.
        """
        squares = np.nansum(self.residuals**2, axis=0)
        free = np.where(self.degrees > 0, self.degrees, 1)
        return np.where(self.degrees > 0, np.sqrt(squares / free), np.nan)

    def refusals(self) -> dict[str, str]:
        """Why a parameter is not determined, with the rank and the cure, by its name."""
        refusals = {}
        for name, there in zip(linear_names(), self.solution.determined, strict=True):
            parts = PARTS[name]
            gyro, about = parts.sensor_axis, parts.input_axis
            rank, runs = self.ranks[AXES.index(gyro)], self.recorded[AXES.index(gyro)]
            if there:
                continue
            if not runs:
                refusals[name] = _("the {gyro} gyro is not recorded in any steady run", gyro=gyro)
                continue
            what = _(
                "the inputs of the {gyro} gyro have rank {rank} of {COLUMNS}",
                gyro=gyro,
                rank=rank,
                COLUMNS=COLUMNS,
            )
            cure = (
                _("add a run of another rate")
                if parts.kind == "bias"
                else _("record all three gyros while the table turns about {about}", about=about)
            )
            refusals[name] = f"{what}: {cure}"
        return refusals


def rate_table(
    runs: Sequence[SteadyRate], earth: Earth, position_sigma: float, scatter: float = 0.0
) -> RateTable | None:
    """S4's least squares of k steady runs; None where there is none.

    Sigmas are of the noise of the means, the rate of each run and the share by which all are off,
    the tilt of the table's axis in each position (rad), the earth's rate, and the `scatter` between
    runs (rad/s).
    """
    if not runs:
        return None
    rates = np.array([run.rate * run.about for run in runs])
    means = np.array([run.mean for run in runs])
    noise = np.hypot(np.array([run.sigma for run in runs]), scatter)
    there = np.isfinite(means) & np.isfinite(noise)
    design = np.column_stack([rates, np.ones(len(runs))])
    inverses = [pseudo_inverse(design[there[:, gyro]]) for gyro in range(3)]
    weights = np.zeros((3, COLUMNS, len(runs)))
    for gyro, solution in enumerate(inverses):
        weights[gyro][:, there[:, gyro]] = solution.inverse
    determined = np.array([inverse.determined for inverse in inverses])

    earth_rates = [
        summed_earth_rate(
            earth, run.position, run.about, run.rate * run.elapsed, run.seconds / run.seconds.sum()
        )
        for run in runs
    ]
    matrix = np.eye(3)
    for _iteration in range(EARTH_ITERATIONS):
        values = means - np.array([rate.known for rate in earth_rates]) @ matrix.T
        solved = np.einsum("rkj,jr->rk", weights, np.nan_to_num(values))
        matrix = np.where(determined[:, :3], solved[:, :3], np.eye(3))

    readings = Readings(values, noise)
    for j, (run, earth_rate) in enumerate(zip(runs, earth_rates, strict=True)):
        along = matrix @ run.about
        readings.add_cause("rate", str(j), j, along * run.rate_sigma)
        readings.add_cause(*TABLE_RATE, j, along * np.sign(run.rate) * run.table_rate_sigma)
        readings.add_earth(j, earth_rate, matrix, earth.up_sigma)
        readings.add_tilts(j, run.position.name, run.about, run.rate, matrix, position_sigma)
    return RateTable(
        readings.solution(weights, determined),
        np.array([inverse.rank for inverse in inverses]),
        there.sum(axis=0),
        np.where(there, values - design @ solved.T, np.nan),
    )


# ---- Tests of the linearity of gyros on a rate table.
#
#     mean reading of gyro i = Kᵢ ω + bᵢ + tested term
#
# A term that all gyros share points to the table, one of its own for each gyro to the gyros; on
# one table the two cannot be separated by rate alone. Needs several rates in both directions: two
# rates per gyro leave no degree of freedom, and nothing is tested.

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
        gyro = nearest_axis(run.about)
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
    rate at each set rate, the same in both directions.
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
