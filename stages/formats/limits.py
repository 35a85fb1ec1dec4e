"""How much a container may claim to hold, so that a few bytes cannot fill the memory."""

from pathlib import Path

from inertial.tables.errors import Refusal

LARGEST_PIECE = 1 << 30  # byte, of what is unpacked at once
# Deflate makes no more than 1032 bytes of one; no log has rows of less than a byte each before it.
LARGEST_GROWTH = 1032


def refuse_piece(path: Path, what: str, size: int) -> None:
    """Refuse the file where `what`, unpacked, is said to have more than `LARGEST_PIECE` bytes."""
    if not 0 <= size <= LARGEST_PIECE:
        raise Refusal(
            path.name,
            what,
            f"{size} bytes, as the file says",
            f"at most {LARGEST_PIECE} bytes in one piece",
            "write the log anew in smaller pieces; if it never was that large, the file is damaged",
        )


def refuse_growth(path: Path, what: str, size: int, stored: int) -> None:
    """Refuse the file where `what` is said to have more bytes than `stored` ones can unpack to."""
    if size > LARGEST_GROWTH * max(stored, 1):
        raise Refusal(
            path.name,
            what,
            f"{size} bytes, as the file says, stored in {stored}",
            f"at most {LARGEST_GROWTH} times as many as are stored",
            "copy the log anew from where it was recorded; this file is damaged or no log",
        )
