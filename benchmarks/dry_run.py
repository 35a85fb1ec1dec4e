"""Planning many campaigns: a dry run of the workflow against a bare Snakefile, side by side.

The bare one has the same rules with the same inputs and outputs, written out, and nothing else.
BENCH_CAMPAIGNS sets other numbers of campaigns than 1000, such as "100 1000 10000".
"""

import os
import shutil
import subprocess
import sys
import time
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory, TemporaryFile
from typing import Any

import psutil

import laboratory
from benchmarks.tables import Table, digits
from inertial.tables.campaign_files import logs_of
from laboratory.folder import campaign_yaml
from stages import ORDER

ROOT = Path(__file__).parent.parent
BAR = 1.3
EVERY = 0.1  # s between two samples of the memory


def measured() -> list[Table]:
    """Processor time of both, for each number of campaigns."""
    table = Table(
        "A dry run of many campaigns",
        ("campaigns", "jobs", "processor\ns", "bare\ns", "ratio"),
    )
    worst = 0.0
    for campaigns in map(int, os.environ.get("BENCH_CAMPAIGNS", "1000").split()):
        own, bare = planned(campaigns)
        ratio = own.cpu / bare.cpu
        worst = max(worst, ratio)
        table.add(
            f"{campaigns:,}", f"{own.jobs:,}", digits(own.cpu), digits(bare.cpu), f"{ratio:.2f}"
        )
    kept = "kept" if worst <= BAR else "MISSED"
    table.remarks.append(f"Processor time of Snakemake and all it starts. Bar: {BAR}, {kept}.")
    return [table]


@dataclass(frozen=True)
class Planned:
    """A dry run: jobs that a run would do, processor time, s, and largest memory, byte."""

    jobs: int
    cpu: float
    memory: int


def planned(campaigns: int) -> tuple[Planned, Planned]:
    """A dry run of the workflow and of the bare Snakefile."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        logs = _campaigns(folder, campaigns)
        (folder / "Snakefile").write_text(_bare(logs), encoding="utf-8")
        own, bare = (dry_run(folder, of / "Snakefile") for of in (ROOT, folder))
    if own.jobs != bare.jobs:
        raise RuntimeError(f"the bare Snakefile plans {bare.jobs} jobs, the workflow {own.jobs}")
    return own, bare


def planned_alone(campaigns: int) -> Planned:
    """A dry run for the report of one campaign in a folder that has so many."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        _campaigns(folder, campaigns)
        return dry_run(folder, ROOT / "Snakefile", "reports/c00000.html")


def _campaigns(folder: Path, number: int) -> list[str]:
    """So many folders of raw logs, which are empty, for nothing reads them; the logs' names."""
    document: dict[str, Any] = laboratory.read(ROOT / "data/simulated/demo.yaml").document
    campaign = campaign_yaml(document["campaign"])
    for each in range(number):
        raw = folder / f"data/raw/c{each:05}"
        raw.mkdir(parents=True)
        (raw / "campaign.yaml").write_bytes(campaign)
        logs = logs_of(raw / "campaign.yaml")
        for log in logs:
            (raw / log).touch()
    shutil.copy(ROOT / "data/instruments.yaml", folder)
    return logs


def _bare(logs: list[str]) -> str:
    """A Snakefile with the same rules and files."""
    raw = [f"data/raw/{{campaign}}/{log}" for log in logs]
    rules = [
        'CAMPAIGNS = glob_wildcards("data/raw/{campaign}/campaign.yaml").campaign',
        'wildcard_constraints: campaign="[a-z0-9][a-z0-9-]*"',
        "rule all:\n    input:\n"
        '        expand("reports/{c}.{kind}", c=CAMPAIGNS, kind=["html", "pdf"]),\n'
        '        expand("reports/{c}.calibration.json", c=CAMPAIGNS),\n'
        '        expand("data/derived/{c}/history/archived.parquet", c=CAMPAIGNS),',
    ]
    for stage in ORDER:
        declared = import_module(f"stages.{stage}.declared").DECLARED
        reads = [f"data/derived/{{campaign}}/{source.place}" for source in declared.reads.values()]
        writes = [f"data/derived/{{campaign}}/{stage}/{name}.parquet" for name in declared.writes]
        writes += [f"reports/{{campaign}}.{ending}" for ending in declared.documents]
        if "raw" in declared.files:
            reads += raw
        if stage == "plan":
            reads += ["data/raw/{campaign}/campaign.yaml", "instruments.yaml"]
        if stage == "pdf":
            reads = [f"reports/{{campaign}}.{e}" for e in ("html", "calibration.json", "dcc.xml")]
        rules.append(
            f"rule {stage}:\n    input: {reads}\n    output: {writes}\n"
            f'    shell: "python -m stages {stage} data/derived/{{wildcards.campaign}}"'
        )
    return "\n".join(rules) + "\n"


def dry_run(folder: Path, snakefile: Path, *goals: str) -> Planned:
    """Plan the goals, or all, in a folder of data."""
    where = ["--snakefile", str(snakefile), "--directory", str(folder)]
    options = ["--cores", "2", "--nolock", "--dry-run", *where, "--", *goals]
    with TemporaryFile("w+") as said:
        run = subprocess.Popen(
            [sys.executable, "-m", "snakemake", *options], stdout=said, stderr=subprocess.STDOUT
        )
        process, memory = psutil.Process(run.pid), 0
        while not (ended := os.wait4(run.pid, os.WNOHANG))[0]:
            with suppress(psutil.Error):  # it has just ended
                memory = max(memory, process.memory_info().rss)
            time.sleep(EVERY)
        _, status, usage = ended  # of the run and all that it started
        said.seek(0)
        text = said.read()
    if status:
        raise RuntimeError(text)
    jobs = [int(line.split()[1]) for line in text.splitlines() if line.startswith("total ")]
    return Planned(jobs[0], usage.ru_utime + usage.ru_stime, memory)
