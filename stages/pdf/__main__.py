"""`python -m stages.pdf`: the stage on the command line."""

from stages.pdf.stage import STAGE

STAGE.command_line()
