"""Planning many campaigns: a dry run of the workflow against a bare Snakefile, side by side.

The bare one has the same rules with the same inputs and outputs, written out, and nothing else.
BENCH_CAMPAIGNS sets other numbers of campaigns than 1000, such as "100 1000 10000".
"""

import os
import resource
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import laboratory
from benchmarks.tables import Table, digits
from inertial.tables.campaign_files import logs_of
from laboratory.folder import campaign_yaml
from stages import ORDER

ROOT = Path(__file__).parent.parent
BAR = 1.3


def measured() -> list[Table]:
    """Processor time of both, for each number of campaigns."""
    table = Table(
        "A dry run of many campaigns",
        ("campaigns", "jobs", "processor\ns", "bare\ns", "ratio"),
    )
    worst = 0.0
    for campaigns in map(int, os.environ.get("BENCH_CAMPAIGNS", "1000").split()):
        own, bare, jobs = planned(campaigns)
        worst = max(worst, own / bare)
        table.add(f"{campaigns:,}", f"{jobs:,}", digits(own), digits(bare), f"{own / bare:.2f}")
    kept = "kept" if worst <= BAR else "MISSED"
    table.remarks.append(f"Processor time of Snakemake and all it starts. Bar: {BAR}, {kept}.")
    return [table]


def planned(campaigns: int) -> tuple[float, float, int]:
    """Processor time, s, of a dry run of the workflow and of the bare Snakefile; their jobs."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        logs = _campaigns(folder, campaigns)
        (folder / "Snakefile").write_text(_bare(logs), encoding="utf-8")
        own, jobs = _dry_run(folder, ROOT / "Snakefile")
        bare, same = _dry_run(folder, folder / "Snakefile")
    if jobs != same:
        raise RuntimeError(f"the bare Snakefile plans {same} jobs, the workflow {jobs}")
    return own, bare, jobs


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
            f'    shell: "python -m stages.{stage} data/derived/{{wildcards.campaign}}"'
        )
    return "\n".join(rules) + "\n"


def _dry_run(folder: Path, snakefile: Path) -> tuple[float, int]:
    """Processor time, s, and the number of jobs that a run would do."""
    where = ["--snakefile", str(snakefile), "--directory", str(folder)]
    before = _spent()
    done = subprocess.run(
        [sys.executable, "-m", "snakemake", "--cores", "2", "--nolock", "--dry-run", *where],
        capture_output=True,
        text=True,
        check=True,
    )
    totals = [line.split() for line in done.stdout.splitlines() if line.startswith("total ")]
    return _spent() - before, int(totals[0][1])


def _spent() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime
