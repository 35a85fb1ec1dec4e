"""Which white noise each mean and each sum carries."""

from collections.abc import Sequence
from functools import cached_property

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.records import rows_of

Array = NDArray[np.float64]

LOUD = 1.5  # times what white noise makes samples scatter, from which they oscillate
UNLIKE = 3.0  # sigmas by which a manoeuvre's noise must differ from the others' to count as its own


class NoiseLevels:
    """White noise by manoeuvre, phase and channel, per √s.

    A level is known to some per cent only, and a sensor alone has the same in every
    manoeuvre. So the level that is common to the campaign is taken, but for a manoeuvre
    and phase whose own level differs from it by more than three of its sigmas: there the
    table, or the air, adds to the noise.
    """

    def __init__(self, noise: pd.DataFrame) -> None:
        self._own: dict[tuple[str, str, str], tuple[float, float]] = {}
        self._samples: dict[tuple[str, str, str], float] = {}
        by_channel: dict[str, list[tuple[float, float]]] = {}
        for row in rows_of(noise):
            level = (row["white_noise"], row["sigma"])
            self._own[row["manoeuvre"], row["phase"], row["channel"]] = level
            self._samples[row["manoeuvre"], row["phase"], row["channel"]] = row["per_sample"]
            by_channel.setdefault(row["channel"], []).append(level)
        self._common: dict[str, float] = {}
        self._relative = 0.0
        for channel, levels in by_channel.items():
            white, sigma = np.array(levels).T
            alike = np.abs(white - np.median(white)) <= UNLIKE * sigma
            alike = alike if alike.any() else np.ones(len(white), bool)
            # Weights by relative sigma: else a level that came out low would weigh more for it.
            weight = (white[alike] / sigma[alike]) ** 2
            self._common[channel] = float(np.average(white[alike], weights=weight))
            self._relative = max(self._relative, float(weight.sum() ** -0.5))

    @property
    def degrees(self) -> float:
        """Degrees of freedom of the noise level itself: a variance known to √(2/ν)."""
        return 0.5 / self._relative**2 if self._relative > 0 else np.inf

    def of(self, manoeuvre: str, phase: str, channels: Sequence[str]) -> Array:
        """The levels of some channels, rest or steady; NaN where nothing is known."""
        return np.array([self._one(manoeuvre, phase, channel) for channel in channels])

    def of_samples(self, manoeuvre: str, phase: str, channels: Sequence[str]) -> Array:
        """What the samples of some channels scatter in all, not per √s; NaN where not known."""
        keys = [(manoeuvre, phase, channel) for channel in channels]
        return np.array([self._samples.get(key, np.nan) for key in keys])

    def rings(self, manoeuvre: str, channels: Sequence[str]) -> bool:
        """Whether a channel oscillates in the steady part of a turn, and not at rest."""
        return any(self._ringing(manoeuvre, channel) for channel in channels)

    def _ringing(self, manoeuvre: str, channel: str) -> bool:
        turn = (manoeuvre, "steady", channel)
        if turn not in self._own or channel not in self._at_rest:
            return False
        return self._scatter(turn) > LOUD * self._at_rest[channel]

    @cached_property
    def _at_rest(self) -> dict[str, float]:
        """What the samples of each channel usually scatter at rest, in its white noise per √s."""
        rests: dict[str, list[float]] = {}
        for key in self._own:
            if key[1] == "rest":
                rests.setdefault(key[2], []).append(self._scatter(key))
        return {channel: float(np.median(scatters)) for channel, scatters in rests.items()}

    def _scatter(self, key: tuple[str, str, str]) -> float:
        return self._samples[key] / self._own[key][0]

    def _one(self, manoeuvre: str, phase: str, channel: str) -> float:
        common = self._common.get(channel, np.nan)
        level, sigma = self._own.get((manoeuvre, phase, channel), (common, np.inf))
        return level if abs(level - common) > UNLIKE * sigma else common
