"""`python -m stages.comparison`: the stage on the command line."""

from stages.comparison.stage import STAGE

STAGE.command_line()
