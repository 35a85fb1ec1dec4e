"""The spectra of one manoeuvre within the band that tells the white noise, and their shape."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from inertial import tables
from inertial.arrays import Array
from inertial.estimation.noise_model import NoiseModel
from inertial.estimation.spectrum import (
    NoiseShape,
    in_band,
    level_of_pieces,
    shape_of,
    square_of_integral,
)
from inertial.sensors import COLUMNS

MIN_SAMPLES = 16  # fewer give no level


class Spectra:
    """The band levels of one manoeuvre, piece by piece, for each sensor by itself.

    Accelerometers and gyros may come in records of their own. A channel whose readings are all
    equal has no level. `carried`: sensors whose counts carry over what they leave.
    """

    def __init__(self) -> None:
        self.levels: dict[str, list[Array]] = {}
        self.frequencies: dict[str, list[Array]] = {}
        self.squares = np.zeros(6)
        self.sums = np.zeros(6)
        self.integrals = np.zeros(6)  # squares of what lines add up to, times samples
        self.samples: dict[str, int] = {}
        self.seconds: dict[str, list[float]] = {}
        self.carried: set[str] = set()

    def add(self, values: Array, rate: float, band: tuple[float, float]) -> None:
        """Take an unbroken piece, (n, 6), sampled at `rate`, Hz, in; `band`: Hz, of the levels."""
        for sensor, columns in COLUMNS.items():
            part = values[:, columns]
            part = part[np.isfinite(part).any(axis=1)]
            if len(part) >= MIN_SAMPLES:
                whole = np.isfinite(part).all(axis=0)
                varies = np.ptp(part, axis=0) > 0  # else their mean is off by its last digit
                known = np.where(whole & varies, part, 0.0)
                frequency, levels = in_band(known, rate, band)
                self.frequencies.setdefault(sensor, []).append(frequency)
                self.levels.setdefault(sensor, []).append(np.where(whole, levels, np.nan))
                self.squares[columns] += np.var(part, axis=0) * len(part)
                self.sums[columns] += part.sum(axis=0)
                self.integrals[columns] += square_of_integral(known, rate, band[1]) * len(part)
                self.samples[sensor] = self.samples.get(sensor, 0) + len(part)
                self.seconds.setdefault(sensor, []).append(len(part) / rate)

    def without_quantisation(self, sensor: str, axis: int, model: NoiseModel, step: float) -> None:
        """Leave of a channel the white noise of a model, of records that come every `step`, s."""
        for frequency, level in zip(
            self.frequencies.get(sensor, ()), self.levels.get(sensor, ()), strict=True
        ):
            level[:, axis] *= model.white_noise**2 / model.density(frequency, step)

    def rows(
        self, manoeuvre: str, phase: str, shapes: Mapping[str, Sequence[NoiseShape]]
    ) -> Iterator[dict[str, Any]]:
        """Of each channel; `shapes`: of the noise of each sensor in all manoeuvres."""
        for sensor, levels in self.levels.items():
            frequencies = self.frequencies[sensor]
            slowest = min(frequency.min() for frequency in frequencies)
            for i, (axis, shape) in enumerate(zip(tables.AXES, shapes[sensor], strict=True)):
                pieces, seconds = [], []
                for frequency, level, duration in zip(
                    frequencies, levels, self.seconds[sensor], strict=True
                ):
                    loud = shape.loud(frequency)
                    if loud.any():
                        flat = level[loud, i] / shape.at(frequency[loud]) ** 2
                        pieces.append(flat[:, None])
                        seconds.append(duration)
                white, sigma = level_of_pieces(pieces, seconds) if pieces else np.zeros((2, 1))
                if white[0] > 0:
                    slow = float(shape.at(slowest))
                    square = self.squares[COLUMNS[sensor]][i]
                    swing = self.integrals[COLUMNS[sensor]][i]
                    yield {
                        "manoeuvre": manoeuvre,
                        "phase": phase,
                        "channel": f"{sensor}_{axis}",
                        "white_noise": slow * float(white[0]),
                        "sigma": slow * float(sigma[0]),
                        "per_sample": float(np.sqrt(square / self.samples[sensor])),
                        "swing": float(np.sqrt(swing / self.samples[sensor])) or None,
                        "samples": self.samples[sensor],
                    }


def shapes_of(spectra: Mapping[tuple[str, str], Spectra]) -> dict[str, list[NoiseShape]]:
    """By sensor the shape of the noise of each channel within the band, at rest if there is any.

    `spectra`: by manoeuvre and phase. A filter in the band takes noise from its upper part; what
    means are uncertain by is at its lower end.
    """
    shapes = {}
    for sensor in COLUMNS:
        seen = {key: one for key, one in spectra.items() if sensor in one.levels}
        resting = [one for (_manoeuvre, phase), one in seen.items() if phase == "rest"]
        own = resting or [*seen.values()]
        frequencies = [frequency for one in own for frequency in one.frequencies[sensor]]
        levels = [np.nan_to_num(level) for one in own for level in one.levels[sensor]]
        shapes[sensor] = [
            shape_of(frequencies, [level[:, axis] for level in levels])
            for axis in range(len(tables.AXES))
        ]
    return shapes
