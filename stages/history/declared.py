"""What the stage reads and writes, and the folder of the archive."""

from inertial import tables
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "campaign": From("plan", tables.CAMPAIGN),
        "inputs": From("plan", tables.INPUTS),
        "accelerometer_parameters": From("accelerometer", tables.PARAMETERS),
        "gyroscope_parameters": From("gyroscope", tables.PARAMETERS),
        "accelerometer_fit": From("accelerometer", tables.FIT),
        "gyroscope_fit": From("gyroscope", tables.FIT),
        "result": From("diagnosis", tables.PARAMETERS, "result"),
        "covariance": From("diagnosis", tables.COVARIANCE),
        "verdict": From("diagnosis", tables.VERDICTS, "verdict"),
        "allowed_changes": From("plan", tables.ALLOWED_CHANGES),
        "published": From("plan", tables.PUBLISHED),
        "growing": From("studies", tables.WINDOWS, "growing"),
        "motions": From("studies", tables.MOTIONS),
        "blocks": From("segment", tables.BLOCKS),
        "known": From("plan", tables.KNOWN),
        "manoeuvres": From("segment", tables.MANOEUVRES),
        "uncertainty_budget": From("compensation", tables.UNCERTAINTY_BUDGET),
    },
    writes={
        "archived": tables.ARCHIVED,
        "earlier": tables.EARLIER,
        "published_differences": tables.DIFFERENCES,
        "repeatability": tables.REPEATABILITY,
        "changes": tables.CHANGES,
        "jumps": tables.JUMPS,
        "forecast": tables.FORECAST,
    },
    files=("archive",),
)
