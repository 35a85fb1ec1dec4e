"""`python -m stages.simulation`: the stage on the command line."""

from stages.simulation.stage import STAGE

STAGE.command_line()
