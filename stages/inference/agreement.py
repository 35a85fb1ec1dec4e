"""Whether values agree within their sigmas, one by one and many together."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stages.inference.tails import student_beyond


def chance_of(in_sigmas: float, degrees: float = np.inf) -> float:
    """Chance that a normal error is at least so many sigmas, either way.

    `degrees`: of freedom, where sigma is estimated (Student's t).
    """
    return float(2 * student_beyond(abs(in_sigmas), degrees))


def beyond_chance(p_values: Sequence[float], level: float) -> NDArray[np.bool_]:
    """Which of n comparisons differ, (n,), when one false alarm in all of them has chance `level`.

    The smallest p-value is held against level/n, the next one against level/(n − 1), until one
    is larger (Holm 1979).
    """
    p = np.asarray(p_values, dtype=np.float64)
    order = np.argsort(p)
    small = p[order] < level / np.arange(len(p), 0, -1)
    result = np.zeros(len(p), dtype=np.bool_)
    result[order] = np.logical_and.accumulate(small)
    return result
