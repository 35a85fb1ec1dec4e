"""`python -m overviews.fleet <name> <campaign>…`: several campaigns taken together."""

import argparse
import json
import sys
from pathlib import Path

from inertial.text.messages import speak_as_set

if __name__ == "__main__":
    speak_as_set(sys.argv)

from inertial.tables.code import code_of, hash_of
from inertial.tables.errors import Refusal
from inertial.tables.fleet import FLEET
from inertial.tables.parquet import Writer
from inertial.tables.whole_files import room_for, write_whole
from inertial.text.numbers import visible
from overviews.fleet.declared import READ
from overviews.fleet.members import members_of
from overviews.fleet.page import fleet_page
from overviews.fleet.results import results_of


def main() -> None:
    """Write reports/fleet-<name>.html and the tables of the fleet below the current folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name", help="of the page")
    parser.add_argument("campaigns", nargs="+")
    parser.add_argument("--derived", type=Path, default=Path("data/derived"))
    parser.add_argument("--reports", type=Path, default=Path("reports"))
    parser.add_argument("--settings", type=json.loads, required=True, help="of config.yaml, JSON")
    given = parser.parse_args()
    settings = given.settings["fleet"]
    code = hash_of(code_of("fleet", "overviews"))
    folder = given.derived / ".fleets" / given.name
    try:
        members = members_of(given.campaigns, given.derived)
        rows, searched = results_of(members, **settings)
        made_by = {"stage": "fleet", "settings": settings, "code": code}
        with room_for(folder), Writer(folder, FLEET, lambda: made_by) as writer:
            for name, table in FLEET.items():
                writer.write(name, table.frame(rows[name]))
        files = [given.derived / c / read.place for c in given.campaigns for read in READ.values()]
        share = settings["false_discoveries"]
        simulated = any(member.simulated for member in members)
        html = fleet_page(rows, searched, share, given.name, files, code, simulated=simulated)
        write_whole({given.reports / f"fleet-{given.name}.html": html.encode()})
    except Refusal as refusal:
        sys.exit(visible(f"fleet: {refusal}"))


main()
