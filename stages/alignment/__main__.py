"""`python -m stages.alignment`: the stage on the command line."""

from stages.alignment.stage import STAGE

STAGE.command_line()
