"""The values of a certificate with their expanded uncertainty, and how they changed."""

from collections.abc import Iterator, Mapping, Sequence

from inertial.campaign.records import grouped
from inertial.sensors import PLURAL, SINGULAR
from inertial.tables import BODY
from inertial.text import numbers
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from inertial.text.statements import RULES, STATEMENTS
from inertial.text.typography import capital
from inertial.text.units import COVERAGE_FACTOR, Unit
from stages.report.outline import (
    Column,
    Heading,
    Paragraph,
    Part,
    Row,
    Table,
    Traced,
    columns,
    head,
    table_row,
)
from stages.report.results import (
    KIND_IN_A_SENTENCE,
    Estimate,
    kind_of,
    quantity_of,
    symbol,
)
from stages.report.sections.effect_terms import equation, with_scanned_sigmas, without_sigma
from stages.report.sections.findings import members
from stages.report.tables import Record, Tables, once
from stages.report.words import term

NOT_USABLE = "not_usable"  # the verdict


def frame_of(results: Sequence[Estimate]) -> str:
    """The frame of the results: by hand nothing tells the axes of the case."""
    frames = (row["frame"] for one in results for row in one.parameters if row["frame"])
    return str(next(frames, BODY))


def values(results: Sequence[Estimate], mount: str, earlier: Mapping[str, Record]) -> Table:
    """The twelve parameters of each sensor side by side, in the order of the first."""
    sensors = [result.sensor for result in results]
    names = list(dict.fromkeys(n for one in results for n in map(_name, one.parameters)))
    by_sensor = [{_name(row): row for row in one.parameters} for one in results]
    written = [_with_uncertainty(list(own.values())) for own in by_sensor]
    rows: list[Row] = []
    for name in names:
        cells = [symbol(name)]
        for own, texts in zip(by_sensor, written, strict=True):
            cells += [*texts.get(name, ("—", "—", ""))]
            if earlier:
                cells.append(_change(own.get(name), earlier))
        rows.append(table_row(*cells))
    extra = [Column(_("change"), "number")] if earlier else []
    return Table(
        _(
            "Bias b, scale error s and cross-axis terms m{mount}, frame: {frame}; index ij: "
            "response of sensor i to an input along axis j. U: expanded uncertainty, k = 2, about "
            "95 %.",
            mount=_(", mount {mount}", mount=mount) if mount else "",
            frame=term(frame_of(results)),
        ),
        (
            Column(_("symbol"), "symbol"),
            *(
                Column(column.heading, column.kind, sensor)
                for sensor in sensors
                for column in (
                    Column(_("value"), "number"),
                    Column("± U", "sigma"),
                    Column(_("unit"), "unit"),
                    *extra,
                )
            ),
        ),
        rows,
        _("None: no parameter was determined."),
        _("—: not determined; “Undetermined parameters” says why.")
        if any(len(texts) < len(names) for texts in written)
        else "",
    )


def _name(row: Record) -> str:
    return str(row["parameter"])


def _with_uncertainty(rows: Sequence[Record]) -> dict[str, tuple[str, str, str]]:
    """Value, U and unit of each, to two digits of its U."""
    written: dict[str, tuple[str, str, str]] = {}
    for row in rows:
        if row["value"] is not None:
            unit = quantity_of(row).shown
            value, spread = _pair(row, unit)
            written[_name(row)] = (Traced(value, row["id"]), spread, unit.name)
    return written


def _pair(row: Record, unit: Unit) -> tuple[str, str]:
    spread = _expanded(row, unit)
    return numbers.with_own_sigma(unit.of(row["value"]), spread)


def _expanded(row: Record, unit: Unit) -> float | None:
    return None if row["sigma"] is None else unit.of(COVERAGE_FACTOR * row["sigma"])


def of_classes(tables: Tables) -> Mapping[str, int]:
    """The effects that are a member of a class, each with how many members that has."""
    classes = [members(tables, row) for row in tables.rows("causes")]
    return {each["member"]: len(own) for own in classes for each in own}


def further_terms(
    rows: Sequence[Record], classes: Mapping[str, int], detected: Sequence[Record] = ()
) -> Table:
    """The parameters of effects, by effect and, where both show it, by sensor.

    `classes`: see `of_classes`; `detected`: see `with_scanned_sigmas`.
    """
    rows = with_scanned_sigmas(rows, detected)
    lines: list[Row] = []
    by_place = grouped(rows, lambda row: (row["effect"], row["sensor"]))
    for (effect, sensor), own in by_place.items():
        heading = capital(in_words(effect))
        if sum(other == effect for other, _sensor in by_place) > 1:
            heading = _("{effect}, from the {sensors}", effect=heading, sensors=PLURAL[sensor])
        if count := classes.get(effect):
            heading = _(
                "{effect}: one of {count} effects that these data do not distinguish (section 2)",
                effect=heading,
                count=count,
            )
        lines.append(head(heading + equation(effect, own)))
        for row in own:
            if row["value"] is not None:
                unit = quantity_of(row).shown
                value, spread = _pair(row, unit)
                cells = (Traced(value, row["id"]), spread, unit.name, row["meaning"])
                lines.append(table_row(symbol(row["parameter"]), *cells))
    return Table(
        _(
            "Further terms of the measurement model, estimated together with the parameters above. "
            "Use all of them together, but do not subtract from readings the terms that the table, "
            "the site or the mounting causes, or a law of unknown cause; the finding says which "
            "these are."
        ),
        (
            Column(_("symbol"), "symbol"),
            Column(_("value"), "number"),
            Column("± U", "sigma"),
            Column(_("unit"), "unit"),
            Column(_("meaning"), "note"),
        ),
        lines,
        note=" ".join(
            [*without_sigma(rows)]
            + [_("Where a parameter depends on the temperature, the value above is that at T0.")]
            * any(symbol(row["parameter"]) == "T0" for row in rows)
        ),
    )


# ---- The last calibration before this one.


@once
def earlier_values(tables: Tables) -> Mapping[str, Record]:
    """The parameters of the latest earlier calibration that is usable, by sensor, mount, name."""
    dated = [row for row in tables.rows("earlier") if row["date"][:1].isdigit()]
    rows = [row for row in dated if row["verdict"] != NOT_USABLE]
    latest = max(((row["date"], row["file"]) for row in rows), default=None)
    return {
        _key(row["sensor"], row["mount"], row["quantity"]): row
        for row in rows
        if (row["date"], row["file"]) == latest
    }


def _key(sensor: str, mount: str, quantity: str) -> str:
    return f"{sensor}@{mount}/{quantity}"


def _change(row: Record | None, earlier: Mapping[str, Record]) -> str:
    if row is None or row["value"] is None:
        return "—"
    before = earlier.get(_key(row["sensor"], row["mount"], row["parameter"]))
    if before is None:
        return "—"
    unit = quantity_of(row).shown
    decimals = numbers.decimals_of(_expanded(row, unit))
    change = unit.of(row["value"] - before["value"])
    text = numbers.significant(change, 2) if decimals is None else numbers.fixed(change, decimals)
    return text if text.startswith("−") else f"+{text}"


# ---- Whether the parameters conform to stated tolerances, part of the certificate.

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
