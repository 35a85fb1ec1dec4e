"""`python -m stages <stage> data/derived/<campaign>`: a stage, in the language of its settings."""

import sys
from importlib import import_module

from inertial.text.messages import speak_as_set
from stages import ORDER

if __name__ == "__main__":
    if not {*ORDER}.intersection(sys.argv[1:2]):
        sys.exit(f"python -m stages <stage> data/derived/<campaign>: one of {', '.join(ORDER)}")
    speak_as_set(sys.argv)
    import_module(f"stages.{sys.argv.pop(1)}.stage").STAGE.command_line()
