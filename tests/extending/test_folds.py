"""What others foretell of some manoeuvres: against brute force, and where one alone shows it."""

import numpy as np
import pytest

from inertial.estimation.effect_information import EffectInformation
from inertial.estimation.least_squares import System
from stages.extension.cross_validation import (
    MIN_TRAINING_SHARE,
    CrossValidation,
    fold_of,
    groups,
    snr_squared,
)
from stages.extension.models import SensorEvidence

NAMES = tuple("abcdef")
TRUTH = np.array([3.0, -2.0])  # of the effects


def campaign(seed: int, size: float = 1.0, effects: int = 2) -> tuple[np.ndarray, ...]:
    """Ten readings of each of six manoeuvres: a bias, a slope, and what the effects add."""
    random = np.random.default_rng(1)
    n = 10 * len(NAMES)
    nuisance = np.column_stack([np.ones(n), random.normal(size=n)])
    columns = random.normal(size=(n, effects))
    noise = np.random.default_rng(seed).normal(size=n)
    return nuisance, columns, nuisance @ [5.0, 1.0] + columns @ (size * TRUTH[:effects]) + noise


def told(parts: tuple[np.ndarray, ...], only: np.ndarray, wide: float = 1e3) -> EffectInformation:
    nuisance, columns, observed = (part[only] for part in parts)
    k = columns.shape[1]
    names = [("parameter", "0"), ("parameter", "1"), *(("effect", str(i)) for i in range(k))]
    return System(
        np.hstack([nuisance, columns]),
        observed,
        np.ones(len(observed)),
        np.zeros(2 + k),
        np.array([1e4, 1e4, *[wide] * k]),
        2,
        tuple(names),
    ).effect_information()


def manoeuvre(number: int) -> np.ndarray:
    return np.arange(10 * len(NAMES)) // 10 == number


EVERY = np.ones(10 * len(NAMES), bool)


def test_the_drop_is_that_of_the_residuals_foretold_with_one_covariance():
    parts = campaign(3)
    nuisance, columns, observed = parts
    for number, name in enumerate(NAMES):
        out = manoeuvre(number)
        one = fold_of([name], told(parts, EVERY), told(parts, ~out))
        # By hand: fit bias and slope to the others, with and without the effects that they show.
        whole = np.hstack([nuisance, columns])
        beta = np.linalg.lstsq(whole[~out], observed[~out], rcond=None)[0][2:]
        np.testing.assert_allclose(one.beta, beta, rtol=1e-5)
        spread = np.linalg.inv(nuisance[~out].T @ nuisance[~out])
        covariance = np.eye(10) + nuisance[out] @ spread @ nuisance[out].T
        chi_squared = []
        for effect in (np.zeros(2), beta):
            left = observed - columns @ effect
            fitted = np.linalg.lstsq(nuisance[~out], left[~out], rcond=None)[0]
            missed = left[out] - nuisance[out] @ fitted
            chi_squared.append(missed @ np.linalg.solve(covariance, missed))
        np.testing.assert_allclose(one.drop, chi_squared[0] - chi_squared[1], rtol=1e-4)


def test_no_width_that_the_effects_had_beforehand_is_in_it():
    parts, rest = campaign(4), ~manoeuvre(2)
    drops = [
        fold_of("c", told(parts, EVERY, wide), told(parts, rest, wide)).drop for wide in (10.0, 1e7)
    ]
    assert drops[0] == pytest.approx(drops[1], rel=1e-9)


def test_the_drop_is_the_part_of_snr_squared_that_was_taken_away():
    ratios, totals = [], []
    for seed in range(200):
        parts = campaign(seed, size=0.5)
        whole = told(parts, EVERY)
        folds = [fold_of(n, whole, told(parts, ~manoeuvre(i))) for i, n in enumerate(NAMES)]
        assert all(one.counts for one in folds)
        drop, stake = (
            sum(getattr(one, name) for one in folds) for name in ("drop", "expected_drop")
        )
        ratios.append(drop / stake)
        totals.append(drop / snr_squared(whole))
    # Two parameters of SNR² near 190 cost about 2 of it; the folds hold everything once.
    assert 0.95 < np.mean(ratios) < 1.02
    assert 0.9 < np.mean(totals) < 1.2


def test_an_effect_that_is_not_there_gains_nothing():
    drops = []
    for seed in range(100):
        parts = campaign(seed, size=0.0)
        whole = told(parts, EVERY)
        drops.append(
            sum(fold_of(n, whole, told(parts, ~manoeuvre(i))).drop for i, n in enumerate(NAMES))
        )
    assert np.mean(drops) < 0  # on average it costs its two parameters
    assert np.mean(drops) > -5


def test_a_manoeuvre_that_alone_shows_the_effect_is_not_counted():
    nuisance, columns, observed = campaign(5, effects=1)
    columns = columns * manoeuvre(1)[:, None]
    parts = (nuisance, columns, nuisance @ [5.0, 1.0] + 4 * columns[:, 0] + observed * 0)
    whole = told(parts, EVERY)
    folds = [fold_of(n, whole, told(parts, ~manoeuvre(i))) for i, n in enumerate(NAMES)]
    assert [one.counts for one in folds] == [True, False, True, True, True, True]
    assert folds[1].kept < MIN_TRAINING_SHARE and folds[1].drop == 0.0
    nothing = fold_of(NAMES, whole, None)
    assert not nothing.counts and nothing.drop == 0.0


def test_a_fold_that_cannot_tell_all_of_the_effect_is_not_compared_with_a_walk():
    """A bias jump that one position alone shows in one axis; a walk follows it from its own rest.

    With it a right jump was "predicted no better", by 620 of chi-squared.
    """
    nuisance, columns, _ = campaign(6)
    columns = columns * np.column_stack([EVERY, manoeuvre(1)])
    noise = np.random.default_rng(6).normal(size=len(EVERY))
    parts = (nuisance, columns, nuisance @ [5.0, 1.0] + columns @ TRUTH + noise)
    whole = told(parts, EVERY)
    trainings = [told(parts, ~manoeuvre(i)) for i in range(len(NAMES))]
    folds = [fold_of(n, whole, training) for n, training in zip(NAMES, trainings, strict=True)]
    assert [one.counts for one in folds] == [True] * len(NAMES)
    evidence = [SensorEvidence(None, one, by) for one, by in ((whole, 90.0), (whole, 80.0))]
    pairs = [(fold, evidence[1]) for fold in folds]
    validated = CrossValidation("accel", evidence[0], pairs, snr_squared(whole))
    assert validated.walk_drop == 60.0
    others = sum(fold.drop for fold in (folds[0], *folds[2:])) - 50.0
    assert validated.drop_against_walk == pytest.approx(others)


@pytest.mark.parametrize("alone", [False, True])
def test_effects_of_which_each_manoeuvre_shows_its_own_are_saturated(alone):
    """Ramp, asymmetry and g-dependence of a scale factor in four turns fit whatever it does.

    χ² fell by 15,800 in the fit and by 100 of 26,000 in held-out turns, and it counted.
    """
    nuisance, columns, _ = campaign(7, effects=2)
    if alone:
        columns = np.column_stack([columns[:, 0] * manoeuvre(i) for i in range(len(NAMES))])
    noise = np.random.default_rng(7).normal(size=len(EVERY))
    sizes = np.resize(TRUTH, columns.shape[1])
    parts = (nuisance, columns, nuisance @ [5.0, 1.0] + columns @ sizes + noise)
    whole = told(parts, EVERY)
    trainings = [told(parts, ~manoeuvre(i)) for i in range(len(NAMES))]
    folds = [fold_of(n, whole, training) for n, training in zip(NAMES, trainings, strict=True)]
    evidence = SensorEvidence(None, whole, 0.0)
    pairs = [(fold, evidence) for fold in folds]
    assert CrossValidation("gyro", evidence, pairs, snr_squared(whole)).saturated == alone


def test_manoeuvres_are_left_out_one_by_one_or_in_groups_through_the_plan():
    assert groups(NAMES, 12) == [(name,) for name in NAMES]
    assert groups(NAMES, 4) == [("a", "e"), ("b", "f"), ("c",), ("d",)]
