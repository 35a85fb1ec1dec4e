"""A channel at the end of its range."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Integers
from inertial.signal.detector import (
    Description,
    Detector,
    Event,
    Log,
    Piece,
    names_of_axes,
    names_of_logs,
    read_in,
)
from inertial.signal.piled_readings import (
    MAX_VISIT_BREAK,
    SIDE_READINGS,
    pile_at_top,
    standing_at,
)
from inertial.signal.runs import MAX_LOST_RUN, joined
from inertial.text.messages import _
from inertial.text.numbers import counted, significant

# s, at the most: a motion that begins at 5 °/s² takes gravity away by 8 scatters of 1 mm/s² in it
SIDE_S = 1.0
MIN_LEAP_RATIO = 10.0  # times the changes beside a visit, by which readings leap to it and back
MAX_BEYOND = 1.25  # times the stated range, which is nominal: what readings of it may reach
MIN_EXCESS_SIGMA = 5.0  # of readings in a count, for the scatter of their number
# Counts of converters
CONVERTER_COUNTS = tuple(2**bits - less for bits in (15, 19, 23, 31) for less in (0, 1))
ROUNDING = 1 - 1e-9  # readings are counts times their size, rounded
MAX_INTERPOLATED = 20  # readings of a visit that can be bridged by a curve


@dataclass(frozen=True)
class Visit:
    """What the description of a visit to the limit needs.

    limit: unit of the channel; seconds: that its readings stand for; lost: integral beyond the
    limit by the cubic that continues the readings beside it, unit of the channel × s, NaN where
    the visit is too long for one; leapt: the readings leap to the limit and back, so they were
    spoilt, and those beside them were not cut off.
    """

    limit: float
    seconds: float
    lost: float
    leapt: bool


class Saturation(Detector):
    """A channel that stands at the largest or the smallest value that it can read.

    It is known where the campaign states the limit, or the extreme is the full count of a
    converter. Otherwise a pile of readings at the largest or smallest value of the log shows it,
    where the noise is no less than a count, and the readings run into it: a value that they leap
    to is no end of a range, nor is zero. Increments at a limit between two counts alternate
    between these. A log that does so nearly throughout stands at the limit where the channel is
    noisy in the other logs, and goes no farther in any.

    What is cut off is the upper part of the noise, so the mean of the readings left beside it is
    too small: of Gaussian noise σ whose upper half is masked, by σ √(2/π).

    Cause: the motion went beyond the range of the sensor or of its converter. The angle of a turn
    is too small, and with it the scale factor.
    """

    name = "saturation"
    source = "MPU-6050 of the Universidad Nacional de Cuyo: gyros at ±32768 counts"
    unit = "samples"
    severity = 3
    alike = "sensor"
    masks = True

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        for i in range(6):
            places, values = piece.channel(i)
            if not len(values):
                continue
            clipped = np.zeros(len(values), bool)
            chance: dict[float, float] = {}
            for sign, most in ((1.0, log.most[i]), (-1.0, -log.least[i])):
                upward = sign * values
                clipped |= upward >= ROUNDING * _known(sign, log, i)
                if not (upward[clipped] == most).any():
                    pile, p_value = _unstated(upward, most, log, i)
                    clipped[pile] = True
                    chance |= dict.fromkeys((sign * upward[pile]).tolist(), p_value)
            for start, end in joined(np.flatnonzero(clipped), MAX_VISIT_BREAK):
                limit = float(values[start])
                yield piece.event(
                    int(places[start]),
                    int(places[end - 1]) + 1,
                    float(clipped[start:end].sum()),
                    channel=i,
                    p_value=chance.get(limit),
                    facts=Visit(
                        limit,
                        (end - start) * log.step,
                        _lost(values, start, end, log.step),
                        _leapt(values, start, end, log.noise[i]),
                    ),
                )

    def censors(self, event: Event) -> bool:
        return not event.facts.leapt

    def describe(self, event: Event, name: str) -> Description:
        return self.describe_many([(name, event)])

    def describe_many(self, events: Sequence[tuple[str, Event]]) -> Description:
        name, largest = max(events, key=lambda pair: pair[1].size)
        assert largest.channel is not None
        number = round(sum(event.size for _, event in events))
        where = _("{name} from line {line} on", name=name, line=largest.line)
        if len({log for log, _ in events}) == 1 < len(events):
            where = _(
                "{count} places of {name}, the longest from line {line} on",
                count=len(events),
                name=name,
                line=largest.line,
            )
        elif len(events) > 1:
            where = _("{logs}, most of them in {where}", logs=names_of_logs(events), where=where)
        what, unit = (_("velocity"), "m/s") if largest.channel < 3 else (_("angle"), "°")
        scale, _unit = read_in(largest.channel)
        visit = largest.facts
        percent = scale * abs(visit.limit) * visit.seconds / 100
        lost = _("by an unknown amount")
        if np.isfinite(visit.lost):
            lost = _(
                "about {lost} {unit}, if the readings beside are continued",
                lost=significant(scale * visit.lost, 2),
                unit=unit,
            )
        elif np.isfinite(percent):
            lost = _(
                "{percent} {unit} for each 1 % beyond", percent=significant(percent, 2), unit=unit
            )
        axes, limit = names_of_axes(events), _limits([event for _, event in events])
        readings = counted(number, "reading")
        censored = any(not event.facts.leapt for _, event in events)
        return Description(
            _(
                "The {axes} reach the end of the range at {limit}: {counted} in {where}.",
                axes=axes,
                limit=limit,
                counted=readings,
                where=where,
            )
            if len({event.channel for _, event in events}) > 1
            else _(
                "The {axes} reaches the end of the range at {limit}: {counted} in {where}.",
                axes=axes,
                limit=limit,
                counted=readings,
                where=where,
            ),
            _(
                "The {what} over them is too small by all that went beyond: {lost}.",
                what=what,
                lost=lost,
            )
            + (
                _(" So is the mean of the readings left beside them, for noise is cut off.")
                if censored
                else ""
            ),
            (
                _(
                    "The readings are masked, and no mean of a turn or a static position in which "
                    "the channel is cut off is used; up to {most} in a row in a motion between "
                    "positions are interpolated from those beside them. Turn more slowly, or "
                    "choose a wider range.",
                    most=MAX_LOST_RUN,
                )
                if censored
                else _("The readings are masked. Look for what spoils them.")
            ),
        )


def _unstated(upward: Array, most: float, log: Log, i: int) -> tuple[Integers, float]:
    """The readings at a limit that nothing states, and the chance of them."""
    count = float(log.quantum[i])
    known = np.isfinite(log.step)
    side = max(SIDE_READINGS, round(SIDE_S / log.step)) if known else SIDE_READINGS
    pile, p_value = pile_at_top(upward, most, count, log.noise[i], side=side)
    if log.increments and (not len(pile) or _alternates(upward, most, count)):
        wider, chance = pile_at_top(upward, most, count, log.noise[i], width=2, side=side)
        pile, p_value = (wider, chance) if len(wider) else (pile, p_value)
    in_no_other = most > log.reach[i] - 1.5 * count
    if not len(pile) and log.increments and in_no_other and log.usual_noise[i] > 0:
        return standing_at(upward, count, log.usual_noise[i])
    return pile, p_value


def _alternates(upward: Array, most: float, count: float) -> bool:
    """Whether the count next to the largest has clearly more readings than the one after it."""
    steps = np.rint((most - upward) / count)
    second, third = np.count_nonzero(steps == 1), np.count_nonzero(steps == 2)
    return bool(second > third + MIN_EXCESS_SIGMA * np.sqrt(third + 1))


def _limits(events: Sequence[Event]) -> str:
    """The ends of the range that events touch, without sign, in the unit of the sensor."""
    values = np.abs([event.facts.limit for event in events])
    gyros = (events[0].channel or 0) >= 3
    values, unit = (np.degrees(values), "°/s") if gyros else (values, "m/s²")
    ends = [significant(float(end), 5) for end in (values.min(), values.max())]
    return f"{ends[0]} {unit}" if ends[0] == ends[1] else f"{ends[0]} … {ends[1]} {unit}"


def _leapt(values: Array, start: int, end: int, noise: float) -> bool:
    """Whether a visit is a leap: away from the limit before and after, as noise and motion are not.

    By more than the readings beside change from one to the next, however fast the IMU turns up.
    """
    before, after = values[max(start - SIDE_READINGS, 0) : start], values[end : end + SIDE_READINGS]
    if min(len(before), len(after)) < 2:
        return False
    leap = min(abs(values[start] - before[-1]), abs(values[start] - after[0]))
    change = max(np.abs(np.diff(before)).max(), np.abs(np.diff(after)).max(), noise)
    return bool(leap > MIN_LEAP_RATIO * change)


def _known(sign: float, log: Log, i: int) -> float:
    """What the channel reads at its upper end, by the campaign or as a full count.

    A stated range that readings go well beyond is not theirs: another count size is theirs.
    """
    most = float(log.most[i] if sign > 0 else -log.least[i])
    count = float(log.count[i] if np.isfinite(log.count[i]) else log.quantum[i])
    if np.isfinite(count) and np.isclose(most / count, CONVERTER_COUNTS, rtol=1e-7).any():
        return most
    limit = float(log.limit[i])
    return limit if most <= MAX_BEYOND * limit else np.inf


def _lost(values: Array, start: int, end: int, step: float) -> float:
    """What the cubic with the slopes beside a visit encloses beyond the limit."""
    if end - start > MAX_INTERPOLATED or start < 2 or end + 2 > len(values):
        return np.nan
    up, down = values[start - 1] - values[start - 2], values[end + 1] - values[end]
    lost = float((up - down) * np.sign(values[start]) * (end - start) ** 2 / 12 * step)
    return lost if lost > 0 else np.nan
