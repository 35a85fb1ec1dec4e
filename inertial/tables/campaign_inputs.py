"""What stages that work on the mounts of a campaign read alike: it, and its joint result."""

from inertial import tables
from inertial.tables.declared import Declared, From

RECORDED = {
    "blocks": From("segment", tables.BLOCKS),
    "manoeuvres": From("segment", tables.MANOEUVRES),
    "performed": From("segment", tables.PERFORMED),
    "levels": From("noise", tables.LEVELS),
    "known": From("plan", tables.KNOWN),
    "clocks": From("decode", tables.CLOCKS),
}
ESTIMATED = {
    "accelerometer_parameters": From("accelerometer", tables.PARAMETERS),
    "accelerometer_positions": From("accelerometer", tables.POSITIONS),
    "accelerometer_switch_ons": From("accelerometer", tables.SWITCH_ONS),
    "gyroscope_parameters": From("gyroscope", tables.PARAMETERS),
    "gyroscope_positions": From("gyroscope", tables.POSITIONS),
    "gyroscope_switch_ons": From("gyroscope", tables.SWITCH_ONS),
}
# With what the fits say of scatter, random walks and switch-ons.
FITTED = ESTIMATED | {
    "accelerometer_fit": From("accelerometer", tables.FIT),
    "gyroscope_fit": From("gyroscope", tables.FIT),
}

# Both stages of estimation, each of its sensor.
ESTIMATION = Declared(
    reads=RECORDED,
    writes={
        "parameters": tables.PARAMETERS,
        "covariance": tables.COVARIANCE,
        "fit": tables.FIT,
        "fit_manoeuvres": tables.FIT_MANOEUVRES,
        "averaging": tables.AVERAGING,
        "positions": tables.POSITIONS,
        "switch_ons": tables.SWITCH_ONS,
        "wanted": tables.WANTED,
        "findings": tables.FINDINGS,
    },
)
