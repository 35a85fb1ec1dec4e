"""`python -m stages.diagnosis`: the stage on the command line."""

from stages.diagnosis.stage import STAGE

STAGE.command_line()
