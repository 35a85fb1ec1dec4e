"""Stages that are forked from a prepared process run as they do by themselves."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from stages.starting import prepared

ROOT = Path(__file__).parent.parent
ASK = ROOT / "stages/starting/ask.py"
ENDS = {
    "well": "print('done', end='')\n",
    "refused": "import sys\nsys.exit('refused: the key rate_hz')\n",
    "with_code": "import sys\nsys.exit(7)\n",
    "failed": "raise ValueError('what is wrong')\n",
    "killed": "import os, signal\nos.kill(os.getpid(), signal.SIGKILL)\n",
    "told": "import os, sys\nprint(os.getcwd(), *sys.argv[1:], end='')\n",
    "meets": (
        "import pathlib, sys, time\n"
        "own, other = map(pathlib.Path, sys.argv[1:])\n"
        "own.touch()\n"
        "while not other.exists():\n"
        "    time.sleep(0.01)\n"
    ),
}


@pytest.fixture
def house(tmp_path, monkeypatch):
    """A project with the stages above; what is asked goes to its own prepared process."""
    (tmp_path / "stages").mkdir()
    (tmp_path / "stages/__init__.py").touch()
    for name, text in ENDS.items():
        guarded = "".join(f"    {line}\n" for line in text.splitlines())
        (tmp_path / f"stages/{name}.py").write_text(f"if __name__ == '__main__':\n{guarded}")
    (tmp_path / "stages/starting").symlink_to(ROOT / "stages/starting")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def begun(house):
    with prepared.begin(Path("socket")) as process:
        yield process


def ask(*arguments: str, folder: Path | None = None, place: str = "socket"):
    command = [sys.executable, "-I", "-S", str(ASK), place, *arguments]
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, timeout=60)


CASES = [
    ("well", 0, "done", ""),
    ("refused", 1, "", "refused: the key rate_hz\n"),
    ("with_code", 7, "", ""),
    ("failed", 1, "", "ValueError: what is wrong\n"),
    ("killed", 128 + signal.SIGKILL, "", ""),
]


@pytest.mark.parametrize(("stage", "code", "output", "error"), CASES)
def test_a_stage_ends_as_it_does_by_itself(begun, stage, code, output, error):
    asked = ask(stage)
    assert (asked.returncode, asked.stdout) == (code, output)
    assert asked.stderr.endswith(error)
    itself = subprocess.run([sys.executable, "-m", f"stages.{stage}"], capture_output=True)
    assert itself.returncode in (code, -signal.SIGKILL)
    assert asked.stdout == itself.stdout.decode()


def test_it_runs_where_it_was_asked_with_every_argument(begun, house):
    folder = house / "data"
    folder.mkdir()
    arguments = ["--name=a b", "'quoted'", "", "ä\n"]
    asked = ask("told", *arguments, folder=folder, place=str(house / "socket"))
    assert asked.stdout == " ".join([str(folder), *arguments])


def test_two_run_side_by_side(begun):
    command = [sys.executable, "-I", "-S", str(ASK), "socket", "meets"]
    both = [subprocess.Popen([*command, *names]) for names in (("a", "b"), ("b", "a"))]
    assert [one.wait(60) for one in both] == [0, 0]


def test_where_none_is_prepared_the_stage_runs_all_the_same(house):
    assert ask("well", place="nowhere").stdout == "done"
    with prepared.begin(Path("socket")) as process:
        process.kill()  # though its socket is there
        process.wait()
        asked = ask("refused")
    assert (asked.returncode, asked.stderr) == (1, "refused: the key rate_hz\n")


def test_code_that_has_changed_since_it_was_loaded_is_not_run(house):
    part = house / "stages/part.py"
    part.write_text("WORD = 'loaded'\n")
    told = "from stages.part import WORD\nif __name__ == '__main__':\n    print(WORD, end='')\n"
    (house / "stages/said.py").write_text(told)
    with prepared.begin(Path("socket")):
        assert ask("said").stdout == "loaded"
        part.write_text("WORD = 'changed since'\n")
        assert ask("said").stdout == "changed since"


def test_it_ends_with_who_began_it_and_leaves_nothing(house):
    with prepared.begin(Path("socket")) as process:
        ask("well")
        process.stdin.close()
        assert process.wait(10) == 0
    assert not Path("socket").exists()
