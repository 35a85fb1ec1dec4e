"""A channel at the end of its range."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from stages.detectors.channel_name import channel_name
from stages.detectors.detector import (
    UNITS,
    Array,
    Detector,
    Event,
    Log,
    Piece,
    Words,
)
from stages.detectors.piles import BETWEEN, pile_at_top
from stages.detectors.runs import joined
from stages.notation.numbers import counted, significant

FULL = tuple(2**bits - one for bits in (15, 19, 23, 31) for one in (0, 1))  # counts of converters
ROUNDED = 1 - 1e-9  # readings are counts times their size, rounded
SHORT = 20  # readings of a visit that can be bridged by a curve


@dataclass(frozen=True)
class Visit:
    """What is told of a visit.

    limit: unit of the channel; seconds: that its readings stand for; lost: integral beyond the
    limit by the cubic that continues the readings beside it, unit of the channel × s, NaN where
    the visit is too long for one.
    """

    limit: float
    seconds: float
    lost: float


class Saturation(Detector):
    """A channel that stands at the largest or the smallest value that it can read.

    It is known where the campaign states the limit, or the extreme is the full count of a
    converter. Otherwise a pile of readings at the largest or smallest value of the log tells it,
    where the noise is no less than a count, and the readings run into it: a value that they leap
    to is no end of a range, nor is zero.
    """

    name = "saturation"
    cause = "the motion went beyond the range of the sensor or of its converter"
    source = "MPU-6050 of the Universidad Nacional de Cuyo: gyros at ±32768 counts"
    costs = "a turn's angle is too small, and with it the scale factor"
    unit = "samples"
    severity = 3
    masks = True

    def finds(self, piece: Piece, log: Log) -> Iterator[Event]:
        for i in range(6):
            places, values = piece.channel(i)
            clipped = np.zeros(len(values), bool)
            chance: dict[float, float] = {}
            for sign, most in ((1.0, log.most[i]), (-1.0, -log.least[i])):
                upward = sign * values
                clipped |= upward >= ROUNDED * _known(sign, log, i)
                if not (upward[clipped] == most).any():
                    pile, p_value = pile_at_top(upward, most, log.quantum[i], log.noise[i])
                    clipped[pile] = True
                    chance[sign * most] = p_value
            for start, end in joined(np.flatnonzero(clipped), BETWEEN):
                limit = float(values[start])
                yield piece.event(
                    int(places[start]),
                    int(places[end - 1]) + 1,
                    float(clipped[start:end].sum()),
                    channel=i,
                    p_value=chance.get(limit),
                    facts=Visit(
                        limit, (end - start) * log.step, _lost(values, start, end, log.step)
                    ),
                )

    def tells(self, event: Event, name: str) -> Words:
        assert event.channel is not None
        visit, many = event.facts, event.size > 1
        what, unit = ("velocity", "m/s") if event.channel < 3 else ("angle", "rad")
        percent = abs(visit.limit) * visit.seconds / 100
        return Words(
            f"{name}: {counted(round(event.size), 'reading')} of {channel_name(event.channel)}"
            f" {'stand' if many else 'stands'} at {significant(visit.limit, 6)}"
            f" {UNITS[event.channel]}, the end of the range, from line {event.line} on.",
            f"The {what} over {'them' if many else 'it'} is too small by all that went beyond: "
            + (
                f"about {significant(visit.lost, 2)} {unit}, if the readings beside are continued."
                if np.isfinite(visit.lost)
                else f"{significant(percent, 2)} {unit} for each 1 % beyond."
                if np.isfinite(percent)
                else "how much, the log does not tell."
            ),
            f"{'The readings are' if many else 'The reading is'} masked. Turn more slowly, or"
            " choose a wider range.",
        )


def _known(sign: float, log: Log, i: int) -> float:
    """What the channel reads at its upper end, by the campaign or as a full count."""
    most = float(log.most[i] if sign > 0 else -log.least[i])
    count = float(log.count[i] if np.isfinite(log.count[i]) else log.quantum[i])
    if np.isfinite(count) and np.isclose(most / count, FULL, rtol=1e-7).any():
        return most
    return float(log.limit[i])


def _lost(values: Array, start: int, end: int, step: float) -> float:
    """What the cubic with the slopes beside a visit encloses beyond the limit."""
    if end - start > SHORT or start < 2 or end + 2 > len(values):
        return np.nan
    up, down = values[start - 1] - values[start - 2], values[end + 1] - values[end]
    lost = float((up - down) * np.sign(values[start]) * (end - start) ** 2 / 12 * step)
    return lost if lost > 0 else np.nan
