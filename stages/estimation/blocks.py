"""The blocks of one manoeuvre as arrays."""

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts.tables import ACCEL, GYRO

Array = NDArray[np.float64]
Truths = NDArray[np.bool_]


@dataclass(frozen=True)
class Blocks:
    """k blocks of one manoeuvre in their order, all of one log.

    `log`, `phase`, `counts` of samples, `seconds`, `missing` before each, s, `time` of the middle,
    s, `temperature`, K: (k,); `gyro`, rad/s, and `accel`, m/s²: (k, 3), NaN where not recorded.
    """

    log: NDArray[Any]
    phase: NDArray[Any]
    counts: Array
    seconds: Array
    missing: Array
    time: Array
    temperature: Array
    gyro: Array
    accel: Array

    def __len__(self) -> int:
        return len(self.phase)

    @property
    def steady(self) -> Truths:
        """Which of them are at the steady rate, (k,)."""
        return np.asarray(self.phase == "steady", bool)

    def those(self, which: NDArray[Any]) -> "Blocks":
        """Some of them, by number or truth value; the readings of a channel stay side by side."""
        return Blocks(*(getattr(self, field.name).T[..., which].T for field in fields(self)))


NONE = Blocks(*(np.empty(0) for _ in range(7)), *(np.empty((0, 3)) for _ in range(2)))


def by_manoeuvre(table: pd.DataFrame) -> dict[str, Blocks]:
    """The blocks of each manoeuvre, by its name."""
    every = _blocks(table)
    rows = table.groupby("manoeuvre").indices
    return {str(name): every.those(np.asarray(some)) for name, some in rows.items()}


def _blocks(table: pd.DataFrame) -> Blocks:
    names = ("count", "seconds", "missing_s", "time", "temperature")
    return Blocks(
        table["log"].to_numpy(),
        table["phase"].to_numpy(),
        *(table[name].to_numpy(np.float64) for name in names),
        *(table[names].to_numpy(np.float64) for names in (GYRO, ACCEL)),
    )
