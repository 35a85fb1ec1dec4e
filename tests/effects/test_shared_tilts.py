"""The tilt of a set position is one error, whichever sensor shows it and whichever way it turns."""

import chain
import numpy as np
import pytest
from hidden_plans import PLANS

import laboratory
from inertial.campaign.effect_evidence import evidence, shared_tilts
from inertial.campaign.observations import campaign_of
from inertial.effects import CATALOGUE
from inertial.sensors import SENSORS

TILT = 120.0  # arcsec, sixty times what the gyros resolve


def _campaign(document):
    recording = laboratory.perform(laboratory.specify(document))
    (data,) = chain.mounts(chain.in_memory(recording, "gyroscope", ("studies", "comparison")))
    return campaign_of(data).without_random_walks()


@pytest.fixture(scope="module")
def document():
    """From each of six positions there and back, the table off by two minutes of arc."""
    document = PLANS["stops"](seed=31)
    document["campaign"]["table"] |= {"position_sigma_arcsec": TILT}
    return document


@pytest.fixture(scope="module")
def campaign(document):
    return _campaign(document)


@pytest.mark.slow
@pytest.mark.parametrize("tilted", ["case", "axis"])
@pytest.mark.parametrize("degrees", [360, 90])
def test_the_gyros_agree_with_the_tilts_that_the_accelerometers_show(document, tilted, degrees):
    """Whether the case leans on the table, or the axis of the table with the case.

    After a quarter turn the first is as it was in body axes, the second a quarter further.
    """
    plan = document["campaign"]["plan"]
    if degrees == 90:  # there, and not back from where it then stands
        plan = [dict(m) for m in plan if not m["id"].endswith(("backward", "after"))]
        for m in plan:
            m |= {"degrees": 90} if m["do"] == "turn" else {}
    changed = {"campaign": document["campaign"] | {"plan": plan}}
    campaign = _campaign(document | changed | {"truth": document["truth"] | {"tilted": tilted}})
    assert len(shared_tilts(campaign).positions) == 6
    told = evidence(campaign, list(CATALOGUE.values()))
    for sensor in told.sensors:
        assert told.residual(sensor, ())[2] > 1e-3


def test_the_axes_of_the_table_are_not_shown_twice(campaign):
    """Where tilts alone limit what both sensors show of a quarter turn, two know it as one does.

    The turns show the accelerometers that no tilt is one of the axis, so gyros show the same one.
    """
    effect = CATALOGUE["table_axis_non_orthogonality"]
    both = evidence(campaign, [effect]).total.information
    systems = campaign.systems([effect], 1.0)
    twice = sum(system.effect_information().information for system in systems if system)
    _, quarter = np.sqrt(np.diag(np.linalg.inv(both)) / np.diag(np.linalg.inv(twice)))
    assert quarter == pytest.approx(np.sqrt(2), rel=0.02)


@pytest.mark.slow
def test_a_turn_may_be_named_by_the_other_end_of_its_axis(campaign, document):
    plan = [dict(manoeuvre) for manoeuvre in document["campaign"]["plan"]]
    for manoeuvre in plan:
        if manoeuvre["id"] == "y-up-forward":
            manoeuvre |= {"about": "-y", "degrees": -manoeuvre["degrees"]}
    renamed = _campaign(document | {"campaign": document["campaign"] | {"plan": plan}})
    for own, other in zip(
        evidence(campaign, []).sensors, evidence(renamed, []).sensors, strict=True
    ):
        assert other.chi_squared == pytest.approx(own.chi_squared, rel=1e-6)


def test_an_effect_is_of_the_sensor_whose_readings_it_changes(campaign):
    """Though by the tilts the gyros add more on the accelerometers' effects than these know."""
    effects = [effect for effect in CATALOGUE.values() if effect.name.split("_")[0] in SENSORS]
    told = evidence(campaign, effects)
    first = 0
    for effect in effects:
        columns = range(first, first := first + len(effect.parameters))
        if np.diag(told.total.information)[list(columns)].any():
            assert told.labels[told.sensor_of(columns)] == effect.name.split("_")[0]
