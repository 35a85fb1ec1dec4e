"""What a campaign could have seen of every effect, or why it cannot see it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.least_squares import MIN_INFORMATION_SHARE
from inertial.model_selection.evidence import Evidence, SearchedEffect

Array = NDArray[np.float64]

DETECTION_SIGMAS = 5.0  # size that a campaign detects

VISIBLE = "visible"
NOT_EXCITED = "not_excited"  # no reading changes
ABSORBED = "absorbed"  # the parameters and errors that are fitted do the very same
ONLY_TOGETHER = "only_together"  # with other parameters of the effect, not alone


@dataclass(frozen=True)
class Visible:
    """What the campaign could have seen of one parameter of an effect.

    `size`: five sigma in the parameter's unit with the effect's other parameters free, NaN
    where `reason` is not `visible`; `best`, `worst`: the same for the values of a scan at which
    it is seen best and worst; `share`: information that is left of its column when all else is
    fitted, NaN where the raw information is not known.
    """

    effect: str
    parameter: int
    size: float
    best: float
    worst: float
    reason: str
    share: float


def visible(evidence: Evidence, effects: Sequence[SearchedEffect]) -> list[Visible]:
    """For every parameter of every effect what would have been five sigma; the median of a scan."""
    return [
        _of_parameter(evidence, one, parameter)
        for one in effects
        for parameter in range(max((len(c) for c in one.candidates), default=0))
    ]


def _of_parameter(evidence: Evidence, effect: SearchedEffect, parameter: int) -> Visible:
    sizes, reasons, shares = [], [], []
    for columns in effect.candidates:
        size, reason, share = _of_column(evidence, columns, parameter)
        sizes.append(size)
        reasons.append(reason)
        shares.append(share)
    seen = np.array([size for size in sizes if np.isfinite(size)])
    if not len(seen):
        order = (ONLY_TOGETHER, ABSORBED, NOT_EXCITED)
        reason = next((r for r in order if r in reasons), NOT_EXCITED)
        share = max(shares, default=np.nan)
        return Visible(effect.name, parameter, np.nan, np.nan, np.nan, reason, share)
    middle = sizes.index(float(np.sort(seen)[len(seen) // 2]))
    return Visible(
        effect.name,
        parameter,
        sizes[middle],
        float(seen.min()),
        float(seen.max()),
        VISIBLE,
        shares[middle],
    )


def _of_column(
    evidence: Evidence, columns: Sequence[int], parameter: int
) -> tuple[float, str, float]:
    if not evidence.sensors:
        return np.nan, NOT_EXCITED, np.nan
    total = evidence.total
    own = float(total.information[columns[parameter], columns[parameter]])
    share = np.nan
    if evidence.raw is not None:
        raw = float(evidence.raw[columns[parameter]])
        if raw <= 0:
            return np.nan, NOT_EXCITED, np.nan
        share = own / raw
        if share <= MIN_INFORMATION_SHARE:
            return np.nan, ABSORBED, share
    elif own <= 0:
        return np.nan, NOT_EXCITED, share
    _, covariance = total.estimate(columns)
    variance = float(covariance[parameter, parameter])
    if not np.isfinite(variance):
        return np.nan, ONLY_TOGETHER, share
    return DETECTION_SIGMAS * float(np.sqrt(variance)), VISIBLE, share
