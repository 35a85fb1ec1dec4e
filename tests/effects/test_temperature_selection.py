"""Functions of temperature: the right ones, of the right degree and size; none where none is."""

import numpy as np
import plans
import pytest
import soaks
from soaks import ICE_POINT, MIDDLE

from inertial.arrays import Array
from inertial.effects import CATALOGUE, KNOWN, TEMPERATURE_MODELS
from inertial.effects.temperature_model import (
    FUNCTIONS,
    NAMES,
    SHIFT,
    Piece,
    TemperatureModel,
    polynomials,
)
from inertial.estimation.effect_information import EffectInformation
from inertial.estimation.temperature import (
    Columns,
    SensorEquations,
    best_knots,
    orders,
    with_knots,
)
from inertial.physics.drift import delay
from inertial.physics.effect import Effect, Reading, Truth
from inertial.physics.motion import stretches
from stages.criticism.temperature_functions import select_with_temperature, temperature_models
from tests.expressions import value_of

G = 9.8
LEVEL, TEMPERATURE_LEVEL = 4e-3, 5e-4
SEEN = ("accel_temperature", "gyro_temperature")


@pytest.fixture(scope="module")
def plan() -> plans.Plan:
    return soaks.soak()


def orders_of(model: TemperatureModel) -> dict[str, int]:
    """The highest power of each function, 0: a bend."""
    return {
        f: 0 if f in model.knots else max(p.power for p in model.pieces if p.function == f)
        for f in {piece.function for piece in model.pieces}
    }


def found(plan: plans.Plan, seed: int, hidden: soaks.Hidden) -> dict[str, TemperatureModel]:
    campaign = soaks.recorded(plan, seed, hidden)
    models = temperature_models(campaign, [], TEMPERATURE_LEVEL, np.inf)
    return {model.sensor: model for model in models}


# ---- hidden, and found

CUBIC = (1e-5 * G, 3e-7 * G, 6e-9 * G)  # m/s² per K, K², K³ about the middle
SLOPE = 2e-5  # 1/K


def cubic_bias_and_a_scale_factor(above: Array, read: Array, time: Array) -> Array:
    change = np.zeros_like(read)
    change[:, 0] = sum(k * above**n for n, k in enumerate(CUBIC, 1))
    change[:, 1] = SLOPE * above * read[:, 1]
    return change


@pytest.mark.slow
def test_a_cubic_bias_and_a_linear_scale_factor_and_nothing_else(plan):
    campaign = soaks.recorded(plan, 11, cubic_bias_and_a_scale_factor)
    effects = [one for n, one in CATALOGUE.items() if n.startswith("accel")]
    selection = select_with_temperature(campaign, effects, LEVEL, TEMPERATURE_LEVEL, np.inf)
    (cause,) = selection.named.causes
    assert (cause.effect, cause.members, cause.verdict) == (SEEN[0], (SEEN[0],), "found")
    (model,) = selection.effects
    assert isinstance(model, TemperatureModel)
    assert orders_of(model) == {"bias_x": 3, "scale_y": 1}
    reference = model.constants(campaign.motion)[0].value
    shift = reference - MIDDLE
    k1, k2, k3 = CUBIC
    told = {
        "bias_x_1": k1 + 2 * k2 * shift + 3 * k3 * shift**2,
        "bias_x_2": k2 + 3 * k3 * shift,
        "bias_x_3": k3,
        "scale_y_1": SLOPE,
    }
    sigma = np.sqrt(np.diag(cause.covariance))
    error = cause.values - np.array([told[p.name] for p in model.parameters])
    assert np.abs(error / sigma).max() < 4
    assert sigma[1] < 0.1 * abs(k2)


@pytest.mark.slow
def test_a_bend_is_a_knot_at_its_temperature(plan):
    def bent(above: Array, read: Array, time: Array) -> Array:
        change = np.zeros_like(read)
        change[:, 4] = np.radians(1e-3) * np.maximum(above - 7.0, 0.0)
        return change

    dense = soaks.soak(np.arange(-20, 61, 10), 5.0)
    models = found(dense, 3, bent)
    assert set(models) == {"gyro"}
    assert orders_of(models["gyro"]) == {"bias_y": 0}
    assert models["gyro"].knots["bias_y"] == pytest.approx(MIDDLE + 7.0, abs=1.0)


@pytest.mark.slow
def test_bends_of_several_parameters_leave_no_random_walk(plan):
    """What a cubic leaves of a bend looks like a random walk, or a bias per log."""

    def bent(above: Array, read: Array, time: Array) -> Array:
        change = np.zeros_like(read)
        change[:, 0] = 2e-4 * np.maximum(above - 3.0, 0.0)
        change[:, 1] = -1e-4 * above + 3e-4 * np.maximum(above + 5.0, 0.0)
        return change

    dense = soaks.soak(np.arange(-20, 61, 10), 5.0)
    campaign = soaks.recorded(dense, 23, bent)
    effects = [CATALOGUE["accel_bias_ramp"]]
    selection = select_with_temperature(campaign, effects, LEVEL, TEMPERATURE_LEVEL, np.inf)
    (cause,) = selection.named.causes
    (model,) = selection.effects
    assert (cause.effect, cause.verdict, selection.random_walks) == (SEEN[0], "found", (0.0, 0.0))
    assert isinstance(model, TemperatureModel)
    assert orders_of(model) == {"bias_x": 0, "bias_y": 0}
    assert model.knots["bias_x"] == pytest.approx(MIDDLE + 3.0, abs=1.0)
    assert model.knots["bias_y"] == pytest.approx(MIDDLE - 5.0, abs=1.0)


def test_a_knot_that_may_be_anywhere_is_in_the_middle_and_has_no_shift():
    """A single temperature below it: any knot between −20 and 30 °C describes the readings."""

    def bent(above: Array, read: Array, time: Array) -> Array:
        change = np.zeros_like(read)
        change[:, 2] = 1e-3 * np.maximum(above, 0.0)
        return change

    few = soaks.soak((-20, 30, 36, 42, 48, 54, 60), 20.0)
    for rows in few.rows:
        rows["temperature"] = ICE_POINT + np.round(rows["temperature"] - ICE_POINT)
    model = found(few, 29, bent)["accel"]
    assert orders_of(model) == {"bias_z": 0}
    assert Piece("bias_z", SHIFT) not in model.pieces
    assert MIDDLE - 20 < model.knots["bias_z"] < MIDDLE + 5


@pytest.mark.slow
def test_cross_terms_are_functions_of_temperature(plan):
    def crossed(above: Array, read: Array, time: Array) -> Array:
        change = np.zeros_like(read)
        change[:, 2] = 3e-7 * above**2 * read[:, 0]
        return change

    models = found(plan, 5, crossed)
    assert {s: orders_of(m) for s, m in models.items()} == {"accel": {"cross_zx": 2}}


def test_no_function_where_there_is_none(plan):
    assert not found(plan, 7, soaks.nothing)


def test_a_straight_line_is_one_of_the_axis_that_has_it(plan):
    def straight(above: Array, read: Array, time: Array) -> Array:
        return 1e-6 * np.outer(above, [300, 0, 0, 0, 0, 0])

    assert orders_of(found(plan, 9, straight)["accel"]) == {"bias_x": 1}


def test_over_a_few_kelvin_straight_lines_are_effects_of_the_catalogue():
    def straight(above: Array, read: Array, time: Array) -> Array:
        return 1e-6 * np.outer(above, [300, 0, 0, 0, 0, 0])

    assert not found(soaks.soak((16, 19, 22, 25)), 9, straight)


@pytest.mark.slow
def test_a_drift_in_time_is_no_curve_of_the_temperature():
    """There and back through the temperatures, so that time is no function of them."""

    def drift(above: Array, read: Array, time: Array) -> Array:
        change = np.zeros_like(read)
        change[:, 0] = 5e-4 * np.exp(-time / 3000)
        return change

    plan = soaks.soak((-20, 10, 40, 60, 25, -5), 10.0)
    campaign = soaks.recorded(plan, 13, drift)
    effects = [CATALOGUE[f"accel_{what}"] for what in ("warm_up", "bias_ramp", "quadratic")]
    selection = select_with_temperature(campaign, effects, LEVEL, TEMPERATURE_LEVEL, np.inf)
    assert [cause.effect for cause in selection.named.causes] == ["accel_warm_up"]


@pytest.mark.slow
def test_a_warm_up_while_the_temperature_rises_is_no_curve_of_it():
    """Beside a straight line of another axis: it was a parabola and a cubic, as if for certain."""

    def line_and_drift(above: Array, read: Array, time: Array) -> Array:
        change = np.zeros_like(read)
        change[:, 0] = 1e-4 * above
        change[:, 2] = 5e-3 * np.exp(-time / 300)
        return change

    campaign = soaks.recorded(
        soaks.soak((10, 15, 20, 25, 30, 35, 40, 45, 50), 5.0), 21, line_and_drift
    )
    effects = [CATALOGUE[f"accel_{what}"] for what in ("warm_up", "bias_ramp", "quadratic")]
    selection = select_with_temperature(campaign, effects, LEVEL, TEMPERATURE_LEVEL, np.inf)
    causes = {cause.effect: cause for cause in selection.named.causes}
    assert set(causes) == {"accel_temperature", "accel_warm_up"}
    warm_up = causes["accel_warm_up"]
    assert warm_up.values[2] == pytest.approx(5e-3, abs=4 * warm_up.covariance[2, 2] ** 0.5 + 2e-4)


@pytest.mark.slow
def test_a_lag_of_the_sensors_is_found():
    """The delayed temperature by small steps of its differential equation."""
    plan, lag = soaks.ramp(), 120.0
    time = np.arange(0, plan.now, 0.5)
    course = soaks.there_and_back(time, plan.now, 10.0, 50.0)
    delayed = course.copy()
    for i in range(1, len(time)):
        delayed[i] = delayed[i - 1] + 0.5 * (course[i - 1] - delayed[i - 1]) / lag

    def late(above: Array, read: Array, at: Array) -> Array:
        change = np.zeros_like(read)
        own = np.interp(at, time, delayed) - MIDDLE
        change[:, 0] = 1e-4 * own + 1e-6 * own**2
        return change

    model = found(plan, 1, late)["accel"]
    assert orders_of(model) == {"bias_x": 2}
    assert model.lag == pytest.approx(lag, abs=15)


@pytest.mark.slow
def test_hysteresis_is_told_from_a_drift_in_time():
    """Two cycles of 40 K: 80 µg more while it warms than while it cools, twice."""
    plan = soaks.soak((0, 20, 40, 20, 0, 20, 40, 20, 0), 10.0)
    way = np.interp(np.arange(9), range(9), [0, 1, 1, -1, -1, 1, 1, -1, -1])
    ends = np.array([rows["time"].iloc[-1] for rows in plan.rows])

    def loop(above: Array, read: Array, time: Array) -> Array:
        soak = np.searchsorted(ends, time[0]) // (len(plan.rows) // 9)
        change = np.zeros_like(read)
        change[:, 2] = 4e-5 * G * way[soak]
        return change

    campaign = soaks.recorded(plan, 17, loop)
    effects = [CATALOGUE[f"accel_{what}"] for what in ("warm_up", "bias_ramp", "bias_jump")]
    selection = select_with_temperature(campaign, effects, LEVEL, TEMPERATURE_LEVEL, np.inf)
    (cause,) = selection.named.causes
    assert cause.members == ("accel_thermal_hysteresis",)
    assert cause.values[2] == pytest.approx(4e-5 * G, abs=4 * cause.covariance[2, 2] ** 0.5)


def test_hysteresis_and_a_drift_in_time_are_one_class_where_it_turns_back_once():
    """Three temperatures, the first and the last alike: a jump between them does the same."""
    plan = soaks.soak((0, 40, 0), 10.0)
    ends = np.array([rows["time"].iloc[-1] for rows in plan.rows])

    def loop(above: Array, read: Array, time: Array) -> Array:
        soak = np.searchsorted(ends, time[0]) // (len(plan.rows) // 3)
        change = np.zeros_like(read)
        change[:, 2] = 1.5e-5 * G * (0, 1, -1)[soak]
        return change

    campaign = soaks.recorded(plan, 17, loop)
    effects = [CATALOGUE[f"accel_{what}"] for what in ("warm_up", "bias_ramp", "bias_jump")]
    selection = select_with_temperature(campaign, effects, LEVEL, TEMPERATURE_LEVEL, np.inf)
    (cause,) = selection.named.causes
    assert cause.verdict == "one_of_class"
    assert {"accel_thermal_hysteresis", "accel_bias_jump"} <= set(cause.members)


def test_a_delay_is_that_of_a_first_order():
    """After a long ramp a part is behind by rate × τ; a part that a thermometer follows is ahead.

    By as much all the time, for the thermometer's own readings rise all the time.
    """
    time = np.arange(0.0, 3000.0, 10.0)
    behind, ahead = (delay(time, 0.01 * time, lag) for lag in (100.0, -100.0))
    assert behind[0] == 0.0
    assert ahead == pytest.approx(np.ones(300), rel=1e-6)
    assert behind[-1] == pytest.approx(-1.0, rel=1e-6)
    assert behind[10] == pytest.approx(-(1 - np.exp(-1)), rel=1e-9)


def test_a_thermometer_that_lags_is_led_back_to_the_part():
    """From its own first-order response to a course that turns about, by its closed formula."""
    time = np.arange(0.0, 4000.0, 20.0)
    since = np.clip(time - 2000, 0, None)
    part = 0.03 * time - 0.06 * since
    response = [0.03 * (time - 120 * (1 - np.exp(-time / 120))) - 0.06 * since]
    response.append(0.06 * 120 * (1 - np.exp(-since / 120)))
    read = np.sum(response, axis=0)
    assert np.abs(read - part).max() == pytest.approx(3.6, abs=0.01)
    recovered = read + delay(time, read, -120.0)
    assert np.abs(recovered - part).max() < 0.25 * 3.6
    away = (np.abs(time - 2000) > 60) & (time > 60)
    assert np.abs(recovered - part)[away].max() < 0.06


# ---- degrees on drawn normal equations: quicker than campaigns

COLUMNS = {f: tuple(range(3 * i, 3 * i + 3)) for i, f in enumerate(FUNCTIONS)}


def information() -> Array:
    """Of three powers of each function at nine temperatures, none at the others' expense."""
    above = np.linspace(-40, 40, 9)
    powers = np.stack([above, above**2, above**3], axis=1)
    powers -= powers.mean(axis=0)
    one = powers.T @ powers
    return np.kron(np.eye(len(FUNCTIONS)), one)


def degrees(beta: Array, rng: np.random.Generator, level: float) -> dict[str, int]:
    """Those found where the coefficients are `beta`."""
    whole = information()
    right = whole @ beta + np.linalg.cholesky(whole) @ rng.standard_normal(len(whole))
    equations = EffectInformation(("",) * len(whole), whole, right, 0.0, 100)
    return orders(SensorEquations(equations, np.diag(whole), 1.0, np.inf, level), COLUMNS)


def test_false_degrees_are_as_rare_as_accepted():
    """Of 200 draws; Bonferroni over columns that are tested together is a little cautious."""
    rng = np.random.default_rng(1)
    false = [any(degrees(np.zeros(36), rng, 0.05).values()) for _ in range(200)]
    assert 0 < np.mean(false) < 0.05 + 3 * np.sqrt(0.05 * 0.95 / 200)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_the_degree_is_right_from_an_snr_of_eight_on(order):
    """That of its highest power beside the lower ones: the bar is 0.95; and never a line."""
    rng = np.random.default_rng(order)
    whole, hits, lines = information(), 0, 0
    own = list(COLUMNS["scale_y"][:order])
    sigma = np.sqrt(np.linalg.inv(whole[np.ix_(own, own)])[-1, -1])
    for _ in range(60):
        beta = np.zeros(36)
        beta[own] = rng.normal(0, 10, order) / np.sqrt(np.diag(whole)[own])
        beta[own[-1]] = 8 * sigma
        given = degrees(beta, rng, TEMPERATURE_LEVEL / 2)
        hits += given == dict.fromkeys(FUNCTIONS, 0) | {"scale_y": order}
        lines += order > 1 and given["scale_y"] < 2
    assert hits >= 57
    assert not lines


def test_what_is_given_is_no_gain_of_a_degree():
    """A large effect that is fitted as well; the functions are constants."""
    rng = np.random.default_rng(3)
    whole = information()
    beta = np.zeros(36)
    beta[0] = 100 / np.sqrt(whole[0, 0])
    right = whole @ beta + np.linalg.cholesky(whole) @ rng.standard_normal(len(whole))
    equations = EffectInformation(("",) * len(whole), whole, right, 0.0, 100)
    tested = SensorEquations(equations, np.diag(whole), 1.0, np.inf, TEMPERATURE_LEVEL, (0,))
    others = {f: own for f, own in COLUMNS.items() if 0 not in own}
    assert not any(orders(tested, others).values())


# ---- knots on drawn normal equations of one function

ABOVE = np.linspace(-1, 1, 40)
TRIED = np.round(np.linspace(-0.8, 0.8, 33), 3).tolist()
BENDS = np.stack([np.maximum(ABOVE - at, 0.0) for at in TRIED], axis=1)
SHAPED = np.column_stack([ABOVE, ABOVE**2, ABOVE**3, BENDS])


@pytest.mark.parametrize(
    ("shape", "is_knot"), [(ABOVE**2, False), (ABOVE**3, False), (np.maximum(ABOVE, 0), True)]
)
def test_a_knot_is_told_from_a_parabola_and_a_cubic(shape, is_knot):
    """At a signal-to-noise ratio of 40, which a line with a knot leaves at least 4 of."""
    rng = np.random.default_rng(31)
    design = SHAPED - SHAPED.mean(axis=0)
    own = shape - np.polyval(np.polyfit(ABOVE, shape, 1), ABOVE)
    size = 40 / np.linalg.norm(own)
    columns = Columns(
        {"bias_x": (0, 1, 2)}, {"bias_x": dict(zip(TRIED, range(3, 36), strict=True))}
    )
    hits = 0
    for _draw in range(20):
        right = design.T @ (size * shape + rng.standard_normal(len(ABOVE)))
        whole = design.T @ design
        equations = EffectInformation(("",) * 36, whole, right, 0.0, 40)
        tested = SensorEquations(equations, np.diag(whole), 1.0, np.inf, TEMPERATURE_LEVEL)
        cubic = {"bias_x": (0, 1, 2)}
        best = best_knots(tested, columns, cubic, {"bias_x": TRIED})
        hits += bool(with_knots(tested, columns, cubic, best)) == is_knot
        assert not is_knot or abs(best["bias_x"]) < 0.15
    assert hits == 20


# ---- what the model adds to a reading

KNOTS = {
    f"{function}{side}": ICE_POINT + at + off
    for function, at in (("bias_x", 27), ("cross_yz", 31))
    for side, off in (("_below", -3), ("", 0), ("_above", 2))
}


@pytest.mark.parametrize("sensor", ["accel", "gyro"])
def test_its_terms_say_in_text_what_is_read(sensor):
    pieces = [
        *polynomials(dict.fromkeys(FUNCTIONS, 3)),
        *(Piece(f, power) for power in NAMES for f in ("bias_x", "cross_yz")),
    ]
    effect: Effect = TemperatureModel(sensor, pieces, KNOTS)
    rng = np.random.default_rng(2)
    motion = stretches(np.arange(50.0), np.ones(50), rng.uniform(280, 320, 50))
    constants = {one.name: one.value for one in effect.constants(motion)}
    effect = effect.with_constants(constants)
    truth = Truth(*rng.normal(size=(2, 50, 3)))
    nothing = Reading(np.zeros((50, 3)), np.zeros((50, 3)))
    values = rng.normal(size=len(effect.parameters))
    read = getattr(effect.reads(nothing, truth, motion, values), sensor)
    felt = {
        f"{letter}_{axis}": vector[:, i]
        for letter, vector in (("f", truth.force), ("w", truth.rate))
        for i, axis in enumerate("xyz")
    }
    names = {**constants, **felt, "T": motion.temperature}
    size = {p.name: value for p, value in zip(effect.parameters, values, strict=True)}
    for i, axis in enumerate("xyz"):
        own = [term for term in effect.terms if term.channel == f"{sensor}_{axis}"]
        assert own
        told = sum(size[term.parameter] * value_of(term.factor, names) for term in own)
        np.testing.assert_allclose(read[:, i], told, rtol=1e-12)


@pytest.mark.parametrize("name", [*TEMPERATURE_MODELS, "accel_bias_temperature"])
def test_nothing_is_extrapolated(name):
    """A kelvin beyond the campaign is what a thermometer is uncertain by; two are not known."""
    campaign = stretches(np.zeros(2), np.ones(2), np.array([280.0, 310.0]))
    effect = KNOWN[name].with_constants({c.name: c.value for c in KNOWN[name].constants(campaign)})
    own = stretches(np.zeros(4), np.ones(4), np.array([278.0, 279.5, 310.5, 312.0]))
    values = np.ones(len(effect.parameters)) * np.array(
        [not p.name.endswith(tuple(NAMES.values())) for p in effect.parameters]
    )
    ones = np.ones((4, 3))
    read = effect.reads(Reading(ones, ones), Truth(ones, ones), own, values)
    known = np.isfinite(getattr(read, name.partition("_")[0])).all(axis=1)
    assert known.tolist() == [False, True, True, False]


def test_its_cubic_is_a_cubic():
    """By numbers that do not come from the code: 2 K above T0, 5e-7 m/s²/K³ are 4e-6 m/s²."""
    effect = replace_reference(TemperatureModel("accel", [Piece("bias_z", 3)]), 300.0)
    motion = stretches(np.zeros(1), np.ones(1), np.array([302.0]))
    none = np.zeros((1, 3))
    read = effect.reads(Reading(none, none), Truth(none, none), motion, np.array([5e-7]))
    np.testing.assert_allclose(read.accel, [[0, 0, 4e-6]], rtol=1e-12)


def replace_reference(effect: TemperatureModel, kelvin: float) -> TemperatureModel:
    return effect.with_constants({"T0": kelvin})
