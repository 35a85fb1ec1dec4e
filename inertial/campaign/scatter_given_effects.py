"""The scatter of positions by hand given some effects, and what contradicts all others."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from inertial.arrays import Array
from inertial.campaign.equations import Campaign
from inertial.estimation import accelerometers, gyroscopes
from inertial.estimation.accelerometers import StaticForce
from inertial.estimation.gyroscope_observations import RateSegment, StaticRate
from inertial.estimation.least_squares import Estimate
from inertial.estimation.multi_position import SCATTER_RANGE
from inertial.estimation.scatter_and_random_walk import (
    MIN_DEVIANCE_DROP,
    Scatter,
    ScatterFit,
    WalkSearch,
    contradicting,
    likeliest,
    most_likely,
    walk_search,
    with_scatter,
)
from inertial.physics.effect import Effect
from inertial.sensors import SENSORS

NAMED_PRIOR_SIZE = 1e4  # prior sigma of an effect that was named, in its typical sizes


def scattered(campaign: Campaign, effects: Sequence[Effect], noise_degrees: float) -> Campaign:
    """The campaign with the scatter and random walk of each sensor that remain given some effects.

    The scatter of the accelerometers first, for it is in the directions that the gyros are compared
    with. A random walk must be likelier than scatter alone; the scatter stays the same beside it,
    so that laws are weighed against it fairly. On a table nothing changes.
    """
    if campaign.by_hand is None:
        return campaign
    campaign = campaign.without_random_walks()
    if "accel" in campaign.solution.free:
        campaign = _with_forces(campaign, effects, noise_degrees)
    if "gyro" in campaign.solution.free:
        campaign = _with_rates(campaign, effects, noise_degrees)
    gyro, accel = (
        likely_walk(campaign, sensor, effects, NAMED_PRIOR_SIZE)
        if sensor in campaign.solution.free
        else 0.0
        for sensor in SENSORS
    )
    return campaign.with_random_walks((gyro, accel))


def _with_forces(campaign: Campaign, effects: Sequence[Effect], noise_degrees: float) -> Campaign:
    given = _forces(campaign, effects, noise_degrees)
    by_hand = campaign.by_hand
    assert by_hand is not None  # else there is no scatter
    corrected = not effects or by_hand.force_changes is not None
    plain = given if corrected else _forces(campaign, [], noise_degrees)
    return _with(
        campaign,
        force_scatter=given.scatter,
        direction_scatter=plain.scatter,
        degrees={"accel": _degrees(given.estimate, effects)} if given.scatter else {},
    )


def _forces(campaign: Campaign, effects: Sequence[Effect], noise_degrees: float) -> ScatterFit:
    return with_scatter(
        lambda size: _solved(_with(campaign, force_scatter=size), "accel", effects),
        SCATTER_RANGE,
        noise_degrees,
    )


def _with_rates(campaign: Campaign, effects: Sequence[Effect], noise_degrees: float) -> Campaign:
    """Without the stops and passages that contradict all others."""
    while True:
        by_hand = campaign.by_hand
        assert by_hand is not None  # else there is no scatter
        found, scatter = likeliest(_rates(campaign, effects), noise_degrees)
        rests = _degrees(found.estimate, effects) - 2 * len(by_hand.motions)
        degrees = {**by_hand.degrees, "gyro": rests if scatter.rate else np.inf}
        campaign = _with(campaign, scatter=scatter, degrees=degrees)
        residuals = _residuals(campaign, effects, found.estimate)
        stops, numbers = len(by_hand.handled.stops), list(residuals)
        firsts = [by_hand.handled.passages[i - stops].passage.first for i in numbers if i >= stops]
        at_rest = [i for i in numbers if i < stops]
        worst = contradicting(list(residuals.values()), at_rest, firsts)
        if not worst:
            return campaign
        campaign = _with(campaign, left_out=by_hand.left_out | {numbers[i] for i in worst})


def _degrees(estimate: Estimate, effects: Sequence[Effect]) -> int:
    return estimate.degrees - sum(len(effect.parameters) for effect in effects)


def likely_walk(
    campaign: Campaign, sensor: str, effects: Sequence[Effect], prior_size: float
) -> float:
    """The most likely random walk of the biases of a sensor; 0: none is clearly likelier.

    `prior_size`: of the effects, in their typical sizes.
    """
    search = walk_range(campaign, sensor)
    if search is None:
        return 0.0
    deviance = campaign.deviance_of_random_walk(sensor, effects, prior_size)
    alone = deviance(0.0)
    size, smallest = most_likely(deviance, search.bounds, alone)
    return size if alone - smallest >= MIN_DEVIANCE_DROP else 0.0


def walk_range(campaign: Campaign, sensor: str) -> WalkSearch | None:
    """The range of random walks that the times of a sensor's stretches allow; None: none."""
    parts: Sequence[StaticRate | RateSegment | StaticForce]
    if sensor == "gyro":
        solved, largest = campaign.solution.gyro, gyroscopes.MAX_RANDOM_WALK
        rests: Sequence[StaticRate | StaticForce] = campaign.inputs.static_rates
        parts = [*rests, *campaign.inputs.turns]
    else:
        solved, largest = campaign.solution.accelerometer, accelerometers.MAX_RANDOM_WALK
        parts = rests = [rest for _, rest, _ in campaign.static_forces]
    if solved is None or not rests:
        return None
    stretches = [part.stretch for part in parts if part.stretch is not None]
    return walk_search(stretches, float(np.nanmedian([rest.sigma for rest in rests])), largest)


def _with(campaign: Campaign, **changes: Any) -> Campaign:
    assert campaign.by_hand is not None  # else there is no scatter
    return replace(campaign, by_hand=replace(campaign.by_hand, **changes))


def _solved(campaign: Campaign, sensor: str, effects: Sequence[Effect]) -> Estimate:
    system = campaign.system(sensor, effects, NAMED_PRIOR_SIZE)
    assert system is not None  # the sensor is free
    return system.solve_shared()


def _rates(campaign: Campaign, effects: Sequence[Effect]) -> Callable[[Scatter], Estimate]:
    equations = campaign.by_scatter(effects, NAMED_PRIOR_SIZE)
    return lambda scatter: equations(scatter).system().solve_shared()


def _residuals(campaign: Campaign, effects: Sequence[Effect], found: Estimate) -> dict[int, Array]:
    """The residuals of the gyros in stops and passages, in units of sigma, by number."""
    equations, by_hand = campaign.equations("gyro", effects, NAMED_PRIOR_SIZE), campaign.by_hand
    assert equations is not None and by_hand is not None  # the gyros are free
    about = found.values - equations.prior
    place = {name: i for i, name in enumerate(by_hand.names)}
    unordered = {
        place[stretch.name]: block.rows[:, -1] - block.rows[:, :-1] @ about
        for block, stretch in equations.blocks
        if stretch.name in place
    }
    return dict(sorted(unordered.items()))
