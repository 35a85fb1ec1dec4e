"""Three accelerometers that do not stand at one point."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Reading, Truth, by_grade
from inertial.physics.motion import Motion, cross
from inertial.text.messages import _


class SizeEffect(Effect):
    """f̃_i += (α × r_i + ω × (ω × r_i))_i, with r_i from the table's axis to accelerometer i.

    What the three have in common is the lever arm of the case. Told by turns about all axes; of
    r_i the part along i by the pull, the others by starting and stopping.
    """

    name = "size_effect"
    cause = _("each accelerometer stands at a place of its own and feels the rotation there")
    source = "Savage 2000, Strapdown Analytics, size effect of the accelerometers"
    parameters = tuple(
        Parameter(
            f"r_{i}{j}",
            "m",
            0.01,
            _("distance from the table's axis to accelerometer {i}, along {j}", i=i, j=j),
        )
        for i in "xyz"
        for j in "xyz"
    )
    stays = _("it depends on where the axis of the table was, as the lever arm does")
    sizes = by_grade(1e-3, 20, 5, 5, 1)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        felt = []
        for i, arm in enumerate(values.reshape(3, 3)):
            felt.append((cross(motion.alpha, arm) + motion.pull(arm))[:, i])
        return reading.plus("accel", np.column_stack(felt))
