"""`make laws`: hidden laws, in docs/laws.md; can be resumed.

    PYTHONPATH=tests:tests/hidden:tests/laws python -m laws <draws> <folder>

Every outcome is a line of `laws.jsonl` in the folder. At the end docs/laws.md is written of what
is there.
"""

import sys
from pathlib import Path

import resumable
from law_draws import code, outcome
from law_page import write


def main(draws: int, folder: Path) -> None:
    """Draw what is missing, then write the page of all."""
    jobs = [(number,) for number in range(draws)]
    resumable.with_all_stages()
    file = folder / "laws.jsonl"
    resumable.drawn(file, code(), ("number",), outcome, jobs)
    sys.stdout.write(write(resumable.outcomes_of(file, code())))


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]))
