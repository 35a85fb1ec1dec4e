"""What a stage reads and writes: declared apart from its function, so that it costs no import."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from inertial import tables
from inertial.tables.table import Table

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class From:
    """A table of an earlier stage; `file`: its name there, where it is not that of the contract."""

    stage: str
    table: Table
    file: str = ""

    @property
    def place(self) -> str:
        """Where it lies in the folder of a campaign."""
        return f"{self.stage}/{self.file or self.table.name}.parquet"


def of_stage(stage: str, *contracts: Table) -> dict[str, From]:
    """Tables of an earlier stage, each by its own name."""
    return {table.name: From(stage, table) for table in contracts}


def of_stages(stages: Sequence[str], *contracts: Table) -> dict[str, From]:
    """The same tables of several stages, each by the stage and its own name."""
    return {f"{stage}_{table.name}": From(stage, table) for stage in stages for table in contracts}


@dataclass(frozen=True)
class Declared:
    """A stage by the tables that it reads, by argument, and those that it writes, by file name.

    A table listed in `streams` is handed over unread, to be read batch by batch; an input listed
    in `files` is no table, and is handed over as the list of its paths. `documents` are the
    endings of files that a stage writes for people and other programs instead of tables.
    `unfolded`: tables of which each row is a file too, named `file` and with `text` in it, in a
    folder of the table's name.
    """

    reads: Mapping[str, From] = field(default_factory=dict)
    writes: Mapping[str, Table] = field(default_factory=dict)
    streams: Sequence[str] = ()
    files: Sequence[str] = ()
    documents: Sequence[str] = ()
    unfolded: Sequence[str] = ()


def read_declared(derived: Path, sources: Mapping[str, From]) -> dict[str, pd.DataFrame]:
    """The tables of the campaign whose folder is `derived`, by argument.

    Raises
    ------
    Refusal
        where one is missing, damaged, or of another version
    """
    return {name: source.table.read(derived / source.place) for name, source in sources.items()}


# ---- What stages that work on the mounts of a campaign read alike: it, and its joint result.

ESTIMATING = ("accelerometer", "gyroscope")
RECORDED = {
    **of_stage("segment", tables.BLOCKS, tables.MANOEUVRES, tables.PERFORMED),
    "levels": From("noise", tables.LEVELS),
    "known": From("plan", tables.KNOWN),
    "clocks": From("decode", tables.CLOCKS),
}
ESTIMATED = of_stages(ESTIMATING, tables.PARAMETERS, tables.POSITIONS, tables.SWITCH_ONS)
# With what the fits say of scatter, random walks and switch-ons.
FITTED = ESTIMATED | of_stages(ESTIMATING, tables.FIT)

# Both stages of estimation, each of its sensor.
ESTIMATION = Declared(
    reads=RECORDED,
    writes={
        "parameters": tables.PARAMETERS,
        "covariance": tables.COVARIANCE,
        "fit": tables.FIT,
        "fit_manoeuvres": tables.FIT_MANOEUVRES,
        "averaging": tables.AVERAGING,
        "positions": tables.POSITIONS,
        "switch_ons": tables.SWITCH_ONS,
        "wanted": tables.WANTED,
        "findings": tables.FINDINGS,
    },
)
