"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared

DECLARED = Declared(
    writes={
        "campaign": tables.CAMPAIGN,
        "known": tables.KNOWN,
        "ideal_readings": tables.IDEAL_READINGS,
        "sensors": tables.SENSORS,
        "logs": tables.LOGS,
        "ranges": tables.RANGES,
        "count_sizes": tables.COUNT_SIZES,
        "inputs": tables.INPUTS,
        "published": tables.PUBLISHED,
        "certificate": tables.CERTIFICATE,
        "standards": tables.STANDARDS,
        "tolerances": tables.TOLERANCES,
        "allowed_changes": tables.ALLOWED_CHANGES,
        "manoeuvres": tables.MANOEUVRES,
        "purposes": tables.PURPOSES,
        "repairs": tables.REPAIRS,
        "accepted": tables.ACCEPTED,
        "guesses": tables.GUESSES,
    },
    files=("campaign", "raw", "instruments", "published", "laboratory"),
)
