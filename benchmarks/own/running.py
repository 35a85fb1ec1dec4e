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
EVERY = 0.2  # s between two samples


@dataclass
class Watch:
    """Processor time, s, and memory, byte, of the processes of a run."""

    cpu: dict[psutil.Process, float] = field(default_factory=dict)
    together: int = 0
    largest: int = 0

    def sample(self, run: psutil.Process) -> None:
        """Sample a process and its children; memory that two of them share counts half for each."""
        memory = [0]
        with suppress(psutil.NoSuchProcess):  # it has just ended
            for process in (run, *run.children(recursive=True)):
                times = process.cpu_times()
                self.cpu[process] = times.user + times.system
                memory.append(process.memory_full_info().pss)
        self.together, self.largest = max(self.together, sum(memory)), max(self.largest, *memory)


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
    """Run the workflow and sample its processes."""
    where = ["--snakefile", str(ROOT / "Snakefile"), "--directory", str(folder)]
    options = ["--cores", "2", "--quiet", "all", *where, "--", *targets]
    run = subprocess.Popen([sys.executable, "-m", "snakemake", *options], stdout=sys.stderr)
    watch = Watch()
    while run.poll() is None:
        watch.sample(psutil.Process(run.pid))
        time.sleep(EVERY)
    if run.returncode:
        sys.exit(run.returncode)
    return watch


def _seconds(log: Path) -> float:
    """From the start of a stage, when its log is created, to its last table; s."""
    tables = [table.stat().st_mtime for table in log.parent.glob("*.parquet")]
    return max(tables) - log.stat().st_mtime


main(*sys.argv[1:])
