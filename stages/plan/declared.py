"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared

DECLARED = Declared(
    writes={
        "campaign": tables.CAMPAIGN,
        "known": tables.KNOWN,
        "sensors": tables.SENSORS,
        "logs": tables.LOGS,
        "ranges": tables.RANGES,
        "count_sizes": tables.COUNT_SIZES,
        "inputs": tables.INPUTS,
        "published": tables.PUBLISHED,
        "manoeuvres": tables.MANOEUVRES,
        "repairs": tables.REPAIRS,
        "accepted": tables.ACCEPTED,
    },
    files=("campaign", "raw", "instruments", "published"),
)
