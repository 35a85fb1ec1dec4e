"""A step of the table's angle at one place of each revolution, which has ripples of all orders."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.periodic_in_angle import Course

MIN_ORDERS = 3  # ripples of whole orders, that one step may explain
LEAST_WIDTH = 2 * np.pi / 1440  # rad, in which a step is sought, or that of a sample
WIDTHS = (1, 2, 4, 8, 16, 32, 64)  # of these, over which it may go


@dataclass(frozen=True)
class StepPerTurn:
    """A step of the table's angle, rad, with its sigma; at, width: rad, from the start of a turn.

    drop: of chi-squared by it; turns: how many show it.
    """

    size: float
    sigma: float
    at: float
    width: float
    drop: float
    turns: int


def step_per_turn(turns: Sequence[SteadyTurn]) -> StepPerTurn | None:
    """The step that explains most of all turns whose angle is known; None where none covers one.

    A table whose angle jumps by S at θ₀ and runs back evenly over the rest of the turn is at

        θ + S (1/2 − x) = θ + Σ S / (πk) sin k(θ − θ₀),  x = (θ − θ₀) / 2π less whole turns,

    so its rate has S within the step, and there alone but for a constant, which is in the bias. The
    sum over the lines is coherent in it, so that it explains more than a few of them. Over how much
    of the turn it goes is unknown: of several widths the likeliest.
    """
    courses = [turn.course(turn.about) for turn in turns if np.isfinite(turn.rate)]
    if not courses:
        return None
    width = max(LEAST_WIDTH, *(abs(course.rate) * course.step for course in courses))
    bins = int(2 * np.pi / width)
    gained, information = np.zeros(bins), np.zeros((2, bins))
    for course in courses:
        place = _places(course, bins)
        variance = (course.sigma * course.step) ** 2
        risen = np.sign(course.rate) * course.rest * course.step
        gained += np.bincount(place, risen, bins) / variance
        information += np.bincount(place, minlength=bins) / variance
    best = max(
        (
            (_clearness(gained, information[0], count), count)
            for count in WIDTHS
            if count < bins / 8
        ),
        key=lambda pair: float(pair[0].max()),
    )
    first, count = int(np.argmax(best[0])), best[1]
    # What is steepest shows it best; all of it lies in a wider stretch, for it may begin softly.
    clearest = _fitted(courses, bins, first, count)
    whole = _fitted(courses, bins, first - count, 3 * count)
    if clearest is None or whole is None:
        return None
    at = (first + count / 2) * 2 * np.pi / bins % (2 * np.pi)
    return replace(whole, at=at, width=clearest.width, drop=clearest.drop)


def _fitted(courses: Sequence[Course], bins: int, first: int, count: int) -> StepPerTurn | None:
    """A step over some parts of a revolution by least squares; None where no turn has it all."""
    product, normal, seen = 0.0, 0.0, 0
    width = count * 2 * np.pi / bins
    for course in courses:
        within = (_places(course, bins) - first) % bins < count
        pulse = _pulse(course, within, width)
        if pulse is not None:
            own = course.less_slow(pulse)
            product += float(own @ course.rest) / course.sigma**2
            normal += float(own @ own) / course.sigma**2
            seen += 1
    if not normal:
        return None
    middle = first * 2 * np.pi / bins + width / 2
    return StepPerTurn(product / normal, normal**-0.5, middle, width, product**2 / normal, seen)


def _places(course: Course, bins: int) -> Array:
    """In which of so many equal parts of a revolution each sample lies, (n,)."""
    share = np.mod(course.angle / (2 * np.pi), 1.0)
    return np.asarray(np.minimum((share * bins).astype(np.int64), bins - 1))


def _clearness(gained: Array, information: Array, count: int) -> Array:
    """The drop of chi-squared by a step over `count` parts from each on, (bins,), roughly."""
    ends = [np.append(values, values[: count - 1]) for values in (gained, information)]
    product, weight = (np.convolve(values, np.ones(count), "valid") for values in ends)
    return np.asarray(np.where(weight > 0, product**2 / np.maximum(weight, 1e-300), 0.0))


def _pulse(course: Course, within: Booleans, width: float) -> Array | None:
    """The rate of a turn with a step of 1 rad over a width, rad; None where it is not all there."""
    if np.count_nonzero(within) * abs(course.rate) * course.step < width / 2:
        return None
    return np.asarray(within * (course.rate / width))
