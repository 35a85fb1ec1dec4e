"""Whole lines, whatever the size of the chunks and the line ends."""

from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from inertial.formats.columns import text_lines as cutting
from inertial.formats.columns.text_lines import text_chunks

PARTS = st.lists(
    st.sampled_from([b"one", b"", b"\r", b"\x00", b"a\rb", b"\n", b"\r\n"]), max_size=40
)


@given(PARTS, st.integers(1, 30))
def test_lines_lie_where_the_file_says(tmp_path_factory, parts, size):
    path = tmp_path_factory.mktemp("chunks") / "log"
    path.write_bytes(b"".join(parts))
    whole = path.read_bytes()

    expected, offset = [], 0
    for line in whole.split(b"\n"):
        if line or offset < len(whole):
            length = len(line) + (offset + len(line) < len(whole))
            text = line.removesuffix(b"\r").removesuffix(b"\r")
            expected.append((offset, length, text))
            offset += length
    found = [
        (offset, length, chunk.text(index))
        for chunk in text_chunks(path, size)
        for index, (offset, length) in enumerate(zip(chunk.offsets, chunk.lengths, strict=True))
    ]
    assert found == expected
    lines = [line for chunk in text_chunks(path, size) for line in chunk.lines]
    assert lines == list(range(1, len(expected) + 1))


def test_a_line_without_end_does_not_fill_the_memory(tmp_path: Path, monkeypatch):
    monkeypatch.setattr(cutting, "MAX_LINE_BYTES", 100)
    path = tmp_path / "log"
    path.write_bytes(b"first\n" + bytes(1000) + b"\nlast\n")
    found = list(text_chunks(path, 64))
    assert max(len(chunk.data) for chunk in found) <= 164
    assert [int(n) for chunk in found for n in chunk.lengths] == [6, 1001, 5]
    assert [int(n) for chunk in found for n in chunk.offsets] == [0, 6, 1007]
    assert [int(n) for chunk in found for n in chunk.lines] == [1, 2, 3]
