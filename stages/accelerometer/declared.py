"""What the stage reads and writes."""

from inertial.tables.declared import ESTIMATION

DECLARED = ESTIMATION
