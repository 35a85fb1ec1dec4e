"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import (
    ESTIMATING,
    FITTED,
    RECORDED,
    Declared,
    From,
    of_stage,
    of_stages,
)

DECLARED = Declared(
    reads={
        "simulated": From("simulation", tables.SIMULATED),
        "criticism_findings": From("criticism", tables.EFFECT_FINDINGS, "findings"),
        **of_stage("criticism", tables.MEMBERS, tables.EFFECTS, tables.STRUCTURE_MANOEUVRES),
        **of_stage("criticism", tables.CAUSE_POSITIONS, tables.RANDOM_WALKS, tables.DRIFTS_AT_REST),
        **RECORDED,
        **FITTED,
        **of_stages(ESTIMATING, tables.FIT_MANOEUVRES),
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
