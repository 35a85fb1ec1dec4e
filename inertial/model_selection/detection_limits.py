"""Detection limits of every effect in a campaign, or why it is not observable."""

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
ABSORBED = "absorbed"  # by the parameters and errors that are fitted
ONLY_TOGETHER = "only_together"  # with other parameters of the effect, not alone


@dataclass(frozen=True)
class Visible:
    """The detection limit of a parameter of an effect.

    `size`: five sigma in the parameter's unit with the effect's other parameters free, NaN
    where `reason` is not `visible`; `best`, `worst`: the smallest and largest over the values of
    a scan; `share`: of the information of its column that remains when all else is fitted, NaN
    where the raw information is not known.
    """

    effect: str
    parameter: int
    size: float
    best: float
    worst: float
    reason: str
    share: float


def visible(evidence: Evidence, effects: Sequence[SearchedEffect]) -> list[Visible]:
    """For every parameter of every effect five sigma; the median over a scan."""
    return [
        _of_parameter(evidence, effect, parameter)
        for effect in effects
        for parameter in range(max((len(c) for c in effect.candidates), default=0))
    ]


def _of_parameter(evidence: Evidence, effect: SearchedEffect, parameter: int) -> Visible:
    sizes, reasons, shares = [], [], []
    for columns in effect.candidates:
        size, reason, share = _of_column(evidence, columns, parameter)
        sizes.append(size)
        reasons.append(reason)
        shares.append(share)
    finite = np.array([size for size in sizes if np.isfinite(size)])
    if not len(finite):
        order = (ONLY_TOGETHER, ABSORBED, NOT_EXCITED)
        reason = next((r for r in order if r in reasons), NOT_EXCITED)
        share = max(shares, default=np.nan)
        return Visible(effect.name, parameter, np.nan, np.nan, np.nan, reason, share)
    middle = sizes.index(float(np.sort(finite)[len(finite) // 2]))
    return Visible(
        effect.name,
        parameter,
        sizes[middle],
        float(finite.min()),
        float(finite.max()),
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
