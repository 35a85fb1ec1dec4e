"""`python -m stages.compensation`: the stage on the command line."""

from stages.compensation.stage import STAGE

STAGE.command_line()
