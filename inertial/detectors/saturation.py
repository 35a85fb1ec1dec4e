"""A channel at the end of its range."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import bdtrc

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
from inertial.signal.runs import MAX_LOST_RUN, joined
from inertial.signal.scatter import MAD_TO_SIGMA
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
                        (end - start) * log.interval,
                        _lost(values, start, end, log.interval),
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
    known = np.isfinite(log.interval)
    side = max(SIDE_READINGS, round(SIDE_S / log.interval)) if known else SIDE_READINGS
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


# ---- Readings that pile up at an extreme of a channel, as at the end of its range.

# Next counts below, whose readings are compared with those at the extreme
COMPARED_COUNTS = (8, 64, 512)
# Both ends of each channel, in one count and in two, in as many logs as S0 has
TESTS = 6 * 2 * 2 * len(COMPARED_COUNTS) * 12
MAX_CHANCE = 1e-6  # chance of a pile in a campaign
MAX_VISIT_BREAK = 8  # readings at the most between two visits that are one
# Of the readings of a pile in one run: it is no noise cut off, but one long visit
MAX_RUN_SHARE = 0.5
MIN_NOISE_COUNTS = 0.8  # counts of noise with that of rounding, which is up to 0.53 in increments
OUTSIDE_READINGS = 64  # readings before the first visit and after the last, and between them
# Readings before and after a visit, at the least, in which the channel must run up to the limit
SIDE_READINGS = 8
# Scatters of those readings: so far away from the limit it must have been
MIN_DISTANCE_SCATTER = 8.0
MAX_STRAYED_COUNTS = 4.0  # of the sum of readings at a limit: rounding, and the least dips below
MIN_FILLED_SHARE = 0.7  # of the counts from the median to the extreme: what noise fills of them
MAX_NOISE_SIGMA = 6.0  # from the median of steady readings: beyond it is the ramp beside them


def pile_at_top(
    values: Array,
    most: float,
    count: float,
    noise: float,
    width: int = 1,
    side: int = SIDE_READINGS,
) -> tuple[Integers, float]:
    """The readings at the largest value of a log, if they pile up there, and the chance of it.

    Where they cut off the noise of a steady reading: unclipped, what lies above would spread over
    as many counts as what lies as far below the median. Where more than half of the readings
    stand there: unclipped, no more lie at the very extreme than in each of the next counts below,
    so of N in the last m + 1 counts at most a share of 1/(m + 1) (binomial). Nothing can be said
    so of a channel whose noise is less than its count. A value that the readings leap to is no
    end of a range, nor is zero.

    Parameters
    ----------
    values : (n,), readings
    most : the largest in the log
    count : the smallest step, in the same unit
    noise : sigma of a reading
    width : how many of the largest values count as one: increments at a limit between two counts
        alternate, for what a count leaves over goes into the next
    side : readings beside a visit, at the most, in which the channel runs up to the limit
    """
    none = np.empty(0, np.int64)
    if most == 0 or not np.isfinite(count):
        return none, 1.0
    pile = np.flatnonzero(values > most - (width - 0.5) * count)
    if len(pile) < 2:
        return none, 1.0
    # Where the noise is less than a count, a steady turn stands at one value by right.
    scatter = _noise_beside(values, pile)
    if scatter < MIN_NOISE_COUNTS * width * count:
        return none, 1.0
    places = np.unique(
        np.clip(pile[:, None] + np.arange(-SIDE_READINGS, SIDE_READINGS + 1), 0, len(values) - 1)
    )
    near = values[places]
    near = near[near > np.median(near) - MAX_NOISE_SIGMA * scatter]  # not the ramp to a steady turn
    if _steady(near, most, count, width):
        chance = TESTS * _by_the_other_side(near, most, count, width)
    elif np.count_nonzero(np.diff(pile) == 1) >= len(pile) / 2 - 1:
        chance = TESTS * _by_what_is_below(values, most, count, width)
    else:
        return none, 1.0  # the crests of an oscillation: one reading each
    if chance < MAX_CHANCE and _runs_into(values, pile, noise, side):
        return pile, chance
    return none, 1.0


def _noise_beside(values: Array, pile: Integers) -> float:
    """The noise of the readings before, between and after the visits of a pile, ramps or not.

    Of white noise the differences of differences have 6 times the variance.
    """
    near = np.zeros(len(values), bool)
    for start, end in joined(pile, 2 * OUTSIDE_READINGS):
        near[max(start - OUTSIDE_READINGS, 0) : end + OUTSIDE_READINGS] = True
    for start, end in joined(pile, MAX_VISIT_BREAK):
        near[start:end] = False
    rough = np.diff(values, 2)[near[:-2] & near[1:-1] & near[2:]]
    if len(rough) < OUTSIDE_READINGS:  # nothing lies outside: what is not at the limit itself
        rough = np.diff(np.delete(values, pile), 2)
    return float(MAD_TO_SIGMA * np.median(np.abs(rough)) / np.sqrt(6)) if len(rough) else 0.0


def _steady(values: Array, most: float, count: float, width: int) -> bool:
    """Whether readings fill all counts from their median to the extreme: noise about one value."""
    upper = values[values >= np.median(values)]
    steps = (most - upper.min()) / count
    filled = len(np.unique(np.rint((most - upper) / count)))
    return bool(steps > width - 0.5 and filled > MIN_FILLED_SHARE * (steps + 1))


def _by_the_other_side(values: Array, most: float, count: float, width: int = 1) -> float:
    """The chance that all readings above a level fall into `width` counts, by those as far below.

    Noise is as wide upwards as downwards: of the N readings at the extreme, and of those that are
    as far below the mean or farther, the same share lies within so many counts. What that share is
    these few readings alone tell: that none of those beyond it is above has the hypergeometric
    chance (Fisher's exact test).
    """
    from scipy.stats import hypergeom  # here, for it takes longer to load than most stages run

    number = np.count_nonzero(values > most - (width - 0.5) * count)
    below = 2 * values.mean() - most
    beyond = np.count_nonzero(values < below - count / 2)
    within = np.count_nonzero(values <= below + (width - 0.5) * count) - beyond
    return float(hypergeom.sf(number - 1, number + within + beyond, number + within, number))


def _by_what_is_below(values: Array, most: float, count: float, width: int = 1) -> float:
    """The chance of so many readings in the largest counts, by those in the counts below them."""
    number = np.count_nonzero(values > most - (width - 0.5) * count)
    chance, filled = 1.0, 0.0
    for steps in COMPARED_COUNTS:
        together = np.count_nonzero(values > most - (steps + width - 0.5) * count)
        density = (together - number) / steps
        if density < filled:
            break  # the readings end before: they lie closer together than so many counts
        chance = min(chance, float(bdtrc(number - 1, together, width / (steps + width))))
        filled = density
    return chance


def _runs_into(values: Array, pile: Integers, noise: float, most: int) -> bool:
    """Whether a pile is noise cut off, or one visit that the channel runs into and out of.

    `most`: readings in which it does so.
    """
    start, end = max(joined(pile, 0), key=lambda run: run[1] - run[0])
    if end - start < max(MAX_RUN_SHARE * len(pile), SIDE_READINGS):
        return True
    start, end = max(joined(pile, MAX_VISIT_BREAK), key=lambda run: run[1] - run[0])
    sides = [
        np.abs(values[start] - side)
        for side in (values[max(start - most, 0) : start][::-1], values[end : end + most])
        if len(side) >= SIDE_READINGS
    ]
    return bool(sides) and all(_runs_away(away, noise) for away in sides)


def _runs_away(away: Array, noise: float) -> bool:
    """Whether readings beside a visit, nearest first, leave the limit without a leap.

    Parameters
    ----------
    away : (k,), by how much they differ from the limit
    """
    far = np.flatnonzero(away[SIDE_READINGS - 1 :] > MIN_DISTANCE_SCATTER * noise)
    if not len(far):
        return False
    change = np.abs(np.diff(away[: SIDE_READINGS + int(far[0])]))
    return bool(away[0] <= 2 * change.max())


def standing_at(values: Array, count: float, noise: float) -> tuple[Integers, float]:
    """The increments of a log, (n,), where they stand in its two largest counts, and the chance.

    At a limit between two counts all of them are the limit, and what a count leaves over goes into
    the next: so their sum goes up along a straight line, but where the deepest of the noise comes
    back below the limit. That of readings that are quiet by themselves strays from it.

    Parameters
    ----------
    noise : sigma of a reading in the other logs
    """
    none = np.empty(0, np.int64)
    steps = np.rint((values.max() - values) / count)
    standing = np.flatnonzero(steps < 2)
    if np.ptp(values) <= MIN_NOISE_COUNTS * count or len(standing) < OUTSIDE_READINGS:
        return none, 1.0
    start, end = max(joined(standing, 0), key=lambda run: run[1] - run[0])
    run = steps[start:end]
    strayed = float(np.ptp(np.cumsum(run - run.mean())))
    if len(run) < OUTSIDE_READINGS or strayed > MAX_STRAYED_COUNTS:
        return none, 1.0
    share = min(2 * count / (noise * np.sqrt(2 * np.pi)), 1.0)  # at the most, in two counts
    chance = float(TESTS * bdtrc(len(standing) - 1, len(values), share))
    return (standing, chance) if chance < MAX_CHANCE else (none, 1.0)
