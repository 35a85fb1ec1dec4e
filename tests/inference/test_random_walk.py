"""A bias that walks: its size comes back, the bias keeps its sigma, and nothing else is a walk."""

from dataclasses import replace

import numpy as np
import pytest
from inference.walking import DEGREE_PER_HOUR, EARTH, TILT, UNIT, campaign
from scipy.stats import chi2

from inertial.estimation import accelerometers
from inertial.estimation.accelerometers import Reference, StaticForce
from inertial.estimation.effect_information import Sensitivities
from inertial.estimation.elimination import EquationBlock, eliminate
from inertial.estimation.gyroscopes import fit as fit_gyroscopes
from inertial.estimation.gyroscopes import joint, linearisation_at, linearised
from inertial.estimation.random_walk import Stretch, with_drifts

G, GRAVITY_SIGMA = 9.7936174, 1e-6
NOISE = 0.0064 / 60  # m/s/√s
FORCE_UNIT = 1e-6 * G / 60  # 1 µg/√h, in m/s²/√s


def test_the_covariance_of_the_stretches_is_that_of_the_walk():
    """Unknowns and relations say the same as the double integral of min(s, t)."""
    rng = np.random.default_rng(1)
    starts, seconds = np.array([0.0, 400.0, 410.0, 900.0]), np.array([300.0, 10.0, 200.0, 50.0])
    walk, scatter, sigma = 0.7, 3.0, 2.0
    zero = 410.0  # the end that is nearest to the middle
    times = [np.linspace(a, a + t, 1001) - zero for a, t in zip(starts, seconds, strict=True)]
    covariance = np.array(
        [
            [
                np.minimum(np.abs(s)[:, None], np.abs(t))[np.sign(s)[:, None] == np.sign(t)].sum()
                / (len(s) * len(t))
                for t in times
            ]
            for s in times
        ]
    )
    covariance = walk**2 * covariance + (scatter**2 + sigma**2) * np.eye(4)
    observed = rng.standard_normal((4, 3)) * 10
    information = np.linalg.inv(covariance)
    expected = information.sum(axis=0) @ observed / information.sum()

    parts = []
    for i, mean in enumerate(observed):
        rows = np.column_stack([np.eye(3), mean]) / sigma
        stretch = Stretch(str(i), "", starts[i], seconds[i])
        parts.append((EquationBlock(rows, (), 3, 6 * np.log(sigma)), stretch))
    every, of_drifts = with_drifts(parts, 3, 0, scatter, walk)
    rows, eliminated = eliminate(every, 3, of_drifts)
    found = np.linalg.lstsq(rows[:, :3], rows[:, 3])[0]
    np.testing.assert_allclose(found, expected, rtol=1e-3)
    np.testing.assert_allclose(
        rows[:, :3].T @ rows[:, :3], information.sum() * np.eye(3), rtol=1e-3, atol=1e-12
    )
    # −2 log of the likelihood, the bias fitted: the same but for the axes, of which there are 3.
    left = rows[:, 3] - rows[:, :3] @ found
    direct = 3 * np.linalg.slogdet(covariance)[1]
    direct += np.sum((observed - expected) * (information @ (observed - expected)))
    assert left @ left + eliminated.deviance == pytest.approx(direct, rel=1e-3)


@pytest.mark.slow
def test_a_walk_of_the_gyros_comes_back_and_the_bias_keeps_its_sigma():
    """0.5 °/h/√h on S0's noise: by the end of the 50 minutes 0.45 °/h, 20 sigma of white noise."""
    size = 0.5 * UNIT
    runs = [campaign(seed, size) for seed in range(10)]
    fits = [fit_gyroscopes(run.stills, run.turns, [], EARTH, TILT) for run in runs]
    assert sum(fit.random_walk > 0 for fit in fits) >= 9
    found = [(run, fit) for run, fit in zip(runs, fits, strict=True) if fit.random_walk]
    of_walk = np.array([(fit.random_walk - size) / fit.random_walk_sigma for _, fit in found])
    assert abs(of_walk.mean()) < 1
    assert 0.4 < of_walk.std() < 1.7
    assert np.mean([fit.random_walk_sigma for _, fit in found]) == pytest.approx(
        0.25 * size, rel=0.4
    )
    pulls = [(f.estimate.values[9:12] - r.bias) / f.estimate.sigma[9:12] for r, f in found]
    assert 0.65 < np.std(pulls) < 1.4  # of some 30, which scatter by 13 %
    # With sigmas of noise alone they would be several times as large.
    alone = [joint(r.stills, r.turns, [], EARTH, TILT) for r, _ in found[:4]]
    plain = [
        (e.values[9:12] - r.bias) / e.sigma[9:12] for e, (r, _) in zip(alone, found, strict=False)
    ]
    assert np.std(plain) > 2.5


def test_clean_campaigns_have_no_walk():
    for seed in range(100, 108):
        run = campaign(seed)
        fit = fit_gyroscopes(run.stills, run.turns, [], EARTH, TILT)
        assert fit.random_walk == 0
        assert fit.scatter == 0


@pytest.mark.parametrize("one_clock", [True, False])
def test_what_differs_with_the_attitude_is_no_walk(one_clock):
    run = campaign(3, g_sensitivity=1.2 * DEGREE_PER_HOUR, one_clock=one_clock)
    fit = fit_gyroscopes(run.stills, run.turns, [], EARTH, TILT)
    assert fit.random_walk == 0
    assert fit.scatter > 1e-6


def test_a_steady_drift_is_no_walk():
    run = campaign(5)
    hour = 2 * DEGREE_PER_HOUR / 3600  # rad/s²
    stills = [
        replace(one, mean=one.mean + hour * (one.stretch.start + one.stretch.end) / 2)
        for one in run.stills
    ]
    turns = [
        replace(one, sums=one.sums + hour * one.stretch.start * one.seconds[:, None])
        for one in run.turns
    ]
    fit = fit_gyroscopes(stills, turns, [], EARTH, TILT)
    assert fit.random_walk == 0
    assert fit.scatter > 1e-7


def test_without_a_common_clock_a_walk_between_logs_is_a_scatter():
    run = campaign(4, UNIT, one_clock=False)
    fit = fit_gyroscopes(run.stills, run.turns, [], EARTH, TILT)
    assert fit.random_walk == 0
    assert fit.scatter > 0


def named(run, walk: float) -> bool:
    """Whether g-sensitivity or a ramp of the bias is named at 1 %."""
    names = [f"g{i}{j}" for i in range(3) for j in range(3)] + [f"ramp{i}" for i in range(3)]

    def traces(one):
        told = [np.eye(3)[i] * one.position.up[j] for i in range(3) for j in range(3)]
        told += [np.eye(3)[i] * (one.stretch.start + one.stretch.end) / 2 for i in range(3)]
        return np.column_stack(told)

    stills = [
        replace(one, sensitivities=Sensitivities(tuple(names), traces(one))) for one in run.stills
    ]
    turns = [
        replace(
            one,
            sensitivities=Sensitivities(tuple(names), np.tile(traces(one), (len(one.sums), 1, 1))),
        )
        for one in run.turns
    ]
    around = linearisation_at(joint(run.stills, run.turns, [], EARTH, TILT), EARTH)
    wide = dict.fromkeys(names[:9], DEGREE_PER_HOUR) | dict.fromkeys(names[9:], 1e-9)
    system = linearised(around, turns, [], EARTH, TILT, wide).system(stills, walk=walk)
    reduced = system.effect_information()
    chances = [chi2.sf(*reduced.drop(some)) for some in (range(9), range(9, 12))]
    return min(chances) < 0.01 / 2


@pytest.mark.slow
def test_a_walk_is_taken_for_an_effect_unless_the_equations_carry_it():
    runs = [campaign(seed, 0.3 * UNIT) for seed in range(200, 212)]
    assert sum(named(run, 0.0) for run in runs) > 6
    assert sum(named(run, 0.3 * UNIT) for run in runs) <= 1


def test_a_walk_of_the_accelerometers_comes_back():
    """20 µg/√h, six positions three times over: 2 hours."""
    size, found = 20 * FORCE_UNIT, []
    for seed in range(8):
        rng = np.random.default_rng(seed)
        rests, time, drift = [], 0.0, np.zeros(3)
        for number in range(18):
            up = (1.0 - 2 * (number % 2)) * np.eye(3)[number // 2 % 3]
            step = size * np.sqrt(300.0)
            before, drift = drift, drift + step * rng.standard_normal(3)
            mean = G * up + (before + drift) / 2 + step / np.sqrt(12) * rng.standard_normal(3)
            sigma = np.full(3, NOISE / np.sqrt(300.0))
            stretch = Stretch(str(number), "", time, 300.0)
            mean += sigma * rng.standard_normal(3)
            rests.append(StaticForce(f"{number}", up, mean, sigma, stretch=stretch))
            time += 360.0
            drift = drift + size * np.sqrt(60.0) * rng.standard_normal(3)
        found.append(accelerometers.fit(rests, Reference(G, GRAVITY_SIGMA, 1e-7)))
    walks = np.array([fit.random_walk for fit in found])
    assert np.all(walks > 0)
    pulls = np.array([(fit.random_walk - size) / fit.random_walk_sigma for fit in found])
    assert abs(pulls.mean()) < 1
    assert 0.4 < pulls.std() < 1.7
