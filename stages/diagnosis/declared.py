"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "quality_findings": From("quality", tables.FINDINGS),
        "segment_findings": From("segment", tables.FINDINGS),
        "noise_findings": From("noise", tables.FINDINGS),
        "accelerometer_findings": From("accelerometer", tables.FINDINGS),
        "gyroscope_findings": From("gyroscope", tables.FINDINGS),
        "criticism_findings": From("criticism", tables.EFFECT_FINDINGS, "findings"),
        "members": From("criticism", tables.MEMBERS),
        "cause_positions": From("criticism", tables.CAUSE_POSITIONS),
        "structure_manoeuvres": From("criticism", tables.STRUCTURE_MANOEUVRES),
        "effects": From("criticism", tables.EFFECTS),
        "random_walks": From("criticism", tables.RANDOM_WALKS),
        "swept": From("criticism", tables.TEMPERATURE_CURVES),
        "plan_repairs": From("plan", tables.REPAIRS),
        "segment_repairs": From("segment", tables.REPAIRS),
        "channel_repairs": From("segment", tables.CHANNEL_REPAIRS),
        "masks": From("segment", tables.MASKS),
        "gaps": From("quality", tables.GAPS),
        "channel_statistics": From("quality", tables.CHANNEL_STATISTICS),
        "clocks": From("decode", tables.CLOCKS),
        "segments": From("segment", tables.SEGMENTS),
        "manoeuvres": From("segment", tables.MANOEUVRES),
        "tolerances": From("plan", tables.TOLERANCES),
        "terms": From("noise", tables.NOISE_TERMS, "terms"),
        "known": From("plan", tables.KNOWN),
        "performed": From("segment", tables.PERFORMED),
        **{
            f"{stage}_{table.name}": From(stage, table)
            for stage in ("accelerometer", "gyroscope", "extension")
            for table in (tables.PARAMETERS, tables.COVARIANCE, tables.FIT)
        },
        "candidates": From("extension", tables.CANDIDATES),
        "candidate_effects": From("extension", tables.CANDIDATE_EFFECTS),
        "drift_means": From("extension", tables.DRIFT_MEANS),
    },
    writes={
        "causes": tables.CAUSES,
        "members": tables.CAUSE_MEMBERS,
        "consequences": tables.CONSEQUENCES,
        "result": tables.PARAMETERS,
        "covariance": tables.COVARIANCE,
        "conformity": tables.CONFORMITY,
        "verdict": tables.VERDICTS,
        "temperature_curves": tables.TEMPERATURE_CURVES,
    },
)
