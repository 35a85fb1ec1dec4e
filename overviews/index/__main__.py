"""`python -m overviews.index <campaign>…`: all campaigns on one page."""

import argparse
import json
import sys
from pathlib import Path

from inertial.text.messages import speak_as_set

if __name__ == "__main__":
    speak_as_set(sys.argv)

from inertial.tables.code import code_of, hash_of
from inertial.tables.errors import Refusal
from inertial.tables.whole_files import write_whole
from inertial.text.numbers import visible
from overviews.index.page import Without, index_page
from overviews.known import serials, with_result
from overviews.tables_of import RESULT, tables_of
from overviews.units import imus_of
from stages import ORDER


def main() -> None:
    """Write reports/index.html below the current folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("campaigns", nargs="*", help="all campaigns that there are")
    parser.add_argument("--archive", type=Path, default=Path("data/history"))
    parser.add_argument("--derived", type=Path, default=Path("data/derived"))
    parser.add_argument("--reports", type=Path, default=Path("reports"))
    parser.add_argument(
        "--settings", type=json.loads, required=True, help="sections of config.yaml, JSON"
    )
    given = parser.parse_args()
    settings = {"tolerance": {}} | given.settings["history"]
    try:
        names = with_result(given.campaigns, given.derived)
        html = index_page(
            {name: tables_of(given.derived / name, RESULT) for name in names},
            [
                Without(name, last_words(given.derived / name))
                for name in given.campaigns
                if name not in names
            ],
            {
                folder: imus_of(given.archive, folder, given.derived, **settings)
                for folder in serials(given.archive)
            },
            (given.derived, given.reports),
            hash_of(code_of("index", "overviews")),
        )
        write_whole({given.reports / "index.html": html.encode()})
    except Refusal as refusal:
        sys.exit(visible(f"index: {refusal}"))


def last_words(derived: Path) -> str:
    """What the first stage that failed said."""
    for stage in ORDER:
        log = derived / stage / "stage.log"
        if log.is_file() and (said := log.read_text("utf-8", "replace").split()):
            return " ".join(said)
    return ""


main()
