"""`python -m stages.plan`: the stage on the command line."""

from stages.plan.stage import STAGE

STAGE.command_line()
