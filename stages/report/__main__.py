"""`python -m stages.report`: the stage on the command line, in the language of its settings."""

import sys

from inertial.text.messages import speak_as_set

if __name__ == "__main__":
    speak_as_set(sys.argv)

from stages.report.stage import STAGE

STAGE.command_line()
