"""The evidence of the equations of all sensors on the effects."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from operator import add

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.least_squares import MIN_INFORMATION_SHARE, EffectInformation
from inertial.estimation.probability import chi2_sf, f_sf
from inertial.estimation.variance_components import MIN_CONSISTENT_P_VALUE

# ---- Searched effects, each by its columns in the evidence.


@dataclass(frozen=True)
class SearchedEffect:
    """An effect and its columns, once for every value of what is scanned.

    `candidates`: the columns of each candidate; an effect without a scan has one. `free`: no
    physical effect but a course that could be anything, such as a drift without a law; it takes
    the place of several effects that together imitate it, and no one's where one suffices.
    `between`: whether the true value of a scan may lie between two candidates.
    """

    name: str
    candidates: tuple[tuple[int, ...], ...]
    free: bool = False
    between: bool = True


def searched_effect(
    name: str, *candidates: Sequence[int], free: bool = False, between: bool = True
) -> SearchedEffect:
    """An effect by the columns of its candidates."""
    each = tuple(tuple(int(i) for i in columns) for columns in candidates)
    return SearchedEffect(name, each, free, between)


# ---- The information of the equations of all sensors about the effects.

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Evidence:
    """What each sensor says of the effects, and all together.

    `sensors`: independent equations about the same effects; `labels`: their names;
    `noise_degrees`: degrees of freedom from which the noise of each was estimated, none:
    infinitely many; `raw`: information of every column before anything else is fitted, summed
    over the sensors, (k,), for the reason why a column is not seen.
    """

    sensors: tuple[EffectInformation, ...]
    labels: tuple[str, ...]
    noise_degrees: tuple[float, ...] = ()
    raw: Array | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters of the effects."""
        return self.sensors[0].names if self.sensors else ()

    @property
    def total(self) -> EffectInformation:
        """All sensors together."""
        return reduce(add, self.sensors)

    def seen(self) -> "Evidence":
        """Without the columns of which fitting all else leaves no more than rounding."""
        if self.raw is None or not self.sensors:
            return self
        kept = (np.diag(self.total.information) > MIN_INFORMATION_SHARE * self.raw).astype(
            np.float64
        )
        sensors = tuple(
            replace(
                sensor,
                information=sensor.information * np.outer(kept, kept),
                right=sensor.right * kept,
            )
            for sensor in self.sensors
        )
        return replace(self, sensors=sensors)

    def left_over(
        self, sensor: EffectInformation, chosen: Sequence[int]
    ) -> tuple[float, int, float]:
        """What the chosen columns leave of a sensor: chi-squared, degrees, and its chance."""
        dropped, used = sensor.drop(chosen) if len(chosen) else (0.0, 0)
        rest, degrees = sensor.chi_squared - dropped, max(sensor.degrees - used, 1)
        noise = self.known_from(next(i for i, s in enumerate(self.sensors) if s is sensor))
        if np.isinf(noise):
            return rest, degrees, float(chi2_sf(rest, degrees))
        return rest, degrees, float(f_sf(rest / degrees, degrees, noise))

    def known_from(self, number: int) -> float:
        """Degrees of freedom of the noise of a sensor."""
        return self.noise_degrees[number] if self.noise_degrees else np.inf

    def sensor_of(self, columns: Sequence[int]) -> int:
        """The sensor that sees the columns best."""
        shares = [float(np.sum(np.diag(s.information)[list(columns)])) for s in self.sensors]
        return int(np.argmax(shares))

    def misfit(self, chosen: Sequence[int], of: Sequence[int]) -> tuple[float, int]:
        """By how much the residuals exceed the noise where the columns `of` are seen best.

        1 where the model with the chosen columns describes that sensor within its noise; else
        chi-squared per degree, and the degrees.
        """
        sensor = self.sensors[self.sensor_of(of)]
        rest, degrees, p_value = self.left_over(sensor, chosen)
        return (1.0, degrees) if p_value >= MIN_CONSISTENT_P_VALUE else (rest / degrees, degrees)

    def excesses(self, chosen: Sequence[int]) -> tuple[tuple[float, float], ...]:
        """For each sensor by how much its residuals exceed the noise, and from how many degrees.

        Where the model with the chosen columns describes the sensor within its noise: 1, and
        the degrees of the noise.
        """
        found = []
        for number, sensor in enumerate(self.sensors):
            rest, degrees, p_value = self.left_over(sensor, chosen)
            within = p_value >= MIN_CONSISTENT_P_VALUE or rest <= degrees
            found.append(
                (1.0, self.known_from(number)) if within else (rest / degrees, float(degrees))
            )
        return tuple(found)

    def weakened(self, excesses: Sequence[tuple[float, float]]) -> "Evidence":
        """The same with the variance of each sensor so many times as large."""
        sensors = tuple(
            replace(
                sensor,
                information=sensor.information / excess,
                right=sensor.right / excess,
                chi_squared=sensor.chi_squared / excess,
            )
            for sensor, (excess, _) in zip(self.sensors, excesses, strict=True)
        )
        return replace(self, sensors=sensors, noise_degrees=tuple(d for _, d in excesses))
