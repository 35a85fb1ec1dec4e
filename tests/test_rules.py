"""Each rule alone, on what it declares to read and nothing else: it makes what the whole run made.

What Snakemake's `--generate-unit-tests` does with stored files, here with those of one run.
"""

import shutil
import subprocess
import sys
from pathlib import Path

import chain
import pyarrow.parquet as pq
import pytest

from inertial.tables.campaign_files import logs_of
from stages import ORDER

CAMPAIGN = "june"
DERIVED = f"data/derived/{CAMPAIGN}"
RAW = f"data/raw/{CAMPAIGN}"
SHOWN = "report"  # takes longest
RULES = [stage for stage in ORDER if stage not in {SHOWN, "pdf"}]  # not every machine makes a PDF


def reads(whole: Path, rule: str) -> list[str]:
    """The files that a rule declares to read, by their places in the folder."""
    declared = chain.stage_of(rule).declared
    logs = [f"{RAW}/{log}" for log in logs_of(whole / RAW / "campaign.yaml")]
    by_kind = {"campaign": [f"{RAW}/campaign.yaml"], "raw": logs}
    files = [place for kind in declared.files for place in by_kind.get(kind, [])]
    return files + [f"{DERIVED}/{source.place}" for source in declared.reads.values()]


def writes(rule: str) -> list[str]:
    """The files that it writes."""
    declared = chain.stage_of(rule).declared
    tables = [f"{DERIVED}/{rule}/{name}.parquet" for name in declared.writes]
    return tables + [f"reports/{CAMPAIGN}.{ending}" for ending in declared.documents]


@pytest.fixture
def alone(whole: Path, tmp_path: Path, rule: str) -> Path:
    """A folder with what a rule reads and nothing else."""
    for place in reads(whole, rule):
        (tmp_path / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(whole / place, tmp_path / place)
    (tmp_path / "reports").mkdir()
    return tmp_path


def assert_as_in(whole: Path, folder: Path, rule: str) -> None:
    """Equal tables, and equal bytes of documents."""
    for place in writes(rule):
        if place.endswith(".parquet"):
            made = pq.read_table(folder / place)
            assert made.equals(pq.read_table(whole / place)), place
        else:
            assert (folder / place).read_bytes() == (whole / place).read_bytes(), place
    there = {str(path.relative_to(folder)) for path in folder.rglob("*.parquet")}
    history = {place for place in there if place.startswith("data/history")}
    assert there - history == {p for p in {*reads(whole, rule), *writes(rule)} if "parquet" in p}


@pytest.mark.parametrize("rule", RULES)
def test_a_stage_needs_only_what_it_declares(whole: Path, alone: Path, rule: str) -> None:
    stage = chain.stage_of(rule)
    sources = {
        "campaign": [alone / RAW / "campaign.yaml"],
        "raw": sorted((alone / RAW).glob("*.asc")),
        "instruments": [chain.ROOT / "data/instruments.yaml"],
        "archive": [alone / "data/history"],
    }
    files = {name: sources.get(name, []) for name in stage.declared.files}
    documents = alone / f"reports/{CAMPAIGN}" if stage.declared.documents else None
    stage.run(alone / DERIVED, files, chain.SETTINGS.get(rule, {}), documents)
    assert_as_in(whole, alone, rule)


@pytest.mark.slow
@pytest.mark.workflow
@pytest.mark.parametrize("rule", [*RULES, SHOWN])
def test_its_rule_runs_it_so(whole: Path, alone: Path, rule: str) -> None:
    if rule == SHOWN and not (whole / f"reports/{CAMPAIGN}.html").exists():
        documents = whole / "reports" / CAMPAIGN
        chain.stage_of(SHOWN).run(whole / DERIVED, {}, chain.SETTINGS[SHOWN], documents)
    # Without the campaign file there is no campaign; no other rule may run.
    (alone / RAW).mkdir(parents=True, exist_ok=True)
    shutil.copytree(whole / RAW, alone / RAW, dirs_exist_ok=True)
    command = [
        *(sys.executable, "-m", "snakemake", "--cores", "1", "--nolock"),
        *("--snakefile", str(chain.ROOT / "Snakefile"), "--directory", str(alone)),
        *("--allowed-rules", rule, "--", *writes(rule)),
    ]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert_as_in(whole, alone, rule)
    assert (alone / DERIVED / rule / "benchmark.tsv").is_file()
