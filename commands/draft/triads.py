"""Three columns of a log that are the axes of a sensor: which may be, and which sensor they are.

Names decide where they name both sensors. Otherwise the motion does: a direction fixed in the
laboratory changes in body axes only as the gyros turn,

    dv/dt = −ω × v,

so the change of the accelerometers is a linear function of the products of both readings and of
each, and of no other three columns. A magnetometer obeys it too, and better: it does not feel how
the hand accelerates.
"""

import re
from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from itertools import product, takewhile
from typing import NamedTuple

import numpy as np

from commands.draft.raw_log import Name, RawLog
from commands.draft.series import sphere
from inertial.arrays import Array
from inertial.signal.scale_factor import bits_without_sign, signed
from inertial.tables.errors import Refusal
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY

BIN_ROWS = 10  # of a short mean
MIN_BINS = 60  # of them for the motion to say anything: three times its unknowns
MIN_EXPLAINED = 0.3  # share of the change of each axis of a direction that the gyros must explain
MAX_UNSTEADY = 0.1  # typical change of |f| as a sensor is turned over, relative: its biases
MAX_TOGETHER = 0.9  # length of the mean direction of what turns over; 1 of what does not
OF_GRAVITY = (STANDARD_GRAVITY, 1.0, 1000.0, 100 * STANDARD_GRAVITY)  # 1 g in usual units
MAX_GYRO_RATIO = 10.0  # of the mean of gyros of an IMU that is turned over to their scatter
MIN_COUNTS = 64.0  # in 1 g, else powers of two
MAX_OFF_GRAVITY = 0.1  # of |f| to these, relative


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
        values = np.column_stack([log.column(name, self.rows) for name in self.columns])
        if self.bits is not None:
            values = signed(values, self.bits)
        return np.asarray(values[np.isfinite(values).all(axis=1)])

    def rows_in(self, together: Sequence[RawLog]) -> int:
        """How many rows its columns have, those with a gap too."""
        return len(together[self.file].column(self.columns[0], self.rows))

    def shares_columns(self, other: "Triad") -> bool:
        """Whether both have a column of the same rows."""
        same_rows = (self.file, self.rows) == (other.file, other.rows)
        return same_rows and not set(self.columns).isdisjoint(other.columns)


# ---- By names.


def threes(
    names: Sequence[Name], clocks: AbstractSet[Name], constant: AbstractSet[Name]
) -> tuple[list[tuple[Name, ...]], list[tuple[Name, ...]]]:
    """Three neighbours that may be the axes of a sensor: by their names, else all that could.

    Where some are by their names, the second list has all that could be among the other columns. A
    column that is constant may be one axis of a sensor by its name, or two, as of one that is dead.
    """
    there = [name for name in names if name not in clocks]
    changing = [name for name in there if name not in constant]
    named: dict[tuple[Name, ...], None] = {}
    for left in (changing, there):
        for i in range(len(left) - 2):
            axes = axes_named(left[i : i + 3])
            if axes and not set(axes) <= constant:
                named[axes] = None
    without = {*clocks, *constant, *(name for axes in named for name in axes)}
    found: list[tuple[Name, ...]] = []
    for piece in _neighbours(names, without):
        windows = [tuple(piece[i : i + 3]) for i in range(len(piece) - 2)]
        found += windows[::3] if len(piece) % 3 == 0 else windows
    return (list(named), found) if named else (found, [])


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


def with_bits(group: Sequence[Sequence[RawLog]], triad: Triad) -> Triad:
    """A triad with the bits of its counts, where they are written without their sign."""
    return replace(triad, bits=bits_without_sign([triad.of(together) for together in group]))


def sensors_among(
    group: Sequence[Sequence[RawLog]], candidates: Sequence[Triad], others: Sequence[Triad] = ()
) -> tuple[Triad | None, Triad | None, str, bool]:
    """Accelerometers and gyros among the candidates, what says so, and whether it is a guess.

    `others`: which may be a sensor that none of the candidates is by its name.
    """
    by_name = _by_name(group[0], candidates)
    if {"accel", "gyro"} <= set(by_name):
        return by_name["accel"], by_name["gyro"], _named_by(by_name), False
    moved = _by_motion(group, candidates, candidates) if len(candidates) > 1 else None
    if moved is None and by_name and others:
        unnamed = [with_bits(group, triad) for triad in others]
        accels, gyros = ([by_name[key]] if key in by_name else unnamed for key in ("accel", "gyro"))
        moved = _by_motion(group, accels, gyros)
    if moved is not None:
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
    """The first triad that is named for each sensor, of one IMU if several are named."""
    found = _all_by_name(together, candidates)
    pairs = list(product(*found.values()))
    best = next(
        (
            pair
            for pair in pairs
            if len({imu_named(triad.columns[0]) for triad in pair}) == 1
            and all(
                is_processed(a.columns[0]) == is_processed(b.columns[0])
                for a, b in zip(pair, pairs[0], strict=True)
            )
        ),
        pairs[0],
    )
    return dict(zip(found, best, strict=True))


def _all_by_name(together: Sequence[RawLog], candidates: Sequence[Triad]) -> dict[str, list[Triad]]:
    """The triads that are named for each sensor, what was processed behind the others."""
    found: dict[str, list[Triad]] = {}
    for triad in sorted(candidates, key=lambda triad: is_processed(triad.columns[0])):
        kind = sensor_named(triad.rows[1]) if triad.rows else None
        if kind is None and isinstance(triad.columns[0], str):
            kind = sensor_of(triad.columns)
        if kind is None and len(candidates) <= len(together):  # the log holds nothing else
            kind = sensor_named(together[triad.file].path.stem)
        if kind in ("accel", "gyro"):
            found.setdefault(str(kind), []).append(triad)
    return found


def other_imus(
    together: Sequence[RawLog], candidates: Sequence[Triad], taken: Sequence[Triad]
) -> list[tuple[Triad, Triad]]:
    """Accelerometers and gyros by name, beside those that are taken, of one other IMU each."""
    found = _all_by_name(together, candidates)
    used = {imu_named(triad.columns[0]) for triad in taken}
    return [
        (accel, gyro)
        for accel, gyro in product(found.get("accel", []), found.get("gyro", []))
        if not (is_processed(accel.columns[0]) or is_processed(gyro.columns[0]))
        and imu_named(accel.columns[0]) == imu_named(gyro.columns[0])
        and imu_named(accel.columns[0]) not in used
    ]


def _named_by(found: Mapping[str, Triad]) -> str:
    """What names the sensors that were found by a name: columns, or files whose columns do not."""
    of_columns = all(t.rows or sensor_of(t.columns) for t in found.values())
    return _("by their names") if of_columns else _("by the names of their files")


# ---- By motion.


def _by_motion(
    group: Sequence[Sequence[RawLog]], accels: Sequence[Triad], gyros: Sequence[Triad]
) -> tuple[Triad, Triad, float] | None:
    """The pair of which one explains how the other changes direction, and the share explained."""
    binned = {
        triad: [_short_means(triad.of(together)) for together in group]
        for triad in (*accels, *gyros)
    }
    explained = {
        (accel, gyro): share
        for accel, gyro in product(accels, gyros)
        if not accel.shares_columns(gyro)
        and (share := _explained_share(binned[accel], binned[gyro])) > MIN_EXPLAINED
    }
    if not explained:
        return None
    gyro = max(gyros, key=lambda g: max(explained.get((a, g), 0.0) for a in accels))
    pairs = {a: share for (a, g), share in explained.items() if g == gyro}
    whole = {a: share for a, share in pairs.items() if _on_sphere(binned[a], binned[gyro])}
    # Of gravity and another direction, gravity is the one that the hand disturbs.
    accel = min(whole or pairs, key=lambda a: pairs[a])
    return accel, gyro, pairs[accel]


def _short_means(values: Array) -> Array:
    """Means of BIN_ROWS rows each, (k, 3)."""
    k = len(values) // BIN_ROWS
    return np.asarray(values[: k * BIN_ROWS].reshape(k, BIN_ROWS, 3).mean(axis=1))


def _explained_share(accel: Sequence[Array], gyro: Sequence[Array]) -> float:
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


# ---- By size.


def _by_size(
    group: Sequence[Sequence[RawLog]], candidates: Sequence[Triad]
) -> tuple[Triad | None, Triad | None, str, bool]:
    """Without names or motion: gravity keeps its length, wherever it points.

    So does what hardly changes at all, a pressure or a temperature; what changes its direction and
    keeps its length is surer, and then what has a length that gravity has in some unit.
    """
    sizes = {triad: _size([triad.of(together) for together in group]) for triad in candidates}
    accel = max(candidates, key=sizes.__getitem__)
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
    points = np.concatenate([means[:0], *map(_short_means, recordings)])
    points = points if len(points) else means
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


# ---- What names of columns say: which sensor, which axis, and which IMU where there are several.

NAMED = {
    "accel": re.compile(r"acc|^[af][ _.]?[xyz]\b|^[af]_|_[af][xyz]\b|specific force"),
    "gyro": re.compile(
        r"gyr|^[gw][ _.]?[xyz]\b|^[gw]_|_[gw][xyz]\b|omega|ang.*(vel|rate)|rotation|turn ?rate"
        r"|(roll|pitch|yaw)[ _.]?(rate|speed|vel)|rate[ _.]?(of )?(roll|pitch|yaw)"
        r"|rate[ _.]?[pqr]\b|^[pqr][ _.]?rate"
    ),
    "other": re.compile(
        r"mag|compass|^[mqb][ _.]?[xyzw]\b|quat|euler|roll|pitch|yaw|pos|vel|gps|temp"
    ),
}
PROCESSED = re.compile(  # by a phone, of its sensors
    r"user|linear|gravity|motion|(?:^|[ _.])(?:lin|free)", re.IGNORECASE
)
OF_SENSOR = re.compile(  # parts of a name that tell sensor or axis, and not which IMU
    r"acc|gyr|omega|ang|vel|rate|rot|lin|force|^(roll|pitch|yaw|raw|cal)|^[afgw]?[xyz]?$|^[pqr]$|^(forward|fwd|front)$"
)
AXES_IN_NAMES = (("x", "y", "z"), ("roll", "pitch", "yaw"), ("p", "q", "r"))
FORWARD = ("forward", "fwd", "front")
SIDES = (("right", "down"), ("left", "up"))  # y and z beside x forward, right-handed
RATES = ("p", "q", "r")  # names of aeronautics: the rates about x, y and z
UNIT = re.compile(r"[_ ](m?g|m[/p_]?s_?2|m?dps|m?(rad|deg)[/p_]?s)$")  # behind a name
DIGITS = "0123456789"


def sensor_named(name: str) -> str | None:
    """The sensor that a name names: accel, gyro, other, or None."""
    plain = _plain(str(name))
    return next((kind for kind, pattern in NAMED.items() if pattern.search(plain)), None)


def _plain(name: str) -> str:
    """A name without its unit, in small letters; gyro[0] is gyro0, %float(GyroX) is gyrox."""
    name = re.sub(r"^\W*%\w+\((\w+)\)\W*$", r"\1", name)
    name = re.sub(r"\[(\d)\]", r"\1", name)
    return UNIT.sub("", re.sub(r"[\[(].*", "", name).strip().lower())


def axes_named(three: Sequence[Name]) -> tuple[Name, ...]:
    """Those that are named x, y, z, or by three numbers, of one sensor, in this order; or none.

    The names differ in the axis only: gyro_x, x_gyro, pitch rate. Roll, pitch and yaw alone are
    angles. Of forward, right and down the sensor has to be named.
    """
    own = _differing(three)
    if len(own) < 3:
        return ()
    if all(len(axis) == 1 for axis in own) and "".join(own) in DIGITS:
        return tuple(three)
    if (directions := _directions(own)) and sensor_of(three) in ("accel", "gyro"):
        return tuple(three[own.index(axis)] for axis in directions)
    axes = next((axes for axes in AXES_IN_NAMES if sorted(axes) == sorted(own)), None)
    if axes is None or (axes[0] != "x" and sensor_of(three) != "gyro"):
        return ()
    return tuple(three[own.index(axis)] for axis in axes)


def _differing(three: Sequence[Name]) -> list[str]:
    """In what names differ, without what all of them begin or end with; none of numbers."""
    names = [_plain(name) for name in three if isinstance(name, str)]
    behind = _without_shared_start([name[::-1] for name in _without_shared_start(names)])
    return [name[::-1] for name in behind]


def _directions(own: Sequence[str]) -> tuple[str, ...]:
    """Words in the order x, y, z where they are forward, right, down or forward, left, up."""
    x = next((word for word in own if word in FORWARD), "")
    return next(((x, *yz) for yz in SIDES if sorted((x, *yz)) == sorted(own)), ())


def directions_named(columns: Sequence[Name]) -> tuple[str, ...]:
    """The directions of x, y, z that the names of three columns say, such as right; or none."""
    found = _directions(_differing(columns))
    return ("forward", *found[1:]) if found else ()


def _without_shared_start(texts: Sequence[str]) -> list[str]:
    """Texts without the letters that all of them begin with."""
    letters = zip(*texts, strict=False)  # the shortest ends it
    shared = sum(1 for _same in takewhile(lambda own: len(set(own)) == 1, letters))
    return [text[shared:] for text in texts]


def sensor_of(columns: Sequence[Name]) -> str | None:
    """The sensor that the names of three columns name: accel, gyro, other, or None."""
    names = [_plain(str(name)) for name in columns]
    return "gyro" if sorted(names) == list(RATES) else sensor_named(str(columns[0]))


def is_processed(column: Name) -> bool:
    """Whether a column is what a phone computed from its sensors, by its name."""
    return bool(PROCESSED.search(str(column)))


def imu_named(column: Name) -> tuple[str, ...]:
    """What a name says beside sensor and axis: imu1_ax, left.gyro.x, acc2_z.

    It tells the IMU where a log holds several.
    """
    pieces = re.findall(r"[^\W\d_]+|\d+", _plain(str(column)))
    return tuple(piece for piece in pieces if not OF_SENSOR.search(piece))
