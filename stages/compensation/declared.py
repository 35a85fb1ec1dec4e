"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import FITTED, RECORDED, Declared, From, of_stage

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        **of_stage("segment", tables.CHANNEL_REPAIRS, tables.TRACES, tables.MASKS, tables.SEGMENTS),
        "channel_statistics": From("quality", tables.CHANNEL_STATISTICS),
        **of_stage("plan", tables.RANGES, tables.CAMPAIGN),
        **RECORDED,
        **FITTED,
        "extended_fit": From("extension", tables.FIT),
        "result": From("diagnosis", tables.PARAMETERS, "result"),
        "simulated": From("simulation", tables.SIMULATED),
    },
    writes={
        "compensated": tables.COMPENSATED,
        "checks": tables.CHECKS,
        "residuals": tables.RESIDUALS,
        "characteristics": tables.CHARACTERISTICS,
        "uncertainty_budget": tables.UNCERTAINTY_BUDGET,
        "compensated_traces": tables.TRACES,
        "findings": tables.FINDINGS,
    },
    streams=("samples", "simulated"),
)
