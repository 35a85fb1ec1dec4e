"""Which parameters of a sensor are functions of temperature, and of which degree.

All polynomial columns of all parameters are in one set of normal equations, everything else that
is fitted eliminated. Degrees are raised where that reduces chi-squared by more than the threshold
of the columns added, the largest gain first; a raise may be by several degrees, for a cubic about
its middle has no quadratic part. Then each highest degree is tested given all others and lowered
until it is significant by itself. So each degree that is selected is significant at the level, by
Bonferroni over all columns; lower degrees of the same function stay with it (hierarchy).

Where a polynomial bends, a straight line with a change of slope at a knot is compared with it:
two columns and a searched knot against as many columns as the cubic has.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.least_squares import MIN_INFORMATION_SHARE, EffectInformation
from inertial.estimation.probability import chi2_isf, f_isf

Array = NDArray[np.float64]
Columns = Mapping[str, Sequence[int]]  # by function, those of degree 1, 2, 3

# Of chi-squared, by which a line with a knot must be better than a cubic: both have three unknowns,
# so the likelihoods decide, and where they are alike the smoother of the two is kept.
MIN_KNOT_ADVANTAGE = 2.0


@dataclass(frozen=True)
class SensorEquations:
    """The normal equations of one sensor, and the noise that they are compared with.

    `excess`: of the variance over that of the noise; `noise_degrees`: of freedom of it; `level`:
    accepted probability of any degree that is not there; `given`: columns that are fitted as well.
    """

    equations: EffectInformation
    raw: Array
    excess: float
    noise_degrees: float
    level: float
    given: tuple[int, ...] = ()

    def drop(self, columns: Sequence[int]) -> tuple[float, int]:
        """Reduction of chi-squared by some columns beside those given, and its degrees."""
        if not len(columns):
            return 0.0, 0
        return self.equations.drop(list(dict.fromkeys([*self.given, *columns])))

    def threshold(self, degrees: int, tests: int) -> float:
        """The reduction that noise exceeds with its share of the level."""
        share = self.level / max(tests, 1)
        if np.isinf(self.noise_degrees):
            return self.excess * float(chi2_isf(share, degrees))
        return self.excess * degrees * float(f_isf(share, degrees, self.noise_degrees))

    def observable(self, column: int) -> bool:
        """Whether more than rounding remains of a column, all else fitted."""
        own = float(self.equations.information[column, column])
        return own > MIN_INFORMATION_SHARE * float(self.raw[column])


def orders(tested: SensorEquations, columns: Columns) -> dict[str, int]:
    """The degree of each function, 0 where it is a constant."""
    degrees = {name: _observable(tested, own) for name, own in columns.items()}
    tests = sum(degrees.values())
    found = dict.fromkeys(columns, 0)
    while (raised := _raised(tested, columns, degrees, found, tests)) is not None:
        found |= {raised[0]: raised[1]}
    while (lowered := _lowered(tested, columns, found, tests)) is not None:
        found[lowered] -= 1
    return found


def _observable(tested: SensorEquations, own: Sequence[int]) -> int:
    """How many degrees of a function are observable, the lower ones first."""
    places = [tested.observable(column) for column in own]
    return places.index(False) if False in places else len(places)


def columns_of(columns: Columns, found: Mapping[str, int]) -> list[int]:
    """The columns of the selected degrees."""
    return [column for name, order in found.items() for column in columns[name][:order]]


def _raised(
    tested: SensorEquations,
    columns: Columns,
    degrees: Mapping[str, int],
    found: Mapping[str, int],
    tests: int,
) -> tuple[str, int] | None:
    """The function and its degree by which most is gained, if anything is."""
    before, used = tested.drop(columns_of(columns, found))
    best, gain = None, 0.0
    for name, order in found.items():
        for to in range(order + 1, degrees[name] + 1):
            drop, more = tested.drop(columns_of(columns, {**found, name: to}))
            added = max(more - used, 1)
            now = drop - before - tested.threshold(added, tests)
            if now > gain:
                best, gain = (name, to), now
    return best


def _lowered(
    tested: SensorEquations, columns: Columns, found: Mapping[str, int], tests: int
) -> str | None:
    """The function whose highest degree is least significant, if it is not significant."""
    whole, _used = tested.drop(columns_of(columns, found))
    bound = tested.threshold(1, tests)
    drops = {
        name: whole - tested.drop(columns_of(columns, {**found, name: order - 1}))[0]
        for name, order in found.items()
        if order
    }
    name = min(drops, key=lambda one: drops[one], default=None)
    return name if name is not None and drops[name] < bound else None


def knots(
    tested: SensorEquations,
    columns: Columns,
    found: Mapping[str, int],
    bends: Mapping[str, Sequence[int]],
) -> Iterator[tuple[str, int]]:
    """The functions that a knot describes better than a polynomial, and the number of its knot.

    `bends`: by function the columns of the change of slope, one for each knot that is tried.
    """
    given = columns_of(columns, found)
    for name, order in found.items():
        if order < 2 or not len(bends.get(name, ())):
            continue
        own = columns[name]
        others = [column for column in given if column not in own]
        cubic, _used = tested.drop([*others, *own])
        lines = [tested.drop([*others, own[0], bend])[0] for bend in bends[name]]
        best = int(np.argmax(lines))
        if lines[best] - cubic > MIN_KNOT_ADVANTAGE * tested.excess:
            yield name, best
