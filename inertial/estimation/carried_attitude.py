"""An attitude carried by the gyros from one static position to the next, and what changes it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from inertial.estimation.attitude import integrate

Array = NDArray[np.float64]

STRETCH_S = 0.1  # s, of the motion in which the response to an effect counts as constant


@dataclass(frozen=True)
class Passage:
    """The readings of the gyros from stop `first` to the next.

    `rates`: (k, 3), rad/s, means of short stretches; `seconds`: (k,); `density`: (3,), rad/√s;
    `clock`, `clock_sigma`: of its log, and of the rate of that, relative.
    """

    first: int
    rates: Array
    seconds: Array
    density: Array
    clock: str = ""
    clock_sigma: float = 0.0

    @property
    def starts(self) -> NDArray[np.int_]:
        """Where stretches of about `STRETCH_S` begin among the readings."""
        place = np.floor(np.cumsum(self.seconds) / STRETCH_S - 1e-6)
        return np.flatnonzero(np.append(1, np.diff(place)) > 0)


@dataclass(frozen=True)
class IntegratedMotion:
    """A motion by the gyros, before correction for the earth's rate.

    `whole`: (3, 3), from body axes at its start to those at its end; `slope`: (3, 12), the rotation
    per unit of each unknown of the gyros, rad, in axes at the end; `white`: (3, 3), covariance of
    that rotation by noise, rad²; `response`: (s, 3, 3), of it to the mean rates of s stretches.
    """

    whole: Array
    slope: Array
    white: Array
    response: Array
    seconds: float

    def relative_to_earth(self, earth: Array) -> Array:
        """The same for directions fixed to the earth; its rate at the start, (3,)."""
        turned = self.seconds * (self.whole @ earth)
        return np.asarray(Rotation.from_rotvec(turned).as_matrix() @ self.whole)


def integrated_motion(passage: Passage, matrix: Array, bias: Array) -> IntegratedMotion:
    """Integrate the attitude over a motion, with its dependence on M, bias and noise."""
    inverse = np.linalg.inv(matrix)
    rates = (passage.rates - bias) @ inverse.T
    attitude = integrate(rates, passage.seconds)
    weighted = (attitude.to_end @ inverse) * passage.seconds[:, None, None]
    by_matrix = -np.einsum("kir,kc->irc", weighted, rates).reshape(3, 9)
    noise = weighted * passage.density / np.sqrt(passage.seconds)[:, None, None]
    return IntegratedMotion(
        attitude.whole,
        np.hstack([by_matrix, -weighted.sum(axis=0)]),
        np.einsum("kir,kjr->ij", noise, noise),
        np.add.reduceat(weighted, passage.starts),
        float(passage.seconds.sum()),
    )
