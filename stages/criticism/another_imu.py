"""Logs that are of another IMU: from one of them on, or one alone, all parameters are others."""

from collections.abc import Collection, Iterator

import numpy as np

from inertial.arrays import Array
from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.campaign.explanations import ANOTHER_IMU
from inertial.estimation.effect_information import EffectInformation
from inertial.model_selection.cause import FOUND
from inertial.physics.drift import without_clock
from inertial.physics.effect import Effect, Parameter, Reading, Truth
from inertial.physics.motion import Motion
from inertial.sensors import SENSORS
from inertial.tables import AXES
from inertial.text.messages import _
from stages.criticism.bias_drift import TYPICAL_SIZE
from stages.criticism.finding_rows import TableRow, finding_row, snr_of
from stages.criticism.selection import Selection

MIN_CAUSES = 3  # named; one or two are what they are named
CAUSE_PRICE = 10.0  # of −2 log of the odds: one campaign in 150 has a cause of one kind
MIN_GAIN = 10.0  # of −2 log of the evidence, over all that is named
MIN_SIGMAS = 3.0  # by which half of the parameters differ that are known to their typical size
PRIOR_SIZE = 30.0  # of a parameter, in its typical size
TYPICAL_TERM = 1e-4  # of a scale factor or cross term

SENTENCE = _(
    "From {first} to {last} all biases, scale factors and cross terms of both sensors are others: "
    "{count} numbers explain as much as the {causes} causes that would have to come together."
)
CONSEQUENCE = _("The parameters are a mixture of those of two instruments.")
ACTION = _(
    "Compare the serial numbers. If these logs are of another IMU, give each its own campaign; if "
    "they are of the same, look for a change of its compensation or range between the logs."
)


class OfAnotherImu(Effect):
    """Reading += c + D s in some runs: another bias, another matrix; s is what is sensed."""

    name = ANOTHER_IMU
    cause = _("the logs are of another instrument")
    source = "the twelve parameters of each triad, IEEE Std 1431-2004"
    thinkable = 1e4

    def __init__(self, number: int, runs: Collection[int]) -> None:
        self.at, self.runs = float(number), list(runs)
        self.parameters = tuple(
            Parameter(f"{sensor}_{name}_{axis}", unit, size, "")
            for sensor in SENSORS
            for name, (unit, size) in (
                ("c", TYPICAL_SIZE[sensor]),
                *((f"d{other}", ("1", TYPICAL_TERM)) for other in AXES),
            )
            for axis in AXES
        )
        self.sizes = {"usual": TYPICAL_TERM}

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        there = np.isin(motion.run, self.runs)[:, None]
        for sensor, sensed, own in zip(
            SENSORS, (truth.rate, truth.force), values.reshape(2, 4, 3), strict=True
        ):
            reading = reading.plus(sensor, there * (own[0] + sensed @ own[1:]))
        return reading


def another_imu(campaign: Campaign, selection: Selection, mount: str) -> Iterator[TableRow]:
    """The finding, where one change of everything explains more than all that is named.

    None of the sensors contradicts it.
    """
    named = selection.named.causes
    if len(named) < MIN_CAUSES or not campaign.recorded:
        return
    motion = campaign.motion
    runs = np.unique(motion.run).tolist()
    if len(runs) < 2 or not without_clock(motion):
        return
    alone = [[run] for run in runs[:-1]] if len(runs) > 2 else []
    parts = [*(runs[k:] for k in range(1, len(runs))), *alone]
    changes = [OfAnotherImu(number, part) for number, part in enumerate(parts)]
    fitted = selection.fitted
    shown = evidence(campaign, [*fitted, *changes])
    place = {name: i for i, name in enumerate(shown.names)}

    def weighed(effects: Collection[Effect], causes: int, by: EffectInformation) -> float:
        """2 log of the evidence of effects whose parameters are normal, and of their number."""
        own = [place[name] for one in effects for name in one.columns]
        size = np.array([PRIOR_SIZE * p.typical for one in effects for p in one.parameters])
        right = by.right[own] * size
        given = np.eye(len(own)) + by.information[np.ix_(own, own)] * np.outer(size, size)
        occam = float(np.linalg.slogdet(given)[1])
        return float(right @ np.linalg.solve(given, right)) - occam - causes * CAUSE_PRICE

    best = max(changes, key=lambda change: weighed([change], 1, shown.total))
    gain = weighed([best], 1, shown.total) - weighed(fitted, len(named), shown.total)
    contradicted = min(weighed([best], 0, sensor) for sensor in shown.sensors) < -MIN_GAIN
    if gain < MIN_GAIN or contradicted:
        return
    columns = [place[name] for name in best.columns]
    values, covariance = shown.total.estimate(columns)
    sigma = np.sqrt(np.diag(covariance))
    told = sigma < [parameter.typical for parameter in best.parameters]
    if np.count_nonzero(np.abs(values[told]) > MIN_SIGMAS * sigma[told]) < told.sum() / 2:
        return
    drop, degrees = shown.total.drop(columns)
    there = motion.visit[np.isin(motion.run, best.runs)]
    first, last = (campaign.planned[int(visit)] for visit in (there.min(), there.max()))
    yield finding_row(
        ANOTHER_IMU,
        mount,
        sensor=None,
        count=len(best.runs),
        size=snr_of(drop, degrees),
        unit="sigma",
        p_value=None,
        severity=3,
        sentence=SENTENCE.format(first=first, last=last, count=degrees, causes=len(named)),
        consequence=CONSEQUENCE,
        action=ACTION,
        verdict=FOUND,
        statistic=drop,
        degrees=degrees,
        snr=snr_of(drop, degrees),
    )
