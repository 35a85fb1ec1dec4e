"""The envelope of a log as it is drawn: it loses no spike and hides no gap."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pandas as pd

from inertial import tables as contracts
from stages.report.sections import raw_data
from stages.report.sections.raw_data import MOST_MISSING, Log, envelope, logs
from tests.report import synthetic
from tests.report.synthetic_values import GAP, rows_as


def drawn(tables: dict[str, Any]) -> list[Log]:
    return logs(synthetic.tables_of(tables))


def test_a_single_spike_survives_every_reduction() -> None:
    tables = synthetic.campaign(logs=("x-up.asc",))
    tables["traces"].loc[317, "most_gyro_y"] = 0.5
    [log] = drawn(tables)
    _, low, high = envelope(log, "gyro_y", 40)
    assert len(low) == 40
    assert high.max() == 0.5


def test_the_curve_breaks_off_where_samples_are_missing() -> None:
    [log] = drawn(synthetic.campaign(logs=("z-backward.asc",)))
    assert log.missing == (GAP,)
    time, low, _ = envelope(log, "gyro_z", 60)
    [broken] = np.flatnonzero(np.isnan(low))
    assert time[broken - 1] <= GAP[0]
    assert time[broken + 1] >= GAP[1]


def test_a_missing_stretch_without_a_gap_is_seen_in_the_envelope() -> None:
    tables = synthetic.campaign(logs=("z-backward.asc",))
    tables["gaps"] = tables["gaps"].iloc[:0]
    # whole rows of the envelope are missing
    tables["traces"] = tables["traces"].drop(index=[20, 21, 22]).reset_index(drop=True)
    [log] = drawn(tables)
    assert len(log.missing) >= 1


def test_logs_without_time_are_drawn_over_records() -> None:
    tables = synthetic.campaign(logs=("x-up.asc",))
    for name in ("traces", "segments", "clocks"):
        for column in ("from_s", "to_s"):
            tables[name][column] = np.nan
    [log] = drawn(tables)
    assert not log.timed
    assert log.end[-1] == tables["traces"]["to_record"].iloc[-1]


def test_identifiers_of_figures_do_not_collide() -> None:
    tables = synthetic.campaign(logs=("x-up.asc", "z-backward.asc"))
    parts = raw_data.SECTION.parts(synthetic.tables_of(tables))
    figures = "".join(getattr(part, "drawn", "") for part in parts)
    identifiers = re.findall(r' id="([^"]+)"', figures)
    assert identifiers
    assert len(identifiers) == len(set(identifiers))


def test_thousands_of_gaps_are_counted_but_not_all_drawn() -> None:
    tables = synthetic.campaign(logs=("x-up.asc",))
    tables["traces"] = tables["traces"].iloc[::2].reset_index(drop=True)
    [log] = drawn(tables)
    assert len(log.missing) == MOST_MISSING
    assert log.lost > 140


def test_masked_samples_are_marked_where_they_are_and_said_to_be_unused() -> None:
    """A second of all channels, and one sample of the x accelerometer, of a log at 100 Hz."""
    tables = synthetic.campaign(logs=("x-up.asc",))
    found = {"id": "quality/impact", "cause": "impact", "count": 1, "unit": "m/s²", "severity": 2}
    found |= dict.fromkeys(("consequence", "action", "sentence"), "An impact.")
    tables["quality_findings"] = pd.concat(
        [tables["quality_findings"], rows_as(contracts.FINDINGS, [found])], ignore_index=True
    )
    mask = {"log": "x-up.asc", "repeated": False, "censored": False, "finding": "quality/impact"}
    masks = [
        mask | {"from_record": 1000, "to_record": 1100},
        mask | {"from_record": 5000, "to_record": 5001, "sensor": "accel", "axis": "x"},
    ]
    tables["masks"] = rows_as(contracts.MASKS, masks)
    [log] = drawn(tables)
    first, second = log.masked
    begin = log.start[0] + 0.01 * (1000 - tables["traces"]["from_record"].iloc[0])
    assert np.allclose(first.span, [begin, begin + 0.99], atol=0.02)
    assert (first.samples, first.channel, second.samples, second.channel) == (100, "", 1, "accel_x")
    [figure, *_] = raw_data.SECTION.parts(synthetic.tables_of(tables))
    assert "Cross-hatched: masked, not used (impact on the IMU: 100 samples; " in figure.caption
    assert "impact on the IMU, x accelerometer: 1 sample)." in figure.caption
