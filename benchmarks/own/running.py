"""A campaign through the whole workflow, from its logs to the report.

python -m benchmarks.own.running <folder that holds data/raw/<campaign>> <campaign>
"""

import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import psutil

from benchmarks.answering import answer

ROOT = Path(__file__).parents[2]
EVERY = 0.2  # s between two looks at the memory


def main(folder: str, campaign: str) -> None:
    """Answer with seconds, processor time, memory in byte, and the seconds of each stage."""
    start = time.monotonic()
    together = _watched([f"reports/{campaign}.html"], Path(folder))
    seconds, used = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    answer(
        seconds=seconds,
        cpu=used.ru_utime + used.ru_stime,
        together=together,
        largest=used.ru_maxrss * 1024,
        stages={
            path.parent.name: _seconds(path)
            for path in Path(folder, "data/derived", campaign).glob("*/stage.log")
        },
    )


def _watched(targets: list[str], folder: Path) -> int:
    """Run the workflow; the most memory that its processes had together, byte."""
    where = ["--snakefile", str(ROOT / "Snakefile"), "--directory", str(folder)]
    told = ["--cores", "2", "--quiet", "all", *where, "--", *targets]
    run = subprocess.Popen([sys.executable, "-m", "snakemake", *told], stdout=sys.stderr)
    most = 0
    while run.poll() is None:
        most = max(most, _memory(psutil.Process(run.pid)))
        time.sleep(EVERY)
    if run.returncode:
        sys.exit(run.returncode)
    return most


def _seconds(log: Path) -> float:
    """From the begin of a stage, when its log was made, to its last table; s."""
    tables = [table.stat().st_mtime for table in log.parent.glob("*.parquet")]
    return max(tables, default=np.nan) - log.stat().st_mtime


def _memory(process: psutil.Process) -> int:
    """Of a process and all that it began, byte."""
    held = 0
    try:
        for one in (process, *process.children(recursive=True)):
            held += one.memory_info().rss
    except psutil.NoSuchProcess:  # it has just ended
        pass
    return held


main(*sys.argv[1:])
