"""How long a gap is, by stamps that are coarser than the samples are apart."""

from math import degrees

import chain
import numpy as np
import pytest

COLUMNS = """
campaign: 1
instrument: {name: made up}
serial: unknown
date: unknown
site: {latitude_deg: null, gravity_m_s2: 9.8}
table: {name: table}
log: log.csv
formats:
  log:
    kind: columns
    delimiter: ","
    time: {column: 1, unit: s}
    accelerometer: {columns: [2, 3, 4], unit: m/s2}
    gyro: {columns: [5, 6, 7], unit: deg/s}
plan:
  - {id: turn, do: turn, up: +z, degrees: 90, rate_deg_s: 10, accel_deg_s2: 20, format: log}
"""


@pytest.mark.parametrize(("later", "missing"), [(0.0, 205 / 102.4), (0.003, 205 / 102.4 + 0.003)])
def test_stamps_of_a_millisecond_still_tell_a_whole_number_of_samples(later, missing, tmp_path):
    """102.4 samples per second, 205 of them lost; or a logger that began anew, 3 ms out of step."""
    n, rng = 3000, np.random.default_rng(4)
    time = np.arange(n) / 102.4
    turning = time - 10  # the turn takes 9.5 s
    rate = 10 * np.clip(np.minimum(turning, 9.5 - turning) / 0.5, 0, 1)
    values = np.column_stack([np.zeros((n, 2)), np.full(n, 9.8), np.zeros((n, 2)), rate])
    values += 1e-3 * rng.standard_normal(values.shape)
    time[1505:] += later
    kept = np.r_[:1300, 1505:n]
    rows = [f"{t:.3f}," + ",".join(f"{v:.6f}" for v in values[i]) for i, t in enumerate(time)]
    (tmp_path / "raw").mkdir()
    (tmp_path / "raw/campaign.yaml").write_text(COLUMNS)
    (tmp_path / "raw/log.csv").write_text("\n".join(rows[i] for i in kept) + "\n")
    results = chain.run(tmp_path / "raw", tmp_path / "derived", "segment")
    done = results["segment/performed"].iloc[0]
    assert done["bridged"]
    assert done["missing_s"] == pytest.approx(missing, abs=1e-3 if later else 1e-4)
    assert degrees(done["angle"] + done["missing_angle"]) == pytest.approx(90, abs=0.1)
