"""`make mutants`: faults in the physics, one at a time, and which tests see them; can be resumed.

    PYTHONPATH=tests:tests/mutants python -m mutants <mutants> <folder>

Every outcome is a line of `mutants.jsonl` in the folder. At the end docs/mutants.md is written.
"""

import sys
from pathlib import Path

import resumable
from mutant_runs import code, covered, every, outcome
from mutants_page import write


def main(count: int, folder: Path) -> None:
    """Try the mutants that are missing, then write the page of all."""
    covered(folder)
    jobs = [(*job, str(folder)) for job in every()[:count]]
    file = folder / "mutants.jsonl"
    outcomes = resumable.drawn(file, code(), ("file", "number"), outcome, jobs)
    sys.stdout.write(write(outcomes, len(every())))


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]).absolute())
