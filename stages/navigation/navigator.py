"""One mount of a campaign: its rests and whole turns navigated, and their errors predicted."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from inertial.arrays import Array, Integers
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.rate_segments import position_of
from inertial.campaign.records import Manoeuvre, Part, Row, with_mount
from inertial.physics.forward import Site, Triad, force_of, rate_of
from inertial.physics.motion import stretches, turned
from inertial.physics.strapdown import Course, Start, aligned, navigated
from inertial.tables import ACCEL, CHANNELS, GYRO, STATIC_PHASES
from inertial.text.messages import _
from stages.navigation.corridor import (
    QUANTITIES,
    Corridor,
    NavigatedStretch,
    Source,
    Uncertain,
    corridor,
    white_of,
)
from stages.navigation.windows import ALIGNMENT, HORIZONS, Readings

STEP_IN_TURN = 0.1  # s, at least, in which errors grow in a turn; at rest steps may be long
STEPS_OF_A_TURN = 200  # at most: in 360° less than 2° each
POINTS = 40  # of a course
UNITS = {"attitude": "rad", "velocity": "m/s", "position": "m"}
MAX_AZIMUTH_SHARE = 1 / 3  # of the level earth rate, its sigma where the gyros show the azimuth
CALIBRATIONS = ("nominal", "published", "calibrated")
NO_NOISE = _("its noise is not known")


@dataclass(frozen=True)
class Mean:
    """Mean readings at rest, (6,), forces first; time, s, and temperature, K, of their middle.

    `begins`: s, when what they stand for is navigated: after the alignment, or from the beginning
    of a rest that is shorter.
    """

    recorded: Array
    time: float
    temperature: float
    begins: float


@dataclass(frozen=True)
class Run:
    """One calibration's alignment, and the corrected readings, (n, 6), from its end on."""

    start: Start
    corrected: Array
    step: float
    gravity: float

    def course(self, after: Integers) -> Course:
        """The state after some of the samples."""
        force, rate = self.corrected[:, :3], self.corrected[:, 3:]
        return navigated(rate, force, self.step, self.start, self.gravity, after)

    def errors(self, after: Integers) -> Array:
        """Errors of attitude, velocity and position after some samples, (k, 9): truth is rest."""
        course = self.course(after)
        drift = Rotation.from_matrix(course.attitude @ self.start.attitude.T).as_rotvec()
        return np.hstack([drift, course.velocity, course.position])


class Navigator:
    """Takes in the windows of one mount, then predicts; its rows are those of the tables."""

    def __init__(
        self, data: CampaignData, known: Uncertain, published: Mapping[str, Triad]
    ) -> None:
        self.data, self.known, self.published = data, known, published
        self.site = Site(data.gravity.number, data.earth.up, data.earth.level)
        self.course_rows: list[Row] = []
        self._rows: list[Row] = []
        # By motion, time, quantity, and whether they were navigated, not only predicted.
        self._variances: dict[tuple[str, float | None, str, bool], dict[Source, float]] = {}
        self._longest = 0.0
        self._navigated: set[tuple[str, float]] = set()

    @property
    def error_rows(self) -> list[Row]:
        """Of the table of errors, in the order of the plan."""
        order = {m.name: place for place, m in enumerate(self.data.plan)}

        def place(row: Row) -> tuple[int, str, float]:
            return order[row["manoeuvre"].partition(" (")[0]], row["manoeuvre"], row["seconds"]

        return sorted(self._rows, key=place)

    @property
    def share_rows(self) -> list[Row]:
        """Of the table of shares: of what was navigated, as far as anything was."""
        return [
            {
                "mount": self.data.mount,
                "motion": motion,
                "seconds": seconds,
                "quantity": quantity,
                "family": family,
                "source": name,
                "share": variance / sum(variances.values()),
            }
            for (motion, seconds, quantity, tried), variances in self._variances.items()
            if tried or (motion, seconds, quantity, True) not in self._variances
            for (family, name), variance in variances.items()
            if variance
        ]

    # ---- What the readings of a window lead to.

    def add(self, each: Readings) -> None:
        """Navigate one window with each calibration, and predict its errors."""
        window, motion = each.window, "turn" if each.window.turn else "rest"
        at_rest = _mean(each)
        reason = each.reason or self._without_noise(window.manoeuvre)
        if reason:
            self._rows += reason_rows(
                [replace(window.part, reason=reason)], self.data.mount, motion
            )
            return
        alignment = each.aligned * window.step
        azimuth, north = self._azimuth(window.manoeuvre, window.part, at_rest, alignment)
        runs = self._runs(each, azimuth, north)
        stretch = self._resting(window.manoeuvre, at_rest, runs["calibrated"].start, alignment)
        stretch = replace(stretch, azimuth=azimuth)
        samples = len(each.recorded) - each.aligned
        if window.turn:
            self._turn(each, runs, stretch)
            return
        for horizon in HORIZONS:
            after = round(horizon / window.step)
            if after <= samples:
                own = _lasting(stretch, at_rest, horizon)
                self._errors(window.part, horizon, own, runs, after)
        if samples * window.step > self._longest:
            self._longest = samples * window.step
            self._course(window.part, stretch, runs, samples)

    def _runs(self, each: Readings, azimuth: str, north: Array | None) -> dict[str, Run]:
        """By the name of each calibration."""
        step, n = each.window.step, len(each.recorded)
        corrected = {"nominal": each.recorded, "calibrated": each.corrected}
        if self.published:
            motion = stretches(each.time, np.full(n, step), each.temperature)
            force = force_of(each.recorded[:, :3], self.published["accel"], [], motion)
            rate = rate_of(each.recorded[:, 3:], self.published["gyro"], [], motion, force)
            corrected["published"] = np.hstack([force, rate])
        runs = {}
        for name, values in corrected.items():
            force, rate = values[: each.aligned].mean(axis=0).reshape(2, 3)
            start = aligned(force, rate, self.site, north, compass=azimuth == "gyros")
            runs[name] = Run(start, values[each.aligned :], step, self.site.gravity)
        return runs

    def _turn(self, each: Readings, runs: Mapping[str, Run], stretch: NavigatedStretch) -> None:
        """A whole turn: after it, everything is as it was."""
        m, samples = each.window.manoeuvre, len(each.recorded) - each.aligned
        every = max(round(STEP_IN_TURN / each.window.step), -(-samples // STEPS_OF_A_TURN), 1)
        steps = samples // every
        inside = slice(each.aligned, each.aligned + steps * every)
        recorded, time, temperature = (
            values[inside].reshape(steps, every, -1).mean(axis=1)
            for values in (each.recorded, each.time, each.temperature)
        )
        middles = np.arange(steps) * every + every // 2
        attitude = runs["calibrated"].course(middles).attitude
        axis = stretch.start.attitude @ m.axis
        stretch = replace(
            stretch,
            moving=recorded,
            time=time[:, 0],
            temperature=temperature[:, 0],
            attitude=attitude,
            step=every * each.window.step,
            angle_error=(m.angle_sigma or 0.0) * axis,
        )
        expected = corridor(self.data, self.known, stretch, [steps])
        seconds = steps * stretch.step
        self._add(each.window.part, "turn", seconds, stretch.azimuth, expected, runs, steps * every)

    def _errors(
        self,
        part: Part,
        horizon: float,
        stretch: NavigatedStretch,
        runs: Mapping[str, Run],
        after: int,
    ) -> None:
        self._navigated.add((part.label, horizon))
        expected = corridor(self.data, self.known, stretch, [1])
        self._add(part, "rest", horizon, stretch.azimuth, expected, runs, after)

    def _add(
        self,
        part: Part,
        motion: str,
        seconds: float,
        azimuth: str,
        expected: Corridor,
        runs: Mapping[str, Run],
        after: int,
    ) -> None:
        """The rows of one manoeuvre and time; without runs the predicted errors alone."""
        errors = {name: run.errors(np.array([after]))[0] for name, run in runs.items()}
        (covariance,), (own,) = expected.covariances(), expected.covariances(parameters_alone=True)
        for quantity, rows in QUANTITIES.items():
            square = covariance[rows, rows]
            row = _error_row(self.data.mount, part.label, motion, quantity, seconds, azimuth) | {
                "predicted": float(np.sqrt(np.trace(square))),
                "by_parameters": float(np.sqrt(np.trace(own[rows, rows]))),
            }
            row |= {name: float(np.linalg.norm(error[rows])) for name, error in errors.items()}
            if errors:
                error = errors["calibrated"][rows]
                row["normalised"] = float(error @ np.linalg.solve(square, error) / 3)
            self._rows.append(row)
            key = (motion, None if motion == "turn" else seconds, quantity, bool(errors))
            total = self._variances.setdefault(key, {})
            for source, variance in expected.shares(quantity).items():
                total[source] = total.get(source, 0.0) + float(variance[0])

    def _course(
        self, part: Part, stretch: NavigatedStretch, runs: Mapping[str, Run], samples: int
    ) -> None:
        """The errors of the longest window against time."""
        step = runs["calibrated"].step
        every = max(samples // POINTS, 1)
        after = np.arange(0, samples + 1, every)
        even = replace(stretch, step=every * step)
        expected = corridor(self.data, self.known, even, range(len(after)))
        covariances = expected.covariances()
        errors = {name: run.errors(after) for name, run in runs.items()}
        self.course_rows = [
            {
                "mount": self.data.mount,
                "manoeuvre": part.label,
                "seconds": float(after[i] * step),
                "quantity": quantity,
                "unit": UNITS[quantity],
                **dict.fromkeys(CALIBRATIONS),
                **{name: float(np.linalg.norm(e[i, rows])) for name, e in errors.items()},
                "predicted": float(np.sqrt(np.trace(covariances[i][rows, rows]))),
            }
            for quantity, rows in QUANTITIES.items()
            for i in range(len(after))
        ]

    # ---- What is predicted of rests that are shorter.

    def predict(self, short: Sequence[Part]) -> None:
        """The errors of every rest for which it was not recorded for long enough.

        short : rests that were not navigated, with the reason
        """
        reasons = {part.label: part.reason for part in short}
        plan = {m.name: m for m in self.data.plan}
        for part, mean in self._means.items():
            m = plan[part.manoeuvre]
            if self._without_noise(m):
                continue
            azimuth, north = self._azimuth(m, part, mean, ALIGNMENT)
            force, rate = _corrected(self.known, mean)
            start = aligned(force, rate, self.site, north, compass=azimuth == "gyros")
            stretch = replace(self._resting(m, mean, start, ALIGNMENT), azimuth=azimuth)
            for horizon in HORIZONS:
                if (part.label, horizon) in self._navigated:
                    continue
                first = len(self._rows)
                own = _lasting(stretch, mean, horizon)
                expected = corridor(self.data, self.known, own, [1])
                self._add(part, "rest", horizon, azimuth, expected, {}, 0)
                reason = reasons.get(part.label, _("it is not recorded for so long"))
                for row in self._rows[first:]:
                    row["reason"] = reason

    @cached_property
    def _means(self) -> dict[Part, Mean]:
        """The mean readings of every rest of which all channels were recorded."""
        blocks = self.data.blocks
        own = {m.name for m in self.data.plan}
        columns = [*CHANNELS, "time", "temperature"]
        rests = blocks[blocks["phase"].isin(STATIC_PHASES) & blocks["manoeuvre"].isin(own)]
        means = {}
        for (name, phase), rows in rests.groupby(["manoeuvre", "phase"], sort=False):
            values, counts = rows[columns].to_numpy(np.float64), rows["count"].to_numpy(np.float64)
            there = np.isfinite(values[:, :6]).all(axis=1) & (counts > 0)
            if there.any():
                mean = np.average(values[there], axis=0, weights=counts[there])
                begins = (rows["time"] - rows["seconds"] / 2).min()
                part = Part(str(name), str(phase))
                means[part] = Mean(mean[:6], mean[6], mean[7], float(begins))
        return means

    def _without_noise(self, m: Manoeuvre) -> str:
        levels = self.data.noise.of(m.name, "rest", [*GYRO, *ACCEL])
        return "" if np.isfinite(levels).all() else NO_NOISE

    # ---- Attitude at the start.

    def _azimuth(
        self, m: Manoeuvre, part: Part, mean: Mean, alignment: float
    ) -> tuple[str, Array | None]:
        """Where the azimuth is from: plan, gyros or unknown; and north, (3,), by the plan."""
        north = position_of(m, self.data.heading).north
        if north is not None:
            if part.phase == "rest-after":
                return "plan", turned(north, m.axis, m.angle or 0.0)
            return "plan", north
        slopes = self._slopes(mean)[:3]
        white = white_of(self.data, self.known.measurement, m.name)[:3, :3]
        spread = slopes @ self.known.correlation @ slopes.T + white / alignment
        largest = float(np.sqrt(np.linalg.eigvalsh(spread)[-1]))
        seen = largest < MAX_AZIMUTH_SHARE * self.data.earth.level
        return "gyros" if seen else "unknown", None

    def _slopes(self, mean: Mean) -> Array:
        """(6, p), at rest."""
        one = np.ones(1)
        readings = (mean.recorded[None], mean.time * one, one, mean.temperature * one)
        return np.asarray(self.known.slopes(*readings)[0])

    def _resting(
        self, m: Manoeuvre, mean: Mean, start: Start, alignment: float
    ) -> NavigatedStretch:
        """A rest whose mean stands for alignment and navigation; the step is set by who uses it."""
        return NavigatedStretch(
            manoeuvre=m.name,
            at_rest=mean.recorded[None],
            moving=mean.recorded[None],
            time=np.array([mean.time]),
            temperature=np.array([mean.temperature]),
            attitude=start.attitude[None],
            start=start,
            alignment=alignment,
            step=1.0,
            azimuth="unknown",
            angle_error=np.zeros(3),
        )


def _lasting(stretch: NavigatedStretch, mean: Mean, seconds: float) -> NavigatedStretch:
    """A rest in one step of some seconds from its beginning on, and none before it."""
    return replace(stretch, step=seconds, time=np.array([mean.begins + seconds / 2]))


def _mean(each: Readings) -> Mean:
    at_rest = slice(0, max(each.aligned, 1))
    if not len(each.recorded):
        return Mean(np.full(6, np.nan), np.nan, np.nan, np.nan)
    values: list[Any] = [
        part[at_rest].mean(axis=0) for part in (each.recorded, each.time, each.temperature)
    ]
    ends = float(each.time[at_rest][-1])
    return Mean(values[0], float(values[1]), float(values[2]), ends)


def _corrected(known: Uncertain, mean: Mean) -> tuple[Array, Array]:
    """Specific force and rate by mean readings, (3,) each."""
    motion = stretches(np.array([mean.time]), np.ones(1), np.array([mean.temperature]))
    force = known.measurement.force(mean.recorded[None, :3], motion)
    return force[0], known.measurement.rate(mean.recorded[None, 3:], motion, force)[0]


def reason_rows(parts: Sequence[Part], mount: str, motion: str = "rest") -> list[Row]:
    """A row for each manoeuvre, or for all of a mount, of which there is no error at all."""
    return [
        _error_row(mount, part.label, motion, "attitude", HORIZONS[0], "") | {"reason": part.reason}
        for part in parts
    ]


def _error_row(
    mount: str, label: str, motion: str, quantity: str, seconds: float, azimuth: str
) -> Row:
    numbers = (*CALIBRATIONS, "predicted", "by_parameters", "normalised")
    return dict.fromkeys(numbers) | {
        "id": f"{with_mount('navigation', mount)}/{quantity}/{label}/{seconds:.0f}",
        "mount": mount,
        "manoeuvre": label,
        "motion": motion,
        "seconds": seconds,
        "quantity": quantity,
        "unit": UNITS[quantity],
        "azimuth": azimuth,
        "reason": "",
    }
