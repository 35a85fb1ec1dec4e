"""By how much the biases of a sensor walk at random, beside the effects that are named."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from stages.estimation.evidence import USUAL, Campaign
from stages.inference.between_stretches import Times, likeliest, sigma_of
from stages.inference.least_squares import LIKELIER
from stages.inference.random_walk import times_of
from stages.inference.rests_and_turns import Still, Turn
from stages.inference.six_position import WALK as LARGEST_OF_ACCELEROMETERS
from stages.inference.six_position import Rest
from stages.inference.whole_turns import WALK as LARGEST_OF_GYROS
from stages.model.effect import Effect

SENSORS = ("gyro", "accel")


def walks_beside(campaign: Campaign, effects: Sequence[Effect]) -> tuple[float, float]:
    """The likeliest random walks of gyros and accelerometers; 0 where none is asked for."""
    found = [_walk(campaign, sensor, effects) for sensor in SENSORS]
    return found[0], found[1]


def slight(campaign: Campaign) -> tuple[float, float]:
    """Walks that take a bias three times as far in the whole campaign as the noise of a stretch."""
    times = [_times(campaign, sensor) for sensor in SENSORS]
    found = [0.0 if one is None else 3 * one.noise / float(np.sqrt(one.span)) for one in times]
    return found[0], found[1]


def _walk(campaign: Campaign, sensor: str, effects: Sequence[Effect]) -> float:
    times = _times(campaign, sensor)
    if times is None:
        return 0.0
    deviance = _deviance(campaign, sensor, effects)
    alone = deviance(0.0)
    size, smallest = likeliest(deviance, times.walks, alone)
    return size if alone - smallest >= LIKELIER else 0.0


@dataclass(frozen=True)
class Walk:
    """A random walk of the biases of a sensor, and its sigma, rad/s/√s or m/s²/√s."""

    size: float
    sigma: float


def walks_with_sigmas(campaign: Campaign, effects: Sequence[Effect]) -> dict[str, Walk]:
    """The random walks that the equations of a campaign have, by sensor."""
    return {
        sensor: Walk(size, sigma_of(_deviance(campaign, sensor, effects), size))
        for sensor, size in zip(SENSORS, campaign.solution.walks, strict=True)
        if size
    }


def _deviance(
    campaign: Campaign, sensor: str, effects: Sequence[Effect]
) -> Callable[[float], float]:
    equations = campaign.walked(sensor, effects, USUAL)

    def deviance(size: float) -> float:
        system = equations(size)
        assert system is not None  # else it has no times
        return system.solve_shared().deviance

    return deviance


def _times(campaign: Campaign, sensor: str) -> Times | None:
    """What the times of a sensor's stretches can tell of a walk; None where they tell nothing."""
    parts: Sequence[Still | Turn | Rest]
    if sensor == "gyro":
        solved, largest = campaign.solution.gyro, LARGEST_OF_GYROS
        rests: Sequence[Still | Rest] = campaign.inputs.rests
        parts = [*rests, *campaign.inputs.turns]
    else:
        solved, largest = campaign.solution.accelerometer, LARGEST_OF_ACCELEROMETERS
        parts = rests = [rest for _, rest, _ in campaign.rests]
    if solved is None or not rests:
        return None
    stretches = [part.stretch for part in parts if part.stretch is not None]
    return times_of(stretches, float(np.nanmedian([rest.sigma for rest in rests])), largest)
