"""The parameters of one mount, by method and name."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import pandas as pd

from stages.contracts.records import Row, rows_of


@dataclass(frozen=True)
class Results:
    """What the methods of one stage found for one mount."""

    stage: str
    parameters: pd.DataFrame
    suffix: str  # of the methods' names: @ and the mount where there are several

    @cached_property
    def _rows(self) -> dict[tuple[str, str], Row]:
        return {(row["method"], row["parameter"]): row for row in rows_of(self.parameters)}

    def of(self, method: str, name: str) -> Row | None:
        """The row of a parameter; none where the method does not have it."""
        return self._rows.get((f"{method}{self.suffix}", name))

    def determined(self, method: str, name: str) -> Row | None:
        """The same; none where it is not determined either."""
        row = self.of(method, name)
        return None if row is None or row["value"] is None else row

    def names(self, method: str) -> Iterator[str]:
        """Names of the parameters that a method determined."""
        for wanted, name in self._rows:
            if wanted == f"{method}{self.suffix}" and self.determined(method, name):
                yield name
