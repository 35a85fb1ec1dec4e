"""By what the readings of stretches differ beyond noise: a scatter, a random walk, or both.

What the model lacks makes every stretch differ from the others by more than the noise, and sigmas
of noise alone would promise too much. A scatter is the same from each stretch to any other. A
random walk takes the bias the further the more time passes. The size of each is the one of largest
restricted likelihood (Patterson & Thompson 1971), and each is there only if the likelihood asks for
it. Stretches near in time are often alike otherwise too: at one position, or at one attitude, so
that a sensor that feels gravity looks like a bias that walks; and so does a steady drift. Where one
of these rivals is clearly likelier there is no walk, and the stretches have a scatter.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize, minimize_scalar

from stages.inference.least_squares import LIKELIER, Estimate, Fitted, with_scatter

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
