"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        "channel_repairs": From("segment", tables.CHANNEL_REPAIRS),
        "traces": From("segment", tables.TRACES),
        "channel_statistics": From("quality", tables.CHANNEL_STATISTICS),
        "ranges": From("plan", tables.RANGES),
        "masks": From("quality", tables.MASKS),
        "segments": From("segment", tables.SEGMENTS),
        "blocks": From("segment", tables.BLOCKS),
        "campaign": From("plan", tables.CAMPAIGN),
        "manoeuvres": From("segment", tables.MANOEUVRES),
        "performed": From("segment", tables.PERFORMED),
        "levels": From("noise", tables.LEVELS),
        "known": From("plan", tables.KNOWN),
        "clocks": From("decode", tables.CLOCKS),
        "accelerometer_fit": From("accelerometer", tables.FIT),
        "gyroscope_fit": From("gyroscope", tables.FIT),
        "accelerometer_parameters": From("accelerometer", tables.PARAMETERS),
        "accelerometer_positions": From("accelerometer", tables.POSITIONS),
        "accelerometer_switch_ons": From("accelerometer", tables.SWITCH_ONS),
        "gyroscope_parameters": From("gyroscope", tables.PARAMETERS),
        "gyroscope_positions": From("gyroscope", tables.POSITIONS),
        "gyroscope_switch_ons": From("gyroscope", tables.SWITCH_ONS),
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
