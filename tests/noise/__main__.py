"""`make noise`: what is found of simulated noise, in docs/noise.md; can be resumed.

    PYTHONPATH=tests python -m noise <folder> [<recordings>]

Every outcome is a line of `noise.jsonl` in the folder; what this code has drawn already is not
drawn again. At the end docs/noise.md and its figures are written. With a number, so many recordings
are drawn in each part at the most.
"""

import json
import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from noise_draws import PARTS, Row, code, outcome
from noise_page import write

CORES = 2


def rows_of(file: Path) -> list[Row]:
    """What was drawn by this code; a line that was cut short by a kill is left out."""
    found = []
    for line in file.read_text(encoding="utf-8").splitlines() if file.exists() else []:
        try:
            found.append(json.loads(line))
        except json.JSONDecodeError:
            continue
    return [row for row in found if row["code"] == code()]


def main(folder: Path, most: int) -> None:
    """Draw what is missing, then write the page of all."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "noise.jsonl"
    kept = rows_of(file)  # this reads the code, before the processes part
    file.write_text("".join(json.dumps(row) + "\n" for row in kept), encoding="utf-8")
    there = {(row["part"], row["number"]) for row in kept}
    jobs = [(part, n) for part, count in PARTS.items() for n in range(min(count, most))]
    missing = [job for job in jobs if job not in there]
    start = time.monotonic()
    with ProcessPoolExecutor(CORES) as pool, file.open("a", encoding="utf-8") as log:
        futures = [pool.submit(outcome, *job) for job in missing]
        for number, done in enumerate(as_completed(futures), 1):
            log.write(json.dumps(done.result()) + "\n")
            log.flush()
            if number % 100 == 0 or number == len(missing):
                minutes = (time.monotonic() - start) / 60
                left = minutes / number * (len(missing) - number)
                sys.stdout.write(
                    f"{number} of {len(missing)}, {minutes:.0f} min, {left:.0f} to go\n"
                )
                sys.stdout.flush()
    wanted = set(jobs)
    sys.stdout.write(
        write([row for row in rows_of(file) if (row["part"], row["number"]) in wanted])
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else sys.maxsize)
