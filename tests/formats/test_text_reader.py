"""Rows that are parsed chunk by chunk are those that are examined line by line."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from inertial.formats.columns import text_reader
from inertial.formats.columns.text_lines import MAX_LINE_BYTES

LAYOUT = {
    "time": {"column": 1, "unit": "s"},
    "accelerometer": {"columns": [2, None, 3], "unit": "m/s2"},
    "label": [4],
}
FIELD = st.sampled_from(["1", "-2.5e3", " 3", "4 ", "x", "", "é", "\x1f", "5\r6", "\0", "\v", "·"])
LINE = st.lists(FIELD, min_size=3, max_size=5)


def read(path, layout, size):
    """Everything that is said of a log, in types that can be compared."""
    found = []
    for one in text_reader.read(path, layout, size):
        rows = one.records
        numbers = (rows.record, rows.offset, rows.line, rows.ticks, rows.accelerometer)
        said = [None if part is None else part.tobytes() for part in numbers]
        found.append([*said, rows.label, one.refused, list(one.account)])
    return found


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return tmp_path_factory.mktemp("log") / "log.txt"


@settings(max_examples=100)
@given(
    lines=st.lists(st.tuples(LINE, st.sampled_from(["\n", "\r\n", "\n \t\r\n"])), max_size=20),
    delimiter=st.sampled_from([None, ",", " ", "\t", "·", "x"]),
    header=st.integers(0, 2),
    cut=st.integers(0, 3),
    size=st.sampled_from([7, 40, 1000]),
)
def test_chunk_by_chunk_and_line_by_line(path, lines, delimiter, header, cut, size):
    between = " \t" if delimiter is None else delimiter
    text = "".join(between.join(fields) + end for fields, end in lines).encode()
    path.write_bytes(text[: len(text) - cut])
    layout = {**LAYOUT, "header_lines": header, "delimiter": delimiter}
    parsed = read(path, layout, size)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(text_reader, "_is_regular", lambda *_: False)
        examined = read(path, layout, size)
    assert parsed == examined


def test_rows_stand_beside_a_line_without_end(path):
    row = b"1,2,3,a\n"
    path.write_bytes(3 * row + b"9" * (MAX_LINE_BYTES + 5) + b"\n" + 2 * row)
    (*_, label, refused, _) = zip(*read(path, {**LAYOUT, "delimiter": ","}, 1000), strict=True)
    assert sum(len(one) for one in label) == 5
    assert [line.line for one in refused for line in one] == [4]
