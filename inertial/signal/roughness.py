"""How much a channel changes from one reading to the next where it is quietest."""

import numpy as np

from inertial.signal.detector import Array

BLOCK = 64  # readings
ROUNDED = 1e-9  # of a reading
SCATTER = 1.4826  # sigma of Gaussian readings in medians of their absolute values
QUIET = 0.25  # share of the blocks that are taken as quiet
ALIVE = 0.8  # counts; what goes to and fro between two counts has 0.71, and no noise


def roughness(values: Array) -> float:
    """The root mean square change between readings, divided by √2, in the quiet blocks of (n,).

    For white noise of σ and a count q it is √(σ² + q²/12), of increments that carry over
    √(σ² + q²/4), if σ is no less than half a count. NaN for fewer readings than a block has.
    """
    square = in_blocks(np.diff(values) ** 2 / 2)
    return float(np.sqrt(np.quantile(square.mean(axis=1), QUIET))) if len(square) else np.nan


def smallest_step(values: Array) -> float:
    """The smallest change between readings, (n,), which is a count; infinite if there is none.

    Readings are counts times their size, so that equal steps differ in their last digits.
    """
    changes = np.abs(np.diff(values))
    real = changes > ROUNDED * np.abs(values).max(initial=0.0)
    return float(changes[real].min(initial=np.inf))


def in_blocks(changes: Array) -> Array:
    """Changes in blocks, (k, BLOCK), without those that are left over."""
    return changes[: len(changes) // BLOCK * BLOCK].reshape(-1, BLOCK)
