"""`make temperature`: draw campaigns in a chamber and compare curves with their bound; resumable.

    PYTHONPATH=tests:tests/hidden:tests/diagnosis:tests/bounds:tests/temperature \
        python -m temperature <draws> <folder> [<words>]

Every outcome is a line of `temperature.jsonl` in the folder. With words only draws are made that
have them in their name, `plan|number`. At the end docs/temperature.md and its figure are written
from all that were made.
"""

import sys
from pathlib import Path

import resumable
from temperature_draws import PLANS, planned
from temperature_outcomes import code, outcome
from temperature_page import write


def main(draws: int, folder: Path, words: list[str]) -> None:
    """Draw what is missing, plan by plan in turn, then write the page of all."""
    resumable.with_all_stages()
    for plan in PLANS:
        planned(plan)
    names = [f"{plan}|{n}" for n in range(draws // len(PLANS)) for plan in PLANS]
    jobs = [(name,) for name in names if all(word in name for word in words)]
    file = folder / "temperature.jsonl"
    resumable.drawn(file, code(), ("name",), outcome, jobs)
    sys.stdout.write(write(resumable.outcomes_of(file, code())))


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:])
