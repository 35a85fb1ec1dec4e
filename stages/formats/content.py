"""What a log file is, told by its first bytes and never by its name."""

from enum import Enum
from pathlib import Path

from inertial.tables.errors import Refusal


class Content(Enum):
    """The contents that are told apart; whatever else there is, is text."""

    TEXT = "text"
    PARQUET = "Parquet"
    ARROW_FILE = "Arrow file"
    ARROW_STREAM = "Arrow stream"
    HDF5 = "HDF5 or MATLAB 7.3"
    MATLAB_5 = "MATLAB 5"
    ROS_1 = "ROS 1 bag"
    ROS_2 = "ROS 2 bag of SQLite"
    MCAP = "MCAP"


_HDF5 = b"\x89HDF\r\n\x1a\n"
_HDF5_PLACES = (0, 512, 1024, 2048)  # MATLAB 7.3 puts 512 bytes of its own before it
_CONTENTS = {
    b"PAR1": Content.PARQUET,
    b"ARROW1": Content.ARROW_FILE,
    b"\xff\xff\xff\xff": Content.ARROW_STREAM,  # no text in UTF-8 has such bytes
    b"#ROSBAG V": Content.ROS_1,
    b"SQLite format 3\x00": Content.ROS_2,
    b"\x89MCAP0\r\n": Content.MCAP,
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


def content_of(path: Path) -> Content:
    """What the file at `path` is; a file that is empty, or nothing known, counts as text."""
    first = _first_bytes(path)
    if any(first[place:].startswith(_HDF5) for place in _HDF5_PLACES):
        return Content.HDF5
    if first.startswith(b"MATLAB") and first[126:128] in _MATLAB_ENDS:
        return Content.MATLAB_5
    for beginning, content in _CONTENTS.items():
        if first.startswith(beginning):
            return content
    return Content.TEXT


def refuse_compressed(path: Path) -> None:
    """Say so where the log at `path` is compressed or archived.

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
            f"a file that is packed with {kinds[0]}",
            "the log itself",
            "unpack it, put the log into the campaign's folder, and name it in campaign.yaml",
        )


def _first_bytes(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(max(_HDF5_PLACES) + len(_HDF5))
