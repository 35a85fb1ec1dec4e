"""A test that knows which effect was put in, on the same readings as the search.

By hand the scatter of rests, its kind too, is not known: without the effect another kind may
describe the readings as well, and with a table a random walk of another size. So the likelihood
with the effect, in the scatter or walk that is likeliest beside it, is compared with the likelihood
without, in that which is likeliest then:

    drop = that of χ² by the effect, of n log χ² where a scatter is estimated
           − deviance that its scatter or walk loses without it to what is likeliest then

Where its p-value is not below the one from which the search names, no search can name it.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize_scalar

from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.equations import Campaign
from inertial.campaign.observations import campaign_of
from inertial.campaign.scatter_given_effects import NAMED_PRIOR_SIZE, likely_walk, scattered
from inertial.estimation.probability import chi2_sf, f_isf, f_sf
from inertial.estimation.scatter_and_random_walk import Scatter, likeliest
from inertial.physics.effect import Effect
from stages.criticism.effect_selection import evidence_of, scatter_tests_of

SENSORS = ("gyro", "accel")
SCALES = (-3.0, 3.0)  # natural logarithms of a common factor of all scatters


def p_value(data: CampaignData, effect: Effect, sensor: str) -> tuple[float, bool]:
    """Of an effect at the value of its scan that was put in; and whether beside a scatter.

    That there is one is known without the effect only: it may be all that the scatter is.
    """
    noise, base = data.noise.degrees, campaign_of(data).without_drift_at_rest()
    given = scattered(base, [effect], noise).without_random_walks()
    beside = sensor in scattered(base, [], noise).scattering
    test = _beside_scatter if beside else _beside_walk
    return test(given, effect, sensor, noise), beside


def _beside_scatter(given: Campaign, effect: Effect, sensor: str, noise: float) -> float:
    said, searched = evidence_of(given, {effect.name: (effect,)}, np.inf)
    tests = scatter_tests_of(said, searched[:1], [sensor])
    if not tests:
        return 1.0
    (test,) = tests
    used = int(test.used[0])
    left = test.degrees - used
    ratio = float(f_isf(np.maximum(test.p_values[0], np.finfo(float).tiny), used, left))
    drop = test.degrees * np.log1p(ratio * used / left)
    if sensor == "gyro":
        drop = max(drop - _lost(given, noise), 0.0)
    return float(f_sf(np.expm1(drop / test.degrees) * left / used, used, left))


def _lost(given: Campaign, noise: float) -> float:
    """By how much the kind of scatter that goes with the effect is less likely without it."""
    by_hand = given.by_hand
    assert by_hand is not None  # else there is no scatter
    equations = given.by_scatter([], NAMED_PRIOR_SIZE)

    def deviance(scatter: Scatter) -> float:
        return float(equations(scatter).system().solve_shared().deviance)

    def scaled(log_scale: float) -> float:
        scale, own = float(np.exp(log_scale)), by_hand.scatter
        return deviance(replace(own, rate=own.rate * scale, swing=own.swing * scale))

    same = float(minimize_scalar(scaled, bounds=SCALES, method="bounded").fun)
    found, _scatter = likeliest(lambda s: equations(s).system().solve_shared(), noise)
    return max(same - float(found.estimate.deviance), 0.0)


def _beside_walk(quiet: Campaign, effect: Effect, sensor: str, noise: float) -> float:
    sizes = {one: _walk(quiet, one, [effect]) for one in SENSORS}
    lost = 0.0
    if sizes[sensor] or _walk(quiet, sensor, []):
        deviance = quiet.deviance_of_random_walk(sensor, [], NAMED_PRIOR_SIZE)
        lost = deviance(sizes[sensor]) - deviance(_walk(quiet, sensor, []))
    beside = quiet.with_random_walks((sizes["gyro"], sizes["accel"]))
    said, _searched = evidence_of(beside, {effect.name: (effect,)}, noise)
    seen = said.observable()
    own = [i for i, name in enumerate(seen.names) if name.startswith(f"{effect.label}.")]
    scaled = seen.scaled(seen.excesses(own))
    drop, used = scaled.total.drop(own)
    return float(chi2_sf(max(drop - lost, 0.0), used)) if used else 1.0


def _walk(campaign: Campaign, sensor: str, effects: Sequence[Effect]) -> float:
    return likely_walk(campaign, sensor, effects, NAMED_PRIOR_SIZE)
