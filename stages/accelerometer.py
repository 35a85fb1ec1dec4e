"""The accelerometers from rests: bias, scale factors, cross terms, mounting, with covariance."""

import numpy as np
import pandas as pd

from stages.contracts import tables
from stages.contracts.stage import Tables, command_line
from stages.estimation.estimates import NAMES, Estimates, reasons
from stages.estimation.stills import Still, averaging_times, stills
from stages.inference import triad
from stages.inference.six_position import Rest, formula, weighted

CURES = {
    "bias": "the rests do not part it from the scale factors: turn the IMU over, so that an axis"
    " points up once and down once",
    "matrix": "no rests differ enough along {axis}: add one with +{axis} up and one with -{axis} up",
}


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
    estimates = Estimates("accelerometer")
    for mount, plan in manoeuvres.groupby("mount", sort=False):
        suffix = "" if manoeuvres["mount"].nunique() == 1 else f"@{mount}"
        found, left = stills(blocks, plan, performed, noise, "accel")
        if not found:
            continue
        estimate = weighted([_rest(still) for still in found], *known_values)
        recorded = np.isfinite([still.mean for still in found]).any(axis=0)
        why = reasons(estimate.determined, recorded, "accelerometer", CURES)
        estimates.add_triad(f"joint{suffix}", estimate, why)
        estimates.add_fit(f"joint{suffix}", estimate, [still.label for still in found], left)
        for seconds in averaging_times(blocks, averaging_steps):
            part, _ = stills(blocks, plan, performed, noise, "accel", seconds)
            shorter = weighted([_rest(still) for still in part], *known_values)
            estimates.add_averaging(f"joint{suffix}", seconds, shorter)
        planned = [_rest(still) for still in found if still.row["do"] == "rest"]
        if planned and (solved := formula(planned, *known_values)) is not None:
            unknowns, covariance = solved
            values = triad.errors_of(unknowns)
            estimates.add(f"six_position{suffix}", NAMES, values, covariance, {})
    return estimates.tables()


def _rest(still: Still) -> Rest:
    return Rest(still.row["position"], still.up_now, still.mean, still.sigma)


if __name__ == "__main__":
    command_line(
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
