"""Some draws of `make challenge`: what is hidden is found, or its class is; nothing else."""

import pytest
from hidden_campaigns import run, size
from hidden_draws import draw
from hidden_scores import detected, false_names


@pytest.mark.parametrize("number", [0, 1, 2, 3, 4, 7])
def test_a_draw(number):
    one = draw(number, size)
    outcome = run(one)
    assert false_names(outcome) == []
    assert not (one.kind == "clean" and outcome["unexplained"])
    for effect in one.effects:
        assert detected(outcome, effect), (effect, one.ratio, outcome["named"])


def test_a_draw_can_be_made_again():
    assert draw(4, size) == draw(4, size)
    assert draw(4, size) != draw(10, size)
