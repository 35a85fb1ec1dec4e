"""`python -m stages.quality`: the stage on the command line."""

from stages.quality.stage import STAGE

STAGE.command_line()
