"""Rests that the plan has in one position, and that are not."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from scipy.special import fdtrc

from inertial.arrays import Array
from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.units import ARC_SECOND

MIN_PAIRS = 3  # one alone may be a shift of the IMU in its fixture
MIN_SHARE = 2 / 3  # of the pairs, which turn gravity
MIN_RATIO = 5.0  # of what changes across gravity, over what changes along it in any pair
MAX_CHANCE = 1e-5  # of noise that is the same along gravity and across it
MAX_OF_ROUND = 0.01  # by which a whole number of rounds between two rests may be off
MIN_VERTICAL = 0.9  # share of the vertical in an axis that points up


class PositionNotKept(PlanDetector):
    """From one rest to the next of the same position the direction of gravity is another.

    Its magnitude is not: a tilt changes the specific force across gravity, and the biases of
    accelerometers along it as well, once each axis has been vertical.

    Cause: the IMU was taken out and set anew, or its fixture or the table gives way in each turn.
    The model has one tilt for all rests of a position.
    """

    name = "position_not_kept"
    source = "IEEE Std 1293-2018: a position is set once, and held for all readings in it"
    unit = "rad"
    severity = 3

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        pairs = list(_pairs(recorded))
        vertical = {int(np.argmax(np.abs(recorded.up[i]))) for i, _after in pairs}
        if len(pairs) < MIN_PAIRS or len(vertical) < 3:
            return
        along, across = np.array([_change(recorded, *pair) for pair in pairs]).T
        turned = across > MIN_RATIO * np.abs(along).max()
        noise = 2 * float(np.sum(along**2))
        ratio = float(np.sum(across**2)) / noise if noise > 0 else 0.0
        chance = float(fdtrc(2 * len(pairs), len(pairs), ratio))
        if turned.mean() >= MIN_SHARE and chance < MAX_CHANCE:
            angle = float(np.sqrt(np.mean(across[turned] ** 2) / 2)) / recorded.given.gravity
            yield Deviation(None, "", angle, count=int(turned.sum()), facts=len(pairs))

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        assert deviation.size is not None
        return Description(
            _(
                "In {count} of {pairs} pairs of rests that the plan has in one position gravity "
                "has turned in the case from one to the other, by {angle} arcsec about each axis "
                "(rms), and is as large as before: the position was not kept.",
                count=deviation.count,
                pairs=deviation.facts,
                angle=significant(deviation.size / ARC_SECOND, 2),
            ),
            _(
                "One tilt is estimated for all rests of a position, so what these differ by goes "
                "into biases and cross terms, and their sigmas do not include it."
            ),
            _(
                "If the IMU was set anew, leave position out of these manoeuvres, so that each has "
                "a tilt of its own; else look for what gives way in the fixture or in the table."
            ),
        )


def _pairs(recorded: Recorded) -> Iterator[tuple[int, int]]:
    """Manoeuvres one after the other in one position, after whole rounds between their rests."""
    read = np.isfinite(recorded.force).all(axis=1) & recorded.found
    upright = np.abs(recorded.up).max(axis=1) > MIN_VERTICAL
    for i, after in pairwise(range(len(recorded.name))):
        rounds = 0.0 if np.isnan(recorded.angle[i]) else recorded.angle[i] / (2 * np.pi)
        same = recorded.position[i] == recorded.position[after]
        if same and is_closed(rounds) and read[[i, after]].all() and upright[i]:
            yield i, after


def is_closed(rounds: float) -> bool:
    """Whether a turn by so many rounds ends where it began."""
    return abs(rounds - round(rounds)) < MAX_OF_ROUND


def _change(recorded: Recorded, i: int, after: int) -> Array:
    """By what the specific force changes along gravity, and across it, m/s²."""
    change, up = recorded.force[after] - recorded.force[i], recorded.up[i]
    along = float(change @ up)
    return np.array([along, np.linalg.norm(change - along * up)])
