"""A disk that fills while a stage writes: said by name, and nothing is half-written."""

import resource
import subprocess
import sys
from pathlib import Path

import chain
import pytest

from inertial.tables.errors import Refusal
from inertial.tables.whole_files import write_whole

DECODE = [sys.executable, "-m", "stages", "decode"]


def limited(size: int):
    """What a process does before it begins: no file of its own grows beyond `size` bytes."""

    def limit() -> None:
        import signal

        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # then a write fails as on a full disk
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit


def run(results: chain.Results, raw: Path, size: int | None):
    return subprocess.run(
        [*DECODE, str(results.folder), "--raw", *map(str, sorted(raw.glob("*.asc")))],
        cwd=chain.ROOT,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=None if size is None else limited(size),
    )


@pytest.fixture(scope="module")
def decoded(tmp_path_factory) -> tuple[Path, chain.Results]:
    folder = tmp_path_factory.mktemp("full")
    campaign = chain.simulate(chain.demo(), folder / "raw")
    results = chain.run(campaign, folder / "derived", "plan")
    done = run(results, campaign, None)
    assert done.returncode == 0, done.stderr
    return campaign, results


@pytest.mark.parametrize("size", [0, 1000, 100_000])
def test_a_stage_without_room_leaves_the_tables_that_were_there(decoded, size):
    campaign, results = decoded
    output = results.folder / "decode"
    before = {path.name: path.read_bytes() for path in output.iterdir()}

    failed = run(results, campaign, size)
    assert failed.returncode == 1
    assert f"decode: {output}" in failed.stderr
    assert "found:    no room" in failed.stderr
    assert "Traceback" not in failed.stderr
    assert {path.name: path.read_bytes() for path in output.iterdir()} == before


def test_of_some_files_all_are_written_or_none(tmp_path):
    first, second = tmp_path / "a", tmp_path / "b"
    first.write_bytes(b"before")
    second.with_name("b.part").mkdir()  # it cannot be written there
    with pytest.raises(OSError, match="directory"):
        write_whole({first: b"after", second: b"after"})
    assert first.read_bytes() == b"before"
    assert not second.exists()


def test_no_room_is_a_refusal(tmp_path, monkeypatch):
    def no_room(path: Path, data: bytes) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", no_room)
    with pytest.raises(Refusal, match="No space left on device"):
        write_whole({tmp_path / "a": b"text"})
    assert not list(tmp_path.iterdir())
