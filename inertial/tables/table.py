"""A table contract: its columns with type, unit, frame and meaning. It loads no library.

What reads or writes Parquet is in `parquet.py` and loaded when a table is first read, so that the
declarations of all stages are read in a tenth of a second.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
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
    return [optional(f"{stem}_{axis}", DOUBLE, unit, f"{meaning}, {axis}", BODY) for axis in AXES]


def channels(meaning: str, *, prefix: str = "") -> list[Column]:
    return [
        optional(f"{prefix}{channel}", DOUBLE, UNITS[channel[:-2]], f"{meaning}, {channel}", BODY)
        for channel in CHANNELS
    ]


LOG = Column(
    "log", TEXT, "", "file name; with ':' and the format's name where it is read in several"
)
RECORDS = (
    Column("from_record", INTEGER, "1", "first record"),
    Column("to_record", INTEGER, "1", "record after the last"),
)
SENSOR = Column("sensor", TEXT, "", "accel or gyro")
AXIS = Column("axis", TEXT, "", "x, y or z, of the body")
AS_CHANNEL = "m/s² of accel, rad/s of gyro"
MOUNT = Column("mount", TEXT, "", "of the plan; empty where the campaign has a single one")
METHOD = Column("method", TEXT, "", "method of estimation")
QUANTITY = Column("quantity", TEXT, "", "name of the parameter, such as bias_x")
