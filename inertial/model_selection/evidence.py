"""The evidence of the equations of all sensors on the effects."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from operator import add

import numpy as np

from inertial.arrays import Array
from inertial.estimation.effect_information import MIN_INFORMATION_SHARE, EffectInformation
from inertial.estimation.probability import chi2_sf, f_sf
from inertial.estimation.scatter_and_random_walk import MIN_CONSISTENT_P_VALUE

# ---- Searched effects, each by its columns in the evidence.


@dataclass(frozen=True)
class SearchedEffect:
    """An effect and its columns, once for every value of what is scanned.

    `candidates`: the columns of each candidate; an effect without a scan has one. `free`: no
    physical effect but an arbitrary function, such as a drift without a law; it replaces several
    effects that together imitate it, but never a single effect that suffices.
    `between`: whether the true value of a scan may lie between two candidates. `only`: the value
    of its single column, where it is there with that value or not at all; `positive`: whether the
    value of its single column cannot be negative: then a drop of chi-squared by a negative one is
    none, and the test is one-sided, its p-value at most half of that stated.
    """

    name: str
    candidates: tuple[tuple[int, ...], ...]
    free: bool = False
    between: bool = True
    only: float | None = None
    positive: bool = False


def searched_effect(
    name: str,
    *candidates: Sequence[int],
    free: bool = False,
    between: bool = True,
    only: float | None = None,
    positive: bool = False,
) -> SearchedEffect:
    """An effect by the columns of its candidates."""
    columns = tuple(tuple(int(i) for i in candidate) for candidate in candidates)
    return SearchedEffect(name, columns, free, between, only, positive)


# ---- The information of the equations of all sensors about the effects.


@dataclass(frozen=True)
class Evidence:
    """The information of each sensor on the effects.

    `sensors`: independent equations about the same effects; `labels`: their names;
    `noise_degrees`: degrees of freedom from which the noise of each was estimated, none:
    infinitely many; `raw`: information of each sensor on every column before anything else is
    fitted, (s, k): which sensor an effect acts on, and why a column is not observable.
    """

    sensors: tuple[EffectInformation, ...]
    labels: tuple[str, ...]
    noise_degrees: tuple[float, ...] = ()
    raw: Array | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters of the effects."""
        return self.sensors[0].names if self.sensors else ()

    @cached_property
    def total(self) -> EffectInformation:
        """All sensors together."""
        return reduce(add, self.sensors)

    def observable(self) -> "Evidence":
        """Without the columns whose information, all else fitted, is no more than rounding."""
        if self.raw is None or not self.sensors:
            return self
        least = MIN_INFORMATION_SHARE * self.raw.sum(axis=0)
        kept = (np.diag(self.total.information) > least).astype(np.float64)
        sensors = tuple(
            replace(
                sensor,
                information=sensor.information * np.outer(kept, kept),
                right=sensor.right * kept,
            )
            for sensor in self.sensors
        )
        return replace(self, sensors=sensors)

    def given(self, columns: Sequence[int]) -> "Evidence":
        """With some columns fitted too: no information on them remains."""
        if not len(columns):
            return self
        return replace(self, sensors=tuple(sensor.given(columns) for sensor in self.sensors))

    def residual(
        self, sensor: EffectInformation, chosen: Sequence[int]
    ) -> tuple[float, int, float]:
        """Chi-squared of a sensor with the chosen columns fitted, degrees, and p-value."""
        dropped, used = sensor.drop(chosen) if len(chosen) else (0.0, 0)
        rest, degrees = sensor.chi_squared - dropped, max(sensor.degrees - used, 1)
        noise = self.noise_degrees_of(next(i for i, s in enumerate(self.sensors) if s is sensor))
        if np.isinf(noise):
            return rest, degrees, float(chi2_sf(rest, degrees))
        return rest, degrees, float(f_sf(rest / degrees, degrees, noise))

    def noise_degrees_of(self, number: int) -> float:
        """Degrees of freedom of the noise of a sensor."""
        return self.noise_degrees[number] if self.noise_degrees else np.inf

    def sensor_of(self, columns: Sequence[int]) -> int:
        """The sensor with most information on the columns, of those whose readings they change.

        Where sensors share the tilts of positions, one informs on effects of the other, too.
        """
        own = list(columns)
        shares = np.array([np.sum(np.diag(s.information)[own]) for s in self.sensors])
        if self.raw is not None and (changed := self.raw[:, own].sum(axis=1) > 0).any():
            shares[~changed] = -1
        return int(np.argmax(shares))

    def excesses(self, chosen: Sequence[int]) -> tuple[tuple[float, float], ...]:
        """For each sensor chi-squared per degree with the chosen columns fitted, and its degrees.

        Where the residuals are consistent with the noise: 1, and the degrees of the noise.
        """
        factors = []
        for number, sensor in enumerate(self.sensors):
            rest, degrees, p_value = self.residual(sensor, chosen)
            within = p_value >= MIN_CONSISTENT_P_VALUE or rest <= degrees
            factors.append(
                (1.0, self.noise_degrees_of(number)) if within else (rest / degrees, float(degrees))
            )
        return tuple(factors)

    def scaled(self, excesses: Sequence[tuple[float, float]]) -> "Evidence":
        """The same with the noise variance of each sensor multiplied by its excess.

        A sensor whose residuals exceed its noise says nothing of what changes readings of the
        other one alone: it knows that by the tilts of positions, which its unexplained part moves.
        """
        sensors: list[EffectInformation] = []
        for number, (sensor, (excess, _)) in enumerate(zip(self.sensors, excesses, strict=True)):
            share = np.full(len(sensor.names), 1 / excess)
            if excess > 1 and self.raw is not None:
                share[(self.raw[number] == 0) & (self.raw.sum(axis=0) > 0)] = 0.0
            root = np.sqrt(share)
            sensors.append(
                replace(
                    sensor,
                    information=sensor.information * np.outer(root, root),
                    right=sensor.right * share,
                    chi_squared=sensor.chi_squared / excess,
                )
            )
        return replace(self, sensors=tuple(sensors), noise_degrees=tuple(d for _, d in excesses))
