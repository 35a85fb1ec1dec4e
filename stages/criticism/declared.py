"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import FITTED, RECORDED, Declared, From, by_name

DECLARED = Declared(
    reads={
        "simulated": From("simulation", tables.SIMULATED),
        "gaps": From("quality", tables.GAPS),
        "allan": From("noise", tables.ALLAN),
        **RECORDED,
        **FITTED,
    },
    writes={
        **by_name(tables.SCORES, tables.EFFECTS, tables.DETECTION_LIMITS, tables.LINES),
        **by_name(tables.RANDOM_WALKS, tables.DRIFTS_AT_REST, tables.STRUCTURES),
        **by_name(tables.STRUCTURE_POINTS, tables.STRUCTURE_MANOEUVRES),
        "findings": tables.EFFECT_FINDINGS,
        **by_name(tables.MEMBERS, tables.CAUSE_POSITIONS, tables.TEMPERATURE_CURVES),
        **by_name(tables.SCORE_VECTOR, tables.INFORMATION_MATRIX),
    },
    streams=("simulated",),
)
