"""The encoder of the table's angle, read at the end of every sample."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from math import pi
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.instants import NODES_PER_INTERVAL, Instants
from laboratory.layout import Segment
from laboratory.profiles import Standing
from laboratory.units import ARCSECOND, MILLISECOND, PPM


@dataclass(frozen=True)
class Encoder:
    """It reads (1 + e) θ(t − τ) in whole counts, θ the angle on the scale.

    The scale is that of the table: where it is off its axis (table_eccentricity), the angle on the
    scale is not the true one. Ripple of the drive is a motion, and is read.
    """

    scale: float  # e
    latency: float  # τ, s
    count: float  # rad

    @classmethod
    def specified(cls, written: Mapping[str, Any] | None) -> Self | None:
        """The encoder that simulated.schema.yaml describes; None where none is recorded."""
        if written is None:
            return None
        return cls(
            written.get("scale_ppm", 0.0) * PPM,
            written.get("latency_ms", 0.0) * MILLISECOND,
            written["count_arcsec"] * ARCSECOND,
        )

    def course(self, segment: Segment, instants: Instants, effects: Iterable[Effect]) -> Array:
        """The angle on the scale since the start of a segment, (n,), rad, at the ends of samples.

        A change of position is about another axis, and moves nothing here.
        """
        if isinstance(segment.profile, Standing) or segment.manoeuvre is None:
            return np.zeros(instants.samples)
        late = replace(instants, late=self.latency)
        turning = segment.turning(late)
        for effect in effects:
            if not effect.of_scale:
                [turning, *_] = effect.change_rotations([turning], late)
        return turning.angle[NODES_PER_INTERVAL::NODES_PER_INTERVAL]

    def readings(self, angles: Array) -> Array:
        """What is recorded, (n,), rad, from 0 to 2π, by the angles on the scale."""
        counts = np.round((1 + self.scale) * angles / self.count)
        return np.asarray(np.mod(counts * self.count, 2 * pi))
