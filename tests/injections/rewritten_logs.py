"""The bytes of a log of columns with something added to the readings of some of its lines."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from recordings.known import UNITS

NUMBER = re.compile(r"[+-]?\d+(?:\.(\d*))?(?:[eE]([+-]?\d+))?")
MAX_OWN_SHARE = 0.5  # of the readings of a column that no other equals: more are not in counts
COUNT_SHARE = 0.05  # of the differences between neighbouring readings, up to which one is a count

Array = np.ndarray[Any, np.dtype[np.float64]]


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
    file: Path,
    layout: Mapping[str, Any],
    numbers: Sequence[int],
    added: Mapping[str, Array],
    random: np.random.Generator,
) -> None:
    """Add to the readings of a log, in the counts of its columns, see `Counts`.

    numbers: of the lines, from 1; added: by sensor, (lines, 3), in the numbers of its columns.
    A number that stays the same keeps its bytes.
    """
    with_fields(
        file,
        layout,
        numbers,
        {
            (sensor, axis): lambda fields, error=errors[:, axis]: Counts.of(fields).moved(
                fields, error, random
            )
            for sensor, errors in added.items()
            for axis in range(3)
            if errors[:, axis].any()
        },
    )


def held(
    file: Path, layout: Mapping[str, Any], numbers: Sequence[int], channel: tuple[str, int]
) -> None:
    """Write a channel, sensor and axis, in all of these lines as it is in the first of them."""
    with_fields(file, layout, numbers, {channel: lambda fields: [fields[0]] * len(fields)})


def with_fields(
    file: Path, layout: Mapping[str, Any], numbers: Sequence[int], changes: Mapping[Any, Any]
) -> None:
    """Replace the fields of some channels in some lines; `changes`: their new ones by the old."""
    lines = lines_of(file)
    places = columns_of(layout, [line.rstrip("\r\n") for line in lines])
    parts = [_split(lines[number - 1], layout) for number in numbers]
    for (sensor, axis), change in changes.items():
        place = 2 * places[sensor][axis]
        for own, field in zip(parts, change([own[place] for own in parts]), strict=True):
            own[place] = field
    for number, own in zip(numbers, parts, strict=True):
        lines[number - 1] = "".join(own)
    write(file, lines)


@dataclass(frozen=True)
class Counts:
    """The numbers that a column may hold: those that it does hold, and what lies between.

    levels: (k,), in order; texts: how each that occurs is written. An instrument reads in counts,
    which in a log of physical units are rounded besides: what is written between them no instrument
    of this kind would have read. Empty where the numbers are no counts.
    """

    levels: Array
    texts: Mapping[float, str]

    @classmethod
    def of(cls, fields: Sequence[str]) -> "Counts":
        """Those of a column by its fields."""
        numbers = [NUMBER.search(field)[0] for field in fields]
        texts = {float(number): number for number in numbers}
        levels = np.array(sorted(texts))
        if len(levels) < 2 or len(levels) > MAX_OWN_SHARE * len(fields):
            return cls(np.empty(0), {})
        count = float(np.quantile(np.diff(levels), COUNT_SHARE))
        between = [
            np.linspace(low, high, round((high - low) / count), endpoint=False)
            for low, high in pairwise(levels)
            if high - low > count / 2
        ]
        return cls(np.append(np.concatenate(between), levels[-1]), texts)

    def moved(self, fields: Sequence[str], errors: Array, random: np.random.Generator) -> list[str]:
        """Some fields with errors added, (n,): to the count above or below at random.

        So that their mean is what was added, though it be less than a count. What is at an end of
        the range stays there. Without counts a number is written with its own decimals.
        """
        found = [NUMBER.search(field) for field in fields]
        before = np.array([float(number[0]) for number in found])
        values, stays = before + errors, errors == 0
        if len(self.levels):
            stays |= np.isin(before, self.levels[[0, -1]])
            above = np.clip(np.searchsorted(self.levels, values), 1, len(self.levels) - 1)
            low, high = self.levels[above - 1], self.levels[above]
            values = np.where(random.random(len(values)) * (high - low) < values - low, high, low)
        return [
            field if same else self._written(field, number, float(value))
            for field, number, value, same in zip(fields, found, values, stays, strict=True)
        ]

    def _written(self, field: str, number: re.Match[str], value: float) -> str:
        decimals = max(len(number[1] or "") - int(number[2] or 0), 0)
        text = self.texts.get(value) or f"{value:.{decimals}f}"
        return field[: number.start()] + text + field[number.end() :]


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
