"""What a file is, by its content: compressed logs are refused, and text stays text."""

import bz2
import gzip
import io
import lzma
import tarfile
import zipfile

import lz4.frame
import pyarrow as pa
import pytest

from inertial.formats.columns import column_reader as columns
from inertial.formats.file_type import FileType, file_type_of, refuse_no_log
from inertial.tables.errors import Refusal
from tests.formats import written

LINE = b"1,2,3\n"


def zipped(data: bytes) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("log.csv", data)
    return file.getvalue()


def tarred(data: bytes) -> bytes:
    file = io.BytesIO()
    with tarfile.open(fileobj=file, mode="w") as archive:
        entry = tarfile.TarInfo("log.csv")
        entry.size = len(data)
        archive.addfile(entry, io.BytesIO(data))
    return file.getvalue()


PACKED = {
    "gzip": gzip.compress(LINE),
    "bzip2": bz2.compress(LINE),
    "xz": lzma.compress(LINE),
    "zstd": pa.Codec("zstd").compress(LINE, asbytes=True),
    "lz4": lz4.frame.compress(LINE),
    "zip": zipped(LINE),
    "tar": tarred(LINE),
    "7z": b"7z\xbc\xaf\x27\x1c\x00\x04",
    "compress": b"\x1f\x9d\x90\x31",
}


@pytest.mark.parametrize("kind", PACKED)
def test_a_compressed_log_is_refused_by_name(tmp_path, kind):
    log = tmp_path / "log.csv"
    log.write_bytes(PACKED[kind])
    with pytest.raises(Refusal) as refusal:
        refuse_no_log(log)
    assert str(refusal.value) == (
        "log.csv\n"
        f"  found:    a file that is packed with {kind}\n"
        "  expected: the log itself\n"
        "  cure:     unpack it, put the log into the campaign's folder, "
        "and name it in campaign.yaml"
    )
    with pytest.raises(Refusal, match="packed with"):
        list(columns.read(log, {"kind": "columns"}))


@pytest.mark.parametrize("text", [b"\n", b"BZh9 is a name\n", b"PAR2\n", b"MATLAB\n", LINE])
def test_text_is_text(tmp_path, text):
    log = tmp_path / "log.parquet"
    log.write_bytes(text)
    refuse_no_log(log)
    assert file_type_of(log) is FileType.TEXT


@pytest.mark.parametrize(
    ("name", "content"),
    {
        "text": FileType.TEXT,
        "parquet": FileType.PARQUET,
        "arrow file": FileType.ARROW_FILE,
        "arrow stream": FileType.ARROW_STREAM,
        "matlab 5": FileType.MATLAB_5,
        "matlab 7.3": FileType.HDF5,
        "ros 1": FileType.ROS_1,
        "ros 2": FileType.ROS_2,
        "mcap": FileType.MCAP,
        "numpy": FileType.NUMPY,
        "numpy archive": FileType.NUMPY_ARCHIVE,
        "ulog": FileType.ULOG,
    }.items(),
)
def test_a_container_is_told_whatever_its_name(tmp_path, name, content):
    log = tmp_path / "log.txt"
    written.WRITERS[name](log, written.rows(3))
    assert file_type_of(log) is content
