"""`python -m stages.history`: the stage on the command line."""

from stages.history.stage import STAGE

STAGE.command_line()
