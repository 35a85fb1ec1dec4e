"""`python -m stages.decode`: the stage on the command line."""

from stages.decode.stage import STAGE

STAGE.command_line()
