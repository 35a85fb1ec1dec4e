"""What a campaign could have seen, and which manoeuvre would split a class."""

from itertools import combinations

import numpy as np
import pytest

from inertial.estimation.effect_information import EffectInformation
from inertial.model_selection.detection_limits import (
    ABSORBED,
    NOT_EXCITED,
    ONLY_TOGETHER,
    VISIBLE,
    visible,
)
from inertial.model_selection.evidence import Evidence, searched_effect
from inertial.model_selection.naming import causes
from inertial.model_selection.null_simulation import chance
from inertial.model_selection.splitting import Pair, Split, split
from stages.criticism.block_sentences import split_sentence
from stages.criticism.class_splitting import Splitting
from tests.inference.naming_evidence import plan_of, whitened
from tests.inference.naming_plans import catalogue, times_of_jumps


def test_five_sigma_are_those_of_a_plain_fit():
    p = plan_of("b")
    seen = {(one.effect, one.parameter): one for one in visible(quiet("b"), p.effects)}
    r, ((sigma, columns), _) = whitened("b")
    traces, _ = catalogue(r, times_of_jumps("b"))["heading"]
    design = np.column_stack([columns, traces[0].reshape(len(sigma), -1) / sigma[:, None]])
    size = np.sqrt(np.sum(design**2, axis=0))
    covariance = np.linalg.inv((design / size).T @ (design / size))
    by_hand = 5 * np.sqrt(covariance[-1, -1]) / size[-1]
    assert seen["heading", 0].size == pytest.approx(by_hand, rel=1e-6)
    # Design study: a heading error of 3.4° with a gyro of 0.1 °/√h.
    assert np.degrees(by_hand) == pytest.approx(3.4, rel=0.2)


def test_what_is_not_seen_has_a_reason():
    p = plan_of("b")
    seen = {one.effect: one for one in visible(quiet("b"), p.effects)}
    assert seen["accel_cross"].reason == NOT_EXCITED  # no axis is ever between two others
    assert seen["accel_k3"].reason == ABSORBED  # ±1 cubed is ±1: a scale factor
    assert seen["mounting"].reason == ABSORBED  # a rotation of the case: cross terms
    assert np.isnan(seen["accel_k3"].size)
    assert seen["accel_k2"].reason == VISIBLE
    scanned = seen["gyro_jump"]
    assert scanned.best < scanned.size < scanned.worst
    assert 0 < seen["latitude"].share < 1


def test_parameters_that_are_seen_together_alone():
    information = np.ones((2, 2))
    said = EffectInformation(("a", "b"), information, np.zeros(2), 5.0, 5)
    seen = visible(
        Evidence((said,), ("gyro",), raw=np.ones((1, 2))), [searched_effect("pair", [0, 1])]
    )
    assert [one.reason for one in seen] == [ONLY_TOGETHER] * 2


def test_the_manoeuvre_that_splits_a_class_is_found():
    """Turns up at one rate and down at another: the same rates at opposite gravity split."""
    p, rng = plan_of("c"), np.random.default_rng(1)
    law = chance(p.information, p.effects, 0.01, draws=1000)
    beta, _ = p.signal("gyro_scale_g", 12.0, rng)
    said = p.draw(beta, rng)
    found = causes(said, p.effects, law).causes
    (one,) = found
    assert "gyro_quadratic" in one.members
    names = ("c, same rates at opposite g", "c, all rests again")
    further = {name: quiet(name).total for name in names}
    best, other = split(said.total, further, p.effects, found, 0)
    assert best.manoeuvre == names[0]
    now = {frozenset((pair.first, pair.second)): pair for pair in best.pairs}
    for nonlinearity in ("gyro_quadratic", "gyro_cubic"):
        pair = now[frozenset(("gyro_scale_g", nonlinearity))]
        assert pair.present < 3.3 < pair.extended
    # Both are of the rate alone: two rates in each direction do not tell them apart.
    assert not now[frozenset(("gyro_quadratic", "gyro_cubic"))].distinct
    assert other.rank < best.rank


def test_the_manoeuvre_that_splits_the_most_probable_pair_comes_first():
    """Of 43, 43, 7 and 5 %, the first two hold 3/5 of all that is open between any two."""
    members, shares = ("asymmetry", "quadratic", "jump", "hysteresis"), (0.43, 0.43, 0.07, 0.05)

    def of(name: str, *distinct: tuple[str, str]) -> Split:
        pairs = [
            Pair(a, b, 0.1, 5.5 + p * q if (a, b) in distinct else 0.2, p * q)
            for (a, p), (b, q) in combinations(zip(members, shares, strict=True), 2)
        ]
        return Split(name, tuple(sorted(pairs, key=lambda pair: -pair.extended)))

    others = [pair for pair in combinations(members, 2) if pair != members[:2]]
    faster, between = of("faster", *others), of("45°", members[:2])
    assert between.rank > faster.rank
    assert (between.pair.first, between.pair.second) == members[:2]
    assert {faster.pair.first, faster.pair.second} & set(members[:2])
    said = split_sentence(Splitting("rest at 45°", ("accel_quadratic", "accel_bias_jump"), 5.5, 4))
    assert "To distinguish accelerometer quadratic term from accelerometer bias jump, rest" in said


def test_a_separation_is_what_simulation_gives():
    """Root of the mean difference of chi-squared of the wrong member and the right one."""
    p, rng = plan_of("c"), np.random.default_rng(2)
    law = chance(p.information, p.effects, 0.01, draws=1000)
    beta, _ = p.signal("gyro_scale_g", 12.0, rng)
    said = p.draw(beta, rng)
    found = causes(said, p.effects, law).causes
    name = "c, same rates at opposite g"
    after = plan_of(name)
    (one,) = split(said.total, {name: quiet(name).total}, p.effects, found, 0)
    pair = one.pairs[0]
    columns = [list(p.effects[p.index(e)].candidates[0]) for e in (pair.first, pair.second)]
    lost = []
    for right, wrong in (columns, columns[::-1]):
        truth = np.zeros(len(beta))
        truth[right] = said.total.estimate(right)[0]
        draws = [after.draw(truth, rng).total for _ in range(100)]
        lost.append(np.mean([d.drop(right)[0] - d.drop(wrong)[0] for d in draws]))
    scatter = 2 * pair.extended / np.sqrt(100)
    assert min(lost) == pytest.approx(pair.extended**2, abs=4 * scatter)


def quiet(plan: str) -> Evidence:
    p = plan_of(plan)
    return p.draw(np.zeros(p.raw.shape[1]), np.random.default_rng(0))
