"""The accelerometers from rests: bias, scale factors, cross terms, mounting, with covariance."""

import numpy as np
import pandas as pd

from stages.contracts import tables
from stages.contracts.stage import Stage, Tables
from stages.estimation.estimates import NAMES, Estimates, reasons
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.stills import Still, averaging_times, stills
from stages.inference import triad
from stages.inference.least_squares import with_scatter
from stages.inference.six_position import Rest, formula, weighted

CURES = {
    "bias": "the rests do not part it from the scale factors: turn the IMU over, so that an axis"
    " points up once and down once",
    "matrix": "no rests differ enough along {axis}: add one with +{axis} up and one with -{axis} up",
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
    """Parameters of the joint weighted estimate and of S0's formula, with their covariance.

    Each mount has parameters of its own, for its mounting rotation is one of them.
    """
    given = known.set_index("quantity")
    gravity, gravity_sigma = (float(given.loc["gravity", c]) for c in ("value", "sigma"))
    known_values = (gravity, gravity_sigma, float(given.loc["position", "sigma"]))
    levels = NoiseLevels(noise)
    estimates = Estimates("accelerometer")
    for mount, plan in manoeuvres.groupby("mount", sort=False):
        suffix = "" if manoeuvres["mount"].nunique() == 1 else f"@{mount}"
        found, left = stills(blocks, plan, performed, levels, "accel")
        if not found:
            estimates.add_nothing(f"joint{suffix}", "; ".join(left))
            continue
        rests = [_rest(still) for still in found]
        fitted = with_scatter(
            lambda scatter, rests=rests: weighted(rests, *known_values, scatter),
            SCATTER,
            levels.degrees,
        )
        estimate, scatter, _ = fitted
        recorded = np.isfinite([rest.mean for rest in rests]).any(axis=0)
        why = reasons(estimate.determined, recorded, "accelerometer", CURES)
        estimates.add_triad(f"joint{suffix}", estimate, why)
        estimates.add_fit(f"joint{suffix}", fitted, [still.label for still in found], left)
        for seconds in averaging_times(found, averaging_steps):
            shorter = weighted([_rest(still, seconds) for still in found], *known_values, scatter)
            estimates.add_averaging(f"joint{suffix}", seconds, shorter)
        planned = [_rest(still) for still in found if still.row["do"] == "rest"]
        if planned and (solved := formula(planned, *known_values, scatter)) is not None:
            unknowns, covariance = solved
            values = triad.errors_of(unknowns)
            estimates.add(f"six_position{suffix}", NAMES, values, covariance, {})
    return estimates.tables()


def _rest(still: Still, seconds: float = np.inf) -> Rest:
    return Rest(still.row["position"], still.up_now, *still.over(seconds))


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
    },
)

if __name__ == "__main__":
    STAGE.command_line()
