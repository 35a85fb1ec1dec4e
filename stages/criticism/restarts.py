"""Restarts of the IMU that nobody stated: at gaps of the recording, after which biases differ."""

from collections.abc import Collection, Mapping, Sequence

import numpy as np
import pandas as pd

from inertial.campaign.equations import Campaign
from inertial.campaign.records import Clock, rows_of
from inertial.effects.restarts import MAX_RESTARTS, Restarts
from inertial.estimation.effect_information import whitening
from inertial.estimation.probability import chi2_sf
from inertial.physics.drift import without_clock
from inertial.sensors import SENSORS
from stages.criticism.selection import Selection

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


def at_changes(selection: Selection, level: float) -> list[float] | None:
    """The times of the gaps at which biases change; None where they do at all that are taken.

    Of both sensors together, for a restart is one of both. Runs at whose gap they change least, by
    chi-squared, are one, until the change at each gap left has no more than the probability
    `level`, of all gaps, to be by chance.
    """
    named = [
        (effect, list(cause.columns))
        for cause in selection.named.causes
        if cause.effect in selection.families
        and isinstance(effect := selection.effect(cause.effect, cause.value), Restarts)
    ]
    if not named:
        return None
    times = named[0][0].times
    own = [i for _effect, columns in named for i in columns]
    evidence = selection.evidence.observable()
    evidence = evidence.scaled(selection.named.excesses) if selection.named.excesses else evidence
    given = {i for cause in selection.named.causes for i in cause.columns} - set(own)
    total = evidence.total.given(sorted(given)) if given else evidence.total
    information, right = total.information[np.ix_(own, own)], total.right[own]

    def explained(kept: Collection[int]) -> tuple[float, int]:
        """Chi-squared and degrees of runs that begin at these gaps alone."""
        run = np.cumsum([k in kept for k in range(len(times))])
        of_runs = np.eye(len(kept) + 1)[run][:, 1:]  # the first has none
        together = np.kron(np.eye(len(named)), np.kron(of_runs, np.eye(3)))
        known = whitening(together.T @ information @ together)
        return float(np.sum((known.T @ (together.T @ right)) ** 2)), known.shape[1]

    kept = list(range(len(times)))
    while len(kept) > 1:
        drop, degrees = explained(kept)
        chances = []
        for k in kept:
            less, fewer = explained([other for other in kept if other != k])
            chances.append(float(chi2_sf(drop - less, max(degrees - fewer, 1))) * len(times))
        if max(chances) <= level:
            break
        kept.pop(int(np.argmax(chances)))
    return None if len(kept) == len(times) else [times[k] for k in kept]
