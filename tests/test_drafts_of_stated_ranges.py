"""`make draft`: the range that a header states, beside what gravity and motion show of counts."""

import numpy as np
import pytest
from drafting import comments, drafted, moved, told
from logs_by_hand import by_hand_log
from moved_by_hand import RATE

from commands.draft import full_scale
from inertial.text.units import DEGREE

G = 9.80665
RATES = [(20.0, (0.0, 0.0, 0.0))]
STATED = "# ODR 100 Hz\n# accel +-4g, gyro +-500dps, values are int16 LSB\n"


def in_counts(header: str, per_g: float, per_degree: float, seed: int | None = 40) -> str:
    """A log in counts; `seed`: of positions by hand, None: of one rest, which shows no gyro."""
    if seed is None:
        force, rate = np.split(moved(RATES)[:, 1:], 2, axis=1)
    else:
        log = by_hand_log(seed)
        force, rate = log.force, log.rate / DEGREE
    counts = np.hstack([force / G * per_g, rate * per_degree + np.array([[40.0, -25.0, 12.0]])])
    rows = np.column_stack([np.arange(len(force)) * round(1e6 / RATE), np.round(counts)])
    lines = "".join(" ".join(f"{value:.0f}" for value in row) + "\n" for row in rows)
    return f"{header}# us ax ay az gx gy gz\n{lines}"


def layout_of(text: str, tmp_path) -> tuple[dict, str]:
    folder = drafted({"log.txt": text}, tmp_path)
    return told(folder)["instrument"]["format"], comments(folder)


def test_a_range_that_the_motion_contradicts_is_asked_about_with_both_sizes(tmp_path):
    layout, said = layout_of(in_counts(STATED, 8192, 32.8), tmp_path)
    assert layout["gyro"]["counts_per_unit"] == 32.8
    assert "gyros of log.txt: the header says ±500 °/s, by which 65.50 or 57.10" in said
    assert "the motion makes it 32.80; which range was set?" in said
    assert "accelerometers of log.txt" not in said


def test_a_range_that_gravity_contradicts_is_asked_about_with_both_sizes(tmp_path):
    layout, said = layout_of(in_counts(STATED, 2048, 65.5), tmp_path)
    assert layout["accelerometer"]["counts_per_unit"] == 2048
    assert "accelerometers of log.txt: the header says ±4 g, by which 8192.0 counts" in said
    assert "gravity at rest makes it 2048.0" in said


@pytest.mark.parametrize("per_degree", [65.5, 57.1])
def test_a_range_that_agrees_is_evidence_and_no_question(per_degree, tmp_path):
    """Of ±500 °/s some makers have 65.5 counts in 1 °/s, others 57.1."""
    layout, said = layout_of(in_counts(STATED, 8192, per_degree), tmp_path)
    assert layout["gyro"]["counts_per_unit"] == per_degree
    assert "the header says ±500 °/s, which is the same" in said
    assert "the header says ±4 g, which is the same" in said and "which range" not in said


@pytest.mark.parametrize(("range_", "counts"), [("500", 65.5), ("2000", 16.4)])
def test_where_no_motion_shows_the_size_the_range_does(range_, counts, tmp_path):
    """It was guessed beside the size of the accelerometers, and the range was asked about."""
    header = STATED.replace("500", range_)
    layout, said = layout_of(in_counts(header, 8192, counts, None), tmp_path)
    assert layout["gyro"]["counts_per_unit"] == counts
    assert "which range was set" not in said


def test_names_of_fields_do_not_hide_the_range(tmp_path):
    names = ("t_us", "ax", "ay", "az", "gx", "gy", "gz")
    head, *rows = in_counts("# FS: 4g / 500dps\n", 8192, 32.8).splitlines()
    fields = (zip(names, row.split(), strict=True) for row in rows[1:])
    text = "".join("\t".join(f"{n}:{v}" for n, v in row) + "\n" for row in fields)
    _layout, said = layout_of(f"{head}\n{text}", tmp_path)
    assert "the header says ±4 g, which is the same" in said
    assert "the header says ±500 °/s, by which" in said


@pytest.mark.parametrize(
    ("header", "accel", "gyro"),
    [
        ("accel +-4g, gyro +-500dps", "±4 g", "±500 °/s"),
        ("FS=±2000 dps", None, "±2000 °/s"),
        ("Gyro range: ±250 deg/s, Accel range: ±2g", "±2 g", "±250 °/s"),
        ("ACCEL_RANGE 4, GYRO_RANGE 500", "±4 g", "±500 °/s"),
        ("sensitivity 17.50 mdps/LSB, 131 LSB/(°/s)", None, None),
        ("ranges ±2/4/8/16 g, 250/500/1000 dps", None, None),
        ("mass 4 g, 100 Hz", None, None),
    ],
)
def test_ranges_in_headers(header, accel, gyro):
    found = full_scale.of_accel([header]), full_scale.of_gyro([header])
    assert tuple(each and each.words for each in found) == (accel, gyro)
