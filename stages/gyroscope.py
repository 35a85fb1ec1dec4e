"""The gyros from turns and rests: bias, scale factors, cross terms, mounting, with covariance."""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts import tables
from stages.contracts.records import known_of, manoeuvres_of, performed_of, share_a_clock
from stages.contracts.stage import Stage, Tables
from stages.estimation.between_rests import add_free_gyros
from stages.estimation.estimates import Estimates, by_mount, reasons, stops_between_turns
from stages.estimation.gyro_formulas import add_formulas, add_turn_and_stop
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.stills import averaging_times
from stages.estimation.turns import GyroInputs, gyro_inputs
from stages.inference import whole_turns

CURES = {
    "bias": "neither a rest nor a turn there and back shows it: add a rest",
    "matrix": "no whole turn about {axis} was recorded: add one of 360° about {axis}",
}


def gyroscope(
    blocks: pd.DataFrame,
    manoeuvres: pd.DataFrame,
    performed: pd.DataFrame,
    noise: pd.DataFrame,
    known: pd.DataFrame,
    clocks: pd.DataFrame,
    *,
    averaging_steps: int,
    wanted_bias: float,
) -> Tables:
    """Parameters of the joint estimate and of the sources' formulas, with covariance.

    Each mount has parameters of its own, for its mounting rotation is one of them.
    """
    given, done, levels = known_of(known), performed_of(performed), NoiseLevels(noise)
    shared = share_a_clock(clocks)
    estimates = Estimates("gyroscope")
    for suffix, plan in by_mount(manoeuvres_of(manoeuvres)):
        add_free_gyros(estimates, suffix, blocks, plan, levels, given)
        inputs = gyro_inputs(blocks, plan, done, levels, given, shared)
        if inputs.nothing:
            estimates.add_nothing(f"joint{suffix}", "; ".join(inputs.left_out))
            continue
        moving = (inputs.turns, inputs.steadies, inputs.earth, inputs.position_sigma)
        fitted = whole_turns.fitted(inputs.rests, *moving, levels.degrees)
        why = reasons(fitted.estimate.determined, _channels(inputs), "gyro", CURES)
        estimates.add_triad(f"joint{suffix}", fitted.estimate, why)
        estimates.add_fit(f"joint{suffix}", fitted, inputs.used, inputs.left_out)
        linear = whole_turns.about(whole_turns.around_of(fitted.estimate, inputs.earth), *moving)
        for seconds in averaging_times(inputs.stills, averaging_steps):
            shorter = linear.system(inputs.first_of_rests(seconds), fitted.scatter, fitted.walk)
            estimates.add_averaging(f"joint{suffix}", seconds, shorter.solve_shared())
        add_formulas(estimates, suffix, inputs, levels, fitted, wanted_bias)
        if stops_between_turns(plan):
            add_turn_and_stop(estimates, suffix, inputs, fitted.scatter)
    return estimates.tables()


def _channels(inputs: GyroInputs) -> NDArray[np.bool_]:
    """Which gyros are in the logs, (3,)."""
    readings = [rest.mean for rest in inputs.rests]
    readings += [steady.mean for steady in inputs.steadies]
    readings += [turn.sums.sum(axis=0) for turn in inputs.turns]
    return np.asarray(np.isfinite(np.array(readings)).any(axis=0))


STAGE = Stage(
    gyroscope,
    reads={
        "blocks": tables.BLOCKS,
        "manoeuvres": tables.MANOEUVRES,
        "performed": tables.PERFORMED,
        "noise": tables.NOISE,
        "known": tables.KNOWN,
        "clocks": tables.CLOCKS,
    },
    writes={
        "parameters": tables.PARAMETERS,
        "covariance": tables.COVARIANCE,
        "fit": tables.FIT,
        "averaging": tables.AVERAGING,
        "positions": tables.POSITIONS,
        "wanted": tables.WANTED,
    },
)

if __name__ == "__main__":
    STAGE.command_line()
