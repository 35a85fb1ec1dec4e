"""A campaign through the whole workflow, from its logs to the report.

python -m benchmarks.own.running <folder that holds data/raw/<campaign>> <campaign>
"""

import subprocess
import sys
import time
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import psutil

from benchmarks.answering import answer

ROOT = Path(__file__).parents[2]
EVERY = 0.2  # s between two looks


@dataclass
class Watch:
    """What the processes of a run were seen to use: processor time, s, and memory, byte."""

    cpu: dict[psutil.Process, float] = field(default_factory=dict)
    together: int = 0
    largest: int = 0

    def look(self, run: psutil.Process) -> None:
        """At a process and all that it began; what two of them share counts for each a half."""
        held = [0]
        with suppress(psutil.NoSuchProcess):  # it has just ended
            for one in (run, *run.children(recursive=True)):
                times = one.cpu_times()
                self.cpu[one] = times.user + times.system
                held.append(one.memory_full_info().pss)
        self.together, self.largest = max(self.together, sum(held)), max(self.largest, *held)


def main(folder: str, campaign: str) -> None:
    """Answer with seconds, processor time, memory in byte, and the seconds of each stage."""
    start = time.monotonic()
    watch = _watched([f"reports/{campaign}.html"], Path(folder))
    answer(
        seconds=time.monotonic() - start,
        cpu=sum(watch.cpu.values()),
        together=watch.together,
        largest=watch.largest,
        stages={
            path.parent.name: _seconds(path)
            for path in Path(folder, "data/derived", campaign).glob("*/stage.log")
            if any(path.parent.glob("*.parquet"))
        },
    )


def _watched(targets: list[str], folder: Path) -> Watch:
    """Run the workflow and look at its processes."""
    where = ["--snakefile", str(ROOT / "Snakefile"), "--directory", str(folder)]
    told = ["--cores", "2", "--quiet", "all", *where, "--", *targets]
    run = subprocess.Popen([sys.executable, "-m", "snakemake", *told], stdout=sys.stderr)
    watch = Watch()
    while run.poll() is None:
        watch.look(psutil.Process(run.pid))
        time.sleep(EVERY)
    if run.returncode:
        sys.exit(run.returncode)
    return watch


def _seconds(log: Path) -> float:
    """From the begin of a stage, when its log was made, to its last table; s."""
    tables = [table.stat().st_mtime for table in log.parent.glob("*.parquet")]
    return max(tables) - log.stat().st_mtime


main(*sys.argv[1:])
