"""`make challenge`: hide effects in many campaigns and see what is found; can be resumed.

    python -m hidden <draws> <file>

Every outcome is a line of the file; numbers that are there already are not drawn again.
"""

import json
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

from hidden_campaigns import reference, run, size
from hidden_draws import draw
from hidden_scores import share

CORES = 2


def one(number: int) -> dict[str, Any]:
    """The outcome of a draw."""
    return run(draw(number, size))


def main(draws: int, file: Path) -> None:
    """Draw what is missing, then tell the figures of all."""
    file.parent.mkdir(parents=True, exist_ok=True)
    lines = file.read_text(encoding="utf-8").splitlines() if file.exists() else []
    outcomes = [json.loads(line) for line in lines]
    missing = [n for n in range(draws) if n not in {one["number"] for one in outcomes}]
    with ProcessPoolExecutor(CORES, initializer=reference) as pool, file.open("a") as log:
        for outcome in pool.map(one, missing):
            outcomes.append(outcome)
            log.write(json.dumps(outcome) + "\n")
            log.flush()
    for key, value in share(outcomes).items():
        sys.stdout.write(f"{key}: {value}\n")


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]))
