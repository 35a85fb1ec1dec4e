"""Effects that were looked for and not found: from what size on they would have been seen."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from inertial.text import numbers, units
from inertial.text.cause_names import in_words
from stages.reporting.outline import Column, Row, Table
from stages.reporting.parameters import symbol
from stages.reporting.rows import Record
from stages.reporting.sought import Sought, capital

VISIBLE = "visible"


def tables(rows: Sequence[Record], missed: Sequence[Sought]) -> Iterator[Table]:
    """What would have been seen, an effect a row; and what not, by the reason.

    `rows`: of the table of blind spots; `missed`: the effects that were not named.
    """
    by_name = {name_with_mount(one): one for one in missed}
    own = [row for row in rows if row["effect"] in by_name]
    by_row = {row["effect"] for row in own}
    seen = [row for row in own if row["reason"] == VISIBLE and row["visible"] is not None]
    blind = [row for row in own if row not in seen]
    blind += [_elsewhere(one, name) for name, one in by_name.items() if name not in by_row]
    yield Table(
        "Looked for and not found: of each effect the smallest that this campaign would have seen "
        "(5 σ), on the axis where it is seen worst, and where best.",
        (
            Column("Effect"),
            Column("worst", "number", "Seen from"),
            Column("of", "symbol", "Seen from"),
            Column("best", "number", "Seen from"),
            Column("unit", "unit", "Seen from"),
            Column("p", "number"),
            Column("What it would be", "note"),
        ),
        tuple(_rows(seen, by_name)),
        empty="None: this campaign could have seen no effect that it has not named.",
        note="p: the chance of what the data say of it by noise alone.",
    )
    if blind:
        yield Table(
            "What this campaign cannot show, or what is told elsewhere, by the reason.",
            (Column("Why"), Column("Effects")),
            tuple(_unseen(blind, [*seen, *blind])),
        )


def name_with_mount(one: Sought) -> str:
    """An effect as the table of blind spots names it."""
    return f"{one.score['effect']}@{one.mount}" if one.mount else str(one.score["effect"])


def _rows(rows: Sequence[Record], by_name: dict[str, Sought]) -> Iterator[Row]:
    for (name, unit), group in groupby(rows, lambda row: (row["effect"], row["unit"])):
        own = sorted(group, key=lambda row: -(row["worst"] or row["visible"]))
        one, laboratory = by_name[name], units.quantity(own[0]["parameter"], unit).laboratory
        worst = max(own[0]["visible"], own[0]["worst"] or 0.0)
        best = min(min(row["visible"], row["best"] or row["visible"]) for row in own)
        size, least = (numbers.significant(laboratory.of(each), 2) for each in (worst, best))
        more = " ".join(dict.fromkeys(_more(row["sentence"] or "") for row in own)).strip()
        meaning = f"{capital(numbers.shortened(one.score['cause'], 160))}."
        yield Row(
            (
                capital(one.name),
                size,
                symbol(own[0]["parameter"]),
                least if least != size else "",
                laboratory.name,
                numbers.probability(one.score["p_value"]),
                f"{meaning} {numbers.shortened(more, 300)}".strip(),
            ),
            f"blind/{name}/{own[0]['parameter']}",
        )


def _more(sentence: str) -> str:
    """What is said beyond the size: another way of turning, or how short a turn is."""
    return sentence.partition(" on. ")[2]


def _elsewhere(one: Sought, name: str) -> Record:
    """An effect that is not sought in equations and turns: its score says how."""
    return {"effect": name, "parameter": "", "sentence": f": {one.score['sentence']}"}


def _unseen(rows: Sequence[Record], whole: Sequence[Record]) -> Iterator[Row]:
    """Effects that are not seen for the same reason in one row; `whole`: all blind spots."""
    by_reason: dict[str, dict[str, list[str]]] = {}
    for row in rows:
        reason = (row["sentence"] or "").partition(": ")[2]
        for lead in ("not seen, for ", "not seen. "):
            reason = reason.removeprefix(lead)
        effects = by_reason.setdefault(capital(numbers.shortened(reason, 300)), {})
        effects.setdefault(row["effect"], []).append(row["parameter"])
    for reason, effects in by_reason.items():
        names = [_named(name, own, whole) for name, own in effects.items()]
        yield Row((reason, f"{capital('; '.join(names))}."))


def _named(name: str, parameters: Sequence[str], whole: Sequence[Record]) -> str:
    """The effect, and its parameters where not all of them are concerned."""
    effect, _, mount = name.partition("@")
    every = sum(row["effect"] == name for row in whole)
    told = in_words(effect) + (f" (mount {numbers.shortened(mount, 60)})" if mount else "")
    if len(parameters) == every:
        return told
    return f"{told} ({', '.join(numbers.shortened(each, 30) for each in parameters)})"
