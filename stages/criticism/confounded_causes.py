"""Named effects in whose place, or beside which, another cause may be that the plan cannot show.

A change of the biases of one sensor may be hidden in the other; one asymmetry of all gyros may be
of a table that turns less far in one sense than planned; several at once may be another IMU.
"""

from collections.abc import Collection, Iterator, Sequence

import numpy as np

from inertial.arrays import Array
from inertial.campaign.effect_evidence import evidence
from inertial.campaign.effect_sentences import Estimated
from inertial.campaign.equations import Campaign
from inertial.campaign.explanations import ANOTHER_IMU
from inertial.campaign.hypotheses import JUMP_NOT_TESTABLE, SENSE_OF_TURNS
from inertial.estimation.effect_information import EffectInformation
from inertial.estimation.probability import chi2_sf
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS
from inertial.physics.drift import without_clock
from inertial.physics.effect import Effect, Parameter, Reading, Truth
from inertial.physics.motion import Motion
from inertial.sensors import PLURAL, SENSORS
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.numbers import significant
from stages.criticism.finding_rows import TableRow, finding_id, finding_row, snr_of
from stages.criticism.selection import Selection

CHANGES = ("bias_jump", "bias_per_log")  # of a sensor, by the end of the effect's name

# ---- A change of the biases of one sensor that the other may share unseen.

CHANGE_MAY_BE_SHARED = _(
    "The biases of the {changing} change. Whether those of the {others} changed as well, this plan "
    "cannot show: where the axes are up before the change and down after it, or no two positions "
    "are in one log, it reads as bias, scale factors and cross terms."
)
CONSEQUENCE_OF_CHANGE = _("If they did, about half of their change is in each parameter.")
RECORD_TOGETHER = _(
    "Record all positions without a restart; or, with restarts, several positions in each log, "
    "among them each axis up and down."
)


def jumps_not_testable(selection: Selection, mount: str) -> Iterator[TableRow]:
    """The finding, where the other sensor shows less of the same change than this one."""
    named = {
        cause.effect: cause.value
        for cause in selection.named.causes
        if cause.verdict in (FOUND, ONE_OF_CLASS)
    }
    labels = selection.evidence.labels
    for sensor, other in zip(SENSORS, SENSORS[::-1], strict=True):
        changes = {f"{sensor}_{what}": f"{other}_{what}" for what in CHANGES}
        if not named.keys().isdisjoint(changes.values()) or other not in labels:
            continue
        changed = [(own, named[own], same) for own, same in changes.items() if own in named]
        if any(_hidden(selection, *each) for each in changed):
            yield finding_row(
                JUMP_NOT_TESTABLE,
                mount,
                id=finding_id(JUMP_NOT_TESTABLE, mount, other),
                sensor=other,
                unit="",
                sentence=CHANGE_MAY_BE_SHARED.format(changing=PLURAL[sensor], others=PLURAL[other]),
                consequence=CONSEQUENCE_OF_CHANGE,
                action=RECORD_TOGETHER,
                verdict=FOUND,
            )


def _hidden(selection: Selection, own: str, value: int, same: str) -> bool:
    """Whether fewer parameters of the other sensor's change are observable than of this one."""
    searched = {one.name: one.candidates for one in selection.searched}
    places = searched[own][value], searched[same][_same_time(selection, own, value, same)]
    of_own, of_other = (selection.evidence.total.drop(place)[1] for place in places)
    return of_other < of_own


def _same_time(selection: Selection, own: str, value: int, same: str) -> int:
    """The candidate of the other's change that is nearest in time; a change by logs has one."""
    if own not in selection.families:
        return value
    at = selection.effect(own, value).at or 0.0
    times = [one.at or 0.0 for one in selection.families[same]]
    return min(range(len(times)), key=lambda i: abs(times[i] - at))


# ---- One asymmetry of all gyros, which a table has that turns less far in one sense.


ASYMMETRY = "gyro_scale_asymmetry"
MIN_SIGMAS = 5.0  # of each gyro's asymmetry
MIN_P = 0.01  # that the three differ as they do if they are one

ASYMMETRY_IS_SHARED = _(
    "The scale asymmetries of all three gyros are one within their sigmas, {size} ± {sigma} ppm. "
    "Three gyros hardly agree so; a table that turns by {share} ppm farther in one sense than in "
    "the other, as by backlash, reads the same."
)
CONSEQUENCE_OF_ASYMMETRY = _(
    "If it is the table, compensating the asymmetry is wrong, and the scale factors are off by "
    "{size} ppm at most, for it is not known which sense is right."
)
MEASURE_ANGLES = _(
    "Measure the angle of a turn in each sense by an encoder, a mark or an autocollimator; state "
    "the angles in the plan as they are."
)


def shared_asymmetry(estimates: Sequence[Estimated], mount: str) -> Iterator[TableRow]:
    """The finding, by the asymmetries of the gyros that were named."""
    if len(estimates) != 3 or any(one.value is None or not one.sigma for one in estimates):
        return
    values = np.array([one.value for one in estimates], np.float64)
    weights = np.array([one.sigma for one in estimates], np.float64) ** -2
    mean, sigma = float(values @ weights / weights.sum()), float(weights.sum() ** -0.5)
    spread = float((values - mean) ** 2 @ weights)
    if (values**2 * weights < MIN_SIGMAS**2).any() or chi2_sf(spread, 2) < MIN_P:
        return
    size = significant(1e6 * abs(mean), 3)
    yield finding_row(
        SENSE_OF_TURNS,
        mount,
        sensor="gyro",
        size=mean,
        unit="1",
        sentence=ASYMMETRY_IS_SHARED.format(
            size=significant(1e6 * mean, 3),
            sigma=significant(1e6 * sigma, 2),
            share=significant(2e6 * abs(mean), 3),
        ),
        consequence=CONSEQUENCE_OF_ASYMMETRY.format(size=size),
        action=MEASURE_ANGLES,
        verdict=FOUND,
    )


# ---- Logs that are of another IMU: from one of them on, or one alone, all parameters are others.

MIN_CAUSES = 3  # named; one or two are what they are named
CAUSE_PRICE = 10.0  # of −2 log of the odds: one campaign in 150 has a cause of one kind
MIN_GAIN = 10.0  # of −2 log of the evidence, over all that is named
MIN_DIFFERENCE = 3.0  # sigma, of half of the parameters that are known to their typical size
PRIOR_SIZE = 30.0  # of a parameter, in its typical size
TYPICAL_BIAS = {"gyro": ("rad/s", 5e-6), "accel": ("m/s²", 1e-4)}
TYPICAL_TERM = 1e-4  # of a scale factor or cross term

ALL_ARE_OTHERS = _(
    "From {first} to {last} all biases, scale factors and cross terms of both sensors are others: "
    "{count} numbers explain as much as the {causes} causes that would have to come together."
)
CONSEQUENCE_OF_MIXTURE = _("The parameters are a mixture of those of two instruments.")
COMPARE_SERIALS = _(
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
                ("c", TYPICAL_BIAS[sensor]),
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
    if np.count_nonzero(np.abs(values[told]) > MIN_DIFFERENCE * sigma[told]) < told.sum() / 2:
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
        sentence=ALL_ARE_OTHERS.format(first=first, last=last, count=degrees, causes=len(named)),
        consequence=CONSEQUENCE_OF_MIXTURE,
        action=COMPARE_SERIALS,
        verdict=FOUND,
        statistic=drop,
        degrees=degrees,
        snr=snr_of(drop, degrees),
    )
