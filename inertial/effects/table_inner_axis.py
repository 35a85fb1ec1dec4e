"""An inner axis of the table that is not at a right angle to the axis that carries it."""

from dataclasses import replace

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.effects.table_axis_non_orthogonality import HOME, middle_axis
from inertial.physics.effect import Effect, Parameter, Truth, of_tables
from inertial.physics.motion import Motion, cross, turned_all, without_north
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND

MIN_AVERAGING_FACTOR = 0.1  # in a mean of what goes round; of less nothing is concluded
MIN_INNER_COSINE = np.cos(np.radians(1))  # of the angle from the axis of a turn to the inner one


class TableInnerAxis(Effect):
    """f −= λ × f, ω −= λ × (ω − Ω_i),   λ = δ i × m.

    The case sits on the inner axis i, which home, its z axis, is. It leans by δ towards the level
    middle axis m that carries it, so the case is off wherever it stands, but a turn Ω_i about
    the inner axis is one about i still. Such a turn leaves m where it is in the laboratory, any
    other leaves it where it is in the case.
    """

    name = "table_inner_axis"
    cause = _("the inner axis of the table is not at a right angle to its middle one")
    source = "IEEE Std 1554-2005, orthogonality of table axes"
    parameters = (
        Parameter(
            "lean", "rad", 1e-5, _("δ, by which the inner axis leans towards the middle one")
        ),
    )
    sizes = of_tables(ARC_SECOND, 2, 30)

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        inner = is_inner(motion)
        at_start = middle_axis(motion)
        middle = turned_all(at_start, motion.about, np.where(inner, motion.angle, 0.0))
        return off_its_axes(truth, motion, values[0] * cross(HOME, middle), inner)

    def blind(self, motion: Motion) -> str:
        return without_north(motion)


def is_inner(motion: Motion) -> Booleans:
    """Which stretches turn about the inner axis, (n,)."""
    own = np.abs(motion.about @ HOME) > MIN_INNER_COSINE
    return np.asarray(own & np.ones(len(motion.up), bool))


def off_its_axes(truth: Truth, motion: Motion, lean: Array, inner: Booleans) -> Truth:
    """What a case feels that is off by λ, (n, 3), rad, in all turns but those about the inner axis.

    f −= λ × f, ω −= λ × (ω − Ω_i), Ω_i the rate of turns about the inner axis, (n,) of `inner`. In
    these λ goes round as f does, and of means f is one.
    """
    carried = truth.rate - np.where(inner[:, None], motion.omega, 0.0)
    force = cross(lean, truth.force)
    along = motion.about * np.sum(motion.about * force, axis=1, keepdims=True)
    factor = np.maximum(motion.averaging_factor, MIN_AVERAGING_FACTOR)[:, None]
    of_means = np.where(inner[:, None], along / factor + factor * (force - along), force)
    return replace(truth, rate=truth.rate - cross(lean, carried), force=truth.force - of_means)
