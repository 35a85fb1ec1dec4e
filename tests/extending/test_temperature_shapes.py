"""Functions of temperature of which the data do not tell the shape: the mean over shapes."""

import numpy as np
import pytest

from inertial.effects.temperature_model import BEND, SHIFT, Piece, TemperatureModel
from inertial.estimation.least_squares import System
from inertial.estimation.triad import linear_names
from inertial.physics.motion import stretches
from stages.diagnosis.result import Result, curve_rows
from stages.extension.estimates import Solved
from stages.extension.models import PRIOR_SIGMA
from stages.extension.stage import told_of_equals
from stages.extension.temperature_shapes import with_shapes

NOISE = 1e-6  # rad/s, of a reading
LOW, MIDDLE, HIGH = 270.0, 300.0, 330.0
LEVELS = np.repeat([LOW, MIDDLE, HIGH], 40)  # and few readings between them
TEMPERATURE = np.concatenate([LEVELS, np.linspace(LOW, HIGH, 13)[1:-1]])
DENSE = np.linspace(LOW, HIGH, 200)
SIZE = 1e-5  # rad/s, of a bend over half of the range


class Readings:
    """Of the bias of x at temperatures; each other parameter is read once."""

    def __init__(self, temperature, curve, chance) -> None:
        self.temperature = temperature
        noise = NOISE * chance.standard_normal(len(temperature))
        self.read = np.append(np.zeros(11), curve(temperature) + noise)
        n = len(temperature)
        self.motion = stretches(np.arange(n) * 10.0, np.full(n, 1e-3), temperature)

    def system(self, effects) -> System:
        names = [("parameter", name) for name in linear_names()]
        columns = np.zeros((11 + len(self.temperature), 12))
        others = [i for i in range(12) if i != 9]
        columns[range(11), others] = 1.0
        columns[11:, 9] = 1.0
        sizes = [1.0] * 12
        for effect in effects:
            for piece, parameter in zip(effect.pieces, effect.parameters, strict=True):
                column = np.append(np.zeros(11), effect.shape(piece, self.motion))
                columns = np.column_stack([columns, column])
                names.append(("effect", f"{effect.label}.{parameter.name}"))
                sizes.append(PRIOR_SIGMA * parameter.typical)
        sigma = np.full(len(columns), NOISE)
        zeros = np.zeros(len(sizes))
        of = (self.read, sigma, zeros, np.array(sizes), len(sizes), tuple(names))
        return System(columns, *of)

    def estimated(self, model: TemperatureModel):
        """The curve by a named model, with the mean over shapes: K, values, sigmas, first row."""
        fit = self.system([model]).solve_shared()
        names = [*linear_names(), *(f"{model.name}.{p.name}" for p in model.parameters)]
        values = fit.values - np.append(np.eye(3).ravel(), np.zeros(len(names) - 9))
        rows = [
            {"parameter": name, "value": value, "sigma": sigma, "reason": "", "mount": "a"}
            | {"effect": None if i < 12 else model.name, "unit": "rad/s", "meaning": ""}
            | {"id": f"extension/gyroscope/{name}", "sensor": "gyro", "frame": "body"}
            for i, (name, value, sigma) in enumerate(zip(names, values, fit.sigma, strict=True))
        ]
        effects = [model.name] * len(model.parameters)
        solution = Solved("gyro", rows, fit.covariance, fit, 0.0, effects)
        mean = with_shapes(solution, [model], self.motion, lambda more: self.system([model, *more]))
        result = Result("extended", [*mean.rows, *mean.constants], mean.covariance)
        told = [row for row in curve_rows(result) if row["parameter"] == "bias_x"]
        at, value, sigma = (
            np.array([row[key] for row in told]) for key in ("temperature", "value", "sigma")
        )
        return at, value, sigma, told[0]


PARABOLA = TemperatureModel("gyro", [Piece("bias_x", 1), Piece("bias_x", 2)])


def knee(at: float) -> TemperatureModel:
    pieces = [Piece("bias_x", power) for power in (1, BEND, SHIFT)]
    return TemperatureModel("gyro", pieces, {"bias_x": at})


def drawn(shape: str, chance):
    """A bend of a ratio to noise from which shapes are sure to be no straight line."""
    slope, size = chance.normal(0, SIZE, 2)
    size = (SIZE + abs(size)) * chance.choice([-1, 1])
    knot = chance.uniform(LOW + 15, HIGH - 15)
    bends = {
        "parabola": lambda z, at: size * z**2,
        "cubic": lambda z, at: size * z**2 + 2 * size * z**3,
        "knee": lambda z, at: size * np.maximum(at - knot, 0) / 30,
    }
    return lambda at: slope * (at - MIDDLE) / 30 + bends[shape]((at - MIDDLE) / 30, at)


@pytest.mark.slow
def test_intervals_hold_between_the_temperatures_whatever_the_shape():
    """Three temperatures and little between: 0.95 of intervals of 95 %, over 240 curves."""
    chance = np.random.default_rng(8)
    inside = []
    for draw in range(240):
        curve = drawn(("parabola", "cubic", "knee")[draw % 3], chance)
        at, value, sigma, _ = Readings(TEMPERATURE, curve, chance).estimated(PARABOLA)
        inside.append(np.abs(value - curve(at)) < 1.96 * sigma)
    assert 0.92 < np.mean(inside) < 0.985


def test_where_the_data_tell_the_knot_it_is_that_of_the_least_squares():
    """Two hundred readings along the range; the knot by a search, its sigma by the derivative."""
    chance = np.random.default_rng(2)
    read = Readings(DENSE, lambda at: 1e-4 * np.maximum(at - 310, 0) / 30, chance)
    by_knot = knee(310.0)
    at, value, sigma, told = read.estimated(by_knot)
    assert told["order"] == 1 and told["knot"] == pytest.approx(310, abs=0.5)
    fit = read.system([by_knot]).solve_shared()
    own = [9, 12, 13, 14]
    shapes = [by_knot.shape(p, stretches(0 * at, 0 * at + 1, at)) for p in by_knot.pieces]
    design = np.column_stack([np.ones(len(at)), *shapes])
    expected = np.sqrt(np.einsum("ti,ij,tj->t", design, fit.covariance[np.ix_(own, own)], design))
    far = np.abs(at - 310) > 3
    np.testing.assert_allclose(sigma[far], expected[far], rtol=0.05)
    np.testing.assert_allclose(value[far], (design @ fit.values[own])[far], atol=3e-7)


def test_it_does_not_depend_on_the_shape_that_was_named():
    chance = np.random.default_rng(5)
    read = Readings(TEMPERATURE, drawn("knee", chance), chance)
    (_, one, sigma, _), (_, other, _, _) = read.estimated(PARABOLA), read.estimated(knee(300.0))
    np.testing.assert_allclose(one, other, atol=0.3 * sigma.max())


def test_a_straight_line_stays_as_it_is():
    line = TemperatureModel("gyro", [Piece("bias_x", 1)])
    fit = Solved("gyro", [{"parameter": "gyro_temperature.bias_x_1"}] * 13, np.eye(13), None, 0.0)
    assert with_shapes(fit, [line], None, None) is fit


def test_what_is_told_of_a_function_holds_for_its_other_forms_as_far_as_they_have_it():
    """Forms with more columns, or less, ended the stage with an exception."""
    named = TemperatureModel("gyro", [Piece("bias_x", 1), Piece("bias_x", 2)], {}, 0.0).fixed(0.0)
    other = TemperatureModel("gyro", [Piece("bias_x", n) for n in (1, 3)], {}, 0.0).fixed(0.0)
    first, second = named.columns
    told = told_of_equals([named], [other], {first: (1.0, 0.1), second: (2.0, 0.2)})
    assert told == {other.columns[0]: (1.0, 0.1)}
