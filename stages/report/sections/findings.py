"""What shows each cause: pictures, and the findings that are behind it."""

from __future__ import annotations

from collections.abc import Iterator

from inertial.campaign.competition import circumstances
from inertial.sensors import SINGULAR
from inertial.text.cause_names import in_words
from inertial.text.enumeration import listed
from inertial.text.messages import _
from inertial.text.numbers import fixed, probability, shortened, whole
from inertial.text.typography import capital
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
from stages.report.sizes import size_in_words
from stages.report.tables import Record, Tables, once

FINDINGS = (
    "quality_findings",
    "segment_findings",
    "noise_findings",
    "accelerometer_findings",
    "gyroscope_findings",
    "criticism_findings",
)
FINDING_TABLES = (
    *FINDINGS,
    "causes",
    "cause_members",
    "consequences",
    "verdict",
)
MODEL = "criticism"  # the stage whose findings are about the model, not about the recording
MOST_ROWS = 30  # findings of a cause that are listed
MOST_SHOWN = 4  # findings of a cause that have a picture
MOST_NAMES = 3  # members of a class in a title
MAX_HARMLESS_MOVE, MAX_MOVE = 0.5, 1.0  # sigma of a parameter
# Cures, that which asks most of the reader first.
CURES = ("repaired", "left_out", "modelled", "curve", "interpolated", "masked", "none")


@once
def causes(tables: Tables) -> list[Record]:
    """The causes: what spoils a result first, then by their cures, and what is harmless last."""
    return sorted(
        tables.rows("causes"),
        key=lambda row: (
            not spoils(tables, row),
            harmless(row),
            CURES.index(row["cure"]),
            -(row["moves"] or 0.0),
            row["id"],
        ),
    )


def spoils(tables: Tables, row: Record) -> bool:
    """Whether a cause that is not removed makes a result not usable."""
    if row["cure"] != "none":
        return False
    if row["moves"] is not None:
        return bool(row["moves"] > MAX_MOVE)
    lost = {each["sensor"] for each in tables.rows("verdict") if each["verdict"] == "not_usable"}
    return bool(lost) and row["sensor"] in (*lost, None)


def harmless(row: Record) -> bool:
    """Whether a cause needs no cure, for it moves no parameter of the result."""
    moves = row["moves"]
    return row["cure"] == "none" and moves is not None and bool(moves < MAX_HARMLESS_MOVE)


@once
def findings_by_id(tables: Tables) -> dict[str, Record]:
    """All findings by their identifiers, each with its stage."""
    return {
        row["id"]: row | {"stage": DECLARED.reads[name].stage}
        for name in FINDINGS
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


def in_recording(tables: Tables, cause: Record) -> bool:
    """Whether a finding of the recording shows a cause, so that it stands in this section."""
    return any(row["stage"] != MODEL for row in findings_of(tables, cause))


@once
def cause_of_finding(tables: Tables) -> dict[str, Record]:
    """By the identifier of a finding the cause that explains it."""
    by_id = {row["id"]: row for row in tables.rows("causes")}
    return {row["finding"]: by_id[row["cause"]] for row in tables.rows("consequences")}


def title_of(tables: Tables, row: Record) -> str:
    """What it is, its class, and where; equal ones in several places have no place."""
    names = [in_words(one["member"]) for one in members(tables, row)] or [in_words(row["cause"])]
    if len(names) > MOST_NAMES:
        names = [*names[: MOST_NAMES - 1], _("{count} others", count=len(names) - MOST_NAMES + 1)]
    name, where = listed(names, "or"), concerned(row)
    if row["sensor"] and SINGULAR[row["sensor"]] in name:
        where = _("{axis} axis", axis=row["axis"]) if row["axis"] else ""
    place = (row["manoeuvre"] or row["log"]) if row["count"] == 1 else None
    return _joined(capital(name), place, where)


def concerned(row: Record) -> str:
    """The sensor and the axis that a row is about."""
    sensor = SINGULAR.get(row["sensor"] or "", "")
    return f"{row['axis']} {sensor}" if row["axis"] and sensor else sensor


def _joined(*texts: str | None) -> str:
    return " · ".join(shortened(text, 120) for text in texts if text)


def members(tables: Tables, row: Record) -> list[Record]:
    """The members of its class, the most probable first; none where it is no class."""
    if row["verdict"] != "one_of_class":
        return []
    own = [each for each in tables.rows("cause_members") if each["cause"] == row["id"]]
    return sorted(own, key=lambda each: int(each["rank"]))


# ---- The section.


def parts(tables: Tables) -> Iterator[Part]:
    """For each cause what shows it, and the findings behind it."""
    rows = causes(tables)
    own = {row["id"]: findings_of(tables, row) for row in rows if in_recording(tables, row)}
    if not own:
        yield Paragraph(_("None: nothing is wrong in the recording and its segments."), "good")
    for row in circumstances(tables.rows("segment_findings")):
        yield Paragraph(f"{row['sentence']} {row['consequence']} {row['action']}")
    shown = evidence(tables, [each for found in own.values() for each in found[:MOST_SHOWN]])
    for row in (row for row in rows if row["id"] in own):
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
        columns("text", _("Finding"), _("Where"))
        + columns("number", _("Time"), _("Size"), _("Times"), "p")
        + columns("identifier", _("Identifier")),
        [
            table_row(
                capital(in_words(row["cause"])),
                _joined(row["manoeuvre"] or row["log"], concerned(row)),
                _time(row) or "—",
                size_in_words(row) or "—",
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
    _("The pictures and the findings behind each cause of section 2."),
    _(
        "Left, the whole log, where a wedge marks the place; right, the samples there. p is the "
        "probability of such a size if nothing is wrong; what concerns the model alone stands "
        "in “What shows each effect”."
    ),
    (
        *FINDING_TABLES,
        *("campaign", "known", "manoeuvres", "performed", "clocks", "segments", "traces"),
        *("plan_repairs", "gaps", "masks", "quality_close_ups", "segment_close_ups"),
    ),
    parts,
)


def _time(row: Record) -> str | None:
    start, end = row["from_s"], row["to_s"]
    if start is None:
        return None
    if end is None or end == start:
        return f"{fixed(start, 2)} s"
    return f"{fixed(start, 2)} … {fixed(end, 2)} s"
