"""Every effect that is sought in blocks, from the laboratory's readings: each parameter comes back.

Two recordings have the same noise; one of them has effects besides, all parameters of each by
chance. So the estimates of the two differ by the effects alone, nearly without noise, and each must
be what the laboratory put in, but for what is of second order. Sign, order of indices, factor and a
term that is left out all show.
"""

import chain
import numpy as np
import pytest
from hidden_plans import PLANS, SPANS, sensors
from hidden_ways import POSITIVE, WAYS

import laboratory
from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.campaign.observations import campaign_of
from inertial.effects import CATALOGUE
from inertial.physics.effect import Effect

PLAN = "rates"  # shows them all
RATIO = 10.0  # signal to noise of each effect
MAX_ERROR = 0.25  # sigma of a parameter that is estimated with the others of its group
# Readings are rounded to counts, differently with the effects: that leaves 0.1 to 0.3 sigma, of
# which the two parameters of a wobble show most.
MAX_ERROR_OF = {"table_wobble": 0.5}
BESIDE = ("studies", "comparison")
# No two of a group are alike, so that each parameter has a small sigma beside the others.
GROUPS = (
    (
        *("gyro_g_sensitivity", "gyro_scale_cubic", "gyro_bias_jump", "gyro_scale_temperature"),
        *("accel_cross_products", "accel_scale_temperature", "accel_bias_temperature", "lever_arm"),
    ),
    (
        *("gyro_g2_sensitivity", "gyro_scale_quadratic", "gyro_warm_up", "gyro_bias_temperature"),
        "gyro_bias_sense",
        *("accel_cubic", "accel_hysteresis", "accel_warm_up", "table_tilt"),
    ),
    (
        *("gyro_scale_asymmetry", "gyro_scale_g_dependence", "accel_scale_asymmetry"),
        *("accel_bias_jump", "earth_rate_omitted", "gyro_hysteresis"),
    ),
    (
        *("gyro_bias_ramp", "accel_quadratic", "accel_bias_ramp", "size_effect", "latitude_error"),
        *("table_axis_non_orthogonality", "heading_error"),
    ),
    ("table_wobble", "table_angle_scale", "table_inner_axis"),
    ("table_tilt_ramp",),
    ("table_tilt_jump",),
    ("mounting_shift",),
    ("gyro_scale_ramp", "accel_scale_ramp", "gyro_relaxation", "gyro_relaxation_braking"),
    ("gyro_relaxation_sense",),
    ("accel_scale_jump",),
)


def test_every_effect_with_a_way_to_hide_it_is_in_a_group():
    assert sorted(name for group in GROUPS for name in group) == sorted(WAYS)


def _campaign(sensed, effects) -> Campaign:
    document = PLANS[PLAN](seed=77, effects=effects)
    document["truth"] |= sensed
    recording = laboratory.perform(laboratory.specify(document))
    (data,) = chain.mounts(chain.in_memory(recording, "gyroscope", BESIDE))
    return campaign_of(data).without_random_walks()


def _estimates(campaign: Campaign, effects: list[Effect]):
    total = evidence(campaign, effects).total
    return np.linalg.solve(total.information, total.right), np.linalg.inv(total.information)


@pytest.fixture(scope="module")
def sensed():
    return sensors(np.random.default_rng(77))


@pytest.fixture(scope="module")
def without(sensed):
    return _campaign(sensed, {})


@pytest.mark.slow
@pytest.mark.parametrize(
    "group",
    [pytest.param(g, id=g[0]) for g in GROUPS],
)
def test_each_parameter_comes_back(group, sensed, without):
    random = np.random.default_rng(sum(map(len, group)))
    effects, hidden, truth = [], {}, []
    for name in group:
        way, effect, extra = WAYS[name], CATALOGUE[name], {}
        if way.scan is not None:
            at = float(random.uniform(*way.scan[1:]) * (SPANS[PLAN] if way.share else 1.0))
            effect, extra = effect.fixed(at), {way.scan[0]: at}
        assert way.names == tuple(parameter.name for parameter in effect.parameters)
        values = random.normal(size=len(way.names))
        if name in POSITIVE:
            values = np.abs(values)
        information = evidence(without, [effect]).total.information
        values *= RATIO / np.sqrt(values @ information @ values)
        effects.append(effect)
        truth.append(values)
        hidden[name] = way.told(values) | extra
    found, covariance = _estimates(_campaign(sensed, hidden), effects)
    before, _ = _estimates(without, effects)
    off = (found - before - np.concatenate(truth)) / np.sqrt(np.diag(covariance))
    names = [f"{e.name}.{p.name}" for e in effects for p in e.parameters]
    assert not {
        name: round(float(x), 2)
        for name, x in zip(names, off, strict=True)
        if not abs(x) < MAX_ERROR_OF.get(group[0], MAX_ERROR)
    }
