"""`make challenge ONLY=diagnosis`: draw campaigns and see what the diagnosis says; can be resumed.

    PYTHONPATH=tests:tests/hidden:tests/diagnosis python -m diagnosis <folder> [<words>]

Every outcome is a line of `diagnosis.jsonl` in the folder; what this code has drawn already is not
drawn again. At the end docs/diagnosis.md is written. With words only draws are run that have them
in their name, `part|plan|what|size`, and only the terminal is told.
"""

import json
import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from importlib import import_module
from pathlib import Path

import chain
from diagnosis_bars import bars
from diagnosis_draws import names, places, sigmas
from diagnosis_outcomes import Outcome, code, outcome
from diagnosis_page import write
from hidden_plans import PLANS
from hidden_sizes import reference

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


def main(folder: Path, words: list[str]) -> None:
    """Draw what is missing, then write the page of all."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "diagnosis.jsonl"
    for stage in chain.ORDER:  # before the processes part, so that all run the same code
        import_module(f"stages.{stage}.stage")
    for plan in PLANS:
        reference(plan), sigmas(plan), places(plan)
    chosen = [name for name in names() if all(word in name for word in words)]
    kept = outcomes_of(file)
    file.write_text("".join(json.dumps(one) + "\n" for one in kept), encoding="utf-8")
    there = {one["name"] for one in kept}
    missing = [name for name in chosen if name not in there]
    start = time.monotonic()
    with ProcessPoolExecutor(CORES) as pool, file.open("a", encoding="utf-8") as log:
        futures = [pool.submit(outcome, name) for name in missing]
        for number, done in enumerate(as_completed(futures), 1):
            log.write(json.dumps(done.result()) + "\n")
            log.flush()
            if number % 20 == 0 or number == len(missing):
                minutes = (time.monotonic() - start) / 60
                left = minutes / number * (len(missing) - number)
                sys.stdout.write(
                    f"{number} of {len(missing)}, {minutes:.0f} min, {left:.0f} to go\n"
                )
                sys.stdout.flush()
    wanted = set(chosen)
    found = [one for one in outcomes_of(file) if one["name"] in wanted]
    if words:
        lines = (f"{bar.verdict.strip('*'):9} {bar.words}: {bar.measured}\n" for bar in bars(found))
        sys.stdout.write("".join(lines))
    else:
        sys.stdout.write(write(found))


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
