"""The result that counts against the tolerances of the campaign."""

from collections.abc import Collection, Iterator, Sequence

from inertial.campaign.records import Row, with_mount
from inertial.estimation.conformity import decision
from inertial.text.parameters import PARTS

NOT_ASSESSED = {"statement": "not_assessed", "risk": None}


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
