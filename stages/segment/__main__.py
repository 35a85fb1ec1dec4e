"""`python -m stages.segment`: the stage on the command line."""

from stages.segment.stage import STAGE

STAGE.command_line()
