"""What stages that work on the mounts of a campaign read alike: it, and its joint result."""

from inertial import tables
from inertial.tables.declared import Declared, From, of_stage, of_stages

ESTIMATING = ("accelerometer", "gyroscope")
RECORDED = {
    **of_stage("segment", tables.BLOCKS, tables.MANOEUVRES, tables.PERFORMED),
    "levels": From("noise", tables.LEVELS),
    "known": From("plan", tables.KNOWN),
    "clocks": From("decode", tables.CLOCKS),
}
ESTIMATED = of_stages(ESTIMATING, tables.PARAMETERS, tables.POSITIONS, tables.SWITCH_ONS)
# With what the fits say of scatter, random walks and switch-ons.
FITTED = ESTIMATED | of_stages(ESTIMATING, tables.FIT)

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
