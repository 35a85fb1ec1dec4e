"""How each stretch of a campaign moved, and when, how warm and how shaken it was."""

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stages.contracts.records import Manoeuvre
from stages.contracts.tables import ACCEL
from stages.estimation.motions import at_rest, in_blocks
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.solution import Solution
from stages.estimation.stills import Still
from stages.estimation.turns import Recorded
from stages.inference.whole_turns import Turn
from stages.model.motion import Motion

Array = NDArray[np.float64]

MOVING, AFTER = 1 / 3, 2 / 3  # of a visit: the turn, and the rest behind it
UPRIGHT = 1 - 1e-6  # cosine of an axis to the vertical


class CampaignMotions:
    """The stretches of one mount; without a clock that the logs share, no time is given."""

    def __init__(
        self,
        plan: Sequence[Manoeuvre],
        levels: NoiseLevels,
        solution: Solution,
        heading: float | None,
        shared_clock: bool,
    ) -> None:
        self._shared_clock = shared_clock
        self._visits = {m.name: float(place) for place, m in enumerate(plan)}
        names = positions_of(plan)
        self._places = {m.name: float(names.index(m.position)) for m in plan}
        self._levels, self._solution, self._heading = levels, solution, heading
        self._at_rest: dict[tuple[str, float], Motion] = {}

    def at_rest(self, still: Still) -> Motion:
        """A rest as one stretch."""
        name, time = still.manoeuvre.name, still.mean_of(still.time)
        time = time if self._shared_clock else np.nan
        later = AFTER if still.label.endswith("(rest-after)") else 0.0
        place = (name, still.angle)  # all pieces of a rest stand alike
        if place not in self._at_rest:
            self._at_rest[place] = at_rest(still, self._solution, self._heading, time)
        return replace(
            self._at_rest[place],
            time=np.array([time]),
            seconds=np.array([still.seconds.sum()]),
            visit=np.array([self._visits[name] + later]),
            position=np.array([self._places[name]]),
            temperature=np.array([still.mean_of(still.temperature)]),
            vibration=self._levels.of_samples(name, "rest", ACCEL)[None],
        )

    def turning(self, one: Recorded, turn: Turn) -> Motion:
        """A turn in its blocks; about an axis that is not upright gravity hides how it shakes."""
        name = one.plan.name
        blocks = one.blocks
        time = blocks.time if self._shared_clock else np.full(len(blocks), np.nan)
        motion = in_blocks(one.plan, turn, self._solution, self._heading, time)
        upright = abs(float(turn.position.up @ turn.about)) > UPRIGHT
        shaken = self._levels.of_samples(name, "steady", ACCEL) if upright else np.full(3, np.nan)
        return replace(
            motion,
            visit=np.full(len(time), self._visits[name] + MOVING),
            position=np.full(len(time), self._places[name]),
            temperature=blocks.temperature,
            vibration=np.tile(shaken, (len(time), 1)),
        )


def positions_of(plan: Sequence[Manoeuvre]) -> list[str]:
    """The positions of a plan in their order."""
    return list(dict.fromkeys(m.position for m in plan))


def mean_motion(motion: Motion, some: slice, share: Array) -> Motion:
    """Some stretches as one; `share`: what each of them counts for."""

    def mean(values: Array) -> Array:
        return np.asarray([share @ values[some]])

    names = [field.name for field in fields(Motion) if field.name != "about"]
    means: dict[str, Any] = {name: mean(getattr(motion, name)) for name in names}
    # The pull of a lever arm goes with the square of the rate, so its mean is the root of that.
    means["rate"] = np.sign(means["rate"]) * np.sqrt(mean(motion.rate**2))
    means["seconds"] = np.array([motion.seconds[some].sum()])
    means["surveyed"], means["position"] = motion.surveyed[some][:1], motion.position[some][:1]
    return Motion(about=motion.about, **means)
