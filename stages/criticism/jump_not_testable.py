"""A change of the biases of one sensor that the other may share unseen, for the plan hides it."""

from collections.abc import Iterator

from inertial.campaign.hypotheses import JUMP_NOT_TESTABLE
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS
from inertial.sensors import PLURAL, SENSORS
from inertial.text.messages import _
from stages.criticism.finding_rows import TableRow, finding_id, finding_row
from stages.criticism.selection import Selection

CHANGES = ("bias_jump", "bias_per_log")  # of a sensor, by the end of the effect's name

SENTENCE = _(
    "The biases of the {changing} change. Whether those of the {others} changed as well, this plan "
    "cannot show: where the axes are up before the change and down after it, or no two positions "
    "are in one log, it reads as bias, scale factors and cross terms."
)
CONSEQUENCE = _("If they did, about half of their change is in each parameter.")
ACTION = _(
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
                sentence=SENTENCE.format(changing=PLURAL[sensor], others=PLURAL[other]),
                consequence=CONSEQUENCE,
                action=ACTION,
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
