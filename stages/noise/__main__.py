"""`python -m stages.noise`: the stage on the command line."""

from stages.noise.stage import STAGE

STAGE.command_line()
