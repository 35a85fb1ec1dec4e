"""The oscillations of all turns of one mount, one after another: bound to time or to the angle."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stages.estimation.against_angle import best_orders, shortest
from stages.estimation.against_time import in_all, in_turns
from stages.estimation.bound import Bound, explained
from stages.estimation.ringing import Ringing, ringing
from stages.estimation.standing_out import Stands
from stages.estimation.steady_turns import SteadyTurn
from stages.inference.chance_of_orders import sigmas_seen
from stages.inference.lines import Taken, without_line
from stages.inference.orders import Orders, search

Array = NDArray[np.float64]

MOST = 6  # oscillations that are told apart
SEARCHES = 4  # in one turn, in all turns, orders, the order 1: each has its share of the chance


@dataclass(frozen=True)
class Heard:
    """What was found in the turns of one mount.

    lines : the oscillations in the order in which they were found
    strongest : the strongest line in time of each axis and turn before any was taken out
    orders : of the last search, what each says; None without a turn whose angle is known
    left : of the last search, what stood out most in time, the order 1, and the best other order
    seen : (m,), from how many sigmas on an order is seen
    more : whether the last search would have found another one, but enough were found
    """

    turns: Sequence[SteadyTurn]
    lines: Sequence[Bound]
    strongest: Sequence[Ringing]
    orders: Orders | None
    left: Sequence[Stands]
    seen: Array
    more: bool


def heard(turns: Sequence[SteadyTurn], level: float, lowest: float) -> Heard:
    """Find the oscillation that stands out most, take it out, and search again.

    level : accepted chance of finding any where there is none; lowest : Hz, from which on lines in
    time are sought
    """
    share = level / SEARCHES
    left, taken = list(turns), {turn.name: list[Taken]() for turn in turns}
    lines: list[Bound] = []
    first: list[Ringing] = []
    while True:
        rings = [ring for turn in left for ring in ringing(turn, lowest, taken[turn.name])]
        first = first if lines else rings
        turning = [turn for turn in left if np.isfinite(turn.rate)]
        orders = search([turn.course(turn.about) for turn in turning]) if turning else None
        against = [] if orders is None else best_orders(turning, orders, taken)
        every = [*in_turns(rings, left), *in_all(left, taken, lowest), *against]
        clear = [one for one in every if one.p_value < share]
        if not clear or len(lines) == MOST:
            break
        found = explained(max(clear, key=lambda one: one.drop), left, lowest, share)
        lines.append(found)
        left = [_without(turn, found, taken[turn.name]) for turn in left]
    seen = np.zeros(0) if orders is None else sigmas_seen(orders, shortest(turning), share)
    return Heard(turns, lines, first, orders, every, seen, bool(clear))


def _without(turn: SteadyTurn, found: Bound, taken: list[Taken]) -> SteadyTurn:
    """A turn without an oscillation: about each axis as large, and in such phase, as it is."""
    frequency = found.frequencies.get(turn.name)
    if frequency is None:
        return turn
    parts = [without_line(record, 1 / turn.step, frequency) for record in turn.truth.T]
    taken.append(Taken(frequency, max(part.amplitude for part in parts)))
    less = [
        record - part.amplitude * part.shape
        for record, part in zip(turn.truth.T, parts, strict=True)
    ]
    return replace(turn, truth=np.column_stack(less))
