"""`python -m stages.export`: the stage on the command line."""

from stages.export.stage import STAGE

STAGE.command_line()
