"""Whether the residuals of a refit still have a structure, whatever its cause."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array, Integers
from inertial.estimation.probability import chi2_isf, chi2_sf, f_sf
from inertial.model_selection.evidence import searched_effect
from inertial.model_selection.null_simulation import chance
from inertial.model_selection.search import MIN_EIGENVALUE, Candidates
from inertial.physics.motion import without_leans

# ---- The functions of the tests.


HALF_WAVES = 6  # of a smooth function over the whole campaign
MAX_FREQUENCIES = 60  # of an oscillation in time, in steps of half a cycle per campaign
ORDERS = np.arange(0.5, 15.01, 0.5)  # of a ripple, cycles per turn: faster is in the spectrum
HARMONICS = (1, 2, 3)
RATE_BINS = 8  # between the fastest rates backward and forward
MAX_CHANGES = 60  # times of a change
MIN_DISTINCT = 4  # values that a function needs


@dataclass(frozen=True)
class Conditions:
    """The conditions of readings, NaN where not known.

    `time`: (n,), s; `angle` of the table: (n,), rad; `up`: (n, 3), body axes; `temperature`:
    (n,), °C; `rate`: (n,), rad/s, of a gyro that about its own axis, of an accelerometer
    that of the table.
    """

    time: Array
    angle: Array
    rate: Array
    up: Array
    temperature: Array


@dataclass(frozen=True)
class FunctionGroups:
    """Functions (n, k) in groups (g, w) of their columns, one of which may fit the residuals.

    `scan_values`: (g,), of the scanned variable; `independent`: columns are in the order of the
    groups, and groups are so many and so different that each counts as an independent trial.
    """

    functions: Array
    groups: Integers
    scan_values: Array
    independent: bool = False


FunctionFamily = Callable[[Conditions], Iterator[FunctionGroups]]


def _single_group(functions: Array) -> FunctionGroups:
    return FunctionGroups(functions, np.arange(functions.shape[1])[None], np.array([np.nan]))


def _waves(phase: Array, scan_values: Array) -> FunctionGroups:
    """Cosine and sine of each column of `phase` (n, g), none where the phase is not known."""
    known = np.isfinite(phase)
    phase = np.where(known, phase, 0.0)
    functions = np.stack([known * np.cos(phase), known * np.sin(phase)], axis=2)
    count = phase.shape[1]
    groups = np.arange(2 * count).reshape(count, 2)
    return FunctionGroups(
        functions.reshape(len(phase), 2 * count), groups, scan_values, independent=True
    )


def _unit(x: Array) -> tuple[Array, float]:
    """From 0 to 1, NaN where not known; and the span."""
    low, high = np.nanmin(x), np.nanmax(x)
    return (x - low) / (high - low), float(high - low)


def _varies(x: Array) -> bool:
    return len(np.unique(x[np.isfinite(x)])) >= MIN_DISTINCT


def of_time(readings: Conditions) -> Iterator[FunctionGroups]:
    """A smooth function, and oscillations."""
    if not _varies(readings.time):
        return
    phase, span = _unit(readings.time)
    half_waves = np.arange(1, HALF_WAVES + 1)
    yield _single_group(np.nan_to_num(np.cos(np.pi * phase[:, None] * half_waves)))
    # Above half the number of readings frequencies are aliased.
    count = min(MAX_FREQUENCIES, len(np.unique(readings.time[np.isfinite(readings.time)])) // 2)
    cycles = HALF_WAVES / 2 + np.arange(1, count + 1) / 2
    yield _waves(2 * np.pi * phase[:, None] * cycles, cycles / span)


def of_angle(readings: Conditions) -> Iterator[FunctionGroups]:
    """Harmonics of a revolution, and ripples of any order."""
    if not _varies(readings.angle):
        return
    harmonics = _waves(
        readings.angle[:, None] * np.array(HARMONICS), np.array(HARMONICS, dtype=float)
    )
    ripples = _waves(readings.angle[:, None] * ORDERS, ORDERS)
    # Errors of the angle of the table scale with the rate as well.
    for weight in (np.ones(len(readings.angle)), np.nan_to_num(readings.rate)):
        yield _single_group(harmonics.functions * weight[:, None])
        yield replace(ripples, functions=ripples.functions * weight[:, None])


def of_rate(readings: Conditions) -> Iterator[FunctionGroups]:
    """Means of bins of the rate."""
    rate = readings.rate
    if not np.any(np.nan_to_num(rate)):
        return
    fastest = float(np.nanmax(np.abs(rate)))
    bins = np.floor((rate / fastest + 1) / 2 * RATE_BINS * 0.999999)
    bins = np.where(np.isfinite(rate), bins, -1)
    bins = np.where(rate == 0, RATE_BINS, bins)
    yield _single_group((bins[:, None] == np.arange(RATE_BINS + 1)).astype(np.float64))


def of_attitude(readings: Conditions) -> Iterator[FunctionGroups]:
    """Linear and quadratic functions of the direction of up."""
    known = np.isfinite(readings.up.sum(axis=1))
    if known.sum() < MIN_DISTINCT:
        return
    x, y, z = np.where(known[:, None], without_leans(readings.up), 0.0).T
    constant = known.astype(np.float64)
    yield _single_group(np.column_stack([x, y, z, constant, x * x, y * y, x * y, x * z, y * z]))


def of_temperature(readings: Conditions) -> Iterator[FunctionGroups]:
    """A polynomial of the third degree."""
    if not _varies(readings.temperature):
        return
    phase, _ = _unit(readings.temperature)
    yield _single_group(np.nan_to_num(np.cos(np.pi * phase[:, None] * np.arange(1, 4))))


def of_change(readings: Conditions) -> Iterator[FunctionGroups]:
    """A step at any time: the generalised likelihood ratio."""
    times = np.unique(readings.time[np.isfinite(readings.time)])
    if len(times) < MIN_DISTINCT:
        return
    between = (times[1:] + times[:-1]) / 2
    evenly = np.linspace(between[0], between[-1], MAX_CHANGES)
    chosen = between[np.unique(np.searchsorted(between, evenly))]
    known: Array = np.where(np.isfinite(readings.time), readings.time, -np.inf)
    steps: Array = np.where(known[:, np.newaxis] > chosen, 1.0, 0.0)
    yield FunctionGroups(steps, np.arange(len(chosen))[:, None], chosen)


TESTS: dict[str, FunctionFamily] = {
    "time": of_time,
    "angle": of_angle,
    "rate": of_rate,
    "attitude": of_attitude,
    "temperature": of_temperature,
    "change": of_change,
}


# ---- Score tests of the residuals of a refit for structure of any cause.
#
# Each tests whether functions of a variable (time, angle, rate, attitude, temperature) explain the
# residuals. Residuals of a fit are not independent: if the model is right their covariance is
# I − H, H the projection of the fit, and so the functions T are tested by T'e ~ N(0, T'(I − H)T),
# Rao's score test. What the fit has already absorbed does not count.

SIMULATED = 0.01  # chance from which that of a scan of dependent trials is simulated
DRAWS = 2000


@dataclass(frozen=True)
class ScoreEquations:
    """Normal equations of functions in the residuals of one axis of a sensor.

    `kind`: of the test; `sensor`: gyro or accel; `information`: T'(I − H)T, (k, k), zero of
    what was fitted; `right`: T'e, (k,); `chi_squared` of `degrees`: the residuals themselves;
    `noise_degrees`: from which their sigma was estimated.
    """

    kind: str
    sensor: str
    axis: str
    tested: FunctionGroups
    information: Array
    right: Array
    chi_squared: float
    degrees: int
    noise_degrees: float = np.inf


@dataclass(frozen=True)
class Structure:
    """One test of structure.

    `kind`: time, angle, rate, attitude, temperature, or change; `sensor`, `axis`: where it is
    most significant; `scan_value`: the time of a change, the frequency of an oscillation, the
    order of a ripple, else NaN; `p_value`: the search over channels and scan accounted for;
    `detected`: at the level that all tests share; `equations`, `group`: the functions that
    explain most.
    """

    kind: str
    sensor: str
    axis: str
    scan_value: float
    statistic: float
    degrees: int
    p_value: float
    possible: bool
    detected: bool
    equations: ScoreEquations | None = None
    group: int = 0

    @property
    def values(self) -> tuple[list[int], Array]:
        """The functions that best explain the residuals, and their coefficients."""
        if self.equations is None:
            return [], np.zeros(0)
        chosen = self.equations.tested.groups[self.group].tolist()
        block = self.equations.information[np.ix_(chosen, chosen)]
        return chosen, np.linalg.pinv(
            block, rcond=MIN_EIGENVALUE, hermitian=True
        ) @ self.equations.right[chosen]


def structures(equations: Sequence[ScoreEquations], level: float, seed: int = 0) -> list[Structure]:
    """The six tests; any detects in a share `level` of the campaigns whose model is right."""
    tests: dict[str, list[Structure]] = {kind: [] for kind in TESTS}
    for of_axis in equations:
        test = _test(of_axis, seed)
        if test is not None:
            tests[of_axis.kind].append(test)
    possible = sum(map(bool, tests.values()))
    return [_combined(kind, each, level / max(possible, 1)) for kind, each in tests.items()]


def _combined(kind: str, tests: Sequence[Structure], level: float) -> Structure:
    """The most significant of the tests of the axes, with Bonferroni's correction."""
    if not tests:
        return Structure(kind, "", "", np.nan, 0.0, 0, 1.0, False, False)
    best = min(tests, key=lambda test: test.p_value)
    p_value = min(best.p_value * len(tests), 1.0)
    return replace(best, p_value=p_value, detected=p_value < level)


def _test(equations: ScoreEquations, seed: int) -> Structure | None:
    """The group of functions that explains most; none where all of them were fitted."""
    tested = equations.tested
    effect = searched_effect(equations.kind, *tested.groups)
    drops, degrees = Candidates([effect]).drops(equations.information, equations.right)
    if not degrees.any():
        return None
    best = int(np.argmax(drops))
    drop, count = float(drops[best]), int(degrees[best])
    alone = _alone(drop, count, equations)
    searched = min(alone * int(np.sum(degrees > 0)), 1.0)
    # With a larger chance it is no structure, however few the trials of a scan are.
    if len(tested.groups) > 1 and not tested.independent and alone < SIMULATED:
        law = chance(equations.information, [effect], SIMULATED, DRAWS, seed).tails[0]
        searched = float(law(chi2_isf(alone, law.degrees)))
    scan_value = float(tested.scan_values[best])
    return Structure(
        equations.kind,
        equations.sensor,
        equations.axis,
        scan_value,
        drop,
        count,
        searched,
        True,
        False,
        equations,
        best,
    )


def _alone(drop: float, count: int, equations: ScoreEquations) -> float:
    """p-value of a drop, with sigma from prior knowledge and from the remaining residuals."""
    if np.isinf(equations.noise_degrees):
        return float(chi2_sf(drop, count))
    remaining = max(equations.degrees - count, 0)
    degrees = remaining + equations.noise_degrees
    rest = max(equations.chi_squared - drop, 0.0)
    # Residuals that uniformly exceed the noise are no structure. Where they lie below it a filter
    # makes neighbouring blocks alike, which means of many do not gain by.
    variance = max(
        (rest + equations.noise_degrees) / degrees, rest / remaining if remaining else 0.0, 1.0
    )
    return float(f_sf(drop / count / variance, count, degrees))
