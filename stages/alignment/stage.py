"""Alignment at rest, and how far the attitude errs afterwards, with rotation and without."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.campaign_data import MOUNTS, CampaignData
from inertial.campaign.masked_samples import Repairs
from inertial.campaign.measurement import Measurement, measurements_of
from inertial.campaign.records import Manoeuvre, Performed, Row, rows_of
from inertial.campaign.sample_stretches import Samples, records_of, samples_in
from inertial.estimation.alignment import (
    AttitudeError,
    CoarseAlignment,
    Separated,
    at_rest,
    gained,
    integrated,
    separated,
)
from inertial.physics.motion import cross, stretches, turned_all
from inertial.tables import ACCEL, AXES, GYRO
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from inertial.text.parameters import BIAS
from stages.alignment.declared import DECLARED

# ---- The runs of an alignment: the rest itself, and the turns and rests over which it is followed.

BIN_S = 0.05  # s, over which readings are averaged: 4° at 80 °/s, of which a mean lacks 2·10⁻⁴
LEVEL = 0.5  # of up along an axis, below which the axis counts as level
ALIGNMENT, MODULATION = "alignment", "modulation"


@dataclass(frozen=True)
class Group:
    """An alignment, and the turns and rests that follow it in its log with the same end up."""

    alignment: Manoeuvre
    followed: Sequence[tuple[Manoeuvre, bool]]  # whether it is modulated


def groups(
    plan: Sequence[Manoeuvre], performed: Mapping[str, Performed], purposes: Mapping[str, str]
) -> Iterator[Group]:
    """The alignments of a plan that were recorded."""
    found = [m for m in plan if performed[m.name].found]
    for log in dict.fromkeys(m.log for m in found):
        own = [m for m in found if m.log == log]
        starts = [i for i, m in enumerate(own) if purposes.get(m.name) == ALIGNMENT]
        for start, end in pairwise([*starts, len(own)]):
            first = own[start]
            followed = [
                (m, purposes.get(m.name) == MODULATION)
                for m in own[start + 1 : end]
                if purposes.get(m.name) == MODULATION or m.do == "rest"
            ]
            yield Group(first, [each for each in followed if _alike(first, each[0])])


def _alike(first: Manoeuvre, other: Manoeuvre) -> bool:
    """Whether another manoeuvre has the same end up, and turns about it if it does."""
    if first.up is None or other.up is None or first.up @ other.up < 1 - 1e-9:
        return False
    return other.do == "rest" or abs(float(other.axis @ first.up)) > 1 - 1e-9


@dataclass(frozen=True)
class Run:
    """A manoeuvre in k short stretches.

    `force`, `rate`: (k, 3), means of the readings; `time` of the middle, `seconds`, `temperature`:
    (k,); `angle`, `speed`: (k,), of the table at the middle, rad and rad/s, by its encoder or else
    about up since the start; `end`: rad, the angle at its end; `density`: rad/√s and m/s/√s, white
    noise of a level gyro and of a level accelerometer.
    """

    manoeuvre: Manoeuvre
    force: Array
    rate: Array
    time: Array
    seconds: Array
    temperature: Array
    angle: Array
    speed: Array
    end: float
    encoder: bool
    density: tuple[float, float]

    def compensated(self, measurement: Measurement) -> "Run":
        """The same without the errors of the result; linear, so of means."""
        motion = stretches(self.time, self.seconds, self.temperature)
        force = measurement.force(self.force, motion)
        return replace(self, force=force, rate=measurement.rate(self.rate, motion, force))

    def mean(self, values: Array) -> Array:
        """The mean of force or rate over the run, (3,)."""
        return np.asarray(np.average(values, axis=0, weights=self.seconds))


def run_of(data: CampaignData, m: Manoeuvre, samples: Samples) -> Run | None:
    """A manoeuvre from its samples, without those in which a channel is masked.

    None where it has not all six channels for a tenth of a second, or their noise is not known.
    """
    assert m.up is not None  # the plan refuses an alignment without
    step = data.clocks[m.log].step
    kept = np.isfinite(samples.values).all(axis=1)
    values, time = samples.values[kept], samples.time[kept]
    length = max(round(BIN_S / step), 1)
    if len(values) < 2 * length:
        return None
    starts = np.arange(0, len(values) - length + 1, length)
    count = np.diff(starts, append=len(values))
    if np.isfinite(time).all():  # a gap lengthens the stretch in which it lies
        seconds = np.diff(time[starts], append=time[-1] + step)
    else:
        seconds = step * count
    recorded = samples.table_angle[kept]
    encoder = bool(np.isfinite(recorded).all())
    angle = recorded if encoder else _by_gyro(m, values[:, 3:], step)

    def means(of: Array) -> Array:
        return np.asarray((np.add.reduceat(of, starts).T / count).T)

    middle, turned = time[starts] + seconds / 2, means(angle)
    level = np.abs(m.up) < LEVEL
    density = tuple(
        float(np.sqrt(np.mean(data.noise.of(m.name, "rest", channels)[level] ** 2)))
        for channels in (GYRO, ACCEL)
    )
    if not np.isfinite(density).all():
        return None
    return Run(
        m,
        means(values[:, :3]),
        means(values[:, 3:]),
        middle,
        seconds,
        means(samples.temperature[kept]),
        turned,
        np.gradient(turned) / seconds if m.do == "turn" else np.zeros(len(turned)),
        float(angle[-1]),
        encoder,
        (density[0], density[1]),
    )


def _by_gyro(m: Manoeuvre, rates: Array, step: float) -> Array:
    """The angle about up since the start, (n,), rad, which ends at the known one of the turn.

    The gyro tells its course, the plan its size.
    """
    if m.do != "turn" or m.angle is None or m.up is None:
        return np.zeros(len(rates))
    bias = float(np.mean(rates[: max(round(1 / step), 1)] @ m.axis))
    course = np.cumsum(rates @ m.axis - bias)
    return np.asarray(np.sign(m.axis @ m.up) * m.angle * course / course[-1])


def since_alignment(alignment: Run, runs: Sequence[Run]) -> list[Run]:
    """The runs with the angle of the table about up since the alignment.

    By the encoder where it is recorded in all of them, its sense by the gyros; else each begins
    where the one before ended.
    """
    if alignment.encoder and all(run.encoder for run in runs):
        up = alignment.manoeuvre.up
        assert up is not None  # the plan refuses an alignment without
        sense = float(np.sign(sum(float(run.speed @ (run.rate @ up)) for run in runs))) or 1.0
        return [
            replace(run, angle=sense * (run.angle - alignment.end), speed=sense * run.speed)
            for run in runs
        ]
    start, result = 0.0, []
    for run in runs:
        first = run.angle[0] if run.encoder else 0.0
        result.append(replace(run, angle=start + run.angle - first))
        start += run.end - first
    return result


# ---- The stage.

RECORDED, COMPENSATED = "recorded", "compensated"
MAX_POINTS = 200  # of a curve in the table


def alignment(
    mounts: Sequence[CampaignData],
    samples: Stream,
    masks: pd.DataFrame,
    channel_repairs: pd.DataFrame,
    segments: pd.DataFrame,
    purposes: pd.DataFrame,
    result: pd.DataFrame,
) -> Tables:
    """The tables of the stage; empty where the campaign has no manoeuvre for an alignment."""
    named = {row["manoeuvre"]: row["purpose"] for row in rows_of(purposes)}
    found = [(data, group) for data in mounts for group in groups(data.plan, data.performed, named)]
    wanted = {
        m.name: records_of(m, segments)
        for _data, group in found
        for m in (group.alignment, *(each for each, _ in group.followed))
    }
    repairs = Repairs(channel_repairs)
    read = samples_in(samples, wanted, masks, repairs) if wanted else {}
    measurements = measurements_of(result)
    rows: dict[str, list[Row]] = {name: [] for name in DECLARED.writes}
    for data, group in found:
        aligned, *others = (
            run_of(data, m, read[m.name]) if m.name in read else None
            for m in (group.alignment, *(each for each, _ in group.followed))
        )
        if aligned is None:
            continue
        followed = [
            (run, each) for run, each in zip(others, group.followed, strict=True) if run is not None
        ]
        runs, kept = [run for run, _ in followed], [each for _, each in followed]
        group = replace(group, followed=kept)
        for case in _cases(data, group, aligned, runs, measurements.get(data.mount)):
            for name, more in case.tables().items():
                rows[name] += more
    return {name: table.frame(rows[name]) for name, table in DECLARED.writes.items()}


def _cases(
    data: CampaignData,
    group: Group,
    aligned: Run,
    runs: Sequence[Run],
    measurement: Measurement | None,
) -> Iterator["Case"]:
    """The readings as recorded, and compensated where both sensors have a result."""
    runs = since_alignment(aligned, runs)
    yield Case(data, group, RECORDED, aligned, runs, np.zeros(3))
    if measurement is None or None in (measurement.accelerometer.triad, measurement.gyro.triad):
        return
    bias = np.array([measurement.gyro.rows[name]["sigma"] for name in BIAS], dtype=np.float64)
    corrected = [run.compensated(measurement) for run in (aligned, *runs)]
    yield Case(data, group, COMPENSATED, corrected[0], corrected[1:], bias)


@dataclass(frozen=True)
class Case:
    """One alignment by the readings of one kind; `bias_sigma`: (3,), rad/s, of the calibration."""

    data: CampaignData
    group: Group
    readings: str
    aligned: Run
    runs: Sequence[Run]
    bias_sigma: Array

    @property
    def up(self) -> Array:
        """The planned up, (3,), body axes."""
        assert self.group.alignment.up is not None
        return self.group.alignment.up

    @property
    def direction(self) -> tuple[str, Array]:
        """The body direction whose azimuth is stated: the mark, or an axis that is level."""
        if self.group.alignment.mark is not None:
            return "mark", self.group.alignment.mark
        axis = int(np.argmin(np.abs(self.up)))
        return AXES[axis], np.eye(3)[axis]

    def tables(self) -> dict[str, list[Row]]:
        """The rows of each table."""
        static = self._static()
        turns = [
            run
            for run, (_, modulated) in zip(self.runs, self.group.followed, strict=True)
            if modulated
        ]
        frame, rows = static, list(self._alignment_rows("static", static))
        if turns:
            frame, level_rate = self._by_rotation(turns[0])
            rows += self._alignment_rows("rotation", frame)
            rows.append(self._alignment("rotation", "level_rate", *level_rate, "rad/s"))
            rows[-1]["known"] = self.data.earth.level
        name, direction = self.direction
        if name == "mark" and self.data.heading is not None:
            sigma = self.data.position_sigma
            frame = frame.with_azimuth(direction, self.data.heading, sigma)
        curves, gains = self._followed(frame)
        return {"alignments": rows, "attitude_errors": curves, "modulation_gains": gains}

    def _static(self) -> CoarseAlignment:
        """By the means of the rest."""
        run, seconds = self.aligned, float(self.aligned.seconds.sum())
        gyro, accel = (density / np.sqrt(seconds) for density in run.density)
        level = np.abs(self.up) < LEVEL
        gyro = np.hypot(gyro, np.sqrt(np.mean(self.bias_sigma[level] ** 2)))
        force, rate = run.mean(run.force), run.mean(run.rate)
        return at_rest(force, rate, accel, float(gyro), self.data.earth.up)

    def _by_rotation(self, run: Run) -> tuple[CoarseAlignment, tuple[float, float]]:
        """By what turns in the axes of the case; and the level rate that it gives, with sigma."""
        rate = self._separated(run, run.rate, run.density[0])
        force = self._separated(run, run.force, run.density[1])
        gravity = self.data.gravity.number
        up = self.up + force.turning / gravity
        up /= np.linalg.norm(up)
        level = rate.turning - (rate.turning @ up) * up
        size = float(np.linalg.norm(level))
        north = level / size
        axes = np.stack([cross(north, up), north, up])
        found = CoarseAlignment(axes, force.sigma / gravity, rate.sigma / size, 0.0)
        return found, (size, rate.sigma)

    def _separated(self, run: Run, means: Array, density: float) -> Separated:
        sigma = density / np.sqrt(run.seconds)
        return separated(means, run.angle, run.speed, self.up, sigma)

    def _alignment_rows(self, method: str, found: CoarseAlignment) -> Iterator[Row]:
        """Tilts about the level axes, and the azimuth."""
        tilt = cross(self.up, found.up)
        for i, axis in enumerate(AXES):
            if abs(self.up[i]) < LEVEL:
                yield self._alignment(
                    method, f"tilt_{axis}", float(tilt[i]), found.tilt_sigma, "rad"
                )
        name, direction = self.direction
        azimuth = found.azimuth(direction)
        known = self.data.heading if name == "mark" else None
        if known is not None:  # in the turn in which the known one is
            azimuth = known + float(np.remainder(azimuth - known + np.pi, 2 * np.pi)) - np.pi
        row = self._alignment(method, "azimuth", azimuth, found.heading_sigma, "rad")
        yield row | {"direction": name, "per_bias": found.per_bias, "known": known}

    def _alignment(self, method: str, quantity: str, value: float, sigma: float, unit: str) -> Row:
        return self._common | {
            "method": method,
            "quantity": quantity,
            "value": value,
            "sigma": sigma,
            "unit": unit,
        }

    @property
    def _common(self) -> Row:
        return {
            "mount": self.data.mount,
            "alignment": self.group.alignment.name,
            "readings": self.readings,
        }

    def _followed(self, frame: CoarseAlignment) -> tuple[list[Row], list[Row]]:
        """The error over each run, and the gain of the first one with rotation."""
        earth = self.data.earth.up * frame.up + self.data.earth.level * frame.axes[1]
        remains = self.aligned.mean(self.aligned.rate) - earth
        mean_sigma = self.aligned.density[0] / np.sqrt(float(self.aligned.seconds.sum()))
        curves: list[Row] = []
        errors: dict[bool, tuple[str, AttitudeError, AttitudeError]] = {}
        for run, (m, modulated) in zip(self.runs, self.group.followed, strict=True):
            k = len(run.seconds)
            truth = run.speed[:, None] * self.up + turned_all(earth, self.up, run.angle)
            place = (run.angle, run.seconds, self.up, frame.axes)
            error = integrated(run.rate - truth, *place, run.density[0])
            fixed, sigma = np.tile(remains, (k, 1)), mean_sigma
            if modulated:  # cross terms of the rate are fixed in the case as well
                found = self._separated(run, run.rate, run.density[0])
                fixed = (
                    (remains @ self.up) * self.up + found.fixed + np.outer(run.speed, found.growing)
                )
                sigma = found.fixed_sigma
            predicted = integrated(fixed, *place, 0.0)
            chord = integrated(np.tile(frame.axes[0], (k, 1)), *place, 0.0).level()
            errors.setdefault(modulated, (m.name, error, predicted))
            curves += self._curve(m.name, modulated, error, predicted, sigma * chord)
        if len(errors) < 2:
            return curves, []
        (turning, measured, expected), (still, without, drift) = errors[True], errors[False]
        gain, foreseen = gained(measured, without), gained(expected, drift)
        return curves, [
            self._common
            | {
                "modulated": turning,
                "still": still,
                "seconds": gain.seconds,
                "still_error": gain.still,
                "still_sigma": gain.still_sigma,
                "modulated_error": gain.modulated,
                "modulated_sigma": gain.modulated_sigma,
                "factor": gain.factor,
                "factor_sigma": gain.sigma,
                "predicted_factor": foreseen.factor,
            }
        ]

    def _curve(
        self,
        name: str,
        modulated: bool,
        error: AttitudeError,
        predicted: AttitudeError,
        sigma: Array,
    ) -> Iterator[Row]:
        last = len(error.seconds) - 1
        for i in np.unique(np.linspace(0, last, min(last + 1, MAX_POINTS)).astype(int)):
            components = dict(zip(("east", "north", "up"), error.angle[i].tolist(), strict=True))
            foreseen = zip(("east", "north", "up"), predicted.angle[i].tolist(), strict=True)
            yield (
                self._common
                | components
                | {
                    "manoeuvre": name,
                    "modulated": modulated,
                    "seconds": float(error.seconds[i]),
                    "sigma": float(error.sigma[i]),
                    **{f"predicted_{axis}": value for axis, value in foreseen},
                    "predicted_sigma": float(sigma[i]),
                }
            )


STAGE = Stage(alignment, DECLARED, gathers=MOUNTS)
