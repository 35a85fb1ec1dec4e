"""The measurement equation of one mount by the result that counts.

reading = M · truth + bias + effects(truth, time, temperature)
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.records import Row, grouped, rows_of
from inertial.effects import KNOWN
from inertial.estimation.triad import linear_names, triad_of_errors
from inertial.physics.effect import Effect
from inertial.physics.forward import Sized, Triad, force_of, rate_of
from inertial.physics.motion import Motion
from inertial.text.parameters import BIAS


@dataclass(frozen=True)
class EffectOfResult:
    """An effect in the model of a result.

    `effect`: with its constants; `parameters`: rows of those that were estimated, by name;
    `constants`: rows of its constants, by name.
    """

    effect: Effect
    parameters: Mapping[str, Row]
    constants: Mapping[str, Row]

    @property
    def values(self) -> Array:
        """The values of all its parameters, 0 where one was not estimated."""
        own = (self.parameters.get(parameter.name) for parameter in self.effect.parameters)
        return np.array([(row or {}).get("value") or 0.0 for row in own])


@dataclass(frozen=True)
class SensorResult:
    """The result that counts of one sensor on one mount.

    `rows`: the twelve parameters by name; `effects`: those in its model.
    """

    sensor: str
    rows: Mapping[str, Row]
    effects: Sequence[EffectOfResult] = ()

    @cached_property
    def triad(self) -> Triad | None:
        """M and bias; none where they are not wholly determined, or not usable."""
        names = linear_names()
        values = [self.rows.get(name, {}).get("value") for name in names]
        return None if None in values else triad_of_errors(np.array(values, np.float64))

    def shifted(self, bias: Array | None) -> "SensorResult":
        """The same with a bias that is larger by (3,); or the same."""
        if bias is None or self.triad is None:
            return self
        moved = {
            name: self.rows[name] | {"value": self.rows[name]["value"] + change}
            for name, change in zip(BIAS, bias.tolist(), strict=True)
        }
        return replace(self, rows={**self.rows, **moved})

    @property
    def missing(self) -> dict[str, list[str]]:
        """Why parameters have no value: reason → their names."""
        reasons: dict[str, list[str]] = {}
        for name, row in self.rows.items():
            if row["value"] is None:
                reasons.setdefault(row["reason"], []).append(name)
        return reasons

    @property
    def removable(self) -> list[Sized]:
        """The effects that can be taken out of readings, with their values."""
        return [(one.effect, one.values) for one in self.effects if one.effect.terms]

    @property
    def staying(self) -> list[EffectOfResult]:
        """The effects that are in the model of the parameters, and stay in readings."""
        return [one for one in self.effects if not one.effect.terms]


@dataclass(frozen=True)
class Measurement:
    """The results of both sensors on one mount."""

    accelerometer: SensorResult
    gyro: SensorResult

    def along(self, time: Array, temperature: Array) -> "Measurement":
        """The same in a campaign of this course of the temperature, (n,) each, s and K."""

        def sensor(own: SensorResult) -> SensorResult:
            effects = [
                replace(one, effect=one.effect.along(time, temperature)) for one in own.effects
            ]
            return replace(own, effects=effects)

        return Measurement(sensor(self.accelerometer), sensor(self.gyro))

    def since(self, switch_on: int, deviations: Mapping[tuple[str, int], Array]) -> "Measurement":
        """The same with the biases after a switch-on; `deviations`: see `Solution`."""
        accelerometer, gyro = (
            own.shifted(deviations.get((own.sensor, switch_on)))
            for own in (self.accelerometer, self.gyro)
        )
        return Measurement(accelerometer, gyro)

    def force(self, readings: Array, motion: Motion) -> Array:
        """Specific force from the readings of the accelerometers, (n, 3), m/s²."""
        own = self.accelerometer
        return force_of(readings, own.triad, own.removable, motion)

    def rate(self, readings: Array, motion: Motion, force: Array) -> Array:
        """Angular rate from the readings of the gyros under a specific force, (n, 3), rad/s."""
        return rate_of(readings, self.gyro.triad, self.gyro.removable, motion, force)


def measurements_of(result: pd.DataFrame) -> dict[str, Measurement]:
    """The measurement equation of each mount that has a result, by its name."""
    by_mount = grouped(rows_of(result), lambda row: row["mount"])
    return {mount: measurement_of(rows) for mount, rows in by_mount.items()}


def measurement_of(rows: Sequence[Row]) -> Measurement:
    """The measurement equation of one mount by the rows of its result."""
    accelerometer, gyro = (
        _sensor(sensor, [row for row in rows if row["sensor"] == sensor])
        for sensor in ("accel", "gyro")
    )
    return Measurement(accelerometer, gyro)


def _sensor(sensor: str, rows: Sequence[Row]) -> SensorResult:
    twelve = {row["parameter"]: row for row in rows if row["effect"] is None}
    names = dict.fromkeys(row["effect"] for row in rows if row["effect"] is not None)
    effects = [_effect(name, (row for row in rows if row["effect"] == name)) for name in names]
    return SensorResult(sensor, {n: twelve[n] for n in linear_names() if n in twelve}, effects)


def _effect(name: str, rows: Iterable[Row]) -> EffectOfResult:
    """`rows`: parameters and constants, each called effect.name."""
    own = {row["parameter"].partition(".")[2]: row for row in rows}
    effect = KNOWN[name]
    parameters = {p.name: own[p.name] for p in effect.parameters if p.name in own}
    constants = {key: row for key, row in own.items() if key not in parameters}
    values = {key: row["value"] for key, row in constants.items() if row["value"] is not None}
    return EffectOfResult(effect.with_constants(values), parameters, constants)


NOTHING = measurement_of([])  # of a mount without a result
