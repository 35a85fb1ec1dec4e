"""`python -m overviews.compare <campaign> <campaign>`: two campaigns beside each other."""

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
from overviews.compare.page import as_text, comparison_page
from overviews.compare.pair import READ, pair_of_campaigns
from overviews.tables_of import tables_of


def main() -> None:
    """Write reports/compare-A-B.html and .txt below the current folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("first")
    parser.add_argument("second")
    parser.add_argument("--derived", type=Path, default=Path("data/derived"))
    parser.add_argument("--reports", type=Path, default=Path("reports"))
    parser.add_argument("--settings", type=json.loads, required=True, help="of config.yaml, JSON")
    given = parser.parse_args()
    names = (given.first, given.second)
    try:
        first, second = (tables_of(given.derived / name, READ) for name in names)
        pair = pair_of_campaigns(names, (first, second), given.settings["comparison"]["level"])
        html = comparison_page(pair, given.derived, hash_of(code_of("compare", "overviews")))
        documents = {"html": html, "txt": as_text(pair)}
        write_whole(
            {
                given.reports / f"compare-{'-'.join(names)}.{ending}": text.encode()
                for ending, text in documents.items()
            }
        )
    except Refusal as refusal:
        sys.exit(visible(f"compare: {refusal}"))


main()
