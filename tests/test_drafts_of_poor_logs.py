"""`make draft`: logs of a single row, in which nothing changes, or of which rows are cut off."""

import re
import warnings

import numpy as np
import pytest
from drafting import comments, drafted, told, written
from logs_by_hand import by_hand_log
from moved_by_hand import RATE

from inertial.tables.errors import Refusal

NAMES = "t,ax,ay,az,gx,gy,gz\n"


def test_a_single_row_is_said_to_be_one(tmp_path):
    """It was "no three columns", after warnings of an empty mean."""
    with warnings.catch_warnings(), pytest.raises(Refusal, match="1 row of numbers"):
        warnings.simplefilter("error")
        drafted({"log.csv": NAMES + "0.00,0.988,-0.013,-0.015,0.075,-0.232,0.048\n"}, tmp_path)


def test_a_table_of_a_few_rows_is_no_log(tmp_path):
    """Of five rows without names there are no short means, which ended in an exception."""
    rows = np.random.default_rng(0).integers(0, 10_000, (5, 3)).astype(float)
    with pytest.raises(Refusal, match="5 rows of numbers"):
        drafted({"log.csv": written([rows])}, tmp_path)


@pytest.mark.parametrize("clock", ["goes on", "stands"])
def test_a_log_in_which_nothing_changes_is_said_to_be_one(clock, tmp_path):
    time = np.arange(500) / RATE * (clock == "goes on")
    still = np.tile([0.0, 0.0, 1.0, 0.0, 0.0, 0.0], (500, 1))
    with pytest.raises(Refusal, match="nothing changes"):
        drafted({"log.csv": NAMES + written([time, still])}, tmp_path)


def test_rows_that_are_cut_off_are_counted(tmp_path):
    """Every seventh: the rate is that of the others, 6/7 of 100 Hz."""
    log = by_hand_log(50)
    time = np.arange(len(log.force)) / RATE
    lines = written([time, log.force, log.rate]).splitlines()
    lines[3::7] = [line[:22] for line in lines[3::7]]
    folder = drafted({"log.csv": NAMES + "\n".join(lines) + "\n"}, tmp_path)
    assert told(folder)["instrument"]["format"]["gyro"]["unit"] == "rad/s"
    said = comments(folder)
    cut = f"{len(lines[3::7]):,}".replace(",", " ")
    assert f"log.csv: {cut} of its rows lack a reading" in said
    rate = re.search(r"at ([0-9.]+) Hz", said)
    assert rate is not None and float(rate[1]) == pytest.approx(100 * 6 / 7, abs=0.1)


def test_rows_that_are_whole_are_not_counted(tmp_path):
    log = by_hand_log(51)
    time = np.arange(len(log.force)) / RATE
    folder = drafted({"log.csv": NAMES + written([time, log.force, log.rate])}, tmp_path)
    assert "lack a reading" not in comments(folder)
