"""The steady parts of rotations, sample by sample: gyro residuals, and the angle of the table."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from math import ceil

import numpy as np
import pandas as pd

from inertial.arrays import Array, Booleans, nearest_axis
from inertial.campaign.campaign_data import CampaignData
from inertial.estimation.periodic_in_angle import Course
from inertial.estimation.periodic_in_time import Line
from inertial.estimation.spectrum import WHITE, NoiseShape, band_levels, noise_shape, white_level
from inertial.physics.site import EARTH_RATE
from inertial.signal.stamps import samples_passed
from inertial.tables import ACCEL, AXES, GYRO
from inertial.tables.parquet import Stream

RESIDUALS, OF_FORCE = ([f"residual_{name}" for name in names] for names in (GYRO, ACCEL))
RESTS = ("rest-before", "rest-after")
MAX_LOST_SAMPLES = 3  # in a row: the phase of an oscillation is still known
MIN_SAMPLES = 64  # of a steady part
MIN_WHITE_HZ = 0.5  # from which the white noise is estimated
MAX_UNEVEN = 1e-3  # of a rate that is even, beside the earth's rate, which the case turns in
MAX_ACROSS_COSINE = 0.5  # below which an axis is not that of the table
MIN_UPRIGHT_COSINE = 0.999  # of axis and vertical, from which gravity is constant in the case


@dataclass(frozen=True)
class SteadyTurn:
    """The steady part of one turn, the coupling of the gyros by M undone.

    name : of the manoeuvre; about : (3,), the table's axis in the case; step : s, of a sample
    start : s, time of the first sample, NaN where it is not known
    matrix : (3, 3), M of the gyros
    truth : (n, 3), rad/s, residuals of the rates about the axes of the case
    force : (n, 3), m/s², residuals of the accelerometers as they read; NaN where not recorded
    angle : (n,), rad, signed, that the table has turned since its start; NaN where the table has
        no stated rate, for then it follows from the gyros, and their residuals have no ripple
    averaged : whether a sample is the mean of the rate over its interval, an increment
    tilted : whether gravity rotates in the case
    stated : rad, signed, that the table is stated to turn from rest to rest; NaN where it is not
    shapes : of the noise about each axis of the case
    rests : the same before and after the turn: times, (m,), s, and residuals of the rates, (m, 3)
    """

    name: str
    about: Array
    matrix: Array
    truth: Array
    force: Array
    angle: Array
    step: float
    averaged: bool
    tilted: bool
    start: float = np.nan
    stated: float = np.nan
    shapes: Sequence[NoiseShape] = (WHITE,) * len(AXES)
    rests: Sequence[tuple[Array, Array]] = ()

    @property
    def rate(self) -> float:
        """The rate of the table, rad/s; NaN where its angle is not known, or does not change.

        Slower than the earth it does not: of a table that stands still rounding remains.
        """
        rate = float(self.angle[-1] - self.angle[0]) / (len(self.angle) - 1) / self.step
        return rate if abs(rate) > EARTH_RATE else np.nan

    @property
    def seconds(self) -> float:
        """Duration, s."""
        return self.step * len(self.truth)

    def hertz(self, order: float) -> float:
        """The frequency of `order` periods per revolution of the table."""
        return order * abs(self.rate) / (2 * np.pi)

    def observes(self, direction: Array) -> bool:
        """Whether its residuals about an axis of the case, a unit vector, contain an oscillation.

        About the axis of the table they do not where its angle follows from the gyros.
        """
        return bool(np.isfinite(self.rate) or abs(direction @ self.about) < MAX_ACROSS_COSINE)

    def along(self, direction: Array) -> Array:
        """The residual rate about an axis of the case, a unit vector, (n,), rad/s."""
        return np.asarray(self.truth @ direction)

    def shape(self, direction: Array) -> NoiseShape:
        """The shape of the noise about an axis of the case, of a unit vector the nearest one."""
        return self.shapes[nearest_axis(direction)]

    def sigma(self, direction: Array, frequency: Array | float) -> Array:
        """Noise of a sample about an axis of the case, were it white as at a frequency, rad/s."""
        return np.asarray(self.course(direction).sigma * self.shape(direction).at(frequency))

    def course(self, direction: Array) -> Course:
        """The residual rate about an axis of the case, against the table's angle."""
        key = direction.tobytes()
        if key not in self._courses:
            record, rate, shape = self.along(direction), 1 / self.step, self.shape(direction)
            levels = band_levels(record[:, None], rate, (MIN_WHITE_HZ, rate / 2), shape)
            sigma = float(white_level(levels)[0][0] * np.sqrt(rate))
            self._courses[key] = Course(
                record, self.angle, self.rate, self.step, self.averaged, sigma, self.tilted, shape
            )
        return self._courses[key]

    @cached_property
    def _courses(self) -> dict[bytes, Course]:
        """Those that were asked for, by the bytes of their direction."""
        return {}

    def whole(self, line: Line) -> Line:
        """A line of the rate, corrected for the averaging over a sample, sinc(fT)."""
        share = float(np.sinc(line.frequency * self.step)) if self.averaged else 1.0
        return Line(
            line.frequency,
            line.sigma_frequency,
            line.amplitude / share,
            line.sigma_amplitude / share,
            line.p_value,
        )


def steady_turns(data: CampaignData, simulated: Stream) -> list[SteadyTurn]:
    """The steady parts of all turns of one mount; none where its gyros are not determined.

    Of a turn that was another than stated nothing is simulated that it could be compared with; nor
    of one that is simulated at rest, for so most of what was taken for its steady part was.
    """
    gyro = data.result.gyro
    if gyro is None:
        return []
    others = {r.plan.name for r in data.gyro_inputs.recorded if r.off_ratio is not None}
    planned = {m.name: m for m in data.plan if m.do == "turn" and m.name not in others}
    inverse = np.asarray(np.linalg.inv(gyro.matrix))
    steady_parts = []
    for name, rows in by_turn(simulated, ["time", *GYRO, *RESIDUALS, *OF_FORCE]):
        steady = (rows["phase"] == "steady").to_numpy()
        if name not in planned or not steady.any():
            continue
        m = planned[name]
        step = data.clocks[m.log].step
        angle = np.full(len(rows), np.nan)
        if m.rate is not None and m.acceleration is not None:
            rate = (rows[GYRO].to_numpy() - gyro.bias) @ inverse.T @ m.axis
            angle = _angle(rows, rate, step)
            steady = steady & _between_ramps(rate, steady)
        columns = [rows[["time", *RESIDUALS]].to_numpy(np.float64), angle[:, None]]
        columns.append(rows[["time", *OF_FORCE]].to_numpy(np.float64))
        residuals, further = unbroken(np.hstack(columns)[steady])
        truth = residuals @ inverse.T
        if len(truth) < MIN_SAMPLES or not np.isfinite(truth).all():
            continue
        tilted = m.up is None or abs(float(m.up @ m.axis)) < MIN_UPRIGHT_COSINE
        turn = SteadyTurn(
            name,
            m.axis,
            gyro.matrix,
            truth,
            further[:, 2:],
            further[:, 0],
            step,
            data.clocks[m.log].averaged,
            tilted,
            float(further[0, 1]),
            np.nan if m.angle is None else m.angle,
            rests=[*_rests(rows, inverse)],
        )
        if np.isfinite(turn.rate) or np.isnan(turn.angle).all():
            steady_parts.append(turn)
    return [*_with_shapes(steady_parts)]


def _rests(rows: pd.DataFrame, inverse: Array) -> Iterator[tuple[Array, Array]]:
    """The times and residuals before and after a turn; `inverse`: of M."""
    for phase in RESTS:
        read = rows.loc[rows["phase"] == phase, ["time", *RESIDUALS]].to_numpy(np.float64)
        read = read[np.isfinite(read).all(axis=1)]
        yield read[:, 0], read[:, 1:] @ inverse.T


def _with_shapes(turns: Sequence[SteadyTurn]) -> Iterator[SteadyTurn]:
    """The turns with the shape that the noise of each axis has in all that are sampled alike.

    Without their first samples, in which the filter that such a shape shows still settles.
    """
    rates = np.array([float(f"{1 / turn.step:.3g}") for turn in turns])
    shapes = {
        rate: [
            noise_shape(
                [turn.truth[:, i] for turn, own in zip(turns, rates, strict=True) if own == rate],
                rate,
                MIN_WHITE_HZ,
            )
            for i in range(len(AXES))
        ]
        for rate in set(rates.tolist())
    }
    for turn, rate in zip(turns, rates.tolist(), strict=True):
        own = shapes[rate]
        first = ceil(max(shape.settling for shape in own) / turn.step)
        if len(turn.truth) - first >= MIN_SAMPLES:
            yield replace(
                turn,
                truth=turn.truth[first:],
                force=turn.force[first:],
                angle=turn.angle[first:],
                start=turn.start + first * turn.step,
                shapes=own,
            )


def _between_ramps(rate: Array, steady: Booleans) -> Booleans:
    """Which samples are between the ramps as simulated, (n,); `rate`: (n,), rad/s, as simulated.

    Of a gyro that reads another rate than is predicted, a scale factor with the rate, the simulated
    ramps are earlier or later than those that were recorded, and lie within its steady part.
    """
    even = float(np.median(rate[steady]))
    near = np.abs(rate - even) <= MAX_UNEVEN * abs(even) + 2 * EARTH_RATE
    inner = np.flatnonzero(near & steady)
    if not len(inner):  # it turns unevenly
        return steady
    places = np.arange(len(rate))
    return np.asarray((places >= inner[0]) & (places <= inner[-1]))


def _angle(rows: pd.DataFrame, rate: Array, step: float) -> Array:
    """The table's angle at the middle of each sample since the turn began, (n,), rad.

    `rate`: (n,), rad/s, about the axis, as simulated: with the earth's, which remains at
    rest. Over lost samples the table moves at the rate of those after.
    """
    quiet = rows["phase"].isin(RESTS).to_numpy()
    turning = rate - (np.median(rate[quiet]) if quiet.any() else 0.0)
    time = rows["time"].to_numpy(np.float64)
    passed = np.ones(len(time))
    if np.isfinite(time).all():
        passed[1:] = samples_passed(time, step)
    return np.asarray(np.cumsum(turning * passed) * step - turning * step / 2)


def by_turn(simulated: Stream, columns: list[str]) -> Iterator[tuple[str, pd.DataFrame]]:
    """The rows of each manoeuvre with their phase, one manoeuvre at a time."""
    name, parts = "", []  # type: str, list[pd.DataFrame]
    for batch in simulated.columns(["manoeuvre", "phase", *columns]):
        for manoeuvre, rows in batch.to_pandas().groupby("manoeuvre", sort=False):
            if manoeuvre != name and parts:
                yield name, pd.concat(parts)
                parts = []
            name = str(manoeuvre)
            parts.append(rows)
    if parts:
        yield name, pd.concat(parts)


def unbroken(rows: Array) -> tuple[Array, Array]:
    """The longest stretch without a gap; rows (n, 4 + c) of time, residuals, further columns.

    Returns the residuals, (m, 3), and the further columns, (m, c). A few missing or masked
    samples do not end it: their residuals are zero, the further columns interpolated.
    """
    rows = rows[~np.isnan(rows[:, 1:4]).all(axis=1)]
    if len(rows) < 2 or np.isnan(rows[:, 0]).any():
        return rows[:, 1:4], rows[:, 4:]
    pause = np.diff(rows[:, 0])
    step = float(np.mean(pause[(pause > 0) & (pause < 1.5 * np.median(pause))]))
    passed = np.maximum(samples_passed(rows[:, 0], step), 1).astype(np.int64)
    edges = [0, *(np.flatnonzero(passed > MAX_LOST_SAMPLES + 1) + 1).tolist(), len(rows)]
    first, after = max(pairwise(edges), key=lambda edge: edge[1] - edge[0])
    place = np.append(0, np.cumsum(passed[first : after - 1]))
    every = np.arange(place[-1] + 1)
    stretch = np.zeros((len(every), len(AXES)))
    stretch[place] = rows[first:after, 1:4]
    further = [np.interp(every, place, column) for column in rows[first:after, 4:].T]
    return stretch, np.reshape(further, (-1, len(every))).T
