"""`python -m stages.criticism`: the stage on the command line."""

from stages.criticism.stage import STAGE

STAGE.command_line()
