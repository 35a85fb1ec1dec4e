"""`make temperature`: draw campaigns in a chamber and compare curves with their bound; resumable.

    PYTHONPATH=tests:tests/hidden:tests/diagnosis:tests/bounds:tests/temperature \
        python -m temperature <draws> <folder> [<words>]

Every outcome is a line of `temperature.jsonl` in the folder; what this code has drawn already is
not drawn again. With words only draws are made that have them in their name, `plan|number`. At the
end docs/temperature.md and its figure are written from all.
"""

import json
import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from importlib import import_module
from pathlib import Path

import chain
from temperature_bars import Outcome
from temperature_draws import PLANS, planned
from temperature_outcomes import code, outcome
from temperature_page import write

CORES = 2


def outcomes_of(file: Path) -> list[Outcome]:
    """What was drawn by this code; a line that was cut short by a kill is left out."""
    found = []
    for line in file.read_text(encoding="utf-8").splitlines() if file.exists() else []:
        try:
            found.append(json.loads(line))
        except json.JSONDecodeError:
            continue
    return [one for one in found if one["code"] == code()]


def main(draws: int, folder: Path, words: list[str]) -> None:
    """Draw what is missing, plan by plan in turn, then write the page of all."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "temperature.jsonl"
    for stage in chain.ORDER:  # before the processes part, so that all run the same code
        import_module(f"stages.{stage}.stage")
    names = [f"{plan}|{n}" for n in range(draws // len(PLANS)) for plan in PLANS]
    kept = outcomes_of(file)
    file.write_text("".join(json.dumps(one) + "\n" for one in kept), encoding="utf-8")
    there = {one["name"] for one in kept}
    chosen = [name for name in names if all(word in name for word in words)]
    missing = [name for name in chosen if name not in there]
    for plan in {name.split("|")[0] for name in missing}:
        planned(plan)
    start = time.monotonic()
    with ProcessPoolExecutor(CORES) as pool, file.open("a", encoding="utf-8") as log:
        futures = [pool.submit(outcome, name) for name in missing]
        for number, done in enumerate(as_completed(futures), 1):
            log.write(json.dumps(done.result()) + "\n")
            log.flush()
            if number % 10 == 0 or number == len(missing):
                passed = time.monotonic() - start
                sys.stdout.write(f"{number} of {len(missing)} campaigns, {passed / 60:.0f} min\n")
                sys.stdout.flush()
    sys.stdout.write(write(outcomes_of(file)))


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:])
