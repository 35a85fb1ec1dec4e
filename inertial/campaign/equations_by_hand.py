"""The equations of positions by hand, of unknown attitude, with effects as further unknowns.

By hand positions differ by more than noise: the IMU is not quite at rest. That is a scatter in the
equations of each sensor, re-estimated with each set of effects, for what is an effect of the
catalogue is no scatter.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from inertial.arrays import Array
from inertial.campaign.motions import Merged
from inertial.campaign.passages import Handled, RecordedPassage
from inertial.campaign.records import Known
from inertial.campaign.solution import Solution
from inertial.estimation import accelerometers, multi_position
from inertial.estimation.accelerometers import StaticForce
from inertial.estimation.attitude import integrate
from inertial.estimation.between_positions import NONE, Prior, Stop
from inertial.estimation.carried_effects import Carried, CarriedEquations, carried_equations
from inertial.estimation.drifting_equations import DriftingEquations
from inertial.estimation.effect_information import NO_SENSITIVITIES, Sensitivities
from inertial.estimation.elimination import whitened
from inertial.estimation.gyroscope_observations import Earth
from inertial.estimation.random_walk import COMMON_CLOCK, Stretch
from inertial.estimation.scatter_and_random_walk import Scatter
from inertial.estimation.triad import UNKNOWNS
from inertial.physics.effect import GOOD, POOR, Effect
from inertial.physics.forward import Triad
from inertial.physics.motion import Motion
from inertial.text.messages import _

MOST_SWAY = 0.02  # m/s, of a hand that holds still: some mm at 1 Hz, tenths of a mm at 10 Hz
MIN_BENT = 2e-3  # of M, rad of a direction, rad/s: by less a motion of 3 rad is bent by 20 µrad
NO_TABLE = _("No table takes part in a session by hand.")
SWAYING = _("A hand that turns the IMU sways at rest too, more than this would change.")


def of_a_table(effect: Effect) -> bool:
    """Whether a table causes an effect."""
    return set(effect.sizes) <= {GOOD, POOR}


@dataclass(frozen=True)
class ByHand:
    """The positions and motions of one mount, the motion in each, and the scatters.

    `shared_clock`: as in `CampaignData`; `motions`: of each passage, in its stretches; `scatter`:
    of the gyros; `force_scatter`: of the accelerometers given the effects, m/s²;
    `direction_scatter`: of the directions that the gyros are compared with; `degrees`:
    from which these were estimated, by sensor; `left_out`: by number, stops, then passages, whose
    gyros are not used; `force_changes`: m/s², (n, 3), by effects, without which the specific force
    of the stops is compared with the gyros.
    """

    handled: Handled
    motions: Sequence[Motion]
    gravity: Known
    earth: Earth
    shared_clock: bool
    scatter: Scatter = NONE
    force_scatter: float = 0.0
    direction_scatter: float = 0.0
    degrees: Mapping[str, float] = field(default_factory=dict)
    left_out: frozenset[int] = frozenset()
    force_changes: Array | None = None

    @property
    def scattering(self) -> tuple[str, ...]:
        """The sensors whose scatter is estimated from the residuals."""
        sizes = {"gyro": self.scatter != NONE, "accel": self.force_scatter > 0}
        return tuple(sensor for sensor, there in sizes.items() if there)

    @property
    def scatter_seconds(self) -> float | None:
        """Of a rest with the scatter of the gyros, as in `ScatterFit`."""
        usual = float(np.median([stop.seconds for stop in self.handled.stops]))
        return usual if self.scatter.sways else None

    @property
    def of_motion(self) -> float:
        """The largest scatter of the mean specific force that motion at rest can make, m/s².

        The mean acceleration over a rest is the change of velocity between its ends, by its length.
        """
        return MOST_SWAY / float(np.median([stop.seconds for stop in self.handled.stops]))

    @property
    def beyond_motion(self) -> bool:
        """Whether |f| at rest scatters about g by more than an IMU that sways can make it."""
        return self.force_scatter > self.of_motion

    def without_scatter(self) -> "ByHand":
        """The same with noise alone."""
        return replace(self, scatter=NONE, force_scatter=0.0)

    @property
    def moving(self) -> list[str]:
        """The passages by name."""
        return [each.part.manoeuvre for each in self.handled.passages]

    @property
    def names(self) -> list[str]:
        """The stops, then the passages, by name."""
        return [*(stop.forces.name for stop in self.handled.stops), *self.moving]

    def accelerometer(
        self, rests: Sequence[StaticForce], triad: Triad, prior_sigmas: Mapping[str, float]
    ) -> DriftingEquations:
        """The equations of the accelerometers at some of the rests."""
        known = (self.gravity.number, self.gravity.scatter, triad)
        return drifting(rests, *known, prior_sigmas, self.force_scatter)

    def gyro(
        self,
        solution: Solution,
        at_rest: Mapping[str, tuple[Sensitivities, Stretch]],
        moving: Sequence[Sensitivities],
        prior_sigmas: Mapping[str, float],
    ) -> CarriedEquations:
        """Those of the gyros; `at_rest`: by the name of a position with readings of them."""
        gyro, accelerometer = solution.gyro, solution.accelerometer
        assert gyro is not None and accelerometer is not None  # else the gyros are not free
        unknown = (NO_SENSITIVITIES, Stretch("unread"))
        rests = [at_rest.get(name, unknown) for name in self.names[: len(self.handled.stops)]]
        return carried_equations(
            self._corrected_stops,
            [each.passage for each in self.handled.passages],
            Prior(self.gravity.number, self.gravity.scatter, self.direction_scatter, self.earth),
            (gyro.matrix, gyro.bias, accelerometer.matrix, accelerometer.bias),
            Carried([own for own, _ in rests], moving, [s for _, s in rests] + self._stretches),
            prior_sigmas,
        )

    @property
    def _corrected_stops(self) -> list[Stop]:
        """The stops with the specific force that effects leave."""
        stops = self.handled.stops
        if self.force_changes is None:
            return stops
        return [
            replace(stop, forces=replace(stop.forces, mean=stop.forces.mean - change))
            for stop, change in zip(stops, self.force_changes, strict=True)
        ]

    def used(self, only: set[str] | None) -> list[bool]:
        """Of each stop, then of each passage, whether its gyros are used."""
        return [
            i not in self.left_out and (only is None or name in only)
            for i, name in enumerate(self.names)
        ]

    @cached_property
    def _stretches(self) -> list[Stretch]:
        return [_stretch(each, self.shared_clock) for each in self.handled.passages]


def _stretch(recorded: RecordedPassage, shared_clock: bool) -> Stretch:
    seconds = recorded.passage.seconds
    start = float(recorded.time[0] - seconds[0] / 2)
    clock = COMMON_CLOCK if shared_clock else recorded.log
    return Stretch(recorded.part.manoeuvre, clock, start, float(seconds.sum()))


def motion_of(
    recorded: RecordedPassage, before: Motion, gyro: Triad, place: int, *, shared_clock: bool
) -> Motion:
    """A passage in its stretches, the attitude carried on by the gyros from the rest `before`.

    The hand's acceleration is not in it: from rest to rest it sums up to nothing. Nor is there the
    angle of a table.
    """
    passage = recorded.passage
    rates = (passage.rates - gyro.bias) @ np.linalg.inv(gyro.matrix).T
    ups = integrate(rates, passage.seconds).middles @ before.up[0]
    merged = Merged(passage.seconds, passage.starts)
    omega, n = merged.mean(rates), len(merged.starts)
    rate = np.linalg.norm(omega, axis=1)
    unknown = np.full((n, 3), np.nan)
    return Motion(
        time=merged.mean(recorded.time) if shared_clock else np.full(n, np.nan),
        about=omega / np.maximum(rate, np.finfo(float).tiny)[:, None],
        angle=np.full(n, np.nan),
        rate=rate,
        acceleration=np.zeros(n),
        up=merged.mean(ups),
        north=unknown,
        seconds=merged.seconds,
        switched_on=np.full(n, before.switched_on[0]),
        visit=np.full(n, place + 0.5),
        position=np.full(n, float(place)),
        run=np.full(n, before.run[0]),
        surveyed=np.zeros(n, bool),
        temperature=merged.mean(recorded.temperature),
        vibration=np.zeros((n, 3)),
        peaks=unknown,
        senses=unknown,
        tumbled=np.zeros((n, 3)),
        square=rate**2,
        log_time=np.full(n, np.nan),
        since=unknown,
        turned=np.zeros((n, 3)),
        measured_force=unknown,
    )


# ---- The accelerometers in positions of unknown attitude: |f| = g, one linear equation for each.
#
#     |P⁻¹ (reading − bias)| − g = 0
#
# about P and the upward direction v that the readings give. The row n = P⁻ᵀ v of the three readings
# is the only combination that no small rotation of the position changes, and it changes by n · δ
# for an error δ of the readings, whatever its cause: noise, a bias, an effect (Tedaldi, Pretto &
# Menegatti, ICRA 2014). It is the same estimate as that of `multi_position`, in the twelve unknowns
# of other methods, with P symmetric.

SYMMETRY_SIGMA = 1e-8  # of M_xy − M_yx
CROSS_SIGMA = multi_position.PRIOR_SIGMA[3] * np.sqrt(2)  # before both cross terms are alike
PRIOR_SIGMA = np.append(np.where(np.eye(3, dtype=bool).ravel(), 1.0, CROSS_SIGMA), np.full(3, 10.0))
PAIRS = ((1, 3), (2, 6), (5, 7))  # of the nine elements by rows


def drifting(
    statics: Sequence[StaticForce],
    gravity: float,
    gravity_sigma: float,
    about: Triad,
    effect_sigma: Mapping[str, float],
    scatter: float,
) -> DriftingEquations:
    """The equations about a triad and the direction `up` of each position.

    Unknowns: M by rows, bias, gravity, effects; `scatter`, m/s²: between positions, beyond noise.
    """
    effects = list(effect_sigma)
    prior = np.concatenate([accelerometers.PRIOR, [gravity], np.zeros(len(effects))])
    ups = np.array([static.up for static in statics])
    normal = ups @ np.linalg.inv(about.matrix)
    every = accelerometers.linear_rows(statics, gravity, about, prior, effects)
    along = np.einsum("ni,nij->nj", normal, every)
    rows = along[:, np.r_[: len(prior), -1]]  # no tilt changes them
    noise = np.hypot([static.sigma for static in statics], scatter)
    rows[:, -1] -= multi_position.lengthened(about.matrix, ups, noise, gravity)
    sigma = np.linalg.norm(normal * noise, axis=1)
    alike = np.zeros((len(PAIRS), rows.shape[1]))
    for row, (one, other) in enumerate(PAIRS):
        alike[row, [one, other]] = 1.0, -1.0
    symmetric = whitened(alike, np.full(len(PAIRS), SYMMETRY_SIGMA), ())
    blocks = [(symmetric, Stretch("symmetry"))]
    for i, static in enumerate(statics):
        some = slice(i, i + 1)
        block = whitened(rows[some], sigma[some], ())
        blocks.append((block, static.stretch or Stretch(f"rest {i}")))
    names = [("parameter", str(i)) for i in range(UNKNOWNS)] + [("gravity", "")]
    return DriftingEquations(
        blocks,
        ["", *(static.position for static in statics)],
        {},
        prior,
        np.array([*PRIOR_SIGMA, gravity_sigma, *effect_sigma.values()]),
        (*names, *(("effect", name) for name in effects)),
        accelerometers.BIAS,
    )
