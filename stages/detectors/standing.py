"""Whether an IMU stood in another way, or its accelerometers are read as each other."""

import numpy as np

from stages.detectors.detector import Array
from stages.detectors.exchanges import EVERY, Permutation

ASKEW = float(np.cos(np.radians(25)))  # how far an IMU may be mounted from the planned direction
CLEARLY = 3.0  # times as far from what was expected, for the other explanation to be wrong


def read_as_other_axes(force: Array, up: Array, forces: Array, ups: Array) -> Permutation | None:
    """The permutation that a rest was read with, if that and no other attitude explains it.

    Every accelerometer has its own bias and scale factor, and the triad its own mounting: what
    the other rests read, forces = A [ups; 1], foretells the three readings of this one, either in
    the planned attitude with the axes exchanged, or as read with another axis up. None where the
    two differ too little to tell, as by hand, or where the other rests are too few.

    Parameters
    ----------
    force : (3,), m/s², mean of the rest in question
    up : (3,), what was planned to point up in it
    forces, ups : (k, 3), the same of rests that agree with the plan
    """
    design = np.column_stack([ups, np.ones(len(ups))])
    if np.linalg.matrix_rank(design, tol=0.1) < 4:
        return None
    response = np.linalg.lstsq(design, forces, rcond=None)[0].T
    foretold = response @ np.append(up, 1.0)
    away: dict[Permutation, float] = {}
    for permutation in EVERY:
        straight = permutation.of(force)
        if float(straight @ up) > ASKEW * float(np.linalg.norm(force)):
            away[permutation] = float(np.linalg.norm(straight - foretold))
    if not away:
        return None
    axis = int(np.argmax(np.abs(force)))
    stood = np.sign(force[axis]) * np.eye(3)[axis]
    otherwise = float(np.linalg.norm(force - response @ np.append(stood, 1.0)))
    best = min(away, key=lambda permutation: away[permutation])
    return best if CLEARLY * away[best] < otherwise else None
