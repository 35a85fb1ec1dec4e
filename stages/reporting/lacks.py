"""What the model lacks: effects that the data ask for, and those that stayed out of sight."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from stages.reporting import blind_spots, cause, extended, extended_parameters, structures
from stages.reporting.certainty import clearest_first, in_short, others_of
from stages.reporting.criticised import Criticised
from stages.reporting.mounts import mount_of
from stages.reporting.outline import Heading, Link, Paragraph, Part, Section
from stages.reporting.parameters import Estimate
from stages.reporting.rows import Record
from stages.reporting.sought import Sought

COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


def section(
    found: Sequence[Record],
    sought: Sequence[Sought],
    model: Criticised,
    blind: Sequence[Record],
    extended_rows: Sequence[Record],
    joint: Sequence[Estimate],
    links: Mapping[str, Sequence[Link]],
) -> Section:
    """A block for each finding of criticism, the tests of structure, and the blind spots.

    `found`: the findings; `blind`: the table of blind spots; `links`: by finding, to others that
    speak of the same thing.
    """
    rows = clearest_first(found)
    parts: list[Part] = [_summary(rows, sought)]
    parts += extended.paragraphs(model.decision)
    silent = [one for one in model.structures if one["fires"]] == []
    if silent:
        parts += structures.tests(model.structures)
    parts += cause.causes(rows, links, model)
    if not silent:
        parts += structures.tests(model.structures)
    parts += extended_parameters.parts(extended_rows, joint)
    missed = list(_missed(rows, sought))
    if missed:
        parts.append(Heading("Looked for and not found: the blind spots"))
        parts += blind_spots.tables(blind, missed)
    return Section(
        "lacks",
        "What the model lacks",
        "Physical effects beyond bias, scale and cross-axis terms that the data ask for; how sure "
        "that is, what it does and what to do; and how small an effect would still have been seen.",
        "The clearest comes first. Found: noise alone would hardly ever ask for it, and no other "
        "effect does the same. One of a class: others do the same to these data. Consistent: the "
        "name is not certain. χ² falls on the data that were fitted, and on data that were not: "
        "each manoeuvre foretold from the others, with and without the effects; an effect that "
        "only fits noise gains nothing there. At stake is what exactly known effects would bring.",
        parts,
    )


def _missed(rows: Sequence[Record], sought: Sequence[Sought]) -> Iterator[Sought]:
    """The effects that no finding is about, nor may be instead."""
    told = {(name, mount_of(row["id"])) for row in rows for name in (row["cause"], *others_of(row))}
    for one in sought:
        if (one.score["effect"], one.mount) not in told:
            yield one


def _summary(rows: Sequence[Record], sought: Sequence[Sought]) -> Paragraph:
    if said := list(in_short(rows)):
        return Paragraph(" ".join(said), "fair")
    if not sought:
        return Paragraph("None was looked for: the joint fits give no model to criticise.", "fair")
    every = len({one.score["effect"] for one in sought})
    shown = len({one.score["effect"] for one in sought if one.score["degrees"]})
    if not shown:
        return Paragraph(f"This plan can show none of the {_counted(every)} effects.", "fair")
    if shown == every:
        which = f"none of the {_counted(every)} effects is needed"
    else:
        which = (
            f"none of the {_counted(shown)} effects that this plan can show is needed; "
            f"{_counted(every - shown)} it cannot show"
        )
    return Paragraph(f"Nothing is missing: {which}.", "good")


def _counted(count: int) -> str:
    return COUNTS[count] if count < len(COUNTS) else str(count)
