"""`make challenge`: hide effects in many campaigns and see what is found; can be resumed.

    python -m hidden <draws> <folder>

Every outcome is a line of `campaigns.jsonl` in the folder, every effect and ratio of the second
part one of `statistics.jsonl`. At the end docs/challenge.md and its picture are written.
"""

import sys
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import resumable
from hidden_campaigns import run
from hidden_draws import draw, numbers_of_each
from hidden_page import write
from hidden_plans import PLANS
from hidden_sizes import code, reference, size
from hidden_statistics import every_job, tried


def campaign(number: int) -> dict[str, Any]:
    """The outcome of a draw."""
    return run(draw(number, size))


def statistics(*job: Any) -> dict[str, Any]:
    """The outcome of one effect at one ratio."""
    start = time.process_time()
    return tried(*job) | {"seconds": time.process_time() - start}


def main(draws: int, folder: Path) -> None:
    """Draw what is missing, then write the page of all."""
    resumable.with_all_stages()
    for plan in PLANS:
        reference(plan)
    numbers = [(n,) for n in (*range(draws), *numbers_of_each())]
    campaigns = resumable.drawn(folder / "campaigns.jsonl", code(), ("number",), campaign, numbers)
    key = ("plan", "effect", "ratio")
    tries = resumable.drawn(folder / "statistics.jsonl", code(), key, statistics, list(every_job()))
    sys.stdout.write(write(campaigns, tries))


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]))
