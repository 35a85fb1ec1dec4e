"""The clock of the encoder's log, of stamps that are rounded to their count."""

from pathlib import Path

import numpy as np
import pytest

from inertial.formats.columns.column_reader import Encoder

RATE, INTERVAL = 72.0, 0.020002  # °/s; s, 100 ppm off a whole number of counts of 0.1 ms
LAYOUT = {
    "kind": "columns",
    "delimiter": ",",
    "header_lines": 1,
    "time": {"column": 1, "unit": "s"},
    "table_angle": {"column": 2, "unit": "deg"},
}


def encoder(folder: Path, stamps, angles) -> Encoder:
    rows = [f"{t:.4f},{a:.5f}" for t, a in zip(stamps, angles, strict=True)]
    (folder / "table.csv").write_text("\n".join(["t,angle", *rows, ""]))
    return Encoder(folder / "table.csv", LAYOUT, 360.0)


@pytest.mark.parametrize("lost", [slice(0, 0), slice(1000, 1050)])
def test_rounded_stamps_of_an_even_clock_bring_no_jumps(tmp_path: Path, lost: slice) -> None:
    """A count of 0.1 ms is 0.0072° at 72 °/s, at every tenth of the 50 readings of a second."""
    times = np.delete(0.125 + INTERVAL * np.arange(3000), lost)
    own = encoder(tmp_path, times, RATE * times)
    at = np.arange(1.0, 59.0, 0.01)
    off = own.angle_at(at) - RATE * at
    known = np.isfinite(off)
    assert known.mean() > 0.9
    assert np.ptp(off[known]) < 2e-4  # an angle is written to 1e-5
    assert abs(off[known].mean()) < RATE * 5e-5


def test_stamps_of_a_clock_that_is_not_even_are_used(tmp_path: Path) -> None:
    """Readings that do come 1 ms early or late are at their own times."""
    random = np.random.default_rng(3)
    times = np.round(INTERVAL * np.arange(3000) + 1e-3 * random.standard_normal(3000), 4)
    own = encoder(tmp_path, times, RATE * times)
    at = np.arange(1.0, 59.0, 0.01)
    assert np.abs(own.angle_at(at) - RATE * at).max() < 1e-4
