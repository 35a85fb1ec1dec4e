"""An accelerometer that remembers on which side it was."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Reading, Truth, by_grade, parameters_by_axis
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY

WIDTHS = (np.arange(20) + 0.5) / 20 * STANDARD_GRAVITY  # m/s², at which contacts give way


def hysteresis(force: Array, order: Array, peaks: Array) -> Array:
    """Rayleigh's hysteresis of the force along each axis, by `order`, (n, 3).

    1 and −1 are its values at zero force after g and −g. Contacts without an elastic threshold give
    way at forces up to g, evenly many at each; at first none is loaded. Between two manoeuvres the
    table may pass through any attitude: `peaks`, (n, 3), m/s², see `Motion`.
    """
    sequence = np.argsort(order, kind="stable")
    force, peaks = force[sequence], peaks[sequence]
    starts = np.diff(np.floor(order[sequence]), prepend=-1.0) != 0
    changes = starts | np.append(True, np.any(np.diff(force, axis=0) != 0, axis=1))
    loaded = np.zeros((3, len(WIDTHS)))
    means = []
    for row in np.flatnonzero(changes):
        if starts[row]:
            known = np.isfinite(peaks[row])
            loaded[known] = _followed(loaded, peaks[row])[known]
        loaded = _followed(loaded, force[row])
        means.append(loaded.mean(axis=1))
    result = np.zeros_like(force)
    result[sequence] = np.array(means)[np.cumsum(changes) - 1] - force / 2
    return 4 / STANDARD_GRAVITY * result


def _followed(loaded: Array, force: Array) -> Array:
    """The loads of the contacts of three axes after a force, (3, k)."""
    return np.clip(loaded, force[:, None] - WIDTHS, force[:, None] + WIDTHS)


class AccelHysteresis(Effect):
    """f̃_i += h_i r_i, r_i Rayleigh's hysteresis of the force along axis i, 1 at the most.

    After forces of ±g its loop is r = ±(1 − (f/g)²), widest where the axis is level and closed at
    ±g; loops of smaller forces are narrower. Shown by an axis that comes to level from above and
    from below, in the order of the plan and by what the log has of the moves between. A level axis
    is also what the error of a set position moves, so the loop must exceed that.
    """

    name = "accel_hysteresis"
    cause = _("the suspension does not return quite to where it was before the load")
    source = "IEEE Std 528-2019, 'hysteresis error'; Lord Rayleigh, Phil. Mag. 23, 1887, 225"
    parameters = parameters_by_axis(
        "h",
        "m/s²",
        1e-5 * STANDARD_GRAVITY,
        _("half the width of the loop of the {axis} accelerometer"),
    )
    stays = _("it depends on the forces before the reading, which the reading does not tell")
    sizes = by_grade(1e-6 * STANDARD_GRAVITY, 5, 20, 50, 500)

    def added(self, truth: Truth, motion: Motion) -> Reading:
        accel = hysteresis(truth.force, motion.visit, motion.peaks)[:, :, None] * np.eye(3)
        return Reading(np.zeros_like(accel), accel)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        return reading.plus("accel", self.added(truth, motion).accel @ values)
