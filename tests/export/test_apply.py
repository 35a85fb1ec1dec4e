"""The examples in C and Python take the errors out of the worked samples, from the files alone."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from stages.export.c_header import c_header
from stages.export.calibration import NOT_USABLE, Calibration
from stages.export.document import as_json, document
from tests.export.made_up import EVIL, calibration, mount, moving_mount, named

EXAMPLES = Path(__file__).parents[2] / "docs/apply"
WARNINGS = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic")


def by_python(whole: Calibration, folder: Path, text: str = "") -> subprocess.CompletedProcess[str]:
    file = folder / "a.json"
    file.write_text(text or as_json(document(whole)), "utf-8")
    command = [sys.executable, EXAMPLES / "apply.py", file]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def by_c(whole: Calibration, folder: Path, text: str = "") -> subprocess.CompletedProcess[str]:
    if shutil.which("cc") is None:
        pytest.skip("no C compiler is installed (cc)")
    file, program = folder / "a.h", folder / "a.out"
    file.write_text(text or c_header(document(whole)), "utf-8")
    define = f'-DCALIBRATION="{file}"'
    compiler = ["cc", *WARNINGS, define, EXAMPLES / "apply.c", "-lm", "-o", program]
    subprocess.run(compiler, check=True)
    return subprocess.run([program], capture_output=True, text=True, check=False)


MOVING = calibration(moving_mount(), mount("other"))


@pytest.mark.parametrize("applied", [by_c, by_python])
def test_the_worked_samples_come_out_with_effects_of_both_triads(applied, tmp_path) -> None:
    done = applied(MOVING, tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("differs by") == 6  # two samples and one, force and rate of each


@pytest.mark.parametrize(
    ("applied", "write"),
    [(by_c, c_header), (by_python, as_json)],
)
@pytest.mark.parametrize("number", ["2e-05", "0.0004", "90.0", "3e-06", "0.0507"])
def test_another_number_is_noticed(applied, write, number: str, tmp_path: Path) -> None:
    """Of a bias and of each kind of effect: the check of the examples is none that cannot fail."""
    text = write(document(MOVING))
    changed, count = re.subn(rf"(?<![0-9.e-]){number}(?![0-9])", "0.0009", text)
    assert count
    assert applied(MOVING, tmp_path, changed).returncode == 1


def test_by_hand_the_g_sensitivity_is_what_is_missing_at_rest() -> None:
    """g_xx f_x = 3e-6 · 9.8 rad/s is in the reading; what is left is not that of M and bias."""
    with_effects, without = (
        document(calibration(one))["mounts"][0]["worked_samples"][0]["gyroscope"]["corrected"]
        for one in (moving_mount(), mount())
    )
    assert without[0] - with_effects[0] == pytest.approx(3e-6 * 9.8, rel=0.02)


def test_of_sensors_that_are_not_usable_nothing_is_applied(tmp_path: Path) -> None:
    whole = mount()
    verdict = (whole.gyroscope.verdict or {}) | {"verdict": NOT_USABLE}
    spoilt = replace(whole, gyroscope=replace(whole.gyroscope, verdict=verdict))
    header = c_header(document(calibration(spoilt)))
    assert "{{NAN, NAN, NAN}, {NAN, NAN, NAN}, {NAN, NAN, NAN}}, {NAN, NAN, NAN}" in header
    missing = calibration(mount(missing={"gyroscope": ["cross_xy", "bias_y"]}))
    assert by_python(missing, tmp_path).returncode == by_c(missing, tmp_path).returncode == 0


def test_nothing_exported_still_compiles(tmp_path: Path) -> None:
    empty = replace(calibration(), mounts=[], noise=[], not_exported="compensated")
    assert by_c(empty, tmp_path).returncode == 0


def test_any_name_stays_a_text(tmp_path: Path) -> None:
    name = '"; int main(void){return 3;} */ // ??/' + "\n#error\\" + "".join(EVIL)
    done = by_c(named(name.replace("\0", "")), tmp_path)
    assert done.returncode == 0
    assert '"; int main(void){return 3;} */ // ??/' in done.stdout


def test_the_numbers_are_those_of_the_json_to_the_last_bit() -> None:
    content = document(calibration(moving_mount()))
    header = c_header(content)
    for kind in ("accelerometer", "gyroscope"):
        triad = content["mounts"][0][kind]
        numbers = np.ravel([*triad["inverse"]["value"], triad["bias"]["value"]])
        numbers = [*numbers, *(r["value"] for e in triad["effects"] for r in e["parameters"])]
        assert all(repr(float(one)) in header for one in numbers)
