"""How errors of the sensors grow in free inertial navigation over a minute.

With the axes of the laboratory fixed and the attitude known at the start, a rate error δω and an
error of specific force δf that stay as they are, in these axes, give after t

    attitude  ψ = δω t             velocity  δv = δf t + ψ × (g u) t / 2

u up. So a gyro error grows with t in attitude and with g t²/2 in velocity, an accelerometer error
with t in velocity. What feedback by gravity (Schuler, a period of 84 min) and the turning earth
add is of the order of (2π t / 84 min)² / 6 and ω_earth t, below 1 % in a minute. Sources: Titterton
& Weston, Strapdown Inertial Navigation Technology, 2nd ed. 2004, on the growth of errors over short
times; Groves, Principles of GNSS, Inertial, and Multisensor Integrated Navigation Systems, 2nd ed.
2013, on short-term straight-line error propagation.
"""

import numpy as np
from numpy.typing import NDArray

from stages.model.vectors import cross

Array = NDArray[np.float64]

SECONDS = 60.0


def grown(rate: Array, force: Array, lift: Array, seconds: float = SECONDS) -> tuple[Array, Array]:
    """Errors of attitude, rad, and of velocity, m/s, after some time, (…, 3) each.

    Parameters
    ----------
    rate, force : (…, 3), rad/s and m/s², errors of what the sensors say, corrected
    lift : (…, 3), m/s², the specific force that holds the case up: g, upward
    """
    attitude = rate * seconds
    # The attitude as computed has turned too far by ψ, so the specific force is turned by ψ.
    velocity = force * seconds + cross(attitude, lift) * (seconds / 2)
    return attitude, velocity
