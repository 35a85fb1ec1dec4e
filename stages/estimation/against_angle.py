"""What stands out in the turns against the table's angle."""

from collections.abc import Mapping, Sequence

import numpy as np

from stages.estimation.standing_out import Stands
from stages.estimation.steady_turns import SteadyTurn
from stages.inference.chance_of_orders import log_chance
from stages.inference.lines import Taken
from stages.inference.orders import Orders

ECCENTRIC = 1.0  # the order of an encoder off its axis


def best_orders(
    turns: Sequence[SteadyTurn], said: Orders, taken: Mapping[str, Sequence[Taken]]
) -> list[Stands]:
    """The order 1, and the best of all others: two searches."""
    chance = log_chance(said, shortest(turns))
    # What may be left of a line that was taken out of any turn is no ripple.
    amplitude = np.sqrt(said.drop) * np.where(said.turns > 0, said.sigma, 0.0)
    for turn in turns:
        for one in taken[turn.name]:
            leaks = one.leaks(turn.hertz(1.0) * said.order, turn.seconds)
            stands = amplitude * said.order * abs(turn.rate) > leaks
            chance = np.where(stands, chance, 0.0)
    found = []
    others = np.where(said.order > ECCENTRIC, chance, 0.0)
    for i, trials in ((0, 1.0), (int(np.argmin(others)), float(len(others)))):
        p_value = float(np.exp(min(chance[i] + np.log(trials), 0.0)))
        order, turn = float(said.order[i]), turns[0]
        found.append(Stands(float(said.drop[i]), p_value, order, turn.hertz(order), turn))
    return found


def shortest(turns: Sequence[SteadyTurn]) -> float:
    """How many whole turns the shortest of the steady parts is long."""
    return min(turn.seconds * turn.hertz(1.0) for turn in turns)
