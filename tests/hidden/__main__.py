"""`make challenge`: hide effects in many campaigns and see what is found; can be resumed.

    python -m hidden <draws> <folder>

Every outcome is a line of `campaigns.jsonl` in the folder, every effect and ratio of the second
part one of `statistics.jsonl`; what this code has drawn already is not drawn again. At the end
docs/challenge.md and its picture are written.
"""

import json
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from importlib import import_module
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import chain
from hidden_campaigns import run
from hidden_draws import draw
from hidden_page import write
from hidden_plans import PLANS
from hidden_sizes import code, reference, size
from hidden_statistics import every_job, tried

CORES = 2
Row = dict[str, Any]


def campaign(number: int) -> Row:
    """The outcome of a draw."""
    return run(draw(number, size))


def statistics(job: tuple[str, str, float, int]) -> Row:
    """The outcome of one effect at one ratio."""
    start = time.process_time()
    return tried(*job) | {"seconds": time.process_time() - start}


def rows_of(file: Path) -> list[Row]:
    """What was drawn by this code; a line that was cut short by a kill is left out."""
    lines = file.read_text(encoding="utf-8").splitlines() if file.exists() else []
    return [row for row in _whole(lines) if row["code"] == code()]


def _whole(lines: Iterable[str]) -> Iterator[Row]:
    for line in lines:
        try:
            yield json.loads(line)
        except json.JSONDecodeError:
            continue


def drawn(
    pool: ProcessPoolExecutor, file: Path, does: Callable[[Any], Row], jobs: Sequence[Any]
) -> None:
    """Do the jobs, one line of the file each, and say how far it has come."""
    start = time.monotonic()
    kept = rows_of(file)
    file.write_text("".join(json.dumps(row) + "\n" for row in kept), encoding="utf-8")
    with file.open("a", encoding="utf-8") as log:
        for number, done in enumerate(as_completed([pool.submit(does, job) for job in jobs]), 1):
            log.write(json.dumps(done.result()) + "\n")
            log.flush()
            if number % 20 == 0 or number == len(jobs):
                minutes = (time.monotonic() - start) / 60
                left = minutes / number * (len(jobs) - number)
                sys.stdout.write(
                    f"{file.stem}: {number} of {len(jobs)}, {minutes:.0f} min, {left:.0f} to go\n"
                )
                sys.stdout.flush()


def main(draws: int, folder: Path) -> None:
    """Draw what is missing, then write the page of all."""
    folder.mkdir(parents=True, exist_ok=True)
    campaigns, statistical = folder / "campaigns.jsonl", folder / "statistics.jsonl"
    for stage in chain.ORDER:  # before the processes part, so that all run the same code
        import_module(f"stages.{stage}.stage")
    for plan in PLANS:
        reference(plan)
    with ProcessPoolExecutor(CORES) as pool:
        there = {row["number"] for row in rows_of(campaigns)}
        drawn(pool, campaigns, campaign, [n for n in range(draws) if n not in there])
        known = {(row["plan"], row["effect"], row["ratio"]) for row in rows_of(statistical)}
        jobs = [job for job in every_job() if job[:3] not in known]
        drawn(pool, statistical, statistics, jobs)
    outcomes = [row for row in rows_of(campaigns) if row["number"] < draws]
    sys.stdout.write(write(outcomes, rows_of(statistical)))


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]))
