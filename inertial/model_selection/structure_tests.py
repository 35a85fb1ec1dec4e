"""Whether the residuals of a refit still have a structure, whatever its cause."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.probability import chi2_isf, chi2_sf, f_sf
from inertial.model_selection.evidence import searched_effect
from inertial.model_selection.null_simulation import chance
from inertial.model_selection.scan import SEEN, Candidates

# ---- The functions of the tests.

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

SMOOTH = 6  # half waves of a smooth course over the whole campaign
FREQUENCIES = 60  # of an oscillation in time, in steps of half a cycle per campaign
ORDERS = np.arange(0.5, 15.01, 0.5)  # of a ripple, cycles per turn: faster is in the spectrum
HARMONICS = (1, 2, 3)
RATES = 8  # bins between the fastest rates backward and forward
CHANGES = 60  # times of a change
FEWEST = 4  # readings, or rates, that a function needs


@dataclass(frozen=True)
class Where:
    """Where readings were taken: NaN where it is not known.

    `time`: (n,), s; `angle` of the table: (n,), rad; `up`: (n, 3), body axes; `temperature`:
    (n,), °C; `rate`: (n,), rad/s, what the channel is exposed to: of a gyro that about its own
    axis, of an accelerometer that of the table.
    """

    time: Array
    angle: Array
    rate: Array
    up: Array
    temperature: Array


@dataclass(frozen=True)
class Question:
    """Functions (n, k) in groups (g, w) of their columns, one of which may have a trace.

    `where`: (g,), the value of what is scanned; `independent`: the columns stand group after
    group, and groups are so many and so different that each is its own trial.
    """

    functions: Array
    groups: Integers
    where: Array
    independent: bool = False


Asking = Callable[[Where], Iterator[Question]]


def _one(functions: Array) -> Question:
    return Question(functions, np.arange(functions.shape[1])[None], np.array([np.nan]))


def _waves(phase: Array, where: Array) -> Question:
    """Cosine and sine of each column of `phase` (n, g), none where the phase is not known."""
    known = np.isfinite(phase)
    phase = np.where(known, phase, 0.0)
    functions = np.stack([known * np.cos(phase), known * np.sin(phase)], axis=2)
    count = phase.shape[1]
    groups = np.arange(2 * count).reshape(count, 2)
    return Question(functions.reshape(len(phase), 2 * count), groups, where, independent=True)


def _unit(x: Array) -> tuple[Array, float]:
    """From 0 to 1, NaN where not known; and the span."""
    low, high = np.nanmin(x), np.nanmax(x)
    return (x - low) / (high - low), float(high - low)


def _varies(x: Array) -> bool:
    return len(np.unique(x[np.isfinite(x)])) >= FEWEST


def of_time(read: Where) -> Iterator[Question]:
    """A smooth course, and oscillations."""
    if not _varies(read.time):
        return
    phase, span = _unit(read.time)
    half_waves = np.arange(1, SMOOTH + 1)
    yield _one(np.nan_to_num(np.cos(np.pi * phase[:, None] * half_waves)))
    # Faster than every second reading cannot be told from slower.
    count = min(FREQUENCIES, len(np.unique(read.time[np.isfinite(read.time)])) // 2)
    cycles = SMOOTH / 2 + np.arange(1, count + 1) / 2
    yield _waves(2 * np.pi * phase[:, None] * cycles, cycles / span)


def of_angle(read: Where) -> Iterator[Question]:
    """Harmonics of a turn, and ripples of any order."""
    if not _varies(read.angle):
        return
    harmonics = _waves(read.angle[:, None] * np.array(HARMONICS), np.array(HARMONICS, dtype=float))
    ripples = _waves(read.angle[:, None] * ORDERS, ORDERS)
    # What an angle of the table does to a rate goes with the rate as well.
    for weight in (np.ones(len(read.angle)), np.nan_to_num(read.rate)):
        yield _one(harmonics.functions * weight[:, None])
        yield replace(ripples, functions=ripples.functions * weight[:, None])


def of_rate(read: Where) -> Iterator[Question]:
    """Means of bins of the rate."""
    rate = read.rate
    if not np.any(np.nan_to_num(rate)):
        return
    fastest = float(np.nanmax(np.abs(rate)))
    bins = np.floor((rate / fastest + 1) / 2 * RATES * 0.999999)
    bins = np.where(np.isfinite(rate), bins, -1)
    bins = np.where(rate == 0, RATES, bins)
    yield _one((bins[:, None] == np.arange(RATES + 1)).astype(np.float64))


def of_attitude(read: Where) -> Iterator[Question]:
    """Linear and quadratic functions of the direction of up."""
    known = np.isfinite(read.up.sum(axis=1))
    if known.sum() < FEWEST:
        return
    x, y, z = np.where(known[:, None], read.up, 0.0).T
    ones = known.astype(np.float64)
    yield _one(np.column_stack([x, y, z, ones, x * x, y * y, x * y, x * z, y * z]))


def of_temperature(read: Where) -> Iterator[Question]:
    """A polynomial of the third degree."""
    if not _varies(read.temperature):
        return
    phase, _ = _unit(read.temperature)
    yield _one(np.nan_to_num(np.cos(np.pi * phase[:, None] * np.arange(1, 4))))


def of_change(read: Where) -> Iterator[Question]:
    """A step at any time: the generalised likelihood ratio."""
    times = np.unique(read.time[np.isfinite(read.time)])
    if len(times) < FEWEST:
        return
    between = (times[1:] + times[:-1]) / 2
    evenly = np.linspace(between[0], between[-1], CHANGES)
    chosen = between[np.unique(np.searchsorted(between, evenly))]
    known: Array = np.where(np.isfinite(read.time), read.time, -np.inf)
    steps: Array = np.where(known[:, np.newaxis] > chosen, 1.0, 0.0)
    yield Question(steps, np.arange(len(chosen))[:, None], chosen)


TESTS: dict[str, Asking] = {
    "time": of_time,
    "angle": of_angle,
    "rate": of_rate,
    "attitude": of_attitude,
    "temperature": of_temperature,
    "change": of_change,
}


# ---- Score tests of the residuals of a refit for structure of any cause.
#
# Each test asks whether functions of something (time, angle, rate, attitude, temperature) would
# explain the residuals. Residuals of a fit are not independent: if the model is right their
# covariance is I − H, H the projection of the fit, and so the functions T are judged by
# T'e ~ N(0, T'(I − H)T), Rao's score test. What the fit has absorbed already counts nothing.

LEVEL = 0.01  # accepted chance that any test fires where the model is right
DRAWS = 2000


@dataclass(frozen=True)
class Answer:
    """What the residuals of one sensor say of the functions of a question, on one of its axes.

    `kind`: of the test; `sensor`: gyro or accel; `information`: T'(I − H)T, (k, k), zero of
    what was fitted; `right`: T'e, (k,); `chi_squared` of `degrees`: the residuals themselves;
    `noise_degrees`: from which their sigma was estimated.
    """

    kind: str
    sensor: str
    axis: str
    question: Question
    information: Array
    right: Array
    chi_squared: float
    degrees: int
    noise_degrees: float = np.inf


@dataclass(frozen=True)
class Structure:
    """One test of structure.

    `kind`: time, angle, rate, attitude, temperature, or change; `sensor`, `axis`: where it is
    clearest; `where`: the time of a change, the frequency of an oscillation, the order of a
    ripple, else NaN; `p_value`: its own search over channels and scan accounted for; `fires`: at
    the level that all tests share; `answer`, `group`: the functions that explain most.
    """

    kind: str
    sensor: str
    axis: str
    where: float
    statistic: float
    degrees: int
    p_value: float
    possible: bool
    fires: bool
    answer: Answer | None = None
    group: int = 0

    @property
    def values(self) -> tuple[list[int], Array]:
        """The functions that explain the residuals best, and how much of each."""
        if self.answer is None:
            return [], np.zeros(0)
        chosen = self.answer.question.groups[self.group].tolist()
        block = self.answer.information[np.ix_(chosen, chosen)]
        return chosen, np.linalg.pinv(block, rcond=SEEN, hermitian=True) @ self.answer.right[chosen]


def structures(answers: Sequence[Answer], level: float = LEVEL, seed: int = 0) -> list[Structure]:
    """The six tests; together they fire in a share `level` of campaigns whose model is right."""
    found: dict[str, list[Structure]] = {kind: [] for kind in TESTS}
    for answer in answers:
        told = _tested(answer, seed)
        if told is not None:
            found[answer.kind].append(told)
    possible = sum(bool(some) for some in found.values())
    return [_together(kind, some, level / max(possible, 1)) for kind, some in found.items()]


def _together(kind: str, some: list[Structure], level: float) -> Structure:
    """The clearest of some answers, at a price for each of them."""
    if not some:
        return Structure(kind, "", "", np.nan, 0.0, 0, 1.0, False, False)
    best = min(some, key=lambda one: one.p_value)
    p_value = min(best.p_value * len(some), 1.0)
    return replace(best, p_value=p_value, fires=p_value < level)


def _tested(answer: Answer, seed: int) -> Structure | None:
    """The group of functions that explains most; none where all of them were fitted."""
    question = answer.question
    one = searched_effect(answer.kind, *question.groups)
    drops, degrees = Candidates([one]).drops(answer.information, answer.right)
    if not degrees.any():
        return None
    best = int(np.argmax(drops))
    drop, count = float(drops[best]), int(degrees[best])
    alone = _alone(drop, count, answer)
    searched = min(alone * int(np.sum(degrees > 0)), 1.0)
    if len(question.groups) > 1 and not question.independent:
        law = chance(answer.information, [one], LEVEL, DRAWS, seed).tails[0]
        searched = float(law(chi2_isf(alone, law.degrees)))
    where = float(question.where[best])
    return Structure(
        answer.kind,
        answer.sensor,
        answer.axis,
        where,
        drop,
        count,
        searched,
        True,
        False,
        answer,
        best,
    )


def _alone(drop: float, count: int, answer: Answer) -> float:
    """Chance of such a drop, the sigma known beforehand and from what is left over."""
    if np.isinf(answer.noise_degrees):
        return float(chi2_sf(drop, count))
    left = max(answer.degrees - count, 0)
    degrees = left + answer.noise_degrees
    rest = max(answer.chi_squared - drop, 0.0)
    # Residuals that are larger than the noise all over are no structure.
    variance = max((rest + answer.noise_degrees) / degrees, rest / left if left else 0.0)
    return float(f_sf(drop / count / variance, count, degrees))
