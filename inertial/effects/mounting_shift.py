"""An IMU that shifts in its fixture once."""

from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.physics.drift import SettingIn
from inertial.physics.effect import (
    Scan,
    Truth,
    known_earth,
    of_tables,
    parameters_by_axis,
)
from inertial.physics.motion import Motion, cross
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND

SHIFT_TIMES = 108  # that are tried: one between two of them loses 3 to 5 % of its SNR²


class MountingShift(SettingIn):
    """f += f × θ H(t − t₀), ω += ω × θ H(t − t₀): the case has turned by θ; t₀ is scanned.

    From then on every axis of the case points elsewhere than the plan says, for both sensors alike.
    A jump of a bias is the same in all attitudes; this one turns what is sensed, so it goes with
    the attitude and with the rate. A single position that is off is followed by right ones;
    after a shift all that follow are off. Another zero of the axis that carries the fixture is the
    same rotation, and no reading tells which it is.
    """

    name = "mounting_shift"
    cause = _(
        "a screw or an adhesive gives way, the IMU is knocked, or the innermost axis of the table "
        "counts from another zero: its orientation differs from then on"
    )
    source = "IEEE Std 1554-2005, stability of the mounting fixture"
    parameters = parameters_by_axis(
        "theta", "rad", 2 * ARC_SECOND, _("rotation of the case about its {axis} axis")
    )
    sizes = of_tables(ARC_SECOND, 10, 60)
    vector = True
    thinkable = 1000.0  # degrees, where a screw comes loose
    times = SHIFT_TIMES
    scan = Scan("t0", "s", _("time of the shift since the first sample of all logs"))

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        turned = np.outer(self.since(motion), values)
        upward, level = known_earth(truth, motion)
        return replace(
            truth,
            rate=truth.rate + cross(motion.omega + upward + level, turned),
            force=truth.force + cross(truth.force, turned),
        )
