"""Detection limits of every effect in a campaign, or why it is not observable."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inertial.estimation.effect_information import MIN_INFORMATION_SHARE
from inertial.model_selection.evidence import Evidence, SearchedEffect

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
    evidence = evidence.observable()
    return [
        _of_parameter(effect, parameter, [each[parameter] for each in of_candidates])
        for effect in effects
        for of_candidates in [[_of_columns(evidence, columns) for columns in effect.candidates]]
        for parameter in range(max((len(c) for c in effect.candidates), default=0))
    ]


_Limit = tuple[float, str, float]  # size, reason and share


def _of_parameter(effect: SearchedEffect, parameter: int, limits: Sequence[_Limit]) -> Visible:
    sizes, reasons, shares = zip(*limits, strict=True)
    finite = np.array([size for size in sizes if np.isfinite(size)])
    if not len(finite):
        order = (ONLY_TOGETHER, ABSORBED, NOT_EXCITED)
        reason = next((r for r in order if r in reasons), NOT_EXCITED)
        return Visible(effect.name, parameter, np.nan, np.nan, np.nan, reason, max(shares))
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


def _of_columns(evidence: Evidence, columns: Sequence[int]) -> list[_Limit]:
    """Of each parameter of a candidate."""
    if not evidence.sensors:
        return [(np.nan, NOT_EXCITED, np.nan)] * len(columns)
    total = evidence.total
    _, covariance = total.estimate(columns)
    limits: list[_Limit] = []
    for column, variance in zip(columns, np.diag(covariance).tolist(), strict=True):
        own, share = float(total.information[column, column]), np.nan
        if evidence.raw is not None:
            raw = float(evidence.raw[:, column].sum())
            share = own / raw if raw > 0 else np.nan
            if raw <= 0 or share <= MIN_INFORMATION_SHARE:
                limits.append((np.nan, ABSORBED if raw > 0 else NOT_EXCITED, share))
                continue
        elif own <= 0:
            limits.append((np.nan, NOT_EXCITED, share))
            continue
        seen = np.isfinite(variance)
        size = DETECTION_SIGMAS * float(np.sqrt(variance)) if seen else np.nan
        limits.append((size, VISIBLE if seen else ONLY_TOGETHER, share))
    return limits
