"""A bias that differs from stretch to stretch: a scatter, a random walk, or both."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.optimize import minimize, minimize_scalar

from inertial.estimation.elimination import Name, Part
from inertial.estimation.least_squares import LIKELIER, Estimate, Fitted, with_scatter

# ---- By what the readings of stretches differ beyond noise: a scatter, a random walk, or both.
#
# What the model lacks makes every stretch differ from the others by more than the noise, and
# sigmas of noise alone would promise too much. A scatter is the same from each stretch to any
# other. A random walk takes the bias the further the more time passes. The size of each is the
# one of largest restricted likelihood (Patterson & Thompson 1971), and each is there only if the
# likelihood asks for it. Stretches near in time are often alike otherwise too: at one position,
# or at one attitude, so that a sensor that feels gravity looks like a bias that walks; and so
# does a steady drift. Where one of these rivals is clearly likelier there is no walk, and the
# stretches have a scatter.

Array = NDArray[np.float64]
Deviance = Callable[[float], float]  # as a function of one size

SMALLEST, LARGEST = 0.1, 1e3  # of the noise of a stretch: sizes that no data show, and beyond all
STEP = 4.0  # ratio of one size to the next, where the largest likelihood is looked for
FLAT = 3.0  # of the deviance: what the best size gains at most on the best of the steps
NEAR = 0.05  # relative: how near the size of largest likelihood is sought
CURVED = 0.2  # relative change of a size, for the curvature of the likelihood


@dataclass(frozen=True)
class Times:
    """What is known of the times of the stretches: s from first to last, by one clock or several.

    `noise`: of the mean reading of a stretch, so that sizes are sought about it; `largest`: random
    walk that is thought of, per √s: what is more, as by a hand, is a scatter.
    """

    noise: float
    span: float
    common: bool
    largest: float = np.inf

    @property
    def walks(self) -> tuple[float, float]:
        """Between which sizes a random walk is sought, per √s."""
        unit = self.noise / float(np.sqrt(self.span))
        return SMALLEST * unit, max(min(LARGEST * unit, self.largest), 2 * SMALLEST * unit)


def with_drift(
    fit: Callable[[float, float], Estimate],
    between: tuple[float, float],
    times: Times | None,
    rivals: Sequence[Deviance],
    noise_degrees: float,
) -> Fitted:
    """The fit with that scatter and that random walk which the data ask for.

    Parameters
    ----------
    fit : the estimate as a function of both
    between : smallest and largest scatter, in the unit of the readings
    times : None where the times are not known, and so no walk
    rivals : deviance by the size of other differences that look like a walk
    noise_degrees : see `Estimate.p_value`
    """
    scattered = with_scatter(lambda scatter: fit(scatter, 0.0), between, noise_degrees)
    if times is None:
        return scattered
    alone = fit(0.0, 0.0).deviance
    walk, deviance = likeliest(lambda size: fit(0.0, size).deviance, times.walks, alone)
    if alone - deviance < LIKELIER:
        return scattered
    # Little tells a walk from other differences where nothing is known of the time from log to log.
    by = -LIKELIER if times.common else LIKELIER
    sizes = (SMALLEST * times.noise, LARGEST * times.noise)
    plain = likeliest(lambda size: fit(size, 0.0).deviance, sizes, np.inf)
    others = [plain[1], *(likeliest(rival, sizes, np.inf)[1] for rival in rivals)]
    if min(others) - by < deviance:
        if scattered.scatter or alone - plain[1] < LIKELIER:
            return scattered
        return replace(scattered, estimate=fit(plain[0], 0.0), scatter=plain[0])
    scatter, walk = _both(fit, (scattered.scatter or times.noise, walk), deviance)
    return replace(
        scattered,
        estimate=fit(scatter, walk),
        scatter=scatter,
        walk=walk,
        walk_sigma=_sigma(fit, scatter, walk),
    )


def likeliest(deviance: Deviance, sizes: tuple[float, float], alone: float) -> tuple[float, float]:
    """The size of least deviance, and that deviance; rough where `alone` is about as likely."""
    low, high = np.log(sizes)
    steps = np.linspace(low, high, int(np.ceil((high - low) / np.log(STEP))) + 1)
    found = [deviance(float(np.exp(size))) for size in steps]
    best = int(np.argmin(found))
    if alone - found[best] < LIKELIER - FLAT:
        return float(np.exp(steps[best])), found[best]
    near = minimize_scalar(
        lambda size: deviance(float(np.exp(size))),
        bounds=(steps[max(best - 1, 0)], steps[min(best + 1, len(steps) - 1)]),
        method="bounded",
        options={"xatol": NEAR},
    )
    return float(np.exp(near.x)), float(near.fun)


def sigma_of(deviance: Deviance, size: float) -> float:
    """The sigma of a size by the curvature of its likelihood."""
    behind, here, ahead = (deviance(size * float(np.exp(CURVED * i))) for i in (-1, 0, 1))
    curvature = (ahead - 2 * here + behind) / CURVED**2
    return size * float(np.sqrt(2 / curvature)) if curvature > 0 else float("nan")


def _both(
    fit: Callable[[float, float], Estimate], start: tuple[float, float], deviance: float
) -> tuple[float, float]:
    """Scatter and random walk of largest likelihood; no scatter where the walk alone will do."""

    def together(sizes: Array) -> float:
        return fit(float(np.exp(sizes[0])), float(np.exp(sizes[1]))).deviance

    first = np.log(np.array(start))
    if deviance - together(first) < -LIKELIER:
        return 0.0, start[1]
    found = minimize(
        together,
        first,
        method="Nelder-Mead",
        options={"xatol": NEAR, "fatol": NEAR, "maxfev": 60},
    )
    if deviance - float(found.fun) < LIKELIER:
        return 0.0, start[1]
    return float(np.exp(found.x[0])), float(np.exp(found.x[1]))


def _sigma(fit: Callable[[float, float], Estimate], scatter: float, walk: float) -> float:
    """The sigma of the walk by the curvature of the likelihood, the scatter fitted beside it."""
    sizes = np.array([walk, scatter] if scatter else [walk])

    def deviance(moved: Array) -> float:
        changed = [*(sizes * np.exp(CURVED * moved)).tolist(), 0.0]
        return fit(changed[1], changed[0]).deviance

    unit = np.eye(len(sizes))
    curvature = np.zeros((len(sizes), len(sizes)))
    for i, j in np.ndindex(curvature.shape):
        mixed = deviance(unit[i] + unit[j]) + deviance(-unit[i] - unit[j])
        mixed -= deviance(unit[i] - unit[j]) + deviance(unit[j] - unit[i])
        curvature[i, j] = mixed / (2 * CURVED) ** 2
    variance = float(2 * np.linalg.inv(curvature)[0, 0])
    return walk * float(np.sqrt(variance)) if variance > 0 else float("nan")


# ---- A bias that differs from stretch to stretch of a campaign: at random, or because it walks.
#
#     bias of a stretch = bias + d,    d = scatter + mean of K W(t) over the stretch
#
# W is Brownian. So over a stretch of T seconds, G seconds after the one before, from p at the end
# of that to e at its own, the mean m and e have the covariance
#
#     cov [m − p, e − p] = K² [[G + T/3, G + T/2], [G + T/2, G + T]].
#
# Of every stretch d and e are unknowns, for each axis. The walk is 0 at the end of the stretch
# that is nearest to the middle of the campaign, so the bias is that of then. Where logs have no
# common clock each has a walk of its own, which comes from as far as that of all recorded time
# leads.
#
# Source: IEEE Std 952-2020, rate random walk.

COMMON = ""  # the clock of all logs, where they have one
FEWEST = 4  # stretches: fewer tell no random walk


@dataclass(frozen=True)
class Stretch:
    """A stretch of time in which the bias counts as one: a rest, a turn.

    `start`, `seconds`: s, NaN where not known; `clock`: by whose time; `weight`: how often it has
    the drift of its name.
    """

    name: str
    clock: str = COMMON
    start: float = np.nan
    seconds: float = np.nan
    weight: float = 1.0

    @property
    def end(self) -> float:
        """When it ends, s."""
        return self.start + self.seconds


def times_of(stretches: Sequence[Stretch], noise: float, largest: float) -> Times | None:
    """What their times can tell of a walk; None where too few stretches have one.

    `noise`: of the mean reading of a stretch; `largest`: walk that is thought of, per √s.
    """
    timed = [stretch for stretch in stretches if np.isfinite(stretch.end)]
    if len(timed) < FEWEST or not noise > 0:
        return None
    span = max(stretch.end for stretch in timed) - min(stretch.start for stretch in timed)
    return Times(noise, span, all(stretch.clock == COMMON for stretch in timed), largest)


def trend(stretches: Sequence[Stretch]) -> Callable[[Stretch], Stretch]:
    """Instead of a walk: a drift in proportion to the time before or after the middle."""
    start = float(np.nanmin([stretch.start for stretch in stretches]))
    span = float(np.nanmax([stretch.end for stretch in stretches])) - start

    def of(stretch: Stretch) -> Stretch:
        part = (stretch.start + stretch.seconds / 2 - start) / span - 0.5
        return Stretch("trend", weight=part if np.isfinite(part) else 0.0)

    return of


def drifting(
    parts: Sequence[tuple[Part, Stretch]],
    shared: int,
    bias: int,
    scatter: float,
    walk: float,
) -> tuple[list[Part], dict[Name, float]]:
    """Equations with the drifts as further errors, in an order in which few of them wait.

    Parameters
    ----------
    shared : how many unknowns all parts share; `bias`: the first of the three biases among them
    scatter, walk : unit of the readings; the same per √s

    Returns
    -------
    the parts, and the sigmas of those errors that are observations of zero
    """
    if not (scatter or walk):
        return [part for part, _ in parts], {}
    own: dict[Stretch, list[Part]] = {}
    for part, stretch in parts:
        own.setdefault(stretch, []).append(_drifted(part, stretch, shared, bias))
    walked = [s for s in own if walk and np.isfinite(s.end)]
    still = [s for s in own if not (walk and np.isfinite(s.end))]
    found = [part for stretch in still for part in own[stretch]]
    for stretch, relations in _paths(walked, shared, scatter, walk):
        found += [*relations, *own[stretch]]
    return found, {name: scatter for stretch in still for name in _drifts(stretch)}


def _drifts(stretch: Stretch) -> tuple[Name, ...]:
    return tuple((f"drift {i}", stretch.name) for i in range(3))


def _reached(stretch: Stretch) -> tuple[Name, ...]:
    return tuple((f"reached {i}", stretch.name) for i in range(3))


def _drifted(part: Part, stretch: Stretch, shared: int, bias: int) -> Part:
    """A drift is seen as the bias is."""
    rows = part.rows
    more = [rows[:, :-1], stretch.weight * rows[:, bias : bias + 3], rows[:, -1:]]
    return Part(np.hstack(more), (*part.own, *_drifts(stretch)), part.count, part.deviance)


def _paths(
    stretches: Sequence[Stretch], shared: int, scatter: float, walk: float
) -> Iterator[tuple[Stretch, list[Part]]]:
    """Every stretch in the order of time, with what its drift has to do with the others."""
    recorded = sum(stretch.seconds for stretch in stretches)
    by_clock: dict[str, list[Stretch]] = {}
    for stretch in stretches:
        by_clock.setdefault(stretch.clock, []).append(stretch)
    for clock, some in by_clock.items():
        path = sorted(some, key=lambda stretch: stretch.start)
        middle = (path[0].start + path[-1].end) / 2
        nearest = min(path, key=lambda stretch: abs(stretch.end - middle))
        before, left = tuple((f"reached {i}", f"start {clock}") for i in range(3)), path[0].start
        for stretch in path:
            relations = []
            if clock != COMMON and stretch is path[0]:
                away = np.array([[walk * np.sqrt(recorded)]])
                relations.append(_relation(np.ones((1, 1)), away, before, shared))
            gap, lasted = max(stretch.start - left, 0.0), stretch.seconds
            spread = np.array([[lasted / 3, lasted / 2], [lasted / 2, lasted]]) + gap
            spread = walk**2 * spread + np.diag([scatter**2, 0.0])
            lower: Array = np.linalg.cholesky(spread).astype(np.float64)
            mean, after = _drifts(stretch), _reached(stretch)
            change = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])
            if clock == COMMON and before == _reached(nearest):
                relations.append(_relation(change[:, 1:], lower, (*mean, *after), shared))
            elif clock == COMMON and stretch is nearest:
                relations.append(_relation(change[:, :2], lower, (*before, *mean), shared))
            else:
                relations.append(_relation(change, lower, (*before, *mean, *after), shared))
            yield stretch, relations
            before, left = after, stretch.end


def _relation(change: Array, lower: Array, names: tuple[Name, ...], shared: int) -> Part:
    """Changes of the drift, the same for three axes, whose covariance is lower · lowerᵀ."""
    rows = np.kron(solve_triangular(lower, change, lower=True), np.eye(3))
    nothing = np.zeros((len(rows), shared))
    deviance = 6 * float(np.sum(np.log(np.diag(lower))))
    return Part(np.hstack([nothing, rows, nothing[:, :1]]), names, 0, deviance)
