"""Drift from stretch to stretch: with the time since the start, and with the temperature.

A stretch may last for minutes, so its mean of a function of time is not the function at its
middle. The start is the first sample of all logs: for an instrument that was switched on before,
a warm-up began earlier, and its amplitude differs by a factor.
"""

import numpy as np
from numpy.typing import NDArray

from inertial.physics.effect import MEAN_TEMPERATURE, Constant
from inertial.physics.motion import Motion
from inertial.text.messages import _

Array = NDArray[np.float64]

NO_CLOCK = (
    "The logs share no clock, so nothing tells how long after one another they were recorded."
)
NO_TEMPERATURE = "No temperature is recorded."
NOT_EVERYWHERE = "The temperature is not recorded everywhere."


def without_clock(motion: Motion) -> str:
    """Why drift with time is not observable; empty where it is."""
    return "" if np.isfinite(motion.time).all() else NO_CLOCK


def without_temperature(motion: Motion) -> str:
    """Why drift with temperature is not observable; empty where it is."""
    known = np.isfinite(motion.temperature)
    if known.all():
        return ""
    return NOT_EVERYWHERE if known.any() else NO_TEMPERATURE


def evenly(motion: Motion, count: int) -> Array:
    """`count` equally spaced times between the first stretch and the last, s, without the ends."""
    if without_clock(motion):
        return np.zeros(0)
    return np.linspace(motion.time.min(), motion.time.max(), count + 2)[1:-1]


def after(motion: Motion, time: float) -> Array:
    """The share of each stretch after a time, (n,)."""
    return np.clip((motion.time - time) / motion.seconds + 0.5, 0.0, 1.0)


def decayed(motion: Motion, constant: float) -> Array:
    """The mean of exp(−t/τ) over each stretch, (n,), for the time constant τ, s."""
    half = motion.seconds / (2 * constant)
    return np.asarray(np.exp(-motion.time / constant) * np.sinh(half) / half)


def mean_temperature(motion: Motion, reference: float | None = None) -> Constant:
    """The temperature that others are relative to: the mean of the campaign, K."""
    mean = reference
    if mean is None:
        mean = float(np.average(motion.temperature, weights=motion.seconds))
    return Constant(MEAN_TEMPERATURE, "K", _("mean temperature of the campaign"), mean)


def warmer(motion: Motion, reference: float | None = None) -> Array:
    """Temperature of each stretch less `reference`, the mean of the campaign, (n,), K.

    Without a reference the motion is all of the campaign.
    """
    return np.asarray(motion.temperature - mean_temperature(motion, reference).value)
