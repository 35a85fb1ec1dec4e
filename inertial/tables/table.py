"""A table contract: its columns with type, unit, frame and meaning. It loads no library.

What reads or writes Parquet is in `parquet.py` and loaded when a table is first read, so that the
declarations of all stages are read in a tenth of a second.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from inertial.sensors import CHANNELS, UNITS
from inertial.text.parameters import AXES

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa

    from inertial.tables.parquet import Rows, Stream


DOUBLE, TEXT, INTEGER, TRUTH, WORD = "double", "string", "int64", "bool", "uint32"
LABEL = "label"  # one of few texts: a dictionary
SENTENCE = "sentence"  # English for a person; the file keeps its messages, for other languages
TEXTS = "texts"  # a list of texts


@dataclass(frozen=True)
class Column:
    """One column: what its numbers mean, in which unit and frame.

    `type`: a name above, or the columns of the rows that each value holds.
    """

    name: str
    type: str | tuple[Column, ...]
    unit: str
    meaning: str
    frame: str = ""
    nullable: bool = False


def optional(
    name: str, type: str | tuple[Column, ...], unit: str, meaning: str, frame: str = ""
) -> Column:
    """A column that may be null: not known, not tested, or not applicable."""
    return Column(name, type, unit, meaning, frame, nullable=True)


def text(name: str, meaning: str, frame: str = "", *, nullable: bool = False) -> Column:
    """A column of texts, which have no unit."""
    return Column(name, TEXT, "", meaning, frame, nullable)


def sentence(name: str, meaning: str, *, nullable: bool = False) -> Column:
    """A column of sentences for a person."""
    return Column(name, SENTENCE, "", meaning, nullable=nullable)


def truth(name: str, meaning: str, *, nullable: bool = False) -> Column:
    """A column of yes or no."""
    return Column(name, TRUTH, "", meaning, nullable=nullable)


def integer(name: str, meaning: str, *, nullable: bool = False) -> Column:
    """A column of counts and numbers in an order, of unit 1."""
    return Column(name, INTEGER, "1", meaning, nullable=nullable)


def number(
    name: str, unit: str, meaning: str, frame: str = "", *, nullable: bool = False
) -> Column:
    """A column of measured or estimated numbers."""
    return Column(name, DOUBLE, unit, meaning, frame, nullable)


# The same where they may be null.
optional_text = partial(text, nullable=True)
optional_sentence = partial(sentence, nullable=True)
optional_truth = partial(truth, nullable=True)
optional_integer = partial(integer, nullable=True)
optional_number = partial(number, nullable=True)


@dataclass(frozen=True)
class Table:
    """Whoever reads this table gets these columns, in this order.

    `version` counts up with every change of the columns or of what they mean.
    """

    name: str
    version: int
    columns: tuple[Column, ...]

    @property
    def schema(self) -> pa.Schema:
        """The Arrow schema, with unit, frame and meaning of each column in its metadata."""
        from inertial.tables import parquet

        return parquet.schema_of(self)

    def read(self, path: Path) -> pd.DataFrame:
        """The whole table; for tables that are small."""
        from inertial.tables import parquet

        return parquet.read(self, path)

    def stream(self, path: Path) -> Stream:
        """The table batch by batch, as often as wanted; for tables that may be large."""
        from inertial.tables import parquet

        return parquet.stream(self, path)

    def arrow(self, rows: Rows) -> pa.Table:
        """`rows` in the columns of the contract.

        Raises
        ------
        ValueError
            where a column is missing, or has gaps that the contract does not allow
        """
        from inertial.tables import parquet

        return parquet.arrow(self, rows)

    def frame(self, rows: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
        """Rows given one by one as a frame, with the columns of the contract even where empty."""
        import pandas as pd

        names = [column.name for column in self.columns]
        return pd.DataFrame(rows, columns=names) if rows else self.empty()

    def empty(self) -> pd.DataFrame:
        """A table without rows."""
        frame: pd.DataFrame = self.schema.empty_table().to_pandas()
        return frame


def table(name: str, version: int, *columns: Column) -> Table:
    """The contract with these columns."""
    return Table(name, version, columns)


# ---- What many tables share: types, axes, channels, and columns that come together.

# Lists, for pandas takes a tuple as one name.
ACCEL, GYRO = ([f"{sensor}_{axis}" for axis in AXES] for sensor in ("accel", "gyro"))
STATIC_PHASES = ["rest", "rest-before", "rest-after"]  # in which the table is at rest
PHASES = (
    "rest; for a turn rest-before, spin-up, steady, spin-down, settling, rest-after; by hand:"
    " turning; from one rest of unknown attitude to the next: between"
)
CHANNEL_PARTS = {f"{sensor}_{axis}": (sensor, axis) for sensor in UNITS for axis in AXES}
BODY = "body"  # axes x, y, z of the IMU's case, right-handed
# By hand nothing tells the case: axes square to each other, nearest to those of the accelerometers.
OF_TRIAD = "accelerometer triad"


def vector(stem: str, unit: str, meaning: str) -> list[Column]:
    return [optional_number(f"{stem}_{axis}", unit, f"{meaning}, {axis}", BODY) for axis in AXES]


def channels(meaning: str, *, prefix: str = "") -> list[Column]:
    return [
        optional_number(f"{prefix}{channel}", UNITS[channel[:-2]], f"{meaning}, {channel}", BODY)
        for channel in CHANNELS
    ]


LOG = text("log", "file name; with ':' and the format's name where it is read in several")
RECORDS = integer("from_record", "first record"), integer("to_record", "record after the last")
SENSOR = text("sensor", "accel or gyro")
AXIS = text("axis", "x, y or z, of the body")
AS_CHANNEL = "m/s² of accel, rad/s of gyro"
MOUNT = text("mount", "of the plan; empty where the campaign has a single one")
METHOD = text("method", "method of estimation")
QUANTITY = text("quantity", "name of the parameter, such as bias_x")
