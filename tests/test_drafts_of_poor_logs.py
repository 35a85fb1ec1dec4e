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


# ---- columns that are not read


@pytest.mark.parametrize("gyros", ["in every second row", "with a checksum behind"])
def test_columns_without_a_number_in_many_rows_are_named(gyros, tmp_path):
    """It said that no gyros are recorded, and of the columns nothing."""
    log = by_hand_log(52)
    rows = written([np.arange(len(log.force)) / RATE, log.force]).splitlines()
    rates = written([log.rate]).splitlines()
    if gyros == "in every second row":
        rates[1::2] = [",,"] * len(rates[1::2])
    else:
        rates = [f"{row}*{k % 256:02X}" for k, row in enumerate(rates)]
    lines = [f"{row},{rate}\n" for row, rate in zip(rows, rates, strict=True)]
    text = comments(drafted({"log.csv": NAMES + "".join(lines)}, tmp_path))
    if gyros == "in every second row":
        assert "one row of ten or more, and not read: gx, gy, gz;" in text
    else:
        assert "text, and not read: gz" in text
    assert "gyros: none are among the columns that are read" in text


def test_a_log_without_rows_of_numbers_is_shown_by_a_line(tmp_path):
    text = "".join(f"{k}.0D+00 1.0D+00 2.0D+00 9.8D+00\n" for k in range(9))
    with pytest.raises(Refusal, match=r"line \d+ of it is '8\.0D\+00 1"):
        drafted({"log.txt": text}, tmp_path)


def test_decimal_commas_in_quotation_marks_between_commas_are_refused(tmp_path):
    """Each number was taken for two columns of counts."""
    rows = written([by_hand_log(53).force]).replace(".", ";").splitlines()
    quoted = [",".join(f'"{field}"' for field in row.split(",")) for row in rows]
    text = "ax,ay,az\n" + "\n".join(quoted).replace(";", ",") + "\n"
    with pytest.raises(Refusal, match="decimal commas in quotation marks") as refusal:
        drafted({"log.csv": text}, tmp_path)
    assert "write it with semicolons" in refusal.value.cure
