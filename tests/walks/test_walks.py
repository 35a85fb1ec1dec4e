"""A random walk against laws: the test that is the limit, and what the stages say of clear ones."""

import numpy as np
import pytest
import walk_draws
from walk_draws import KINDS, WALKS, hidden, limits, quiet

PLAN = "stops"


def drawn(kind, ratio, number):
    random = np.random.default_rng([7, KINDS.index(kind), number])
    truth = hidden(quiet(PLAN), kind, ratio, random)
    return truth, walk_draws.drawn(PLAN, truth, random)


@pytest.mark.slow
def test_what_is_left_without_noise_is_nothing():
    """The noise of the clean campaign is taken out: it would be that of every draw."""
    said = quiet(PLAN).said
    seen = np.diag(said.information) > 0
    pulls = said.right[seen] / np.sqrt(np.diag(said.information)[seen])
    assert np.abs(pulls).max() < 0.1


@pytest.mark.slow
def test_the_size_that_is_hidden_is_in_the_blocks():
    """A ramp of SNR 30: bᵀβ̂ is 30 ± 1 along it; so the laboratory's law is the campaign's."""
    known = quiet(PLAN)
    truth, campaign = drawn("gyro_bias_ramp", 30.0, 0)
    ((column,), (size,)) = truth.columns, truth.sizes
    along = known.of(campaign).right[column] / np.sqrt(known.said.information[column, column])
    assert along * np.sign(size) == pytest.approx(30, abs=4)


@pytest.mark.slow
def test_the_likelihood_of_a_walk_is_that_of_its_path():
    """By half waves, and by the covariance of a walk from stretch to stretch in the stages."""
    known = quiet(PLAN)
    kind = "walk of three axes"
    truth, campaign = drawn(kind, 12.0, 1)
    deviance = campaign.deviance_of_random_walk("gyro", [], 1.0)
    exact = (deviance(0.0) - deviance(float(truth.walk[0]))) / 2
    assert limits(known, known.of(campaign), 12.0)[kind] == pytest.approx(exact, abs=1.0)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["walk of one axis", "gyro_bias_jump"])
def test_a_clear_drift_is_called_what_it_is(kind):
    """At an SNR of 30 the likelihood ratio and the stages say the same."""
    said = walk_draws.outcome(PLAN, kind, 30.0, 0)
    others = [one for one in KINDS if (one in WALKS) != (kind in WALKS)]
    likelihoods = said["likelihoods"]
    assert likelihoods[kind] > max(likelihoods[other] for other in others)
    assert said["right"], said
