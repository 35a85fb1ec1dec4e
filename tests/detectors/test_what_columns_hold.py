"""Columns of a log that do not hold what they should: a copy of another, or no gravity."""

from dataclasses import replace
from itertools import product
from pathlib import Path

import chain
import numpy as np
import pandas as pd
import pytest
from hidden import hidden_plans
from recorded_by_hand import piece, rest, seen, stamps

import laboratory
from inertial.detectors.processed_readings import CopiedChannel
from inertial.detectors.saturation import Saturation
from inertial.detectors.wrong_scale_factor import GravityRemoved

RECORDS = 3000


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("one", "other"), [(0, 1), (3, 5)])
def test_an_axis_that_is_a_copy_of_another_is_found_and_neither_is_used(one, other, sign):
    values = rest(RECORDS)
    values[:, other] = sign * values[:, one]
    events = seen(CopiedChannel(), piece(values, stamps(RECORDS)))
    assert [event.channel for event in events] == [one, other]
    masked = piece(values).without(events).values
    assert np.isnan(masked[:, [one, other]]).all() and np.isfinite(masked).sum() == 4 * RECORDS


def test_axes_that_stand_still_or_differ_once_are_no_copies():
    values = rest(RECORDS)
    values[:, 1:3] = 0.0
    values[:, 4] = values[:, 3]
    values[1234, 4] += 1e-6
    assert not seen(CopiedChannel(), piece(values))


def without_gravity(values: np.ndarray) -> np.ndarray:
    """The linear acceleration of an attitude filter: the mean force over 1 s is subtracted."""
    smooth = np.stack(
        [np.convolve(np.pad(c, 50, "edge"), np.ones(101) / 101, "valid") for c in values[:, :3].T],
        1,
    )
    less = (
        smooth
        / np.linalg.norm(smooth, axis=1)[:, None]
        * np.linalg.norm(values[:, :3].mean(axis=0))
    )
    return np.column_stack([values[:, :3] - less, values[:, 3:]])


def test_accelerometers_that_read_nothing_at_rest_are_told_from_another_unit():
    values = rest(RECORDS)
    (event,) = seen(GravityRemoved(), piece(without_gravity(values), stamps(RECORDS)))
    assert event.sensor == "accel" and event.size < 0.02
    masked = piece(values).without([event]).values
    assert np.isnan(masked[:, :3]).all() and np.isfinite(masked[:, 3:]).all()
    for unit in (1.0, 1 / 9.80665, 1e-3):
        one = piece(values * unit, stamps(RECORDS))
        noise = np.diff(one.values, axis=0).std(axis=0) / np.sqrt(2)
        assert not seen(GravityRemoved(), one, noise=noise)


def test_a_channel_without_readings_is_not_saturated():
    values = rest(RECORDS)
    values[:, 2] = np.nan
    assert not seen(Saturation(), piece(values))


def changed(recording: laboratory.Recording, columns):
    """The recording with other counts."""
    return replace(
        recording,
        records={
            log: replace(one, counts=np.rint(columns(one.counts)).astype(one.counts.dtype))
            for log, one in recording.records.items()
        },
    )


def copied(counts: np.ndarray) -> np.ndarray:
    """The y gyro's column is that of the x gyro."""
    return counts[:, [0, 1, 2, 3, 3, 5]]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("columns", "cause", "sensor"),
    [(without_gravity, "gravity_removed", "accel"), (copied, "copied_channel", "gyro")],
)
def test_it_is_the_only_cause_and_the_other_sensor_stays_usable(columns, cause, sensor):
    """All three accelerometers were reversed; four turns were missing."""
    recording = laboratory.perform(laboratory.specify(chain.short(seed=5)))
    tables = chain.in_memory(changed(recording, columns), "diagnosis", chain.BESIDE)
    causes = tables["diagnosis/causes"]
    assert set(causes["cause"]) == {cause} and set(causes["sensor"]) == {sensor}
    verdicts = tables["diagnosis/verdict"].set_index("sensor")["verdict"]
    assert verdicts.pop(sensor) == "not_usable" and set(verdicts) == {"usable"}


def normalised(counts: np.ndarray) -> np.ndarray:
    """The accelerometers' columns are a direction times a constant, as a phone's gravity."""
    length = np.linalg.norm(counts[:, :3], axis=1, keepdims=True)
    return np.hstack([counts[:, :3] / length * 9.80665e6, counts[:, 3:]])


@pytest.mark.slow
def test_a_direction_in_place_of_the_specific_force_leaves_no_scale_factor():
    """An asymmetry was named, and scale factors that were off by 24 sigma were usable."""
    document = chain.short(seed=5)
    document["receiver"] |= {"message": "columns", "line_end": "lf", "carries": False}
    document["receiver"] |= {"gyro_count_rad": 1e-9, "accelerometer_count_m_s": 1e-8}
    document["campaign"]["instrument"] = {"name": "made up"}
    recording = laboratory.perform(laboratory.specify(document))
    tables = chain.in_memory(changed(recording, normalised), "diagnosis", chain.BESIDE)
    causes = tables["diagnosis/causes"]
    assert list(causes["cause"]) == ["normalised_force"] and set(causes["sensor"]) == {"accel"}
    assert causes["size"][0] == pytest.approx(9.80665, abs=1e-5)
    verdicts = tables["diagnosis/verdict"].set_index("sensor")["verdict"]
    assert verdicts["accel"] == "not_usable" and verdicts["gyro"] == "usable"


@pytest.mark.slow
def test_a_counter_of_16_bits_that_begins_again_is_told_and_spoils_nothing():
    """A log of 65.536 s several times over ended criticism with an exception."""
    recording = laboratory.perform(laboratory.specify(chain.short(seed=5)))
    again = {
        log: replace(one, stamps=recording.start + (one.stamps - recording.start) % 65_536_000_000)
        for log, one in recording.records.items()
    }
    true, tables = (
        chain.in_memory(one, "diagnosis", chain.BESIDE)
        for one in (recording, replace(recording, records=again))
    )
    causes = tables["diagnosis/causes"]
    assert set(causes["cause"]) == {"time_backwards"}
    assert causes["sentence"].str.contains("begins again after 65.536 s").all()
    value, expected = (one["diagnosis/result"]["value"] for one in (tables, true))
    np.testing.assert_allclose(value, expected, rtol=1e-6)


def zeroed(folder: Path, records: int | None) -> chain.Results:
    """A campaign whose gyros were zeroed by the first records of each log, or all, and run."""
    document = hidden_plans.positions(seed=5)
    document["start"]["pause_s"] = 86_400.0  # so that each log has a clock of its own
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "made up", "rate_hz": 100}
    laboratory.write(laboratory.perform(laboratory.specify(document)), folder / "raw")
    for path in (folder / "raw").glob("*.asc"):
        log, gyros = pd.read_csv(path), [f"gyro_{axis}" for axis in "xyz"]
        log[gyros] -= log[gyros].iloc[:records].mean()
        log.to_csv(path, index=False, float_format="%.9f")
    return chain.run(folder / "raw", folder / "derived", "diagnosis")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rate", "said"),
    [
        ({"rate_hz": 100}, "as if the time were in ms where s is stated"),
        ({}, "as if the time of the logs were in ms where s is stated"),  # the turns show it
    ],
)
def test_milliseconds_that_are_stated_as_seconds_are_one_cause(rate, said, tmp_path):
    """Twelve turns of 359922 degrees, each a cause of its own, and the unit said last."""
    document = chain.short(seed=5)
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "made up", **rate}
    laboratory.write(laboratory.perform(laboratory.specify(document)), tmp_path / "raw")
    for path in (tmp_path / "raw").glob("*.asc"):
        log = pd.read_csv(path)
        log[log.columns[0]] = 1000 * log[log.columns[0]]
        log.to_csv(path, index=False, float_format="%.9f")
    tables = chain.run(tmp_path / "raw", tmp_path / "derived", "diagnosis", chain.BESIDE)
    (cause,) = tables["diagnosis/causes"].to_dict("records")
    assert cause["cause"] == "wrong_time_unit"
    assert said in cause["sentence"]


@pytest.mark.slow
def test_gyros_zeroed_at_the_beginning_of_each_log_keep_their_scale_factors(tmp_path):
    """By 4.7 s, which are no whole windows. Else it was a structure that nobody explained."""
    tables = zeroed(tmp_path, 470)
    causes = tables["diagnosis/causes"].set_index("cause")
    assert set(causes.index) == {"bias_removed"}
    assert "over about the first 5.0 s of 12 logs" in causes.loc["bias_removed", "sentence"]
    verdicts = tables["diagnosis/verdict"].set_index("sensor")["verdict"]
    assert verdicts["gyro"] == "usable_within_limits" and verdicts["accel"] == "usable"
    result = tables["diagnosis/result"].set_index(["sensor", "parameter"]).loc["gyro"]
    truth = hidden_plans.positions(seed=5)["truth"]["gyro"]["matrix"]
    for i, j in product(range(3), range(3)):
        name = f"scale_{'xyz'[i]}" if i == j else f"cross_{'xyz'[i]}{'xyz'[j]}"
        row = result.loc[name]
        assert abs(row["value"] - (truth[i][j] - (i == j))) < 4 * row["sigma"], name


@pytest.mark.slow
def test_gyros_less_the_mean_of_each_log_are_told_as_such(tmp_path):
    """All turns were "missing"."""
    tables = zeroed(tmp_path, None)
    causes = tables["diagnosis/causes"].set_index("cause")
    assert set(causes.index) == {"bias_removed"} and set(causes["sensor"]) == {"gyro"}
    assert "over the whole of 12 logs" in causes.loc["bias_removed", "sentence"]
    verdicts = tables["diagnosis/verdict"].set_index("sensor")["verdict"]
    assert verdicts["gyro"] == "not_usable" and verdicts["accel"] == "usable"
