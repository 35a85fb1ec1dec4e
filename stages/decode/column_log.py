"""A log of columns."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from inertial.formats.columns import column_reader
from inertial.formats.columns.column_layout import ticks_per_second
from inertial.signal.signed_counts import signed
from inertial.tables import AXES
from inertial.text.units import CHANNEL_UNITS, ICE_POINT
from stages.decode.arrival_times import ArrivalTimes, Stamped, arrival_times
from stages.decode.decoded import Decoded, Reals, first_of, intervals_of, on_axis
from stages.decode.table_angle import ANGLE_UNITS, Continuous
from stages.decode.unsigned_counts import refuse_unsigned


def _count_size(triad: Mapping[str, Any]) -> Reals:
    """What 1 in a column of a sensor is, SI, one number or (3,)."""
    size = CHANNEL_UNITS[triad["unit"]] / np.asarray(triad.get("counts_per_unit", 1.0))
    return np.asarray(size, np.float64)


class ColumnLog:
    """A log of columns, text or not: its own time or none, and values in units or counts.

    `arrival`: the times of its samples, where its stamps are those of arrival.
    """

    def __init__(self, name: str, path: Path, layout: Mapping[str, Any]) -> None:
        self.name = name
        self.path = path
        self._layout = layout
        time = layout.get("time")
        self.clock = "none" if time is None else "own"
        self._ticks = 1.0 if time is None else ticks_per_second(layout)
        self.arrival: ArrivalTimes | None = None
        self._first, self.interval, self.step = self._beginning()

    def _beginning(self) -> tuple[float, float | None, float | None]:
        """The time of the first sample in ticks; median and mean sample interval, s."""
        time = self._layout.get("time")
        if time is None:
            return 0.0, None, None
        if time.get("column") is None:  # rows are counted from the first, though it be refused
            return 0.0, 1 / self._ticks, 1 / self._ticks
        first = first_of(each.ticks[~each.repeated] for each in self._stamps())
        if not len(first):
            return 0.0, None, None
        if "mean_of" not in self._layout:
            self.arrival = arrival_times(first, self._stamps, self._ticks)
        if self.arrival is not None:
            interval = self.arrival.clock.interval
            return self.arrival.first, interval, interval
        median, mean = intervals_of(first)
        if median is None or mean is None:
            return first[0].item(), None, None
        return first[0].item(), median / self._ticks, mean / self._ticks

    def _stamps(self) -> Iterator[Stamped]:
        sensor = "accelerometer" if "accelerometer" in self._layout else "gyro"
        for reading in column_reader.read(self.path, self._layout):
            yield Stamped.of(reading.records, sensor)

    def decoded(self, origin: int) -> Iterator[Decoded]:
        """The log, piece by piece; `origin` is none of its business."""
        continuous = Continuous()
        for number, reading in enumerate(column_reader.read(self.path, self._layout)):
            rows = reading.records
            if number == 0:
                self._refuse_unsigned(rows)
            samples: dict[str, Any] = {
                "record": rows.record,
                "offset": rows.offset,
                "line": rows.line,
                "mean_of": rows.mean_of,
                "label": rows.label,
                **self._triad("accel", "accelerometer", rows.accelerometer),
                **self._triad("gyro", "gyro", rows.gyro),
            }
            if self.arrival is not None:
                samples["time"] = self.arrival.of(rows.record)
            elif rows.ticks is not None:
                samples["time"] = (rows.ticks - self._first) / self._ticks
            if rows.table_angle is not None:
                unit = ANGLE_UNITS[self._layout["table_angle"]["unit"]]
                samples["table_angle"] = continuous(rows.table_angle * unit)
            if rows.temperature is not None:
                above = ICE_POINT if self._layout["temperature"]["unit"] == "degC" else 0.0
                samples["temperature"] = rows.temperature + above
            sigmas = {
                **self._sigmas("accel", "accelerometer", rows.accelerometer_sigma),
                **self._sigmas("gyro", "gyro", rows.gyro_sigma),
            }
            yield Decoded(samples, reading.refused, reading.account, mean_sigmas=sigmas)

    def _triad(self, sensor: str, key: str, values: Reals) -> dict[str, Reals]:
        triad = self._layout.get(key)
        if triad is None:
            return {}
        size = _count_size(triad)
        if bits := triad.get("signed_bits"):
            values = signed(values, bits)
        in_units = (values - np.asarray(triad.get("zero_counts", 0.0))) * size
        return dict(on_axis(sensor, axis, in_units[:, i]) for i, axis in self._axes(sensor))

    def _sigmas(self, sensor: str, key: str, values: Reals | None) -> dict[str, Reals]:
        if values is None:
            return {}
        size = np.broadcast_to(_count_size(self._layout[key]), 3)
        return {f"{sensor}_{axis[-1]}": values[:, i] * size[i] for i, axis in self._axes(sensor)}

    def _axes(self, sensor: str) -> Iterator[tuple[int, str]]:
        """The fields of a sensor by number, with body axis and sign of each."""
        yield from enumerate(self._layout.get("axes", {}).get(sensor, AXES))

    def _refuse_unsigned(self, rows: column_reader.Rows) -> None:
        for sensor, values in (("accelerometer", rows.accelerometer), ("gyro", rows.gyro)):
            if triad := self._layout.get(sensor):
                refuse_unsigned(self.path.name, sensor, triad, values)

    def began(self, origin: int, *, absolute: bool) -> float:
        """What its samples' time 0 is by its own clock, which is the encoder's too, s."""
        return self._first / self._ticks

    def epoch(self, origin: int) -> dict[str, Any]:
        """Nothing: its clock is its own."""
        return {"epoch_gps": None, "recorded_on": None}
