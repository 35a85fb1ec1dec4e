"""How sure criticism is of what it found, in words: found, one of a class, consistent, no name."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal

from inertial.text import numbers
from inertial.text.cause_names import in_words
from stages.reporting.mounts import mount_of
from stages.reporting.rows import Record

Kind = Literal["found", "class", "structure", "consistent", "walk", "unexplained"]
CLEAREST_FIRST: tuple[Kind, ...] = (
    "found",
    "class",
    "structure",
    "consistent",
    "walk",
    "unexplained",
)
_GRADE: dict[Kind, str] = {
    "found": "found",
    "class": "one of a class",
    "structure": "a structure without a name",
    "consistent": "consistent with it, and no more",
    "walk": "consistent with it, and no more",
    "unexplained": "not explained",
}
SENSORS = {"gyro": "gyros", "accel": "accelerometers"}
STRUCTURE = "unknown_structure"
MOST_MEMBERS = 8


def kind_of(row: Record) -> Kind:
    """Of what kind a finding of criticism is."""
    if row["cause"] == "unexplained":
        return "unexplained"
    if row["cause"].endswith("_random_walk"):
        return "walk"
    if row["cause"] == STRUCTURE:
        return "structure"
    verdicts: dict[str, Kind] = {"found": "found", "one_of_class": "class"}
    return verdicts.get(row.get("verdict") or "", "consistent")


def grade(row: Record) -> str:
    """The verdict in a few words."""
    return _GRADE["class" if _walk_of_a_class(row) else kind_of(row)]


def _walk_of_a_class(row: Record) -> bool:
    """Whether effects are known that a walk may be instead."""
    return kind_of(row) == "walk" and bool(others_of(row))


def clearest_first(rows: Sequence[Record]) -> list[Record]:
    """Findings of criticism: what is found, then what is less sure; within, what is clearer."""
    return sorted(
        rows,
        key=lambda row: (
            CLEAREST_FIRST.index(kind_of(row)),
            -(row.get("snr") or 0.0),
            row["id"],
        ),
    )


def name_of(row: Record) -> str:
    """What was found, in words, with its mount where there are several."""
    kind, sensors = kind_of(row), SENSORS.get(row["sensor"] or "", "")
    name = in_words(row["cause"])
    if sensors and kind == "structure":
        name = f"structure without a name in the {sensors}"
    if sensors and kind == "unexplained":
        name = f"residuals of the {sensors} that nothing explains"
    mount = mount_of(row["id"])
    return name + (f" (mount {numbers.shortened(mount, 60)})" if mount else "")


def others_of(row: Record) -> list[str]:
    """The effects that it may be instead, by name in the catalogue."""
    members = (row.get("members") or "").split(", ")
    return [name for name in members if name and name != row["cause"]][:MOST_MEMBERS]


def how_sure(row: Record) -> str:
    """The verdict in words, and how far it stands out of the noise."""
    names = [in_words(name) for name in (row["cause"], *others_of(row))]
    said = {
        "found": "Found: nothing else of the catalogue would do the same to these data.",
        "class": f"One of a class: this campaign cannot tell {listed(names)} apart.",
        "structure": "A structure without a name: it is there, and no effect of the catalogue "
        "explains it.",
        "consistent": "Consistent with it, and no more: the name is not certain.",
        "walk": "Consistent with it, and no more: what changes without a law looks much the same.",
        "unexplained": "Not explained: no effect of the catalogue does it.",
    }["class" if _walk_of_a_class(row) else kind_of(row)]
    told = []
    if row.get("snr"):
        told.append(f"it stands {numbers.significant(row['snr'], 2)} σ out of the noise")
    if row["p_value"] is not None:
        told.append(f"by noise alone {numbers.p_is(row['p_value'])}")
    more = ", ".join(told)
    return f"{said} {more[:1].upper()}{more[1:]}." if told else said


def in_short(rows: Sequence[Record]) -> Iterator[str]:
    """What the model lacks, a sentence for each degree of certainty; none where nothing does."""
    groups = {kind: [row for row in rows if kind_of(row) == kind] for kind in CLEAREST_FIRST}
    names = {kind: listed(_once(map(name_of, own))) for kind, own in groups.items() if own}
    sensors = {
        kind: listed(_once(SENSORS.get(row["sensor"] or "", "readings") for row in own))
        for kind, own in groups.items()
        if own
    }
    if groups["found"]:
        yield f"The data ask for {names['found']}."
    for row in groups["class"]:
        others = " or ".join(in_words(name) for name in others_of(row))
        yield (
            f"The data ask for {name_of(row)}, or for {others}: this campaign cannot tell them "
            "apart."
        )
    if groups["structure"]:
        yield f"What is left of the {sensors['structure']} has a structure without a name."
    if own := groups["consistent"]:
        each = [
            " or ".join([name_of(row), *(in_words(name) for name in others_of(row))]) for row in own
        ]
        yield f"The data are consistent with {listed(_once(each))}, and no more is said."
    for row in groups["walk"]:
        sensors_of = SENSORS.get(row["sensor"] or "", "readings")
        walk = f"The biases of the {sensors_of} change as by a random walk"
        others = " or ".join(in_words(name) for name in others_of(row))
        yield f"{walk}, or by {others}: they cannot be told apart." if others else f"{walk}."
    if groups["unexplained"]:
        yield (
            f"The residuals of the {sensors['unexplained']} are larger than noise, and nothing "
            "explains it."
        )


def listed(names: Sequence[str], last: str = "and") -> str:
    """Names as part of a sentence: a, b and c."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} {last} {names[-1]}"


def _once(names: object) -> list[str]:
    return list(dict.fromkeys(names))  # type: ignore[call-overload]
