"""A law that no effect of the catalogue has: a function of one state, of one axis or of all."""

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Self

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Constant, Effect, Parameter, Reading, Truth, by_grade
from inertial.physics.laws import (
    LAWS,
    OWN,
    SHAPED_IN_STATE,
    UNITS,
    beside_product,
    functions,
    powers,
    unknown,
)
from inertial.physics.motion import Motion
from inertial.sensors import SENSORS
from inertial.text.messages import _
from inertial.text.parameters import AXES
from inertial.text.units import DEGREE_PER_HOUR, STANDARD_GRAVITY

SIZES = {"gyro": ("rad/s", DEGREE_PER_HOUR), "accel": ("m/s²", 1e-5 * STANDARD_GRAVITY)}
WIDE = 1e3  # of the usual size, which of a shape that is far from 1 says nothing
TELEGRAPH = "telegraph"  # family of two levels
ALL = "all"  # axes, each with a size of its own
DRIFTING = ("time", "run_time", "temperature", "temperature_rate")  # states, however it moves


class Law(Effect):
    """Reading of an axis += Σ k_j u_j, u_j the functions of a family of one state.

    `axis`: x, y, z, or `all`; `family`, `state`, `shape`: as in `physics.laws.functions`.
    """

    cause = _("a law that no effect of the catalogue has")
    source = "sparse regression (Brunton, Proctor & Kutz 2016), with the evidence of each form"
    stays = _("its physical cause is not known, so it is not taken out of readings")
    thinkable = 1e6

    def __init__(
        self, sensor: str, axis: str, family: str, state: str, shape: Sequence[float] = ()
    ) -> None:
        self.sensor, self.axis, self.family, self.state = sensor, axis, family, state
        self.shape = tuple(shape)
        self.name = law_name(sensor, axis, family, state)
        unit, size = SIZES[sensor]
        if (family, state) == ("hysteresis", "temperature"):
            unit = f"{unit}/K"
        self.sizes = by_grade(size, 0.1, 1, 10, 100)
        self.parameters = tuple(
            Parameter(
                f"k{j}_{i}", unit, WIDE * size, _("size of the law in the {axis} reading", axis=i)
            )
            for i in self.axes
            for j in self._terms
        )

    @property
    def axes(self) -> tuple[str, ...]:
        """Those that have it."""
        return AXES if self.axis == ALL else (self.axis,)

    @property
    def one_axis(self) -> str | None:
        """The axis, where it is one alone."""
        return None if self.axis == ALL else self.axis

    @property
    def is_drift(self) -> bool:
        """Whether the bias has it whatever the IMU does: a law of time or of the temperature."""
        return all(state in DRIFTING for state in self.state.split("*"))

    @property
    def _terms(self) -> Sequence[str]:
        """What distinguishes the functions of one axis."""
        if self.family == "polynomial":
            degree = self.shape[0] if self.shape else 2
            return [str(k) for k in powers(self.state, degree)]
        if self.family == "product":
            return ["", *(f"_{name}" for name in beside_product(self.state))]
        return ("_cos", "_sin") if self.family == "harmonic" else ("",)

    @property
    def key(self) -> tuple[object, ...]:
        return self.name, self.shape

    @property
    def label(self) -> str:
        return f"{self.name}@{','.join(f'{value:.6g}' for value in self.shape)}"

    def blind(self, motion: Motion) -> str:
        return unknown(self.state, motion)

    def constants(self, motion: Motion) -> Sequence[Constant]:
        unit = UNITS.get(self.state, "g") if self.family in SHAPED_IN_STATE else "1"
        return [
            Constant(f"shape_{i}", unit, _("shape of the law"), value)
            for i, value in enumerate(self.shape, 1)
        ]

    def with_constants(self, values: Mapping[str, float]) -> Self:
        shape = [values[f"shape_{i}"] for i in range(1, 100) if f"shape_{i}" in values]
        return type(self)(self.sensor, self.axis, self.family, self.state, shape)

    def as_named(self, values: Mapping[str, float]) -> Effect:
        return self.with_constants(values)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        added = np.zeros((len(motion.time), 3))
        for axis, own in zip(self.axes, np.split(values, len(self.axes)), strict=True):
            i = AXES.index(axis)
            added[:, i] = functions(self.family, self.state, self.shape, motion, i) @ own
        return reading.plus(self.sensor, added)


def law_name(sensor: str, axis: str, family: str, state: str) -> str:
    """The name of a law as an effect."""
    return f"{sensor}_{axis}_{family}_of_{state.replace('*', '_and_')}"


def every_law() -> dict[str, Law]:
    """All laws that may be named, by name; their shapes are those of a campaign."""
    laws = (
        Law(sensor, axis, family, state)
        for sensor, axis, (family, state) in product(SENSORS, (*AXES, ALL), LAWS)
        if axis == ALL or state not in OWN
    )
    return {law.name: law for law in laws}
