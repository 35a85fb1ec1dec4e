"""Bias and scale factor error of one gyro from whole turns about it, as S0 has it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stages.inference.least_squares import Estimate, solve
from stages.inference.rests_and_turns import Earth


@dataclass(frozen=True)
class Angle:
    """One whole turn as its own axis saw it: summed angle of that gyro, α, duration, up or down."""

    summed: float  # rad
    angle: float  # rad, along the axis
    angle_sigma: float
    seconds: float
    up: float  # +1 where the axis points up, −1 where it points down
    density: float  # rad/√s


def known_angle(turns: Sequence[Angle], earth: Earth, scatter: float = 0.0) -> Estimate:
    """Bias and scale factor error of one gyro from turns about it, forward and backward.

    α̃ = b t + (1 + s) α + ω_e sinφ t for each turn; for one forward and one backward turn over
    equal times this is S0 (3-9), (3-10): b = (α̃₁+α̃₂)/(2t) − ω_e sinφ, s = (α̃₁−α̃₂)/(2α) − 1.
    Unknowns: b, s, the upward earth rate. `scatter` as in `joint`.
    """
    seconds = np.array([turn.seconds for turn in turns])
    angles = np.array([turn.angle for turn in turns])
    up = np.array([turn.up for turn in turns])
    summed = np.array([turn.summed for turn in turns])
    variance = [turn.density**2 * turn.seconds + turn.angle_sigma**2 for turn in turns]
    sigma = np.sqrt(variance + (scatter * seconds) ** 2)
    design = np.column_stack([seconds, angles, up * seconds])
    prior, prior_sigma = np.array([0.0, 0.0, earth.up]), np.array([1.0, 1.0, earth.up_sigma])
    return solve(design, summed - angles, sigma, prior, prior_sigma, 2)
