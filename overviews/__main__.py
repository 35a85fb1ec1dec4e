"""`python -m overviews <page> <name>…`: a page of several campaigns, in the language as set."""

import argparse
import json
import sys
from importlib import import_module
from pathlib import Path

from inertial.text.messages import speak_as_set

if __name__ == "__main__":
    speak_as_set(sys.argv)

from inertial.tables.code import code_of, hash_of
from inertial.tables.errors import Refusal
from inertial.tables.whole_files import write_whole
from inertial.text.numbers import visible

PAGES = {  # each with what is named
    "index": "all campaigns that there are",
    "history": "the serial number of an IMU, as its folder in the archive is called",
    "compare": "two campaigns",
    "fleet": "the fleet, and its campaigns",
}


def main() -> None:
    """Write the page below the current folder, of a fleet its tables too."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("page", choices=PAGES)
    parser.add_argument("names", nargs="*", help=", ".join(f"{p}: {of}" for p, of in PAGES.items()))
    parser.add_argument("--archive", type=Path, default=Path("data/history"))
    parser.add_argument("--derived", type=Path, default=Path("data/derived"))
    parser.add_argument("--reports", type=Path, default=Path("reports"))
    parser.add_argument("--settings", type=json.loads, required=True, help="of config.yaml, JSON")
    given = parser.parse_args()
    code = hash_of(code_of(given.page, "overviews"))
    try:
        texts = import_module(f"overviews.{given.page}.page").documents(given, code)
        write_whole({given.reports / name: text.encode() for name, text in texts.items()})
    except Refusal as refusal:
        sys.exit(visible(f"{given.page}: {refusal}"))


main()
