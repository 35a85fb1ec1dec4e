"""Which logs belong together: recorded at the same time, of one sensor, with the same columns."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from commands.draft.columns import Named
from commands.draft.raw_log import Name, RawLog, finite
from commands.draft.timing import seconds_of, time_of
from commands.draft.triads import sensor_named
from inertial.arrays import Array
from inertial.tables.errors import Refusal
from inertial.text.messages import _
from inertial.text.numbers import significant

MIN_SHARED_TIME = 0.8  # of two logs of one recording, which were not begun at the same moment
WHOLE_IMU = 6  # columns, and a clock: a log that lacks no sensor
MAX_UNSTEADY = 0.3  # scatter of |f| of accelerometers that are turned over by hand, relative
MAX_SHARE_OF_GRAVITY = 0.3  # of the lengths in the other logs: no accelerometer reads so little
OTHER_SENSOR = re.compile(r"mag(?!i)|compass|baro", re.IGNORECASE)


def runs_of(log: RawLog) -> list[RawLog]:
    """A container of several matrices of one sensor holds as many recordings."""
    matrices: dict[str, dict[Name, Array]] = {}
    for name, values in log.columns.items():
        matrices.setdefault(str(name).rpartition(".")[0], {})[name] = values
    kinds = {sensor_named(matrix) for matrix in matrices}
    alone = all(len(columns) == 3 for columns in matrices.values())
    if len(matrices) < 2 or not alone or len(kinds) > 1 or not kinds <= {"accel", "gyro"}:
        return [log]
    return [replace(log, columns=columns) for columns in matrices.values()]


def recorded_together(logs: Sequence[RawLog]) -> list[tuple[RawLog, ...]]:
    """Logs of two sensors, each in a file of its own, that are one recording by their stamps.

    They have the same stamps, or they name one sensor each and cover the same time.
    """
    groups: list[list[RawLog]] = []
    for log in logs:
        alone = [group for group in groups if len(group) == 1]
        shared = [_shared(group[0], log) for group in alone]
        best = int(np.argmax(shared)) if shared else 0
        if shared and shared[best] > MIN_SHARED_TIME:
            alone[best].append(log)
        else:
            groups.append([log])
    return [tuple(group) for group in groups]


def _shared(one: RawLog, other: RawLog) -> float:
    """The share of the time of two logs that both cover; 0 where they are no pair of sensors."""
    names = time_of(one), time_of(other)
    sensors = _only_sensor(one), _only_sensor(other)
    alike = _signature(one) == _signature(other) and len(one.columns) > WHOLE_IMU
    if alike or (sensors[0] is not None and sensors[0] == sensors[1]):
        return 0.0  # stamps that begin at 0 in each log are the same, too
    if names[0] is None or names[1] is None:
        return 0.0
    ours, theirs = finite(one.columns[names[0]]), finite(other.columns[names[1]])
    if np.array_equal(ours, theirs):
        return 1.0
    if set(sensors) != {"accel", "gyro"}:
        return 0.0
    ours, theirs = finite(seconds_of(one, names[0])), finite(seconds_of(other, names[1]))
    both = min(ours.max(), theirs.max()) - max(ours.min(), theirs.min())
    either = max(ours.max(), theirs.max()) - min(ours.min(), theirs.min())
    return float(both / either)


def _only_sensor(log: RawLog) -> str | None:
    """The one sensor that the columns of a log name, or else its file does."""
    named = {kind for name in log.columns if (kind := sensor_named(str(name)))} & {"accel", "gyro"}
    return named.pop() if len(named) == 1 else None if named else sensor_named(log.path.stem)


def alike(tables: Sequence[Sequence[RawLog]]) -> list[list[Sequence[RawLog]]]:
    """The recordings by the columns that they have."""
    groups: dict[object, list[Sequence[RawLog]]] = {}
    for together in tables:
        key = tuple(_signature(log) for log in together)
        groups.setdefault(key, []).append(together)
    return list(groups.values())


def _signature(log: RawLog) -> object:
    layout: Mapping[str, object] = log.layout
    words = tuple(
        (n, tuple(sorted(set(w)))) for n, w in log.words.items() if sensor_named(w[0] if w else "")
    )
    return tuple(sorted(layout.items())), tuple(log.columns), words


def sensors_apart(
    group: Sequence[Sequence[RawLog]],
) -> Iterator[tuple[list[Sequence[RawLog]], Named | None]]:
    """The recordings with the same columns by the sensor that each holds, and what says so.

    Logs of three columns without names look alike; of which sensor they are is said by the names of
    the files, or by how much they read, where gravity is in the other logs.

    Raises
    ------
    Refusal
        where a log by its name is of another sensor
    """
    if not all(_of_one_sensor(together) for together in group):
        yield list(group), None
        return
    named = [_by_file_name(together[0]) for together in group]
    lengths = [np.linalg.norm(np.column_stack(_axes(together[0])), axis=1) for together in group]
    usual = np.array([float(np.nanmedian(own)) for own in lengths])
    steady = np.array([float(np.nanstd(own)) for own in lengths]) < MAX_UNSTEADY * usual
    steady &= np.array([each is None or each.sensor == "accel" for each in named])
    gravity = float(np.median(usual[steady])) if steady.any() else 0.0
    what = _(
        "by their size: gravity reads {length} in the other logs, far more than these do",
        length=significant(gravity),
    )
    small = usual < MAX_SHARE_OF_GRAVITY * gravity
    found: dict[Named | None, list[Sequence[RawLog]]] = {}
    for together, own, is_small in zip(group, named, small, strict=True):
        sensor = Named("gyro", what, True) if own is None and is_small else own
        found.setdefault(sensor, []).append(together)
    yield from ((logs, sensor) for sensor, logs in found.items())


def _of_one_sensor(together: Sequence[RawLog]) -> bool:
    """Whether a recording is one file with three columns beside its clock, none with a name."""
    log = together[0]
    no_names = all(isinstance(name, int) for name in log.columns) and not log.words
    return len(together) == 1 and no_names and len(_axes(log)) == 3


def _axes(log: RawLog) -> list[Array]:
    clock = time_of(log)
    return [values for name, values in log.columns.items() if name != clock]


def _by_file_name(log: RawLog) -> Named | None:
    stem = log.path.stem
    sensor = sensor_named(stem)
    if sensor in ("accel", "gyro"):
        return Named(str(sensor), _("by the names of their files"), False)
    if not OTHER_SENSOR.search(stem):
        return None
    raise Refusal(
        log.path.name,
        "",
        _("three columns of another sensor, by the name of the file"),
        _("accelerometers or gyros"),
        _("leave the log out; or rename it, such as accelerometers.csv or gyros.csv"),
    )
