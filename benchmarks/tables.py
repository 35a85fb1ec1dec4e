"""Tables as plain text: columns aligned, numbers to the right, remarks below."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest
from math import isnan


@dataclass
class Table:
    """A table of a benchmark: title, heads (a second line for the unit), rows, remarks."""

    title: str
    heads: Sequence[str]
    rows: list[Sequence[str]] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)

    def add(self, *cells: str) -> None:
        """Add a row."""
        if len(cells) != len(self.heads):
            raise ValueError(f"{len(cells)} cells in a table of {len(self.heads)} columns")
        self.rows.append(cells)

    def text(self) -> str:
        """The whole table; the first column to the left, the others to the right."""
        lines = [self.title, "", *_aligned([self.heads, *self.rows])]
        for remark in self.remarks:
            lines += ["", remark]
        return "\n".join(lines) + "\n"


def digits(number: float) -> str:
    """Three significant digits; a dash for no value."""
    if isnan(number):
        return "–"
    if abs(number) < 0.005:
        return "0.00"
    return f"{number:,.0f}" if abs(number) >= 100 else f"{number:.3g}"


def _aligned(rows: Sequence[Sequence[str]]) -> Iterable[str]:
    heads = list(zip_longest(*(head.split("\n") for head in rows[0]), fillvalue=""))
    rows = [*heads, *rows[1:]]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for number, row in enumerate(rows, 1 - len(heads)):
        cells = [row[0].ljust(widths[0])]
        cells += [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
        yield "  ".join(cells).rstrip()
        if number == 0:
            yield "  ".join("-" * width for width in widths)
