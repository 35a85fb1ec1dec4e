"""Compiled loops are those of the files as they stand."""

import shutil
import subprocess
import sys

from stages.formats import compiled

CALLED = "from .compiled import {kind}\n\n@{kind}\ndef step(x):\n    return x + {step}\n"
CALLER = """from .compiled import compiled
from .called import step

@compiled
def twice(x):
    return step(step(x))

print(twice(0))
"""


def test_a_loop_is_compiled_anew_when_one_that_it_calls_changes(tmp_path):
    """The file of the loop itself stays as it is, so by its date nothing has changed."""
    package = tmp_path / "loops"
    package.mkdir()
    shutil.copy(compiled.__file__, package)
    (package / "caller.py").write_text(CALLER)

    def said(kind: str, step: int) -> str:
        (package / "called.py").write_text(CALLED.format(kind=kind, step=step))
        run = [sys.executable, "-m", "loops.caller"]
        return subprocess.run(run, cwd=tmp_path, capture_output=True, text=True, check=True).stdout

    assert said("compiled", 1).strip() == "2"
    assert said("compiled", 2).strip() == "4"
    assert said("inlined", 3).strip() == "6"
    kept = {path: path.stat().st_mtime_ns for path in package.rglob("*.nb?")}
    assert said("compiled", 1).strip() == "2"  # as it was: nothing is compiled again
    assert {path: path.stat().st_mtime_ns for path in package.rglob("*.nb?")} == kept != {}
