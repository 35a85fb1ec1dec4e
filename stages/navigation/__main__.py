"""`python -m stages.navigation`: the stage on the command line."""

from stages.navigation.stage import STAGE

STAGE.command_line()
