"""Where the manoeuvres of every window are, by the axes as the sensors are taken to be read."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.records import Manoeuvre
from inertial.signal.axis_permutations import Permutation
from inertial.signal.rests_and_motions import Stretch, moving, stretches, with_slow_ends
from stages.segment.matching import Observation, match, observe, points
from stages.segment.windows import Binned

Array = NDArray[np.float64]

AS_NAMED = Permutation((0, 1, 2), (1, 1, 1))


@dataclass(frozen=True)
class Axes:
    """What takes the readings of the two sensors to the axes that the plan names."""

    accel: Permutation = AS_NAMED
    gyro: Permutation = AS_NAMED

    @property
    def as_named(self) -> bool:
        """Whether both sensors read as the plan names their axes."""
        return self == AS_PLANNED

    def plan_of(self, m: Manoeuvre) -> Manoeuvre:
        """A manoeuvre with its directions as these sensors read them; readings stay as they are."""
        up = None if m.up is None else self.accel.inverse.of(m.up)
        about = None if m.about is None else self.gyro.inverse.of(m.about)
        return replace(m, up=up, about=about)


AS_PLANNED = Axes()


@dataclass(frozen=True)
class Division:
    """A window cut into stretches that move or rest, in one way or another."""

    binned: Binned
    ways: Sequence[tuple[Sequence[Stretch], Sequence[Observation]]]


@dataclass(frozen=True)
class Located:
    """Which stretch of a window is which manoeuvre, None where it is not found.

    `plan`: the manoeuvres as the sensors read their directions, by these axes.
    """

    binned: Binned
    axes: Axes
    plan: Sequence[Manoeuvre]
    stretches: Sequence[Stretch]
    observed: Sequence[Observation]
    matched: Mapping[str, int | None]

    def place(self, m: Manoeuvre) -> int | None:
        """The stretch of a manoeuvre."""
        return self.matched.get(m.name)

    def rest_before(self, m: Manoeuvre) -> int | None:
        """The stretch at rest just before a turn that was found, or before all that moves."""
        place = self.place(m)
        if place is None and self.binned.window.alone:
            place = next(
                (k for k, observation in enumerate(self.observed) if observation.moves), None
            )
        if not place or self.observed[place - 1].moves or place - 1 in self.matched.values():
            return None
        return place - 1

    @property
    def agreeing(self) -> tuple[int, int]:
        """How many observations agree with the plan, and how many there are.

        A rest gives the direction of gravity, a turn its axis and sense, and the rest before it
        the direction of gravity once more; a sensor of which an axis is lacking gives none.
        """
        agreements = [agrees for m in self.plan for agrees in self._agree(m)]
        return sum(agreements), len(agreements)

    @property
    def fitting(self) -> list[tuple[str, int]]:
        """The observations that agree with the plan, by manoeuvre and number."""
        return [(m.name, n) for m in self.plan for n, agrees in enumerate(self._agree(m)) if agrees]

    def _agree(self, m: Manoeuvre) -> list[bool]:
        place = self.place(m)
        if m.do == "positions":
            return []
        if m.do == "rest":
            known = m.up is not None and any(
                np.isfinite(observation.force).all() for observation in self.observed
            )
            return [place is not None] if known else []
        agreements = []
        if any(np.isfinite(observation.rate).all() for observation in self.observed):
            planned = m.rate if m.recorded == "steady" else m.angle
            turned = 0.0 if place is None else _about(self.observed[place], m)
            agreements.append(turned != 0 if planned is None else turned * planned > 0)
        before = self.rest_before(m)
        if (
            before is not None
            and m.up is not None
            and np.isfinite(self.observed[before].force).all()
        ):
            agreements.append(bool(points(self.observed[before].force, m.up)))
        return agreements


def divide(binned: Binned, level: Array, threshold: float, noise: float) -> Division:
    """A window in which rates beyond the threshold, or else beyond the noise, count as motion."""
    ways = []
    above_noise = moving(binned.rates, binned.forces, level, noise)
    for lowest in (threshold, noise):
        moves = moving(binned.rates, binned.forces, level, lowest)
        divided = stretches(moves, binned.bin_seconds, binned.forces)
        divided = with_slow_ends(divided, above_noise, binned.bin_seconds)
        ways.append((divided, observe(binned, divided, level)))
    return Division(binned, ways)


def locate(
    window: Division, axes: Axes = AS_PLANNED, manoeuvres: Sequence[Manoeuvre] | None = None
) -> Located:
    """Match the manoeuvres of a window, or others, to its stretches.

    A wrong unit makes a turn too slow to count as motion; where a turn is not found, all that is
    above the noise counts.
    """
    plan = [axes.plan_of(m) for m in manoeuvres or window.binned.window.manoeuvres]
    best: Located | None = None
    for divided, observed in window.ways:
        located = Located(window.binned, axes, plan, divided, observed, match(plan, observed))
        lost = [m for m in plan if located.matched.get(m.name, 0) is None]
        if best is None or len(lost) < list(best.matched.values()).count(None):
            best = located
        if not any(m.do == "turn" for m in lost):
            break
    assert best is not None  # there is at least one way
    return best


def _about(observation: Observation, m: Manoeuvre) -> float:
    return float(
        np.nan_to_num(observation.rate if m.recorded == "steady" else observation.turned) @ m.axis
    )
