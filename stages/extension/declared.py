"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import (
    ESTIMATING,
    FITTED,
    RECORDED,
    Declared,
    From,
    by_name,
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
        **by_name(tables.PARAMETERS, tables.COVARIANCE, tables.FIT, tables.FIT_MANOEUVRES),
        **by_name(tables.GAIN, tables.GAIN_EFFECTS, tables.HELD_OUT, tables.MOVED, tables.WORTH),
        **by_name(tables.CANDIDATES, tables.CANDIDATE_EFFECTS, tables.WARM_UP, tables.DRIFT_MEANS),
        "proposed": tables.PROPOSED,
    },
    unfolded=("proposed",),
    streams=("simulated",),
)
