"""`python -m stages.extension`: the stage on the command line."""

from stages.extension.stage import STAGE

STAGE.command_line()
