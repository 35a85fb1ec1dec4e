"""`make silence`: clean campaigns of all plans, to see that nothing is named; can be resumed.

    python -m silence <draws> <folder>

Every outcome is a line of `campaigns.jsonl` in the folder. At the end docs/silence.md is written.
"""

import sys
from pathlib import Path

import resumable

from silence.silent_campaigns import code, outcome
from silence.silent_page import write


def main(draws: int, folder: Path) -> None:
    """Draw what is missing, then write the page of all."""
    resumable.with_all_stages()
    jobs = [(number,) for number in range(draws)]
    drawn = resumable.drawn(folder / "campaigns.jsonl", code(), ("number",), outcome, jobs)
    sys.stdout.write(write(drawn, draws))


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]))
