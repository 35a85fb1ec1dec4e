"""What the blocks of a campaign say of every effect of the catalogue."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts import tables
from stages.contracts.records import Known, Manoeuvre, Performed
from stages.estimation.motions import at_rest, in_blocks
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.solution import Solution
from stages.estimation.stills import Still, stills
from stages.estimation.turns import GyroInputs, Recorded, gyro_inputs
from stages.inference import six_position, whole_turns
from stages.inference.least_squares import System
from stages.inference.naming import Evidence
from stages.inference.six_position import Rest
from stages.inference.whole_turns import Around
from stages.model.effect import Effect, Reading
from stages.model.forward import Triad, signature
from stages.model.motion import Motion, turned_all

Array = NDArray[np.float64]

ACCEL = [f"accel_{axis}" for axis in tables.AXES]
MERGED = 5  # blocks of a turn that make one of the accelerometers, whose truth changes slowly


@dataclass(frozen=True)
class Campaign:
    """One mount of a campaign with its joint result, ready to be asked about effects.

    `manoeuvres`: those that are in the equations.
    """

    inputs: GyroInputs
    rests: list[tuple[str, Rest, Motion]]  # manoeuvre; of the accelerometers, turns too
    still_motions: list[Motion]
    turn_motions: list[Motion]
    solution: Solution
    gravity: Known
    position_sigma: float

    @property
    def manoeuvres(self) -> list[str]:
        """The manoeuvres in the equations, in the order of the plan."""
        names = [still.manoeuvre.name for still in self.inputs.stills]
        names += [one.plan.name for one in self._whole]
        return list(dict.fromkeys([*names, *(name for name, _, _ in self.rests)]))

    @property
    def _whole(self) -> list[Recorded]:
        return [r for r in self.inputs.usable if r.plan.recorded == "whole"]

    def systems(
        self, effects: Sequence[Effect], wide: float, only: set[str] | None = None
    ) -> tuple[System | None, System | None]:
        """The equations of gyros and accelerometers with the effects as further unknowns.

        `wide`: sigma of the effects' parameters, in their typical sizes; `only`: the
        manoeuvres that are used.
        """
        widths = {
            f"{effect.name}.{parameter.name}": wide * parameter.typical
            for effect in effects
            for parameter in effect.parameters
        }
        return self._gyro(effects, widths, only), self._accelerometer(effects, widths, only)

    def _gyro(
        self, effects: Sequence[Effect], widths: Mapping[str, float], only: set[str] | None
    ) -> System | None:
        if self.solution.gyro is None:
            return None
        rests, turns = [], []
        pairs = zip(self.inputs.stills, self.inputs.rests(), self.still_motions, strict=True)
        for still, rest, motion in pairs:
            if only is None or still.manoeuvre.name in only:
                traces = self._traces(effects, motion, "gyro")
                rests.append(replace(rest, traces={k: trace[0] for k, trace in traces.items()}))
        whole = zip(self._whole, self.inputs.turns, self.turn_motions, strict=True)
        for recorded, turn, motion in whole:
            if only is None or recorded.plan.name in only:
                turns.append(replace(turn, traces=self._traces(effects, motion, "gyro")))
        if not (rests or turns):
            return None
        gyro = self.solution.gyro
        names = [(q, p) for p, q in self.solution.found]
        levels = dict(zip(names, self.solution.found.values(), strict=True))
        return whole_turns.equations(
            rests,
            turns,
            [],
            self.inputs.earth,
            (self.position_sigma, 0.0),
            Around(gyro.matrix, gyro.bias, levels),
            widths,
        )

    def _accelerometer(
        self, effects: Sequence[Effect], widths: Mapping[str, float], only: set[str] | None
    ) -> System | None:
        if self.solution.accelerometer is None:
            return None
        rests = [
            replace(
                rest, traces={k: t[0] for k, t in self._traces(effects, motion, "accel").items()}
            )
            for name, rest, motion in self.rests
            if only is None or name in only
        ]
        if not rests:
            return None
        return six_position.equations(
            rests,
            self.gravity.number,
            self.gravity.scatter,
            self.position_sigma,
            0.0,
            self.solution.accelerometer.matrix,
            widths,
        )

    def _traces(self, effects: Sequence[Effect], motion: Motion, sensor: str) -> dict[str, Array]:
        """How the readings change per unit of each parameter, (k, 3) each."""
        solution = self.solution
        unit = Triad(np.eye(3), np.zeros(3))
        traces = {}
        for effect in effects:
            told: Reading = signature(
                motion,
                solution.site,
                solution.gyro or unit,
                solution.accelerometer or unit,
                effect,
            )
            part = told.gyro if sensor == "gyro" else told.accel
            for i, parameter in enumerate(effect.parameters):
                traces[f"{effect.name}.{parameter.name}"] = part[:, :, i]
        return traces


def campaign_of(
    blocks: pd.DataFrame,
    plan: Sequence[Manoeuvre],
    done: Mapping[str, Performed],
    levels: NoiseLevels,
    known: Mapping[str, Known],
    solution: Solution,
    shared_clock: bool,
) -> Campaign:
    """Gather what the equations need of one mount.

    Without a shared clock the times of different logs are not comparable, and so none is given.
    """
    inputs = gyro_inputs(blocks, plan, done, levels, known)
    heading = inputs.heading
    blocks = blocks if shared_clock else blocks.assign(time=np.nan)
    times = _times(blocks)
    stills_of_gyro = [at_rest(s, solution, heading, times[s.label]) for s in inputs.stills]
    turns: list[Motion] = []
    rests: list[tuple[str, Rest, Motion]] = []
    for still in stills(blocks, plan, done, levels, "accel")[0]:
        motion = at_rest(still, solution, heading, times[still.label])
        rests.append((still.manoeuvre.name, _rest(still), motion))
    whole = [r for r in inputs.usable if r.plan.recorded == "whole"]
    for one, turn in zip(whole, inputs.turns, strict=True):
        if solution.gyro is None:
            break
        time = one.blocks["time"].to_numpy(np.float64)
        motion = in_blocks(one.plan, turn, solution, heading, time)
        turns.append(motion)
        if not turn.by_hand:
            density = levels.of(one.plan.name, "steady", ACCEL)
            edges = [0, *(bridge.before for bridge in turn.bridges), len(turn.seconds)]
            rests += _turning(one.plan, one.blocks, motion, density, edges)
    return Campaign(
        inputs,
        rests,
        stills_of_gyro,
        turns,
        solution,
        known["gravity"],
        known["position"].scatter,
    )


def _times(blocks: pd.DataFrame) -> dict[str, float]:
    """The middle of every stretch at rest by its label, s; NaN without a common clock."""
    times = {}
    for (name, phase), part in blocks[blocks["count"] > 0].groupby(["manoeuvre", "phase"]):
        label = str(name) if phase == "rest" else f"{name} ({phase})"
        times[label] = float(np.average(part["time"], weights=part["count"]))
    return times


def _rest(still: Still) -> Rest:
    return Rest(still.manoeuvre.position, still.up_now, *still.over())


def _turning(
    m: Manoeuvre, blocks: pd.DataFrame, motion: Motion, density: Array, edges: Sequence[int]
) -> list[tuple[str, Rest, Motion]]:
    """The accelerometers during a turn, some blocks at a time, none across the `edges`."""
    read = blocks[ACCEL].to_numpy(np.float64)
    seconds = blocks["seconds"].to_numpy(np.float64)
    assert m.up is not None  # else the turn is refused
    ups = turned_all(m.up, m.axis, motion.angle)
    parts = []
    pieces = [range(first, after, MERGED) for first, after in pairwise(edges)]
    starts = [start for piece in pieces for start in piece]
    for start, after in pairwise([*starts, len(read)]):
        some = slice(start, after)
        share = seconds[some] / seconds[some].sum()
        mean = share @ read[some]
        up = share @ ups[some]
        sigma = density / np.sqrt(seconds[some].sum())
        rest = Rest(m.position, up / np.linalg.norm(up), mean, sigma)
        parts.append((m.name, rest, _mean_motion(motion, some, share)))
    return parts


def _mean_motion(motion: Motion, some: slice, share: Array) -> Motion:
    def mean(values: Array) -> Array:
        return np.asarray([share @ values[some]])

    # The pull of a lever arm goes with the square of the rate, so its mean is the root of that.
    rate = np.sign(mean(motion.rate)) * np.sqrt(mean(motion.rate**2))
    return Motion(
        mean(motion.time),
        motion.about,
        mean(motion.angle),
        rate,
        mean(motion.acceleration),
        mean(motion.up),
        mean(motion.north),
    )


def evidence(campaign: Campaign, effects: Sequence[Effect]) -> Evidence:
    """What gyros and accelerometers say of the effects, all other unknowns fitted.

    Both are told apart but for the tilts of the positions, which each fits for itself.
    """
    systems = zip(("gyro", "accel"), campaign.systems(effects, 1.0), strict=True)
    said = [(sensor, system.reduced()) for sensor, system in systems if system is not None]
    return Evidence(tuple(reduced for _, reduced in said), tuple(sensor for sensor, _ in said))
