"""An IMU that shifts in its fixture once."""

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import replace
from typing import Self

import numpy as np

from inertial.arrays import Array
from inertial.physics.drift import after, evenly, without_clock
from inertial.physics.effect import (
    Effect,
    Scan,
    Truth,
    known_earth,
    of_tables,
    parameters_by_axis,
)
from inertial.physics.motion import Motion, cross
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND

BETWEEN_LOGS = Scan(
    "manoeuvre", "1", _("place in the plan of the first manoeuvre after the shift"), between=False
)
CANDIDATES = 108  # times of the shift: one between two of them loses 3 to 5 % of its SNR²


class MountingShift(Effect):
    """f += f × θ H(t − t₀), ω += ω × θ H(t − t₀): the case has turned by θ; t₀ is scanned.

    From then on every axis of the case points elsewhere than the plan says, for both sensors alike.
    A jump of a bias is the same in all attitudes; this one turns what is sensed, so it goes with
    the attitude and with the rate. A single position that is off is followed by right ones;
    after a shift all that follow are off. Of logs that share no clock it is sought between one and
    the next, in the order of the plan.
    """

    name = "mounting_shift"
    cause = _(
        "a screw or an adhesive gives way, or the IMU is knocked: its orientation in the fixture "
        "differs from then on"
    )
    source = "IEEE Std 1554-2005, stability of the mounting fixture"
    parameters = parameters_by_axis(
        "theta", "rad", 2 * ARC_SECOND, _("rotation of the case about its {axis} axis")
    )
    sizes = of_tables(ARC_SECOND, 10, 60)
    vector = True
    thinkable = 1000.0  # degrees, where a screw comes loose
    scan = Scan("t0", "s", _("time of the shift since the first sample of all logs"))

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        at = self.value(motion)
        shifted = motion.visit >= at if without_clock(motion) else after(motion, at)
        turned = np.outer(shifted, values)
        upward, level = known_earth(truth, motion)
        return replace(
            truth,
            rate=truth.rate + cross(motion.omega + upward + level, turned),
            force=truth.force + cross(truth.force, turned),
        )

    def blind(self, motion: Motion) -> str:
        return "" if len(np.unique(motion.run)) > 1 else without_clock(motion)

    def grid(self, motion: Motion) -> Array:
        if not without_clock(motion):
            return evenly(motion, CANDIDATES)
        runs = np.unique(motion.run)
        return np.unique([np.floor(motion.visit[motion.run == run].min()) for run in runs])[1:]

    def candidates(self, motion: Motion) -> Sequence[Self]:
        every = super().candidates(motion)
        return [one.between_logs() for one in every] if without_clock(motion) else every

    def as_named(self, values: Mapping[str, float]) -> Effect:
        at = values.get(BETWEEN_LOGS.name)
        return super().as_named(values) if at is None else self.fixed(at).between_logs()

    def between_logs(self) -> Self:
        """The effect with the place in the plan as what is scanned."""
        effect = copy(self)
        effect.scan = BETWEEN_LOGS  # type: ignore[misc]
        return effect
