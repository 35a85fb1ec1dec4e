"""What shows each cause: pictures, and the findings that are behind it."""

from __future__ import annotations

from collections.abc import Iterator

from inertial.text.cause_names import in_words
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, probability, shortened, significant, whole
from stages.report.declared import DECLARED
from stages.report.outline import (
    Figure,
    Heading,
    Paragraph,
    Part,
    Section,
    Table,
    columns,
    more,
    table_row,
)
from stages.report.sections.evidence import evidence
from stages.report.tables import Record, Tables, once
from stages.report.words import capital, listed

FINDING_TABLES = (
    "quality_findings",
    "segment_findings",
    "accelerometer_findings",
    "criticism_findings",
    "causes",
    "cause_members",
    "consequences",
)
MODEL = "criticism"  # the stage whose findings are about the model, not about the recording
MOST_ROWS = 30  # findings of a cause that are listed
MOST_SHOWN = 4  # findings of a cause that have a picture
MOST_NAMES = 8  # members of a class
# Cures, that which leaves most to be done first.
CURES = ("none", "left_out", "repaired", "modelled", "interpolated", "masked")
COUNTED = frozenset({"samples", "records", "readings", "days"})  # units of sizes that are counts
SENSOR = {"accel": _("accelerometer"), "gyro": _("gyroscope")}


@once
def causes(tables: Tables) -> list[Record]:
    """The causes, those that are not removed first, then by how far they move the result."""
    return sorted(
        tables.rows("causes"),
        key=lambda row: (CURES.index(row["cure"]), -(row["moves"] or 0.0), row["id"]),
    )


@once
def findings_by_id(tables: Tables) -> dict[str, Record]:
    """All findings by their identifiers, each with its stage."""
    return {
        row["id"]: row | {"stage": DECLARED.reads[name].stage}
        for name in FINDING_TABLES[:4]
        for row in tables.rows(name)
    }


def findings_of(tables: Tables, cause: Record) -> list[Record]:
    """The findings that a cause explains, its own first, then the worst."""
    every = findings_by_id(tables)
    own = [row["finding"] for row in tables.rows("consequences") if row["cause"] == cause["id"]]
    rows = [every[finding] for finding in own if finding in every]
    return sorted(
        rows, key=lambda row: (row["cause"] != cause["cause"], -row["severity"], -row["count"])
    )


@once
def cause_of_finding(tables: Tables) -> dict[str, Record]:
    """By the identifier of a finding the cause that explains it."""
    by_id = {row["id"]: row for row in tables.rows("causes")}
    return {row["finding"]: by_id[row["cause"]] for row in tables.rows("consequences")}


def title_of(tables: Tables, row: Record) -> str:
    """What it is, its class, and where."""
    names = members(tables, row)
    name = listed([in_words(one) for one in names or [row["cause"]]], "or")
    sensor = {"gyro": _("gyroscope"), "accel": _("accelerometer")}.get(row["sensor"] or "", "")
    concerned = f"{row['axis']} {sensor}" if row["axis"] and sensor else sensor
    places = [shortened(text, 60) for text in (row["manoeuvre"] or row["log"], concerned) if text]
    return " · ".join([capital(name), *places])


def members(tables: Tables, row: Record) -> list[str]:
    """The members of its class, the most probable first; none where it is no class."""
    if row["verdict"] != "one_of_class":
        return []
    own = [each for each in tables.rows("cause_members") if each["cause"] == row["id"]]
    return [each["member"] for each in sorted(own, key=lambda each: each["rank"])][:MOST_NAMES]


# ---- The section.


def parts(tables: Tables) -> Iterator[Part]:
    """For each cause what shows it, and the findings behind it."""
    rows = causes(tables)
    if not rows:
        yield Paragraph(
            _("None: neither in the recording, nor in its segments, nor in the model."), "good"
        )
        return
    own = {row["id"]: findings_of(tables, row) for row in rows}
    shown = evidence(tables, [each for found in own.values() for each in found[:MOST_SHOWN]])
    for row in rows:
        yield Heading(title_of(tables, row), f"evidence/{row['id']}")
        for finding in own[row["id"]][:MOST_SHOWN]:
            yield from _shown(finding, shown)
        yield _table(own[row["id"]])


def _shown(finding: Record, shown: dict[str, list[Figure | Table]]) -> Iterator[Part]:
    if finding["stage"] != MODEL:  # its own section shows it
        yield from shown[finding["id"]]


def _table(findings: list[Record]) -> Table:
    return Table(
        _("The findings behind it."),
        columns("text", "Finding", "Where")
        + columns("number", "Time", "Size", "Times", "p")
        + columns("identifier", "Identifier"),
        [
            table_row(
                capital(in_words(row["cause"])),
                _where(row),
                _time(row) or "—",
                _size(row) or "—",
                whole(row["count"]),
                "—" if row["p_value"] is None else probability(row["p_value"]),
                row["id"],
            )
            for row in findings[:MOST_ROWS]
        ],
        note=more(len(findings) - MOST_ROWS, _(" in the tables of findings")),
    )


SECTION = Section(
    "findings",
    _("What shows each cause"),
    _("The pictures and the findings behind each cause of page one."),
    _(
        "Left, the whole log, where a wedge marks the place; right, the samples there. p is the "
        "probability of such a size if nothing is wrong. What concerns the model has its figures "
        "in “Unmodelled effects”."
    ),
    (
        *FINDING_TABLES,
        *("campaign", "known", "manoeuvres", "performed", "clocks", "segments", "traces"),
        *("gaps", "masks", "quality_close_ups", "segment_close_ups"),
    ),
    parts,
)


def _where(row: Record) -> str:
    sensor = SENSOR.get(row["sensor"] or "", "")
    concerned = f"{row['axis']} {sensor}" if row["axis"] and sensor else sensor
    places = (row["manoeuvre"] or row["log"], concerned)
    return " · ".join(shortened(text, 60) for text in places if text)


def _time(row: Record) -> str | None:
    start, end = row["from_s"], row["to_s"]
    if start is None:
        return None
    if end is None or end == start:
        return f"{fixed(start, 2)} s"
    return f"{fixed(start, 2)} … {fixed(end, 2)} s"


def _size(row: Record) -> str | None:
    if row["size"] is None:
        return None
    if row["unit"] in COUNTED:
        return counted(round(row["size"]), row["unit"].removesuffix("s"))
    size = f"{significant(row['size'])} {row['unit'] or ''}".strip().replace(" °", "°")
    return size.removesuffix(" 1")
