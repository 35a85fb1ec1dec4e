"""The accelerometers from rests and steady turns: bias, M, mounting, with covariance."""

from collections.abc import Iterator, Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.estimates import Estimates, by_mount, reasons, stops_between_turns
from inertial.campaign.findings import Finding, table_of
from inertial.campaign.noise_levels import NoiseLevels
from inertial.campaign.records import known_of, manoeuvres_of, performed_of, share_a_clock
from inertial.campaign.static_positions import Still, averaging_times, stills
from inertial.campaign.unknown_attitude import add_free_accelerometers
from inertial.estimation import accelerometers, triad
from inertial.estimation.accelerometers import Rest, equations, weighted
from inertial.estimation.least_squares import INCONSISTENT
from inertial.estimation.position_outlier import off_position
from inertial.tables.stage import Stage, Tables
from stages.accelerometer.declared import DECLARED
from stages.accelerometer.position_findings import findings
from stages.accelerometer.rotating_positions import LEVER_ARM, turning_rests
from stages.accelerometer.source_formulas import add_pooled_positions, add_six_positions

Array = NDArray[np.float64]

CURES = {
    "bias": "the rests do not part it from the scale factors: turn the IMU over, so that an axis"
    " points up once and down once",
    "matrix": "no rests differ enough along {axis}: add one with +{axis} up, one with -{axis} up",
}


def accelerometer(
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
    """Parameters of the joint weighted estimate and of S0's and S3's formulas, with covariance.

    Each mount has parameters of its own, for its mounting rotation is one of them.
    """
    given, done, levels = known_of(known), performed_of(performed), NoiseLevels(noise)
    shared = share_a_clock(clocks)
    gravity = given["gravity"]
    about = (gravity.number, gravity.scatter, given["position"].scatter)
    estimates = Estimates("accelerometer")
    told: list[Finding] = []
    for suffix, plan in by_mount(manoeuvres_of(manoeuvres)):
        add_free_accelerometers(estimates, suffix, blocks, plan, levels, given)
        found, left = stills(blocks, plan, done, levels, "accel", shared)
        if not found:
            estimates.add_nothing(f"joint{suffix}", "; ".join(left))
            continue
        turns = turning_rests(blocks, plan, done, levels, shared)
        wide = LEVER_ARM if turns else None
        moving = [rest for _, rest in turns]
        rests = [*(_rest(still) for still in found), *moving]
        fitted = accelerometers.fitted(rests, *about, levels.degrees, wide)
        recorded = np.isfinite(np.array([rest.mean for rest in rests])).any(axis=0)
        why = reasons(fitted.estimate.determined, recorded, "accelerometer", CURES)
        estimates.add_triad(f"joint{suffix}", fitted.estimate, why)
        used = [still.label for still in found] + list(dict.fromkeys(label for label, _ in turns))
        estimates.add_fit(f"joint{suffix}", fitted, used, left)
        matrix = fitted.estimate.values[:9].reshape(3, 3)
        if fitted.p_value < INCONSISTENT:
            told += _off(rests, about, matrix, wide, suffix)
        for seconds in averaging_times(found, averaging_steps):
            part = [*(_rest(still, seconds) for still in found), *moving]
            shorter = equations(part, *about, fitted.scatter, matrix, wide, fitted.walk)
            estimates.add_averaging(f"joint{suffix}", seconds, shorter.solve_shared())
        stops = [_rest(still) for still in found]
        planned = [
            pair for pair in zip(found, stops, strict=True) if pair[0].manoeuvre.do == "rest"
        ]
        add_six_positions(estimates, suffix, planned, about, fitted.scatter, wanted_bias)
        if stops_between_turns(plan):
            add_pooled_positions(estimates, suffix, stops, about, fitted.scatter)
    return {**estimates.tables(), "findings": table_of(told)}


def _off(
    rests: list[Rest],
    about: tuple[float, float, float],
    matrix: Array,
    wide: Mapping[str, float] | None,
    suffix: str,
) -> Iterator[Finding]:
    """The position that does not fit, where one alone explains why the model does not."""
    off = off_position(rests, *about, matrix, wide)
    if off is not None:
        sigma = weighted(rests, *about, wide=wide).sigma[: triad.UNKNOWNS]
        yield from findings(off, sigma, suffix)


def _rest(still: Still, seconds: float = np.inf) -> Rest:
    stretch = still.during(seconds)
    return Rest(still.manoeuvre.position, still.up_now, *still.over(seconds), stretch=stretch)


STAGE = Stage(accelerometer, DECLARED)
