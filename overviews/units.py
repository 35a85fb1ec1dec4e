"""The calibrations of an IMU out of the archive, and what they show together."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from inertial import tables
from inertial.campaign.records import grouped, rows_of
from inertial.text.messages import _
from stages.history.archive import COMPARABLE_BY, Archive, Entry, results
from stages.history.repeatability import (
    Series,
    forecast_rows,
    jump_rows,
    jumps_of,
    repeatability_rows,
    series_of,
    tolerances,
)
from stages.report.tables import Tables

ALLOWED_CHANGES = "plan/allowed_changes.parquet"  # in the folder of a campaign


@dataclass(frozen=True)
class Imu:
    """An IMU: its current calibrations in the order of their dates.

    `level`: chance of naming a jump where there is none; `allowed`: by how much its parameters may
    change until it is due, by sensor_kind.
    """

    simulated: bool
    calibrations: Sequence[Entry]
    level: float
    allowed: Mapping[str, float]

    @property
    def last(self) -> Entry:
        """Its newest calibration."""
        return self.calibrations[-1]

    @property
    def name(self) -> str:
        """Its type, and that the errors were taken out of its logs, where they were."""
        row = self.last.row
        compensated = _(", compensated logs") if row["compensated"] else ""
        return f"{row['instrument']}{compensated}"

    @cached_property
    def series(self) -> Series:
        """The values of each parameter of the result that counted."""
        return series_of([(each.row, results(each)) for each in self.calibrations])

    @cached_property
    def tables(self) -> Tables:
        """How they repeat, their jumps, and what the next may find: tables of the stage history."""
        jumps = jumps_of(self.series, self.level)
        frames = {
            "repeatability": tables.REPEATABILITY.frame(
                list(repeatability_rows(self.series, tables.BLOCKS.empty()))
            ),
            "jumps": tables.JUMPS.frame(list(jump_rows(jumps, len(self.series)))),
            "forecast": tables.FORECAST.frame(
                list(forecast_rows(self.series, jumps, self.allowed))
            ),
        }
        return Tables(frames, {})

    @property
    def due(self) -> str | None:
        """The day on which the first of its parameters is due; none where that is not known."""
        days = [row["due"] for row in self.tables.rows("forecast") if row["due"]]
        return min(days, default=None)

    @property
    def why_not_due(self) -> str:
        """Why no day is known, once."""
        reasons = dict.fromkeys(row["reason"] for row in self.tables.rows("forecast"))
        return "; ".join(reason for reason in reasons if reason)


def imus_of(
    archive: Path, folder: str, derived: Path, *, level: float, tolerance: Mapping[str, float]
) -> list[Imu]:
    """The IMUs with this serial number: as a rule one, and simulated ones apart.

    `folder`: file name of the serial number; `derived`: where campaigns have their tables; the
    changes that the last campaign allows count before `tolerance`.

    Raises
    ------
    Refusal
        where a file of the archive cannot be read
    """
    imus = []
    for simulated in (False, True):
        entries = Archive(archive, simulated=simulated).of_serial(folder)
        groups = grouped(entries, lambda entry: tuple(entry.row[key] for key in COMPARABLE_BY))
        for own in groups.values():
            stated = derived / own[-1].row["campaign"] / ALLOWED_CHANGES
            rows = rows_of(tables.ALLOWED_CHANGES.read(stated)) if stated.is_file() else []
            imus.append(Imu(simulated, own, level, tolerances(tolerance, rows)))
    return imus
