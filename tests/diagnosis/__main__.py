"""`make challenge ONLY=diagnosis`: draw campaigns and see what the diagnosis says; can be resumed.

    PYTHONPATH=tests:tests/hidden:tests/diagnosis python -m diagnosis <folder> [<words>]

Every outcome is a line of `diagnosis.jsonl` in the folder. At the end docs/diagnosis.md is written.
With words only draws are run that have them in their name, `part|plan|what|size`, and only the
terminal is told.
"""

import sys
from pathlib import Path

import resumable
from diagnosis_draws import names, places, sigmas
from diagnosis_outcomes import code, outcome
from diagnosis_page import terminal, write
from hidden_plans import PLANS
from hidden_sizes import reference


def main(folder: Path, words: list[str]) -> None:
    """Draw what is missing, then write the page of all."""
    resumable.with_all_stages()
    for plan in PLANS:
        reference(plan), sigmas(plan), places(plan)
    jobs = [(name,) for name in names() if all(word in name for word in words)]
    found = resumable.drawn(folder / "diagnosis.jsonl", code(), ("name",), outcome, jobs)
    sys.stdout.write(terminal(found) if words else write(found))


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
