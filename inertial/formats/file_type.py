"""The type of a log file, by its first bytes and never by its name."""

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
    ROS_1 = "ROS 1 bag"
    ROS_2 = _("ROS 2 bag of SQLite")
    MCAP = "MCAP"


_HDF5 = b"\x89HDF\r\n\x1a\n"
_HDF5_PLACES = (0, 512, 1024, 2048)  # MATLAB 7.3 puts 512 bytes of its own before it
_FILE_TYPES = {
    b"PAR1": FileType.PARQUET,
    b"ARROW1": FileType.ARROW_FILE,
    b"\xff\xff\xff\xff": FileType.ARROW_STREAM,  # no text in UTF-8 has such bytes
    b"#ROSBAG V": FileType.ROS_1,
    b"SQLite format 3\x00": FileType.ROS_2,
    b"\x89MCAP0\r\n": FileType.MCAP,
}
_MATLAB_ENDS = (b"IM", b"MI")  # at byte 126: little or big end first
_COMPRESSED = {
    b"\x1f\x8b": "gzip",
    b"\x1f\x9d": "compress",
    b"BZh": "bzip2",
    b"\xfd7zXZ\x00": "xz",
    b"\x28\xb5\x2f\xfd": "zstd",
    b"\x04\x22\x4d\x18": "lz4",
    b"LZIP": "lzip",
    b"PK\x03\x04": "zip",
    b"PK\x05\x06": "zip",  # an empty one
    b"7z\xbc\xaf\x27\x1c": "7z",
    b"Rar!\x1a\x07": "rar",
}
_TAR, _TAR_PLACE = b"ustar", 257
_BZIP2_BLOCKS = (b"1AY&SY", b"\x17rE8P\x90")  # π or √π at byte 4: a block, or the end


def file_type_of(path: Path) -> FileType:
    """The type of the file at `path`; an empty or unknown one counts as text."""
    first = _first_bytes(path)
    if any(first[place:].startswith(_HDF5) for place in _HDF5_PLACES):
        return FileType.HDF5
    if first.startswith(b"MATLAB") and first[126:128] in _MATLAB_ENDS:
        return FileType.MATLAB_5
    for beginning, file_type in _FILE_TYPES.items():
        if first.startswith(beginning):
            return file_type
    return FileType.TEXT


def refuse_compressed(path: Path) -> None:
    """Refuse a log at `path` that is compressed or archived.

    Raises
    ------
    Refusal
        where it is: a few bytes can unpack to more than any disk holds
    """
    first = _first_bytes(path)
    kinds = [kind for beginning, kind in _COMPRESSED.items() if first.startswith(beginning)]
    if kinds == ["bzip2"] and first[4:10] not in _BZIP2_BLOCKS:
        return
    if not kinds and first[_TAR_PLACE:].startswith(_TAR):
        kinds = ["tar"]
    if kinds:
        raise Refusal(
            path.name,
            "",
            _("a file that is packed with {kinds}", kinds=kinds[0]),
            "the log itself",
            _("unpack it, put the log into the campaign's folder, and name it in campaign.yaml"),
        )


def _first_bytes(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(max(_HDF5_PLACES) + len(_HDF5))
