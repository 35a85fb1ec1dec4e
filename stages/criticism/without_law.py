"""What follows no law is reported once for each sensor: by its random walk, structure, or drift.

A bias that changes by no law shows in several ways: the estimate finds a random walk, the tests a
structure of the residuals in time, and the search effects or half waves that resemble it a little.
These are one finding, and what they resemble is what the data are consistent with. A structure that
few manoeuvres carry is no random walk, which is in all of them.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from inertial.model_selection.cause import UNKNOWN_STRUCTURE, Cause
from inertial.sensors import SENSORS
from stages.criticism.bias_drift import drift_name
from stages.criticism.finding_rows import finding_id
from stages.criticism.residual_structure import CAUSE as STRUCTURE
from stages.criticism.residual_structure import Tested, carrying
from stages.criticism.selection import Selection, walk_name

OF_WALKS = ("time", "change")  # structures that a bias without a law has, whatever its course


@dataclass(frozen=True)
class WithoutLaw:
    """What each sensor has without a law.

    `owner`: by sensor the cause of the finding that reports all of it; `structured`: the p-value of
    the structure of its residuals, by sensor that has one; `members`: by sensor the
    effects with which the data are no more than consistent.
    """

    owner: Mapping[str, str]
    structured: Mapping[str, float]
    members: Mapping[str, tuple[str, ...]]

    @property
    def reported_structures(self) -> dict[str, tuple[str, ...]]:
        """The members of each structure that is a finding of its own, by sensor."""
        return {
            s: self.members[s] for s, cause in self.owner.items() if cause.startswith(STRUCTURE)
        }

    def finding(self, cause: Cause, sensor: str, mount: str) -> str:
        """The finding by which a cause is reported."""
        own = cause.verdict != UNKNOWN_STRUCTURE or sensor not in self.owner
        return finding_id(cause.effect if own else self.owner[sensor], mount)


def without_law(selection: Selection, walks: Collection[str], tested: Tested) -> WithoutLaw:
    """Of a selection; `walks`: the sensors that have a random walk."""
    owner: dict[str, str] = {}
    members: dict[str, tuple[str, ...]] = {}
    drifts = {cause.effect for cause in selection.named.causes}
    for number, sensor in enumerate(SENSORS):
        kinds = {test.kind for test in tested.of(sensor)}
        if sensor in walks and kinds <= set(OF_WALKS) and not carrying(tested, sensor):
            owner[sensor] = walk_name(number)
        elif kinds:
            owner[sensor] = f"{STRUCTURE}/{sensor}"
        elif drift_name(sensor) in drifts:
            owner[sensor] = drift_name(sensor)
        members[sensor] = tuple(dict.fromkeys(selection.consistent()[sensor]))
    structured = {
        sensor: min(test.p_value for test in tested.of(sensor))
        for sensor in SENSORS
        if tested.of(sensor)
    }
    return WithoutLaw(owner, structured, members)
