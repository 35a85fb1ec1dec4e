"""The gyros from turns and rests: bias, scale factors, cross terms, mounting, with covariance."""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.estimates import Estimates, by_mount, reasons, stops_between_turns
from inertial.campaign.gyroscope_methods import add_formulas, add_turn_and_stop
from inertial.campaign.noise_levels import NoiseLevels
from inertial.campaign.rate_segments import GyroInputs, gyro_inputs
from inertial.campaign.records import known_of, manoeuvres_of, performed_of, share_a_clock
from inertial.campaign.static_positions import averaging_times
from inertial.estimation import gyroscopes
from inertial.tables.stage import Stage, Tables
from stages.gyroscope.declared import DECLARED
from stages.gyroscope.free_positions import add_free_gyros

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
        fitted = gyroscopes.fitted(inputs.rests, *moving, levels.degrees)
        why = reasons(fitted.estimate.determined, _channels(inputs), "gyro", CURES)
        estimates.add_triad(f"joint{suffix}", fitted.estimate, why)
        estimates.add_fit(f"joint{suffix}", fitted, inputs.used, inputs.left_out)
        linear = gyroscopes.about(gyroscopes.around_of(fitted.estimate, inputs.earth), *moving)
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


STAGE = Stage(gyroscope, DECLARED)
