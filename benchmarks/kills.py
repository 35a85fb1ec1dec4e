"""Runs that are killed at random moments: nothing is half-written, and the next run completes.

BENCH_KILLS sets another number than 50.
"""

import os
import shutil
import signal
import subprocess
import sys
import time
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
PAGE = "reports/short.html"


def measured() -> list[Table]:
    """One undisturbed run; then runs that are killed, each continuing where the last one ended."""
    kills, chance = int(os.environ.get("BENCH_KILLS", "50")), np.random.default_rng(1)
    with TemporaryDirectory() as name:
        whole, killed = Path(name) / "whole", Path(name) / "killed"
        for folder in (whole, killed):
            _prepare(folder)
        start = time.monotonic()
        if ended := _start(whole).wait():
            raise RuntimeError(f"a run that nobody disturbs ends with {ended}")
        seconds = time.monotonic() - start
        moments, damaged, completed, parts = 0, [], 0, 0
        while moments < kills:
            run = _start(killed)
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
        last = _start(killed).wait()
        different = _different(whole, killed)
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
    how = "completes" if last == 0 else f"ends with {last}"
    table.add(str(moments), str(len(damaged)), str(parts), how, str(len(different)))
    table.remarks.append(
        f"An undisturbed run takes {digits(seconds)} s; {completed} runs ended before they could be"
        " killed and were started again. Temporary files hold a table until it is complete;"
        " the next run overwrites them. The tables are compared with the undisturbed run's."
    )
    return [table]


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
    YAML(typ="safe").dump(short, folder / "data/simulated/short.yaml")


def _start(folder: Path) -> subprocess.Popen[bytes]:
    """A run, the first of a process group of its own."""
    told_where = ["--snakefile", str(ROOT / "Snakefile"), "--directory", str(folder)]
    return subprocess.Popen(
        [sys.executable, "-m", "snakemake", "--cores", "2", "--nolock", *told_where, PAGE],
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
