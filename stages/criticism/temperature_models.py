"""Each axis of a sweep of temperatures, judged: which polynomial it follows, and what is left."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inertial.estimation.regression import Curve, Knee, curve_of, knee_of
from inertial.text.units import STANDARD_GRAVITY
from stages.criticism.temperature_sweeps import Sweep

ICE_POINT = 273.15  # K
LIKELIER = float(np.log(20))  # from which a knee is told
SHOWS = 0.5  # cosine or sine from which an accelerometer sees its scale factor, or a tilt


@dataclass(frozen=True)
class Channel:
    """One axis of a sweep, judged.

    `degree`: of its law, 0 where it has none; `chance`: of that by noise alone, after the search;
    `chance_beyond`: of what the highest degree leaves, after the search; `knee`: where it
    fits clearly better than that.
    """

    axis: str
    curve: Curve
    degree: int
    chance: float
    chance_beyond: float
    structure: bool
    knee: Knee | None

    @property
    def moves(self) -> bool:
        """Whether it goes with the temperature."""
        return self.degree > 0 or self.structure

    @property
    def change(self) -> float:
        """From the smallest reading to the largest."""
        return float(np.ptp(self.curve.readings))

    @property
    def told(self) -> int:
        """The degree of the polynomial that stands for it."""
        return self.curve.highest if self.structure else self.degree


@dataclass(frozen=True)
class Moving:
    """The channels of a sweep that go with the temperature, at least one."""

    sweep: Sweep
    channels: Sequence[Channel]

    @property
    def structured(self) -> bool:
        """Whether a polynomial does not hold all of them."""
        return any(channel.structure for channel in self.channels)

    @property
    def best(self) -> Channel:
        """The channel in which it is clearest."""
        if self.structured:
            own = [channel for channel in self.channels if channel.structure]
            return min(own, key=lambda one: one.chance_beyond)
        return min(self.channels, key=lambda one: one.chance)

    @property
    def leaning(self) -> dict[str, float]:
        """The tilt, rad, that would move each accelerometer across the vertical so much."""
        across = {
            one.axis: float(np.nan_to_num(np.sqrt(1 - self.sweep.along(one.axis) ** 2), nan=1.0))
            for one in self.channels
        }
        return {
            one.axis: one.change / (STANDARD_GRAVITY * across[one.axis])
            for one in self.channels
            if across[one.axis] >= SHOWS
        }

    @property
    def about(self) -> float:
        """The mean temperature, whole in °C, about which polynomials are told, K."""
        middle = np.mean([channel.curve.at.mean() for channel in self.channels])
        return float(np.round(middle - ICE_POINT)) + ICE_POINT


def moving(swept: Sequence[Sweep], level: float) -> list[Moving]:
    """Of all sweeps those that go with the temperature.

    `level`: accepted chance of a law in any channel where there is none, and of a structure.
    """
    every = [
        (sweep, {axis: curve_of(at, seen) for axis, at, seen in sweep.channels()})
        for sweep in swept
    ]
    curves = [curve for _, own in every for curve in own.values()]
    searched = (sum(len(c.lawful) for c in curves), len(curves))
    judged = [
        Moving(
            sweep, [one for a, c in own.items() if (one := _judged(a, c, level, searched)).moves]
        )
        for sweep, own in every
    ]
    return [one for one in judged if one.channels]


def _judged(axis: str, curve: Curve, level: float, searched: tuple[int, int]) -> Channel:
    """`searched`: how many degrees of laws, and how many channels, are looked at in all."""
    laws, structures = searched
    clear = [d for d in curve.lawful if curve.chance(range(d, d + 1)) * laws < level]
    degree = max(clear, default=0)
    beyond = min(1.0, curve.chance_beyond() * structures)
    knee = knee_of(curve.at, curve.readings) if beyond < level else None
    if knee is not None and _odds(curve, knee) < LIKELIER:
        knee = None
    chance = min(1.0, curve.chance(range(1, degree + 1)) * laws)
    return Channel(axis, curve, degree, chance, beyond, beyond < level, knee)


def _odds(curve: Curve, knee: Knee) -> float:
    """How much likelier, as a logarithm, two lines are than the polynomial of highest degree."""
    rounded = np.finfo(np.float64).tiny  # two lines may hold made-up readings wholly
    return len(curve.at) * float(np.log(curve.left(curve.highest) / max(knee.left, rounded)))
