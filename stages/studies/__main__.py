"""`python -m stages.studies`: the stage on the command line."""

from stages.studies.stage import STAGE

STAGE.command_line()
