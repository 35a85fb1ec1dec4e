"""The observation equations of a campaign with effects of the catalogue as further unknowns."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import accumulate, pairwise

import numpy as np

from inertial.arrays import Array
from inertial.campaign.equations_by_hand import NO_TABLE, SWAYING, ByHand, of_a_table
from inertial.campaign.rate_segments import GyroInputs
from inertial.campaign.records import Known
from inertial.campaign.solution import Solution
from inertial.estimation import accelerometers, gyroscopes
from inertial.estimation.accelerometers import Reference, StaticForce
from inertial.estimation.carried_effects import CarriedEquations
from inertial.estimation.drifting_equations import DriftingEquations
from inertial.estimation.effect_information import Sensitivities, SensorInformation
from inertial.estimation.elimination import Name
from inertial.estimation.gyroscope_equations import Linearisation
from inertial.estimation.gyroscope_observations import EARTH_UP, SteadyRate
from inertial.estimation.gyroscopes import LinearisedEquations
from inertial.estimation.horizontal_earth_rate import constrained_positions
from inertial.estimation.least_squares import System
from inertial.estimation.random_walk import NO_DRIFT, MeasuredDrift
from inertial.estimation.scatter_and_random_walk import Scatter, SwitchOns
from inertial.physics.effect import Effect
from inertial.physics.forward import Triad, signatures
from inertial.physics.motion import Motion, joined
from inertial.sensors import SENSORS
from inertial.text.messages import _

PRIOR_SIZE = 10.0  # prior sigma of an effect, in its typical sizes
NOT_SIMULATED = _("Nothing is simulated, for no sensor has all of its biases determined.")
NO_GYROS = _(
    "it changes no reading of the accelerometers, and the gyros are not simulated, for not all of "
    "their biases are determined"
)
POSITION_UNKNOWNS = {"tilt": "tilt", "horizontal": "level"}  # by quantity, in the equations
MAX_KEPT = 4  # equations with different effects


EffectKey = tuple[object, ...]
EffectKeys = tuple[EffectKey, ...]


def _prior_sigmas(effects: Sequence[Effect], prior_sigma: float) -> dict[str, float]:
    """Prior sigmas of the parameters of effects, by column; `prior_sigma`: in typical sizes."""
    return {
        f"{effect.label}.{parameter.name}": prior_sigma * parameter.typical if own is None else own
        for effect in effects
        for parameter in effect.parameters
        for own in [effect.prior_sigma(parameter)]
    }


@dataclass(frozen=True)
class Campaign:
    """One mount of a campaign with its joint result, from which systems with effects are formed.

    `positions`, `planned`: positions and manoeuvres of the plan, in its order; `by_hand`: where the
    result is that of positions of unknown attitude; `drifts`: of the biases by the noise at rest,
    of `gyro` and `accel`; `axis_sigma`: as in Reference.
    """

    inputs: GyroInputs
    static_forces: list[tuple[str, StaticForce, Motion]]  # by manoeuvre; of rotations too
    static_motions: list[Motion]
    turn_motions: list[Motion]
    steady_rates: list[tuple[str, SteadyRate, Motion]]  # by manoeuvre, at a known rate
    solution: Solution
    gravity: Known
    position_sigma: float
    positions: Sequence[str]
    planned: Sequence[str] = ()
    by_hand: ByHand | None = None
    drifts: Mapping[str, MeasuredDrift] = field(
        default_factory=lambda: dict.fromkeys(SENSORS, NO_DRIFT)
    )
    axis_sigma: float | None = None
    _known: dict[EffectKey, Mapping[str, Array]] = field(
        default_factory=dict, repr=False, compare=False
    )  # responses to effects, which random walks do not change
    _linear: dict[EffectKeys, LinearisedEquations] = field(
        default_factory=dict, repr=False, compare=False
    )  # equations of the gyros, nor these

    @property
    def manoeuvres(self) -> list[str]:
        """The manoeuvres in the equations, in the order of the plan."""
        names = [*self._gyro_names, *(name for name, _, _ in self.static_forces)]
        return list(dict.fromkeys([*names, *(self.by_hand.moving if self.by_hand else ())]))

    @property
    def _gyro_names(self) -> list[str]:
        """Of the gyros' static positions, then of their rotations, then of those at a rate."""
        names = [position.manoeuvre.name for position in self.inputs.static_positions]
        names += [recorded.plan.name for recorded in self.inputs.whole_turns]
        return [*names, *(name for name, _, _ in self.steady_rates)]

    @cached_property
    def motion(self) -> Motion:
        """All stretches of the equations: gyros at rest, gyros in rotation, accelerometers."""
        return joined(self.motions)

    @cached_property
    def motions(self) -> list[Motion]:
        """The same, each by itself."""
        return [*self.gyro_motions, *(motion for _, _, motion in self.static_forces)]

    @cached_property
    def gyro_motions(self) -> list[Motion]:
        """Those of the gyros: static positions, rotations, those at a rate, passages by hand."""
        passages = self.by_hand.motions if self.by_hand else ()
        steady = (motion for _, _, motion in self.steady_rates)
        return [*self.static_motions, *self.turn_motions, *steady, *passages]

    @property
    def recorded(self) -> bool:
        """Whether there is anything to simulate."""
        return bool(self.motions)

    def stretches(self, sensor: str) -> slice:
        """Which stretches of `motion` are those of a sensor, `gyro` or `accel`."""
        gyros = sum(len(motion.rate) for motion in self.gyro_motions)
        return slice(0, gyros) if sensor == "gyro" else slice(gyros, len(self.motion.rate))

    def manoeuvres_of(self, sensor: str) -> list[str]:
        """The manoeuvre of each of its `stretches`, of a sensor that is simulated."""
        if sensor == "gyro":
            names = [*self._gyro_names, *(self.by_hand.moving if self.by_hand else ())]
            motions = self.gyro_motions
        else:
            names = self.at_rest
            motions = [motion for _, _, motion in self.static_forces]
        each = zip(names, motions, strict=True)
        return [name for name, motion in each for _ in range(len(motion.rate))]

    def candidates(self, effects: Sequence[Effect]) -> dict[str, list[Effect]]:
        """Each effect by its name, once for every value of its scanned parameter."""
        return {
            effect.name: [effect]
            if not self.motions or self.excludes(effect)
            else list(effect.candidates(self.motion)) or [effect]
            for effect in effects
        }

    @property
    def handled(self) -> bool:
        """Whether it was moved by hand, which never stands still."""
        return self.by_hand is not None or any(turn.by_hand for turn in self.inputs.turns)

    def excludes(self, effect: Effect) -> bool:
        """Whether an effect is none of this campaign: of a table, or of stillness, by hand."""
        if effect.of_stillness:
            return self.handled
        return self.by_hand is not None and of_a_table(effect)

    def places(self, effect: Effect) -> Sequence[str]:
        """The names among which the scan of an effect is: manoeuvres or positions."""
        by_position = effect.scan is None or effect.scan.name == "position"
        return self.positions if by_position else self.planned

    def blind(self, effect: Effect) -> str:
        """Why an effect is not observable in this campaign; empty where it may be."""
        if self.excludes(effect):
            return SWAYING if effect.of_stillness else NO_TABLE
        return effect.blind(self.motion) if self.motions else NOT_SIMULATED

    def with_random_walks(self, random_walks: tuple[float, float]) -> "Campaign":
        """The same with random walks of the gyro and accelerometer biases, rad/s/√s, m/s²/√s."""
        return replace(self, solution=replace(self.solution, random_walks=random_walks))

    def about(self, solution: Solution, by_hand: ByHand | None) -> "Campaign":
        """The same, linear about another result."""
        return replace(self, solution=solution, by_hand=by_hand, _known={}, _linear={})

    @property
    def at_rest(self) -> list[str]:
        """The manoeuvres of the accelerometers."""
        return [name for name, _, _ in self.static_forces]

    def without_random_walks(self) -> "Campaign":
        """The same with constant biases."""
        return self.with_random_walks((0.0, 0.0))

    def without_drift_at_rest(self, sensors: Collection[str] = SENSORS) -> "Campaign":
        """The same without the drift that the noise at rest shows of some.

        Switch-ons remain, and the bias instability of the data sheet.
        """
        drifts = {
            sensor: drift.as_stated if sensor in sensors else drift
            for sensor, drift in self.drifts.items()
        }
        return replace(self, drifts=drifts)

    @property
    def scattering(self) -> tuple[str, ...]:
        """The sensors, by hand, whose residuals have a scatter that is estimated from them."""
        return () if self.by_hand is None else self.by_hand.scattering

    def without_scatter(self) -> "Campaign":
        """The same without the scatter of positions by hand."""
        if not self.scattering:
            return self
        assert self.by_hand is not None  # else there is no scatter
        return replace(self, by_hand=self.by_hand.without_scatter())

    def switch_ons(self, effects: Sequence[Effect]) -> dict[str, SwitchOns]:
        """By what biases differ between switch-ons, beside effects; of sensors with several."""
        found: dict[str, SwitchOns] = {}
        for sensor, drift in self.drifts.items():
            equations = self.equations(sensor, effects, PRIOR_SIZE)
            if equations is not None and drift.switch_on is not None:
                unknown = replace(equations, measured=replace(drift, switch_on=None))
                if (between := unknown.likelihood.switch_ons()) is not None:
                    found[sensor] = between
        return found

    def with_switch_ons(self, found: Mapping[str, SwitchOns]) -> "Campaign":
        """The same with biases that differ by so much between switch-ons."""
        sizes = {sensor: between.covering for sensor, between in found.items()}
        drifts = {
            sensor: replace(drift, switch_on=sizes.get(sensor, drift.switch_on))
            for sensor, drift in self.drifts.items()
        }
        return replace(self, drifts=drifts)

    def noise_degrees(self, sensor: str, of_noise: float) -> float:
        """Degrees of freedom of the noise of a sensor, a scatter by hand included."""
        own = self.by_hand.degrees.get(sensor, np.inf) if self.by_hand else np.inf
        return float(min(of_noise, own))

    def systems(
        self,
        effects: Sequence[Effect],
        prior_sigma: float,
        only: set[str] | None = None,
    ) -> tuple[System | None, System | None]:
        """The equations of gyros and accelerometers with the effects as further unknowns.

        `prior_sigma`: of the effects' parameters, in their typical sizes; `only`: the
        manoeuvres that are used.
        """
        gyro, accel = (self.system(sensor, effects, prior_sigma, only) for sensor in SENSORS)
        return gyro, accel

    @property
    def reference(self) -> Reference:
        """What static positions are compared with."""
        known = (self.gravity.number, self.gravity.scatter, self.position_sigma, self.axis_sigma)
        return Reference(*known, self.solution.off_positions(self.position_sigma))

    def system(
        self,
        sensor: str,
        effects: Sequence[Effect],
        prior_sigma: float,
        only: set[str] | None = None,
    ) -> System | None:
        """The equations of one sensor, `gyro` or `accel`; arguments as in `systems`."""
        walk = self._walk(sensor)
        drifting = self.equations(sensor, effects, prior_sigma, only, walking=bool(walk))
        return drifting.system(walk=walk) if drifting else None

    def information(
        self, sensor: str, effects: Sequence[Effect], errors: Sequence[Name] = ()
    ) -> SensorInformation | None:
        """What one sensor says of effects, and of errors that the other one shows, too.

        For many effects this takes less time and memory than their system.
        """
        walk = self._walk(sensor)
        drifting = self.equations(sensor, effects, 1.0, walking=bool(walk))
        return drifting.information(walk, errors) if drifting else None

    def _walk(self, sensor: str) -> float:
        return self.solution.random_walks[SENSORS.index(sensor)]

    def equations(
        self,
        sensor: str,
        effects: Sequence[Effect],
        prior_sigma: float,
        only: set[str] | None = None,
        *,
        walking: bool = False,
    ) -> DriftingEquations | None:
        """The same before errors are eliminated; `walking`: a random walk may be added."""
        sigmas = _prior_sigmas(effects, prior_sigma)
        if sensor == "gyro":
            return self._gyro(effects, sigmas, only)
        return self._accelerometer(effects, sigmas, only, walking=walking)

    def by_scatter(
        self, effects: Sequence[Effect], prior_sigma: float
    ) -> Callable[[Scatter], DriftingEquations]:
        """The equations of gyros by hand as a function of their scatter."""
        by_hand = self.by_hand
        assert by_hand is not None  # else there is no scatter
        equations = self._carried(by_hand, effects, _prior_sigmas(effects, prior_sigma))
        used, measured = by_hand.used(None), self.drifts["gyro"]
        return lambda scatter: replace(equations.drifting(scatter, used), measured=measured)

    def deviance_of_random_walk(
        self, sensor: str, effects: Sequence[Effect], prior_sigma: float
    ) -> Callable[[float], float]:
        """−2 log of the likelihood of one sensor as a function of the random walk of its biases."""
        drifting = self.equations(sensor, effects, prior_sigma, walking=True)
        assert drifting is not None  # else it has no times
        return drifting.likelihood.of_walk()

    def _gyro(
        self,
        effects: Sequence[Effect],
        prior_sigmas: Mapping[str, float],
        only: set[str] | None,
    ) -> DriftingEquations | None:
        if self.solution.gyro is None:
            return None
        if self.by_hand and "gyro" in self.solution.free:
            carried = self._carried(self.by_hand, effects, prior_sigmas)
            drifting = carried.drifting(self.by_hand.scatter, self.by_hand.used(only))
            return replace(drifting, measured=self.drifts["gyro"])
        used = [only is None or name in only for name in self._gyro_names]
        if not any(used):
            return None
        drift = self.drifts["gyro"]
        equations = replace(self._linearised(effects), effect_sigma=prior_sigmas, measured=drift)
        return equations.only(used).drifting()

    def _carried(
        self, by_hand: ByHand, effects: Sequence[Effect], prior_sigmas: Mapping[str, float]
    ) -> CarriedEquations:
        answers = self.sensitivities("gyro", effects)
        at_rest = {
            position.label: (_first(response), position.stretch)
            for position, response in zip(self.inputs.static_positions, answers, strict=False)
        }
        moving = answers[len(answers) - len(by_hand.motions) :]
        return by_hand.gyro(self.solution, at_rest, moving, prior_sigmas)

    def _linearised(self, effects: Sequence[Effect]) -> LinearisedEquations:
        """The equations of all static positions and rate segments, with no prior of the effects."""
        effect_keys = tuple(effect.key for effect in effects)
        own = (self.position_sigma, *self.drifts["gyro"].instability.tolist())
        key = (*effect_keys, own)
        if key in self._linear:
            return self._linear[key]
        made = self._newly_linearised(effects)
        if all(known in self._known for known in effect_keys):
            if len(self._linear) >= MAX_KEPT:
                self._linear.clear()
            self._linear[key] = made
        return made

    def _newly_linearised(self, effects: Sequence[Effect]) -> LinearisedEquations:
        sensitivities = self.sensitivities("gyro", effects)
        static = len(self.static_motions)
        rests = [
            replace(rest, sensitivities=_first(responses))
            for rest, responses in zip(
                self.inputs.static_rates, sensitivities[:static], strict=True
            )
        ]
        turns = [
            replace(turn, sensitivities=responses)
            for turn, responses in zip(self.inputs.turns, sensitivities[static:], strict=False)
        ]
        steady = [
            replace(rate, sensitivities=_mean_of(responses, rate.seconds))
            for (_, rate, _), responses in zip(
                self.steady_rates, sensitivities[static + len(self.turn_motions) :], strict=False
            )
        ]
        gyro, site = self.solution.gyro, self.solution.site
        assert gyro is not None  # else it has no equations
        levels = {
            (f"{POSITION_UNKNOWNS[quantity]} {component}", position): value
            for (position, quantity, component), value in self.solution.position_parameters.items()
        }
        levels[EARTH_UP] = site.earth_up
        constrained = constrained_positions(levels, site.earth_level)
        point = Linearisation(gyro.matrix, gyro.bias, levels, constrained)
        known = (self.inputs.earth, self.position_sigma)
        columns = _prior_sigmas(effects, 1.0)
        drift = self.drifts["gyro"]
        made = gyroscopes.linearised(point, turns, steady, *known, columns, drift)
        changes: dict[str, float] = {}
        for effect in effects:
            by_column = effect.level_rate_changes(site.earth_up, site.earth_level).tolist()
            changes |= zip(effect.columns, by_column, strict=True)
        return replace(made.with_statics(rests), level_changes=changes)

    def _accelerometer(
        self,
        effects: Sequence[Effect],
        prior_sigmas: Mapping[str, float],
        only: set[str] | None,
        *,
        walking: bool,
    ) -> DriftingEquations | None:
        if self.solution.accelerometer is None:
            return None
        sensitivities = self.sensitivities("accel", effects)
        rests = [
            replace(rest, sensitivities=_first(responses))
            for (name, rest, _), responses in zip(self.static_forces, sensitivities, strict=True)
            if only is None or name in only
        ]
        if not rests:
            return None
        drift = self.drifts["accel"]
        if self.by_hand:
            known = (self.solution.accelerometer, prior_sigmas)
            return replace(self.by_hand.accelerometer(rests, *known), measured=drift)
        return accelerometers.drifting(
            rests,
            self.reference,
            self.solution.accelerometer,
            prior_sigmas,
            walking=walking,
            measured=drift,
        )

    def _responses(self, effects: Sequence[Effect]) -> list[Mapping[str, Array]]:
        """The responses to each effect, by sensor, (n, 3, k) for all n stretches of that sensor."""
        if not effects or not self.motions:
            return []
        unit = Triad(np.eye(3), np.zeros(3))
        triads = self.solution.gyro or unit, self.solution.accelerometer or unit
        keys = [effect.key for effect in effects]
        every = dict(zip(keys, effects, strict=True))
        missing = {key: effect for key, effect in every.items() if key not in self._known}
        first = sum(len(motion.rate) for motion in self.gyro_motions)  # of the accelerometers
        found = (
            {"gyro": trace.gyro[:first].copy(), "accel": trace.accel[first:].copy()}
            for trace in signatures(self.motion, self.solution.site, *triads, missing.values())
        )
        responses = self._known | dict(zip(missing, found, strict=True))
        self._known.update(
            (key, responses[key]) for key, e in missing.items() if e.signature(self.motion) is None
        )
        return [responses[key] for key in keys]

    def sensitivities(self, sensor: str, effects: Sequence[Effect]) -> list[Sensitivities]:
        """The responses of one sensor in each stretch of its equations.

        Gyros: static positions, then rotations; accelerometers: as in `static_forces`.
        """
        gyros = len(self.gyro_motions)
        motions = self.motions[:gyros] if sensor == "gyro" else self.motions[gyros:]
        ends = [0, *accumulate(len(motion.rate) for motion in motions)]
        names = tuple(name for effect in effects for name in effect.columns)
        responses = [response[sensor] for response in self._responses(effects)]
        stacked = np.concatenate([np.zeros((ends[-1], 3, 0)), *responses], axis=2)
        return [Sensitivities(names, stacked[first:after]) for first, after in pairwise(ends)]


def _mean_of(responses: Sensitivities, seconds: Array) -> Sensitivities:
    """Those of the mean of some stretches."""
    values = np.tensordot(seconds / seconds.sum(), responses.values, axes=1)
    return Sensitivities(responses.names, values)


def _first(responses: Sensitivities) -> Sensitivities:
    """Those of a single stretch."""
    return Sensitivities(responses.names, responses.values[0])
