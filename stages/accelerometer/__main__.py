"""`python -m stages.accelerometer`: the stage on the command line."""

from stages.accelerometer.stage import STAGE

STAGE.command_line()
