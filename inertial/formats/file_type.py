"""The type of a log file, by its first bytes and never by its name; what is no log is refused."""

from enum import Enum
from pathlib import Path

from inertial.tables.errors import Refusal
from inertial.text.messages import _


class FileType(Enum):
    """The types that are distinguished; everything else is text."""

    TEXT = "text"
    PARQUET = "Parquet"
    ARROW_FILE = "Arrow file"
    ARROW_STREAM = "Arrow stream"
    HDF5 = "HDF5 or MATLAB 7.3"
    MATLAB_5 = "MATLAB 5"
    NUMPY = "NumPy"
    NUMPY_ARCHIVE = _("NumPy archive")
    ROS_1 = "ROS 1 bag"
    ROS_2 = _("ROS 2 bag of SQLite")
    MCAP = "MCAP"
    ULOG = "PX4 ULog"


_HDF5 = b"\x89HDF\r\n\x1a\n"
_HDF5_PLACES = (0, 512, 1024, 2048)  # MATLAB 7.3 puts 512 bytes of its own before it
_FILE_TYPES = {
    b"PAR1": FileType.PARQUET,
    b"ARROW1": FileType.ARROW_FILE,
    b"\xff\xff\xff\xff": FileType.ARROW_STREAM,  # no text in UTF-8 has such bytes
    b"\x93NUMPY": FileType.NUMPY,
    b"#ROSBAG V": FileType.ROS_1,
    b"SQLite format 3\x00": FileType.ROS_2,
    b"\x89MCAP0\r\n": FileType.MCAP,
    b"ULog\x01\x12\x35": FileType.ULOG,
}
_MATLAB_ENDS = (b"IM", b"MI")  # at byte 126: little or big end first
_ZIP, _ZIP_NAME = b"PK\x03\x04", 30  # the byte where the name of the first file in it begins


def file_type_of(path: Path) -> FileType:
    """The type of the file at `path`; an empty or unknown one counts as text."""
    first = _first_bytes(path)
    if any(first[place:].startswith(_HDF5) for place in _HDF5_PLACES):
        return FileType.HDF5
    if first.startswith(b"MATLAB") and first[126:128] in _MATLAB_ENDS:
        return FileType.MATLAB_5
    if _first_name_in_zip(first).endswith(b".npy"):
        return FileType.NUMPY_ARCHIVE
    for beginning, file_type in _FILE_TYPES.items():
        if first.startswith(beginning):
            return file_type
    return FileType.TEXT


# ---- Files that are no logs: what they are, and the cure.

_UNPACK = _("unpack it, put the log into the campaign's folder, and name it in campaign.yaml")
_COMPRESSED = {
    b"\x1f\x8b": "gzip",
    b"\x1f\x9d": "compress",
    b"BZh": "bzip2",
    b"\xfd7zXZ\x00": "xz",
    b"\x28\xb5\x2f\xfd": "zstd",
    b"\x04\x22\x4d\x18": "lz4",
    b"LZIP": "lzip",
    _ZIP: "zip",
    b"PK\x05\x06": "zip",  # an empty one
    b"7z\xbc\xaf\x27\x1c": "7z",
    b"Rar!\x1a\x07": "rar",
}
_TAR, _TAR_PLACE = b"ustar", 257
_BZIP2_BLOCKS = (b"1AY&SY", b"\x17rE8P\x90")  # π or √π at byte 4: a block, or the end

_POINTER = (
    _("a pointer of Git LFS, not the log"),
    _("fetch the log where this was cloned, by `git lfs pull`, and copy it from there"),
)
_PAGE = (
    _("a page of HTML or XML, not the log"),
    _("fetch the file itself: a web site shows a page about it, or a page of login, instead"),
)
_SHEET = (_("a spreadsheet"), _("save its sheet as CSV (UTF-8), and name that"))
_UTF_16 = (_("text in UTF-16"), _("write it as UTF-8: iconv -f UTF-16 -t UTF-8"))
_PICTURE = (_("a picture"), _("name the log that it shows"))
_PACKETS = (
    _("captured network packets"),
    _("write the stream in them to a file, by tcpflow or Wireshark's `Follow`, and name that"),
)
_FOREIGN = {
    b"version https://git-lfs": _POINTER,
    b"<!doctype html": _PAGE,
    b"<html": _PAGE,
    b"<?xml": _PAGE,
    b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1": _SHEET,  # before 2007
    b"%pdf-": (_("a PDF"), _("name the log that it describes")),
    b"\x89png\r\n": _PICTURE,
    b"\xff\xd8\xff": _PICTURE,
    b"gif8": _PICTURE,
    b"\xff\xfe": _UTF_16,
    b"\xfe\xff": _UTF_16,
    b"\xd4\xc3\xb2\xa1": _PACKETS,
    b"\xa1\xb2\xc3\xd4": _PACKETS,
    b"\x0a\x0d\x0d\x0a": _PACKETS,  # pcapng
    b"\xa3\x95\x80": (
        _("a DataFlash log of ArduPilot"),
        _("write its messages as CSV: mavlogdump.py --types IMU --format csv"),
    ),
}
_SHEET_NAMES = (b"[Content_Types].xml", b"_rels/", b"xl/", b"mimetype")  # first in .xlsx and .ods


def refuse_no_log(path: Path) -> None:
    """Refuse a file at `path` that is empty, compressed, or no log at all.

    Raises
    ------
    Refusal
        where it is; of a compressed log a few bytes can unpack to more than any disk holds
    """
    first = _first_bytes(path)
    if not first:
        problem = _("an empty file"), _("copy it anew from where it was recorded, or record again")
    elif _first_name_in_zip(first).startswith(_SHEET_NAMES):
        problem = _SHEET
    elif kind := _compression(first):
        problem = _("a file that is packed with {kinds}", kinds=kind), _UNPACK
    else:
        letters = first.removeprefix(b"\xef\xbb\xbf").lstrip(b" \t\r\n") or first
        problems = [
            problem
            for beginning, problem in _FOREIGN.items()
            if first.startswith(beginning) or letters.lower().startswith(beginning)
        ]
        if not problems:
            return
        problem = problems[0]
    raise Refusal(path.name, "", problem[0], _("the log itself"), problem[1])


def _compression(first: bytes) -> str:
    """The program that a file is packed with, if any."""
    if _first_name_in_zip(first).endswith(b".npy"):
        return ""
    kinds = [kind for beginning, kind in _COMPRESSED.items() if first.startswith(beginning)]
    if kinds == ["bzip2"] and first[4:10] not in _BZIP2_BLOCKS:
        return ""
    if not kinds and first[_TAR_PLACE:].startswith(_TAR):
        kinds = ["tar"]
    return kinds[0] if kinds else ""


def _first_name_in_zip(first: bytes) -> bytes:
    """The name of the first file in an archive of zip, empty where it is none."""
    length = int.from_bytes(first[26:28], "little")
    return first[_ZIP_NAME : _ZIP_NAME + length] if first.startswith(_ZIP) else b""


def _first_bytes(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(max(_HDF5_PLACES) + len(_HDF5))
