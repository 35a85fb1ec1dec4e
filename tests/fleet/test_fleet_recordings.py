"""The five real MPU-9150 by hand as a fleet, against the published values of each."""

import shutil

import numpy as np
import pyarrow.parquet as pq
import pytest
from recordings.known import RECORDINGS

from inertial import tables
from overviews.fleet.declared import READ
from overviews.fleet.members import members_of
from overviews.fleet.results import results_of

NAMES = [f"mikoff-{number}" for number in range(1, 6)]
UNITS = {"bias": 1.0, "scale": 0.01}  # of what is published


@pytest.fixture(scope="module")
def pooled(drafted, tmp_path_factory):
    """Their tables with what only a person knows: that they are five of one type."""
    folder = tmp_path_factory.mktemp("mpu9150")
    for name in NAMES:
        _, results = drafted(name, "compensation")
        for read in READ.values():
            (folder / name / read.place).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(results.folder / read.place, folder / name / read.place)
        file = folder / name / "plan/campaign.parquet"
        about = tables.CAMPAIGN.read(file).assign(instrument="MPU-9150", serial=name)
        pq.write_table(tables.CAMPAIGN.arrow(about), file)
    rows, _ = results_of(members_of(NAMES, folder), false_discoveries=0.03, outliers=0.01)
    return rows


@pytest.mark.slow
@pytest.mark.parametrize("quantity", UNITS)
@pytest.mark.parametrize("axis", range(3))
def test_mean_and_spread_are_those_of_the_published_values(pooled, quantity, axis):
    """Each campaign has one IMU: the spread is by IMU, table or campaign, which none tells."""
    published = np.array(
        [
            known.values[axis]
            for recording in RECORDINGS
            for known in recording.known
            if recording.name in NAMES and known.quantity == quantity
        ]
    )
    published = published * UNITS[quantity]
    key = ("accel", f"{quantity}_{'xyz'[axis]}")
    (row,) = [r for r in pooled["population"] if (r["sensor"], r["parameter"]) == key]
    (spread,) = [r for r in pooled["spreads"] if (r["sensor"], r["parameter"]) == key]
    assert spread["levels"] == "table + imu + campaign"
    assert spread["value"] == pytest.approx(published.std(ddof=1), abs=spread["sigma"] / 2)
    assert row["mean"] == pytest.approx(published.mean(), abs=row["mean_sigma"] / 2)


@pytest.mark.slow
def test_what_they_cannot_tell_is_said(pooled):
    """A table by hand has no name: what goes with the IMU may belong to its only campaign."""
    assert not pooled["outliers"]
    for finding in pooled["findings"]:
        possible = {
            row["level"]
            for row in pooled["sharings"]
            if row["finding"] == finding["finding"] and row["possible"]
        }
        assert possible == {"type"} or {"table", "imu", "campaign"} <= possible
