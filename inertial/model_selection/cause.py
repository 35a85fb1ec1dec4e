"""What is said of causes: those that were found, and every effect that was asked about."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FOUND = "found"
ONE_OF_CLASS = "one_of_class"
UNKNOWN_STRUCTURE = "unknown_structure"


@dataclass(frozen=True)
class Cause:
    """A cause that was found, or a class of which it is one.

    `effect`: the most probable; `value`: which candidate of its scan; `members`: all that
    cannot be told apart, the most probable first; `member_values`: the best candidate of the
    scan of each; `weights`: their posterior probabilities;
    `captured`: which share of the signal each can mimic; `statistic`: drop of chi-squared beside
    the other causes, on `degrees`; `p_value`: that noise brings any effect of the catalogue so
    far; `snr`: root of the drop less what noise adds; `columns`, `values`, `covariance`: of the
    parameters, estimated with those of the other causes.
    """

    effect: str
    value: int
    verdict: str
    members: tuple[str, ...]
    member_values: tuple[int, ...]
    weights: tuple[float, ...]
    captured: tuple[float, ...]
    statistic: float
    degrees: int
    p_value: float
    snr: float
    columns: tuple[int, ...]
    values: Array
    covariance: Array


@dataclass(frozen=True)
class EffectTest:
    """What the data say of an effect beside the causes that were found.

    `p_value`: its own search paid for; `after_search`: that of the whole catalogue too;
    `value`: the best candidate of its scan.
    """

    effect: str
    value: int
    statistic: float
    degrees: int
    p_value: float
    after_search: float


@dataclass(frozen=True)
class Named:
    """The causes, and what the data say of every effect of the catalogue."""

    causes: tuple[Cause, ...]
    tests: tuple[EffectTest, ...]
    excesses: tuple[tuple[float, float], ...]
