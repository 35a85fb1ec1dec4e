"""The result with some effects, about which the equations of a campaign are made linear."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from inertial.campaign import equations_by_hand
from inertial.campaign.equations import Campaign
from inertial.campaign.equations_by_hand import ByHand, of_a_table
from inertial.estimation import accelerometers
from inertial.estimation.effect_information import MIN_INFORMATION_SHARE
from inertial.estimation.least_squares import Estimate, with_columns
from inertial.estimation.triad import UNKNOWNS
from inertial.physics.effect import Effect
from inertial.physics.forward import Triad
from inertial.sensors import SENSORS

NOTHING = np.zeros((1, 3))  # that changes a rest


def about_effects(campaign: Campaign, effects: Sequence[Effect], prior_sigma: float) -> Campaign:
    """The same, linear about the result with those effects; `prior_sigma`: as in its `systems`."""
    if campaign.by_hand:
        return _about_changes(campaign, campaign.by_hand, effects, prior_sigma)
    return _about_leans(campaign, effects, prior_sigma)


def _about_changes(
    campaign: Campaign, by_hand: ByHand, effects: Sequence[Effect], prior_sigma: float
) -> Campaign:
    """By hand: about M and bias of the gyros, and directions at rest, that effects leave.

    A bias that warms up bends M where it is taken as constant; and directions by accelerometers
    that warm up are off alike from one position to the next, which is no scatter.
    """
    before = campaign.solution.gyro
    effects = [effect for effect in effects if not campaign.excludes(effect)]
    gyro, accel = (_determined(campaign, sensor, effects, prior_sigma) for sensor in SENSORS)
    if not effects or before is None or gyro is None or accel is None:
        return campaign
    unknowns = zip(accel.names, accel.values.tolist(), strict=True)
    sizes = {name: value for (kind, name), value in unknowns if kind == "effect"}
    responses = campaign.sensitivities("accel", effects)
    changed = [each.of([*sizes]) @ np.array([*sizes.values()]) for each in responses]
    forces = dict(zip(campaign.at_rest, changed, strict=True))
    stops = by_hand.handled.stops
    changes = np.array([forces.get(stop.forces.name, NOTHING)[0] for stop in stops])
    further = changes if by_hand.force_changes is None else changes - by_hand.force_changes
    after, gravity = accelerometers.triad_of(gyro), campaign.gravity.number
    bent = max(_bent(before, after, 1.0), np.abs(further).max() / gravity)
    if bent <= equations_by_hand.MIN_BENT:
        return campaign
    about = replace(by_hand, force_changes=changes)
    return campaign.about(replace(campaign.solution, gyro=after), about)


def _about_leans(campaign: Campaign, effects: Sequence[Effect], prior_sigma: float) -> Campaign:
    """The same, its accelerometers linear about their result with those effects of a table.

    The tilt that a reading shows is by M and bias. A lean of all positions that is not among
    the unknowns bends both, and a part of it is not seen.
    """
    leans = [effect for effect in effects if of_a_table(effect)]
    before = campaign.solution.accelerometer
    if not leans or before is None:
        return campaign
    estimate = _determined(campaign, "accel", leans, prior_sigma)
    if estimate is None:
        return campaign
    after = accelerometers.triad_of(estimate)
    if _bent(before, after, campaign.gravity.number) <= accelerometers.MIN_BENT:
        return campaign
    return campaign.about(replace(campaign.solution, accelerometer=after), None)


def _bent(before: Triad, after: Triad, unit: float) -> float:
    """The largest change of M, and of the bias in that unit."""
    changes = (after.matrix - before.matrix, (after.bias - before.bias) / unit)
    return max(float(np.abs(change).max()) for change in changes)


def _determined(
    campaign: Campaign, sensor: str, effects: Sequence[Effect], prior_sigma: float
) -> Estimate | None:
    """A sensor's unknowns with effects, where these determine its M and bias.

    Of the effects without what M and bias absorb but for rounding, which would bend them by any
    angle.
    """
    system = campaign.system(sensor, effects, prior_sigma)
    if system is None:
        return None
    reduced = system.effect_information()
    shown = np.diag(reduced.information) > MIN_INFORMATION_SHARE * system.raw_information()
    if not shown.all():
        system = with_columns(system, frozenset(np.array(reduced.names)[shown].tolist()))
    estimate = system.solve_shared()
    return estimate if estimate.determined[:UNKNOWNS].all() else None
