"""Whether the parameters conform to stated tolerances, part of the certificate."""

from collections.abc import Iterator, Sequence

from inertial.campaign.records import grouped
from inertial.sensors import SINGULAR
from inertial.text import numbers
from inertial.text.messages import _
from inertial.text.statements import RULES, STATEMENTS
from inertial.text.typography import capital
from stages.report.outline import Column, Heading, Paragraph, Part, Row, Table, columns, table_row
from stages.report.results import KIND_IN_A_SENTENCE, kind_of, quantity_of, symbol
from stages.report.tables import Record, Tables

MIN_RISK = 1e-4  # of a false statement; of a smaller one only that is said


def conformity(tables: Tables) -> Iterator[Part]:
    """A row for each sensor and kind, by its worst parameter; or that nothing is assessed."""
    yield Heading(_("Conformity"))
    rows = tables.rows("conformity")
    if not rows:
        yield Paragraph(_("Not assessed: no tolerances are stated."))
        return
    groups = grouped(rows, lambda row: (row["mount"], row["sensor"], kind_of(row["quantity"])))
    yield Table(
        _("Decision rule: {rule}.", rule=RULES[rows[0]["decision_rule"]]),
        (
            *columns("text", _("Parameters"), _("Statement")),
            Column(_("limit ±"), "number"),
            Column(_("unit"), "unit"),
            Column(_("probability of a false statement, by U"), "number"),
        ),
        [_assessed(key, groups[key]) for key in sorted(groups, key=_in_order)],
    )


def _in_order(key: tuple[str, str, str]) -> tuple[str, str, int]:
    return key[0], key[1], list(KIND_IN_A_SENTENCE).index(key[2])


def _assessed(key: tuple[str, str, str], rows: Sequence[Record]) -> Row:
    mount, sensor, kind = key
    unit = quantity_of({"parameter": rows[0]["quantity"], "unit": rows[0]["unit"]}).shown
    each: dict[str, list[str]] = {}
    for row in rows:
        each.setdefault(row["statement"], []).append(symbol(row["quantity"]))
    said = [
        STATEMENTS[one] if len(each) == 1 else f"{STATEMENTS[one]}: {', '.join(each[one])}"
        for one in STATEMENTS
        if one in each
    ]
    risks = [row["risk"] for row in rows if row["risk"] is not None]
    name = f"{capital(SINGULAR[sensor])}, {KIND_IN_A_SENTENCE[kind]}" + (
        f" ({mount})" if mount else ""
    )
    tone = "" if set(each) == {"conforms"} else "poor" if "does_not_conform" in each else "fair"
    return table_row(
        name,
        capital("; ".join(said)),
        numbers.significant(unit.of(rows[0]["limit"]), 3),
        unit.name,
        _risk(max(risks)) if risks else "—",
        tone=tone,  # type: ignore[arg-type]
    )


def _risk(risk: float) -> str:
    """In per cent; far out in the tails U is not known to be that of a Gaussian."""
    if risk < MIN_RISK:
        return f"< {numbers.significant(100 * MIN_RISK, 1)} %"
    return f"{numbers.significant(100 * risk, 2)} %"
