"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.campaign_inputs import FITTED, RECORDED
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        "channel_repairs": From("segment", tables.CHANNEL_REPAIRS),
        "traces": From("segment", tables.TRACES),
        "channel_statistics": From("quality", tables.CHANNEL_STATISTICS),
        "ranges": From("plan", tables.RANGES),
        "masks": From("segment", tables.MASKS),
        "segments": From("segment", tables.SEGMENTS),
        **RECORDED,
        "campaign": From("plan", tables.CAMPAIGN),
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
