"""Campaigns through a real Slurm: a node dies in the middle, a job needs more than it asked for.

Two runs of Snakemake submit to the same Slurm, as two users do. What came out is compared with a
run on this machine without Slurm.
"""

import re
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import chain
import pandas as pd
import pyarrow.parquet as pq
from slurm import Slurm

from stages import ORDER

DYING = "n1"
GREEDY = "greedy"
SMALL_MB = 300  # too little for any stage with the two processes of Snakemake that start it
EVERY = 1.0  # s
MEASURED = ("s", "cpu_time", "max_rss")  # s, s, MB: columns of Snakemake's benchmarks


@dataclass(frozen=True)
class Outcome:
    """What happened: seconds, jobs begun again, jobs ended for their memory, differing tables.

    `restarts`: of a controller of Slurm that ended by itself.
    """

    campaigns: int
    exit_codes: tuple[int, ...]
    seconds: float
    lost_processes: int
    requeued: int
    over_memory: int
    restarts: int
    again: str  # what a further run finds to do
    different: tuple[str, ...]
    share: float  # of the processor time of the run without Slurm, that of the stages
    benchmarks: pd.DataFrame  # a row for each campaign and stage

    @property
    def lossless(self) -> bool:
        """Whether all is there as if nothing had happened."""
        return (
            not any(self.exit_codes) and not self.different and "Nothing to be done" in self.again
        )


def through_slurm(
    folder: Path, campaigns: int, goals: Sequence[str], compared: int, patience: float
) -> Outcome:
    """Run so many campaigns and a greedy one up to `goals`, names with `{campaign}`.

    `compared`: how many of them are run without Slurm too; `patience`: s, until all is ended.
    """
    names = [f"c{number:03}" for number in range(campaigns)]
    for seed, name in enumerate(names):
        chain.simulate(chain.short(seed=seed), folder / "many/data/raw" / name)
    chain.simulate(chain.short(seed=campaigns), folder / "one/data/raw" / GREEDY)
    wanted = [goal.format(campaign=name) for name in names for goal in goals]
    greedy = [goal.format(campaign=GREEDY) for goal in goals]

    start = time.monotonic()
    with Slurm(folder / "slurm") as slurm:
        until = start + patience
        runs = [_submitting(slurm, folder / "many", "--", *wanted)]
        try:
            _wait(lambda: _at_work(slurm, folder / "many"), until, slurm)
            lost = slurm.kill(DYING)
            small = [f"{stage}:mem_mb=attempt * attempt * {SMALL_MB}" for stage in ORDER]
            runs += [_submitting(slurm, folder / "one", "--set-resources", *small, "--", *greedy)]
            _wait(lambda: slurm.states().get(DYING, "").startswith("down"), until, slurm)
            slurm.start_node(DYING)
            for job in slurm.asked("squeue", "--noheader", "--format=%i %r").splitlines():
                if job.endswith("BeginTime"):  # begun again, which Slurm holds for two minutes
                    slurm.asked("scontrol", "update", f"JobId={job.split()[0]}", "StartTime=now")
            _wait(lambda: all(run.poll() is not None for run in runs), until, slurm)
            codes = tuple(run.wait() for run in runs)
        finally:
            for run in runs:
                run.kill()
                run.wait()
        seconds = time.monotonic() - start
        log = (folder / "slurm/slurmctld.log").read_text()
    again = local(folder / "many", "--dry-run", "--", *wanted)
    share = _beside(folder, names[:compared], goals)
    logs = (folder / "one/.snakemake/slurm_logs").rglob("*.log")
    return Outcome(
        campaigns + 1,
        codes,
        seconds,
        lost,
        len(set(re.findall(rf"requeue job JobId=(\d+) due to failure of node {DYING}", log))),
        sum("exceeded memory limit" in path.read_text("utf-8", "replace") for path in logs),
        slurm.restarts,
        again.stdout + again.stderr,
        tuple(_different(folder)),
        share,
        benchmarks(folder / "many"),
    )


def _submitting(slurm: Slurm, folder: Path, *arguments: str) -> subprocess.Popen[bytes]:
    """Snakemake with the profile of the project, as a user runs it."""
    command = [
        *_snakemake(folder),
        *("--profile", str(chain.ROOT / "profiles/slurm")),
        *("--slurm-init-seconds-before-status-checks", "5"),
        *arguments,
    ]
    with (folder / "said.txt").open("wb") as said:
        return subprocess.Popen(command, env=slurm.env, stdout=said, stderr=said)


def local(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Snakemake on this machine alone."""
    command = [*_snakemake(folder), "--cores", "1", *arguments]
    return subprocess.run(command, capture_output=True, text=True)


def _snakemake(folder: Path) -> list[str]:
    where = ["--snakefile", str(chain.ROOT / "Snakefile"), "--directory", str(folder)]
    return [sys.executable, "-m", "snakemake", "--nolock", *where]


def _at_work(slurm: Slurm, folder: Path) -> bool:
    """Whether a job is on the node that will die, and the stage after decoding has begun."""
    begun = folder.glob("data/derived/*/quality/stage.log")
    return any(begun) and bool(slurm.jobs_on(DYING))


def _wait(done: Callable[[], bool], until: float, slurm: Slurm) -> None:
    while not done():
        if time.monotonic() > until:
            raise TimeoutError("what was waited for on the cluster did not happen")
        slurm.revive()
        time.sleep(EVERY)


def _beside(folder: Path, names: Sequence[str], goals: Sequence[str]) -> float:
    """Run these campaigns without Slurm; the share of the stages in the processor time."""
    beside = folder / "beside"
    (beside / "data/raw").mkdir(parents=True)
    for name in names:
        (beside / "data/raw" / name).symlink_to(folder / "many/data/raw" / name)
    before = _spent()
    done = local(beside, "--", *(goal.format(campaign=name) for name in names for goal in goals))
    if done.returncode:
        raise RuntimeError(done.stderr)
    return float(benchmarks(beside)["cpu_time"].sum() / (_spent() - before))


def _spent() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def _different(folder: Path) -> list[str]:
    """Tables that the run without Slurm made otherwise, but for rounding, or that are missing."""
    beside, many = folder / "beside", folder / "many"
    tables = sorted(path.relative_to(beside) for path in beside.glob("data/derived/*/*/*.parquet"))
    return [
        str(table)
        for table in tables
        if not (many / table).is_file() or not _equal(beside / table, many / table)
    ]


def _equal(first: Path, second: Path) -> bool:
    try:
        pd.testing.assert_frame_equal(
            *(pq.read_table(path).to_pandas() for path in (first, second)), rtol=1e-9, atol=0.0
        )
    except AssertionError:
        return False
    return True


def benchmarks(folder: Path) -> pd.DataFrame:
    """What `benchmark:` measured: a row for each campaign and stage."""
    rows = [
        {"campaign": file.parts[-3], "stage": file.parts[-2]}
        | pd.read_csv(file, sep="\t")[list(MEASURED)].iloc[-1].to_dict()
        for file in folder.glob("data/derived/*/*/benchmark.tsv")
    ]
    return pd.DataFrame(rows)
