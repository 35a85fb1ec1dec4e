"""The accelerometers from rests: bias, scale factors, cross terms, mounting, with covariance."""

from functools import partial

import numpy as np
import pandas as pd

from stages.contracts import tables
from stages.contracts.records import known_of, manoeuvres_of, performed_of
from stages.contracts.stage import Stage, Tables
from stages.estimation.estimates import (
    NAMES,
    Estimates,
    by_mount,
    reasons,
    stops_between_turns,
)
from stages.estimation.free_positions import add_free_accelerometers
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.stills import Still, averaging_times, stills
from stages.inference import triad
from stages.inference.least_squares import with_scatter
from stages.inference.pooled_positions import pooled_positions
from stages.inference.six_position import Rest, formula, weighted

CURES = {
    "bias": "the rests do not part it from the scale factors: turn the IMU over, so that an axis"
    " points up once and down once",
    "matrix": "no rests differ enough along {axis}: add one with +{axis} up, one with -{axis} up",
}
SCATTER = (1e-7, 1.0)  # m/s²: how much rests may differ beyond the noise


def accelerometer(
    blocks: pd.DataFrame,
    manoeuvres: pd.DataFrame,
    performed: pd.DataFrame,
    noise: pd.DataFrame,
    known: pd.DataFrame,
    *,
    averaging_steps: int,
) -> Tables:
    """Parameters of the joint weighted estimate and of S0's and S3's formulas, with covariance.

    Each mount has parameters of its own, for its mounting rotation is one of them.
    """
    given, done, levels = known_of(known), performed_of(performed), NoiseLevels(noise)
    gravity = given["gravity"]
    about = (gravity.number, gravity.scatter, given["position"].scatter)
    estimates = Estimates("accelerometer")
    for suffix, plan in by_mount(manoeuvres_of(manoeuvres)):
        add_free_accelerometers(estimates, suffix, blocks, plan, levels, given)
        found, left = stills(blocks, plan, done, levels, "accel")
        if not found:
            estimates.add_nothing(f"joint{suffix}", "; ".join(left))
            continue
        rests = [_rest(still) for still in found]
        fitted = with_scatter(
            partial(weighted, rests, *about), between=SCATTER, noise_degrees=levels.degrees
        )
        recorded = np.isfinite(np.array([rest.mean for rest in rests])).any(axis=0)
        why = reasons(fitted.estimate.determined, recorded, "accelerometer", CURES)
        estimates.add_triad(f"joint{suffix}", fitted.estimate, why)
        estimates.add_fit(f"joint{suffix}", fitted, [still.label for still in found], left)
        for seconds in averaging_times(found, averaging_steps):
            part = [_rest(still, seconds) for still in found]
            estimates.add_averaging(
                f"joint{suffix}", seconds, weighted(part, *about, fitted.scatter)
            )
        planned = [_rest(still) for still in found if still.manoeuvre.do == "rest"]
        solved = formula(planned, *about, fitted.scatter) if planned else None
        if solved is not None:
            unknowns, covariance = solved
            values = triad.errors_of(unknowns)
            estimates.add(f"six_position{suffix}", NAMES, values, covariance, {})
        rests = [_rest(still) for still in found]
        pooled = pooled_positions(rests, *about, fitted.scatter)
        if pooled is not None and stops_between_turns(plan):
            values = triad.errors_of(pooled.values)
            estimates.add(f"pooled_positions{suffix}", NAMES, values, pooled.covariance, {})
    return estimates.tables()


def _rest(still: Still, seconds: float = np.inf) -> Rest:
    return Rest(still.manoeuvre.position, still.up_now, *still.over(seconds))


STAGE = Stage(
    accelerometer,
    reads={
        "blocks": tables.BLOCKS,
        "manoeuvres": tables.MANOEUVRES,
        "performed": tables.PERFORMED,
        "noise": tables.NOISE,
        "known": tables.KNOWN,
    },
    writes={
        "parameters": tables.PARAMETERS,
        "covariance": tables.COVARIANCE,
        "fit": tables.FIT,
        "averaging": tables.AVERAGING,
        "positions": tables.POSITIONS,
    },
)

if __name__ == "__main__":
    STAGE.command_line()
