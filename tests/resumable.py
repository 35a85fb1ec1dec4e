"""Outcomes of many draws, a line of JSON each: what the same code has drawn is not drawn again."""

import json
import os
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from importlib import import_module
from pathlib import Path
from typing import Any

import chain

from inertial.tables.code import code_of, hash_of

Outcome = dict[str, Any]

CORES = int(os.environ.get("CORES", "2"))
EVERY = 20  # draws, of which one is told


def with_all_stages() -> None:
    """Load all stages before the processes part, so that all run the same code."""
    for stage in chain.ORDER:
        import_module(f"stages.{stage}.stage")


def code_of_outcomes(stages: Iterable[str], drawn_by: Iterable[Path]) -> str:
    """A hash of all that an outcome rests on: stages, laboratory, settings, and what draws it."""
    files = {file for stage in stages for file in code_of(stage)} | {*drawn_by}
    files |= {*(chain.ROOT / "laboratory").rglob("*.py"), chain.ROOT / "config.yaml"}
    return hash_of(sorted(files))[:16]


def outcomes_of(file: Path, code: str) -> list[Outcome]:
    """What was drawn by this code; a line that was cut short by a kill is left out."""
    found = []
    for line in file.read_text(encoding="utf-8").splitlines() if file.exists() else []:
        try:
            found.append(json.loads(line))
        except json.JSONDecodeError:
            continue
    return [one for one in found if one["code"] == code]


def drawn(
    file: Path,
    code: str,
    key: Sequence[str],
    outcome: Callable[..., Outcome],
    jobs: Sequence[tuple[Any, ...]],
) -> list[Outcome]:
    """The outcomes of the jobs, those that are missing drawn and written, one line each.

    Parameters
    ----------
    file : of the lines; those of other code are deleted
    code : hash of what an outcome rests on, which is its entry `code`
    key : entries of an outcome that are the first values of its job
    outcome : of a job, its values the arguments; called in other processes
    """
    file.parent.mkdir(parents=True, exist_ok=True)
    kept = outcomes_of(file, code)
    file.write_text("".join(json.dumps(one) + "\n" for one in kept), encoding="utf-8")

    def done_by(one: Outcome) -> tuple[Any, ...]:
        return tuple(one[name] for name in key)

    there, wanted = {done_by(one) for one in kept}, {job[: len(key)] for job in jobs}
    missing = [job for job in jobs if job[: len(key)] not in there]
    start = time.monotonic()
    with ProcessPoolExecutor(CORES) as pool, file.open("a", encoding="utf-8") as log:
        futures = [pool.submit(outcome, *job) for job in missing]
        for number, done in enumerate(as_completed(futures), 1):
            log.write(json.dumps(done.result()) + "\n")
            log.flush()
            if number % EVERY == 0 or number == len(missing):
                minutes = (time.monotonic() - start) / 60
                left = minutes / number * (len(missing) - number)
                sys.stdout.write(
                    f"{file.stem}: {number} of {len(missing)}, {minutes:.0f} min, {left:.0f} left\n"
                )
                sys.stdout.flush()
    return [one for one in outcomes_of(file, code) if done_by(one) in wanted]
