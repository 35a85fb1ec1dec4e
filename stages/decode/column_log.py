"""A log of columns, with its times where the stamps are those of arrival."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inertial.arrays import Array, Booleans, Integers
from inertial.formats.columns import column_reader
from inertial.formats.columns.column_layout import has_stamps, ticks_per_second
from inertial.formats.columns.data_rows import Rows
from inertial.signal.regular_clock import RegularClock, are_regular, regular_clock
from inertial.signal.scale_factor import bits_without_sign, signed
from inertial.signal.stamps import sent_again
from inertial.tables import AXES
from inertial.tables.errors import Refusal
from inertial.text.messages import _, listed
from inertial.text.numbers import significant
from inertial.text.units import CHANNEL_UNITS, ICE_POINT, INCREMENT_UNITS, STANDARD_GRAVITY
from stages.decode.decoded import ANGLE_UNITS, Continuous, Decoded, first_of, interval_of, on_axis

# What a degree of a unit is in K, and its zero.
KELVIN = {"degC": (1.0, ICE_POINT), "K": (1.0, 0.0), "degF": (5 / 9, ICE_POINT - 32 * 5 / 9)}

MIN_INTERVAL = 1 / 50_000  # s, between samples: no IMU samples faster
MIN_STAMPS = 20  # that show it


@dataclass(frozen=True)
class Stamped:
    """The stamps of one sensor, for two may come in rows of their own.

    record, ticks: (n,), of its rows; repeated: (n,), which have stamp and readings of the row
    before, or these and come too soon, so that no sample is taken with them.
    """

    record: Integers
    ticks: Array | Integers
    repeated: Booleans

    @classmethod
    def of(cls, rows: Rows, sensor: str) -> "Stamped":
        """The stamps of accelerometer or gyro in some rows of a log with time."""
        own = rows.accelerometer if sensor == "accelerometer" else rows.gyro
        there = np.isfinite(own).any(axis=1)
        all_ticks = np.zeros(0) if rows.ticks is None else rows.ticks  # of a log without rows
        ticks, values = all_ticks[there], np.hstack([rows.accelerometer, rows.gyro])[there]
        repeated = np.append(False, np.diff(ticks) == 0)[: len(ticks)]
        still = np.flatnonzero(repeated)
        same = np.nan_to_num(values[still]) == np.nan_to_num(values[still - 1])
        repeated[still] = same.all(axis=1)
        repeated |= sent_again(ticks, values)
        return cls(rows.record[there], ticks, repeated)

    @classmethod
    def joined(cls, parts: Iterable["Stamped"]) -> "Stamped":
        """Those of consecutive rows."""
        columns = zip(*((each.record, each.ticks, each.repeated) for each in parts), strict=True)
        return cls(*(np.concatenate(column) for column in columns))


class ArrivalTimes:
    """The times of a log's records, s since the first, by the clock of one sensor's samples.

    `first`: the stamp of time 0 by that clock, ticks; `ticks`: in a second.
    """

    def __init__(self, stamped: Stamped, clock: RegularClock, ticks: float) -> None:
        self.clock = clock
        self.first = float(stamped.ticks[0] + clock.start * ticks)
        self._record = stamped.record
        self._time = clock.time[np.cumsum(~stamped.repeated) - 1]

    def of(self, record: Integers) -> Array:
        """The time of each record, (n,), s; one of the other sensor lies between its neighbours."""
        return np.asarray(np.interp(record, self._record, self._time))


def arrival_times(
    beginning: NDArray[Any], stamps: Callable[[], Iterable[Stamped]], ticks: float
) -> ArrivalTimes | None:
    """The times of a log whose first stamps are not regular; None where these are, or no clock."""
    if are_regular((beginning - beginning[0]) / ticks):
        return None
    stamped = Stamped.joined(stamps())
    clock = regular_clock((stamped.ticks[~stamped.repeated] - stamped.ticks[0]) / ticks)
    return None if clock is None else ArrivalTimes(stamped, clock, ticks)


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
        self._first, self.interval = self._beginning()

    def _beginning(self) -> tuple[float, float | None]:
        """The time of the first sample in ticks; the sample interval, s."""
        time = self._layout.get("time")
        if time is None:
            return 0.0, None
        if not has_stamps(time):  # rows are counted from the first, though it be refused
            return 0.0, 1 / self._ticks
        first = first_of(each.ticks[~each.repeated] for each in self._stamps())
        if not len(first):
            return 0.0, None
        self._refuse_fast(first)
        if "mean_of" not in self._layout:
            self.arrival = arrival_times(first, self._stamps, self._ticks)
        if self.arrival is not None:
            return self.arrival.first, self.arrival.clock.interval
        interval = interval_of(first)
        return first[0].item(), None if interval is None else interval / self._ticks

    def _refuse_fast(self, first: NDArray[Any]) -> None:
        """Refuse first stamps, (n,), ticks, of more samples a second than any IMU takes."""
        mean = float(first[-1] - first[0]) / max(len(first) - 1, 1)
        if len(first) >= MIN_STAMPS and 0 < mean / self._ticks < MIN_INTERVAL:
            time = self._layout["time"]
            raise Refusal(
                self.path.name,
                "time",
                _(
                    "{rate} samples a second, by stamps in {unit} that are {ticks} apart",
                    rate=significant(self._ticks / mean),
                    unit=time.get("unit") or listed(time["units"]),
                    ticks=significant(mean),
                ),
                _("at most {rate} a second", rate=f"{1 / MIN_INTERVAL:g}"),
                _("correct the unit of the time in its format, or name the column of the time"),
            )

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
                degree, zero = KELVIN[self._layout["temperature"]["unit"]]
                samples["temperature"] = rows.temperature * degree + zero
            sigmas = {
                **self._sigmas("accel", "accelerometer", rows.accelerometer_sigma),
                **self._sigmas("gyro", "gyro", rows.gyro_sigma),
            }
            yield Decoded(samples, reading.refused, reading.account, mean_sigmas=sigmas)

    def _triad(self, sensor: str, key: str, values: Array) -> dict[str, Array]:
        triad = self._layout.get(key)
        if triad is None:
            return {}
        size = self._count_size(key, triad)
        if bits := triad.get("signed_bits"):
            values = signed(values, bits)
        in_units = (values - np.asarray(triad.get("zero_counts", 0.0))) * size
        return dict(on_axis(sensor, axis, in_units[:, i]) for i, axis in self._axes(sensor))

    def _count_size(self, sensor: str, triad: Mapping[str, Any]) -> Array:
        """What 1 in a column of a sensor is, SI, one number or (3,), also of increments."""
        counts = np.asarray(triad.get("counts_per_unit", 1.0), np.float64)
        if triad["unit"] in CHANNEL_UNITS:
            return np.asarray(CHANNEL_UNITS[triad["unit"]] / counts)
        if self.interval is None:
            raise Refusal(
                self.path.name,
                sensor,
                _("increments without a time"),
                _("the time of each sample, or how many there are in a second"),
                _("state time, or rate_hz, in its format"),
            )
        return np.asarray(INCREMENT_UNITS[triad["unit"]] / counts / self.interval)

    def _sigmas(self, sensor: str, key: str, values: Array | None) -> dict[str, Array]:
        if values is None:
            return {}
        size = np.broadcast_to(self._count_size(key, self._layout[key]), 3)
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


# ---- Unsigned counts that were not said to be unsigned: refused, with their zero or their bits

ZEROS = {1 << (bits - 1): bits for bits in (16, 12, 24)}  # middle of the counts of converters


def refuse_unsigned(file: str, sensor: str, triad: Mapping[str, Any], values: Array) -> None:
    """Refuse the first readings of a triad, (n, 3), where their zero is that of unsigned counts.

    All three channels then lie in the middle half of a converter's counts: no gyro turns so about
    all its axes at once. Accelerometers could, so their |f| must be nearer to gravity with that
    zero than without. A stated `zero_counts`, 0 included, or `signed_bits` is believed.

    Raises
    ------
    Refusal
        where they are such counts
    """
    values = values[np.isfinite(values).all(axis=1)]
    if "zero_counts" in triad or "signed_bits" in triad or not len(values):
        return
    if "counts_per_unit" in triad and (size := bits_without_sign([values])) is not None:
        raise Refusal(
            file,
            sensor,
            _(
                "counts that leap between 0 and {most:g}: they are written without their sign",
                most=2**size - 1,
            ),
            _("counts with their sign, or signed_bits"),
            _("add signed_bits: {size} to {sensor} in its format", size=size, sensor=sensor),
        )
    for zero, bits in ZEROS.items():
        usual = np.median(values, axis=0)
        inside = values.min() >= 0 and values.max() < 2 * zero
        if inside and (abs(usual - zero) < zero / 2).all() and _fits(sensor, triad, usual, zero):
            raise Refusal(
                file,
                sensor,
                _(
                    "counts from {least:g} to {most:g}, as unsigned ones of {bits} bits, whose "
                    "zero is {zero}",
                    least=values.min(),
                    most=values.max(),
                    bits=bits,
                    zero=zero,
                ),
                _("zero_counts, the count that stands for zero"),
                _(
                    "add zero_counts: {zero} to {sensor} in its format; zero_counts: 0 if they "
                    "are right as they are",
                    zero=zero,
                    sensor=sensor,
                ),
            )


def _fits(sensor: str, triad: Mapping[str, Any], usual: Array, zero: int) -> bool:
    """Whether the usual readings, (3,), make more sense from this zero than from 0."""
    if sensor != "accelerometer" or "counts_per_unit" not in triad:
        return True
    if triad["unit"] in INCREMENT_UNITS:
        return True
    size = CHANNEL_UNITS[triad["unit"]] / np.array(triad["counts_per_unit"]) / STANDARD_GRAVITY
    with_zero, without = (np.linalg.norm((usual - z) * size) for z in (zero, 0))
    return bool(abs(np.log(with_zero)) < abs(np.log(without))) if with_zero > 0 else False
