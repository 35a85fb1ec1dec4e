"""Files are written beside their place and moved there whole; a full disk is said by name."""

import errno
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from inertial.tables.errors import Refusal
from inertial.text.messages import _

FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}


@contextmanager
def room_for(path: Path) -> Iterator[None]:
    """What is written at `path` inside finds room.

    Raises
    ------
    Refusal
        where the disk, a quota or a limit leaves none
    """
    try:
        yield
    except OSError as error:
        if error.errno not in FULL:
            raise
        raise Refusal(
            str(path),
            "",
            _("no room: {value}", value=error.strerror or error),
            _("room on the disk for what is written here"),
            _("make room and run again: nothing is half-written, and what was there is whole"),
        ) from None


def write_whole(contents: Mapping[Path, bytes]) -> None:
    """Write some files, all of them or none.

    Raises
    ------
    Refusal
        where there is no room
    """
    parts = {path: path.with_name(f"{path.name}.part") for path in contents}
    try:
        for path, part in parts.items():
            with room_for(path):
                path.parent.mkdir(parents=True, exist_ok=True)
                part.write_bytes(contents[path])
        for path, part in parts.items():
            part.replace(path)
    finally:
        for part in parts.values():
            part.unlink(missing_ok=True)
