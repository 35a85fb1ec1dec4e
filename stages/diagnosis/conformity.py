"""The result that counts against the tolerances of the campaign, |truth| ≤ T (JCGM 106:2012).

The estimate is y ± σ. Both rules are binary acceptance on the measured value: simple acceptance
takes the tolerance itself as the acceptance interval (8.2), the guarded one narrows it by w = U = 2
σ (8.3.2, ISO 14253-1). A guarded rejection widens it as much, and between both nothing is shown.
Errors are normal, nothing else is known of the parameter, so P(truth ≤ x) = Φ((x − y)/σ).
"""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from scipy.stats import norm

from inertial.campaign.records import Row, with_mount
from inertial.text.parameters import PARTS
from inertial.text.units import COVERAGE_FACTOR

GUARD_BAND, SIMPLE_ACCEPTANCE = "guard_band", "simple_acceptance"
CONFORMS, DOES_NOT_CONFORM, NOT_SHOWN = "conforms", "does_not_conform", "not_shown"
NOT_ASSESSED = {"statement": "not_assessed", "risk": None}


@dataclass(frozen=True)
class Decision:
    """A statement, and the probability that it is wrong; none where nothing is shown."""

    statement: str
    risk: float | None


def decision(value: float, sigma: float, limit: float, rule: str) -> Decision:
    """The statement on |truth| ≤ limit, all in one unit; the limit is positive."""
    guard = COVERAGE_FACTOR * sigma if rule == GUARD_BAND else 0.0
    outside = float(norm.sf((limit - value) / sigma) + norm.cdf((-limit - value) / sigma))
    if abs(value) <= limit - guard:
        return Decision(CONFORMS, outside)
    if abs(value) > limit + guard:
        return Decision(DOES_NOT_CONFORM, 1 - outside)
    return Decision(NOT_SHOWN, None)


def conformity_rows(
    result: Sequence[Row], tolerances: Sequence[Row], unusable: Collection[tuple[str, str]]
) -> Iterator[Row]:
    """A row for each parameter that has a limit, without a value too.

    `unusable`: sensor and mount of results that are not to be used; of these nothing conforms.
    """
    limits = {(row["sensor"], row["kind"]): row for row in tolerances}
    for row in result:
        part = None if row["effect"] else PARTS.get(row["parameter"])
        limit = limits.get((row["sensor"], part.kind)) if part else None
        if limit is None:
            continue
        given: Row = dict(NOT_ASSESSED)
        known = row["value"] is not None and row["sigma"]
        if known and (row["sensor"], row["mount"]) not in unusable:
            made = decision(row["value"], row["sigma"], limit["limit"], limit["decision_rule"])
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
