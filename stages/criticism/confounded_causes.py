"""Named effects in whose place, or beside which, another cause may be that the plan cannot show.

A change of the biases of one sensor may be hidden in the other; one asymmetry of all gyros may be
of a table that turns less far in one sense than planned.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from inertial.campaign.effect_sentences import Estimated
from inertial.campaign.hypotheses import JUMP_NOT_TESTABLE, SENSE_OF_TURNS
from inertial.estimation.consistency import weighted_mean
from inertial.estimation.probability import chi2_sf
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS
from inertial.sensors import PLURAL, SENSORS
from inertial.text.messages import _
from inertial.text.numbers import significant
from stages.criticism.finding_rows import TableRow, finding_id, finding_row
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
    sigmas = np.array([one.sigma for one in estimates], np.float64)
    mean, sigma, spread = weighted_mean(values, sigmas)
    if (np.abs(values) < MIN_SIGMAS * sigmas).any() or chi2_sf(spread, 2) < MIN_P:
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
