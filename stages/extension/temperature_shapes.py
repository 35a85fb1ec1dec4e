"""The mean over the shapes that functions of temperature may have, in place of the likeliest one.

That a function bends is certain where it is named; whether it is a parabola, a cubic or a line with
a knot, and where that is, is not, and between the temperatures of a campaign the shapes differ.
Each has a probability: its evidence beyond a straight line, for a knot the mean over a grid of
knots, all three being equally probable beforehand. The knots are represented by three with their
mean and variance, at 0 and ±√3 sigma with weights 2/3 and 1/6 (Gauss and Hermite). All shapes of
all functions are fitted with each other, and the result is the mixture of these fits: linear in
coefficients of powers and of bends, whose covariance holds what the shapes differ by.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from math import prod

import numpy as np
from scipy.special import logsumexp

from inertial.arrays import Array
from inertial.effects.temperature_model import (
    BEND,
    BENDS,
    MAX_ORDER,
    SHIFT,
    Piece,
    TemperatureModel,
    polynomials,
)
from inertial.estimation.least_squares import Estimate, System, with_columns
from inertial.estimation.mixture import mixture
from inertial.estimation.triad import UNKNOWNS
from inertial.model_selection.effect_classes import log_evidence
from inertial.physics.effect import Effect
from inertial.physics.motion import Motion
from stages.extension.estimates import Row, Solved
from stages.extension.models import compressed

GRID = 25  # knots over the range
FINE, FINE_SIGMAS = 17, 4.0  # about the knot that was named, to so many of its sigma
MIN_SIDE = 0.1  # of the range, on either side of a knot
KNOT_DIGITS = 3  # of a knot in K
MIN_PROBABILITY = 0.01  # of a shape that is fitted
MOST = 729  # fits, the most probable
THREE = tuple(zip(BENDS, (-np.sqrt(3), 0.0, np.sqrt(3)), (1 / 6, 2 / 3, 1 / 6), strict=True))

SystemOf = Callable[[Sequence[Effect]], System]
Knots = Mapping[str, Sequence[float]]  # by function, K


@dataclass(frozen=True)
class Shape:
    """One that a function may have: its degree, 1 with a knot, K, which is that of a piece."""

    degree: int
    probability: float
    bend: int = BEND
    knot: float = np.nan

    def pieces(self, function: str) -> list[Piece]:
        """Of a function of this shape."""
        powers = range(1, self.degree + 1)
        bends = [self.bend] if self.degree == 1 else []
        return [Piece(function, power) for power in (*powers, *bends)]


Shapes = Mapping[str, Sequence[Shape]]  # by function, of which its value is a mean


def with_shapes(
    solution: Solved, effects: Sequence[Effect], motion: Motion, system_of: SystemOf
) -> Solved:
    """The fit with the mean over the shapes; the same where no function of temperature bends.

    `system_of`: the equations of the sensor with further effects.
    """
    for model in effects:
        if isinstance(model, TemperatureModel) and (bent := _bent(model, solution)):
            grid = {f: _grid(f, solution, model, motion) for f in bent}
            estimate = solution.estimate
            excess = max(1.0, estimate.chi_squared / max(estimate.degrees, 1))
            every = _Equations(model, effects, grid, excess, system_of)
            shapes = {f: every.shapes(f, motion) for f in bent}
            three = {f: [s.knot for s in own if s.degree == 1] for f, own in shapes.items()}
            every = _Equations(model, effects, three, excess, system_of)
            return every.mixed(solution, shapes, motion)
    return solution


def _bent(model: TemperatureModel, solution: Solved) -> list[str]:
    """The functions that are estimated and more than a straight line."""
    there = {row["parameter"] for row in solution.of_effects}
    return [
        piece.function
        for piece in model.pieces
        if piece.power in (2, BEND) and _named(model, piece) in there
    ]


def _named(model: TemperatureModel, piece: Piece) -> str:
    """A coefficient as the rows of a fit name it."""
    return f"{model.name}.{piece.name}"


def _grid(f: str, solution: Solved, model: TemperatureModel, motion: Motion) -> list[float]:
    """Knots over the range, and closer ones about that which was named."""
    low, high = _ends(motion)
    knots = np.linspace(low, high, GRID)
    rows = {row["parameter"]: row for row in solution.of_effects}
    shift, bend = (rows.get(_named(model, Piece(f, power))) for power in (SHIFT, BEND))
    if shift and bend and shift["sigma"] and bend["value"]:
        around = FINE_SIGMAS * abs(shift["sigma"] / bend["value"])
        fine = model.knots[f] + np.linspace(-around, around, FINE)
        knots = np.append(knots, np.clip(fine, low, high))
    return [float(at) for at in np.unique(np.round(knots, KNOT_DIGITS))]


def _ends(motion: Motion) -> tuple[float, float]:
    """The lowest and the highest knot, K."""
    ends = [np.nanmin(motion.temperature), np.nanmax(motion.temperature)]
    low, high = np.quantile(ends, [MIN_SIDE, 1 - MIN_SIDE])
    return float(low), float(high)


class _Equations:
    """The equations of a sensor with the columns of all shapes.

    `knots`: by function, K; `excess`: of the variance over that of the noise.
    """

    def __init__(
        self,
        model: TemperatureModel,
        effects: Sequence[Effect],
        knots: Knots,
        excess: float,
        system_of: SystemOf,
    ) -> None:
        self.model, self.effects, self.knots, self.excess = model, effects, knots, excess

        def labelled(pieces: Sequence[Piece], at: float, of: Mapping[str, float]) -> Effect:
            return TemperatureModel(model.sensor, pieces, of, model.lag).fixed(at)

        self.smooth = labelled(polynomials(dict.fromkeys(knots, MAX_ORDER)), 0.0, {})
        self.bends = {
            (f, at): labelled([Piece(f, BEND)], at, {f: at})
            for f, own in knots.items()
            for at in own
        }
        self.system = compressed(system_of([self.smooth, *self.bends.values()]))
        self.named = {p: f"{model.label}.{p.name}" for p in model.pieces if p.function in knots}
        own = {name for effect in (self.smooth, *self.bends.values()) for name in effect.columns}
        self.others = [
            name
            for kind, name in self.system.names
            if kind == "effect" and name not in {*own, *self.named.values()}
        ]

    @cached_property
    def before(self) -> Estimate:
        """The fit as it was named."""
        return self.fit(list(self.named.values()))

    def fit(self, columns: Sequence[str]) -> Estimate:
        """With some columns of these functions, beside all other effects."""
        return with_columns(self.system, frozenset([*self.others, *columns])).solve_shared()

    def beside(self, f: str) -> list[str]:
        """The columns of the other functions, as they were named."""
        return [n for p, n in self.named.items() if p.function != f and p.power != SHIFT]

    def columns(self, f: str, shape: Shape) -> list[str]:
        """The columns of a shape, in the order of its pieces."""
        smooth = [f"{self.smooth.label}.{Piece(f, n).name}" for n in range(1, shape.degree + 1)]
        if shape.degree > 1:
            return smooth
        return [*smooth, f"{self.bends[f, shape.knot].label}.{Piece(f, BEND).name}"]

    def shapes(self, f: str, motion: Motion) -> list[Shape]:
        """The shapes of a function by their probabilities, the others as they were named."""
        others = self.beside(f)
        line = self.fit([*others, f"{self.smooth.label}.{Piece(f, 1).name}"])
        tried = [
            *(Shape(degree, 1.0) for degree in range(2, MAX_ORDER + 1)),
            *(Shape(1, 1.0, BEND, at) for at in self.knots[f]),
        ]
        fits = [self.fit([*others, *self.columns(f, shape)]) for shape in tried]
        drops = np.array([line.chi_squared - fit.chi_squared for fit in fits]) / self.excess
        further = np.array([max(shape.degree - 1, 1) for shape in tried])
        odds = log_evidence(drops, further)
        for i, (shape, fit) in enumerate(zip(tried, fits, strict=True)):
            determined = {
                n for (_k, n), there in zip(fit.names, fit.determined, strict=True) if there
            }
            if not determined.issuperset(self.columns(f, shape)):
                odds[i] = -np.inf
        knots = np.array(self.knots[f])
        width = np.gradient(knots)
        of_knots = odds[MAX_ORDER - 1 :] + np.log(width / width.sum())
        by_degree = np.append(odds[: MAX_ORDER - 1], logsumexp(of_knots))
        *smooth, bent = np.exp(by_degree - logsumexp(by_degree)).tolist()
        shapes = [Shape(degree, share) for degree, share in enumerate(smooth, 2)]
        if bent > 0:
            shapes += _three(bent, knots, np.exp(of_knots - logsumexp(of_knots)), _ends(motion))
        largest = max(shape.probability for shape in shapes)
        return [s for s in shapes if s.probability >= MIN_PROBABILITY * largest]

    def mixed(self, solution: Solved, shapes: Shapes, motion: Motion) -> Solved:
        """The fit with the mixture of all shapes in place of those that were named."""
        places = self._places(solution, shapes)
        chosen = sorted(product(*shapes.values()), key=lambda one: -_probability(one))[:MOST]
        fits = [self._placed(shapes, one, places) for one in chosen]
        values, covariances, together = (np.array(each) for each in zip(*fits, strict=True))
        weights = self._weights(shapes, chosen, together)
        mean, covariance = mixture(values, covariances, weights)
        # What the sizes of effects and scanned values have changed in the fit stays.
        old, named = places.kept, slice(len(places.kept))
        before = np.ix_(own := places.columns(self.before), own)
        mean[named] += solution.values[old] - self.before.values[own]
        covariance[named, named] += solution.covariance[np.ix_(old, old)]
        covariance[named, named] -= self.before.covariance[before]
        likeliest = {
            f: _likeliest([one[i].degree for one in chosen], weights) for i, f in enumerate(shapes)
        }
        model = _of_shapes(self.model, places.pieces, shapes, likeliest)
        return _written(solution, places, model, motion, mean, covariance)

    def _places(self, solution: Solved, shapes: Shapes) -> "_Places":
        dropped = {_named(self.model, piece) for piece in self.named}
        kept = [i for i, row in enumerate(solution.rows) if row["parameter"] not in dropped]
        labels = {
            f"{e.name}.{p.name}": f"{e.label}.{p.name}" for e in self.effects for p in e.parameters
        }
        wanted = [labels.get(solution.rows[i]["parameter"], "") for i in kept if i >= UNKNOWNS]
        pieces = sorted({p for f, own in shapes.items() for s in own for p in s.pieces(f)})
        return _Places(kept, wanted, pieces)

    def _placed(
        self, shapes: Shapes, combination: Sequence[Shape], places: "_Places"
    ) -> tuple[Array, Array, float]:
        """Values and covariance, zero for pieces of other shapes, and chi-squared of a fit."""
        columns = {
            name: places.of(piece)
            for f, shape in zip(shapes, combination, strict=True)
            for name, piece in zip(self.columns(f, shape), shape.pieces(f), strict=True)
        }
        fit = self.fit(list(columns))
        own = places.columns(fit, list(columns))
        to = [*range(len(places.kept)), *columns.values()]
        values, covariance = np.zeros(places.size), np.zeros((places.size, places.size))
        values[to] = fit.values[own]
        covariance[np.ix_(to, to)] = fit.covariance[np.ix_(own, own)]
        return values, covariance, fit.chi_squared

    def _weights(self, shapes: Shapes, chosen: Sequence[Sequence[Shape]], together: Array) -> Array:
        """Of combinations of shapes, from the product of the probabilities of each by itself.

        Together they are more or less likely than that; `together`: chi-squared of their fits,
        which is measured in the noise that they leave.
        """
        alone = {
            (f, shape): self.fit([*self.beside(f), *self.columns(f, shape)]).chi_squared
            for f, own in shapes.items()
            for shape in own
        }
        expected = [
            sum(alone[f, shape] for f, shape in zip(shapes, one, strict=True)) for one in chosen
        ]
        log_odds = (np.array(expected) - together) / 2 / self.excess
        weights = np.array([_probability(one) for one in chosen])
        return np.asarray(weights * np.exp(log_odds - log_odds.max()))


@dataclass(frozen=True)
class _Places:
    """Where the unknowns of the mixture are: rows that are kept, then the pieces of all shapes.

    `kept`: rows of the fit; `wanted`: columns of the effects among them, in the same order.
    """

    kept: Sequence[int]
    wanted: Sequence[str]
    pieces: Sequence[Piece]

    @property
    def size(self) -> int:
        """The number of unknowns."""
        return len(self.kept) + len(self.pieces)

    def of(self, piece: Piece) -> int:
        """That of a piece."""
        return len(self.kept) + self.pieces.index(piece)

    def columns(self, fit: Estimate, more: Sequence[str] = ()) -> list[int]:
        """The unknowns of a fit that are kept, and those of more effects."""
        column = {name: i for i, (kind, name) in enumerate(fit.names) if kind == "effect"}
        return [*range(UNKNOWNS), *(column[name] for name in (*self.wanted, *more))]


def _written(
    solution: Solved,
    places: _Places,
    model: TemperatureModel,
    motion: Motion,
    mean: Array,
    covariance: Array,
) -> Solved:
    """The fit with the rows and constants of a model of all pieces; what has no value has none."""
    template = next(row for row in solution.of_effects if row["effect"] == model.name)
    described = {parameter.name: parameter for parameter in model.parameters}
    added = [
        _renamed(template, _named(model, piece), parameter.unit, parameter.meaning)
        for piece in places.pieces
        for parameter in (described[piece.name],)
    ]
    sigma = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    without = {i for i, row in enumerate(places.kept) if solution.rows[row]["value"] is None}
    rows = [
        row if i in without else {**row, "value": float(value), "sigma": float(scatter)}
        for i, (row, value, scatter) in enumerate(
            zip([*(solution.rows[i] for i in places.kept), *added], mean, sigma, strict=True)
        )
    ]
    constants = [
        {
            **_renamed(template, f"{model.name}.{one.name}", one.unit, one.meaning),
            **{"frame": "", "value": one.value, "sigma": None},
        }
        for one in model.constants(motion)
    ]
    return replace(
        solution,
        rows=rows,
        covariance=covariance,
        effects=[row["effect"] for row in rows[UNKNOWNS:]],
        constants=[*(r for r in solution.constants if r["effect"] != model.name), *constants],
        fitted=[model if one.name == model.name else one for one in solution.fitted],
    )


def _three(
    probability: float, knots: Array, weights: Array, ends: tuple[float, float]
) -> list[Shape]:
    """Lines with three knots that have the mean and the variance of many."""
    mean = float(weights @ knots)
    sigma = float(np.sqrt(weights @ (knots - mean) ** 2))
    three = [
        Shape(1, share * probability, bend, round(float(np.clip(mean + off * sigma, *ends)), 3))
        for bend, off, share in THREE
    ]
    if len({shape.knot for shape in three}) == len(three):
        return three
    return [Shape(1, probability, BEND, round(mean, KNOT_DIGITS))]


def _of_shapes(
    model: TemperatureModel,
    pieces: Sequence[Piece],
    shapes: Shapes,
    likeliest: Mapping[str, tuple[int, float]],
) -> TemperatureModel:
    """The model of the mean: that of all pieces, with the knots and the likeliest shapes."""
    smooth = [piece for piece in model.pieces if piece.function not in shapes]
    knots = {
        piece.knot: shape.knot
        for f, own in shapes.items()
        for shape in own
        for piece in shape.pieces(f)
        if piece.power in BENDS
    }
    mean = TemperatureModel(model.sensor, [*smooth, *pieces], knots, model.lag)
    mean.likeliest = likeliest
    return mean


def _likeliest(degrees: Sequence[int], weights: Array) -> tuple[int, float]:
    """The degree that is likeliest in many fits, and its probability."""
    shares = np.bincount(degrees, weights) / weights.sum()
    return int(np.argmax(shares)), float(shares.max())


def _probability(combination: Sequence[Shape]) -> float:
    """Of the shapes of all functions together."""
    return prod(shape.probability for shape in combination)


def _renamed(row: Row, name: str, unit: str, meaning: str) -> Row:
    """The row of another parameter of the same effect."""
    folder = row["id"].rpartition("/")[0]
    return {**row, "id": f"{folder}/{name}", "parameter": name, "unit": unit, "meaning": meaning}
