"""Columns of text: every value from the column that the layout names, or refused by name."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from inertial.formats.account import Account
from inertial.formats.columns.column_reader import read
from inertial.tables.errors import Refusal

NAMED = {
    "kind": "columns",
    "delimiter": ",",
    "header_lines": 1,
    "time": {"column": "t", "unit": "ms"},
    "accelerometer": {"columns": ["ax", "ay", "az"], "unit": "m/s2"},
    "gyro": {"columns": ["gx", None, "gz"], "unit": "deg/s"},
}
HEADER = b"t,ax,ay,az,gx,gy,gz\n"


@pytest.fixture
def log(tmp_path: Path):
    def write(content: bytes) -> Path:
        path = tmp_path / "log.csv"
        path.write_bytes(content)
        return path

    return write


def everything(path: Path, layout, size: int = 1 << 22):
    """Rows as (record, line, ticks, accelerometer, gyro), refused lines, account."""
    rows, refused, account = [], [], Account()
    for reading in read(path, layout, size):
        found = reading.records
        ticks = [None] * len(found.record) if found.ticks is None else found.ticks.tolist()
        triads = found.accelerometer.tolist(), found.gyro.tolist()
        rows += zip(found.record.tolist(), found.line.tolist(), ticks, *triads, strict=True)
        refused += reading.refused
        account.add_account(reading.account)
    return rows, refused, {kind: (lines, size) for kind, _, lines, size in account}


def test_values_come_from_the_named_columns(log):
    rows, refused, account = everything(
        log(HEADER + b"10, 1,2 ,-3e0,4,5,6\r\n\r\n20,1.5,2,3,4,whatever,.5"), NAMED
    )
    assert [row[:4] for row in rows] == [(0, 2, 10, [1, 2, -3]), (1, 4, 20, [1.5, 2, 3])]
    np.testing.assert_equal([row[4] for row in rows], [[4, np.nan, 6], [4, np.nan, 0.5]])
    assert not refused  # the y gyro is not wanted, so its text does not matter
    assert account == {"header": (1, 20), "decoded": (2, 21 + 24), "blank": (1, 2)}


@pytest.mark.parametrize("delimiter", [None, " ", "\t", ";", " | "])
def test_every_delimiter_gives_the_same_numbers(log, delimiter):
    between = "  \t " if delimiter is None else delimiter
    lines = [between.join(f"{row}.{column}" for column in range(1, 4)) for row in range(50)]
    layout = {"delimiter": delimiter, "gyro": {"columns": [3, 1, 2], "unit": "deg/s"}}
    rows, refused, _ = everything(log("\n".join(lines).encode()), layout, 200)
    assert not refused
    assert [row[4] for row in rows] == [[n + 0.3, n + 0.1, n + 0.2] for n in range(50)]


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        (b"20,1,2,3,4,5", "6 fields, expected 7"),
        (b"20,1,2,3,4,5,6,7", "8 fields, expected 7"),
        (b"20,1,nan,3,4,5,6", "column ay is 'nan', expected a finite number"),
        (b"20,1,2,-inf,4,5,6", "column az is '-inf', expected a finite number"),
        (b"20,1e999,2,3,4,5,6", "column ax is '1e999', expected a finite number"),
        (b"20,1,2,3,,5,6", "column gx is '', expected a finite number"),
        (b"twenty,1,2,3,4,5,6", "column t is 'twenty', expected a finite number"),
        (b"20,1,2,3,4,5,0x10", "column gz is '0x10', expected a finite number"),
        (b"20,1_0,2,3,4,5,6", "column ax is '1_0', expected a finite number"),
        (b"20,1,\x002,3,4,5,6", "column ay is '\\x002', expected a finite number"),
        (b"20,1,2,3,4,\xb0,6", "byte '\\xb0', expected text in UTF-8"),
        (b"20,1,2,3\r20,4,5,6", "a carriage return inside the line, expected LF or CRLF at its e"),
    ],
)
def test_a_bad_row_costs_itself_and_says_why(log, line, reason):
    rows, refused, account = everything(
        log(HEADER + b"10,1,2,3,4,5,6\n" + line + b"\n30,1,2,3,4,5,6\n"), NAMED
    )
    assert [(record, line, ticks) for record, line, ticks, *_ in rows] == [(0, 2, 10), (2, 4, 30)]
    assert [(lost.line, lost.bytes) for lost in refused] == [(3, len(line) + 1)]
    assert refused[0].reason.startswith(reason)
    assert account["refused"] == (1, len(line) + 1)


def test_a_first_row_that_is_torn_does_not_decide_the_length_of_the_others(log):
    rows, refused, _ = everything(
        log(b"5 6\n1 2 3 4\n1 2 3 4\n"), {"gyro": {"columns": [1, 2, 3], "unit": "rad/s"}}
    )
    assert [record for record, *_ in rows] == [1, 2]
    assert [line.reason for line in refused] == ["2 fields, expected 4"]


def test_an_unknown_column_is_refused_with_those_that_exist(log):
    layout = NAMED | {"gyro": {"columns": ["gx", "gy", "g_z"], "unit": "deg/s"}}
    with pytest.raises(Refusal) as refusal:
        everything(log(HEADER + b"10,1,2,3,4,5,6\n"), layout)
    assert str(refusal.value) == (
        "log.csv, gyro.columns\n"
        "  found:    no column 'g_z'\n"
        "  expected: one of t, ax, ay, az, gx, gy, gz\n"
        "  cure:     name the column as the last header line does, or by its number from 1; "
        "header_lines tells how many lines come before the data"
    )


def test_a_number_beyond_the_columns_is_refused_with_those_that_exist(log):
    layout = NAMED | {"gyro": {"columns": ["gx", 6, 8], "unit": "deg/s"}}
    with pytest.raises(Refusal, match=r"gyro.columns\n .*no column '8'\n .*one of t, ax"):
        everything(log(HEADER + b"10,1,2,3,4,5,6\n"), layout)


def test_a_name_that_stands_twice_is_refused(log):
    with pytest.raises(Refusal, match="the header has 2 columns 'ax'"):
        everything(log(b"t,ax,ax,az,gx,gy,gz\n10,1,2,3,4,5,6\n"), NAMED)


def test_counted_rows_keep_their_time_though_one_is_refused(log):
    layout = {"time": {"rate_hz": 100}, "gyro": {"columns": [1, 2, 3], "unit": "rad/s"}}
    rows, _, _ = everything(log(b"1 2 x\n1 2 3\n\n1 2 3\n"), layout)
    assert [(record, ticks) for record, _, ticks, *_ in rows] == [(1, 1), (2, 2)]


def test_rows_that_hold_no_triad_are_not_selected(log):
    triad = {"columns": [2, 3, 4], "unit": "g"}
    layout = {
        "accelerometer": triad | {"rows": {"1": "acc"}},
        "gyro": triad | {"rows": {"1": "gyro"}},
    }
    content = b"acc 1 2 3\nmag x y z\ngyro 4 5 6\n"
    rows, refused, account = everything(log(content), layout)
    assert not refused
    np.testing.assert_equal(
        rows,
        [
            (0, 1, None, [1, 2, 3], [np.nan] * 3),
            (2, 3, None, [np.nan] * 3, [4, 5, 6]),
        ],
    )
    assert account == {"decoded": (2, 21), "not selected": (1, 10)}


def test_labels_are_the_texts_that_the_plan_selects_by(log):
    layout = NAMED | {"label": ["gy", "t"]}
    reading = next(read(log(HEADER + b"10,1,2,3,4, a ,6\n20,1,2,3,4,\xc3\xa4,6\n"), layout))
    assert reading.records.label == ["gy=a; t=10", "gy=ä; t=20"]


@pytest.mark.parametrize("content", [HEADER, HEADER[:9], b"\n\n"])
def test_a_log_without_rows_has_no_records(log, content):
    rows, refused, account = everything(log(content), NAMED)
    assert not rows
    assert not refused
    assert sum(size for _, size in account.values()) == len(content)


LINES = st.sampled_from(
    [b"10,1,2,3,4,5,6", b"20,1,2,3", b",,,,,,", b"", b" ", b"\x00" * 9, b"\xff,1,2,3,4,5,6", b'"']
)


@given(
    st.lists(st.tuples(LINES | st.binary(max_size=30), st.sampled_from([b"\n", b"\r\n", b"\r"]))),
    st.sampled_from([30, 1 << 22]),
)
@settings(max_examples=200)
def test_every_byte_is_accounted_for_whatever_the_damage(tmp_path_factory, lines, size):
    content = HEADER + b"".join(text + end for text, end in lines)
    path = tmp_path_factory.mktemp("damage") / "log.csv"
    path.write_bytes(content)
    by_number = {
        "delimiter": ",",
        "header_lines": 1,
        "gyro": {"columns": [5, 6, 7], "unit": "rad/s"},
    }
    for layout in (NAMED, by_number):
        rows, refused, account = everything(path, layout, size)
        assert sum(size for _, size in account.values()) == len(content)
        assert account.get("refused", (0, 0))[0] == len(refused)
        assert account.get("decoded", (0, 0))[0] == len(rows)
        records = [record for record, *_ in rows]
        assert records == sorted(set(records))
        others = len(refused) + account.get("not selected", (0, 0))[0]
        assert all(record < len(rows) + others for record in records)
        numbers = [row[4][0] for row in rows]
        assert np.isfinite(numbers).all()
