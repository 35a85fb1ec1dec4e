"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, by_name

DECLARED = Declared(
    writes={
        **by_name(tables.CAMPAIGN, tables.KNOWN, tables.IDEAL_READINGS, tables.SENSORS),
        **by_name(tables.LOGS, tables.RANGES, tables.COUNT_SIZES, tables.INPUTS, tables.PUBLISHED),
        **by_name(tables.CERTIFICATE, tables.STANDARDS, tables.TOLERANCES, tables.ALLOWED_CHANGES),
        **by_name(tables.MANOEUVRES, tables.PURPOSES, tables.REPAIRS, tables.ACCEPTED),
        "guesses": tables.GUESSES,
    },
    files=("campaign", "raw", "instruments", "published", "laboratory"),
)
