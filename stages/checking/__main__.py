"""Is anything wrong with a recording?

    python -m stages.checking --campaign demo

It reads what quality and segment found, which `make check` lets the workflow make first. It ends
with 0 where nothing spoils a result, with 1 where something does, and with 2 where there is nothing
to read.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from inertial.tables.errors import Refusal
from inertial.text.numbers import visible
from stages.checking.recording import recording
from stages.checking.verdict import as_text, spoiled


def main(arguments: Sequence[str] | None = None) -> int:
    """Print what is wrong, the worst first; the exit code."""
    parser = argparse.ArgumentParser(prog="check", description="what is wrong with a recording")
    parser.add_argument("--campaign", required=True, help="name of the campaign")
    parser.add_argument("--data", type=Path, default=Path("data"), help="holds derived/")
    given = parser.parse_args(arguments)
    try:
        found = recording(given.data / "derived" / given.campaign)
    except Refusal as refusal:
        sys.stderr.write(visible(f"check: {refusal}\n"))
        return 2
    sys.stdout.write(visible(as_text(found, given.campaign)))
    return 1 if spoiled(found) else 0


if __name__ == "__main__":
    sys.stdout.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    sys.stderr.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    sys.exit(main())
