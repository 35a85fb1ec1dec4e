"""Gravity at the latitude that the gyros show, where the stated one is wrong.

A gravity that was taken from a wrong latitude is wrong, too, and the accelerometers are referred
to the right one. That is a stated gravity which normal gravity at the latitude found confirms,
within anomalies, and which normal gravity of the wrong one had replaced; else normal gravity at the
latitude found: where none was stated, or where the stated one is no gravity of that latitude. A
mean at rest is M g up + b: so M (g used) is what the readings tell, M becomes M (g used / g), and b
stays.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import hypot

from inertial.campaign.competition import ExplainedFindings
from inertial.campaign.explanations import is_of_wrong_place
from inertial.campaign.records import Known, Row
from inertial.physics.site import ANOMALY_SIGMA, MIN_SIGMA, normal_gravity
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from stages.diagnosis.sensor_results import SensorResult

LATITUDE = "latitude_error"
MIN_MOVE = 0.5  # sigma of a scale factor: less is harmless
STEP = 1e-3  # rad, over which normal gravity changes as its derivative says
AS_STATED = (
    _(
        "gravity is the stated {gravity:.5f} m/s², which normal gravity at the latitude that the "
        "gyros show ({normal:.5f} ± {sigma:.5f} m/s²) confirms."
    ),
    _(" M is referred to the stated gravity, {gravity:.5f} m/s², not to that of a {latitude}."),
)
AS_FOUND = (
    _(
        "gravity is normal gravity at the latitude that the gyros show, {normal:.5f} ± {sigma:.5f} "
        "m/s², and not {used:.5f} m/s², which is that of another latitude."
    ),
    _(
        " M is referred to normal gravity at the latitude that the gyros show, {gravity:.5f} m/s², "
        "and not to {used:.5f} m/s²."
    ),
)


@dataclass(frozen=True)
class Gravity:
    """The gravity that a result is referred to, m/s², in place of the one that was used.

    sigma : m/s², by which that is less well known than the results have it
    condition, reason : sentences; moved : by how many sigma it moves a scale factor
    """

    value: float
    used: float
    sigma: float
    condition: str
    reason: str
    moved: float


def referred(
    results: Sequence[SensorResult],
    explained: Sequence[ExplainedFindings],
    known: Mapping[str, Known],
) -> tuple[list[SensorResult], dict[str, Gravity]]:
    """The results by the right gravity, and this by the finding of the wrong latitude."""
    found: dict[str, Gravity] = {}
    for each in explained:
        if not each.cause.named or each.cause.cause != LATITUDE:
            continue
        repair = _replaced(each)
        for by_gyros in (one for one in results if one.models({LATITUDE})):
            own = [one for one in results if _same_mount(one, by_gyros)]
            gravity = _gravity(by_gyros, own, repair, known)
            if gravity is not None:
                found[each.cause.id] = gravity
                results = [_referred(one, gravity) if one in own else one for one in results]
                break
    return list(results), found


def _replaced(explained: ExplainedFindings) -> Row | None:
    """The repair that put normal gravity of the wrong latitude in the place of a stated one."""
    repairs: Iterator[Row] = (
        other.repair
        for other in explained.consequences
        if other.repair is not None and is_of_wrong_place(explained.cause, other)
    )
    return next((repair for repair in repairs if repair["state"] == "applied"), None)


def _same_mount(result: SensorResult, by_gyros: SensorResult) -> bool:
    return result.sensor == "accel" and result.mount == by_gyros.mount


def _gravity(
    by_gyros: SensorResult,
    own: Sequence[SensorResult],
    repair: Row | None,
    known: Mapping[str, Known],
) -> Gravity | None:
    """None where the one that was used holds at the latitude found, too."""
    (row,) = (row for row in by_gyros.chosen.rows if row["effect"] == LATITUDE)
    scale_sigma = min((one.scale_sigma or 0.0 for one in own), default=0.0)
    if row["value"] is None or row["sigma"] is None or not scale_sigma:
        return None
    latitude, taken = known["latitude"].number, known["gravity"]
    here, there, beyond = (
        normal_gravity(latitude + shift, 0.0) for shift in (0.0, row["value"], row["value"] + STEP)
    )
    normal = taken.number + there - here
    of_latitude = abs(beyond - there) / STEP * row["sigma"]
    measured = repair is None and (taken.sigma or 0.0) < ANOMALY_SIGMA
    sigma = hypot(of_latitude, max(taken.sigma or 0.0, ANOMALY_SIGMA))
    value, more, sentences = normal, sigma if measured else of_latitude, AS_FOUND
    if measured and abs(taken.number - normal) < MIN_SIGMA * sigma:
        return None
    if repair is not None and abs(repair["stated"] - normal) < MIN_SIGMA * sigma:
        value, more, sentences = repair["stated"], 0.0, AS_STATED
    moved = abs(taken.number / value - 1) / scale_sigma
    if moved < MIN_MOVE:
        return None
    condition, reason = (
        sentence.format(
            gravity=value,
            normal=normal,
            sigma=sigma,
            used=taken.number,
            latitude=in_words(LATITUDE),
        )
        for sentence in sentences
    )
    return Gravity(value, taken.number, more, condition, reason, moved)


def _referred(result: SensorResult, gravity: Gravity) -> SensorResult:
    decision = replace(result.decision, reason=result.decision.reason + gravity.reason)
    chosen = result.chosen.with_matrix(gravity.used / gravity.value, gravity.sigma / gravity.value)
    return replace(result, chosen=chosen, decision=decision)
