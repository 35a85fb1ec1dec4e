"""By how much the drifts of a model change the parameters of a sensor, on average over a recording.

The bias of a ramp is that of its beginning, of a warm-up that of its end, beside a temperature that
of the mean temperature. Models that drift otherwise are compared, and mixed, by the means.
"""

from collections.abc import Iterator

import numpy as np

from inertial.arrays import Array
from inertial.campaign.records import Row
from inertial.effects.temperature_model import TemperatureModel
from inertial.estimation.triad import linear_names
from inertial.physics.drift import Drift
from inertial.physics.effect import Effect, Reading, Truth
from inertial.physics.motion import Motion
from inertial.physics.setting_in import ScaleJump
from stages.extension.estimates import Solved

DRIFTS = (Drift, ScaleJump, TemperatureModel)  # of the sensor, with time or temperature alone


def drift_means(solution: Solved, motion: Motion, stretches: slice) -> Iterator[Row]:
    """The rows of a fit; `stretches`: those of `motion` that are of its sensor."""
    there = {row["parameter"] for row in solution.of_effects}
    weights = motion.seconds[stretches] / motion.seconds[stretches].sum()
    for effect in solution.fitted:
        if not isinstance(effect, DRIFTS):
            continue
        for parameter, unit in zip(effect.parameters, np.eye(len(effect.parameters)), strict=True):
            name = f"{effect.name}.{parameter.name}"
            changes = changes_of(effect, unit, motion, solution.sensor)[stretches]
            means = np.nan_to_num(weights @ changes)
            for of, mean in zip(linear_names(), means.tolist(), strict=True):
                if name in there and mean:
                    yield {
                        "mount": solution.mount,
                        "sensor": solution.sensor,
                        "method": solution.method,
                        "parameter": name,
                        "of": of,
                        "mean": mean,
                    }


def changes_of(effect: Effect, values: Array, motion: Motion, sensor: str) -> Array:
    """By how much M, by rows, and bias differ in each stretch, (n, 12), to first order."""

    def read(sensed: Array) -> Array:
        every = np.broadcast_to(sensed, (len(motion.time), 3))
        nothing = Reading(np.zeros_like(every), np.zeros_like(every))
        reading = effect.reads(nothing, Truth(every, every), motion, values)
        return reading.gyro if sensor == "gyro" else reading.accel

    bias = read(np.zeros(3))
    matrix = np.stack([read(axis) - bias for axis in np.eye(3)], axis=2)
    return np.hstack([matrix.reshape(len(bias), 9), bias])
