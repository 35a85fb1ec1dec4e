"""Base class of the detectors of recording faults, and the data that they examine."""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

import numpy as np

from inertial.arrays import Array, Integers
from inertial.sensors import CHANNELS, COLUMNS, SINGULAR, UNITS
from inertial.text.messages import _
from inertial.text.units import in_degrees

if TYPE_CHECKING:
    from inertial.signal.phase_folding import Glitch


def channel_name(channel: int) -> str:
    """Its sensor and axis: accelerometer x, gyro z."""
    sensor, _underscore, axis = CHANNELS[channel].partition("_")
    return _("{sensor} {axis}", sensor=SINGULAR[sensor], axis=axis)


def read_in(channel: int) -> tuple[float, str]:
    """What a person reads it in, °/s or m/s²: how many of these are one SI unit, and its name."""
    return in_degrees(1.0, UNITS[CHANNELS[channel].partition("_")[0]])


@dataclass(frozen=True)
class Given:
    """What the campaign states of all its logs.

    gravity: m/s²; normal_gravity: m/s², at its latitude and height, NaN where these are not stated;
    refuted_gravity: m/s², where a stated one is not that of the place, else NaN.
    interval: s, of the instrument, NaN where not stated. date: ISO, or unknown.
    usual_interval: s, the median of the mean intervals of its logs, and unlike: by how much these
    differ, 1; NaN where fewer than three logs have stamps.
    must_be_set, must_be_clear: bits of the status of a valid record. count_sizes: m/s and rad, of
    accelerometer and gyro, by the name of each listed instrument. position_sigma: rad, of the tilts
    of a set position; attitude_set: whether that of what is examined is one.
    """

    gravity: float
    normal_gravity: float
    interval: float
    instrument: str
    date: str
    must_be_set: int
    must_be_clear: int
    count_sizes: Mapping[str, tuple[float, float]]
    refuted_gravity: float = np.nan
    usual_interval: float = np.nan
    unlike: float = np.nan
    position_sigma: float = 0.0
    attitude_set: bool = True


@dataclass(frozen=True)
class Windows:
    """Means over k windows of 1 s (or so many records, where there is no time) of a log.

    mean, variance: (k, 6), NaN where not recorded; time, temperature: (k,), s and K.
    """

    mean: Array
    variance: Array
    time: Array
    temperature: Array

    @classmethod
    def none(cls) -> Self:
        """No windows at all."""
        return cls(np.empty((0, 6)), np.empty((0, 6)), np.empty(0), np.empty(0))


@dataclass(frozen=True, eq=False)
class Log:
    """Properties of a log that are known before its records are examined singly.

    interval: s, what a sample counts for in a sum over time, NaN where there is none;
    recorded_on: UTC date, or None.
    quantum, noise: (6,), smallest step of a channel's readings, and the scatter of one reading
    about its neighbours, m/s² and rad/s, NaN where not recorded.
    equal: (6,), share of readings that are equal to the one before; held: (2,), share of records in
    which the accelerometers, or the gyros, repeat their readings, 0 unless throughout the log.
    least, most: (6,), its smallest and largest reading.
    reach, usual_noise: (6,), its largest reading of either sign in any log, and the median of its
    noise in all logs.
    limit: (6,), how far the channel reaches, infinite where not stated.
    threshold: (6,), below which the channel reads 0, NaN where it does not.
    count: (6,), what one count is by the campaign, m/s² and rad/s, NaN where not stated.
    records: how many; records_of_all: of all logs.
    increments: readings are increments over `interval`, and what a count leaves over goes into the
    next. imu: the types of IMU in its messages, by NovAtel's list.
    stamp_scatter: s, rms of the stamps about the regular clock that is used instead, NaN where the
    stamps are used; interval_sigma: s, of its interval; shortest_gap: s, that such stamps show.
    glitches: what is off at one phase of a period.
    """

    name: str
    given: Given
    interval: float
    recorded_on: str | None
    quantum: Array
    noise: Array
    equal: Array
    least: Array
    most: Array
    limit: Array
    count: Array
    windows: Windows
    records: int
    reach: Array = field(default_factory=lambda: np.full(6, np.nan))
    usual_noise: Array = field(default_factory=lambda: np.full(6, np.nan))
    increments: bool = False
    imu: tuple[int, ...] = ()
    threshold: Array = field(default_factory=lambda: np.full(6, np.nan))
    held: Array = field(default_factory=lambda: np.zeros(2))
    stamp_scatter: float = np.nan
    interval_sigma: float = np.nan
    shortest_gap: float = np.nan
    glitches: tuple["Glitch", ...] = ()
    records_of_all: int = 0

    def event(self, size: float, **more: Any) -> "Event":
        """An event that concerns the log as a whole."""
        times = self.windows.time
        ends = (float(times[0]), float(times[-1])) if len(times) else (np.nan, np.nan)
        return Event(0, self.records, 1, *ends, size, **more)


@dataclass(frozen=True, eq=False)
class Piece:
    """n consecutive records of a log.

    record, line: (n,), numbers in the log; time: (n,), s, NaN where there is none; values:
    (n, 6), NaN where not recorded or masked by an earlier detector; status, temperature: (n,),
    NaN where there is none. Records [first, after) are to be examined; the others are
    there for comparison. reached: s, the latest time before the first of all.
    """

    record: Integers
    line: Integers
    time: Array
    values: Array
    status: Array
    temperature: Array
    first: int
    after: int
    reached: float = -np.inf

    def __len__(self) -> int:
        return len(self.record)

    def channel(self, i: int) -> tuple[Integers, Array]:
        """Where channel i is recorded, (m,), and what it reads there, (m,)."""
        there = np.flatnonzero(np.isfinite(self.values[:, i]))
        return there, self.values[there, i]

    def without(self, events: "list[Event]") -> Self:
        """The same piece, without the readings that these events mask."""
        values = self.values.copy()
        for event in events:
            inside = slice(*np.searchsorted(self.record, [event.first, event.after]))
            values[inside, list(event.channels) or slice(None)] = np.nan
        return replace(self, values=values)

    def event(self, start: int, end: int, size: float, **more: Any) -> "Event":
        """An event at the places [start, end) of this piece."""
        return Event(
            int(self.record[start]),
            int(self.record[end - 1]) + 1,
            int(self.line[start]),
            float(self.time[start]),
            float(self.time[end - 1]),
            size,
            **more,
        )


@dataclass(frozen=True)
class Event:
    """A detection at one place: records [first, after) of a log.

    from_s, to_s: time of its first and last record, NaN where there is none; size: in the
    detector's unit, or in that of the channel; p_value: chance of it if nothing is wrong, the
    search paid for; count: how many equal things it stands for; facts: what its description needs;
    severity: where it is not that of the detector; sensor: accel or gyro, where it concerns one of
    them though no channel alone; log: that it concerns, where it was seen between logs.
    """

    first: int
    after: int
    line: int
    from_s: float
    to_s: float
    size: float
    channel: int | None = None
    p_value: float | None = None
    count: int = 1
    facts: Any = None
    severity: int | None = None
    sensor: str | None = None
    log: str = ""

    @property
    def channels(self) -> Sequence[int]:
        """The channels that it concerns; none where it is the whole record."""
        if self.channel is not None:
            return (self.channel,)
        own = COLUMNS.get(self.sensor or "", slice(0, 0))
        return range(own.start, own.stop)


@dataclass(frozen=True)
class Description:
    """A finding for a person: what is wrong, what it does to which parameter, what to do."""

    sentence: str
    consequence: str
    action: str


class Detector(ABC):
    """One fault of a recording: its name, source and detection.

    The docstring of a class says what causes the fault, and what it costs the result.
    `unit` of the size, empty where it is that of the channel; `sensor`: accel or gyro, where all
    axes of one are concerned. `severity`: 3 spoils a result, 2 weakens it, 1 is good to know.
    `masks`: readings that it detects are not used by others; `repeats`: no time passes with the
    records that it masks. `alike`: which of its events are one finding: those of a `sensor` (or
    all, where they concern no channel), of a `channel`, those of several channels over the same
    `records`, or each `event` is one of its own.
    """

    name: ClassVar[str]
    source: ClassVar[str]
    unit: ClassVar[str] = ""
    sensor: ClassVar[str | None] = None
    severity: ClassVar[int] = 2
    masks: ClassVar[bool] = False
    repeats: ClassVar[bool] = False
    alike: ClassVar[Literal["sensor", "channel", "records", "event"]] = "channel"

    def censors(self, event: Event) -> bool:
        """Whether it masks readings for their value, so that those left have a biased mean."""
        return False

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        """Events in a piece of a log, in the order of the records."""
        yield from ()

    def detect_in_log(self, log: Log) -> Iterator[Event]:
        """Events that concern a log as a whole."""
        yield from ()

    def detect_in_campaign(self, given: Given) -> Iterator[Event]:
        """Events in what the campaign states."""
        yield from ()

    def detect_between_logs(self, logs: Mapping[str, Log]) -> Iterator[Event]:
        """Events in the comparison of the logs of the campaign, by name."""
        yield from ()

    @abstractmethod
    def describe(self, event: Event, name: str) -> Description:
        """An event in words; `name` is that of the log or rest, empty for the campaign."""

    def describe_many(self, events: Sequence[tuple[str, Event]]) -> Description:
        """Events that are one finding in words, each with the name of its log or rest."""
        name, largest = max(events, key=lambda pair: abs(pair[1].size))
        one = self.describe(largest, name)
        return replace(one, sentence=f"{one.sentence} {occurrences(events)}")


MAX_NAMED_LOGS = 6  # in a sentence; of more the number is given


def occurrences(events: Sequence[tuple[str, Event]]) -> str:
    """How often, and in which logs, of which the largest event was described."""
    count = sum(event.count for _, event in events)
    if len({name for name, _ in events}) == 1:
        return _("This occurs {count} times in this log; the largest is described.", count=count)
    return _(
        "This occurs {count} times in {logs}; the largest is described.",
        count=count,
        logs=names_of_logs(events),
    )


def names_of_logs(events: Sequence[tuple[str, Event]]) -> str:
    """The logs or rests of events in words; of many, how many they are."""
    names = list(dict.fromkeys(name for name, _event in events))
    if len(names) > MAX_NAMED_LOGS:
        return _("{count} logs", count=len(names))
    return ", ".join(names)


def names_of_axes(events: Sequence[tuple[str, Event]]) -> str:
    """The sensor of events and its axes, in words: gyros x, y."""
    channels = sorted({event.channel for _name, event in events if event.channel is not None})
    axes = ", ".join(CHANNELS[channel][-1] for channel in channels)
    if CHANNELS[channels[0]].startswith("gyro"):
        return _("gyros {axes}", axes=axes) if axes[1:] else _("gyro {axes}", axes=axes)
    return (
        _("accelerometers {axes}", axes=axes) if axes[1:] else _("accelerometer {axes}", axes=axes)
    )
