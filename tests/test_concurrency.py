"""Several at work on one folder, a disk that fills, runs that are killed: nothing is lost."""

import fcntl
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import chain
import pyarrow.parquet as pq
import pytest

from benchmarks import kills
from turntable_calibration.workflow_run import LOCK

pytestmark = pytest.mark.workflow

PATIENCE = 900  # s
ESTIMATED = ("accelerometer", "gyroscope")
WAITS = "Another run is at work here; this one waits for it."
KILLS = 20
ROOM, MORE_ROOM = "2200k", "200m"  # the logs have 1.7 MB, the tables up to the gyros 3 MB
INDEX = [sys.executable, "-m", "turntable_calibration", "--cores", "1"]
OTHER = 65534  # user and group; may read what the first one may, so that Python can be anywhere
READ = "+dac_read_search"
AS_OTHER = [
    *("setpriv", f"--reuid={OTHER}", f"--regid={OTHER}", "--clear-groups"),
    *(f"--inh-caps={READ}", f"--ambient-caps={READ}", f"--bounding-set=-all,{READ}"),
]


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Snakemake on a folder."""
    where = ["--snakefile", str(chain.ROOT / "Snakefile"), "--directory", str(folder)]
    command = [sys.executable, "-m", "snakemake", "--nolock", "--cores", "1", *where]
    return subprocess.run([*command, *arguments], capture_output=True, text=True, cwd=chain.ROOT)


def goals(campaign: str) -> list[str]:
    return [f"data/derived/{campaign}/{stage}/parameters.parquet" for stage in ESTIMATED]


def index_of(folder: Path, *other: str, umask: int = 0o022) -> subprocess.Popen[str]:
    """The command that makes the page of all campaigns, of which there are none.

    `other`: what runs it as another user.
    """
    command = [*other, *INDEX, "--folder", str(folder), "index"]
    home = {"HOME": str(folder), "PYTHONDONTWRITEBYTECODE": "1"} if other else {}
    return subprocess.Popen(
        command,
        cwd=chain.ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT if other else None,
        text=True,
        bufsize=1,
        umask=umask,
        env=os.environ | home,
    )


@pytest.mark.slow
def test_a_second_run_on_a_folder_waits_for_the_first(tmp_path: Path) -> None:
    (tmp_path / LOCK).parent.mkdir()
    page = tmp_path / "reports/index.html"
    with (tmp_path / LOCK).open("a") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        second = index_of(tmp_path)
        assert second.stdout is not None
        assert second.stdout.readline().strip() == WAITS
        assert not page.exists()
    assert second.wait(PATIENCE) == 0
    assert page.exists()


@pytest.mark.slow
def test_a_killed_run_keeps_nobody_waiting_and_of_two_at_once_one_waits(tmp_path: Path) -> None:
    first = index_of(tmp_path)
    while not (tmp_path / ".snakemake/log").exists():  # it is at work
        assert first.poll() is None
    second = index_of(tmp_path)
    assert second.stdout is not None
    assert second.stdout.readline().strip() == WAITS
    # Snakemake itself has the lock, too: it goes on where only the command is killed.
    (snakemake,) = _children(first.pid)
    for pid in (first.pid, snakemake):
        os.kill(pid, 9)
    assert second.wait(PATIENCE) == 0
    first.wait()
    both = [index_of(tmp_path), index_of(tmp_path)]
    said = [each.communicate(timeout=PATIENCE)[0] for each in both]
    assert [each.returncode for each in both] == [0, 0]
    # Either makes its pages in two runs, so that each may have to wait for the other.
    assert any(WAITS in text for text in said)


@pytest.fixture
def for_two() -> Iterator[Path]:
    """A folder of a group that has another user, too, below one that all may enter."""
    if os.geteuid() != 0 or subprocess.run([*AS_OTHER, "true"], capture_output=True).returncode:
        pytest.skip("needs leave to run as another user")
    with TemporaryDirectory(dir="/var/tmp") as name:  # nobody may enter that of pytest
        Path(name).chmod(0o755)
        folder = Path(name) / "laboratory"
        folder.mkdir()
        os.chown(folder, -1, OTHER)
        folder.chmod(0o2775)
        yield folder


@pytest.mark.slow
def test_two_users_make_reports_in_a_folder_of_their_group(for_two: Path) -> None:
    """At once, and each what the other made before."""
    page = for_two / "reports/index.html"
    both = [index_of(for_two, umask=0o002), index_of(for_two, *AS_OTHER, umask=0o002)]
    said = [each.communicate(timeout=PATIENCE)[0] for each in both]
    assert [each.returncode for each in both] == [0, 0], said
    assert any(WAITS in text for text in said)
    owners = set()
    for other in (AS_OTHER, []):
        page.unlink()
        again = index_of(for_two, *other, umask=0o002)
        assert again.wait(PATIENCE) == 0
        owners.add(page.stat().st_uid)
    assert owners == {0, OTHER}


def test_a_folder_that_another_user_keeps_for_himself_is_refused(for_two: Path) -> None:
    (for_two / LOCK).parent.mkdir(mode=0o755)
    other = index_of(for_two, *AS_OTHER)
    said, _ = other.communicate(timeout=PATIENCE)
    assert other.returncode == 1
    assert "belongs to another user" in said and "umask 002" in said
    assert "Traceback" not in said
    assert not (for_two / "reports").exists()


def _children(pid: int) -> list[int]:
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


@pytest.mark.slow
def test_two_campaigns_of_one_imu_that_end_at_once_are_both_in_its_history(
    whole: Path, tmp_path: Path
) -> None:
    names = ("left", "right")
    for name in names:
        derived = tmp_path / "data/derived" / name
        shutil.copytree(whole / "data/derived/june", derived)
        made_by = pq.read_metadata(derived / "plan/campaign.parquet").metadata
        facts = pq.read_table(derived / "plan/campaign.parquet").replace_schema_metadata(made_by)
        place = facts.schema.get_field_index("campaign")
        renamed = facts.set_column(place, facts.schema.field(place), [[name]])
        pq.write_table(renamed, derived / "plan/campaign.parquet")
        _of_other_logs(derived / "plan/inputs.parquet", name)
    history = tmp_path / "data/history"

    def end(*ending: str) -> None:
        command = [sys.executable, "-m", "stages", "history", "--archive", str(history)]
        command += ["--settings", json.dumps(chain.SETTINGS["history"])]
        at_once = [
            subprocess.Popen([*command, str(tmp_path / "data/derived" / name)], cwd=chain.ROOT)
            for name in ending
        ]
        assert [each.wait(PATIENCE) for each in at_once] == [0] * len(ending)

    end(*names)
    kept = _contents(history)
    assert sorted(re.sub(r"-[0-9a-f]{12}\.parquet", "", Path(f).name) for f in kept) == [
        "2026-11-02-left",
        "2026-11-02-right",
    ]
    # Each finds the other when it runs again, and the archive stays as it is.
    end(*names)
    for name, other in (names, names[::-1]):
        earlier = pq.read_table(tmp_path / f"data/derived/{name}/history/earlier.parquet")
        assert set(earlier["campaign"].to_pylist()) == {other}
    assert _contents(history) == kept


def _of_other_logs(path: Path, name: str) -> None:
    """The same logs once more would be the same calibration by another name."""
    made_by = pq.read_metadata(path).metadata
    inputs = pq.read_table(path).replace_schema_metadata(made_by)
    place = inputs.schema.get_field_index("sha256")
    hashes = [hashlib.sha256(f"{name} {sha}".encode()).hexdigest() for sha in inputs["sha256"]]
    field = inputs.schema.field(place)
    pq.write_table(inputs.set_column(place, field, [hashes]), path)


def _contents(folder: Path) -> dict[str, bytes]:
    return {str(path): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system of its own, whose size can be changed."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={ROOM}", "tmpfs", str(disk)]
    if os.geteuid() != 0 or shutil.which("mount") is None or subprocess.run(mount).returncode:
        pytest.skip("needs leave to mount a small file system")
    yield disk
    subprocess.run(["umount", "--lazy", str(disk)], check=True)


@pytest.mark.slow
def test_on_a_full_disk_it_says_so_and_with_more_room_it_completes(
    small_disk: Path, tmp_path: Path
) -> None:
    chain.simulate(chain.short(), small_disk / "data/raw/june")
    full = run(small_disk, "--", *goals("june"))
    assert full.returncode != 0
    assert "No space left on device" in full.stdout + full.stderr
    for table in small_disk.rglob("*.parquet"):
        pq.read_table(table)
    subprocess.run(["mount", "-o", f"remount,size={MORE_ROOM}", str(small_disk)], check=True)
    last = run(small_disk, "--", *goals("june"))
    assert last.returncode == 0, last.stderr
    shutil.copytree(small_disk / "data/raw", tmp_path / "data/raw")
    other = chain.run(tmp_path / "data/raw/june", tmp_path / "derived/june")
    for stage in ESTIMATED:
        made = pq.read_table(small_disk / f"data/derived/june/{stage}/parameters.parquet")
        assert made.equals(pq.read_table(other.folder / f"{stage}/parameters.parquet"))


@pytest.mark.slow
def test_runs_killed_at_random_moments_end_as_an_undisturbed_one(tmp_path: Path) -> None:
    killed = kills.survived(tmp_path, KILLS, goals(kills.CAMPAIGN))
    assert not killed.damaged
    assert killed.last == 0
    assert not killed.different
