"""Runs that are killed at random moments: nothing is half-written, and the next run completes.

BENCH_KILLS sets another number than 50.
"""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from ruamel.yaml import YAML

import laboratory
from benchmarks.tables import Table, digits

ROOT = Path(__file__).parent.parent
CAMPAIGN = "short"
PAGE = f"reports/{CAMPAIGN}.html"


@dataclass(frozen=True)
class Killed:
    """What runs that were killed left: tables that cannot be read, parts, tables that differ.

    `seconds`: of an undisturbed run; `completed`: runs that ended before they could be killed;
    `last`: exit code of the run after the last kill.
    """

    seconds: float
    completed: int
    damaged: Sequence[Path]
    parts: int
    last: int
    different: Sequence[Path]


def measured() -> list[Table]:
    """One undisturbed run; then runs that are killed, each continuing where the last one ended."""
    kills = int(os.environ.get("BENCH_KILLS", "50"))
    with TemporaryDirectory() as name:
        killed = survived(Path(name), kills, [PAGE])
    table = Table(
        "Runs killed (-9) at random moments",
        (
            "kills",
            "tables that cannot be read",
            "temporary files",
            "the next run",
            "tables that differ",
        ),
    )
    how = "completes" if killed.last == 0 else f"ends with {killed.last}"
    cells = (len(killed.damaged), killed.parts, how, len(killed.different))
    table.add(str(kills), *map(str, cells))
    table.remarks.append(
        f"An undisturbed run takes {digits(killed.seconds)} s; {killed.completed} runs ended before"
        " they could be killed and were started again. Temporary files hold a table until it is"
        " complete; the next run overwrites them. The tables are compared with the undisturbed"
        " run's."
    )
    return [table]


def survived(folder: Path, kills: int, goals: Sequence[str]) -> Killed:
    """Runs to these goals, so many of which are killed at moments that are drawn from one seed."""
    chance, whole, killed = np.random.default_rng(1), folder / "whole", folder / "killed"
    for each in (whole, killed):
        _prepare(each)
    start = time.monotonic()
    if ended := _start(whole, goals).wait():
        raise RuntimeError(f"a run that nobody disturbs ends with {ended}")
    seconds = time.monotonic() - start
    moments, damaged, completed, parts = 0, [], 0, 0
    while moments < kills:
        run = _start(killed, goals)
        try:
            run.wait(chance.uniform(0, seconds))
            completed += 1
            shutil.rmtree(killed)
            _prepare(killed)
        except subprocess.TimeoutExpired:
            os.killpg(run.pid, signal.SIGKILL)
            run.wait()
            moments += 1
            damaged += _damaged(killed)
            parts += len(list(killed.rglob("*.part")))
    last = _start(killed, goals).wait()
    return Killed(seconds, completed, damaged, parts, last, _different(whole, killed))


def _prepare(folder: Path) -> None:
    """The demo with rests of 20 s, quick turns and no faults."""
    document: dict[str, Any] = laboratory.read(ROOT / "data/simulated/demo.yaml").document
    quick = {"rate_deg_s": 30, "accel_deg_s2": 30}
    plan = [
        item | ({"seconds": 20} if item["do"] == "rest" else quick)
        for item in document["campaign"]["plan"]
    ]
    short = {
        **document,
        "faults": [],  # they name lines of the long one
        "campaign": {**document["campaign"], "plan": plan},
        "handling": {"still_s": 5},
        "start": {**document["start"], "pause_s": 10},
    }
    (folder / "data/simulated").mkdir(parents=True)
    YAML(typ="safe").dump(short, folder / f"data/simulated/{CAMPAIGN}.yaml")


def _start(folder: Path, goals: Sequence[str]) -> subprocess.Popen[bytes]:
    """A run, the first of a process group of its own."""
    where = ["--snakefile", str(ROOT / "Snakefile"), "--directory", str(folder)]
    return subprocess.Popen(
        [sys.executable, "-m", "snakemake", "--cores", "2", "--nolock", *where, "--", *goals],
        start_new_session=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


def _damaged(folder: Path) -> list[Path]:
    """Tables under their final names that cannot be read."""
    found = []
    for path in folder.rglob("*.parquet"):
        try:
            pq.read_table(path)
        except (pa.ArrowException, OSError):
            found.append(path)
    return found


def _different(whole: Path, killed: Path) -> list[Path]:
    """Tables of the undisturbed run that the other has not, or has otherwise."""
    inside = sorted(path.relative_to(whole) for path in whole.glob("data/derived/**/*.parquet"))
    return [
        path
        for path in inside
        if not (killed / path).exists()
        or not pq.read_table(whole / path).equals(pq.read_table(killed / path))
    ]
