"""The competition of findings: which are causes, and which are consequences of these."""

from collections import defaultdict
from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass, replace

from inertial.campaign.explanations import explains, rank
from inertial.campaign.hypotheses import MAX_CARRYING, MODEL, Hypothesis
from inertial.campaign.records import Row
from inertial.campaign.where_causes_act import JUMPS, RESTARTS

# What a recording shows of its circumstances: no fault; whether it matters follows from the model.
CIRCUMSTANCES = ("temperature_drift", "rests_divided", "turning_point_once")
MAX_WALK_P = 0.005  # as of all names together, of a random walk that is a cause and no mere noise


@dataclass(frozen=True)
class ExplainedFindings:
    """A cause, and the findings that are its consequences, its own among them."""

    cause: Hypothesis
    consequences: tuple[Hypothesis, ...]


def compete(hypotheses: Sequence[Hypothesis]) -> Iterator[ExplainedFindings]:
    """The causes: the hypotheses that none other explains, each with what it explains.

    A finding that several explain is the consequence of the one that explains most.
    """
    hypotheses = [h for h in hypotheses if h.cause not in CIRCUMSTANCES]
    touched: dict[object, set[str]] = defaultdict(set)
    for h in hypotheses:
        touched[_group(h)] |= h.manoeuvres
    explained = {
        h.id: [o for o in hypotheses if explains(h, o) and _reaches(h, o, touched[_group(h)])]
        for h in hypotheses
    }
    by_strength = sorted(hypotheses, key=lambda h: (len(explained[h.id]), rank(h)), reverse=True)
    owner: dict[str, str] = {}
    for cause in by_strength:
        for other in explained[cause.id]:
            if other.id not in owner and _root(cause.id, owner) != other.id:
                owner[other.id] = cause.id
    for root in (h for h in hypotheses if h.id not in owner):
        own = tuple(h for h in hypotheses if _root(h.id, owner) == root.id)
        if len(own) > 1 or not _is_noise(root):
            yield ExplainedFindings(_of_all_sensors(root, own), own)


def _of_all_sensors(root: Hypothesis, own: Sequence[Hypothesis]) -> Hypothesis:
    """A cause that changes the biases of both sensors at once concerns both."""
    others = [
        one for one in own if {root.cause, one.cause} in (JUMPS, RESTARTS) and one is not root
    ]
    if not others:
        return root
    members = (root.cause, *(one.cause for one in others))
    return replace(root, row={**root.row, "sensor": None, "axis": None}, members=members)


def _group(fault: Hypothesis) -> object:
    """What equal faults have in common."""
    return fault.stage, fault.cause, fault.mount, fault.sensor


def _reaches(cause: Hypothesis, structure: Hypothesis, touched: Set[str]) -> bool:
    """Whether faults touch all of the few manoeuvres that carry a structure of the residuals.

    One that no few carry is not of faults that touch few. `touched`: by all faults that are equal;
    none: all the log.
    """
    if structure.cause != "unknown_structure" or cause.stage == MODEL or not touched:
        return True
    if structure.manoeuvres:
        return structure.manoeuvres <= touched
    return len(touched) > MAX_CARRYING


def _is_noise(finding: Hypothesis) -> bool:
    """Whether it is a random walk at rest, or one that is not significant: a term of the noise.

    It is in the sigmas and among the terms of the noise; the result lacks nothing by it. Of
    severity 2 it is none of a sensor.
    """
    p_value = finding.row.get("p_value")
    walk = finding.cause.endswith("_random_walk") and not finding.members[1:]
    slight = finding.row["severity"] < 2
    return walk and slight and (p_value is None or p_value >= MAX_WALK_P)


def _root(finding: str, owner: dict[str, str]) -> str:
    while finding in owner:
        finding = owner[finding]
    return finding


def circumstances(findings: Sequence[Row]) -> Iterator[Row]:
    """Those of some findings that tell of circumstances, and are no fault."""
    return (row for row in findings if row["cause"] in CIRCUMSTANCES)
