"""The third part of the challenge: how large an effect is said to be, given that it was named.

An effect is named where it is large enough, so that its least-squares estimate is on average too
large. Of the draws of sufficient statistics in which the right class is named this part counts

    ratio      β̂ᵀ F β / βᵀ F β, the estimate along the true direction in units of the truth,
    intervals  the 95 % intervals of its parameters that hold the truth, and the joint ellipsoid,

by least squares and as the pipeline reports it. Where another member of the class is named first
the estimate is that of the member that was hidden, as the extension fits it; where a scan finds
another value than the true one, it is the estimate at that value.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import chi2

from inertial.estimation.effect_information import EffectInformation
from inertial.model_selection.cause import Cause
from inertial.model_selection.size_after_selection import corrected

Array = np.ndarray[Any, np.dtype[np.float64]]
Counts = dict[str, float]

SIGMAS, SHARE = 1.96, 0.95
WAYS_OF_ESTIMATING = ("least squares", "reported")
FIRST, MATE, SCANNED = "named first", "a class mate named first", "of all, with a scan"
NOTHING: Counts = dict.fromkeys(
    (
        "draws",
        "parameters",
        *(
            f"{what} {way}"
            for way in WAYS_OF_ESTIMATING
            for what in ("ratio", "squares", "inside", "ellipsoid")
        ),
    ),
    0.0,
)


@dataclass(frozen=True)
class Truth:
    """What was hidden.

    `columns`: what the laboratory makes of the effect, and their `sizes`; `values`: of the effect's
    parameters, in their units; `ratio`: the signal-to-noise ratio.
    """

    columns: Sequence[int]
    sizes: Array
    values: Array
    ratio: float


def counted(
    total: EffectInformation,
    causes: Sequence[Cause],
    mine: Cause,
    own: Sequence[int],
    truth: Truth,
) -> Counts:
    """One draw, for sums over many.

    Parameters
    ----------
    total : what the data say of all effects, of all sensors together
    causes : that are named, `mine` among them, the class of what was hidden
    own : the columns of what was hidden at the value of its scan that explains most
    """
    every = list(dict.fromkeys(column for cause in causes for column in cause.columns))
    place = {column: i for i, column in enumerate(every)}
    values, covariance = total.estimate(every)
    groups = {tuple(place[i] for i in cause.columns): cause.selected for cause in causes}
    after, changed = corrected(values, covariance, groups)
    others = [i for cause in causes if cause is not mine for i in cause.columns if i not in own]
    model = [*own, *others]
    plain, variance = total.estimate(model)
    if not (np.isfinite(plain).all() and np.isfinite(values).all()):
        return NOTHING
    size = np.sqrt(np.diag(total.information)[model])
    block = total.information[np.ix_(model, model)] / np.outer(size, size)
    across = total.information[np.ix_(model, every)] / size[:, None]
    follows = np.linalg.lstsq(block, across, rcond=None)[0] / size[:, None]
    reported = plain + follows @ (after - values)
    of_reported = variance + follows @ (changed - covariance) @ follows.T
    told = NOTHING | {"draws": 1.0, "parameters": float(len(own))}
    along = total.information[np.ix_(own, truth.columns)] @ truth.sizes / truth.ratio**2
    k = slice(0, len(own))
    for way, estimate, spread in (
        (WAYS_OF_ESTIMATING[0], plain[k], variance[k, k]),
        (WAYS_OF_ESTIMATING[1], reported[k], of_reported[k, k]),
    ):
        error, ratio = estimate - truth.values, float(estimate @ along)
        told[f"ratio {way}"], told[f"squares {way}"] = ratio, ratio**2
        inside = np.abs(error) < SIGMAS * np.sqrt(np.diag(spread))
        told[f"inside {way}"] = float(np.sum(inside))
        within = error @ np.linalg.solve(spread, error) < chi2.ppf(SHARE, len(own))
        told[f"ellipsoid {way}"] = float(within)
    return told


def summed(every: Iterable[Mapping[str, float]]) -> Counts:
    """The sums over draws, or over such sums."""
    told = dict(NOTHING)
    for one in every:
        told = {name: told[name] + one[name] for name in told}
    return told


def mean_ratio(counts: Counts, way: str) -> tuple[float, float]:
    """Mean of the ratio and its standard deviation."""
    draws = counts["draws"]
    mean = counts[f"ratio {way}"] / draws
    variance = max(counts[f"squares {way}"] / draws - mean**2, 0.0)
    return mean, float(np.sqrt(variance / draws))


def coverage(counts: Counts, way: str) -> float:
    """Share of the intervals of single parameters that hold the truth."""
    return counts[f"inside {way}"] / counts["parameters"]


def rows_of_page(statistics: Sequence[Mapping[str, Any]]) -> Iterable[Sequence[str]]:
    """The rows of the page: for each ratio all, and by what was named, least squares → reported."""
    for ratio in sorted({row["ratio"] for row in statistics if row["ratio"]}):
        own = [row for row in statistics if row["ratio"] == ratio]
        sorts = {"all": [s for row in own for s in (row["sizes"][FIRST], row["sizes"][MATE])]}
        sorts |= {sort: [row["sizes"][sort] for row in own] for sort in (FIRST, MATE, SCANNED)}
        for sort, some in sorts.items():
            counts = summed(some)
            if counts["draws"]:
                yield f"{ratio:g}", sort, f"{counts['draws']:.0f}", *_cells(counts)
        by_effect = {
            f"{row['effect']}, {row['plan']}": mean_ratio(counts, WAYS_OF_ESTIMATING[1])
            for row in own
            if (counts := summed([row["sizes"][FIRST], row["sizes"][MATE]]))["draws"] > 1
        }
        for sort, choose in (("smallest ratio", min), ("largest ratio", max)):
            name = choose(by_effect, key=lambda effect: by_effect[effect][0], default=None)
            if name is not None:
                mean, sigma = by_effect[name]
                yield f"{ratio:g}", f"{sort}: {name}", "", f"{mean:.3f} ± {sigma:.3f}", "", ""


def _cells(counts: Counts) -> Sequence[str]:
    ratios = [mean_ratio(counts, way) for way in WAYS_OF_ESTIMATING]
    shares = [coverage(counts, way) for way in WAYS_OF_ESTIMATING]
    joint = [counts[f"ellipsoid {way}"] / counts["draws"] for way in WAYS_OF_ESTIMATING]
    return (
        f"{ratios[0][0]:.3f} → {ratios[1][0]:.3f} ± {ratios[1][1]:.3f}",
        f"{shares[0]:.3f} → {shares[1]:.3f}",
        f"{joint[0]:.3f} → {joint[1]:.3f}",
    )
