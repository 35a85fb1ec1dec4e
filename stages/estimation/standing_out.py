"""What stands out of the noise of the turns, before it is known what it is."""

from dataclasses import dataclass

from stages.estimation.steady_turns import SteadyTurn


@dataclass(frozen=True)
class Stands:
    """An order against the table's angle, or else a frequency in time."""

    drop: float  # of chi-squared
    p_value: float  # the search paid for
    order: float | None
    frequency: float  # Hz, in the turn
    turn: SteadyTurn
