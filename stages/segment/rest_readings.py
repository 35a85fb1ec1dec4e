"""What the rests of a recording show: gravity, the signs of the gyros, and their level."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.signal.rests_and_motions import rest_level
from stages.segment.located import Axes, Located
from stages.segment.matching import Observation
from stages.segment.windows import Binned

MIN_UPRIGHT_SHARE = 0.9  # share of the vertical in an axis that points up
MIN_EARTH_SIGMA = 4.0  # sigmas to which the earth's rate must be seen to half of itself


def earth_seen(located: Sequence[Located], axes: Axes, earth_rate: float) -> list[int]:
    """The signs of the gyros by the earth rate: +1 right, −1 wrong, 0 nothing, (3,).

    A gyro reads the upward part of the earth's rate with one sign while its axis points up, with
    the other while it points down, whatever its bias. Gyros that are too noisy give 0.
    """
    rests = [pair for window in located for pair in _rates(window, axes)]
    signs = [0, 0, 0]
    for i in range(3):
        ways = []
        for sign in (1, -1):
            same = [
                (r, u)
                for up, r, u in rests
                if sign * up[i] > MIN_UPRIGHT_SHARE and np.isfinite(u[i])
            ]
            if same:
                weight = np.array([1 / max(u[i], 1e-12) ** 2 for _, u in same])
                mean = float(weight @ np.array([r[i] for r, _ in same]) / weight.sum())
                ways.append((mean, float(1 / np.sqrt(weight.sum()))))
        if len(ways) == 2 and earth_rate:
            (above, sigma_above), (below, sigma_below) = ways
            ratio = (above - below) / 2 / earth_rate
            sigma = np.hypot(sigma_above, sigma_below) / 2 / earth_rate
            if MIN_EARTH_SIGMA * abs(sigma) < 0.5 and 0.5 < abs(ratio) < 1.5:
                signs[i] = int(np.sign(ratio))
    return signs


def _rates(located: Located, axes: Axes) -> Iterator[tuple[Array, Array, Array]]:
    """The rests of a window: what points up, rates, and their sigmas, along the plan's axes."""
    unsigned = replace(axes.gyro, signs=(1, 1, 1))
    for up, observation in _rests(located):
        yield axes.accel.of(up), axes.gyro.of(observation.rate), unsigned.of(observation.unsure)


def forces_at_rest(located: Located) -> Iterator[tuple[Array, Array]]:
    """The specific forces at the rests of a window, each with the direction that was planned up."""
    for up, observation in _rests(located):
        if np.isfinite(observation.force).all():
            yield observation.force, up


def _rests(located: Located) -> Iterator[tuple[Array, Observation]]:
    """The rests of a window, those before turns too: what was planned up, and what was seen."""
    for m in located.plan:
        place = located.place(m) if m.do == "rest" else located.rest_before(m)
        if place is not None and m.up is not None and located.place(m) is not None:
            yield m.up, located.observed[place]


def level_of(every: Sequence[Binned]) -> tuple[Array, float]:
    """The gyros at rest over the campaign: from the windows of rests alone, if there are any.

    An axis that none of them records does not count; one that some do not record is taken from the
    others.
    """
    rests = [binned for binned in every if {m.do for m in binned.window.manoeuvres} == {"rest"}]
    for group in (rests, every):
        read = [binned.rates[binned.seconds > 0] for binned in group]  # not where all is masked
        rates = np.concatenate([np.empty((0, 3)), *read])
        recorded = np.isfinite(rates).any(axis=0)
        whole = rates[np.isfinite(rates[:, recorded]).all(axis=1)] if recorded.any() else []
        if len(whole):
            return rest_level(np.where(recorded, whole, 0.0))
    return np.zeros(3), 0.0
