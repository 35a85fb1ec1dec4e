"""Named causes, and the test of every effect of the catalogue."""

from dataclasses import dataclass

from inertial.arrays import Array
from inertial.model_selection.size_after_selection import Selected, selected

FOUND = "found"
ONE_OF_CLASS = "one_of_class"
UNKNOWN_STRUCTURE = "unknown_structure"
LAW = "law"  # of no effect of the catalogue


@dataclass(frozen=True)
class Cause:
    """A named cause, or a class of indistinguishable causes.

    `effect`: the most probable; `value`: which candidate of its scan; `members`: all
    indistinguishable effects, the most probable first; `member_values`: the best candidate of
    the scan of each; `weights`: their posterior probabilities; `captured`: which share of the
    signal each can mimic; `statistic`: reduction of chi-squared given the other causes, on
    `degrees`; `threshold`: the reduction from which it is named, 0 if it was not searched;
    `p_value`: probability that noise yields as large a statistic for any effect of
    the catalogue; `snr`: root of the reduction less what noise adds; `columns`, `values`,
    `covariance`: of the parameters, estimated with those of the other causes by least squares.
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
    threshold: float = 0.0

    @property
    def selected(self) -> Selected:
        """What having been selected by its size changes in the estimate of it."""
        return selected(self.statistic, self.degrees, self.threshold)


@dataclass(frozen=True)
class EffectTest:
    """Test of an effect given the named causes.

    `p_value`: accounts for the search over its own scan; `after_search`: for that over the
    whole catalogue too; `value`: the best candidate of its scan.
    """

    effect: str
    value: int
    statistic: float
    degrees: int
    p_value: float
    after_search: float


@dataclass(frozen=True)
class NamedCauses:
    """The named causes, and the test of every effect of the catalogue."""

    causes: tuple[Cause, ...]
    tests: tuple[EffectTest, ...]
    excesses: tuple[tuple[float, float], ...]
