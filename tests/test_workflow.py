"""The workflow: it tells what the stages tell, reruns what changed, and survives what goes wrong.

It runs in a checkout of the project, so that lines of it can be changed, on the demo and on short
campaigns of the simulated laboratory.
"""

from __future__ import annotations

import math
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from inertial.tables.declared import Declared
from stages import ORDER
from tests.chain import ROOT, short, simulate
from tests.text.test_chinese import english_left

pytestmark = pytest.mark.workflow

PAGE = "reports/demo.html"
PUBLISHED = "data/raw/demo/published.yaml"
DIAGNOSED = {"diagnosis", "compensation", "navigation", "alignment", "history", "report"}
USING = {"comparison", "simulation", "criticism", "extension", *DIAGNOSED}
ESTIMATION = {"accelerometer", "gyroscope", "studies", *USING}
AFTER_DECODE = {"quality", "segment", "noise", *ESTIMATION}
PATIENCE = 60  # s, until a stage must have begun


@dataclass(frozen=True)
class Workflow:
    """A Snakefile with its stages, and the folder that holds the data it is run on."""

    home: Path
    data: Path
    said: str = ""  # by the first `make report`

    def command(self, *arguments: str) -> list[str]:
        """Snakemake as `make report` calls it."""
        where = ["--snakefile", str(self.home / "Snakefile"), "--directory", str(self.data)]
        return [sys.executable, "-m", "snakemake", "--cores", "2", "--nolock", *where, *arguments]

    def run(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            self.command(*arguments), capture_output=True, text=True, env=from_a_fresh_shell()
        )

    def planned(self, *arguments: str) -> set[str]:
        """The rules that a run would run."""
        dry = self.run("--dry-run", *arguments, "--", PAGE)
        assert dry.returncode == 0, dry.stderr
        return set(re.findall(r"^(\w+) +\d+$", dry.stdout + dry.stderr, re.MULTILINE)) - {"total"}

    def beside(self, data: Path, *campaigns: str) -> Workflow:
        """The same workflow on fresh data: the raw logs of a short campaign by these names."""
        for campaign in campaigns:
            simulate(short(), data / "data/raw" / campaign)
        return Workflow(self.home, data)


@pytest.fixture(scope="module")
def workflow(tmp_path_factory: pytest.TempPathFactory) -> Workflow:
    """A checkout of what git has, as it stands here, in which `make report` was run once."""
    if not (ROOT / ".git").exists() or shutil.which("git") is None:
        pytest.skip("needs a git checkout, which it copies")
    home = tmp_path_factory.mktemp("checkout")
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True)
    for name in filter(None, listed.stdout.split("\0")):
        if (ROOT / name).is_file():
            (home / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, home / name)
    # With the environment that this runs in: to make one is what CI begins with.
    (home / ".venv").symlink_to(sys.prefix)
    os.utime(home / "requirements.lock", (0, 0))
    (home / "data/raw/demo").mkdir(parents=True)
    (home / PUBLISHED).write_text("source: data sheet\ngyro: {bias_x: {value: 0.5, unit: deg/h}}\n")
    first = make(home, "report")
    assert first.returncode == 0, first.stdout + first.stderr
    assert "(100%) done" in first.stderr
    return Workflow(home, home, first.stdout)


def make(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """`make` in a folder."""
    env = from_a_fresh_shell()
    return subprocess.run(["make", *arguments], cwd=folder, env=env, capture_output=True, text=True)


def from_a_fresh_shell() -> dict[str, str]:
    """The environment without what an outer `make test` hands down."""
    passed_on = ("MAKEFLAGS", "MAKELEVEL", "MFLAGS", "MAKEOVERRIDES", "CAMPAIGN", "ENDED")
    return {name: value for name, value in os.environ.items() if name not in passed_on}


# ---- one story


def test_the_rules_are_the_stages_with_what_they_declare(workflow: Workflow) -> None:
    documents = ["reports/demo.pdf", "reports/demo.calibration.json"]
    summary = workflow.run("--detailed-summary", "--", *documents).stdout.splitlines()
    names = summary[0].split("\t")
    outputs: dict[str, set[str]] = {}
    for line in summary[1:]:
        row = dict(zip(names, line.split("\t"), strict=True))
        outputs.setdefault(row["rule"], set()).add(row["output_file"])
        if row["rule"] in set(ORDER) - {"pdf"}:
            assert f"python -m stages {row['rule']} data/derived/demo" in row["shellcmd"]
    assert set(outputs) - {"pdf"} == {*ORDER, "laboratory_demo"} - {"pdf"}
    for stage in set(ORDER) - {"pdf"}:
        declared: Declared = import_module(f"stages.{stage}.declared").DECLARED
        expected = {f"data/derived/demo/{stage}/{table}.parquet" for table in declared.writes}
        expected |= {f"reports/demo.{ending}" for ending in declared.documents}
        assert outputs[stage] == expected


# ---- what changed is run again, and only that


def test_a_second_run_does_nothing(workflow: Workflow) -> None:
    second = workflow.run(PAGE)
    assert "Nothing to be done" in second.stdout + second.stderr


def test_a_file_that_is_only_newer_changes_nothing(workflow: Workflow) -> None:
    """As after a fresh checkout of the same state."""
    for file in (workflow.home / "stages").rglob("*.py"):
        file.touch()
    assert workflow.planned() == set()


@pytest.mark.parametrize(
    ("setting", "rerun"),
    [
        pytest.param("segment: {margin: 0.6}", AFTER_DECODE - {"quality"}, marks=pytest.mark.slow),
        pytest.param("noise: {from_hz: 0.6}", {"noise", *ESTIMATION}, marks=pytest.mark.slow),
        ("accelerometer: {averaging_steps: 5}", {"accelerometer", *USING}),
    ],
)
def test_a_changed_setting_reruns_its_stage_and_what_follows(
    workflow: Workflow, tmp_path: Path, setting: str, rerun: set[str]
) -> None:
    changes = tmp_path / "changes.yaml"
    changes.write_text(setting)
    assert workflow.planned("--configfile", str(changes)) == rerun


@pytest.mark.parametrize(
    ("file", "rerun"),
    [
        pytest.param(
            *("inertial/formats/columns/text_reader.py", {"decode", *AFTER_DECODE}),
            marks=pytest.mark.slow,
        ),
        pytest.param(
            *("inertial/estimation/spectrum.py", {"noise", *ESTIMATION}), marks=pytest.mark.slow
        ),
        pytest.param(
            *("inertial/estimation/least_squares.py", {"segment", "noise", *ESTIMATION}),
            marks=pytest.mark.slow,
        ),
        pytest.param(
            *("inertial/text/numbers.py", {"plan", "decode", *AFTER_DECODE}),
            marks=pytest.mark.slow,
        ),
        pytest.param(
            *("inertial/text/cause_names.py", {"criticism", "extension", *DIAGNOSED}),
            marks=pytest.mark.slow,
        ),
        ("stages/report/report.css", {"report"}),
        pytest.param("inertial/text/zh.po", {"report"}, marks=pytest.mark.slow),
        ("laboratory/counts.py", {"laboratory_demo", "plan", "decode", *AFTER_DECODE}),
    ],
)
def test_a_changed_line_of_code_reruns_what_rests_on_it(
    workflow: Workflow, file: str, rerun: set[str]
) -> None:
    with one_more_line(workflow.home / file):
        assert workflow.planned() == rerun


def test_the_language_is_a_setting_of_the_report_alone(workflow: Workflow) -> None:
    assert workflow.planned("--config", "report={language: zh}") == {"report"}


@pytest.mark.slow
def test_the_report_in_chinese_has_no_english(workflow: Workflow, tmp_path: Path) -> None:
    said = [sys.executable, "-m", "stages", "report", str(workflow.data / "data/derived/demo")]
    said += ["--settings", '{"language": "zh"}', "--documents", str(tmp_path / "demo")]
    subprocess.run(said, cwd=workflow.home, check=True)
    page = (tmp_path / "demo.html").read_text(encoding="utf-8")
    assert '<html lang="zh-CN">' in page
    assert not english_left(page)
    assert not english_left((tmp_path / "demo.txt").read_text(encoding="utf-8"))


@pytest.mark.slow
def test_changed_published_values_rerun_the_plan_that_reads_them(workflow: Workflow) -> None:
    with one_more_line(workflow.data / PUBLISHED):
        assert "plan" in workflow.planned()
    assert workflow.planned() == set()


@contextmanager
def one_more_line(file: Path) -> Iterator[None]:
    before = file.read_bytes()
    file.write_bytes(before + b"\n")
    try:
        yield
    finally:
        file.write_bytes(before)


# ---- what goes wrong


@pytest.mark.slow
def test_a_killed_run_leaves_no_half_table_and_the_next_run_completes(
    workflow: Workflow, tmp_path: Path
) -> None:
    killed = workflow.beside(tmp_path, "killed")
    derived = tmp_path / "data/derived/killed"
    goals = [f"data/derived/killed/{of}/parameters.parquet" for of in ORDER[5:7]]
    for stage in ("decode", "noise", "gyroscope"):
        kill_within(stage, killed, derived, goals)
        assert list((derived / stage).glob("*.part"))
        assert not list((derived / stage).glob("*.parquet"))
        for table in derived.rglob("*.parquet"):
            pq.read_table(table)

    last = killed.run(*goals)
    assert last.returncode == 0, last.stderr
    assert all((tmp_path / goal).is_file() for goal in goals)
    assert not list(tmp_path.rglob("*.part"))
    assert {path.name for path in derived.iterdir()} == set(ORDER[:7])


def kill_within(stage: str, workflow: Workflow, derived: Path, goals: list[str]) -> None:
    """Start a run and kill it with all it started (-9) while `stage` is at work.

    A stage opens the parts of its tables before it works, and moves them at its end.
    """
    run = subprocess.Popen(
        workflow.command(*goals),
        start_new_session=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    until = time.monotonic() + PATIENCE
    while not list((derived / stage).glob("*.part")):
        assert run.poll() is None, f"the run ended before {stage} was seen at work"
        assert time.monotonic() < until, f"{stage} did not begin"
        time.sleep(0.001)
    os.killpg(run.pid, signal.SIGKILL)
    run.wait()


def test_a_bad_campaign_is_refused_by_name_and_a_good_one_beside_it_is_finished(
    workflow: Workflow, tmp_path: Path
) -> None:
    both = workflow.beside(tmp_path, "bad", "good")
    file = tmp_path / "data/raw/bad/campaign.yaml"
    file.write_text(file.read_text().replace("serial:", "sreial:"))
    line = 1 + [text.startswith("sreial:") for text in file.read_text().splitlines()].index(True)

    goals = [f"data/derived/{name}/segment/segments.parquet" for name in ("bad", "good")]
    done = both.run(*goals)

    assert done.returncode != 0
    assert [(tmp_path / goal).is_file() for goal in goals] == [False, True]
    said = done.stdout + done.stderr
    assert f"data/raw/bad/campaign.yaml, line {line}" in said
    assert "sreial" in said
    assert re.search(r"cure: .*serial", said)
    assert_it_is_the_last_on_the_screen(done.stderr)


def assert_it_is_the_last_on_the_screen(said: str) -> None:
    """A refusal in its box, after it the place of the full log, which has how it was called."""
    before, _, log = said.rpartition("The full log: ")
    before = re.sub(r"Makefile:\d+: \*\*\* $", "", before)  # by $(error) of make
    assert before.endswith(f"{'=' * 80}\n")
    refusal = before.split("=" * 80)[-2]
    assert [line.split()[0] for line in refusal.strip().splitlines()[1:]] == [
        "found:",
        "expected:",
        "cure:",
    ]
    assert "CalledProcessError" not in said
    (full,) = log.splitlines()
    assert "CalledProcessError" in Path(full.removesuffix(".  Stop.")).read_text()


def test_an_unknown_setting_is_refused_by_name(workflow: Workflow, tmp_path: Path) -> None:
    changes = tmp_path / "changes.yaml"
    changes.write_text("noise: {from_herz: 0.6}")
    done = workflow.run("--dry-run", "--configfile", str(changes), "--", PAGE)
    assert done.returncode != 0
    assert "'from_herz' was unexpected" in done.stdout + done.stderr


def test_a_mistake_in_the_settings_is_refused_with_its_line(workflow: Workflow) -> None:
    settings = workflow.home / "config.yaml"
    right = settings.read_text(encoding="utf-8")
    try:
        settings.write_text(right.replace("rest_block", "rest_blok"), encoding="utf-8")
        done = workflow.run("--dry-run", "--", PAGE)
    finally:
        settings.write_text(right, encoding="utf-8")
    assert done.returncode != 0 and "Traceback" not in done.stderr
    assert "config.yaml, line 11, segment.rest_blok" in done.stderr
    assert done.stderr.rstrip().endswith("cure:     write rest_block")


# ---- make


@pytest.mark.parametrize(
    "name",
    [
        "",
        "Demo",
        "dömo",
        "-n",
        "../demo",
        "a b",
        "x;touch run",
        "$(touch run)",
        "`touch run`",
        "$(shell touch run)",
        "x\ntouch run",
        "'\"; touch run",
    ],
)
def test_an_odd_name_of_a_campaign_is_refused_and_not_run(workflow: Workflow, name: str) -> None:
    before = set(workflow.home.iterdir())
    done = make(workflow.home, "report", f"CAMPAIGN={name}")
    assert done.returncode == 2
    assert "is no name of a campaign" in done.stderr
    assert set(workflow.home.iterdir()) == before


def test_make_report_in_a_clean_checkout(workflow: Workflow) -> None:
    home, said = workflow.home, workflow.said
    pages = ["reports/demo.html", *(["reports/demo.pdf"] if has_pango() else [])]
    for page in pages:
        assert (home / page).stat().st_size > 100_000
    *_, exported, path = said.splitlines()
    assert path == f"The report: {' '.join(pages)}"
    assert exported.startswith("For other programs: reports/demo.calibration.json ")
    for file in exported.partition(": ")[2].split():
        assert (home / file).stat().st_size > 100
    verdict, _, _ = (home / "reports/demo.txt").read_text().partition("\nCampaign:")
    assert verdict.startswith("SIMULATED")
    assert f"{verdict}\n{exported}\n{path}\n" in said

    second = make(home, "report")
    assert "Nothing to be done" in second.stderr
    assert f"{verdict}\n{exported}\n{path}\n" in second.stdout
    assert ".venv" not in second.stdout  # it was not made again


@pytest.mark.slow
@pytest.mark.parametrize("target", ["report", "check"])
def test_a_log_of_another_kind_is_refused_by_make(workflow: Workflow, target: str) -> None:
    name = f"page-{target}"
    raw = simulate(short(), workflow.home / "data/raw" / name)
    (raw / "x-up.asc").write_bytes(b"<!DOCTYPE html>\n<html>\n")
    refused = make(workflow.home, target, f"CAMPAIGN={name}")
    assert refused.returncode == 2
    assert "decode: x-up.asc\n  found:    a page of HTML" in refused.stderr
    assert_it_is_the_last_on_the_screen(refused.stderr)


@pytest.mark.slow
def test_the_pages_of_several_campaigns_are_made_again_when_a_result_changes(
    workflow: Workflow,
) -> None:
    pages = ["reports/index.html", "reports/history/SIM-001.html"]

    def planned() -> set[str]:
        dry = workflow.run("--dry-run", "--", *pages)
        assert dry.returncode == 0, dry.stderr
        return set(re.findall(r"^(\w+) +\d+$", dry.stdout + dry.stderr, re.MULTILINE)) - {"total"}

    made = make(workflow.home, "index")
    assert made.returncode == 0, made.stderr
    assert '<a href="demo.html">demo</a>' in (workflow.home / pages[0]).read_text()
    assert (workflow.home / pages[1]).stat().st_size > 100_000
    assert planned() == set()
    with one_more_line(workflow.home / "overviews/index/sorted_tables.js"):
        assert planned() == {"index"}
    with one_more_line(workflow.home / "stages/diagnosis/stage.py"):
        assert {"diagnosis", "history", "index", "history_page"} <= planned()
    # A campaign that is refused now does not keep the others from the page.
    campaign = workflow.home / "data/raw/refused/campaign.yaml"
    campaign.parent.mkdir()
    campaign.write_text("campaign: 1\n")
    try:
        assert make(workflow.home, "index").returncode == 0
        assert "refused</td>" in (workflow.home / pages[0]).read_text()
    finally:
        shutil.rmtree(campaign.parent)


def test_the_queries_of_the_page_on_usage_run_on_the_demo(
    workflow: Workflow, monkeypatch: pytest.MonkeyPatch
) -> None:
    duckdb = pytest.importorskip("duckdb")
    monkeypatch.chdir(workflow.data)
    page = (ROOT / "docs/usage.md").read_text(encoding="utf-8")
    queries = re.findall(r"^    -- .*\n((?:    .*\n)+?(?=\n|\Z))", page, re.MULTILINE)
    assert len(queries) == 4
    result, biases, causes, archive = (duckdb.sql(query).df() for query in queries)
    assert len(result) == 24 and result["sigma"].gt(0).all()
    assert sorted(biases["parameter"]) == ["bias_x", "bias_y", "bias_z"]
    own = result[(result["sensor"] == "gyro") & (result["parameter"] == "bias_x")]["value"].item()
    shown = biases.set_index("parameter").loc["bias_x", "value"]
    assert shown == pytest.approx(own * 180 / math.pi * 3600)
    assert {"gap", "gyro_g_sensitivity", "oscillation"} <= set(causes["cause"])
    assert list(archive["campaign"]) == ["demo"]


def has_pango() -> bool:
    try:
        import_module("weasyprint")
    except OSError:
        return False
    return True
