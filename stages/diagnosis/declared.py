"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import ESTIMATING, Declared, From, of_stage, of_stages

DECLARED = Declared(
    reads={
        **of_stages(("quality", "noise", *ESTIMATING), tables.FINDINGS),
        **of_stages(["segment"], tables.FINDINGS, tables.REPAIRS),
        "criticism_findings": From("criticism", tables.EFFECT_FINDINGS, "findings"),
        **of_stage("criticism", tables.MEMBERS, tables.CAUSE_POSITIONS),
        **of_stage("criticism", tables.STRUCTURE_MANOEUVRES, tables.EFFECTS, tables.RANDOM_WALKS),
        "swept": From("criticism", tables.TEMPERATURE_CURVES),
        "plan_repairs": From("plan", tables.REPAIRS),
        **of_stage("segment", tables.CHANNEL_REPAIRS, tables.MASKS, tables.SEGMENTS),
        **of_stage("segment", tables.MANOEUVRES, tables.PERFORMED),
        **of_stage("quality", tables.GAPS, tables.CHANNEL_STATISTICS),
        "clocks": From("decode", tables.CLOCKS),
        **of_stage("plan", tables.TOLERANCES, tables.KNOWN),
        "terms": From("noise", tables.NOISE_TERMS, "terms"),
        **of_stages((*ESTIMATING, "extension"), tables.PARAMETERS, tables.COVARIANCE, tables.FIT),
        **of_stage("extension", tables.CANDIDATES, tables.CANDIDATE_EFFECTS, tables.DRIFT_MEANS),
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
