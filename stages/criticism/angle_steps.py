"""Steps of the angle: in one turn alone, by a slip or a single jump, and in each revolution.

A pulse of the rate has power at all frequencies, so one turn with it makes lines in time, and
ripples of "all" turns, at frequencies of which none is there. It is found first, and its stretch
is left out of the search for lines.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import degrees, erfc, sqrt

import numpy as np

from inertial.arrays import Array, Booleans, nearest_axis
from inertial.campaign.hypotheses import STEP_IN_TURN
from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.periodic_in_angle import Course
from inertial.model_selection.cause import FOUND
from inertial.signal.scatter import MAD_TO_SIGMA
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.numbers import fixed, plus_minus, significant
from stages.criticism.finding_rows import TableRow, finding_id, finding_row

MAX_SECONDS = 1.0  # that a step takes: a slower one is no more than a bias that drifts
MAX_SHARE = 1 / 8  # of a turn, that it takes: the rest tells how the residuals scatter
MIN_SAMPLES = 2  # of a step: a single reading that is off is a spike
# Far beyond noise: a smaller pulse has too little power at any one frequency to make a line.
MIN_SIGMAS = 8.0
EDGE_SECONDS = 0.1  # beside an end of the steady part, where a pulse may be of the ramp
EDGE_SIGMAS = 3.0  # of a few samples, down to which its stretch reaches
LEVEL_SIGMAS = 4.0  # from which the rate after it is another than before
MIN_LEVEL = 16  # samples, before or after it, that tell a level
MAX_STEPS = 3  # in one turn: what has more is no step, but rings or is noisy there
MAX_TURNS_SHARE = 1 / 4  # of the turns, that have one: what more have is of the table
MIN_OF_TABLE = 0.5  # of its size, that other turns have at the same angle of the table
ROUNDING = 1e-6  # of the largest change: below it readings are alike, as counts are that toggle


@dataclass(frozen=True)
class StepInTurn:
    """A step in one turn; vectors in the axes of the case.

    first, after : its samples in the steady part; from_s, to_s : in the time of the log
    matrix : (3, 3), M of the gyros
    angle : (3,), rad, by which the case turns further; sigma : rad, of its largest component
    sigmas : by how many a pulse of the rate exceeds the scatter; tried : pulses, in its turn
    """

    manoeuvre: str
    first: int
    after: int
    from_s: float
    to_s: float
    matrix: Array
    angle: Array
    sigma: float
    sigmas: float
    tried: int

    @property
    def axis(self) -> str:
        """The axis of the case about which most of it is."""
        return AXES[nearest_axis(self.angle)]

    @property
    def size(self) -> float:
        """By how much the case turns about that axis, rad."""
        return float(self.angle[AXES.index(self.axis)])

    def chance(self, turns: int) -> float:
        """That noise has such a pulse anywhere in so many turns."""
        return min(turns * self.tried * erfc(self.sigmas / sqrt(2)), 1.0)


def without_steps(turns: Sequence[SteadyTurn]) -> tuple[list[SteadyTurn], list[StepInTurn]]:
    """The turns, those with steps of their own without these; and the steps.

    What the table does at one angle it does in every turn, and is a ripple of it.
    """
    every = [(turn, *_quiet(turn)) for turn in turns]
    if sum(bool(own) for _turn, _quieted, own in every) > max(1.0, MAX_TURNS_SHARE * len(turns)):
        return list(turns), []
    kept, steps = list[SteadyTurn](), list[StepInTurn]()
    for turn, quiet, own in every:
        alone = not any(_of_table(step, turn, turns) for step in own)
        kept.append(quiet if alone else turn)
        steps += own if alone else []
    return kept, sorted(steps, key=lambda step: -step.sigmas)


def _quiet(turn: SteadyTurn) -> tuple[SteadyTurn, list[StepInTurn]]:
    """A turn without its steps; the turn itself where there are none, or too many."""
    quiet, steps = turn, list[StepInTurn]()
    while len(steps) <= MAX_STEPS:
        step = _largest(quiet)
        if step is None:
            return quiet, steps
        steps.append(step)
        quiet = _without(quiet, step)
    return turn, []


def _largest(turn: SteadyTurn) -> StepInTurn | None:
    """The pulse of the rate that exceeds the scatter of the turn most; None where none does.

    It rises above what is before it and above what is after it, which a bias that jumps does not.
    The scatter is that of all stretches as long, so that a drift, coloured noise or an oscillation,
    which have many of them, hide a pulse and are none.
    """
    if not np.isfinite(turn.rate):  # by hand, no rate is even
        return None
    n, best, tried = len(turn.truth), (MIN_SIGMAS, 0, 0, 0), 0
    longest = min(MAX_SECONDS / turn.step, MAX_SHARE * n)
    widths = [2**k for k in range(int(np.log2(longest)) + 1)] if longest >= 1 else []
    for axis in range(len(AXES)):
        if not turn.observes(np.eye(3)[axis]):
            continue
        record = turn.truth[:, axis]
        changes = np.diff(record)
        sigma = _scatter(changes) / sqrt(2)
        for width in widths if sigma > ROUNDING * np.abs(changes).max() else []:
            rises = _rises(_means(record, width), 2 * width)
            tried += rises.shape[1]
            scatter = max(*map(_scatter, rises), sigma * sqrt(2 / width))
            same = np.prod(np.sign(rises), axis=0) > 0
            exceeds = same * np.abs(rises).min(axis=0) / scatter
            edge = max(width, int(EDGE_SECONDS / turn.step))
            exceeds[:edge] = exceeds[-edge:] = 0.0
            first = int(np.argmax(exceeds))
            best = max(best, (float(exceeds[first]), axis, first, width))
    sigmas, axis, first, width = best
    if width < MIN_SAMPLES:
        return None
    start, after = _stretch(turn.truth[:, axis], first, width)
    angle, sigma = _angle(turn, start, after, axis)
    begin = turn.start + start * turn.step
    end = turn.start + after * turn.step
    return StepInTurn(turn.name, start, after, begin, end, turn.matrix, angle, sigma, sigmas, tried)


def _scatter(values: Array) -> float:
    """Sigma of most values, whatever a few do."""
    return MAD_TO_SIGMA * float(np.median(np.abs(values - np.median(values))))


def _means(record: Array, width: int) -> Array:
    """The means over `width` samples from each sample on, (n - width + 1,)."""
    sums = np.cumsum(np.append(0.0, record))
    return np.asarray((sums[width:] - sums[:-width]) / width)


def _rises(means: Array, apart: int) -> Array:
    """By how much each mean exceeds one before and one after it, (2, n); at an end the other."""
    before, after = np.roll(means, apart), np.roll(means, -apart)
    before[:apart], after[-apart:] = after[:apart], before[-apart:]
    return np.array([means - before, means - after])


def _stretch(record: Array, first: int, width: int) -> tuple[int, int]:
    """The samples of a pulse, to where a few of them are as small as noise; at most as much again.

    Its most significant part may be shorter, for it may begin softly.
    """
    few = max(1, width // 4)
    small = EDGE_SIGMAS * _scatter(record) / sqrt(few)
    means = np.abs(_means(record - np.median(record), few))
    start, after = first, first + width
    while start > max(0, first - 3 * width) and means[max(start - few, 0)] > small:
        start = max(start - few, 0)
    while after < min(len(record), first + 4 * width) and means[min(after, len(means) - 1)] > small:
        after += few
    return max(start - few, 0), min(after + few, len(record))


def _levels(turn: SteadyTurn, step: tuple[int, int]) -> tuple[Array, Array]:
    """The mean rates before and after a stretch, (3,) each; where one is too short the other's."""
    first, after = step
    parts = [part for part in (turn.truth[:first], turn.truth[after:]) if len(part) >= MIN_LEVEL]
    if not parts:
        return np.zeros(3), np.zeros(3)
    means = [part.mean(axis=0) for part in parts]
    return means[0], means[-1]


def _angle(turn: SteadyTurn, first: int, after: int, axis: int) -> tuple[Array, float]:
    """By how much the case turns further within a stretch, (3,), rad, and its sigma about an axis.

    Beyond what it does before and after.
    """
    middle = sum(_levels(turn, (first, after))) / 2
    count, others = after - first, len(turn.truth) - after + first
    angle = (turn.truth[first:after] - middle).sum(axis=0) * turn.step
    sigma = _scatter(turn.truth[:, axis]) * turn.step * sqrt(count * (1 + count / max(others, 1)))
    return np.asarray(angle), sigma


def _without(turn: SteadyTurn, step: StepInTurn) -> SteadyTurn:
    """The turn without the step: its stretch at the mean, and the rate after it as before.

    An IMU that has slipped sees a part of the table's rate with another axis than before. What does
    not show the step is left as it is.
    """
    before, later = _levels(turn, (step.first, step.after))
    n, truth = len(turn.truth), turn.truth.copy()
    shortest = max(min(step.first, n - step.after), MIN_LEVEL)
    sigma = np.array([_scatter(record) for record in truth.T])
    clear = np.abs(later - before) > LEVEL_SIGMAS * sigma * sqrt(2 / shortest)
    risen = np.where(clear, later - before, 0.0)
    truth[step.after :] -= risen
    rest = np.delete(truth, slice(step.first, step.after), axis=0)
    least = LEVEL_SIGMAS * sigma * turn.step * sqrt(step.after - step.first)
    turned = np.flatnonzero((np.abs(step.angle) > least) | clear)
    truth[step.first : step.after, turned] = rest.mean(axis=0)[turned]
    return replace(turn, truth=truth)


def _of_table(step: StepInTurn, turn: SteadyTurn, turns: Sequence[SteadyTurn]) -> bool:
    """Whether the other turns, and other revolutions, have it at the same angle of the table."""
    own = float(step.angle @ turn.about) * np.sign(turn.rate)
    if abs(own) < MIN_OF_TABLE * abs(step.size):  # it is about another axis than the table's
        return False
    ends = turn.angle[[step.first, step.after - 1]]
    middle, half = (
        float(ends.mean()),
        float(abs(ends[1] - ends[0])) / 2 + abs(turn.rate) * turn.step,
    )
    sizes, weights = list[float](), list[float]()
    for other in turns:
        if not np.isfinite(other.rate):
            continue
        apart = np.abs(np.mod(other.angle - middle + np.pi, 2 * np.pi) - np.pi)
        within = apart <= half
        if other is turn:
            within[max(step.first - 1, 0) : step.after + 1] = False
        if np.count_nonzero(within) * abs(other.rate) * other.step < half:
            continue
        record = other.along(other.about)
        record = (record - np.median(record)) * np.sign(other.rate)
        sizes.append(float(record[within].sum()) * other.step)
        weights.append(1 / (np.count_nonzero(within) * other.step**2 * _scatter(record) ** 2))
    if not sizes or not np.isfinite(weights).all():
        return False
    return bool(np.average(sizes, weights=weights) / own > MIN_OF_TABLE)


# ---- Their findings.


SENTENCE = _(
    "In {manoeuvre} alone the case turns further than the table by {size}° about {axis} within "
    "{seconds} s, at {time} s of the log: the IMU slips in its fixture, or the table jumps once."
)
CONSEQUENCE = _(
    "The angle of this turn is off by so much; if the IMU slipped, its axes point elsewhere in all "
    "that follows."
)
ACTION = _(
    "The stretch is left out of the search for oscillations. Fasten the IMU, look at the drive of "
    "the table, and record the turn again."
)


def step_rows(
    steps: Sequence[StepInTurn],
    turns: int,
    moves: Sequence[float | None],
    logs: Mapping[str, str],
    mount: str,
) -> Iterator[TableRow]:
    """A finding for each step; `turns`: how many were searched.

    `moves`: the largest shift of a parameter by each, in its sigma; `logs`: of the manoeuvres.
    """
    for number, (step, moved) in enumerate(zip(steps, moves, strict=True)):
        yield finding_row(
            STEP_IN_TURN,
            mount,
            id=finding_id(STEP_IN_TURN, mount, *([str(number + 1)] if number else [])),
            sensor="gyro",
            axis=step.axis,
            log=logs[step.manoeuvre],
            manoeuvre=step.manoeuvre,
            from_s=step.from_s,
            to_s=step.to_s,
            size=abs(step.size),
            unit="rad",
            p_value=step.chance(turns),
            sentence=_sentence(step),
            consequence=CONSEQUENCE,
            action=ACTION,
            verdict=FOUND,
            statistic=step.sigmas**2,
            degrees=1,
            snr=step.sigmas,
            moves=moved,
        )


def _sentence(step: StepInTurn) -> str:
    return SENTENCE.format(
        manoeuvre=step.manoeuvre,
        size=plus_minus(degrees(step.size), degrees(step.sigma)),
        axis=step.axis,
        seconds=significant(step.to_s - step.from_s, 2),
        time=fixed((step.from_s + step.to_s) / 2, 2),
    )


# ---- A step of the table's angle at one place of each revolution, which has ripples of all orders.

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
