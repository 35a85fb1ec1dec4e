"""`python -m stages.report`: the stage on the command line."""

from stages.report.stage import STAGE

STAGE.command_line()
