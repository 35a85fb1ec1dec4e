"""The mean readings of each channel and their equations."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import solve_triangular

from inertial.arrays import Array
from inertial.campaign.equations import Campaign
from inertial.campaign.recorded_turns import Rotation
from inertial.estimation import accelerometers
from inertial.estimation.gyroscope_equations import (
    CLOCK,
    horizontal_axes,
    horizontal_names,
    tilt_axes,
)
from inertial.estimation.gyroscope_observations import Position, RateSegment
from inertial.estimation.least_squares import System
from inertial.estimation.random_walk import NO_DRIFT, MeasuredDrift, Stretch, measured_covariance
from inertial.physics.effect import Effect, Truth
from inertial.physics.forward import Triad, signatures, truth_of
from inertial.physics.motion import Motion, cross, turned_all
from inertial.sensors import SENSORS

# ---- The means of each channel over static positions and over turns.
#
# The blocks of a turn mix the channels, for their angle is known from themselves alone. So a
# channel is judged by its mean reading of every stretch, less what the joint result predicts,
#
#     gyro at rest:           reading − (M ω + b)
#     gyro, a whole turn:     (Σ reading τ − M (u α + Σ ω_earth τ)) / T − b
#     accelerometer:          reading − (M f + b), at rest, or over some blocks of a turn
#
# in proportion to changes of its row of M and of its bias, to the effects, and to the errors of
# the tilt, of the azimuth, of the angle of the turn, of gravity and of the earth's rate, each
# with its known sigma; where the bias drifts, that too. Changes within a turn of a gyro are not
# included.

UNTIMED = Stretch("")
Errors = dict[tuple[str, str], tuple[Array, float]]  # what the readings change by (3,), and sigma


@dataclass(frozen=True)
class Mean:
    """The mean readings of three channels over a stretch.

    `residual`, `sigma`: (3,), less the prediction; `truth`: (3,), the known rate or
    specific force; `traces`: (3, k), per unit of each parameter of the effects; `time`: s, of its
    middle; `stretch`: of time.
    """

    manoeuvre: str
    residual: Array
    sigma: Array
    truth: Array
    traces: Array
    errors: Errors
    time: float
    stretch: Stretch = UNTIMED


@dataclass(frozen=True)
class Channels:
    """The means of one campaign, `gyro` and `accel`, with the traces of some effects."""

    campaign: Campaign
    effects: Sequence[Effect]

    @property
    def names(self) -> list[str]:
        """The parameters of the effects, in the order of the traces."""
        return [name for effect in self.effects for name in effect.columns]

    @cached_property
    def _traces(self) -> list[tuple[Motion, Truth, Array, Array]]:
        """Each stretch: motion, truth, and traces of gyros and accelerometers, (n, 3, k)."""
        campaign = self.campaign
        triads = [campaign.solution.gyro, campaign.solution.accelerometer]
        gyro, accel = (triad or Triad(np.eye(3), np.zeros(3)) for triad in triads)
        site = campaign.solution.site
        responses = list(signatures(campaign.motion, site, gyro, accel, self.effects))
        traces = [
            np.concatenate([getattr(response, s) for response in responses], axis=2)
            for s in SENSORS
        ]
        stretches, start = [], 0
        for motion in campaign.motions:
            part = slice(start, start + len(motion.rate))
            truth = truth_of(motion, site)
            stretches.append((motion, truth, traces[0][part], traces[1][part]))
            start = part.stop
        return stretches

    def means(self, sensor: str) -> list[Mean]:
        """The means of the three channels of a sensor; by hand no channel stands alone."""
        if self.campaign.by_hand:
            return []
        if sensor == "accel":
            return [] if self.campaign.solution.accelerometer is None else self._of_accelerometers()
        return [] if self.campaign.solution.gyro is None else self._of_gyros()

    def _of_gyros(self) -> list[Mean]:
        campaign, inputs = self.campaign, self.campaign.inputs
        static, turns = len(campaign.static_motions), len(campaign.turn_motions)
        means = []
        rests = zip(
            inputs.static_positions, inputs.static_rates, self._traces[:static], strict=True
        )
        for position, rest, (motion, truth, traces, _) in rests:
            known = _known_rate(motion, truth, rest.position)[0]
            errors = self._earth(rest.position, motion, np.ones(1))
            residual = rest.mean - self._gyro.matrix @ known - self._gyro.bias
            name, time = position.manoeuvre.name, float(motion.time[0])
            parts = (known, traces[0], errors, time, rest.stretch or UNTIMED)
            means.append(Mean(name, residual, rest.sigma, *parts))
        responses = self._traces[static : static + turns]
        for recorded, turn, (motion, truth, traces, _) in zip(
            inputs.whole_turns, inputs.turns, responses, strict=True
        ):
            means.append(self._of_turn(recorded, turn, motion, truth, traces))
        return means

    @property
    def _gyro(self) -> Triad:
        assert self.campaign.solution.gyro is not None  # else it has no means
        return self.campaign.solution.gyro

    def _of_turn(
        self, recorded: Rotation, turn: RateSegment, motion: Motion, truth: Truth, traces: Array
    ) -> Mean:
        """A turn as a whole; gaps are weighted as the blocks next to them."""
        weight = turn.weights * turn.seconds
        total = float(weight.sum())
        share = weight / total
        earth = _known_rate(motion, truth, turn.position) - motion.omega
        known = turn.about * (turn.angle / total) + share @ earth
        residual = turn.weights @ turn.sums / total - self._gyro.matrix @ known - self._gyro.bias
        sigma = turn.noise_of_sum / total
        errors = self._earth(turn.position, motion, share)
        along = self._gyro.matrix @ turn.about / total
        errors["angle", recorded.plan.name] = (
            along,
            float(np.hypot(turn.angle_sigma, turn.gap_sigma)),
        )
        errors[CLOCK, turn.clock] = (along * turn.angle, turn.clock_sigma)
        for name, axis in tilt_axes(turn.position, turn.about).items():
            tilted = self._gyro.matrix @ cross(axis, turn.about) * (turn.angle / total)
            errors[name] = (tilted, self.campaign.position_sigma)
        of_effects = np.einsum("n,nck->ck", share, traces)
        time = float(share @ motion.time)
        parts = (known, of_effects, errors, time, turn.stretch or UNTIMED)
        return Mean(recorded.plan.name, residual, sigma, *parts)

    def _earth(self, position: Position, motion: Motion, share: Array) -> Errors:
        """The errors of the known earth's rate."""
        earth, matrix = self.campaign.inputs.earth, self._gyro.matrix
        errors: Errors = {("earth", "up"): (matrix @ (share @ motion.up), earth.up_sigma)}
        for key, axis in zip(horizontal_names(position), horizontal_axes(position), strict=False):
            about = np.broadcast_to(motion.about, motion.up.shape)
            level = share @ turned_all(axis, about, motion.angle)
            errors[key] = (matrix @ level, earth.level / np.sqrt(2))
        return errors

    def _of_accelerometers(self) -> list[Mean]:
        campaign, triad = self.campaign, self.campaign.solution.accelerometer
        assert triad is not None  # else it has no means
        gravity, means = campaign.gravity, []
        responses = self._traces[len(self._traces) - len(campaign.static_forces) :]
        axes = accelerometers.tilt_axes([rest for _, rest, _ in campaign.static_forces])
        for (name, rest, _), tilts, (motion, _, _, traces) in zip(
            campaign.static_forces, axes, responses, strict=True
        ):
            force = gravity.number * rest.up
            errors: Errors = {("gravity", ""): (triad.matrix @ rest.up, gravity.scatter)}
            for tilt, axis in zip(accelerometers.tilts_of(rest), tilts, strict=False):
                errors[tilt] = (triad.matrix @ cross(axis, force), campaign.position_sigma)
            shared = accelerometers.shared_errors(rest, gravity.number, triad)
            sigma = campaign.reference.sigma_of(list(shared))
            errors |= {error: (change, sigma[error]) for error, change in shared.items()}
            residual = rest.mean - triad.matrix @ force - triad.bias
            parts = (force, traces[0], errors, float(motion.time[0]), rest.stretch or UNTIMED)
            means.append(Mean(name, residual, rest.sigma, *parts))
        return means


def _known_rate(motion: Motion, truth: Truth, position: Position) -> Array:
    """The rate that is known beforehand, (n, 3): without a level earth rate that is not."""
    if position.north is not None:
        return truth.rate
    earth = truth.rate - motion.omega
    upward = np.sum(earth * motion.up, axis=1, keepdims=True) * motion.up
    return np.asarray(motion.omega + upward)


# ---- The equations of one channel: its row of M, its bias, the effects, and the errors.

UNKNOWNS = 4  # of a channel: three of M and the bias
PRIOR_SIGMAS = (0.1, 0.1, 0.1, 1.0)  # of these, about the joint result


def system_of(
    means: Sequence[Mean],
    names: Sequence[str],
    channel: int,
    shown: Sequence[str],
    random_walk: float,
    measured: MeasuredDrift = NO_DRIFT,
) -> System | None:
    """The equations of one channel; None where it has no reading.

    `names`: of all traces, of which the effects `shown` are unknowns; `random_walk`: of the bias,
    per √s, beyond the `measured` drift.
    """
    some = [m for m in means if np.isfinite(m.residual[channel]) and np.isfinite(m.sigma[channel])]
    if not some:
        return None
    sigma = np.array([mean.sigma[channel] for mean in some])
    kept = [names.index(name) for name in shown]
    own = np.array([np.append(mean.truth, 1.0) for mean in some])
    of_effects = np.array([mean.traces[channel, kept] for mean in some])
    errors = {key: size for mean in some for key, (_, size) in mean.errors.items()}
    columns = {key: np.zeros(len(some)) for key in errors}
    for row, mean in enumerate(some):
        for key, (change, _) in mean.errors.items():
            columns[key][row] = change[channel]
    design = np.hstack([own, of_effects, *(column[:, None] for column in columns.values())])
    unknowns = [("parameter", str(i)) for i in range(UNKNOWNS)]
    unknowns += [*(("effect", name) for name in shown), *columns]
    observed = np.array([mean.residual[channel] for mean in some])
    rows = np.column_stack([design, observed]) / sigma[:, None]
    switched = measured.differs([mean.stretch for mean in some])
    if random_walk or measured or switched:  # from one stretch to the next, in units of the noise
        covariance = measured_covariance([mean.stretch for mean in some], measured)[channel]
        covariance = (covariance + random_walk**2 * _common_time(some)) / np.outer(sigma, sigma)
        lower = np.linalg.cholesky(np.eye(len(some)) + covariance)
        rows = solve_triangular(lower, rows, lower=True)
    return System(
        rows[:, :-1],
        rows[:, -1],
        np.ones(len(some)),
        np.zeros(len(unknowns)),
        np.array([*PRIOR_SIGMAS, *np.ones(len(shown)), *errors.values()]),
        UNKNOWNS,
        tuple(unknowns),
    )


def _common_time(means: Sequence[Mean]) -> Array:
    """Time from the first stretch to the earlier of two, s, (n, n)."""
    time = np.array([mean.time for mean in means])
    since = np.nan_to_num(time - np.nanmin([*time, np.inf]))
    return np.asarray(np.minimum.outer(since, since))
