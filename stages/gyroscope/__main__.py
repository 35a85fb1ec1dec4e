"""`python -m stages.gyroscope`: the stage on the command line."""

from stages.gyroscope.stage import STAGE

STAGE.command_line()
