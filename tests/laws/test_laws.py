"""Laws of no effect of the catalogue: found with their form, proposed as effects; silence."""

from dataclasses import replace

import chain
import numpy as np
import pytest
from hidden_plans import PLANS

from inertial.campaign.effect_sentences import Estimated
from inertial.effects import LAWS
from inertial.effects.law import Law
from inertial.estimation.triad import linear_names
from inertial.model_selection.cause import LAW, Cause
from inertial.model_selection.evidence import searched_effect
from inertial.model_selection.law_evidence import best_paths, chance_of, law_odds
from inertial.model_selection.walk_odds import Equations
from inertial.physics import laws
from inertial.physics.motion import stretches
from inertial.text.units import DEGREE_PER_HOUR, HOUR
from stages.criticism.laws import law_sentence
from stages.extension.estimates import Solved
from stages.extension.laws import with_drift_in_the_bias

BESIDE = ("studies", "comparison", "compensation")


def hiding(plan, name, **told):
    """What the laboratory is told."""
    return PLANS[plan](seed=4711, effects={name: told})


def named_law(results):
    """The only cause, its law, and the sizes by parameter."""
    (cause,) = results["diagnosis/causes"].to_dict("records")
    effects = results["criticism/effects"]
    return cause, effects[effects["effect"] == cause["cause"]].set_index("parameter")


def named_in_memory(document):
    return named_law(chain.in_memory_of(document, "diagnosis", BESIDE))


@pytest.mark.slow
def test_a_cubic_drift_of_one_gyro_and_the_file_that_proposes_it(tmp_path):
    derived = tmp_path / "derived"
    document = hiding("positions", "gyro_cubic_drift", k_deg_h_h3=[0, 4, 0])
    chain.run(chain.simulate(document, tmp_path / "raw"), derived, "diagnosis", BESIDE)
    (file,) = (derived / "extension/proposed").iterdir()
    assert file.name == "gyro_y_power_of_time.py"
    results = chain.Results(derived)
    cause, sizes = named_law(results)
    assert (cause["cause"], cause["verdict"]) == ("gyro_y_power_of_time", "law")
    assert sizes.loc["shape_1", "value"] == pytest.approx(3, abs=0.5)
    size, sigma = sizes.loc["k_y", ["value", "sigma"]] / DEGREE_PER_HOUR
    assert size == pytest.approx(4, abs=4 * sigma + 0.5) and sigma < 0.5
    assert cause["sentence"].startswith("y gyro: ")
    assert cause["held_out_drop"] > 0 and cause["gain"]
    (verdict,) = results["diagnosis/verdict"].query("sensor == 'gyro'").to_dict("records")
    assert verdict["method"] == "extended"  # the 24 parameters are those with the law in the model


@pytest.mark.slow
def test_a_telegraph_of_one_gyro():
    told = {"height_deg_h": [0, 0, 0.5], "dwell_s": 400.0}
    cause, sizes = named_in_memory(hiding("positions", "gyro_telegraph", **told))
    assert (cause["cause"], cause["verdict"]) == ("gyro_z_telegraph_of_time", "law")
    apart, sigma = sizes.loc["k_z", ["value", "sigma"]] / DEGREE_PER_HOUR
    assert abs(apart) == pytest.approx(1.0, abs=4 * sigma)  # from −0.5 to 0.5 °/h


@pytest.mark.slow
def test_a_sine_of_the_angle_of_no_whole_order():
    told = {"size_deg_h": [0, 1.5, 0], "order": 2.4, "phase_deg": 30.0}
    cause, sizes = named_in_memory(hiding("stops", "gyro_stray_field", **told))
    assert (cause["cause"], cause["verdict"]) == ("gyro_y_harmonic_of_angle", "law")
    assert sizes.loc["shape_1", "value"] == pytest.approx(2.4, abs=0.05)
    both = sizes.loc[["k_cos_y", "k_sin_y"], "value"] / DEGREE_PER_HOUR
    assert both.tolist() == pytest.approx(
        1.5 * np.array([np.sin(np.pi / 6), np.cos(np.pi / 6)]), abs=0.3
    )


@pytest.mark.slow
@pytest.mark.parametrize(("size", "power"), [(1.0, 1.5), (-2.9, 1.33)])
def test_a_power_of_the_rate(size, power):
    """Of one between the steps of the grid no effect of the catalogue is named beside it."""
    told = {"at_10_deg_s_deg_h": [0, size, 0], "power": power}
    cause, sizes = named_in_memory(hiding("rates", "gyro_rate_power", **told))
    assert (cause["cause"], cause["verdict"]) == ("gyro_y_power_of_rate", "law")
    assert sizes.loc["shape_1", "value"] == pytest.approx(power, abs=0.1)
    assert sizes.loc["k_y", "value"] / DEGREE_PER_HOUR == pytest.approx(size, abs=0.1)


@pytest.mark.slow
def test_a_law_of_what_differs_from_axis_to_axis():
    """Each gyro has the product of the forces along the two others: no product of fixed axes."""
    told = {"k_deg_h_g2": [2.0, -1.5, 1.8]}
    cause, sizes = named_in_memory(hiding("rates", "gyro_anisoelasticity", **told))
    assert (cause["cause"], cause["verdict"]) == ("gyro_all_product_of_other_forces", "law")
    found, sigma = (
        sizes.loc[["k_x", "k_y", "k_z"], one].to_numpy() / DEGREE_PER_HOUR
        for one in ("value", "sigma")
    )
    assert np.abs(found - told["k_deg_h_g2"]) == pytest.approx(0.0, abs=4 * sigma.max())


@pytest.mark.slow
def test_a_temperature_coefficient_that_drifts():
    """k t (T − T₀), T₀ that of the first sample: about the mean temperature a drift is beside."""
    told = {"k_deg_h_k_h": [0.0, 1.0, 0.0]}
    cause, sizes = named_in_memory(hiding("rates", "gyro_coefficient_drift", **told))
    assert (cause["cause"], cause["verdict"]) == ("gyro_y_product_of_time_and_temperature", "law")
    value, sigma = sizes.loc["k_y", ["value", "sigma"]] / DEGREE_PER_HOUR
    assert value == pytest.approx(1.0, abs=4 * sigma) and sigma < 0.2
    assert "°/h/(h K)" in cause["sentence"]


@pytest.mark.slow
@pytest.mark.parametrize("walk", [0.0, 0.3])
def test_a_clean_campaign_and_a_random_walk_have_no_law(walk):
    document = PLANS["positions"](seed=99)
    document["noise"] = document["noise"] | {"gyro_rate_random_walk_deg_h_sqrt_h": walk}
    results = chain.in_memory_of(document, "criticism", BESIDE)
    assert not set(results["criticism/findings"]["cause"]) & set(LAWS)


@pytest.mark.parametrize(
    ("law", "warmer"),
    [
        (Law("gyro", "z", "telegraph", "time", (300 / HOUR,)), np.full(3, np.nan)),
        (Law("gyro", "z", "polynomial", "temperature", (1.0,)), np.array([0.0, 0.0, 1.0])),
    ],
)
def test_the_bias_beside_a_drift_by_a_law_is_its_mean_over_the_recording(law, warmer):
    """Of two levels, the higher one for a quarter of the time: b + k/4 ± √(σ² + 3 k²/16).

    A temperature counts from its mean: b ± √(σ² + 3 k²/16).
    """
    motion = stretches(np.array([50.0, 200.0, 350.0]), np.array([100.0, 200.0, 100.0]), warmer)
    share = 0.25 if law.state == "time" else 0.0
    names = [*linear_names(), f"{law.name}.{law.parameters[0].name}"]
    rows = [{"parameter": name, "value": 1.0, "sigma": 0.1} for name in names]
    rows[-1] |= {"value": 8.0, "sigma": 0.2}
    sigmas = np.array([0.1] * 12 + [0.2])
    own = Solved("gyro", rows, np.diag(sigmas**2), None, 0.0)
    mean = with_drift_in_the_bias(own, [law], motion, slice(0, 3))
    values = {row["parameter"]: (row["value"], row["sigma"]) for row in mean.rows}
    scatter = np.sqrt(3 / 16) * 8.0
    sigma = np.sqrt(0.1**2 + (0.2 * share) ** 2 + scatter**2)
    assert values.pop("bias_z") == pytest.approx((1.0 + 8 * share, sigma))
    assert values.pop(names[-1]) == (8.0, pytest.approx(0.2))
    assert all(value == pytest.approx((1.0, 0.1)) for value in values.values())
    assert mean.covariance[-1, 11] == pytest.approx(0.2**2 * share, abs=1e-12)


# ---- Functions, and their search.


def test_means_of_functions_over_stretches():
    motion = stretches(np.array([100.0, 300.0]), np.array([200.0, 200.0]), np.full(2, np.nan))
    (cubic,) = laws.functions("power", "time", (3.0,), motion, 0).T
    exact = np.diff(np.array([0.0, 200.0, 400.0]) ** 4) / (4 * 200 * HOUR**3)
    np.testing.assert_allclose(cubic, exact, rtol=1e-9)
    (ramp,) = laws.functions("ramp", "time", (250 / HOUR,), motion, 0).T
    np.testing.assert_allclose(ramp * HOUR, [0.0, 150**2 / 2 / 200], rtol=1e-9)
    (levels,) = laws.functions("telegraph", "time", (50 / HOUR, 250 / HOUR), motion, 0).T
    np.testing.assert_allclose(levels, [0.75, 0.25], rtol=1e-9)


def test_states_and_their_functions():
    """A rate that grows, a harmonic of the angle, a temperature that rises by 2 K a minute."""
    still = stretches(
        np.array([0.0, 60.0, 120.0]), np.full(3, 4.0), np.array([290.0, 292.0, 294.0])
    )
    x_axis, degree = np.eye(3)[0], np.radians(1.0)
    rates, angles = np.array([10.0, 20.0, -10.0]) * degree, np.array([0.3, 1.0, 2.0])
    motion = replace(still, about=x_axis, rate=rates, angle=angles, up=np.tile([0, 0, 1.0], (3, 1)))
    growing = replace(motion, acceleration=np.full(3, degree))
    later = laws.state("rate", growing, 0)
    first_of_all = later - later[:, [2]]  # the middle of a stretch is the third of five
    np.testing.assert_allclose(later[:, 2], [1.0, 2.0, -1.0])
    nodes = np.polynomial.legendre.leggauss(5)[0]  # of 4 s, in which it grows by 4 of 10 °/s
    np.testing.assert_allclose(first_of_all, np.tile(0.2 * nodes, (3, 1)), atol=1e-12)
    powers = laws.functions("odd_power", "rate", (1.5,), motion, 0)[:, 0]
    np.testing.assert_allclose(powers, [1.0, 2**1.5, -1.0])
    both = laws.functions("harmonic", "angle", (2.4,), motion, 0)
    first, last = (2.4 * (angles + side * rates * 2.0) for side in (-1, 1))
    exact = [np.sin(last) - np.sin(first), np.cos(first) - np.cos(last)] / (last - first)
    np.testing.assert_allclose(both, exact.T, rtol=1e-6)
    tilted = replace(motion, up=np.tile([0.2, 0.5, -0.6], (3, 1)))
    for axis, (own, others) in enumerate([(0.2, -0.3), (0.5, -0.12), (-0.6, 0.1)]):
        np.testing.assert_allclose(laws.state("own_force", tilted, axis), own)
        np.testing.assert_allclose(laws.state("other_forces", tilted, axis), others)
    np.testing.assert_allclose(laws.state("temperature_rate", motion, 0)[1], 2.0)
    hours = replace(motion, time=np.array([0.0, 3600.0, 7200.0]))
    unknown = replace(hours, temperature=np.array([290.0, 292.0, np.nan]))
    assert np.isnan(laws.temperature_rate(unknown)).all()  # not only about the one that lacks
    cycles = np.array(laws.grid("harmonic", "rate", motion))[:, 0] * 3 / (2 * np.pi)
    np.testing.assert_allclose(np.diff(cycles), 1 / 3)  # over the span of 30 °/s
    loops = laws.grid("hysteresis", "rate", motion)
    assert np.array(loops).max() < np.ptp(later[:, 2]) / 2


def test_a_product_of_drifts_has_any_zero_of_its_factors():
    """(t − 1 h)(T − 280 K) is no longer than its own product, the two factors and a constant."""
    hours, kelvin = np.array([0.0, 0.5, 1.0, 2.0, 3.0]), np.array([290.0, 295.0, 291.0, 299.0, 290])
    still = stretches(hours * HOUR, np.full(5, 4.0), kelvin)
    product = laws.functions("product", "time*temperature", (), still, 0)
    columns = np.column_stack([product, np.ones(5)])
    moved = (hours - 1.0) * (kelvin - 280.0)
    sizes, rest = np.linalg.lstsq(columns, moved, rcond=None)[:2]
    assert rest == pytest.approx(0.0, abs=1e-6) and sizes[0] == pytest.approx(1.0, rel=1e-6)
    of_force = replace(still, up=np.tile([0.2, 0.5, -0.6], (5, 1)))
    assert laws.functions("product", "force_x*force_y", (), of_force, 0).shape == (5, 1)


def test_what_is_odd_in_one_rate_is_the_scale_factor():
    """So it is no law: it would set the scale factor free, but for the rate of the earth."""
    x_axis, degree = np.eye(3)[0], np.radians(1.0)
    still = stretches(np.arange(4) * 60.0, np.full(4, 4.0), np.full(4, 290.0))
    one = replace(still, about=x_axis, rate=np.array([10.0, -10.0, 10.0, 0.0]) * degree)
    two = replace(one, rate=np.array([10.0, -10.0, 40.0, 0.0]) * degree)
    for family in ("polynomial", "odd_power"):
        assert laws.grid(family, "rate", one) == []
        assert laws.grid(family, "rate", two)
    assert laws.grid("power", "rate", one)
    np.testing.assert_allclose(laws.functions("polynomial", "rate", (3.0,), two, 0)[2], [16, 64])


@pytest.mark.slow
def test_noise_reaches_the_odds_as_often_as_said():
    """By campaigns of two hundred readings of noise, and laws that are random functions."""
    random = np.random.default_rng(3)
    columns = random.normal(size=(200, 60))
    searched = [searched_effect(str(i), *([3 * i + k] for k in range(3))) for i in range(20)]
    none, chances = np.zeros(20), []
    for _ in range(200):
        right = columns.T @ random.normal(size=200)
        equations = Equations(columns.T @ columns, right)
        chances.append(chance_of(equations, law_odds(equations, searched, none), none))
    assert np.mean(np.array(chances) < 0.1) == pytest.approx(0.1, abs=0.065)  # three sigma


def test_the_path_of_a_telegraph():
    random = np.random.default_rng(5)
    place = np.arange(600)
    levels = np.isin(place // 5, [*range(20, 41), *range(66, 90)]) * 1.0
    steps = (place[:, None] >= 5 * np.arange(120)).astype(float)
    right = steps.T @ (levels + random.normal(size=600) / 3)
    found = best_paths(Equations(9 * steps.T @ steps, 9 * right), range(120), 2)
    (path,) = (path for path in found if len(path) == 4)
    assert np.abs(np.array(path) - [20, 41, 66, 90]).max() <= 1


def test_a_law_whose_terms_the_plan_does_not_tell_apart_is_said_without_their_sizes() -> None:
    """Of forces that are -1, 0 or 1 g all odd powers are equal: the list of sizes was empty."""
    law = Law("gyro", "z", "polynomial", "force_x", (4.0,))
    unknown = [Estimated(p.name, p.unit, "") for p in law.parameters]
    one, none = (1.0,), np.zeros(0)
    cause = Cause(law.name, 0, LAW, (law.name,), (0,), one, one, 90.0, 2, 0.0, 9.0, (), none, none)
    assert ", ;" not in str(law_sentence(cause, law, unknown))
    known = [replace(unknown[0], value=0.1, sigma=0.01), *unknown[1:]]
    assert "± " in str(law_sentence(cause, law, known))
