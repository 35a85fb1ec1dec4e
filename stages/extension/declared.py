"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.campaign_inputs import FITTED, RECORDED
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "simulated": From("simulation", tables.SIMULATED),
        "criticism_findings": From("criticism", tables.EFFECT_FINDINGS, "findings"),
        "members": From("criticism", tables.MEMBERS),
        "effects": From("criticism", tables.EFFECTS),
        "structure_manoeuvres": From("criticism", tables.STRUCTURE_MANOEUVRES),
        "cause_positions": From("criticism", tables.CAUSE_POSITIONS),
        "random_walks": From("criticism", tables.RANDOM_WALKS),
        "drifts_at_rest": From("criticism", tables.DRIFTS_AT_REST),
        **RECORDED,
        **FITTED,
        "accelerometer_fit_manoeuvres": From("accelerometer", tables.FIT_MANOEUVRES),
        "gyroscope_fit_manoeuvres": From("gyroscope", tables.FIT_MANOEUVRES),
    },
    writes={
        "parameters": tables.PARAMETERS,
        "covariance": tables.COVARIANCE,
        "fit": tables.FIT,
        "fit_manoeuvres": tables.FIT_MANOEUVRES,
        "gain": tables.GAIN,
        "gain_effects": tables.GAIN_EFFECTS,
        "held_out": tables.HELD_OUT,
        "moved": tables.MOVED,
        "worth": tables.WORTH,
        "candidates": tables.CANDIDATES,
        "candidate_effects": tables.CANDIDATE_EFFECTS,
        "warm_up": tables.WARM_UP,
        "drift_means": tables.DRIFT_MEANS,
        "proposed": tables.PROPOSED,
    },
    unfolded=("proposed",),
    streams=("simulated",),
)
