"""Gyros that recover after each turn: a bias that decays from where a turn ends."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR

TURNS = 2.0 * DEGREE  # rad/s, from which the motion loads


@dataclass
class GyroRelaxation(Effect):
    """While a turn about any axis lasts ω̃ += d; from its end on ω̃ += b exp(−t/τ).

    The after-effect of an anelastic solid that was loaded: its strain of the one relaxation time
    recovers exponentially once the load is gone (Zener).
    in_turn: d, (3,), rad/s; after: b, (3,), rad/s; time_constant: τ, s.
    Source: C. Zener, Elasticity and Anelasticity of Metals, 1948, ch. 5.
    """

    in_turn: Array
    after: Array
    time_constant: float
    _stopped: Array = field(default_factory=lambda: np.full(3, -np.inf), init=False)  # s
    _sense: Array = field(default_factory=lambda: np.zeros(3), init=False)

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        biases = (np.array(parameters[key], float) for key in ("in_turn_deg_h", "after_deg_h"))
        in_turn, after = (bias * DEGREE / HOUR for bias in biases)
        return cls(in_turn, after, parameters["time_constant_s"])

    def loads(self, rate: Array) -> Array:
        """The load of each gyro, −1, 0 or 1, at rates about the axes, (m, 3), rad/s."""
        return np.tile((np.abs(rate) > TURNS).any(axis=1, keepdims=True), 3).astype(float)

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        load, time = self.loads(sensors.gyro.project(truth.rate)), np.asarray(truth.time)
        loads = np.concatenate([self._sense[None], load])
        times = np.concatenate([self._stopped[None], np.tile(time[:, None], 3)])
        places = np.arange(len(loads))[:, None] * (loads != 0)
        last = np.maximum.accumulate(places, axis=0)
        latest, stopped = (np.take_along_axis(of, last, axis=0)[1:] for of in (loads, times))
        self._sense, self._stopped = latest[-1], stopped[-1]
        left = latest * np.exp(-(time[:, None] - stopped) / self.time_constant)
        return Reading.of_gyros(np.where(load != 0, load * self.in_turn, left * self.after))


@dataclass
class GyroRelaxationSense(GyroRelaxation):
    """The same of each gyro with the sense of turns about its own axis; in them b too."""

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        both = {key: parameters["offset_deg_h"] for key in ("in_turn_deg_h", "after_deg_h")}
        return super().specified({**parameters, **both})

    def loads(self, rate: Array) -> Array:
        return np.where(np.abs(rate) > TURNS, np.sign(rate), 0.0)


@dataclass
class GyroRelaxationBraking(GyroRelaxationSense):
    """The same of what the end of a turn loads: in the turn nothing."""

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        effect = super().specified(parameters)
        effect.in_turn = np.zeros(3)
        return effect
