"""`make walks`: a random walk of gyro biases against ramp, jump and warm-up, in docs/walks.md.

    PYTHONPATH=tests:tests/hidden:tests/walks python -m walks <draws> <folder>

Of so many draws of each kind, ratio and plan every outcome is a line of `walks.jsonl` in the
folder; can be resumed.
"""

import sys
from pathlib import Path
from typing import Any

import resumable
from hidden_plans import PLANS
from walk_draws import KINDS, RATIOS, code, outcome
from walk_guess import guesser
from walk_page import write


def guessed(plan: str, *draw: Any) -> dict[str, Any]:
    """The outcome of a draw, and what would be said of it without knowing its size."""
    return outcome(plan, *draw, guesser(plan).says)


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
    resumable.drawn(folder / "walks.jsonl", code(), key, guessed, jobs)
    sys.stdout.write(write(resumable.outcomes_of(folder / "walks.jsonl", code())))


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]))
