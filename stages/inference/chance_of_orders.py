"""What noise alone brings forth in a search against the table's angle.

Where the noise is white the drop of chi-squared of an order is exponentially distributed, 2 degrees
of freedom. Two things may be worse. A hump of the spectrum: the level is then that of the orders
around, all turns by themselves. And below the band in which the noise was read nothing says that
it is white: there the turns tell it by how they differ among themselves, and by the orders around,
with an F-test. What is the same in all turns cannot be had from noise that differs from turn to
turn.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from stages.inference.orders import Orders
from stages.inference.tails import chi_squared_bound

Array = NDArray[np.float64]

WHITE_FROM = 0.5  # Hz, below which noise is not known to be white; as where it is read
AROUND = 129  # orders of the grid whose median is the level of one
APART = 1.5  # periods by which another order must differ to know nothing of a line
SUFFICES = 5.0  # sigmas: what can be seen
FROM = 4.0  # order from which the orders around are enough to tell a level


def log_chance(said: Orders, turned: float) -> Array:
    """Natural logarithm of the chance of each order's drop by noise, (m,), without the search.

    turned : whole turns that a record is long, which says how far apart orders must be.
    """
    each = said.drop + said.apart
    turns = np.maximum(said.turns, 1)
    level = median_filter(each / (2 * turns), AROUND, mode="nearest")
    level /= chi_squared_bound(0.5, 2 * turns) / (2 * turns)
    chance = -said.drop / 2 / np.maximum(level, 1.0)
    for i in np.flatnonzero(said.hertz < WHITE_FROM).tolist():
        degrees, left = _told_by_turns(said, i, turned)
        ratio = said.drop[i] / 2 / max(left / max(degrees, 1.0), 1.0)
        by_turns = -degrees / 2 * np.log1p(2 * ratio / degrees) if degrees else 0.0
        chance[i] = max(-said.drop[i] / 2, by_turns)
    return np.asarray(np.where(said.turns > 0, chance, 0.0))


def sigmas_seen(said: Orders, turned: float, level: float) -> Array:
    """From how many sigmas on an order is seen, (m,): 5, or what its F-test asks for at `level`.

    Infinite where nothing tells the noise: of a slow ripple in one turn.
    """
    seen = np.where(said.turns > 0, SUFFICES, np.inf)
    for i in np.flatnonzero(said.hertz < WHITE_FROM).tolist():
        degrees, _ = _told_by_turns(said, i, turned)
        asked = np.sqrt(degrees * (level ** (-2 / degrees) - 1)) if degrees else np.inf
        seen[i] = max(seen[i], asked)
    return np.asarray(seen)


def _told_by_turns(said: Orders, i: int, turned: float) -> tuple[float, float]:
    """Degrees of freedom that tell the noise at an order, and their chi-squared."""
    degrees, left = 2.0 * max(said.turns[i] - 1, 0), float(said.apart[i])
    if said.order[i] >= FROM:
        around = _around(said.order, i, turned)
        degrees += 2.0 * float(said.turns[around].sum())
        left += float((said.drop + said.apart)[around].sum())
    return degrees, left


def _around(order: Array, i: int, turned: float) -> list[int]:
    """Orders from half to twice one, one period of the record apart from it and each other."""
    step = float(order[1] - order[0])
    apart = max(round(1 / turned / step), 1)
    first = max(round(APART / turned / step), 1)
    places = [*range(i - first, -1, -apart), *range(i + first, len(order), apart)]
    return [j for j in places if order[i] / 2 <= order[j] <= 2 * order[i]]
