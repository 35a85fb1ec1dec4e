"""What the stage reads and writes, and the folder of the archive."""

from inertial import tables
from inertial.tables.declared import ESTIMATING, Declared, From, of_stage, of_stages

DECLARED = Declared(
    reads={
        **of_stage("plan", tables.CAMPAIGN, tables.INPUTS, tables.ALLOWED_CHANGES),
        **of_stage("plan", tables.PUBLISHED, tables.KNOWN),
        **of_stages(ESTIMATING, tables.PARAMETERS, tables.FIT),
        "result": From("diagnosis", tables.PARAMETERS, "result"),
        "covariance": From("diagnosis", tables.COVARIANCE),
        "verdict": From("diagnosis", tables.VERDICTS, "verdict"),
        "growing": From("studies", tables.WINDOWS, "growing"),
        "motions": From("studies", tables.MOTIONS),
        **of_stage("segment", tables.BLOCKS, tables.MANOEUVRES),
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
