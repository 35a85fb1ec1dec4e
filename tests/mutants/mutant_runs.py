"""A mutant of the physics put to the tests that execute its line, the quickest first.

Which tests execute a line, and how long each takes, is measured once with all faults absent
(coverage.py, one context for each test). A test that fails with the fault and passes without kills
the mutant; so does one that takes far longer. Each process has a copy of the tree of its own.
"""

import atexit
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from coverage import CoverageData
from mutations import Mutation, mutations

ROOT = Path(__file__).parents[2]
ROOMS = ("effects", "physics", "estimation", "model_selection")
PHYSICS = ROOMS[:2]
# The tests whose expectations do not come from the code.
SUITE = (
    *("effects", "inference", "facts", "noise", "bounds", "extending", "laws", "design"),
    *("fleet/test_fleet.py", "test_closure.py", "test_vectors.py", "test_turn_and_stop.py"),
    *("test_rests_of_unknown_attitude.py", "test_history.py", "test_navigation.py"),
    *("test_alignment.py", "test_bandwidth.py", "test_encoder.py", "test_encoder_windows.py"),
    *("test_characteristics.py", "test_repeatability.py"),
)
MINUTES = (  # what takes longer than the budget of a mutant
    "fleet/test_fleet.py::test_intervals_hold_the_mean_of_simulated_populations",
    "test_repeatability.py::test_the_laboratory_s_history_comes_back",
    "test_repeatability.py::test_the_sessions_of_snu_repeat_within_their_sigmas",
)
ALL_DURATIONS = ("--durations=0", "--durations-min=0")
SEED = 20261123
BUDGET_S = 40.0  # of tests for each mutant
PATIENCE = 5.0  # times as long as without the fault, and 30 s: a mutant that takes longer hangs
DURATION = re.compile(r"([\d.]+)s call +(.+)")
SOME_FAILED = 1  # exit status of pytest


@dataclass(frozen=True)
class Coverage:
    """The tests of the suite without faults: of every line of a file, and seconds of each test."""

    lines: dict[str, dict[int, list[str]]]
    seconds: dict[str, float]

    def tests_of(self, file: str, line: int) -> list[str]:
        """The tests that execute a line, the quickest first, within the budget.

        Of a line that none is seen to execute, since it is compiled or run by an import, those that
        execute any other of its file.
        """
        lines = self.lines.get(file, {})
        of_file = sorted(set().union(*lines.values()))
        found = sorted(lines.get(line) or of_file, key=self.seconds.__getitem__)
        chosen: list[str] = []
        total = 0.0
        for test in found:
            total += self.seconds[test]
            if chosen and total > BUDGET_S:
                break
            chosen.append(test)
        return chosen


def pytest_command(*arguments: str) -> list[str]:
    """pytest in one process, with its slow tests; only without --dist has coverage its contexts."""
    options = ("-q", "-n0", "--dist=no", "-p", "no:cacheprovider", "-m", "")
    return [sys.executable, "-m", "pytest", *options, *arguments]


def covered(folder: Path) -> Coverage:
    """What executes each line, by a run of the suite that is kept in a folder for this code.

    A test that fails without any fault is left out.
    """
    data, durations = folder / f"{code()[:16]}.coverage", folder / f"{code()[:16]}.txt"
    if not durations.exists():
        folder.mkdir(parents=True, exist_ok=True)
        suite = [str(ROOT / "tests" / part) for part in SUITE]
        suite += [f"--deselect=tests/{test}" for test in MINUTES]
        cov = [*(f"--cov=inertial/{room}" for room in ROOMS), "--cov-context=test"]
        command = pytest_command(*suite, *cov, "--cov-report=", *ALL_DURATIONS)
        env = os.environ | {"COVERAGE_FILE": str(data)}
        done = subprocess.run(command, cwd=ROOT, env=env, stdout=subprocess.PIPE, check=False)
        if done.returncode > SOME_FAILED:
            sys.exit(done.stdout.decode()[-2000:])
        durations.write_bytes(done.stdout)
    output = durations.read_text(encoding="utf-8")
    seconds = {}
    for line in output.splitlines():
        if match := DURATION.fullmatch(line):
            seconds[match[2]] = float(match[1])
    for test in _failed(output):
        sys.stdout.write(f"fails without any fault, and is left out: {test}\n")
        seconds.pop(test, None)
    measured = CoverageData(str(data))
    measured.read()
    lines: dict[str, dict[int, list[str]]] = {}
    for path in measured.measured_files():
        of_line = {
            line: sorted({context.partition("|")[0] for context in contexts} & set(seconds))
            for line, contexts in measured.contexts_by_lineno(path).items()
        }
        lines[str(Path(path).relative_to(ROOT))] = of_line
    return Coverage(lines, seconds)


@cache
def code() -> str:
    """A hash of the code that is mutated and of the tests."""
    tests = sorted((ROOT / "tests").rglob("*.py"))
    sources = [file for room in ROOMS for file in sorted((ROOT / "inertial" / room).glob("*.py"))]
    digest = hashlib.sha256()
    for file in (*sources, *tests):
        digest.update(str(file.relative_to(ROOT)).encode() + file.read_bytes())
    return digest.hexdigest()


def every() -> list[tuple[str, int]]:
    """All mutants, as file and number of the fault, in an order drawn once and for all.

    Effects and the physics of motion come first: there every fault is one of an equation.
    """
    random = np.random.default_rng(SEED)
    ordered: list[tuple[str, int]] = []
    for rooms in (PHYSICS, tuple(room for room in ROOMS if room not in PHYSICS)):
        jobs = [
            (str(file.relative_to(ROOT)), number)
            for room in rooms
            for file in sorted((ROOT / "inertial" / room).glob("*.py"))
            for number in range(len(mutations(file.read_bytes())))
        ]
        ordered += [jobs[place] for place in random.permutation(len(jobs))]
    return ordered


def outcome(file: str, number: int, folder: str) -> dict[str, Any]:
    """Whether the tests see a fault: the one that kills it, None where all pass."""
    mutation = mutations((ROOT / file).read_bytes())[number]
    coverage = _covered(folder)
    tests = coverage.tests_of(file, mutation.line)
    told = {"file": file, "number": number, "code": code(), "tests": len(tests)}
    told |= {name: getattr(mutation, name) for name in ("kind", "line", "before", "after")}
    limit = round(30 + PATIENCE * sum(coverage.seconds[test] for test in tests))
    return told | {"killed": killed(file, mutation, tests, limit) if tests else None}


def killed(file: str, mutation: Mutation, tests: Sequence[str], limit: int) -> str | None:
    """The first test that fails with the fault in the process's copy of the tree.

    `limit`: of processor time, s.
    """
    tree = _tree()
    place, original = tree / file, (ROOT / file).read_bytes()
    place.write_bytes(mutation.applied(original))
    try:
        command = pytest_command("-x", "--tb=no", *tests)
        bounded = ["bash", "-c", 'ulimit -t "$0"; exec "$@"', str(limit), *command]
        done = subprocess.run(bounded, cwd=tree, capture_output=True, text=True, check=False)
    finally:
        place.write_bytes(original)
    if not done.returncode:
        return None
    if done.returncode < 0:
        return "takes far longer"
    return next(_failed(done.stdout), "cannot be imported")


def _failed(output: str) -> Iterator[str]:
    """The tests that failed, by the summary of pytest."""
    for line in output.splitlines():
        if line.startswith(("FAILED ", "ERROR ")):
            yield line.split(" ", 1)[1].partition(" - ")[0]


_covered = cache(lambda folder: covered(Path(folder)))


@cache
def _tree() -> Path:
    """A copy of what the tests need, of this process alone; deleted at its end."""
    copy = Path(tempfile.mkdtemp())
    atexit.register(shutil.rmtree, copy, ignore_errors=True)
    names = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.split("\0")
    for name in filter(None, names):
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / name).exists():
            shutil.copy(ROOT / name, copy / name)
    return copy
