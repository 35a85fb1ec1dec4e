"""`python -m overviews.history <serial>`: the history of an IMU, by the file name of its serial."""

import argparse
import json
import sys
from pathlib import Path

from inertial.text.messages import _, speak_as_set

if __name__ == "__main__":
    speak_as_set(sys.argv)

from inertial.tables.code import code_of, hash_of
from inertial.tables.errors import Refusal
from inertial.tables.whole_files import write_whole
from inertial.text.numbers import visible
from overviews.history.page import history_page
from overviews.known import serials
from overviews.units import imus_of


def main() -> None:
    """Write reports/history/<serial>.html below the current folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("serial", help="as its folder in the archive is called")
    parser.add_argument("--archive", type=Path, default=Path("data/history"))
    parser.add_argument("--derived", type=Path, default=Path("data/derived"))
    parser.add_argument("--reports", type=Path, default=Path("reports"))
    parser.add_argument(
        "--settings", type=json.loads, required=True, help="sections of config.yaml, JSON"
    )
    given = parser.parse_args()
    settings = {"tolerance": {}} | given.settings["history"]
    try:
        imus = imus_of(given.archive, given.serial, given.derived, **settings)
        if not imus:
            raise Refusal(
                str(given.archive),
                _("serial number {serial}", serial=given.serial),
                _("no calibration of it"),
                _(
                    "one of {serials}",
                    serials=", ".join(serials(given.archive)) or _("none"),
                ),
                _("name one that is there; a report puts its campaign into the archive"),
            )
        code = hash_of(code_of("history", "overviews"))
        html = history_page(imus, given.archive, given.reports, code)
        write_whole({given.reports / "history" / f"{given.serial}.html": html.encode()})
    except Refusal as refusal:
        sys.exit(visible(f"history: {refusal}"))


main()
