"""What stands out against time: in one axis of one turn, and in one axis of all turns."""

from collections.abc import Mapping, Sequence

import numpy as np

from stages.contracts.tables import AXES
from stages.estimation.ringing import Ringing
from stages.estimation.standing_out import Stands
from stages.estimation.steady_turns import SteadyTurn
from stages.inference.lines import Taken
from stages.inference.pooled_lines import pooled


def in_turns(rings: Sequence[Ringing], turns: Sequence[SteadyTurn]) -> list[Stands]:
    """The strongest line of each axis in each turn, the search over all of them paid for."""
    place = {turn.name: turn for turn in turns}
    return [
        Stands(
            ring.drop,
            min(ring.line.p_value * len(rings), 1.0),
            None,
            ring.line.frequency,
            place[ring.manoeuvre],
        )
        for ring in rings
    ]


def in_all(
    turns: Sequence[SteadyTurn], taken: Mapping[str, Sequence[Taken]], lowest: float
) -> list[Stands]:
    """The frequency that stands out most of each axis in all turns; one turn is no more than it.

    What may be left of a line that was taken out of any turn is none.
    """
    found = []
    for i in range(len(AXES)):
        told = [turn for turn in turns if turn.tells(np.eye(3)[i])]
        if len(told) < 2:
            continue
        frequency, drop, chance = pooled(
            [turn.truth[:, i] for turn in told], [1 / turn.step for turn in told], lowest
        )
        if not len(frequency):
            continue
        for turn in told:
            noise = turn.sigma(np.eye(3)[i]) * np.sqrt(2 / len(turn.truth))
            for one in taken[turn.name]:
                leaks = one.leaks(frequency, turn.seconds) / noise
                chance = np.where(drop > len(told) * leaks**2, chance, 0.0)
        best = int(np.argmin(chance))
        trials = len(AXES) * len(frequency)
        p_value = float(np.exp(min(chance[best] + np.log(trials), 0.0)))
        found.append(Stands(float(drop[best]), p_value, None, float(frequency[best]), told[0]))
    return found
