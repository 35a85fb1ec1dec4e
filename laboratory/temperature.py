"""Temperature of the IMU in the course of a campaign, in a chamber or without one."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import isclose
from typing import Any, Final, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.instants import Instants
from laboratory.units import HOUR, ICE_POINT, MINUTE

NODES: Final = ("accelerometer", "gyro", "thermometer")


@dataclass(frozen=True)
class Node:
    """A part of the IMU: its temperature follows that of the IMU and lies above it.

    lag: s, its first-order time constant, 0 where it follows at once; above: K, from its own heat.
    """

    lag: float = 0.0
    above: float = 0.0


@dataclass(frozen=True)
class Chamber:
    """The air of a chamber, from hold to ramp to hold; before and after it is constant.

    moments: (k,), s since the campaign's first sample, where its rate changes; changes: (k,), by
    how much, K/s; time_constant: s, of the IMU as a whole behind the air, of first order.
    """

    moments: Array
    changes: Array
    time_constant: float

    @classmethod
    def specified(cls, steps: Sequence[Mapping[str, Any]], start: float, constant: float) -> Self:
        """From the steps of simulated.schema.yaml; start: K, of the air at time 0."""
        moments, rates, air = [0.0], [0.0], start
        for step in steps:
            seconds, to = step.get("hold_s", 0.0), step.get("to_deg_c", air - ICE_POINT) + ICE_POINT
            rate = np.sign(to - air) * step.get("rate_k_min", 0.0) / MINUTE
            seconds += (to - air) / rate if rate else 0.0
            moments.append(moments[-1] + seconds)
            rates.append(rate)
            air = to
        changes = [after - before for before, after in pairwise([*rates, 0.0])]
        return cls(np.array(moments), np.array(changes), constant)

    def warming(self, time: Array, lag: float) -> Array:
        """What the air adds to a node of the IMU at times (m,), K, above the start."""
        warming = np.zeros_like(time)
        for moment, change in zip(self.moments, self.changes, strict=True):
            if change:
                since = np.clip(time - moment, 0.0, None)
                warming += change * after_ramp(since, self.time_constant, lag)
        return warming


@dataclass(frozen=True)
class Temperature:
    """T(t) = start + slope t + rise (1 − exp(−t / time constant)) + step + what a chamber adds.

    This is the IMU as a whole; `nodes` follow it, the thermometer that is recorded among them, so
    that a sensor and the recorded temperature differ in every ramp.
    t: s since the campaign's first sample, through all logs and the pauses between.
    """

    start: float  # K
    slope: float  # K/s
    rise: float  # K, of the warm-up
    time_constant: float  # s
    step: float  # K
    moment: float  # s
    reference: float  # K: at which `truth` specifies M and bias
    nodes: Mapping[str, Node]
    chamber: Chamber | None = None

    @classmethod
    def specified(cls, written: Mapping[str, Any]) -> Self:
        """The course that simulated.schema.yaml describes."""
        start = written["start_deg_c"] + ICE_POINT
        reference = written.get("reference_deg_c", written["start_deg_c"]) + ICE_POINT
        warm_up = written.get("warm_up", {"rise_k": 0.0, "time_constant_s": 1.0})
        step = written.get("step", {"size_k": 0.0, "at_s": 0.0})
        nodes = {name: written.get(name, {}) for name in NODES}
        chamber = written.get("chamber")
        return cls(
            start,
            written.get("slope_k_h", 0.0) / HOUR,
            warm_up["rise_k"],
            warm_up["time_constant_s"],
            step["size_k"],
            step["at_s"],
            reference,
            {n: Node(one.get("lag_s", 0.0), one.get("above_k", 0.0)) for n, one in nodes.items()},
            chamber and Chamber.specified(chamber["steps"], start, chamber["time_constant_s"]),
        )

    def course(self, node: str, instants: Instants) -> Array:
        """Temperature of a node at the instants, (m,), K."""
        course = self.at(node, instants.time)
        if self.step and not self.nodes[node].lag:
            course += self.step * instants.since(self.moment)
        return course

    def at(self, node: str, time: Array) -> Array:
        """The same at times (m,), s; without the step where the node follows it at once."""
        lag, above = self.nodes[node].lag, self.nodes[node].above
        course: Array = self.start + self.slope * after_ramp(time, 0.0, lag)
        course = course + self.rise * after_step(time, self.time_constant, lag) + above
        if lag and self.step:
            course += self.step * after_step(time - self.moment, 0.0, lag)
        return course if self.chamber is None else course + self.chamber.warming(time, lag)


def after_ramp(time: Array, one: float, other: float) -> Array:
    """Two first-order lags in series, t s after their input began to rise by 1 K/s, (m,), K.

    one, other: time constants a ≥ b in any order, s, each 0 where there is no lag.
    t − a − b + (a² e^(−t/a) − b² e^(−t/b)) / (a − b), zero before; a ramp without lag has no start.
    """
    a, b = max(one, other), min(one, other)
    if a == 0:
        return time
    since = np.clip(time, 0.0, None)
    if isclose(a, b, rel_tol=1e-9):
        return since - 2 * a + (2 * a + since) * decay(since, a)
    return since - a - b + (a * a * decay(since, a) - b * b * decay(since, b)) / (a - b)


def after_step(time: Array, one: float, other: float) -> Array:
    """The same after a step by 1 K: the derivative of `after_ramp`, (m,), K; a > 0."""
    a, b = max(one, other), min(one, other)
    since = np.clip(time, 0.0, None)
    if isclose(a, b, rel_tol=1e-9):
        return 1 - (1 + since / a) * decay(since, a)
    return 1 - (a * decay(since, a) - b * decay(since, b)) / (a - b)


def decay(since: Array, constant: float) -> Array:
    """e^(−t/τ), (m,); 0 without a time constant."""
    return np.exp(-since / constant) if constant else np.zeros_like(since)
