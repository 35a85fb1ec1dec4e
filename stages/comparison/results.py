"""What the methods of one stage found, by method and parameter."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import pandas as pd

from inertial.campaign.records import Row, rows_of, with_mount


@dataclass(frozen=True)
class Results:
    """What the methods of one stage found for one mount."""

    stage: str
    parameters: pd.DataFrame
    mount: str

    def id(self, method: str, name: str = "") -> str:
        """The identifier of a parameter, or of all that a method determined."""
        group = f"{self.stage}/{with_mount(method, self.mount)}"
        return f"{group}/{name}" if name else group

    @cached_property
    def _rows(self) -> dict[tuple[str, str], Row]:
        return {
            (row["method"], row["parameter"]): row
            for row in rows_of(self.parameters)
            if row["mount"] == self.mount
        }

    def of(self, method: str, name: str) -> Row | None:
        """The row of a parameter; none where the method does not have it."""
        return self._rows.get((method, name))

    def determined(self, method: str, name: str) -> Row | None:
        """The same; none where it is not determined either."""
        row = self.of(method, name)
        return None if row is None or row["value"] is None else row

    def names(self, method: str) -> Iterator[str]:
        """Names of the parameters that a method determined."""
        for of_method, name in self._rows:
            if of_method == method and self.determined(method, name):
                yield name
