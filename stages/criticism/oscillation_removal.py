"""Removal of oscillations from the blocks of a mount, and what each moves in the joint result."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.equations import Campaign
from inertial.campaign.observations import campaign_of
from inertial.campaign.records import Manoeuvre
from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.least_squares import Estimate
from inertial.estimation.periodic_in_time import MIN_SAMPLES, phasor
from inertial.estimation.probability import chi2_sf
from inertial.tables import ACCEL, GYRO
from stages.criticism.angle_steps import StepInTurn
from stages.criticism.oscillation_fits import direction
from stages.criticism.oscillation_hypotheses import IN_TIME
from stages.criticism.oscillation_search import Oscillation

MIN_BLOCKS = 8  # of a rest, in which a line is fitted
MAX_CHANCE = 1e-3  # of noise that looks like a line at rest
MIN_SHARE = 0.5  # of the amplitude in turns, of what goes on at rest

# ---- Removal of the oscillations from the blocks of turns.
#
# Where a block holds no whole number of periods the mean of an oscillation over it is not zero,
# and beats over many blocks: it would be taken for effects that depend on time or angle.


def without_lines(
    blocks: pd.DataFrame,
    plan: Sequence[Manoeuvre],
    turns: Sequence[SteadyTurn],
    lines: Sequence[Oscillation],
) -> pd.DataFrame:
    """The same blocks, each line removed from the steady ones with its own phase in each turn.

    An oscillation of the case adds no angle from rest to rest; what goes on at rest is removed from
    ramps and rests too. A ripple of the table adds angle where its order is no integer, or the turn
    no whole one, which is removed too where one ripple against the angle explains all turns. What
    else it adds in the steady part is removed while the table accelerates and decelerates. In the
    rests of a tumble such a ripple is an error of the position.
    """
    if not lines:
        return blocks
    quiet = blocks.copy()
    for turn in turns:
        own = (blocks["manoeuvre"] == turn.name).to_numpy()
        if (own & (blocks["phase"] == "steady")).any() and np.isfinite(turn.start):
            quiet.loc[own] = _of_turn(blocks[own], turn, lines)
    for rest in plan:
        own = (blocks["manoeuvre"] == rest.name).to_numpy()
        if rest.do == "rest" and own.any():
            quiet.loc[own] = _of_rest(blocks[own], rest, lines, turns)
    return quiet


def _of_turn(blocks: pd.DataFrame, turn: SteadyTurn, lines: Sequence[Oscillation]) -> pd.DataFrame:
    """The blocks of a turn without lines."""
    quiet, steady = blocks.copy(), (blocks["phase"] == "steady").to_numpy()
    further = _further(lines, turn.stated) / float(blocks.loc[steady, "seconds"].sum())
    quiet.loc[steady, GYRO] -= further * turn.about @ turn.matrix.T
    for line, rates in _lines(turn, turn.truth, lines):
        if line.at_rest:
            quiet[GYRO] -= rates.means(*_stretches(blocks, turn)) @ turn.matrix.T
        else:
            means = rates.means(*_with_the_whole(blocks[steady], turn))
            quiet.loc[steady, GYRO] -= (means[:-1] - means[-1]) @ turn.matrix.T
    in_time = [line for line in lines if line.effects[0] == IN_TIME]
    for line, forces in _lines(turn, turn.force, in_time):
        part = np.full(len(blocks), True) if line.at_rest else steady
        quiet.loc[part, ACCEL] -= forces.means(*_stretches(blocks[part], turn))
    return quiet


def _of_rest(
    blocks: pd.DataFrame,
    rest: Manoeuvre,
    lines: Sequence[Oscillation],
    turns: Sequence[SteadyTurn],
) -> pd.DataFrame:
    """The blocks of a rest without lines."""
    quiet = blocks.copy()
    for part in (part for one in lines if one.at_rest for part in one.parts):
        quiet[[*GYRO, *ACCEL]] -= _seen_at_rest(part, quiet, turns)
    if rest.tumbled is not None and rest.tumbled.any():
        turned = float(np.linalg.norm(rest.tumbled))
        further = _further(lines, turned) * rest.tumbled / turned
        quiet[ACCEL] += np.cross(further, blocks[ACCEL])
    return quiet


def _further(lines: Sequence[Oscillation], stated: float) -> float:
    """By how much the table turns further than a stated angle, for its ripples, rad."""
    further = 0.0
    for line in (part for cause in lines for part in cause.parts):
        ripple = line.likeliest.ripple
        if ripple and line.likeliest.effect != IN_TIME and ripple.common:
            turned = ripple.order * stated
            further += float(ripple.values @ [np.sin(turned), np.cos(turned) - 1.0])
    return further if np.isfinite(further) else 0.0


def _stretches(blocks: pd.DataFrame, turn: SteadyTurn) -> tuple[Array, Array]:
    """The middle of each block, (k,), s since the first sample of a turn, and its samples."""
    middle, count = (blocks[name].to_numpy(np.float64) for name in ("time", "count"))
    return middle - turn.start, count


def _with_the_whole(steady: pd.DataFrame, turn: SteadyTurn) -> tuple[Array, Array]:
    """The blocks of a steady part, and last the whole of it, what is missing included."""
    middle, count = _stretches(steady, turn)
    half = steady["seconds"].to_numpy(np.float64) / 2
    start, end = middle[0] - half[0], middle[-1] + half[-1]
    return np.append(middle, (start + end) / 2), np.append(count, round((end - start) / turn.step))


@dataclass(frozen=True)
class _Line:
    """A line in the three channels of a turn: Hz, and complex amplitudes, (3,)."""

    frequency: float
    amplitudes: NDArray[np.complex128]
    step: float

    def at(self, since: Array) -> Array:
        """Its values, (n, 3), at times since the first sample of the turn, s."""
        turned = np.exp(2j * np.pi * self.frequency * since)
        return np.asarray(np.real(turned[:, None] * self.amplitudes))

    def means(self, since: Array, count: Array) -> Array:
        """Its means, (k, 3), over stretches of `count` samples about `since`."""
        half = np.pi * self.frequency * self.step
        share = np.sin(count * half) / (count * np.sin(half))  # of a sum of `count` samples
        return np.asarray(share[:, None] * self.at(since))


def _lines(
    turn: SteadyTurn, samples: Array, oscillations: Sequence[Oscillation]
) -> Iterator[tuple[Oscillation, _Line]]:
    """The lines of oscillations and their multiples in the samples of a turn, (n, 3).

    A channel that is not recorded has no line.
    """
    left = np.where(np.isfinite(samples).all(axis=0), samples, 0.0)
    time = np.asarray(turn.step * np.arange(len(left)), dtype=np.float64)
    for one in oscillations:
        for part in one.parts:
            frequency = part.likeliest.frequencies.get(turn.name)
            if frequency is None:
                continue
            amplitudes = [phasor(left[:, axis], 1 / turn.step, frequency) for axis in range(3)]
            line = _Line(frequency, np.array(amplitudes), turn.step)
            left = left - line.at(time)
            yield one, line


def _seen_at_rest(line: Oscillation, blocks: pd.DataFrame, turns: Sequence[SteadyTurn]) -> Array:
    """The means of a line in all channels of the blocks of a rest, (k, 6), by its frequency.

    By least squares beside a constant. As large as in the turns is known beforehand, without which
    a line that the blocks hardly show, or show as a constant, would be noise.
    """
    time, count = (blocks[name].to_numpy(np.float64) for name in ("time", "count"))
    unit = _Line(line.mean.frequency, np.array([1.0, 1j, 0.0]), turns[0].step)
    waves = unit.means(np.asarray(time - time.mean()), count)[:, :2]
    read = blocks[[*GYRO, *ACCEL]].to_numpy(np.float64)
    known = np.where(np.isfinite(read).all(axis=0), read, 0.0)
    apart, left = waves - waves.mean(axis=0), known - known.mean(axis=0)
    seen = np.zeros_like(known)
    if len(blocks) < MIN_BLOCKS:
        return seen
    for channel, size in enumerate(_sizes(line, turns)):
        if size:
            residual = left[:, channel] - apart @ np.linalg.lstsq(apart, left[:, channel])[0]
            weight = 2 * float(residual @ residual) / (len(blocks) - 3) / size**2
            normal = apart.T @ apart + weight * np.eye(2)
            seen[:, channel] = waves @ np.linalg.solve(normal, apart.T @ left[:, channel])
    return seen


def _sizes(line: Oscillation, turns: Sequence[SteadyTurn]) -> Array:
    """The amplitudes of a line in all channels, rms over the turns, (6,); 0 of one not recorded."""
    powers = [
        [
            abs(phasor(record, 1 / turn.step, hertz)) ** 2
            for record in (*turn.truth.T, *turn.force.T)
        ]
        for turn in turns
        if (hertz := line.likeliest.frequencies.get(turn.name)) is not None
    ]
    return np.asarray(np.sqrt(np.nan_to_num(np.mean(powers, axis=0))))


# ---- Whether an oscillation goes on at rest, and what each moves in the joint result.


def with_rests(
    turns: Sequence[SteadyTurn], oscillations: Sequence[Oscillation]
) -> list[Oscillation]:
    """The same oscillations, those in time known to go on in the rests beside the turns."""
    return [
        replace(one, at_rest=one.effects[0] == IN_TIME and _goes_on(one, turns))
        for one in oscillations
    ]


def _goes_on(one: Oscillation, turns: Sequence[SteadyTurn]) -> bool:
    """Whether the rests have its frequency, with half of its amplitude or more."""
    drop, powers = 0.0, list[float]()
    for turn in turns:
        frequency = one.likeliest.frequencies.get(turn.name)
        if frequency is None:
            continue
        along = direction(turn, one.likeliest.axis)
        for time, truth in turn.rests:
            if len(time) < MIN_SAMPLES or (time[-1] - time[0]) * frequency < 1:
                continue
            phase = 2 * np.pi * frequency * (time - time[0])
            waves = np.column_stack([np.cos(phase), np.sin(phase)])
            record = truth @ along
            values = np.linalg.lstsq(waves - waves.mean(axis=0), record - record.mean())[0]
            sigma = float(turn.sigma(along, frequency)) * np.sqrt(2 / len(time))
            drop += float(values @ values) / sigma**2
            powers.append(float(values @ values) - 2 * sigma**2)
    if not powers or chi2_sf(drop, 2 * len(powers)) > MAX_CHANCE:
        return False
    return bool(np.mean(powers) > (MIN_SHARE * one.mean.amplitude) ** 2)


def shifts(
    data: CampaignData,
    turns: Sequence[SteadyTurn],
    oscillations: Sequence[Oscillation],
    quiet: Campaign,
) -> list[float | None]:
    """The largest shift of a parameter by each, in its sigma; None where none is determined.

    `quiet`: the campaign without any of them, in which its random walks and drifts are.
    """
    without = _estimate(quiet) if oscillations else None
    if without is None:
        return [None] * len(oscillations)
    largest = []
    for one in oscillations:
        others = [other for other in oscillations if other is not one]
        blocks = without_lines(data.blocks, data.plan, turns, others)
        made = campaign_of(replace(data, blocks=blocks))
        present = _estimate(replace(made, solution=quiet.solution, drifts=quiet.drifts))
        largest.append(None if present is None else _largest(without, present))
    return largest


def shifts_by_steps(
    data: CampaignData, steps: Sequence[StepInTurn], campaign: Campaign, blocks: pd.DataFrame
) -> list[float | None]:
    """The largest shift of a parameter by the angle of each step of one turn, in its sigma.

    `campaign`: of these blocks.
    """
    present, largest = _estimate(campaign) if steps else None, []
    for step in steps:
        quiet = blocks.copy()
        own = (blocks["manoeuvre"] == step.manoeuvre) & (blocks["phase"] == "steady")
        faster = step.angle / float(blocks.loc[own, "seconds"].sum())
        quiet.loc[own, GYRO] -= faster @ step.matrix.T
        made = campaign_of(replace(data, blocks=quiet))
        without = _estimate(replace(made, solution=campaign.solution, drifts=campaign.drifts))
        largest.append(_largest(without, present) if without and present else None)
    return largest


def _estimate(campaign: Campaign) -> Estimate | None:
    system = campaign.system("gyro", [], 1.0)
    return None if system is None else system.solve_shared()


def _largest(without: Estimate, present: Estimate) -> float | None:
    own = [
        i
        for i, (kind, _) in enumerate(present.names)
        if kind == "parameter" and present.determined[i]
    ]
    if not own or without.names != present.names:
        return None
    shift = np.abs(present.values - without.values) / present.sigma
    return float(shift[own].max())
