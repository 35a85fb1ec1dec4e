"""`python -m stages.report`: the stage on the command line, in the language of its settings."""

import json
import sys

from inertial.text.messages import ENGLISH, speak

if "--settings" in sys.argv[:-1]:
    speak(json.loads(sys.argv[sys.argv.index("--settings") + 1]).get("language", ENGLISH))

from stages.report.stage import STAGE

STAGE.command_line()
