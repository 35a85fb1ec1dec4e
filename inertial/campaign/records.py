"""Rows of the small tables as records with types: manoeuvres, what was performed, what is known."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, TypeVar

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.tables import AXES
from inertial.text.messages import _

MAX_NAMED = 5  # manoeuvres that are left out for the same reason

# Phases in which the table turns.
TURNING = ("spin-up", "steady", "spin-down", "settling", "turning")
Row = dict[str, Any]
Item = TypeVar("Item")
Group = TypeVar("Group")


def rows_of(table: pd.DataFrame) -> list[Row]:
    """The rows of a table, None for what is empty."""
    columns = {
        str(name): [
            None if gap else value
            for value, gap in zip(column.tolist(), column.isna(), strict=True)
        ]
        for name, column in table.items()
    }
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def grouped(items: Iterable[Item], key: Callable[[Item], Group]) -> dict[Group, list[Item]]:
    """The items of each group, all in the order in which they come."""
    groups: dict[Group, list[Item]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return groups


@dataclass(frozen=True)
class Manoeuvre:
    """One manoeuvre of the plan; vectors (3,) in body axes, SI and radians, None where unknown.

    Of a rest of a `tumble`: `tumble_axis` and `tumbled`, the angle since its start along it, (3,).
    `turned_on`: by how much it begins further about the vertical than the first of its position.
    """

    name: str
    do: str
    log: str
    position: str
    mount: str
    up: Array | None = None
    mark: Array | None = None
    about: Array | None = None
    angle: float | None = None
    angle_sigma: float | None = None
    rate: float | None = None
    acceleration: float | None = None
    seconds: float | None = None
    recorded: str = "whole"
    from_s: float | None = None
    to_s: float | None = None
    from_row: int | None = None
    to_row: int | None = None
    label: str | None = None
    temperature: float | None = None
    temperature_sigma: float | None = None
    rate_sigma: float | None = None
    switch_on: int = 0
    tumble: str | None = None
    tumble_axis: Array | None = None
    tumbled: Array | None = None
    turned_on: float = 0.0

    @property
    def selected(self) -> bool:
        """Whether the plan states which stretch of the log it is."""
        return (self.from_s, self.from_row, self.label) != (None, None, None)

    @property
    def axis(self) -> Array:
        """The axis of a turn; the plan refuses a turn without one."""
        assert self.about is not None
        return self.about

    def detected_rest(self, number: int) -> str:
        """The name of a rest that was detected within it, in their order from 1."""
        return f"{self.name}-{number:02d}"


VECTORS = ("up", "mark", "about", "tumble_axis", "tumbled")
STATED = [field.name for field in fields(Manoeuvre) if field.name != "name"]


def with_mount(name: str, mount: str) -> str:
    """A part of an identifier, with the mount where the campaign has several; else it is empty."""
    return f"{name}@{mount}" if mount else name


def by_mount(plan: Sequence[Manoeuvre]) -> list[tuple[str, list[Manoeuvre]]]:
    """The manoeuvres of each mount, whose name is empty where the campaign has a single one."""
    mounts = list(dict.fromkeys(m.mount for m in plan))
    return [
        (mount if len(mounts) > 1 else "", [m for m in plan if m.mount == mount])
        for mount in mounts
    ]


def manoeuvres_of(table: pd.DataFrame) -> list[Manoeuvre]:
    """The manoeuvres of the plan in their order."""
    return [_manoeuvre(row) for row in rows_of(table)]


def _manoeuvre(row: Row) -> Manoeuvre:
    own: Row = {key: vector_of(row, key) if key in VECTORS else row[key] for key in STATED}
    return Manoeuvre(row["manoeuvre"], **own)


def vector_of(row: Row, stem: str) -> Array | None:
    components = [row[f"{stem}_{axis}"] for axis in AXES]
    return None if None in components else np.array(components, dtype=np.float64)


@dataclass(frozen=True)
class Performed:
    """What was recorded of a manoeuvre; rad, rad/s about its axis, s."""

    manoeuvre: str
    sentence: str
    found: bool = True
    complete: bool = True
    angle: float | None = None
    missing_angle: float | None = None
    missing_s: float = 0.0
    rate: float | None = None
    seconds: float = 0.0
    bridged: bool = False
    lost: bool = False
    peak_x: float | None = None
    peak_y: float | None = None
    peak_z: float | None = None
    sense_x: float | None = None
    sense_y: float | None = None
    sense_z: float | None = None
    stopped: float | None = None

    @property
    def peaks(self) -> tuple[float, ...]:
        """Of the force along each axis on the way to it, m/s², (3,); NaN where there is none."""
        return _with_nan(self.peak_x, self.peak_y, self.peak_z)

    @property
    def senses(self) -> tuple[float, ...]:
        """In which it last turned about each axis on the way to it, ±1, (3,); NaN: it did not."""
        return _with_nan(self.sense_x, self.sense_y, self.sense_z)


def _with_nan(*values: float | None) -> tuple[float, ...]:
    return tuple(np.nan if value is None else value for value in values)


def performed_of(table: pd.DataFrame) -> dict[str, Performed]:
    """What was recorded, by the name of the manoeuvre."""
    return {row["manoeuvre"]: Performed(**row) for row in rows_of(table)}


@dataclass(frozen=True)
class Part:
    """A manoeuvre of a fit, or one phase of it; `reason`: why it is left out, empty where used."""

    manoeuvre: str
    phase: str | None = None
    reason: str = ""

    @property
    def label(self) -> str:
        """In words: the manoeuvre, with the phase where it is one of a turn."""
        named = self.phase not in (None, "rest", "between")
        return f"{self.manoeuvre} ({self.phase})" if named else self.manoeuvre

    @property
    def omission(self) -> str:
        """In words: what is left out, and why."""
        return f"{self.label}: {self.reason}"


def parts_of(rows: Iterable[Row]) -> list[Part]:
    """The parts in rows of a table of the manoeuvres of a fit."""
    return [Part(row["manoeuvre"], row["phase"], row["reason"] or "") for row in rows]


def labels(parts: Iterable[Part]) -> str:
    """In words: what is used."""
    return ", ".join(part.label for part in parts if not part.reason)


def omissions(parts: Iterable[Part]) -> str:
    """In words: what is left out, and why; of many for one reason the first and their number."""
    alike = grouped((part for part in parts if part.reason), lambda part: part.reason)
    return "; ".join(_omission(left_out).rstrip(".") for left_out in alike.values())


def _omission(alike: Sequence[Part]) -> str:
    """What is left out for one reason."""
    first, *others = alike
    if len(others) < MAX_NAMED:
        return "; ".join(part.omission for part in alike)
    return _(
        "{label} and {others} others: {reason}",
        label=first.label,
        others=len(others),
        reason=first.reason,
    )


@dataclass(frozen=True)
class Known:
    """A quantity that is taken as known, and its sigma; None where it is not known."""

    value: float | None
    sigma: float | None

    @property
    def number(self) -> float:
        """The value of a quantity that every campaign has."""
        assert self.value is not None
        return self.value

    @property
    def scatter(self) -> float:
        """The sigma of a quantity that always has one."""
        assert self.sigma is not None
        return self.sigma


def known_of(table: pd.DataFrame) -> dict[str, Known]:
    """What is taken as known, by its name."""
    return {row["quantity"]: Known(row["value"], row["sigma"]) for row in rows_of(table)}


OWN = "own"  # of a log whose stamps are not GPS time
MAX_PAUSE = 600.0  # s, between two logs of one run of the instrument
MIN_ABSOLUTE = 1e8  # s, since any epoch: no logger runs for three years


@dataclass(frozen=True)
class Clock:
    """The clock of a log, s: the interval is what a sample counts for in a sum over time.

    `averaged`: whether a sample is the mean over its interval, an increment, as receivers log it;
    `begin`, `end`: of the first and last sample, by the clock that all logs share, NaN where they
    share none; `sigma`: of the interval by stamps of arrival, relative, 0 where the stamps are
    those of sampling; `offset`: of time 0 of the log since that of all logs, s.
    """

    interval: float | None  # None without time
    averaged: bool = False
    begin: float = np.nan
    end: float = np.nan
    sigma: float = 0.0
    offset: float = 0.0

    @property
    def step(self) -> float:
        """The duration of a sample; 1 where there is no time, so that records stand for seconds."""
        return self.interval or 1.0


def clocks_of(table: pd.DataFrame) -> dict[str, Clock]:
    """The clocks by the name of the log."""
    shared, rows = share_a_clock(table), rows_of(table)
    began = [row["began"] for row in rows if row["clock"] == OWN and shared]
    return {
        row["log"]: Clock(
            row["interval"],
            row["clock"] == "GPS",
            *(_span(row) if shared else (np.nan, np.nan)),
            (row.get("interval_sigma") or 0.0) / (row["interval"] or 1.0),
            (row["began"] or 0.0) - min(began) if began and None not in began else 0.0,
        )
        for row in rows
    }


def _span(row: Row) -> tuple[float, float]:
    """The stamps of the first and last sample of a log, s; NaN where there are none."""
    zero = row["began"] if row["clock"] == OWN else row["epoch_gps"]
    times = [row["from_s"], row["to_s"]]
    first, last = (np.nan if None in (zero, time) else float(zero + time) for time in times)
    return first, last


def runs_of(logs: Iterable[str], clocks: Mapping[str, Clock], shared: bool) -> dict[str, int]:
    """Which run of the instrument each log is of, from switch-on to switch-off.

    Logs that share a clock and follow one another within minutes are of one run, for nobody
    switches an instrument off that must warm up again. Other logs may each be a run of their own.
    """
    names = list(logs)
    if not shared or any(name not in clocks for name in names):
        return {name: number for number, name in enumerate(names)}
    number, end, runs = 0, np.nan, {}
    for name in sorted(names, key=lambda name: clocks[name].begin):
        if clocks[name].begin - end > MAX_PAUSE:
            number += 1
        runs[name], end = number, float(np.fmax(end, clocks[name].end))
    return runs


def switch_on_times(
    plan: Sequence[Manoeuvre], clocks: Mapping[str, Clock], blocks: pd.DataFrame
) -> dict[int, float]:
    """When the IMU was switched on again, s since the first sample of all logs, by `switch_on`.

    A log that begins with it tells by its first sample; else the first block after it does.
    """
    if not any(m.switch_on for m in plan):
        return {}
    start = min((clock.begin for clock in clocks.values()), default=np.nan)
    times = blocks.groupby("manoeuvre")["time"].min()
    first = {m.log: m for m in reversed(sorted(plan, key=lambda m: m.switch_on))}
    found: dict[int, float] = {}
    for m in plan:
        at = float(times.get(m.name, np.nan))
        if m is first[m.log] and m.log in clocks and np.isfinite(clocks[m.log].begin):
            at = clocks[m.log].begin - start
        found[m.switch_on] = float(np.fmin(found.get(m.switch_on, np.nan), at))
    return {number: at for number, at in found.items() if number and np.isfinite(at)}


def share_a_clock(table: pd.DataFrame) -> bool:
    """Whether times of all logs count from one start: GPS time, a single log, or logs in a row.

    Stamps of several logs that go on from one to the next, none before the last one ends, are of
    one clock: absolute time, or that of a logger which runs on. Logs that each begin at zero are
    not.
    """
    clocks = table["clock"].tolist()
    if set(clocks) == {"GPS"} or clocks == [OWN]:
        return True
    if set(clocks) != {OWN}:
        return False
    begin, end = np.array(sorted(_span(row) for row in rows_of(table))).T
    pauses = begin[1:] - end[:-1]
    return bool((pauses > 0).all() and (begin[0] > MIN_ABSOLUTE or (pauses < MAX_PAUSE).all()))


def sizes_of_result(parameters: Iterable[Row]) -> dict[tuple[str, str, str], Row]:
    """The rows of the result that are parameters of effects, by mount, effect and parameter.

    Of an effect in the models of both sensors those with the smaller sigma.
    """
    found: dict[tuple[str, str, str], Row] = {}
    for row in parameters:
        if row["effect"] is not None and row["sigma"]:
            key = (row["mount"], row["effect"], row["parameter"].rpartition(".")[2])
            found[key] = min(found.get(key, row), row, key=lambda one: one["sigma"])
    return found
