"""Campaigns in a chamber: six positions and turns about each axis, at several temperatures.

No simulated laboratory: the readings are those of the plan, and what is hidden is added to them.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import plans

from inertial.arrays import Array
from inertial.campaign.equations import Campaign
from inertial.tables import CHANNELS

Hidden = Callable[[Array, Array, Array], Array]  # K above the middle, readings, s → change (n, 6)

ICE_POINT = 273.15  # K
LEVELS = (-20, 0, 20, 40, 60)  # °C
MIDDLE = ICE_POINT + 20
PAUSE = 1800.0  # s, until a temperature is reached
NOISE = np.repeat([plans.ACCEL_NOISE, plans.GYRO_NOISE], 3)


def soak(levels: Sequence[float] = LEVELS, rest: float = 20.0) -> plans.Plan:
    """Each temperature with a slow swing of 0.3 K."""
    plan = plans.Plan()
    for level in levels:
        first = len(plan.rows)
        plans.six_positions(plan, rest)
        for name in ("+x", "+y", "+z"):
            up, mark = plans.axis(name), plans.axis(plans.MARK[name])
            for degrees in (360, -360):
                plan.turn(up, mark, up, degrees, 60, 60)
        for rows in plan.rows[first:]:
            rows["temperature"] = ICE_POINT + level + 0.3 * np.sin(rows["time"] / 300)
        plan.now += PAUSE
    return plan


def nothing(above: Array, readings: Array, time: Array) -> Array:
    return np.zeros_like(readings)


def recorded(plan: plans.Plan, seed: int, hidden: Hidden = nothing) -> Campaign:
    """The campaign with noise and with what is hidden."""
    rng = np.random.default_rng(seed)
    tables = []
    for rows in plan.rows:
        read = rows[list(CHANNELS)].to_numpy()
        above, time, seconds = (rows[n].to_numpy() for n in ("temperature", "time", "seconds"))
        noise = rng.normal(size=read.shape) * NOISE / np.sqrt(seconds)[:, None]
        change = hidden(above - MIDDLE, read, time)
        tables.append(rows.assign(**dict(zip(CHANNELS, (read + change + noise).T, strict=True))))
    return replace(plan, rows=tables).campaign()


def ramp(seconds: float = 60.0, warmest: float = 50.0, coldest: float = 10.0) -> plans.Plan:
    """Six positions, six times, while it warms and then cools as fast."""
    plan = plans.Plan()
    for _sweep in range(6):
        plans.six_positions(plan, seconds)
    for rows in plan.rows:
        rows["temperature"] = there_and_back(rows["time"].to_numpy(), plan.now, coldest, warmest)
    return plan


def there_and_back(time: Array, end: float, coldest: float, warmest: float) -> Array:
    """A triangle, K."""
    return ICE_POINT + coldest + (warmest - coldest) * (1 - np.abs(2 * time / end - 1))
