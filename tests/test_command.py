"""The command of the wheel, installed apart from this checkout, on a folder elsewhere."""

import shutil
import subprocess
import sys
import venv
from pathlib import Path

import chain
import pytest

PROGRAM = "turntable-calibration"


pytestmark = pytest.mark.slow  # it builds the wheel and installs it


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, built and installed; what it depends on is that of this environment."""
    folder = tmp_path_factory.mktemp("installed")
    pip = [sys.executable, "-m", "pip", "--quiet"]
    alone = ["--no-deps", "--no-build-isolation"]
    subprocess.run([*pip, "wheel", *alone, "-w", folder, chain.ROOT], check=True)
    (wheel,) = folder.glob("*.whl")
    environment = folder / "environment"
    venv.create(environment, with_pip=False)
    subprocess.run(
        [*pip, "--python", environment / "bin/python", "install", "--no-deps", wheel], check=True
    )
    (own,) = environment.glob("lib/python*/site-packages")
    (depends,) = (Path(path) for path in sys.path if path.endswith("site-packages"))
    (own / "depends.pth").write_text(f"{depends}\n")
    return environment / "bin" / PROGRAM


def call(program: Path, *arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([program, *arguments], cwd=cwd, capture_output=True, text=True)


def test_it_ships_what_the_workflow_needs_and_nothing_of_this_checkout(installed: Path) -> None:
    (home,) = installed.parent.parent.glob("lib/python*/site-packages/turntable_calibration")
    shipped = home / "workflow"
    for place in ("stages", "inertial", "commands", "overviews", "laboratory", "profiles"):
        here = {
            path.relative_to(chain.ROOT)
            for path in (chain.ROOT / place).rglob("*")
            if path.is_file() and "__pycache__" not in path.parts
        }
        there = {
            path.relative_to(shipped) for path in (shipped / place).rglob("*") if path.is_file()
        }
        assert {path for path in there if "__pycache__" not in path.parts} == here
    assert not (home / "tests").exists()


def test_a_campaign_elsewhere_is_checked(installed: Path, tmp_path: Path) -> None:
    raw = chain.simulate(chain.short(), tmp_path / "data/raw/june")
    checked = call(installed, "check", "june", cwd=tmp_path)
    assert checked.returncode == 0, checked.stdout + checked.stderr
    assert "june: 12 of 12 manoeuvres found, 12 complete." in checked.stdout
    assert {path.name for path in tmp_path.iterdir()} <= {"data", "reports", ".snakemake"}

    (raw / "x-up.asc").write_bytes(b"<!DOCTYPE html>\n<html>\n")
    refused = call(installed, "check", "june", cwd=tmp_path)
    assert refused.returncode == 1
    assert "decode: x-up.asc\n  found:    a page of HTML" in refused.stderr
    before, _, _log = refused.stderr.rpartition("The full log: ")
    assert before.endswith(f"{'=' * 80}\n")


def test_a_report_is_made_elsewhere(installed: Path, tmp_path: Path) -> None:
    chain.simulate(chain.short(), tmp_path / "there/data/raw/june")
    made = call(installed, "--folder", "there", "report", "june", cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    assert (tmp_path / "there/reports/june.html").stat().st_size > 100_000
    assert made.stdout.splitlines()[-1].startswith("The report: reports/june.html")
    traced = call(
        *(installed, "--folder", "there", "trace", "june", "gyroscope/joint/bias_x"), cwd=tmp_path
    )
    assert traced.returncode == 0, traced.stdout
    assert "Every link is intact" in traced.stdout

    shutil.copytree(tmp_path / "there/data/raw/june", tmp_path / "there/data/raw/july")
    (tmp_path / "there/data/raw/july/x-up.asc").write_bytes(b"<!DOCTYPE html>\n<html>\n")
    (tmp_path / "there/reports/june.html").unlink()
    several = call(installed, "--folder", "there", "report", "july", "june", cwd=tmp_path)
    assert several.returncode == 1
    assert "decode: x-up.asc\n  found:    a page of HTML" in several.stderr
    assert (tmp_path / "there/reports/june.html").stat().st_size > 100_000


def test_a_plan_is_written_and_its_name_is_not_taken_twice(installed: Path, tmp_path: Path) -> None:
    assert call(installed, "new", "six-position", "june", cwd=tmp_path).returncode == 0
    assert (tmp_path / "data/raw/june/campaign.yaml").is_file()
    twice = call(installed, "new", "six-position", "june", cwd=tmp_path)
    assert twice.returncode == 2
    assert "there is a campaign of this name" in twice.stderr


def test_help_completion_and_an_unknown_campaign(installed: Path, tmp_path: Path) -> None:
    said = call(installed, "--help", cwd=tmp_path).stdout
    for name in ("report", "crate", "check", "draft", "new", "trace", "design", "compare", "index"):
        assert f"\n  {name} " in said
    assert "Exit status: 0" in said
    (tmp_path / "data/raw/june").mkdir(parents=True)
    (tmp_path / "data/raw/june/campaign.yaml").touch()
    unknown = call(installed, "report", "july", cwd=tmp_path)
    assert unknown.returncode == 2
    assert unknown.stderr.splitlines()[-1].endswith("there is no campaign july; there are: june")
    completed = subprocess.run(
        [installed],
        cwd=tmp_path,
        env={
            "COMP_WORDS": f"{PROGRAM} report ",
            "COMP_CWORD": "2",
            "_TURNTABLE_CALIBRATION_COMPLETE": "bash_complete",
        },
        capture_output=True,
        text=True,
    )
    assert completed.stdout == "plain,june\n"
    assert "complete" in call(installed, "completion", "bash", cwd=tmp_path).stdout
