"""The range that the header of a log states of a sensor, and whether its counts are of that size.

"accel +-4g, gyro +-500dps" and counts of 16 bits make 8192 in 1 g, and 65.5 or 57.1 in 1 °/s: by
the maker the largest count is the range itself, or a seventh more.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from commands.draft.scales import (
    MAX_COUNT_ERROR,
    MAX_OFF_WHOLE,
    USUAL_GYRO_COUNTS,
    Scale,
    are_counts,
    turn_misfit,
)
from commands.draft.series import Divided
from inertial.text.messages import _, listed
from inertial.text.numbers import significant
from inertial.text.units import DEGREE

BITS = re.compile(r"(?<!\d)(\d\d)[ -]?bits?(?![a-z])", re.IGNORECASE)  # of a converter
OF_PROCESSORS = ("32", "64")  # bits, which no converter has
NUMBER = r"(?<![\d.,])(?<!\d/)(?P<range>\d+(?:\.\d+)?)"
RANGE = r"(?:range|full[ _-]?scale|\bfsr?\b|(?<![a-z])fsr?_|bereich|scale|±|\+/?-|\+\\-)"
PER_S = r"(?:dps|°/s|deg(?:rees?)?[ _]?(?:/[ ]?|per[ _]|_|p)s(?:ec(?:ond)?)?)(?![a-z/])"
GYRO_RANGES = (
    re.compile(NUMBER + r"[ _]?" + PER_S, re.IGNORECASE),
    re.compile(r"gyr\w*[^\d\n]{0,3}" + RANGE + r"[^\d\n,;]{0,8}" + NUMBER, re.IGNORECASE),
)
ACCEL_RANGES = (
    re.compile(RANGE + r"[^\d\n,;]{0,8}" + NUMBER + r"[ _]?g(?![a-z/])", re.IGNORECASE),
    re.compile(r"acc\w*[^\d\n,;]{0,16}" + NUMBER + r"[ _]?g(?![a-z/])", re.IGNORECASE),
    re.compile(r"acc\w*[^\d\n]{0,3}" + RANGE + r"[^\d\n,;]{0,8}" + NUMBER, re.IGNORECASE),
)
USUAL_GYRO_RANGES = (125.0, 245.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0)  # °/s
USUAL_ACCEL_RANGES = (2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0)  # g
SEVENTH_MORE = 8 / 7  # largest count to the range, of STMicroelectronics and some others
MAX_OFF_USUAL = 0.03  # of the size of a range from the one in data sheets: 250 °/s for 245
LEAST_BITS = 10


@dataclass(frozen=True)
class FullScale:
    """A stated range in words, and the counts in one of its unit that it makes, likelier first."""

    words: str
    counts: tuple[float, ...]

    def nearest(self, counts: float) -> float:
        """The size that is nearest to this one."""
        return min(self.counts, key=lambda each: abs(np.log(each / counts)))


def of_accel(header: Sequence[str]) -> FullScale | None:
    """The range of accelerometers, ± g; None where the header states none, or several."""
    most = _stated(header, ACCEL_RANGES, USUAL_ACCEL_RANGES)
    return None if most is None else FullScale(f"±{most:g} g", (_largest(header) / most,))


def of_gyro(header: Sequence[str]) -> FullScale | None:
    """The range of gyros, ± °/s; None where the header states none, or several."""
    most = _stated(header, GYRO_RANGES, USUAL_GYRO_RANGES)
    if most is None:
        return None
    sizes = [_largest(header) / most / more for more in (1.0, SEVENTH_MORE)]
    return FullScale(f"±{most:g} °/s", tuple(map(_usual, sizes)))


def _usual(size: float) -> float:
    near = min(USUAL_GYRO_COUNTS, key=lambda each: abs(each / size - 1))
    return near if abs(near / size - 1) < MAX_OFF_USUAL else float(f"{size:.4g}")


def _stated(
    header: Sequence[str], patterns: Sequence[re.Pattern[str]], usual: Sequence[float]
) -> float | None:
    """The one usual range among those that the lines state."""
    found = (float(m["range"]) for line in header for p in patterns for m in p.finditer(line))
    ranges = set(found) & set(usual)
    return ranges.pop() if len(ranges) == 1 else None


def _largest(header: Sequence[str]) -> float:
    """The largest count, with its half: of 16 bits where no others are stated."""
    bits = {m[1] for line in header for m in BITS.finditer(line)} - set(OF_PROCESSORS)
    own = int(bits.pop()) if len(bits) == 1 else 16
    return float(2 ** ((own if own >= LEAST_BITS else 16) - 1))


def accel_in_range(accel: Scale, stated: FullScale | None) -> Scale:
    """The unit of accelerometers, which gravity shows, beside the stated range."""
    if stated is None or accel.counts is None or not accel.guessed or accel.increments:
        return accel
    size = stated.nearest(accel.counts)
    if abs(size / accel.counts - 1) < MAX_COUNT_ERROR:
        return replace(accel, counts=size, evidence=_agreed(accel, stated))
    doubt = _(
        "the header says {range}, by which {stated} counts are in 1 g, and gravity at rest makes "
        "it {shown}; which range was set, or of how many bits are the counts? The draft takes what "
        "gravity shows",
        range=stated.words,
        stated=significant(size, 5),
        shown=significant(accel.counts, 5),
    )
    return replace(accel, doubt=doubt)


def gyro_in_range(
    gyro: Scale, stated: FullScale | None, recordings: Sequence[Divided], *, moved: bool
) -> Scale:
    """The unit of gyros beside the stated range, which decides where no motion shows it.

    `moved`: gravity's direction, as it turns, has shown it.
    """
    values = np.concatenate([own.series.gyro for own in recordings])
    if stated is None or not gyro.guessed or gyro.increments or not are_counts(values):
        return gyro
    if moved or not gyro.doubt:  # by gravity, or by round turns
        size = stated.nearest(gyro.size_in_degrees)
        if abs(size / gyro.size_in_degrees - 1) < max(MAX_COUNT_ERROR, 2 * gyro.sigma):
            return replace(
                gyro, unit="deg/s", counts=size, evidence=_agreed(gyro, stated), doubt=""
            )
    own = min(stated.counts, key=lambda each: turn_misfit(recordings, DEGREE / each, np.pi / 2))
    fits = turn_misfit(recordings, DEGREE / own, np.pi / 2) < MAX_OFF_WHOLE
    if not moved and (gyro.doubt or fits):
        own = own if fits else stated.counts[0]
        what = _(
            "the header says {range}: counts, {counts} in 1 °/s",
            range=stated.words,
            counts=significant(own),
        )
        return replace(gyro, unit="deg/s", counts=own, evidence=what, doubt="")
    doubt = _(
        "the header says {range}, by which {stated} counts are in 1 °/s, and the motion makes it "
        "{shown}; which range was set? The draft takes what the motion shows",
        range=stated.words,
        stated=listed([significant(each) for each in stated.counts], last="or"),
        shown=significant(gyro.size_in_degrees),
    )
    return replace(gyro, doubt=doubt)


def _agreed(scale: Scale, stated: FullScale) -> str:
    return _(
        "{evidence}; the header says {range}, which is the same",
        evidence=scale.evidence,
        range=stated.words,
    )
