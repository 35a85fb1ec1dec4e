"""Restarts of the IMU that nobody stated: at gaps of the recording, after which biases differ."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from itertools import zip_longest

import numpy as np
import pandas as pd

from inertial.campaign.equations import Campaign
from inertial.campaign.records import Clock, rows_of
from inertial.campaign.where_causes_act import JUMPS, RESTARTS
from inertial.effects.restarts import MAX_RESTARTS, Restarts
from inertial.effects.warm_up import WarmUp
from inertial.estimation.effect_information import EffectInformation, whitening
from inertial.estimation.probability import chi2_sf
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS, Cause, EffectTest
from inertial.physics.drift import without_clock
from inertial.physics.effect import Effect
from inertial.physics.motion import Motion
from inertial.sensors import SENSORS
from stages.criticism.finding_rows import snr_of
from stages.criticism.rivals import MAX_LOG_ODDS
from stages.criticism.selection import Selection

MIN_SECONDS = 0.5  # of a gap: no IMU starts faster
MAX_TIME_DROP = 9.0  # of chi-squared, from the best time of a jump to that of a gap: three sigma


def times_of_gaps(
    campaign: Campaign, gaps: pd.DataFrame, clocks: Mapping[str, Clock]
) -> list[float]:
    """The gaps at which the IMU may have been switched off and on, s since the first sample.

    Not those at which the campaign states that it was. None where there are more than anybody
    makes by switching.

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
    times = [at for at in times if not _stated(campaign.motion, at)]
    return times if len(times) <= MAX_RESTARTS else []


def _stated(motion: Motion, at: float) -> bool:
    """Whether a switch-on is stated between the last stretch before a time and the next one."""
    switched_on = motion.switched_on[np.argsort(motion.time, kind="stable")]
    before = int(np.sum(motion.time < at))
    return bool(switched_on[before - 1] != switched_on[before])


def restarts_at(times: Sequence[float]) -> list[Restarts]:
    """The effect on each sensor."""
    return [Restarts(sensor, times, first=1) for sensor in SENSORS] if times else []


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
    `level`, of all gaps, to be by chance. Where a jump is named instead, it is the gap that agrees
    with its time.
    """
    named = [
        (effect, list(cause.columns))
        for cause in selection.named.causes
        if cause.effect in selection.families
        and isinstance(effect := selection.effect(cause.effect, cause.value), Restarts)
    ]
    if not named:
        return _at_jump(selection)
    times = named[0][0].times
    own = [i for _effect, columns in named for i in columns]
    evidence = selection.evidence.observable()
    evidence = evidence.scaled(selection.named.excesses) if selection.named.excesses else evidence
    given = {i for cause in selection.named.causes for i in cause.columns} - set(own)
    total = evidence.total.given(sorted(given)) if given else evidence.total
    kept = list(range(len(times)))
    while len(kept) > 1:
        drop, degrees = _explained(total, own, len(times), kept)
        chances = []
        for k in kept:
            others = [other for other in kept if other != k]
            less, fewer = _explained(total, own, len(times), others)
            chances.append(float(chi2_sf(drop - less, max(degrees - fewer, 1))) * len(times))
        if max(chances) <= level:
            break
        kept.pop(int(np.argmax(chances)))
    return None if len(kept) == len(times) else [times[k] for k in kept]


def _explained(
    total: EffectInformation, own: Sequence[int], gaps: int, kept: Collection[int]
) -> tuple[float, int]:
    """Chi-squared and degrees of runs that begin at some of the gaps alone.

    own : the columns of the runs after each gap, of one sensor or of several
    """
    run = np.cumsum([k in kept for k in range(gaps)])
    of_runs = np.eye(len(kept) + 1)[run][:, 1:]  # the first has none
    sensors = len(own) // (3 * gaps)
    together = np.kron(np.eye(sensors), np.kron(of_runs, np.eye(3)))
    known = whitening(together.T @ total.information[np.ix_(own, own)] @ together)
    return float(np.sum((known.T @ (together.T @ total.right[own])) ** 2)), known.shape[1]


# ---- A jump at a gap is a restart: its time is known better than from what is excited about it.


def _at_jump(selection: Selection) -> list[float] | None:
    """The gap that explains about as much as the best time of a named jump, None without one."""
    for cause in selection.named.causes:
        restarts, columns = _instead(selection, cause)
        if restarts is None or len(restarts.times) == 1:
            continue
        total, gaps = selection.beside_others(cause).total, len(restarts.times)
        drops = [_explained(total, columns, gaps, [k])[0] for k in range(gaps)]
        if max(drops) > cause.statistic - MAX_TIME_DROP:
            return [restarts.times[int(np.argmax(drops))]]
    return None


def _instead(selection: Selection, cause: Cause) -> tuple[Restarts | None, list[int]]:
    """The restarts that may be a named jump of a bias, with their columns, if there are gaps."""
    name = cause.effect.replace("_bias_jump", "_restarts")
    if cause.effect not in JUMPS | RESTARTS or name not in selection.families:
        return None, []
    restarts = selection.effect(name, 0)
    assert isinstance(restarts, Restarts)
    return restarts, list(selection.search_of(name).candidates[0])


def named_at_gap(selection: Selection) -> Selection:
    """The same; a jump of a bias that agrees with the only gap taken is a restart there.

    Both are the same term but for the time, so the jump is no rival of it.
    """
    causes = tuple(_at_gap(selection, cause) for cause in selection.named.causes)
    now = {cause.effect: cause for cause in causes}
    replaced = {cause.effect for cause in selection.named.causes} - set(now)
    tests = tuple(
        EffectTest(test.effect, test.value, 0.0, 0, 1.0, 1.0)
        if test.effect in replaced
        else replace(test, degrees=now[test.effect].degrees)
        if test.effect in now
        else test
        for test in selection.named.tests
    )
    return replace(selection, named=replace(selection.named, causes=causes, tests=tests))


def _at_gap(selection: Selection, cause: Cause) -> Cause:
    restarts, columns = _instead(selection, cause)
    if restarts is None or len(restarts.times) != 1:
        return cause
    total = selection.beside_others(cause).total
    drop, degrees = total.drop(columns)
    if drop < cause.statistic - MAX_TIME_DROP:
        return cause
    values, covariance = total.estimate(columns)
    jump = f"{restarts.sensor}_bias_jump"
    each = {
        member: (value, weight, captured)
        for member, value, weight, captured in zip_longest(
            cause.members, cause.member_values, cause.weights, cause.captured
        )
    }
    own = [each.pop(name) for name in (jump, restarts.name) if name in each]
    each = {restarts.name: (0, sum(weight for _, weight, _ in own), 1.0), **each}
    alone = len(each) == 1 and cause.verdict == ONE_OF_CLASS
    return replace(
        cause,
        effect=restarts.name,
        value=0,
        verdict=FOUND if alone else cause.verdict,
        members=tuple(each),
        # A random walk in the class has no candidate.
        member_values=tuple(value for value, _, _ in each.values() if value is not None),
        weights=tuple(weight for _, weight, _ in each.values()),
        captured=tuple(captured for _, _, captured in each.values()),
        statistic=drop,
        degrees=degrees,
        snr=snr_of(drop, degrees),
        columns=tuple(columns),
        values=values,
        covariance=covariance,
    )


# ---- A warm-up begins again where the IMU is switched on.


def beginning_again(effects: Sequence[Effect], motion: Motion, at: Sequence[float]) -> list[Effect]:
    """The effects, of which a warm-up begins again at restarts too, s since the first sample."""
    stated = motion.switched_on[motion.switched_on > 0].tolist()
    times = sorted({*stated, *at})
    return [each.beginning_at(times) if isinstance(each, WarmUp) else each for each in effects]


def is_better(again: Selection, once: Selection) -> bool:
    """Whether a warm-up that begins again at restarts is likelier than all else without it."""
    warming = any(isinstance(effect, WarmUp) for effect in again.effects)
    return warming and again.log_evidence > once.log_evidence + MAX_LOG_ODDS
