"""Which columns of the logs are time, accelerometers and gyros, and what says so.

Names decide where they name both sensors. Otherwise the motion does: a direction fixed in the
laboratory changes in body axes only as the gyros turn,

    dv/dt = −ω × v,

so the change of the accelerometers is a linear function of the products of both readings and of
each, and of no other three columns. A magnetometer obeys it too, and better: it does not feel how
the hand accelerates.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from commands.draft.gravity import sphere
from commands.draft.raw_log import Name, RawLog
from inertial.arrays import Array
from inertial.signal.signed_counts import bits_without_sign, signed
from inertial.tables.errors import Refusal
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY

BIN_ROWS = 10  # of a short mean
MIN_BINS = 60  # of them for the motion to say anything: three times its unknowns
MIN_EXPLAINED = 0.3  # share of the change of each axis of a direction that the gyros must explain
MAX_RESETS = 0.01  # share of steps in which a clock may stand or go back
MIN_ADVANCING = 0.5  # of the rows, in which a clock of several columns advances
CLOCK_PARTS = 20  # of a log, in each of which a clock advances alike
INTERLEAVED_ROWS = 3  # mean length of runs of one word, up to which rows alternate
MAX_UNSTEADY = 0.1  # typical change of |f| as a sensor is turned over, relative: its biases
MAX_TOGETHER = 0.9  # length of the mean direction of what turns over; 1 of what does not
OF_GRAVITY = (STANDARD_GRAVITY, 1.0, 1000.0, 100 * STANDARD_GRAVITY)  # 1 g in usual units
MAX_GYRO_RATIO = 10.0  # of the mean of gyros of an IMU that is turned over to their scatter
MIN_COUNTS = 64.0  # in 1 g, else powers of two
MAX_OFF_GRAVITY = 0.1  # of |f| to these, relative
NAMED = {
    "accel": re.compile(r"acc|^[af][ _.]?[xyz]\b|^[af]_|specific force"),
    "gyro": re.compile(r"gyr|^[gw][ _.]?[xyz]\b|^[gw]_|omega|ang.*(vel|rate)|rotation|turn ?rate"),
    "other": re.compile(
        r"mag|compass|^[mqb][ _.]?[xyzw]\b|quat|euler|roll|pitch|yaw|pos|vel|gps|temp"
    ),
}
PROCESSED = re.compile(r"user|linear|gravity|motion", re.IGNORECASE)  # by a phone, of its sensors
TIME = re.compile(
    r"time|stamp|^t$|sample|epoch|clock|^n$|^t[ _(\[]|^ms$|^us$|millis|micros", re.IGNORECASE
)
PACKETS = re.compile(r"packet|number|count|index|sequence|\bseq\b|frame|message", re.IGNORECASE)
COUNT = re.compile(r"(number[ _]of[ _])?samples|counts?|n|mean_of", re.IGNORECASE)
TEMPERATURE = re.compile(r"temp|tmp|celsius|kelvin|°c|deg_?c(?![a-z])|^t_?c$", re.IGNORECASE)
PLAUSIBLE = {"degC": (-80.0, 150.0), "K": (190.0, 425.0)}  # of an IMU
AXIS = re.compile(r"^(.*?)([xyz0-9])([^xyz0-9]*)$")
UNIT = re.compile(r"[_ ](m?g|m[/p_]?s_?2|m?dps|m?(rad|deg)[/p_]?s)$")  # behind a name


@dataclass(frozen=True)
class Triad:
    """Three columns of one log, and the word in a column of the rows that hold them, if any do.

    `bits`: of counts that are written without their sign.
    """

    file: int  # which log of those recorded together
    columns: tuple[Name, ...]
    rows: tuple[Name, str] | None = None
    bits: int | None = None

    def of(self, together: Sequence[RawLog]) -> Array:
        """The readings, (n, 3), of rows without a gap."""
        log = together[self.file]
        values = np.column_stack([log.columns[column] for column in self.columns])
        if self.rows is not None:
            column, word = self.rows
            values = values[np.array(log.words[column])[: len(values)] == word]
        if self.bits is not None:
            values = signed(values, self.bits)
        return np.asarray(values[np.isfinite(values).all(axis=1)])


def _with_sign(triad: Triad, group: Sequence[Sequence[RawLog]]) -> Triad:
    """The same with the bits of its counts, where these are written without their sign."""
    return replace(triad, bits=bits_without_sign([triad.of(together) for together in group]))


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


def time_of(log: RawLog) -> Name | None:
    """The column that grows steadily, a named one before others; None where none does.

    The messages of a receiver have one, however few they are.
    """
    if log.kind == "rawimus":
        return "time"
    growing = [
        name
        for name, values in log.columns.items()
        if _grows(values) and not _numbers_packets(name, values)
    ]
    named = [name for name in growing if TIME.search(str(name))]
    if len(named) > 1:  # a temperature T that rises stands still from row to row
        named.sort(key=lambda name: np.mean(np.diff(finite(log.columns[name])) > 0) < MIN_ADVANCING)
    return next(iter(named + growing), None)


def _numbers_packets(name: Name, values: Array) -> bool:
    """Whether a column by its name counts packets, of which not all are samples: no clock."""
    if not PACKETS.search(str(name)) or TIME.search(str(name)):
        return False
    steps = np.diff(finite(values))
    return not (values % 1).any() and len(steps) > 0 and 1 - np.mean(steps == 1) > MAX_RESETS


def _grows(values: Array) -> bool:
    """Whether values grow as a clock does: hardly ever back, as much in each part of the log."""
    values = values[np.isfinite(values)]
    if len(values) < 2 * CLOCK_PARTS:
        return False
    steps = np.diff(values)
    usual_step = np.median(steps)
    if usual_step > 0 and np.mean(steps == usual_step) >= 1 - MAX_RESETS:
        return True  # it counts, though it begin again at times
    if usual_step > 0 and (steps >= 0).all() and np.mean(steps < 2 * usual_step) >= 1 - MAX_RESETS:
        return True  # though the recording pause
    growth = np.diff(values[np.linspace(0, len(values) - 1, CLOCK_PARTS + 1).astype(int)])
    usual = float(np.median(growth))
    alike = np.abs(growth - usual) < usual / 2
    return bool(usual > 0 and np.mean(steps < 0) <= MAX_RESETS and alike.mean() >= 0.7)


def columns_of(group: Sequence[Sequence[RawLog]], sensor: Named | None = None) -> Columns:
    """What the columns of these logs are, which have the same; each may be of several files.

    `sensor`: the one whose three columns are all, where something else says so.

    Raises
    ------
    Refusal
        where nothing says which columns are sensors
    """
    first = group[0]
    times = tuple(time_of(log) for log in first)
    label: Name | None = None
    candidates: list[Triad] = []
    for file, log in enumerate(first):
        interleaved, own_label = _words_of(log)
        label = label if own_label is None else own_label
        constant = {
            name
            for name in log.columns
            if all(np.ptp(finite(together[file].columns[name])) == 0 for together in group)
        }
        clocks = {name for name, values in log.columns.items() if _grows(values)}
        pieces = _neighbours(list(log.columns), clocks | constant)
        for rows in interleaved or (None,):
            own = [Triad(file, three, rows) for three in _threes(pieces)]
            candidates += [_with_sign(triad, group) for triad in own]
    if sensor is not None and candidates:
        accel = candidates[0] if sensor.sensor == "accel" else None
        gyro = candidates[0] if sensor.sensor == "gyro" else None
        evidence, guessed = sensor.evidence, sensor.guessed
    else:
        accel, gyro, evidence, guessed = _sensors(group, candidates)
    used: set[Name | None] = {
        name for triad in (accel, gyro) if triad and not triad.file for name in triad.columns
    }
    warmth = _temperature_of(first[0])
    used |= {times[0]} if warmth is None else {times[0], warmth[0]}
    number = next((n for n in first[0].columns if COUNT.fullmatch(str(n))), None)
    unused = tuple(n for n in first[0].columns if n not in {*used, number})
    return Columns(times, accel, gyro, label, evidence, guessed, unused, warmth, number)


def _temperature_of(log: RawLog) -> tuple[Name, str] | None:
    """The column that is named a temperature and reads one, with its unit."""
    for name, values in log.columns.items():
        if isinstance(name, str) and TEMPERATURE.search(name):
            read = finite(values)
            for unit, (least, most) in PLAUSIBLE.items():
                if least < read.min() and read.max() < most:
                    return name, unit
    return None


def finite(values: Array) -> Array:
    """Those that are numbers; one zero where none is."""
    there = values[np.isfinite(values)]
    return there if len(there) else np.zeros(1)


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


def sensor_named(name: str) -> str | None:
    """The sensor that a name names: accel, gyro, other, or None."""
    plain = _plain(str(name))
    return next((kind for kind, pattern in NAMED.items() if pattern.search(plain)), None)


def _plain(name: str) -> str:
    """A name without its unit, in small letters; gyro[0] is gyro0, %float(GyroX) is gyrox."""
    name = re.sub(r"^\W*%\w+\((\w+)\)\W*$", r"\1", name)
    name = re.sub(r"\[(\d)\]", r"\1", name)
    return UNIT.sub("", re.sub(r"[\[(].*", "", name).strip().lower())


def _neighbours(names: Sequence[Name], without: AbstractSet[Name]) -> list[list[Name]]:
    """The columns that are left, those that stand side by side in the log together."""
    pieces: list[list[Name]] = [[]]
    last: Name | None = None
    for name in names:
        apart = isinstance(name, int) and isinstance(last, int) and name != last + 1
        if name in without or apart:
            pieces.append([])
        if name not in without:
            pieces[-1].append(name)
        last = name
    return [piece for piece in pieces if piece]


def _threes(pieces: Sequence[Sequence[Name]]) -> Iterator[tuple[Name, ...]]:
    """Three neighbours that may be the axes of a sensor: by their names, else all that could."""
    named = list(_named_threes([name for piece in pieces for name in piece]))
    if named:
        yield from named
        return
    for piece in pieces:
        windows = [tuple(piece[i : i + 3]) for i in range(len(piece) - 2)]
        yield from windows[::3] if len(piece) % 3 == 0 else windows


def _named_threes(names: Sequence[Name]) -> Iterator[tuple[Name, ...]]:
    for i in range(len(names) - 2):
        if axes := _axes_named(names[i : i + 3]):
            yield axes


def _axes_named(three: Sequence[Name]) -> tuple[Name, ...]:
    """Those that are named x, y, z, or by three numbers, of one sensor, in this order; or none."""
    parts = [AXIS.match(_plain(name)) for name in three if isinstance(name, str)]
    found = [part for part in parts if part]
    if len(found) < 3 or len({(p[1], p[3]) for p in found}) > 1:
        return ()
    axes = "".join(p[2] for p in found)
    if axes in ("".join(map(str, range(i, i + 3))) for i in range(8)):
        return tuple(three)
    return tuple(three[axes.index(axis)] for axis in "xyz") if sorted(axes) == list("xyz") else ()


def _sensors(
    group: Sequence[Sequence[RawLog]], candidates: Sequence[Triad]
) -> tuple[Triad | None, Triad | None, str, bool]:
    """Accelerometers and gyros among the candidates, what says so, and whether it is a guess."""
    by_name = _by_name(group[0], candidates)
    if {"accel", "gyro"} <= set(by_name):
        return by_name["accel"], by_name["gyro"], _named_by(by_name), False
    if len(candidates) > 1 and (moved := _by_motion(group, candidates)) is not None:
        accel, gyro, explained = moved
        return (
            accel,
            gyro,
            _(
                "by the motion: the gyros explain {percent:.0f} % of the change of gravity's "
                "direction, and no other columns do",
                percent=100 * explained,
            ),
            False,
        )
    if by_name:
        return by_name.get("accel"), by_name.get("gyro"), _named_by(by_name), False
    if not candidates:
        raise Refusal(
            group[0][0].path.name,
            "",
            _(
                "no three columns that could be the axes of a sensor; with numbers in nearly every "
                "row: {columns}",
                columns=", ".join(map(str, group[0][0].columns)),
            ),
            _("three columns of accelerometers or gyros"),
            _(
                "name the log itself; where rows of other messages are among those of the IMU, "
                "leave these out"
            ),
        )
    return _by_size(group, candidates)


def _by_name(together: Sequence[RawLog], candidates: Sequence[Triad]) -> dict[str, Triad]:
    found: dict[str, Triad] = {}
    for triad in sorted(candidates, key=lambda one: bool(PROCESSED.search(str(one.columns[0])))):
        kind = sensor_named(triad.rows[1]) if triad.rows else None
        if kind is None and isinstance(triad.columns[0], str):
            kind = sensor_named(triad.columns[0])
        if kind is None and len(candidates) <= len(together):  # the log holds nothing else
            kind = sensor_named(together[triad.file].path.stem)
        if kind in ("accel", "gyro"):
            found.setdefault(str(kind), triad)
    return found


def _named_by(found: Mapping[str, Triad]) -> str:
    """What names the sensors that were found by a name: columns, or files whose columns do not."""
    of_columns = all(t.rows or sensor_named(str(t.columns[0])) for t in found.values())
    return _("by their names") if of_columns else _("by the names of their files")


def _by_motion(
    group: Sequence[Sequence[RawLog]], candidates: Sequence[Triad]
) -> tuple[Triad, Triad, float] | None:
    """The pair of which one explains how the other changes direction, and the share explained."""
    binned = {
        triad: [short_means(triad.of(together)) for together in group] for triad in candidates
    }
    explained = {
        (accel, gyro): share
        for accel in candidates
        for gyro in candidates
        if not (accel.file == gyro.file and accel.rows == gyro.rows)
        or not set(accel.columns) & set(gyro.columns)
        for share in [explained_share(binned[accel], binned[gyro])]
        if share > MIN_EXPLAINED
    }
    if not explained:
        return None
    gyro = max(candidates, key=lambda g: max(explained.get((a, g), 0.0) for a in candidates))
    pairs = {a: share for (a, g), share in explained.items() if g == gyro}
    whole = {a: share for a, share in pairs.items() if _on_sphere(binned[a], binned[gyro])}
    # Of gravity and another direction, gravity is the one that the hand disturbs.
    accel = min(whole or pairs, key=lambda a: pairs[a])
    return accel, gyro, pairs[accel]


def short_means(values: Array) -> Array:
    """Means of BIN_ROWS rows each, (k, 3)."""
    k = len(values) // BIN_ROWS
    return np.asarray(values[: k * BIN_ROWS].reshape(k, BIN_ROWS, 3).mean(axis=1))


def explained_share(accel: Sequence[Array], gyro: Sequence[Array]) -> float:
    """The share of the change of a triad that products with another explain, of its worst axis."""
    changes, designs = [], []
    for a, w in zip(accel, gyro, strict=True):
        k = min(len(a), len(w))
        if k >= 3:
            a, w = a[:k], w[:k]
            changes.append((a[2:] - a[:-2]) / 2)
            rate = (w[:-2] + 2 * w[1:-1] + w[2:]) / 4
            designs.append(np.hstack([rate, a[1:-1]]))
    if not changes or sum(map(len, changes)) < MIN_BINS:
        return 0.0
    change, both = np.concatenate(changes), np.concatenate(designs)
    spread = both.std(axis=0)
    if not (spread > 0).all():
        return 0.0
    both = (both - np.median(both, axis=0)) / spread
    rate, place = both[:, :3], both[:, 3:]
    products = (rate[:, :, None] * place[:, None, :]).reshape(len(both), 9)
    design = np.hstack([products, both, np.ones((len(both), 1))])
    rest = change - design @ np.linalg.lstsq(design, change, rcond=None)[0]
    return float(np.min(1 - np.sum(rest**2, axis=0) / np.sum(change**2, axis=0)))


def _on_sphere(accel: Sequence[Array], gyro: Sequence[Array]) -> bool:
    """Whether the slow part of a triad keeps its distance from some centre."""
    points = []
    for a, w in zip(accel, gyro, strict=True):
        k = min(len(a), len(w))
        speed = np.linalg.norm(w[:k] - np.median(w[:k], axis=0), axis=1)
        points.append(a[:k][speed <= np.quantile(speed, 0.3)])
    _centre, radius, scatter = sphere(np.concatenate(points))
    return scatter < 0.1 * radius


def _by_size(
    group: Sequence[Sequence[RawLog]], candidates: Sequence[Triad]
) -> tuple[Triad | None, Triad | None, str, bool]:
    """Without names or motion: gravity keeps its length, wherever it points.

    So does what hardly changes at all, a pressure or a temperature; what changes its direction and
    keeps its length is surer, and then what has a length that gravity has in some unit.
    """
    sizes = {triad: _size([triad.of(together) for together in group]) for triad in candidates}
    accel = max(candidates, key=lambda triad: sizes[triad])
    others = [t for t in candidates if not set(t.columns) & set(accel.columns)]
    if sizes[accel].turns:  # gyros do not read the same all the time
        others = [t for t in others if sizes[t].ratio < MAX_GYRO_RATIO]
    if len(candidates) == 1 and not sizes[accel].turns and sizes[accel].ratio < 3:
        return None, accel, _("by their size: no gravity is in them"), True
    return (
        accel,
        next(iter(others), None),
        _("by their size: the length of the first hardly changes, as that of gravity"),
        True,
    )


class _Size(NamedTuple):
    """What makes a triad gravity, the surest first; ratio: its length to what changes in it."""

    turns: bool  # and keeps its length
    usual: bool  # length of 1 g in some unit
    ratio: float


def _size(recordings: Sequence[Array]) -> _Size:
    """How much the readings (n, 3) of each recording are like gravity."""
    means = np.array([own.mean(axis=0) for own in recordings])
    lengths = np.linalg.norm(means, axis=1)
    spread = np.concatenate([own.std(axis=0) for own in recordings])
    ratio = float(np.median(lengths) / (np.std(lengths) + np.median(spread) + 1e-300))
    points = np.concatenate([short_means(own) for own in recordings if len(own) >= BIN_ROWS])
    own = np.linalg.norm(points, axis=1)
    length = float(np.median(own))
    if not length > 0:
        return _Size(False, False, ratio)
    steady = float(np.median(np.abs(own / length - 1))) < MAX_UNSTEADY
    together = np.linalg.norm((points / np.maximum(own, 1e-3 * length)[:, None]).mean(axis=0))
    power = float(2.0 ** np.round(np.log2(length)))
    usual = [*OF_GRAVITY, *([power] if power >= MIN_COUNTS else [])]
    is_usual = any(abs(length / each - 1) < MAX_OFF_GRAVITY for each in usual)
    return _Size(bool(steady and together < MAX_TOGETHER), is_usual, ratio)
