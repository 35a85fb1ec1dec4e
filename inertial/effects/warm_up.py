"""Biases of a sensor that settle after the instrument is switched on."""

from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import replace
from itertools import pairwise
from typing import Self

import numpy as np

from inertial.arrays import Array
from inertial.physics.drift import NO_CLOCK, Drift
from inertial.physics.effect import Constant, Effect, OfSensor, Scan, by_grade
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR, STANDARD_GRAVITY

SETTLING_TIMES = (10.0, 3000.0)  # s, of τ: a shorter one is over before the first rest is
ON = "on_"  # and a number: the constants of a warm-up that begins anew
SETTLING_CANDIDATES = 11  # of τ; between two of them the trace changes by a tenth


class WarmUp(Drift):
    """Reading += b exp(−t/τ), with t since the first sample or the last switch-on; τ is scanned.

    Told from an even drift by slowing down. Only logs with a common clock show it, or logs that
    each begin with a switch-on. Switched on earlier by T, the amplitude at the first sample is
    exp(−T/τ) of the whole. After each stated switch-on it is the same again, as of an instrument
    that has cooled down between.

    `switched_on`: when it was switched on again, s since the first sample, where the motion does
    not have it: after an export, or where the readings tell a restart that nobody stated.
    """

    kind, letter, factor = "warm_up", "b", "exp(-t / tau)"
    cause = _("the sensor and its electronics warm up after they are switched on")
    source = "IEEE Std 528-2019, 'warm-up time'"
    scan = Scan("tau", "s", _("time constant of the settling"), smooth=True)
    gyro = OfSensor(
        _("further bias of the {axis} gyro at the first sample"),
        "rad/s",
        DEGREE_PER_HOUR,
        by_grade(DEGREE_PER_HOUR, 0.3, 5, 30, 300),
    )
    accel = OfSensor(
        _("further bias of the {axis} accelerometer at the first sample"),
        "m/s²",
        1e-5 * STANDARD_GRAVITY,
        by_grade(1e-6 * STANDARD_GRAVITY, 20, 100, 100, 1000),
    )
    switched_on: tuple[float, ...] = ()

    def blind(self, motion: Motion) -> str:
        return "" if np.isfinite(motion.running).all() else NO_CLOCK

    def grid(self, motion: Motion) -> Array:
        return np.geomspace(*SETTLING_TIMES, SETTLING_CANDIDATES)

    def course(self, motion: Motion) -> Array:
        running, at = motion.running, np.array([0.0, *self.switched_on])
        if self.switched_on:
            on = at[np.clip(np.searchsorted(at, motion.time, side="right") - 1, 0, None)]
            running = motion.time - on
        return decayed(running, motion.seconds, self.value(motion))

    def constants(self, motion: Motion) -> Sequence[Constant]:
        again = self.switched_on or np.unique(motion.switched_on[motion.switched_on > 0])
        meaning = _("when the instrument was switched on again, after the first sample")
        return [
            *super().constants(motion),
            *(Constant(f"{ON}{i}", "s", meaning, float(at)) for i, at in enumerate(again, 1)),
        ]

    def with_constants(self, values: Mapping[str, float]) -> Self:
        return super().with_constants(values).beginning_at(_switched_on(values))

    def as_named(self, values: Mapping[str, float]) -> Effect:
        effect = super().as_named(values)
        return effect.beginning_at(_switched_on(values)) if isinstance(effect, WarmUp) else effect

    @property
    def key(self) -> tuple[object, ...]:
        return *super().key, self.switched_on

    def beginning_at(self, switched_on: Iterable[float]) -> Self:
        """The same, that begins again at these times, s since the first sample."""
        effect = copy(self)
        effect.switched_on = tuple(sorted(switched_on))
        names = [f"{ON}{i}" for i in range(1, len(effect.switched_on) + 1)]
        if names:
            steps = [f"(t > {names[0]}) * {names[0]}"]
            steps += [f"(t > {at}) * ({at} - {before})" for before, at in pairwise(names)]
            factor = f"exp(-(t - {' - '.join(steps)}) / tau)"
            effect.terms = tuple(replace(term, factor=factor) for term in self.terms)
        return effect


def _switched_on(values: Mapping[str, float]) -> list[float]:
    return [at for name, at in values.items() if name.startswith(ON)]


def decayed(time: Array, seconds: Array, constant: float) -> Array:
    """The mean of exp(−t/τ) over stretches about their middles, (n,), for the constant τ, s."""
    half = seconds / (2 * constant)
    return np.asarray(np.exp(-time / constant) * np.sinh(half) / half)
