"""The rows of a table as plain values, its gaps as None."""

from __future__ import annotations

from typing import Any

import pandas as pd

Record = dict[str, Any]


def records(frame: pd.DataFrame) -> list[Record]:
    """One dict per row; whatever stands for a gap in a column becomes None."""
    columns = {
        str(name): [
            None if gap else value
            for value, gap in zip(column.tolist(), column.isna(), strict=True)
        ]
        for name, column in frame.items()
    }
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def only(frame: pd.DataFrame) -> Record:
    """The single row of a table that has one; an empty table gives an empty row."""
    rows = records(frame)
    return rows[0] if rows else dict.fromkeys(map(str, frame.columns))
