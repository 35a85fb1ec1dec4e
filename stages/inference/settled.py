"""Equations that are not linear in their unknowns: least squares until nothing moves any more.

The equations are made anew about each last result, as rows that are linear there, until the
weighted sum of squares is the smallest (Levenberg & Marquardt, as MINPACK has it). What is returned
is the linear estimate about that place, with its covariance.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from stages.inference.least_squares import Estimate, System

Array = NDArray[np.float64]

NONE = 1e-8  # relative change of the sum of squares that is none
TINY = 1e-15  # so that no small step of one unknown among large ones counts as the end
MOST = 100  # times that the equations are made


def settled(about: Callable[[Array], System], start: Array) -> Estimate:
    """The estimate of smallest variance where the design depends on the unknowns.

    Parameters
    ----------
    about : the equations, linear about given unknowns (p,); there their residuals are exact
    start : (p,), where to begin
    """
    first = about(start)
    prior, width = first.prior, first.prior_sigma

    @lru_cache(maxsize=1)
    def at(moved: bytes) -> System:
        return about(prior + width * np.frombuffer(moved))

    def residual(moved: Array) -> Array:
        system = at(moved.tobytes())
        away = system.observed - system.design @ (prior + width * moved)
        return np.append(away / system.sigma, -moved)

    def slope(moved: Array) -> Array:
        system = at(moved.tobytes())
        return -np.vstack([system.design / system.sigma[:, None] * width, np.eye(len(moved))])

    begin = (start - prior) / width
    found = least_squares(
        residual,
        begin,
        slope,
        method="lm",
        x_scale="jac",
        ftol=NONE,
        xtol=TINY,
        gtol=TINY,
        max_nfev=MOST,
    )
    return about(np.asarray(prior + width * found.x)).solve()
