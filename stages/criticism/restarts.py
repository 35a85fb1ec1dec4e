"""Restarts of the IMU that nobody stated: at gaps of the recording, after which biases differ."""

from collections.abc import Mapping, Sequence

import pandas as pd

from inertial.campaign.equations import Campaign
from inertial.campaign.records import Clock, rows_of
from inertial.effects.restarts import MAX_RESTARTS, Restarts
from inertial.physics.drift import without_clock
from inertial.sensors import SENSORS

MIN_SECONDS = 0.5  # of a gap: no IMU starts faster
MIN_RESTARTS = 2  # a single one is a jump of the biases


def restarts_of(
    campaign: Campaign, gaps: pd.DataFrame, clocks: Mapping[str, Clock]
) -> list[Restarts]:
    """The effect on each sensor, where there are several gaps on one clock.

    gaps : the table of quality
    """
    if not campaign.recorded or without_clock(campaign.motion):
        return []
    time = campaign.motion.time
    middles = [
        (row["from_s"] + row["to_s"]) / 2 + clocks[row["log"]].offset
        for row in rows_of(gaps)
        if row["log"] in clocks and row["to_s"] - row["from_s"] > MIN_SECONDS
    ]
    times = sorted(middle for middle in middles if time.min() < middle < time.max())
    if not MIN_RESTARTS <= len(times) <= MAX_RESTARTS:
        return []
    return [Restarts(sensor, times, first=1) for sensor in SENSORS]


def first_after(campaign: Campaign, times: Sequence[float]) -> list[str]:
    """The first manoeuvre after each of some times."""
    names = [name for sensor in SENSORS for name in campaign.manoeuvres_of(sensor)]
    began = campaign.motion.time - campaign.motion.seconds / 2
    in_time = sorted(zip(began.tolist(), names, strict=True))
    return [next(name for at, name in in_time if at > time) for time in times]
