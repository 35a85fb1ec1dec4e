"""What the stage reads and writes."""

from inertial.tables.campaign_inputs import ESTIMATION

DECLARED = ESTIMATION
