"""The result that counts against the tolerances of the campaign, |truth| ≤ T (JCGM 106:2012).

The estimate is y ± σ. Both rules are binary acceptance on the measured value: simple acceptance
takes the tolerance itself as the acceptance interval (8.2), the guarded one narrows it by w = U = 2
σ (8.3.2, ISO 14253-1). A guarded rejection widens it as much, and between both nothing is shown.
Errors are normal, nothing else is known of the parameter, so P(truth ≤ x) = Φ((x − y)/σ). A bias or
a scale factor that jumps is judged before and after: an instrument leaves with what it has then.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import sqrt

from inertial.campaign.records import Row, with_mount
from inertial.estimation.probability import norm_sf
from inertial.text.parameters import PARTS
from inertial.text.units import COVERAGE_FACTOR

GUARD_BAND, SIMPLE_ACCEPTANCE = "guard_band", "simple_acceptance"
CONFORMS, DOES_NOT_CONFORM, NOT_SHOWN = "conforms", "does_not_conform", "not_shown"
NOT_ASSESSED = {"statement": "not_assessed", "risk": None}
WORST = (CONFORMS, NOT_SHOWN, DOES_NOT_CONFORM)  # the worst last
JUMPS = {"bias": "{sensor}_bias_jump.b_{axis}", "scale": "{sensor}_scale_jump.k_{axis}"}
Covariance = Mapping[tuple[str, str], float]  # by the ids of two parameters


@dataclass(frozen=True)
class Decision:
    """A statement, and the probability that it is wrong; none where nothing is shown."""

    statement: str
    risk: float | None


def decision(value: float, sigma: float, limit: float, rule: str) -> Decision:
    """The statement on |truth| ≤ limit, all in one unit; the limit is positive."""
    guard = COVERAGE_FACTOR * sigma if rule == GUARD_BAND else 0.0
    outside = float(norm_sf((limit - value) / sigma) + norm_sf((limit + value) / sigma))
    if abs(value) <= limit - guard:
        return Decision(CONFORMS, outside)
    if abs(value) > limit + guard:
        return Decision(DOES_NOT_CONFORM, 1 - outside)
    return Decision(NOT_SHOWN, None)


def worse(one: Decision, other: Decision) -> Decision:
    """The worse of two; of two alike the one that is more probably false."""
    return max(one, other, key=lambda each: (WORST.index(each.statement), each.risk or 0.0))


def conformity_rows(
    result: Sequence[Row],
    tolerances: Sequence[Row],
    unusable: Collection[tuple[str, str]],
    covariance: Covariance,
) -> Iterator[Row]:
    """A row for each parameter that has a limit, without a value too.

    `unusable`: sensor and mount of results that are not to be used; of these nothing conforms.
    """
    jumps = {(row["mount"], row["parameter"]): row for row in result if row["effect"]}
    limits = {(row["sensor"], row["kind"]): row for row in tolerances}
    for row in result:
        part = None if row["effect"] else PARTS.get(row["parameter"])
        if part is None or (row["sensor"], part.kind) not in limits:
            continue
        limit = limits[row["sensor"], part.kind]
        given: Row = dict(NOT_ASSESSED)
        known = row["value"] is not None and row["sigma"]
        if known and (row["sensor"], row["mount"]) not in unusable:
            name = JUMPS.get(limit["kind"], "").format(sensor=row["sensor"], axis=part.axes)
            made = _decided(row, jumps.get((row["mount"], name)), limit, covariance)
            given = {"statement": made.statement, "risk": made.risk}
        place = with_mount("diagnosis/conformity", row["mount"])
        yield {
            "id": f"{place}/{row['sensor']}/{row['parameter']}",
            "mount": row["mount"],
            "sensor": row["sensor"],
            "quantity": row["parameter"],
            **{key: limit[key] for key in ("limit", "unit", "decision_rule")},
            **given,
        }


def _decided(row: Row, jump: Row | None, limit: Row, covariance: Covariance) -> Decision:
    """Of a parameter, and of what it is after it has jumped."""
    before = decision(row["value"], row["sigma"], limit["limit"], limit["decision_rule"])
    if jump is None or jump["value"] is None or jump["sigma"] is None:
        return before
    common = covariance.get((row["id"], jump["id"]), covariance.get((jump["id"], row["id"]), 0.0))
    sigma = sqrt(max(row["sigma"] ** 2 + jump["sigma"] ** 2 + 2 * common, 0.0))
    after = row["value"] + jump["value"]
    return worse(before, decision(after, sigma, limit["limit"], limit["decision_rule"]))
