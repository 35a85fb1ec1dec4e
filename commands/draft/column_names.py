"""What names of columns say: which sensor, which axis, and which IMU where there are several."""

import re
from collections.abc import Sequence
from itertools import takewhile

from commands.draft.raw_log import Name

NAMED = {
    "accel": re.compile(r"acc|^[af][ _.]?[xyz]\b|^[af]_|_[af][xyz]\b|specific force"),
    "gyro": re.compile(
        r"gyr|^[gw][ _.]?[xyz]\b|^[gw]_|_[gw][xyz]\b|omega|ang.*(vel|rate)|rotation|turn ?rate"
        r"|(roll|pitch|yaw)[ _.]?(rate|speed|vel)|rate[ _.]?(of )?(roll|pitch|yaw)"
    ),
    "other": re.compile(
        r"mag|compass|^[mqb][ _.]?[xyzw]\b|quat|euler|roll|pitch|yaw|pos|vel|gps|temp"
    ),
}
PROCESSED = re.compile(  # by a phone, of its sensors
    r"user|linear|gravity|motion|(?:^|[ _.])(?:lin|free)", re.IGNORECASE
)
OF_SENSOR = re.compile(  # parts of a name that tell sensor or axis, and not which IMU
    r"acc|gyr|omega|ang|vel|rate|rot|lin|force|^(roll|pitch|yaw|raw|cal)|^[afgw]?[xyz]?$|^[pqr]$"
)
AXES_IN_NAMES = (("x", "y", "z"), ("roll", "pitch", "yaw"), ("p", "q", "r"))
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
    angles.
    """
    names = [_plain(name) for name in three if isinstance(name, str)]
    if len(names) < 3:
        return ()
    behind = _without_shared_start([name[::-1] for name in _without_shared_start(names)])
    own = [name[::-1] for name in behind]
    if all(len(axis) == 1 for axis in own) and "".join(own) in DIGITS:
        return tuple(three)
    axes = next((axes for axes in AXES_IN_NAMES if sorted(axes) == sorted(own)), None)
    if axes is None or (axes[0] != "x" and sensor_of(three) != "gyro"):
        return ()
    return tuple(three[own.index(axis)] for axis in axes)


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
