"""What an oscillation of the rate leaves in an angle whose window cuts it.

    ∫ A sin(2πf t + ψ) dt = A/(2πf) · (cos ψ₁ − cos ψ₂)

ψ₁, ψ₂ are its phases at the two ends. For phases by chance this is A/(2πf) rms, at worst twice as
much. From rest to rest nothing is cut: whole turns are free of it, windows are not.
"""

from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def ripple_angle(amplitude: float, frequency: float) -> float:
    """Rms of the angle that is left, rad, of an amplitude in rad/s at `frequency` in Hz.

    At worst it is twice this.
    """
    return amplitude / (2 * pi * frequency)


def ripple_scale(amplitude: float, frequency: float, angle: float, windows: int = 1) -> float:
    """Rms of the scale factor error by `windows` windows of `angle` (rad) each, 1.

    Forward and backward are two. At worst it is 2√windows times this.
    """
    return ripple_angle(amplitude, frequency) / abs(angle) / sqrt(windows)


def ripple_window(amplitude: float, frequency: float, seconds: Array) -> Array:
    """Rms over all starts of the angle that is left in windows of `seconds`, rad.

    ∫ over T of A sin(2πf t + ψ) dt has the amplitude A/(πf) · |sin πfT|: nothing where T holds
    whole periods, as 18 s do of 20 Hz.
    """
    size = amplitude / (pi * frequency) / sqrt(2)
    return np.asarray(size * np.abs(np.sin(pi * frequency * seconds)))
