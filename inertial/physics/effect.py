"""What every physical effect declares about itself, and its typical sizes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from inertial.arrays import Array
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.parameters import AXES

# ---- Typical sizes of effects, by the grade of a sensor or the quality of a table.

FOG, TACTICAL, MTI, CONSUMER = "fog", "tactical", "mti", "consumer"
GOOD, POOR = "good table", "poor table"
USUAL = "usual"


def by_grade(
    unit: float, fog: float, tactical: float, mti: float, consumer: float
) -> Mapping[str, float]:
    """Sizes by the grade of the sensor; `unit`: of the numbers, in SI.

    fog: fibre-optic gyros and their accelerometers; tactical: MEMS of the STIM300
    class; mti: of the MTi-100 class; consumer: as in smartphones.
    """
    numbers = zip((FOG, TACTICAL, MTI, CONSUMER), (fog, tactical, mti, consumer), strict=True)
    return {grade: number * unit for grade, number in numbers}


def of_tables(unit: float, good: float, poor: float) -> Mapping[str, float]:
    """Sizes of a good and of a poor table of a laboratory; `unit`: of the numbers, in SI."""
    return {GOOD: good * unit, POOR: poor * unit}


def usually(size: float) -> Mapping[str, float]:
    """The typical size, in SI."""
    return {USUAL: size}


# ---- The interface of a physical effect: name, cause, source, parameters, and how it acts.


@dataclass(frozen=True)
class Truth:
    """Angular rate (n, 3), rad/s, and specific force (n, 3), m/s², that the sensors feel."""

    rate: Array
    force: Array


@dataclass(frozen=True)
class Reading:
    """Readings of the sensors: gyro (n, 3), rad/s, and accel (n, 3), m/s²."""

    gyro: Array
    accel: Array

    def plus(self, sensor: str, change: Array) -> Reading:
        """With a change of the readings of gyro or accel, (n, 3)."""
        return replace(self, **{sensor: getattr(self, sensor) + change})


@dataclass(frozen=True)
class Parameter:
    """A parameter of an effect; zero means that the effect is absent."""

    name: str
    unit: str
    typical: float  # size in a good laboratory IMU or table; sets the step of derivatives
    meaning: str


def parameters_by_axis(
    letter: str, unit: str, typical: float, meaning: str
) -> tuple[Parameter, ...]:
    """The same parameter on each of x, y and z; `meaning` names the `{axis}`."""
    return tuple(
        Parameter(f"{letter}_{axis}", unit, typical, meaning.format(axis=axis)) for axis in AXES
    )


@dataclass(frozen=True)
class Scan:
    """A nonlinear parameter of an effect, searched over a grid.

    `between`: whether the true value may lie between two values of the grid; `smooth`: whether what
    the effect adds to the readings, the same whatever is sensed, has a derivative by it.
    """

    name: str
    unit: str
    meaning: str
    between: bool = True
    smooth: bool = False


@dataclass(frozen=True)
class Constant:
    """A number in the terms of an effect that is not estimated with its parameters."""

    name: str
    unit: str
    meaning: str
    value: float


@dataclass(frozen=True)
class Term:
    """What a parameter adds to the reading of one channel: parameter × factor.

    `factor`: as text that C and Python read alike; f_x, f_y, f_z the specific force, m/s², and
    w_x, w_y, w_z the angular rate, rad/s, along the axes of the case; s_x, s_y, s_z what the three
    sensors of the channel sense along their own, M · f or M · w; t the time, s; T the temperature,
    K; and the constants of the effect by their names.
    """

    channel: str
    parameter: str
    factor: str


def on_each_axis(sensor: str, parameter: str, factor: str) -> tuple[Term, ...]:
    """The same term on each axis i of a sensor, accel or gyro."""
    return tuple(Term(f"{sensor}_{i}", parameter.format(i=i), factor.format(i=i)) for i in "xyz")


# Constants of the effects of temperature: the mean of the campaign, and its range.
MEAN_TEMPERATURE, COLDEST, WARMEST = "T0", "T_min", "T_max"


class Effect(ABC):
    """One physical effect: its name, its cause, its source, its parameters and how it acts.

    It changes the truth (`moves`) before it is sensed, or the reading (`reads`), or both, in
    proportion to its parameters as long as they are small.

    `sizes`: typical sizes, in the unit of the last parameter: of a sensor by its grade, fog (a
    fibre-optic gyro and its accelerometers), tactical (MEMS of the STIM300 class), mti (of the
    MTi-100 class), consumer; of a table: good table, poor table; of a site: usual. Sizes of more
    than `thinkable` times the largest of them are excluded. `only`: the value of its parameter
    if it is there, where no other is possible; `positive`: whether that value cannot be negative.

    `sought_in`: where it is detected: in the "blocks" of means on which all equations rest; in the
    "spectrum" of the full-rate residuals, for it is faster than a block or periodic in the angle of
    the table; in the "noise", for its mean is zero; by the "quality" of the samples, where
    `finding` is the cause of that finding.

    `absorbed_by`: what every calibration estimates or knows that has the same effect on readings,
    so that it is not observable by any plan of these manoeuvres; `blind`: why it is not observable
    in a certain campaign; `of_stillness`: what the sway of a hand at rest would be taken for;
    `vector`: its parameters are the components of a vector of any direction; `own_axis`: gyro or
    accel, where `reads` takes the truth along the axes of these sensors, M · truth.

    `scan`: a nonlinear parameter. The effect in the catalogue is then a family whose
    `candidates` for a campaign have one value each, `at`; each is an effect like others.
    Without a value it acts with the middle one of them.

    `terms`: what it adds to the readings as a function of force, rate, time and temperature; where
    there are none, `stays` says why it cannot be taken out of readings. `reference`: the mean
    temperature of the campaign, K, where the motion is not all of it; `valid`: its lowest and
    highest temperature, K, beyond which what depends on it is not known.
    """

    name: str
    cause: str
    source: str
    parameters: tuple[Parameter, ...]
    sizes: Mapping[str, float]
    thinkable: float = 100.0
    only: float | None = None
    positive: bool = False
    sought_in: str = "blocks"
    finding: str = ""
    absorbed_by: str = ""
    of_stillness: bool = False
    vector: bool = False
    own_axis: str = ""
    scan: Scan | None = None
    terms: tuple[Term, ...] = ()
    stays: str = _("the table, the site or the mounting causes it, and the IMU feels it")
    at: float | None = None
    reference: float | None = None
    valid: tuple[float, float] | None = None

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        """The truth with this effect in it; `values` follow `parameters`."""
        return truth

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        """The reading with this effect in it; `values` follow `parameters`."""
        return reading

    def added(self, truth: Truth, motion: Motion) -> Reading | None:
        """What `reads` adds per unit of each parameter, where it is in proportion to them.

        gyro and accel, (n, 3, number of parameters) each; none: differences tell.
        """
        return None

    def level_rate_changes(self, up: float, level: float) -> Array:
        """What the size of the earth's horizontal rate changes by per unit of each parameter.

        Of a position whose azimuth the gyros tell themselves it is all that is known of it. up,
        level: the upward and the horizontal rate that are taken as known, rad/s.
        """
        return np.zeros(len(self.parameters))

    def signature(self, motion: Motion) -> Reading | None:
        """Change of the readings per unit of each parameter, where it needs no forward model.

        gyro and accel, (n, 3, number of parameters) each.
        """
        return None

    def blind(self, motion: Motion) -> str:
        """Why the effect is not observable in this motion, in a sentence; empty where it may be."""
        return ""

    def grid(self, motion: Motion) -> Array:
        """The values of the nonlinear parameter that this motion can distinguish."""
        return np.zeros(0)

    def candidates(self, motion: Motion) -> Sequence[Self]:
        """The effect with each value of the grid; without a scan the effect itself."""
        return self.at_each(self.grid(motion)) if self.scan else [self]

    def at_each(self, values: Iterable[float]) -> list[Self]:
        """The effect with each of these values; those that its label does not tell apart are one.

        As of a moment of an even grid that falls by chance on one between two positions.
        """
        every = (self.fixed(float(at)) for at in values)
        return list({effect.label: effect for effect in every}.values())

    def fixed(self, at: float) -> Self:
        """The effect with one value of the nonlinear parameter."""
        effect = copy(self)
        effect.at = at
        return effect

    def constants(self, motion: Motion) -> Sequence[Constant]:
        """The constants of its terms, as this motion sets them."""
        if self.scan is None:
            return []
        return [Constant(self.scan.name, self.scan.unit, self.scan.meaning, self.value(motion))]

    def with_constants(self, values: Mapping[str, float]) -> Self:
        """The effect with the constants of a campaign, by name."""
        effect = copy(self)
        effect.at = values.get(self.scan.name) if self.scan else None
        effect.reference = values.get(MEAN_TEMPERATURE)
        if COLDEST in values and WARMEST in values:
            effect.valid = values[COLDEST], values[WARMEST]
        return effect

    def along(self, time: Array, temperature: Array) -> Self:
        """The effect in a campaign of this course of the temperature, (n,) each, s and K."""
        return self

    def value(self, motion: Motion) -> float:
        """The value of the nonlinear parameter, by default the middle of the grid; NaN without."""
        if self.at is not None:
            return self.at
        grid = self.grid(motion)
        return float(grid[len(grid) // 2]) if len(grid) else np.nan

    def as_named(self, values: Mapping[str, float]) -> Effect:
        """The effect with the value of the nonlinear parameter, of the numbers by name."""
        at = values.get(self.scan.name) if self.scan else None
        return self if at is None else self.fixed(at)

    @property
    def key(self) -> tuple[object, ...]:
        """What distinguishes it from others of its campaign."""
        return self.name, self.at, self.reference

    @property
    def largest(self) -> float:
        """The largest size considered, in the unit of the last parameter."""
        return self.thinkable * max(self.sizes.values())

    def largest_of(self, parameter: Parameter) -> float:
        """The largest size of a parameter that is considered, in its unit."""
        return self.largest

    def prior_sigma(self, parameter: Parameter) -> float | None:
        """What is known beforehand of the size of a parameter, in its unit; none: nothing."""
        return None

    @property
    def label(self) -> str:
        """Its name, and the value of the nonlinear parameter where it has one."""
        return self.name if self.at is None else f"{self.name}@{self.at:.6g}"

    @property
    def columns(self) -> list[str]:
        """The names of its parameters in the equations and the evidence."""
        return [f"{self.label}.{parameter.name}" for parameter in self.parameters]


@dataclass(frozen=True)
class OfSensor:
    """What of an effect on either sensor is one's own; `meaning`: of its parameter on an `{axis}`.

    `cause`, `source`: empty where they are the same of both.
    """

    meaning: str
    unit: str
    typical: float
    sizes: Mapping[str, float]
    cause: str = ""
    source: str = ""


class OfEither(Effect):
    """An effect that gyros and accelerometers have alike, on each axis by itself.

    `kind`: its name after that of the sensor; `letter`: of its parameters; `factor`: of its terms,
    if it has any: those of a scale factor take the truth along the sensor's own axes, s_i.
    """

    kind: str
    letter: str
    factor: str = ""
    gyro: OfSensor
    accel: OfSensor

    def __init__(self, sensor: str) -> None:
        own: OfSensor = getattr(self, sensor)
        self.sensor, self.name, self.sizes = sensor, f"{sensor}_{self.kind}", own.sizes
        self.cause, self.source = own.cause or self.cause, own.source or self.source
        self.parameters = parameters_by_axis(self.letter, own.unit, own.typical, own.meaning)
        if self.factor:
            self.terms = on_each_axis(sensor, f"{self.letter}_{{i}}", self.factor)
        self.own_axis = sensor if "s_{i}" in self.factor else ""


class OfSensed(Effect):
    """An effect on the readings of a sensor, gyro or accel, by what is sensed at the moment.

    Gyros feel the force that the accelerometers beside them measure, where that is known: off the
    axis of the table a turn pulls with ω × (ω × r), too.
    """

    sensor: str

    @abstractmethod
    def change(self, truth: Truth, values: Array) -> Array:
        """What it adds to them, (n, 3); `values` follow `parameters`."""

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        if self.sensor == "gyro":
            force = np.where(np.isfinite(motion.measured_force), motion.measured_force, truth.force)
            truth = replace(truth, force=force)
        return reading.plus(self.sensor, self.change(truth, values))


def known_earth(truth: Truth, motion: Motion) -> tuple[Array, Array]:
    """Upward and horizontal component of the earth's rate, body axes, (n, 3) each, rad/s.

    The horizontal component is zero where the azimuth is not surveyed: there the gyros estimate it
    themselves, and the estimate absorbs any effect on it.
    """
    earth = truth.rate - motion.omega
    upward = np.sum(earth * motion.up, axis=1, keepdims=True) * motion.up
    return upward, np.where(motion.surveyed[:, None], earth - upward, 0.0)


LARGE_ANGLE = 0.02  # rad, from which 1 − cos is no longer left out


class TurnedEarthRate(Effect):
    """The earth's rate, turned in the local frame by an angle that is its only parameter.

    Of an angle v the part e that turns, and d, e a quarter of a turn on, become
    v (d sin ψ − e (1 − cos ψ)) / ψ: a rotation in proportion to v, and exact where v is ψ = `at`,
    about which it is then estimated again. Without a ψ it is that of a small angle. `after`: the
    turn, of an angle of its own, that goes before it, for the two do not commute.
    """

    after: TurnedEarthRate | None = None

    def parts(self, truth: Truth, motion: Motion) -> tuple[Array, Array]:
        """The part that turns, and the same a quarter of a turn on; body axes, (n, 3), rad/s."""
        raise NotImplementedError

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        before = truth
        if self.after is not None:
            before = self.after.moves(truth, motion, np.array([self.after.at or 0.0]))
        turning, onwards = self.parts(before, motion)
        along, across = self._shares
        return replace(truth, rate=truth.rate + values[0] * (across * onwards + along * turning))

    @property
    def _shares(self) -> tuple[float, float]:
        """Of the part that turns and of that a quarter of a turn on, per unit of the angle."""
        about = self.at or 0.0
        along = -np.sin(about / 2) * np.sinc(about / 2 / np.pi)  # −(1 − cos ψ)/ψ
        return float(along), float(np.sinc(about / np.pi))  # sin ψ/ψ

    @property
    def key(self) -> tuple[object, ...]:
        return *super().key, None if self.after is None else self.after.at

    def about(self, angle: float) -> Self:
        """The effect as it is near an angle, rad."""
        return self.fixed(angle) if abs(angle) > LARGE_ANGLE else self

    def following(self, other: TurnedEarthRate) -> Self:
        """The effect after another turn."""
        effect = copy(self)
        effect.after = other
        return effect

    def as_named(self, values: Mapping[str, float]) -> Effect:
        return self.about(values.get(self.parameters[0].name, 0.0))


def in_sequence(effects: Sequence[Effect]) -> list[Effect]:
    """The same effects; of two turns of the earth's rate the first follows the second."""
    turns = [effect for effect in effects if isinstance(effect, TurnedEarthRate)]
    if len(turns) != 2:
        return list(effects)
    first, second = sorted(turns, key=lambda turn: turn.name)
    return [first.following(second) if effect is first else effect for effect in effects]
