"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import FITTED, RECORDED, Declared, From

DECLARED = Declared(
    reads={
        "simulated": From("simulation", tables.SIMULATED),
        "gaps": From("quality", tables.GAPS),
        "allan": From("noise", tables.ALLAN),
        **RECORDED,
        **FITTED,
    },
    writes={
        "scores": tables.SCORES,
        "effects": tables.EFFECTS,
        "detection_limits": tables.DETECTION_LIMITS,
        "lines": tables.LINES,
        "random_walks": tables.RANDOM_WALKS,
        "drifts_at_rest": tables.DRIFTS_AT_REST,
        "structures": tables.STRUCTURES,
        "structure_points": tables.STRUCTURE_POINTS,
        "structure_manoeuvres": tables.STRUCTURE_MANOEUVRES,
        "findings": tables.EFFECT_FINDINGS,
        "members": tables.MEMBERS,
        "cause_positions": tables.CAUSE_POSITIONS,
        "temperature_curves": tables.TEMPERATURE_CURVES,
        "score_vector": tables.SCORE_VECTOR,
        "information_matrix": tables.INFORMATION_MATRIX,
    },
    streams=("simulated",),
)
