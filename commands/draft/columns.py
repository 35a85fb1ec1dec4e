"""What the columns of the logs are: time, sensors, labels, temperature, and what says so."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from commands.draft.raw_log import Name, RawLog, finite
from commands.draft.timing import grows, time_of
from commands.draft.triads import Triad, other_imus, sensor_named, sensors_among, threes, with_bits
from inertial.tables.errors import Refusal
from inertial.text.messages import _

INTERLEAVED_ROWS = 3  # mean length of runs of one word, up to which rows alternate
COUNT = re.compile(r"(number[ _]of[ _])?samples|counts?|n|mean_of", re.IGNORECASE)
TEMPERATURE = re.compile(
    r"temp|tmp|celsius|kelvin|fahrenheit|°[cf]|deg_?[cf](?![a-z])|^t_?[cf]$", re.IGNORECASE
)
FAHRENHEIT = re.compile(r"fahrenheit|°f|deg_?f(?![a-z])|[_ (]f\)?$", re.IGNORECASE)
PLAUSIBLE = {"degC": (-80.0, 150.0), "K": (190.0, 425.0), "degF": (-112.0, 302.0)}  # of an IMU


@dataclass(frozen=True)
class Named:
    """What sensor three columns are, accel or gyro, and what says so."""

    sensor: str
    evidence: str
    guessed: bool


@dataclass(frozen=True)
class Columns:
    """What the columns of logs of one kind are, and what says so."""

    time: tuple[Name | None, ...]  # of each log recorded together
    accel: Triad | None
    gyro: Triad | None
    label: Name | None  # the column whose words name manoeuvres
    evidence: str
    guessed: bool
    unused: tuple[Name, ...]  # columns of the first log
    temperature: tuple[Name, str] | None = None  # a column of the first log, and its unit
    mean_of: Name | None = None  # where each row is a mean: the number of its samples
    constant: tuple[Name, ...] = ()  # axes that read the same in all rows
    other_imus: tuple[tuple[Triad, Triad], ...] = ()  # accelerometers and gyros of each by name


def columns_of(group: Sequence[Sequence[RawLog]], sensor: Named | None = None) -> Columns:
    """What the columns of these logs are, which have the same; each may be of several files.

    `sensor`: the one whose three columns are all, where something else says so.

    Raises
    ------
    Refusal
        where nothing says which columns are sensors, or nothing changes in any
    """
    first = group[0]
    times = tuple(time_of(log) for log in first)
    label: Name | None = None
    candidates: list[Triad] = []
    others: list[Triad] = []
    still: set[Name] = set()
    changing: set[Name] = set()
    for file, log in enumerate(first):
        interleaved, own_label = _words_of(log)
        label = label if own_label is None else own_label
        constant = {
            name
            for name in log.columns
            if all(np.ptp(finite(together[file].columns[name])) == 0 for together in group)
        }
        clocks = {name for name, values in log.columns.items() if grows(values)}
        for rows in interleaved or (None,):
            found, left = threes(list(log.columns), clocks, constant)
            candidates += [with_bits(group, Triad(file, three, rows)) for three in found]
            others += [Triad(file, three, rows) for three in left]
        still |= constant
        changing |= set(log.columns) - constant - clocks
    if not changing:
        raise _nothing_changes(first[0])
    if sensor is not None and candidates:
        accel = candidates[0] if sensor.sensor == "accel" else None
        gyro = candidates[0] if sensor.sensor == "gyro" else None
        evidence, guessed = sensor.evidence, sensor.guessed
    else:
        accel, gyro, evidence, guessed = sensors_among(group, candidates, others)
    used: set[Name | None] = {
        name for triad in (accel, gyro) if triad and not triad.file for name in triad.columns
    }
    warmth = _temperature_of(first[0])
    used |= {times[0]} if warmth is None else {times[0], warmth[0]}
    number = next((n for n in first[0].columns if COUNT.fullmatch(str(n))), None)
    unused = tuple(n for n in first[0].columns if n not in {*used, number})
    taken = [triad for triad in (accel, gyro) if triad is not None]
    return Columns(
        times,
        accel,
        gyro,
        label,
        evidence,
        guessed,
        unused,
        warmth,
        number,
        tuple(name for triad in taken for name in triad.columns if name in still),
        tuple(other_imus(first, candidates, taken)),
    )


def _nothing_changes(log: RawLog) -> Refusal:
    return Refusal(
        log.path.name,
        "",
        _("nothing changes: each column but the clock reads the same in all rows"),
        _("the readings of an IMU, which are never so still"),
        _("see whether the recorder wrote what the sensors read, and record it again"),
    )


def _words_of(log: RawLog) -> tuple[list[tuple[Name, str]], Name | None]:
    """The words that select the rows of a sensor, and the column whose words label stretches."""
    rows: list[tuple[Name, str]] = []
    label = None
    for name, words in log.words.items():
        runs = 1 + sum(a != b for a, b in pairwise(words))
        different = sorted(set(words))
        if len(different) == len(words):
            continue  # each row has a name of its own
        if len(different) > 1 and len(words) <= INTERLEAVED_ROWS * runs:
            rows += [(name, word) for word in different]
        elif len(different) > 1:
            label = name
        elif sensor_named(different[0]):
            rows.append((name, different[0]))
    return rows, label


def _temperature_of(log: RawLog) -> tuple[Name, str] | None:
    """The column that is named a temperature and reads one, with its unit."""
    for name, values in log.columns.items():
        if isinstance(name, str) and TEMPERATURE.search(name):
            read = finite(values)
            units = ["degF"] if FAHRENHEIT.search(name) else ["degC", "K"]
            for unit, (least, most) in ((unit, PLAUSIBLE[unit]) for unit in units):
                if least < read.min() and read.max() < most:
                    return name, unit
    return None
