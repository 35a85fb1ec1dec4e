"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.campaign_inputs import RECORDED
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        **RECORDED,
        "clocks": From("decode", tables.CLOCKS),
    },
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
