"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        "channel_repairs": From("segment", tables.CHANNEL_REPAIRS),
        "blocks": From("segment", tables.BLOCKS),
        "segments": From("segment", tables.SEGMENTS),
        "manoeuvres": From("segment", tables.MANOEUVRES),
        "performed": From("segment", tables.PERFORMED),
        "levels": From("noise", tables.LEVELS),
        "known": From("plan", tables.KNOWN),
        "clocks": From("decode", tables.CLOCKS),
        "accelerometer_parameters": From("accelerometer", tables.PARAMETERS),
        "accelerometer_positions": From("accelerometer", tables.POSITIONS),
        "accelerometer_switch_ons": From("accelerometer", tables.SWITCH_ONS),
        "gyroscope_parameters": From("gyroscope", tables.PARAMETERS),
        "gyroscope_positions": From("gyroscope", tables.POSITIONS),
        "gyroscope_switch_ons": From("gyroscope", tables.SWITCH_ONS),
    },
    writes={
        "simulated": tables.SIMULATED,
        "fidelity": tables.FIDELITY,
    },
    streams=("samples",),
)
