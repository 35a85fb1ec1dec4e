"""What the laboratory states on a certificate beside the numbers, and what follows from them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date

import pandas as pd

from inertial.campaign.records import Row, rows_of


@dataclass(frozen=True)
class Stated:
    """The items of a certificate by key, where stated, and its tables.

    standards, conformity : rows of these tables
    days : on which the logs were recorded, by their own clock, YYYY-MM-DD, in order
    """

    items: Mapping[str, Row]
    standards: Sequence[Row]
    conformity: Sequence[Row]
    days: Sequence[str]

    def text(self, item: str) -> str | None:
        """A text that is stated; none where it is not."""
        row = self.items.get(item)
        return None if row is None else row["text"]

    def day(self, item: str) -> str | None:
        """A day that is stated, if it is one of the calendar."""
        return calendar_day(self.text(item))


def calendar_day(text: str | None) -> str | None:
    """A day YYYY-MM-DD; none where the text is none, such as `unknown` or 2026-02-30."""
    try:
        return date.fromisoformat(text or "").isoformat()
    except ValueError:
        return None


def stated_by(
    certificate: pd.DataFrame,
    standards: pd.DataFrame,
    conformity: pd.DataFrame,
    clocks: Sequence[Row],
) -> Stated:
    """From the tables of the plan, of the diagnosis and of the logs."""
    return Stated(
        {row["item"]: row for row in rows_of(certificate) if row["file"]},
        rows_of(standards),
        rows_of(conformity),
        sorted({row["recorded_on"] for row in clocks if row["recorded_on"]}),
    )
