"""Campaigns through the whole workflow, from their logs to the report.

python -m benchmarks.own.running <folder that holds data/raw/<campaign>> <campaign> …
"""

import resource
import subprocess
import sys
import time
from collections import defaultdict
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

    own: float = 0.0  # of Snakemake alone
    together: int = 0
    largest: int = 0
    stages: dict[psutil.Process, str] = field(default_factory=dict)
    cpu: dict[psutil.Process, float] = field(default_factory=dict)  # of those of stages
    memory: dict[str, int] = field(default_factory=lambda: defaultdict(int))  # by stage, largest

    def sample(self, run: psutil.Process) -> None:
        """Sample a process and its children; memory that two of them share counts half for each."""
        memory = [0]
        with suppress(psutil.NoSuchProcess):  # it has just ended
            for process in (run, *run.children(recursive=True)):
                times = process.cpu_times()
                memory.append(process.memory_full_info().pss)
                if process == run:
                    self.own = times.user + times.system
                elif stage := self.stages.get(process) or _stage(process):
                    self.stages[process] = stage
                    self.cpu[process] = times.user + times.system
                    self.memory[stage] = max(self.memory[stage], memory[-1])
        self.together, self.largest = max(self.together, sum(memory)), max(self.largest, *memory)

    def by_stage(self) -> dict[str, dict[str, float]]:
        """Processor time of each stage, over all campaigns, and its largest memory."""
        stages = {stage: {"cpu": 0.0, "memory": size} for stage, size in self.memory.items()}
        for process, seconds in self.cpu.items():
            stages[self.stages[process]]["cpu"] += seconds
        return stages


def main(folder: str, *campaigns: str) -> None:
    """Answer with seconds, processor time and memory in byte of all, of Snakemake, of stages."""
    start, before = time.monotonic(), _spent()
    targets = [f"reports/{c}.{kind}" for c in campaigns for kind in ("html", "calibration.json")]
    watch = _watched(targets, Path(folder))
    answer(
        seconds=time.monotonic() - start,
        cpu=_spent() - before,
        snakemake=watch.own,
        together=watch.together,
        largest=watch.largest,
        stages=watch.by_stage(),
    )


def _watched(targets: list[str], folder: Path) -> Watch:
    """Run the workflow and sample its processes."""
    where = ["--snakefile", str(ROOT / "Snakefile"), "--directory", str(folder)]
    options = ["--cores", "2", "--nolock", "--quiet", "all", *where, "--", *targets]
    run = subprocess.Popen([sys.executable, "-m", "snakemake", *options], stdout=sys.stderr)
    watch = Watch()
    while run.poll() is None:
        watch.sample(psutil.Process(run.pid))
        time.sleep(EVERY)
    if run.returncode:
        sys.exit(run.returncode)
    return watch


def _stage(process: psutil.Process) -> str:
    """The stage that a process is, by its command line; none: empty."""
    words = process.cmdline()
    return words[3] if words[1:3] == ["-m", "stages"] else ""


def _spent() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


main(*sys.argv[1:])
