"""The lines of the turns as rows: the strongest of each axis, and what was found beneath them."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from stages.contracts.tables import AXES
from stages.estimation.bound import Bound
from stages.estimation.coupling import TABLE
from stages.estimation.lines_of_turns import Heard
from stages.estimation.ringing import Ringing
from stages.estimation.steady_turns import SteadyTurn

Row = dict[str, Any]


def listed(heard: Heard, named: Sequence[tuple[str, Bound]]) -> Iterator[Row]:
    """The strongest line of each axis in each turn; then others of what was found.

    named : each oscillation with the effect that it is taken for
    """
    turns = {turn.name: turn for turn in heard.turns}
    told = set()
    for ring in heard.strongest:
        turn = turns[ring.manoeuvre]
        effect = next((name for name, one in named if _is(ring, one, turn)), None)
        told.add((ring.manoeuvre, ring.axis, effect))
        yield _row(ring, turn, effect)
    for name, one in named:
        for ring in one.shown:
            turn = turns[ring.manoeuvre]
            if (ring.manoeuvre, _axis(ring, turn), name) not in told:
                yield _row(ring, turn, name)


def _is(ring: Ringing, one: Bound, turn: SteadyTurn) -> bool:
    """Whether a line is that of an oscillation: within a bin."""
    frequency = one.frequencies.get(turn.name, np.inf)
    return abs(ring.line.frequency - frequency) < 1 / turn.seconds


def _axis(ring: Ringing, turn: SteadyTurn) -> str:
    """The axis of the case that is nearest to that of the line."""
    return ring.axis if ring.axis != TABLE else AXES[int(np.argmax(np.abs(turn.about)))]


def _row(ring: Ringing, turn: SteadyTurn, effect: str | None) -> Row:
    return {
        "manoeuvre": ring.manoeuvre,
        "axis": _axis(ring, turn),
        "frequency": ring.line.frequency,
        "frequency_sigma": ring.line.sigma_frequency,
        "amplitude": ring.line.amplitude,
        "amplitude_sigma": ring.line.sigma_amplitude,
        "p_value": ring.line.p_value,
        "order": ring.line.frequency / turn.hertz(1.0) if np.isfinite(turn.rate) else None,
        "effect": effect,
    }
