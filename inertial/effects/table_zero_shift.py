"""A middle axis of the table that counts from another zero from a time on."""

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.effects.mounting_shift import SHIFT_TIMES
from inertial.effects.table_axis_non_orthogonality import HOME, MIN_MIDDLE_SINE
from inertial.effects.table_inner_axis import (
    MIN_AVERAGING_FACTOR,
    MIN_INNER_COSINE,
    is_inner,
    off_its_axes,
)
from inertial.physics.drift import SettingIn, without_clock
from inertial.physics.effect import Parameter, Scan, Truth, of_tables
from inertial.physics.motion import Motion, cross, turned_all, without_north
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND


class TableZeroShift(SettingIn):
    """f −= λ × f, ω −= λ × (ω − Ω_i),   λ = ζ m H(t − t₀); t₀ is scanned.

    From then on the level middle axis m of the table has turned all that it carries ζ further than
    it counts. The case sits on the inner axis i, its z axis, which goes along: a turn Ω_i about it
    is one about i still, and leaves m where it is in the laboratory. The outer axis is vertical as
    before: turned about it, m goes round with the case, which is on a cone.

    So it is a `mounting_shift` where the inner axis is never turned, a `table_tilt_jump` where the
    outer one is not, and neither where m has several directions in the case and the laboratory. On
    a side m is u × z, with u up. Where z is up or down outer and inner axis are parallel, and a
    campaign does not say which of them turned the case: λ has two components of its own there, of
    the size of ζ. Where the inner one did they are fixed to the laboratory; where the outer one did
    they are fixed to the case, see `table_zero_shift_outer`.
    """

    name = "table_zero_shift"
    cause = _(
        "the encoder or a coupling of the middle axis of the table slips, or its zero is set "
        "anew: from then on it is off by the same angle in all positions"
    )
    source = "IEEE Std 1554-2005, position accuracy of tables"
    parameters: tuple[Parameter, ...] = (
        *(
            Parameter(
                f"upright_{to}",
                "rad",
                2 * ARC_SECOND,
                _("lean towards {to} where the inner axis is vertical", to=to),
            )
            for to in ("north", "east")
        ),
        Parameter(
            "zeta", "rad", 2 * ARC_SECOND, _("angle by which the middle axis has turned further")
        ),
    )
    sizes = of_tables(ARC_SECOND, 10, 60)
    vector = True
    thinkable = 30.0  # half a degree
    times = SHIFT_TIMES
    scan = Scan("t0", "s", _("time of the shift since the first sample of all logs"))

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        up, north = _start(motion)
        across = cross(up, HOME)
        sine = np.linalg.norm(across, axis=1)
        upright = sine < MIN_MIDDLE_SINE
        inner = is_inner(motion) & self._is_turned(upright)
        middle = values[-1] * across / np.maximum(sine, MIN_MIDDLE_SINE)[:, None]
        at_start = np.where(upright[:, None], self._upright(up, north, values[:-1]), middle)
        turned = turned_all(at_start, motion.about, np.where(inner, motion.angle, 0.0))
        of_tumble = np.where(self._is_turned(upright), _about_home(motion.tumbled), 0.0)
        lean = self.since(motion)[:, None] * turned_all(turned, HOME, of_tumble)
        return off_its_axes(truth, motion, lean, inner)

    def grid(self, motion: Motion) -> Array:
        every = super().grid(motion)
        return every if without_clock(motion) else np.union1d(every, _settings(motion))

    def blind(self, motion: Motion) -> str:
        return super().blind(motion) or without_north(motion)

    def _is_turned(self, upright: Booleans) -> Booleans:
        """Where the inner axis turns the case if it is one parallel to it, (n,)."""
        return np.ones_like(upright)

    def _upright(self, up: Array, north: Array, values: Array) -> Array:
        """The turn of the case where the inner axis is vertical, body axes, (n, 3), rad."""
        return cross(up, values[0] * north + values[1] * cross(north, up))


def _settings(motion: Motion) -> Array:
    """The times at which the table goes to another position, s; there an axis is likely to slip."""
    order = np.argsort(motion.time, kind="stable")
    half, position = motion.seconds[order] / 2, motion.position[order]
    changes = np.flatnonzero(np.diff(position))
    time = motion.time[order]
    return np.asarray(((time + half)[changes] + (time - half)[changes + 1]) / 2)


def _about_home(tumbled: Array) -> Array:
    """The angle of a tumble about the inner axis, (n,), rad; 0 of one about another axis."""
    along = tumbled @ HOME
    own = np.abs(along) > MIN_INNER_COSINE * np.linalg.norm(tumbled, axis=1)
    return np.where(own, along, 0.0)


def _start(motion: Motion) -> tuple[Array, Array]:
    """Up and north in body axes, (n, 3) each, when the turn or the tumble began."""
    angle = np.linalg.norm(motion.tumbled, axis=1)
    axis = motion.tumbled / np.where(angle > 0, angle, 1.0)[:, None]
    factor = np.maximum(motion.averaging_factor, MIN_AVERAGING_FACTOR)[:, None]
    about = np.broadcast_to(motion.about, motion.up.shape)

    def before(direction: Array) -> Array:
        along = about * np.sum(about * direction, axis=1, keepdims=True)
        return turned_all(along + (direction - along) / factor, axis, -angle)

    return before(motion.up_at_start), before(np.nan_to_num(motion.north_at_start))
