"""Gravity as stated, where the latitude that the gyros show is that at which it is right.

Beside a latitude that is wrong, a gravity that was measured differs from normal gravity, which then
takes its place before anything is estimated. Once the gyros show the true latitude and its normal
gravity is the stated one, within anomalies, the accelerometers are referred to the stated one
again. A mean at rest is M g up + b: so M (g used) is what the readings tell, and M becomes
M (g used / g stated), b stays. The sigmas stay too: they hold the anomalies, within which alone the
stated gravity is confirmed.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from math import hypot

from inertial.campaign.competition import ExplainedFindings
from inertial.campaign.explanations import is_of_wrong_place
from inertial.campaign.records import Known, Row
from inertial.physics.site import MIN_SIGMA, normal_gravity
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from stages.diagnosis.sensor_results import SensorResult

LATITUDE = "latitude_error"
STEP = 1e-3  # rad, over which normal gravity changes as its derivative says
CONDITION = _(
    "gravity is the stated {stated:.5f} m/s², which normal gravity at the latitude that the gyros "
    "show ({normal:.5f} ± {sigma:.5f} m/s²) confirms."
)
REASON = _(" M is referred to the stated gravity, {stated:.5f} m/s², not to that of a {latitude}.")


def restored(
    results: Sequence[SensorResult],
    explained: Sequence[ExplainedFindings],
    known: Mapping[str, Known],
) -> tuple[list[SensorResult], dict[str, str]]:
    """The results by the stated gravity, and by the finding of the latitude the condition."""
    conditions: dict[str, str] = {}
    for finding, repair in _replaced(explained):
        for by_gyros in (one for one in results if one.models({LATITUDE})):
            if condition := _condition(by_gyros, repair, known["latitude"].number):
                conditions[finding] = condition
                reason = REASON.format(stated=repair["stated"], latitude=in_words(LATITUDE))
                ratio = repair["value"] / repair["stated"]
                results = [_referred(one, by_gyros, ratio, reason) for one in results]
                break
    return list(results), conditions


def _replaced(explained: Sequence[ExplainedFindings]) -> Iterator[tuple[str, Row]]:
    """By the finding of a wrong latitude the repair that put its normal gravity in place."""
    for each in explained:
        for other in each.consequences:
            repair = other.repair
            if repair and repair["state"] == "applied" and is_of_wrong_place(each.cause, other):
                yield each.cause.id, repair


def _condition(result: SensorResult, repair: Row, latitude: float) -> str | None:
    """Of the stated gravity; None where the latitude found does not confirm it."""
    (row,) = (row for row in result.chosen.rows if row["effect"] == LATITUDE)
    if row["value"] is None or row["sigma"] is None:
        return None
    here, there = (normal_gravity(at, 0.0) for at in (latitude, latitude + row["value"]))
    beyond = normal_gravity(latitude + row["value"] + STEP, 0.0)
    normal = repair["value"] + there - here
    sigma = hypot(repair["sigma"], (beyond - there) / STEP * row["sigma"])
    if abs(repair["stated"] - normal) > MIN_SIGMA * sigma:
        return None
    return CONDITION.format(stated=repair["stated"], normal=normal, sigma=sigma)


def _referred(
    result: SensorResult, by_gyros: SensorResult, ratio: float, reason: str
) -> SensorResult:
    """The accelerometers of the mount with M larger by a ratio."""
    if result.sensor != "accel" or result.mount != by_gyros.mount:
        return result
    decision = replace(result.decision, reason=result.decision.reason + reason)
    return replace(result, chosen=result.chosen.with_matrix(ratio), decision=decision)
