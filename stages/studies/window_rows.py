"""Bias and scale factor of each gyro by windows of a pair of turns: rows of the study."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import pi

import numpy as np

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.rate_segments import angles_about
from inertial.campaign.records import Row
from inertial.estimation.angle_windows import (
    Window,
    at_set_rate,
    by_angles,
    edges_of,
    noise_of,
    scale_and_bias,
)
from inertial.estimation.consistency import weighted_mean
from inertial.estimation.gyroscopes import bias_and_scale
from inertial.estimation.time_angle import Valued, plateau
from inertial.tables import AXES, GYRO
from stages.studies.table_motion import Gyros, WholeMotion

WINDOW_ANGLE = pi  # rad, of a window, as S0 has it
CLOSE_STARTS_S = 1.0  # within which every start of a window has a row
MAX_STARTS = 200  # of windows over the whole steady part
MAX_ENDS = 200  # of windows that grow
MIN_WINDOW_ANGLE = pi / 36  # rad, of a window that grows


@dataclass(frozen=True)
class Pair:
    """Two turns about body axis `axis`, forward and backward, and what else their windows suffer.

    `densities`: rad/√s, white noise of the gyro in each; `earth`: rad/s, upward along the gyro;
    `level`: rad/s, rms of the level earth rate that it feels through its cross terms;
    `rate_sigma`: relative, of the set rate; `others`: by what the table is faster than set, as
    turns about other axes have it, None where there are none.
    """

    axis: int
    forward: WholeMotion
    backward: WholeMotion
    densities: tuple[float, float]
    earth: float
    level: float
    rate_sigma: float
    others: Valued | None
    mount: str = ""

    @property
    def step(self) -> float:
        """Sample interval, s."""
        return self.forward.step

    @property
    def rate(self) -> float:
        """Size of the set rate, rad/s."""
        return abs(self.forward.plan.rate or 0.0)

    @property
    def samples(self) -> int:
        """How many of the steady part both turns have."""
        return min(motion.after - motion.first for motion in (self.forward, self.backward))

    @property
    def half(self) -> int:
        """Samples of a window of 180° at the set rate."""
        return round(WINDOW_ANGLE / (self.rate * self.step))

    def summed(self) -> tuple[Array, Array]:
        """What the gyro summed in the steady part of each turn, at the edges."""
        first, second = (
            edges_of(motion.increments[motion.first : motion.after, self.axis])
            for motion in (self.forward, self.backward)
        )
        return first, second

    def turned(self) -> tuple[Array, Array]:
        """The angle of the table about the body axis, by time and angle, at the same edges."""
        first, second = (
            motion.signed[motion.first : motion.after + 1] * float(motion.plan.axis[self.axis])
            for motion in (self.forward, self.backward)
        )
        return first, second

    def read(self) -> tuple[Array, Array] | None:
        """The same by the encoder, where it is recorded in both turns."""
        encoders = [motion.encoder for motion in (self.forward, self.backward)]
        if encoders[0] is None or encoders[1] is None:
            return None
        first, second = (
            encoder[motion.first : motion.after + 1] * float(motion.plan.axis[self.axis])
            for motion, encoder in zip((self.forward, self.backward), encoders, strict=True)
            if encoder is not None
        )
        return first, second

    def rows(
        self, window: Window, by: str, table_sigma: Array | float, *, any_phase: bool = False
    ) -> Iterator[Row]:
        """Windows whose angles are known but for `table_sigma`, of the table's speed, relative.

        With `any_phase` an oscillation counts as cut at any phase, however long they are.
        """
        scale, bias = scale_and_bias(window, *self.summed(), self.earth)
        seconds = None if any_phase else window.seconds
        ripple = [motion.ripple(self.axis, seconds) for motion in (self.forward, self.backward)]
        # While the table turns on, the level earth rate sums to 2 sin(α/2)/ω.
        level = self.level * 2 * np.abs(np.sin(window.forward / 2)) / self.rate
        each = np.sqrt((ripple[0] ** 2 + ripple[1] ** 2) / 2 + level**2)
        of_table = np.broadcast_to(table_sigma, (len(scale),))
        cut, bias_sigma = noise_of(window, self.densities, each)
        for k in range(len(scale)):
            yield self._row(
                by,
                from_s=float(window.first[k]) * self.step,
                samples=int(window.after[k] - window.first[k]),
                angle=float(window.forward[k] - window.backward[k]) / 2,
                scale=float(scale[k]),
                scale_sigma=float(np.hypot(cut[k], of_table[k])),
                cut_sigma=float(cut[k]),
                bias=float(bias[k]),
                bias_sigma=float(bias_sigma[k]),
            )

    def by_own_angle(self, window: Window, whole: Row) -> Iterator[Row]:
        """The same windows by the table's own angle: the whole turn again, with its sigma."""
        own = by_angles(window, *self.turned())
        for row in self.rows(own, "own angle", 0.0):
            sigmas = {name: whole[name] for name in ("scale_sigma", "cut_sigma", "bias_sigma")}
            yield row | sigmas

    def by_encoder(self, window: Window, *, any_phase: bool = False) -> Iterator[Row]:
        """The same windows by the encoder, whose angles are as good over a part as over all."""
        if (read := self.read()) is None:
            return
        own = by_angles(window, *read)
        sigma = self.forward.plan.angle_sigma or 0.0
        table_sigma = 2 * sigma / np.abs(own.forward - own.backward)
        yield from self.rows(own, "encoder", table_sigma, any_phase=any_phase)

    def whole(self, data: CampaignData) -> Row:
        """The whole turn, by S0's formula."""
        names = (self.forward.plan.name, self.backward.plan.name)
        own = [turn for name, turn in angles_about(data, self.axis) if name in names]
        found = bias_and_scale(own, data.earth)
        return self._row(
            "whole turn",
            from_s=-self.forward.first * self.step,
            samples=len(self.forward.increments),
            angle=abs(self.forward.plan.angle or 0.0),
            scale=float(found.values[1]),
            scale_sigma=float(found.sigma[1]),
            cut_sigma=0.0,
            bias=float(found.values[0]),
            bias_sigma=float(found.sigma[0]),
        )

    def _row(self, by: str, **values: float) -> Row:
        names = {"forward": self.forward.plan.name, "backward": self.backward.plan.name}
        return {"mount": self.mount, "axis": AXES[self.axis], **names, "by": by, **values}


def sliding(pair: Pair, whole: Row) -> list[Row]:
    """Windows of 180° from every start within a second, and from starts all over the steady part.

    None where the steady part is too short for one.
    """
    last = pair.samples - pair.half
    if last < 0:
        return []
    close = np.arange(min(round(CLOSE_STARTS_S / pair.step), last) + 1)
    starts = np.unique(
        np.append(close, np.linspace(0, last, min(MAX_STARTS, last + 1)).astype(int))
    )
    window = at_set_rate(starts, pair.half, pair.step, pair.rate)
    own = pair.by_own_angle(window, whole)
    return [*pair.rows(window, "set rate", pair.rate_sigma), *own, *pair.by_encoder(window)]


def growing(pair: Pair, whole: Row) -> list[Row]:
    """Windows from the start of the steady part to an angle that grows."""
    shortest = max(round(MIN_WINDOW_ANGLE / (pair.rate * pair.step)), 1)
    if pair.samples < shortest:
        return []
    samples = np.unique(np.linspace(shortest, pair.samples, MAX_ENDS).astype(int))
    window = at_set_rate(np.zeros_like(samples), samples, pair.step, pair.rate)
    own = pair.by_own_angle(window, whole)
    return [
        *pair.rows(window, "set rate", pair.rate_sigma, any_phase=True),
        *own,
        *pair.by_encoder(window, any_phase=True),
    ]


def middle(pair: Pair, whole: Row) -> list[Row]:
    """The whole turn, and the middle 180° by the set rate, its own angle, and other turns."""
    start = (pair.samples - pair.half) // 2
    if start < 0:
        return [whole]
    window = at_set_rate(np.array([start]), pair.half, pair.step, pair.rate)
    rows = [whole, *pair.rows(window, "set rate", pair.rate_sigma)]
    rows += [*pair.by_own_angle(window, whole), *pair.by_encoder(window)]
    if pair.others is not None:
        real = at_set_rate(
            np.array([start]), pair.half, pair.step, pair.rate * (1 + pair.others.value)
        )
        rows += pair.rows(real, "other turns", pair.others.sigma)
    return rows


def excess(motion: WholeMotion) -> Valued | None:
    """By what the table was faster in the steady part than set, relative."""
    if motion.plan.rate is None or motion.after - motion.first < 2:
        return None
    speed = plateau(motion.table, motion.first, motion.after)
    rate = abs(motion.plan.rate)
    return Valued(speed.value / rate - 1, speed.sigma / rate)


def together(values: Iterable[Valued]) -> Valued | None:
    """Weighted mean; its sigma is that of the values, or of their scatter where that is larger."""
    found = list(values)
    if not found:
        return None
    numbers, sigmas = np.array([[first.value, first.sigma] for first in found]).T
    mean, sigma, chi_squared = weighted_mean(numbers, sigmas)
    beyond = max(chi_squared / max(len(found) - 1, 1), 1.0)
    return Valued(mean, sigma * float(np.sqrt(beyond)))


def pair_of(
    data: CampaignData,
    found: tuple[int, WholeMotion, WholeMotion],
    motions: Sequence[WholeMotion],
    gyros: Gyros,
) -> Pair:
    """A pair with what its windows suffer; `motions`: all turns of the mount."""
    i, forward, backward = found
    up = forward.plan.up
    assert up is not None  # else the turn is refused
    densities = [data.noise.of(m.plan.name, "steady", GYRO)[i] for m in (forward, backward)]
    others = [
        first
        for motion in motions
        if abs(float(motion.plan.axis[i])) < 0.5 and _same_rate(motion, forward)
        for first in [excess(motion)]
        if first is not None
    ]
    return Pair(
        i,
        forward,
        backward,
        (float(densities[0]), float(densities[1])),
        data.earth.up * float(up[i]),
        gyros.cross(i) * data.earth.level / np.sqrt(2),
        data.rate_sigma,
        together(others),
        data.mount,
    )


def _same_rate(first: WholeMotion, second: WholeMotion) -> bool:
    return bool(np.isclose(abs(first.plan.rate or 0.0), abs(second.plan.rate or 0.0), rtol=1e-6))
