"""One set position that is off, with turns in it: what the equations tell of it.

Of a position that is off with its axis more is known: the tilt goes round in body axes.
"""

from io import StringIO

import chain
import numpy as np
import pytest
from hidden_plans import PLANS
from ruamel.yaml import YAML

import laboratory
from inertial.campaign.effect_evidence import evidence
from inertial.campaign.observations import campaign_of
from inertial.effects import CATALOGUE
from inertial.physics.motion import all_level_axes, cross
from inertial.text.units import ARC_SECOND

OFF = 70 * ARC_SECOND * np.array([0.0, 0.8, -0.6])  # rotation of the case, rad


def stated(text):
    """The campaign file, in which the position x-up is stated off by this."""
    document = YAML(typ="safe").load(text)
    for manoeuvre in document["plan"]:
        if manoeuvre["position"] == "x-up":
            up = np.eye(3)[0]
            manoeuvre["up"] = (up - cross(OFF, up)).tolist()
    written = StringIO()
    YAML(typ="safe").dump(document, written)
    return written.getvalue()


@pytest.fixture(scope="module")
def campaign():
    recording = laboratory.perform(laboratory.specify(PLANS["stops"](seed=47)))
    tables = chain.in_memory(recording, "gyroscope", ("studies", "comparison"), edit=stated)
    (data,) = chain.mounts(tables)
    return campaign_of(data).without_random_walks()


def told(campaign, effect):
    """What is found of an effect: estimate, sigma, (k,), and statistic."""
    total = evidence(campaign, [effect]).total
    covariance = np.linalg.pinv(total.information)
    estimate = covariance @ total.right
    return estimate, np.sqrt(np.diag(covariance)), float(total.right @ estimate)


@pytest.mark.slow
def test_it_is_found_with_its_size_or_its_opposite_is(campaign):
    """M takes half of a tilt from each of two opposite positions, so either may have it."""
    effect = CATALOGUE["table_position_error"]
    found = {
        each.label: told(campaign, each) for each in campaign.candidates([effect])[effect.name]
    }
    ranked = sorted(found, key=lambda label: -found[label][2])
    places = [campaign.positions[int(float(label.split("@")[1]))] for label in ranked]
    assert set(places[:2]) == {"x-up", "x-down"}
    assert found[ranked[1]][2] > 10 * found[ranked[2]][2]
    estimate, sigma, statistic = found[ranked[places.index("x-up")]]
    truth = all_level_axes(np.eye(3)[:1])[0] @ OFF
    # Two positions of 2 arcsec each, and the others.
    assert (np.abs(estimate - truth) < 4 * sigma).all() and (sigma < 4 * ARC_SECOND).all()
    assert statistic == pytest.approx((estimate / sigma) @ (estimate / sigma), rel=0.1)


@pytest.mark.slow
def test_a_shift_between_the_opposite_positions_explains_as_much(campaign):
    """No more: what follows the shift is the other half of M."""
    position, shift = (
        max(told(campaign, each)[2] for each in campaign.candidates([CATALOGUE[name]])[name])
        for name in ("table_position_error", "mounting_shift")
    )
    assert shift == pytest.approx(position, rel=0.02)


LEAN = 70 * ARC_SECOND * np.array([0.6, 0.8])  # of the axis of x-up, towards north and east, rad


@pytest.fixture(scope="module")
def leaning():
    """A campaign with it, and the truth: about the level axes of the position, (2,), rad."""
    north, east = (LEAN / ARC_SECOND).tolist()
    hidden = {"position": "x-up", "north_arcsec": north, "east_arcsec": east}
    recording = laboratory.perform(
        laboratory.specify(PLANS["stops"](seed=48, effects={"table_axis_error": hidden}))
    )
    tables = chain.in_memory(recording, "gyroscope", ("studies", "comparison"))
    (data,) = chain.mounts(tables)
    turned = recording.placements["x-up"].set_attitude.T @ [-LEAN[0], LEAN[1], 0.0]
    (level,) = all_level_axes(np.eye(3)[:1])
    return campaign_of(data).without_random_walks(), -level @ turned


@pytest.mark.slow
def test_a_position_that_is_off_with_its_axis_is_found_and_nothing_else_explains_it(leaning):
    campaign, truth = leaning
    axis, position, shift = (
        {e.label: told(campaign, e) for e in campaign.candidates([CATALOGUE[name]])[name]}
        for name in ("table_axis_error", "table_position_error", "mounting_shift")
    )
    estimate, sigma, statistic = max(axis.values(), key=lambda found: found[2])
    assert (np.abs(estimate - truth) < 4 * sigma).all() and (sigma < 4 * ARC_SECOND).all()
    assert statistic > 500
    for others in (position, shift):
        assert max(found[2] for found in others.values()) < statistic - 100
