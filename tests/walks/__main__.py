"""`make walks`: a random walk of gyro biases against ramp, jump and warm-up, in docs/walks.md.

    PYTHONPATH=tests:tests/hidden:tests/walks python -m walks <draws> <folder>

Of so many draws of each kind, ratio and plan every outcome is a line of `walks.jsonl` in the
folder; can be resumed.
"""

import sys
from pathlib import Path

import resumable
from hidden_plans import PLANS
from walk_draws import KINDS, RATIOS, code, outcome
from walk_page import write


def main(draws: int, folder: Path) -> None:
    """Draw what is missing, then write the page of all."""
    jobs = [
        (plan, kind, ratio, number)
        for number in range(draws)
        for plan in PLANS
        for kind in KINDS
        for ratio in RATIOS
    ]
    resumable.with_all_stages()
    key = ("plan", "kind", "ratio", "number")
    resumable.drawn(folder / "walks.jsonl", code(), key, outcome, jobs)
    sys.stdout.write(write(resumable.outcomes_of(folder / "walks.jsonl", code())))


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]))
