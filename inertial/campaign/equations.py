"""What the blocks of a campaign say of every effect of the catalogue."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate, pairwise

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.motions import CampaignMotions, mean_motion, positions_of
from inertial.campaign.rate_segments import GyroInputs, Recorded
from inertial.campaign.records import Known, Manoeuvre
from inertial.campaign.solution import Solution
from inertial.campaign.static_positions import Blocks, Still
from inertial.estimation import accelerometers, gyroscopes
from inertial.estimation.accelerometers import StaticForce
from inertial.estimation.gyroscope_equations import Linearisation
from inertial.estimation.horizontal_earth_rate import constrained_positions
from inertial.estimation.least_squares import EffectInformation, System
from inertial.estimation.sensitivities import Sensitivities
from inertial.model_selection.evidence import Evidence
from inertial.physics.effect import Effect, Reading
from inertial.physics.forward import Triad, signatures
from inertial.physics.motion import Motion, joined, mean_turned
from inertial.tables import ACCEL
from inertial.text.messages import _

Array = NDArray[np.float64]

USUAL_SIZE = 10.0  # prior sigma of an effect, in its typical sizes
NOT_SIMULATED = _("Nothing is simulated, for the joint estimate determines no sensor wholly.")
MIN_VISIBLE_SIGMA = 5.0  # of an effect at its largest size: less is not observable
MIN_PIECE_S = 30.0  # s, of a static position that counts as one
MAX_PIECES = 100  # pieces of all rests together
SENSORS = ("gyro", "accel")
UNKNOWN = {"tilt": "tilt", "horizontal": "level"}  # of a position, as the equations call it
MERGED_BLOCKS = 5  # blocks of a turn in one mean of the accelerometers: their input changes slowly


@dataclass(frozen=True)
class Campaign:
    """One mount of a campaign with its joint result, ready to be asked about effects.

    `positions`: of the plan, in its order; `manoeuvres`: those that are in the equations.
    """

    inputs: GyroInputs
    rests: list[tuple[str, StaticForce, Motion]]  # manoeuvre; of the accelerometers, turns too
    still_motions: list[Motion]
    turn_motions: list[Motion]
    solution: Solution
    gravity: Known
    position_sigma: float
    positions: Sequence[str]

    @property
    def manoeuvres(self) -> list[str]:
        """The manoeuvres in the equations, in the order of the plan."""
        names = [still.manoeuvre.name for still in self.inputs.stills]
        names += [one.plan.name for one in self._whole]
        return list(dict.fromkeys([*names, *(name for name, _, _ in self.rests)]))

    @property
    def _whole(self) -> list[Recorded]:
        return [r for r in self.inputs.usable if r.plan.recorded == "whole"]

    @cached_property
    def motion(self) -> Motion:
        """All stretches of the equations: rests of the gyros, turns, the accelerometers'."""
        return joined(self._motions)

    @property
    def _motions(self) -> list[Motion]:
        return [
            *self.still_motions,
            *self.turn_motions,
            *(motion for _, _, motion in self.rests),
        ]

    def stretches(self, sensor: str) -> slice:
        """Which stretches of `motion` are those of a sensor, `gyro` or `accel`."""
        gyros = sum(len(motion.rate) for motion in [*self.still_motions, *self.turn_motions])
        return slice(0, gyros) if sensor == "gyro" else slice(gyros, len(self.motion.rate))

    def candidates(self, effects: Sequence[Effect]) -> dict[str, list[Effect]]:
        """Each effect by its name with every value of what is scanned of it, or by itself."""
        if not self._motions:
            return {effect.name: [effect] for effect in effects}
        return {effect.name: list(effect.candidates(self.motion)) or [effect] for effect in effects}

    def blind(self, effect: Effect) -> str:
        """Why this campaign cannot show an effect; empty where it may."""
        return effect.blind(self.motion) if self._motions else NOT_SIMULATED

    def walking(self, walks: tuple[float, float]) -> "Campaign":
        """The same, the biases of gyros and accelerometers walking so, rad/s/√s and m/s²/√s."""
        return replace(self, solution=replace(self.solution, walks=walks))

    def without_walk(self) -> "Campaign":
        """The same, the biases not walking."""
        return self.walking((0.0, 0.0))

    def deviance(self, effects: Sequence[Effect], sizes: Sequence[float]) -> float:
        """−2 log of the likelihood with some effects, each about so many of its typical sizes."""
        told = self._told(effects)
        sigmas = {
            f"{effect.label}.{parameter.name}": size * parameter.typical
            for effect, size in zip(effects, sizes, strict=True)
            for parameter in effect.parameters
        }
        systems = (
            self._equations(s, self._traces(s, effects, told), sigmas, None) for s in SENSORS
        )
        return sum(system.solve_shared().deviance for system in systems if system is not None)

    def systems(
        self, effects: Sequence[Effect], wide: float, only: set[str] | None = None
    ) -> tuple[System | None, System | None]:
        """The equations of gyros and accelerometers with the effects as further unknowns.

        `wide`: sigma of the effects' parameters, in their typical sizes; `only`: the
        manoeuvres that are used.
        """
        told = self._told(effects)
        gyro, accel = (self._system(s, effects, wide, only, told) for s in ("gyro", "accel"))
        return gyro, accel

    def system(self, sensor: str, effects: Sequence[Effect], wide: float) -> System | None:
        """The equations of one sensor, `gyro` or `accel`; arguments as in `systems`."""
        return self._system(sensor, effects, wide, None, self._told(effects))

    def walked(
        self, sensor: str, effects: Sequence[Effect], wide: float
    ) -> Callable[[float], System | None]:
        """The equations of one sensor as a function of the random walk of its biases."""
        traces, widths = self._asked(sensor, effects, wide, self._told(effects))
        return lambda walk: self.walking((walk, walk))._equations(sensor, traces, widths, None)

    def _system(
        self,
        sensor: str,
        effects: Sequence[Effect],
        wide: float,
        only: set[str] | None,
        told: Sequence[Reading],
    ) -> System | None:
        return self._equations(sensor, *self._asked(sensor, effects, wide, told), only)

    def _asked(
        self, sensor: str, effects: Sequence[Effect], wide: float, told: Sequence[Reading]
    ) -> tuple[list[Sensitivities], dict[str, float]]:
        """The traces of the effects in each stretch, and the sigmas of their parameters."""
        widths = {
            f"{effect.label}.{parameter.name}": wide * parameter.typical
            for effect in effects
            for parameter in effect.parameters
        }
        return self._traces(sensor, effects, told), widths

    def _equations(
        self,
        sensor: str,
        traces: list[Sensitivities],
        widths: Mapping[str, float],
        only: set[str] | None,
    ) -> System | None:
        make = self._gyro if sensor == "gyro" else self._accelerometer
        return make(traces, widths, only)

    def _gyro(
        self, traces: list[Sensitivities], widths: Mapping[str, float], only: set[str] | None
    ) -> System | None:
        if self.solution.gyro is None:
            return None
        rests, turns = [], []
        of_stills, of_turns = traces[: len(self.still_motions)], traces[len(self.still_motions) :]
        for still, rest, told in zip(self.inputs.stills, self.inputs.rests, of_stills, strict=True):
            if only is None or still.manoeuvre.name in only:
                rests.append(replace(rest, sensitivities=Sensitivities(told.names, told.values[0])))
        for recorded, turn, told in zip(self._whole, self.inputs.turns, of_turns, strict=True):
            if only is None or recorded.plan.name in only:
                turns.append(replace(turn, sensitivities=told))
        if not (rests or turns):
            return None
        gyro = self.solution.gyro
        levels = {
            (f"{UNKNOWN[quantity]} {component}", position): value
            for (position, quantity, component), value in self.solution.found.items()
        }
        point = Linearisation(
            gyro.matrix,
            gyro.bias,
            levels,
            constrained_positions(levels, self.inputs.earth.level),
        )
        known = (self.inputs.earth, self.position_sigma)
        equations = gyroscopes.linearised(point, turns, [], *known, widths)
        return equations.system(rests, walk=self.solution.walks[0])

    def _accelerometer(
        self, traces: list[Sensitivities], widths: Mapping[str, float], only: set[str] | None
    ) -> System | None:
        if self.solution.accelerometer is None:
            return None
        rests = [
            replace(rest, sensitivities=Sensitivities(told.names, told.values[0]))
            for (name, rest, _), told in zip(self.rests, traces, strict=True)
            if only is None or name in only
        ]
        if not rests:
            return None
        return accelerometers.equations(
            rests,
            self.gravity.number,
            self.gravity.scatter,
            self.position_sigma,
            0.0,
            self.solution.accelerometer.matrix,
            widths,
            self.solution.walks[1],
        )

    def _told(self, effects: Sequence[Effect]) -> list[Reading]:
        """How the readings go with each effect, in all stretches."""
        if not effects or not self._motions:
            return []
        unit = Triad(np.eye(3), np.zeros(3))
        triads = self.solution.gyro or unit, self.solution.accelerometer or unit
        return signatures(self.motion, self.solution.site, *triads, effects)

    def _traces(
        self, sensor: str, effects: Sequence[Effect], told: Sequence[Reading]
    ) -> list[Sensitivities]:
        """The same of one sensor, in each stretch of its equations.

        Gyros: one for each rest, then for each turn; accelerometers: one for each of `rests`.
        """
        ends = [0, *accumulate(len(motion.rate) for motion in self._motions)]
        parts = [slice(first, after) for first, after in pairwise(ends)]
        gyros = len(parts) - len(self.rests)
        own = parts[:gyros] if sensor == "gyro" else parts[gyros:]
        if not told or not own:
            return [Sensitivities(values=np.zeros((part.stop - part.start, 3, 0))) for part in own]
        names = tuple(f"{e.label}.{parameter.name}" for e in effects for parameter in e.parameters)
        every = np.concatenate([getattr(trace, sensor) for trace in told], axis=2)
        return [Sensitivities(names, every[part]) for part in own]


def campaign_of(data: CampaignData) -> Campaign:
    """Gather what the equations need of one mount.

    Without a shared clock the times of different logs are not comparable, and so none is given.
    """
    inputs = replace(data.gyro_inputs, stills=_in_pieces(data.gyro_inputs.stills))
    found = _in_pieces(data.accelerometer_positions[0])
    motions, solution = CampaignMotions(data), data.result
    stills_of_gyro = [motions.at_rest(still) for still in inputs.stills]
    turns: list[Motion] = []
    rests: list[tuple[str, StaticForce, Motion]] = []
    for still in found:
        rests.append((still.manoeuvre.name, _rest(still), motions.at_rest(still)))
    whole = [r for r in inputs.usable if r.plan.recorded == "whole"]
    for one, turn in zip(whole, inputs.turns, strict=True):
        if solution.gyro is None:
            break
        motion = motions.turning(one, turn)
        turns.append(motion)
        if not turn.by_hand:
            density = data.noise.of(one.plan.name, "steady", ACCEL)
            edges = [0, *(gap.before for gap in turn.gaps), len(turn.seconds)]
            parts = _turning(one.plan, one.blocks, motion, density, edges)
            rests += [(m, replace(part, stretch=turn.stretch), at) for m, part, at in parts]
    return Campaign(
        inputs,
        rests,
        stills_of_gyro,
        turns,
        solution,
        data.gravity,
        data.position_sigma,
        positions_of(data.plan),
    )


def _in_pieces(found: Sequence[Still]) -> list[Still]:
    """Rests so finely that what changes within them is seen, and no more equations than needed."""
    lasted = sum(float(still.seconds.sum()) for still in found)
    return [one for still in found for one in still.pieces(max(MIN_PIECE_S, lasted / MAX_PIECES))]


def _rest(still: Still) -> StaticForce:
    stretch = still.stretch
    return StaticForce(still.manoeuvre.position, still.up_now, *still.over(), stretch=stretch)


def _turning(
    m: Manoeuvre, blocks: Blocks, motion: Motion, density: Array, edges: Sequence[int]
) -> list[tuple[str, StaticForce, Motion]]:
    """The accelerometers during a turn, some blocks at a time, none across the `edges`."""
    read, seconds = blocks.accel, blocks.seconds
    assert m.up is not None  # else the turn is refused
    ups = mean_turned(m.up, m.axis, motion.angle, motion.rate * seconds)
    parts = []
    pieces = [range(first, after, MERGED_BLOCKS) for first, after in pairwise(edges)]
    starts = [start for piece in pieces for start in piece]
    for start, after in pairwise([*starts, len(read)]):
        some = slice(start, after)
        share = seconds[some] / seconds[some].sum()
        mean = share @ read[some]
        up = share @ ups[some]
        sigma = density / np.sqrt(seconds[some].sum())
        rest = StaticForce(m.position, up, mean, sigma)
        parts.append((m.name, rest, mean_motion(motion, some, share)))
    return parts


def evidence(
    campaign: Campaign, effects: Sequence[Effect], noise_degrees: float = np.inf
) -> Evidence:
    """What gyros and accelerometers say of the effects, all other unknowns fitted.

    Both are told apart but for the tilts of the positions, which each fits for itself. The
    columns are named by label and parameter of an effect. Nothing is said of an effect that is
    sought elsewhere, nor where it would not be seen at the largest size that is thought of: there
    it could only take up what the equations round off. `noise_degrees`: of freedom, from which the
    noise is estimated.
    """
    pairs = zip(("gyro", "accel"), campaign.systems(effects, 1.0), strict=True)
    systems = [(sensor, system) for sensor, system in pairs if system is not None]
    said = [(sensor, system.effect_information()) for sensor, system in systems]
    largest = np.array(
        [
            effect.largest if effect.sought_in == "blocks" else 0.0
            for effect in effects
            for _ in effect.parameters
        ]
    )
    information = sum((np.diag(reduced.information) for _, reduced in said), np.zeros(1))
    clear = (largest * np.sqrt(information) > MIN_VISIBLE_SIGMA).astype(np.float64)
    return Evidence(
        tuple(_only(reduced, clear) for _, reduced in said),
        tuple(sensor for sensor, _ in said),
        (noise_degrees,) * len(said),
        sum((system.raw_information() for _, system in systems), np.zeros(1)),
    )


def _only(reduced: EffectInformation, clear: Array) -> EffectInformation:
    """The same without what is said of columns that are not clear, (k,)."""
    return replace(
        reduced,
        information=reduced.information * np.outer(clear, clear),
        right=reduced.right * clear,
    )
