"""Biases that are others after gaps of a recording: the IMU was switched off and on there."""

from collections.abc import Mapping, Sequence

import numpy as np

from inertial.arrays import Array
from inertial.effects.bias_jump import SIZES, TYPICAL
from inertial.physics.drift import after, without_clock
from inertial.physics.effect import (
    Constant,
    Effect,
    Parameter,
    Reading,
    Term,
    Truth,
    parameters_by_axis,
)
from inertial.physics.motion import Motion
from inertial.text.messages import _

MAX_RESTARTS = 6  # in one campaign: nobody switches off and on at each of more gaps
MEANINGS = {  # of b0, b1 …
    "gyro": _("further bias of the {axis} gyro in this run; b0: before the first restart"),
    "accel": _(
        "further bias of the {axis} accelerometer in this run; b0: before the first restart"
    ),
}


class Restarts(Effect):
    """Reading += b_k in run k, which is from t_k to t_k+1, run 0 before t_1.

    A gap of the recording alone shows no restart. Biases that change at several gaps do, for a
    jump or a drift does not know where samples are missing.

    `times`: t_k, s since the first sample of all logs; `spread`: (3,), sigma of b_k on each axis,
    about the bias, which is that of no run; without it b_0 is zero, and they are differences from
    the first run.
    """

    cause = _("the IMU was switched off and on, and its biases are others after it")
    source = "IEEE Std 528-2019, 'bias repeatability'"

    def __init__(
        self,
        sensor: str,
        times: Sequence[float] = (np.nan,) * MAX_RESTARTS,
        spread: Array | None = None,
        first: int = 0,
    ) -> None:
        unit, size = TYPICAL[sensor]
        self.sensor, self.times, self.spread, self.first = sensor, tuple(times), spread, first
        self.name = restarts_name(sensor)
        self.sizes = SIZES[sensor]
        parameters: list[Parameter] = []
        terms: list[Term] = []
        for k in range(first, len(self.times) + 1):
            own = parameters_by_axis(f"b{k}", unit, size, MEANINGS[sensor])
            since, until = f"(t > t{k})", f"(1 - (t > t{k + 1}))"
            factor = " * ".join([since] * (k > 0) + [until] * (k < len(self.times)))
            parameters += own
            terms += [Term(f"{sensor}_{each.name[-1]}", each.name, factor) for each in own]
        self.parameters, self.terms = tuple(parameters), tuple(terms)

    @property
    def key(self) -> tuple[object, ...]:
        return *super().key, self.times, self.first

    def blind(self, motion: Motion) -> str:
        return without_clock(motion)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        if without_clock(motion) or not np.isfinite(self.times).all():
            return reading
        begun = [np.ones(len(motion.time)), *(after(motion, time) for time in self.times)]
        inside = -np.diff(np.stack([*begun, 0 * begun[0]]), axis=0)[self.first :]
        return reading.plus(self.sensor, inside.T @ np.reshape(values, (-1, 3)))

    def constants(self, motion: Motion) -> Sequence[Constant]:
        meaning = _("when it was switched on again, since the first sample of all logs")
        return [Constant(f"t{k}", "s", meaning, at) for k, at in enumerate(self.times, 1)]

    def with_constants(self, values: Mapping[str, float]) -> "Restarts":
        names = [f"t{k}" for k in range(1, MAX_RESTARTS + 1)]
        return Restarts(self.sensor, [values[name] for name in names if name in values])

    def as_named(self, values: Mapping[str, float]) -> "Restarts":
        return self.with_constants(values)

    def with_spread(self, spread: Array) -> "Restarts":
        """The same with biases that scatter by so much about the bias, (3,)."""
        return Restarts(self.sensor, self.times, spread, self.first)

    def prior_sigma(self, parameter: Parameter) -> float | None:
        return None if self.spread is None else float(self.spread["xyz".index(parameter.name[-1])])


def restarts_name(sensor: str) -> str:
    """The name of the effect on a sensor, gyro or accel."""
    return f"{sensor}_restarts"
