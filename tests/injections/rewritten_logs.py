"""The bytes of a log of columns with something added to the readings of some of its lines."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from recordings.known import UNITS

NUMBER = re.compile(r"[+-]?\d+(?:\.(\d*))?")


def unit_of(layout: Mapping[str, Any], sensor: str) -> float:
    """What one of the numbers in the columns of a sensor is in SI."""
    return float(UNITS[layout[sensor]["unit"]] / layout[sensor].get("counts_per_unit", 1))


def columns_of(layout: Mapping[str, Any], lines: Sequence[str]) -> dict[str, list[int]]:
    """The places of the three columns of each sensor in a line, by a layout of a campaign file."""
    heads, comment = layout.get("header_lines", 0), layout.get("comment")
    head = lines[heads - 1] if heads else lines[0].removeprefix(comment or "").lstrip()
    names = _split(head, layout)[::2]
    return {
        sensor: [
            column - 1 if isinstance(column, int) else names.index(column)
            for column in layout[sensor]["columns"]
        ]
        for sensor in ("accelerometer", "gyro")
    }


def rewritten(
    file: Path, layout: Mapping[str, Any], numbers: Sequence[int], added: Mapping[str, np.ndarray]
) -> None:
    """Add to the readings of a log, written with as many decimals as before.

    numbers: of the lines, from 1; added: by sensor, (lines, 3), in the numbers of its columns.
    A number that stays the same to its last decimal keeps its bytes.
    """
    lines = lines_of(file)
    places = columns_of(layout, [line.rstrip("\r\n") for line in lines])
    for row, number in enumerate(numbers):
        parts = _split(lines[number - 1], layout)
        for sensor, columns in places.items():
            for column, error in zip(columns, added[sensor][row], strict=True):
                parts[2 * column] = _moved(parts[2 * column], float(error))
        lines[number - 1] = "".join(parts)
    write(file, lines)


def lines_of(file: Path) -> list[str]:
    """The lines of a log with their ends, every byte kept."""
    return file.read_bytes().decode("utf-8").splitlines(keepends=True)


def write(file: Path, lines: Sequence[str]) -> None:
    """Write a log as a new file: the old one may be a link to the recording itself."""
    part = file.with_suffix(".part")
    part.write_bytes("".join(lines).encode("utf-8"))
    part.replace(file)


def _split(line: str, layout: Mapping[str, Any]) -> list[str]:
    """Fields at the even places, what separates them between."""
    delimiter = layout.get("delimiter")
    return re.split(f"({re.escape(delimiter)})" if delimiter else r"(\s+)", line)


def _moved(text: str, error: float) -> str:
    found = NUMBER.search(text)
    if found is None or not error:
        return text
    value = float(found[0]) + error
    written = f"{value:.{len(found[1] or '')}f}"
    return text[: found.start()] + written + text[found.end() :]
