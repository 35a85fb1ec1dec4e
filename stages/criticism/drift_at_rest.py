"""Whether the drift that the noise at rest shows is in the equations, or effects take its place.

A bias instability goes on between the stretches, and there it would be named as effects, or leave a
structure. A jump or a warm-up within a stretch looks like such a drift at rest, and would be hidden
by it. So the effects that are named beside the drift are weighed against those without it and with
a random walk that is estimated between the stretches, by evidence, one sensor after the other.
Effects beside which a structure is left that the drift explains are no explanation. What few
manoeuvres carry is no drift, unless the others have it too: that is in all of them. A drift that is
no more than the data sheet states is known beforehand, and is not weighed.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.equations import PRIOR_SIZE, Campaign
from inertial.effects.law import Law
from inertial.physics.effect import Effect
from inertial.sensors import SENSORS
from inertial.tables import ACCEL, GYRO
from stages.criticism.residual_structure import Tested, carrying
from stages.criticism.rivals import MAX_LOG_ODDS, members_of
from stages.criticism.selection import Selection


def select_beside_drift(
    measured: Campaign, select: Callable[[Campaign], tuple[Selection, Tested]], level: float
) -> tuple[Selection, Tested, Campaign]:
    """The likeliest selection, its tests, and the campaign with the drifts at rest that are kept.

    Parameters
    ----------
    measured : with the drifts of both sensors at rest
    select : of a campaign the effects and laws, and the tests of its residuals
    level : accepted probability of a law that is not there, which its evidence pays for
    """
    kept = measured
    selection, tested = select(kept)
    for sensor in SENSORS:
        drift = measured.drifts[sensor]
        if not drift or drift.expected or not selection.evidence.sensors:
            continue  # without equations nothing is likelier
        without = kept.without_drift_at_rest([sensor])
        other, other_tested = select(without)
        odds = _log_evidence(other, level) - _log_evidence(selection, level)
        carried = carrying(other_tested, sensor)
        explains = odds > MAX_LOG_ODDS and (not other_tested.of(sensor) or bool(tested.of(sensor)))
        if explains or (carried and not _drifts_without(carried, kept, sensor, other.fitted)):
            selection, tested, kept = other, other_tested, without
        elif odds > -MAX_LOG_ODDS:
            selection = _with_alternatives(selection, other)
    return selection, tested, kept


def _drifts_without(
    carried: Sequence[str], kept: Campaign, sensor: str, effects: Sequence[Effect]
) -> bool:
    """Whether the other manoeuvres are likelier with the drift, given effects."""
    others = set(kept.manoeuvres).difference(carried)
    deviances = [
        equations.likelihood.constant
        for campaign in (kept, kept.without_drift_at_rest([sensor]))
        if (equations := campaign.equations(sensor, effects, PRIOR_SIZE, others)) is not None
    ]
    return len(deviances) == 2 and deviances[1] - deviances[0] > 2 * MAX_LOG_ODDS


def _log_evidence(selection: Selection, level: float) -> float:
    laws = sum(isinstance(effect, Law) for effect in selection.effects)
    return selection.log_evidence + laws * float(np.log(level))


def _with_alternatives(selection: Selection, other: Selection) -> Selection:
    """The same; what is named without the drift may be instead of it."""
    others = dict.fromkeys([*selection.alternatives, *members_of(other)])
    named = members_of(selection)
    return replace(selection, alternatives=tuple(one for one in others if one not in named))


# ---- Whether what is a random walk by the noise at rest is too fast for one of a sensor.
#
# The spectrum of a slow oscillation, or of one that the sampling folds to a low frequency, falls
# with the frequency as that of a random walk does. But a bias wanders within a minute by less than
# its readings scatter from one to the next: of all grades, from a phone's sensors to a navigation
# grade. An oscillation that begins in the course of a campaign is no random walk within a rest: its
# Allan deviation is largest at half a period, and there beyond the readings of the quietest rest.

WITHIN = 60.0  # s
MIN_WANDER_S = 1.0  # s, in which what a sensor filters or shares from reading to reading is over


@dataclass(frozen=True)
class Unsteady:
    """By how much the readings of an axis wander in so many seconds, and one of them scatters.

    rad/s or m/s².
    """

    seconds: float
    wander: float
    scatter: float


def unsteady_rests(
    data: CampaignData, sensor: str, sizes: Array, allan: pd.DataFrame
) -> Unsteady | None:
    """The worst axis, by random walks `sizes`, (3,), rad/s/√s or m/s²/√s; None: like a sensor's.

    By the Allan deviations of the rests, where they do not show it.
    """
    positions, _ = data.gyro_positions if sensor == "gyro" else data.accelerometer_positions
    if not positions:
        return None
    channels = GYRO if sensor == "gyro" else ACCEL
    scatters = [data.noise.of_samples(p.manoeuvre.name, "rest", channels) for p in positions]
    longest = max(float(position.seconds.sum()) for position in positions)
    seconds = min(WITHIN, longest)
    found = _worst(np.full(3, seconds), sizes * np.sqrt(seconds), np.nanmedian(scatters, axis=0))
    if found or data.noise.rounded(sensor):
        return found
    slow = allan[(allan["tau"] >= MIN_WANDER_S) & (allan["tau"] <= WITHIN)]
    largest = slow.sort_values("lower").groupby("channel").last().reindex(channels).fillna(0.0)
    tau, deviation = (largest[name].to_numpy(np.float64) for name in ("tau", "lower"))
    return _worst(tau, deviation, np.nanmin(scatters, axis=0))


def _worst(seconds: Array, wander: Array, scatter: Array) -> Unsteady | None:
    """The axis that wanders most, (3,) each, if by more than its readings scatter."""
    known = np.where(scatter > 0, scatter, np.inf)  # an axis that is not read, or stands still
    worst = int(np.argmax(wander / known))
    if not wander[worst] > known[worst]:
        return None
    return Unsteady(float(seconds[worst]), float(wander[worst]), float(scatter[worst]))
