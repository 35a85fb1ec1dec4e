"""Which parameters of a sensor are functions of temperature, and of which shape.

All polynomial columns of all parameters are in one set of normal equations, everything else that
is fitted eliminated. Degrees are raised where that reduces chi-squared by more than the threshold
of the columns added, the largest gain first; a raise may be by several degrees, for a cubic about
its middle has no quadratic part. Then each highest degree is tested given all others and lowered
until it is significant by itself. So each degree that is selected is significant at the level, by
Bonferroni over all columns; lower degrees of the same function stay with it (hierarchy).

Where a polynomial bends, a straight line with a change of slope at a knot is compared with it. That
there is a bend is certain by then; which shape it has is decided by Akaike's criterion: the
reduction of chi-squared less two for each unknown, of which a knot is one.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.estimation.effect_information import MIN_INFORMATION_SHARE, EffectInformation
from inertial.estimation.probability import chi2_isf, f_isf

Powers = Mapping[str, Sequence[int]]  # by function the columns of degree 1, 2, 3
Shapes = Mapping[str, Sequence[int]]  # by function the columns that describe it

AKAIKE = 2.0  # of chi-squared for each unknown (Akaike 1974)
ALIKE = 0.1  # of chi-squared, between knots that are about as likely


@dataclass(frozen=True)
class Columns:
    """Those of the polynomials, and by function and knot, K, that of the change of slope."""

    powers: Powers
    bends: Mapping[str, Mapping[float, int]]

    def line(self, function: str, knot: float) -> list[int]:
        """Those of a line whose slope changes at a knot."""
        return [self.powers[function][0], self.bends[function][knot]]


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
        """Reduction of chi-squared by some columns and those given, and its degrees."""
        every = list(dict.fromkeys([*self.given, *columns]))
        return self.equations.drop(every) if every else (0.0, 0)

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


def orders(tested: SensorEquations, powers: Powers) -> dict[str, int]:
    """The degree of each function, 0 where it is a constant."""
    degrees = {name: _observable(tested, own) for name, own in powers.items()}
    tests = sum(degrees.values())
    found = dict.fromkeys(powers, 0)
    while (raised := _raised(tested, powers, degrees, found, tests)) is not None:
        found |= {raised[0]: raised[1]}
    while (lowered := _lowered(tested, powers, found, tests)) is not None:
        found[lowered] -= 1
    return found


def _observable(tested: SensorEquations, own: Sequence[int]) -> int:
    """How many degrees of a function are observable, the lower ones first."""
    places = [tested.observable(column) for column in own]
    return places.index(False) if False in places else len(places)


def columns_of(powers: Powers, found: Mapping[str, int]) -> list[int]:
    """The columns of the selected degrees."""
    return [column for name, order in found.items() for column in powers[name][:order]]


def _raised(
    tested: SensorEquations,
    powers: Powers,
    degrees: Mapping[str, int],
    found: Mapping[str, int],
    tests: int,
) -> tuple[str, int] | None:
    """The function and its degree by which most is gained, if anything is."""
    before, used = tested.drop(columns_of(powers, found))
    best, gain = None, 0.0
    for name, order in found.items():
        for to in range(order + 1, degrees[name] + 1):
            drop, more = tested.drop(columns_of(powers, {**found, name: to}))
            added = max(more - used, 1)
            now = drop - before - tested.threshold(added, tests)
            if now > gain:
                best, gain = (name, to), now
    return best


def _lowered(
    tested: SensorEquations, powers: Powers, found: Mapping[str, int], tests: int
) -> str | None:
    """The function whose highest degree is least significant, if it is not significant."""
    whole, _used = tested.drop(columns_of(powers, found))
    bound = tested.threshold(1, tests)
    drops = {
        name: whole - tested.drop(columns_of(powers, {**found, name: order - 1}))[0]
        for name, order in found.items()
        if order
    }
    name = min(drops, key=lambda one: drops[one], default=None)
    return name if name is not None and drops[name] < bound else None


def best_knots(
    tested: SensorEquations, columns: Columns, shapes: Shapes, tried: Mapping[str, Sequence[float]]
) -> dict[str, float]:
    """By function that of some knots with which it explains most, given the shapes of all others.

    Where no reading is between two temperatures, all knots there explain as much: so it is the
    middle one of those that are about as likely. `tried`: by function the knots, ascending.
    """
    best = {}
    for name, knots in tried.items():
        others = _others(shapes, name)
        drops = [tested.drop([*others, *columns.line(name, at)])[0] for at in knots]
        unlikely = np.flatnonzero(np.array(drops) < max(drops) - ALIKE * tested.excess)
        place = int(np.argmax(drops))
        first = int(np.max(unlikely[unlikely < place], initial=-1)) + 1
        last = int(np.min(unlikely[unlikely > place], initial=len(knots))) - 1
        best[name] = knots[(first + last) // 2]
    return best


def with_knots(
    tested: SensorEquations, columns: Columns, shapes: Shapes, knots: Mapping[str, float]
) -> dict[str, float]:
    """Those of the functions that their knots describe better than a polynomial.

    The one first that gains most; `shapes`: of all functions, those with a knot as cubics.
    """
    better: dict[str, float] = {}
    left = dict(knots)
    while left:
        gains = {name: _advantage(tested, columns, shapes, name, at) for name, at in left.items()}
        name = max(gains, key=lambda one: gains[one])
        if gains[name] <= 0:
            break
        better[name] = left.pop(name)
        shapes = {**shapes, name: columns.line(name, better[name])}
    return better


def _advantage(
    tested: SensorEquations, columns: Columns, shapes: Shapes, name: str, knot: float
) -> float:
    """Of a line with a knot over the better of a parabola and a cubic, by Akaike's criterion."""
    others, powers = _others(shapes, name), columns.powers[name]
    parabola = tested.drop([*others, *powers[:2]])[0] + AKAIKE * tested.excess
    cubic = tested.drop([*others, *powers[:3]])[0]
    return tested.drop([*others, *columns.line(name, knot)])[0] - max(parabola, cubic)


def _others(shapes: Shapes, name: str) -> list[int]:
    return [column for other, own in shapes.items() if other != name for column in own]
