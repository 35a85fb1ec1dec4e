"""Readings that pile up at an extreme of a channel, as at the end of its range."""

import numpy as np
from scipy.special import bdtrc
from scipy.stats import hypergeom

from inertial.arrays import Array, Integers
from inertial.signal.runs import joined
from inertial.signal.scatter import MAD_TO_SIGMA

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
