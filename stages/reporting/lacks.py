"""What the model lacks: effects that the data ask for, and those that stayed out of sight."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import pandas as pd

from stages.notation import numbers, units
from stages.notation.causes import in_words
from stages.reporting import blind_spots, extended
from stages.reporting.outline import (
    Column,
    Heading,
    Paragraph,
    Part,
    Row,
    Section,
    Sentences,
    Table,
)
from stages.reporting.parameters import (
    KIND,
    Estimate,
    by_kind,
    in_units,
    in_words_of,
    kind_of,
    symbol,
    written,
)
from stages.reporting.rows import Record, records
from stages.reporting.sought import LABORATORY, SI, Sought, capital

CLEAR = 3.0  # sigmas from which a parameter stands out
LOUD = 1e-3  # p-value below which a line is listed
MOST_LINES = 18
COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
Pair = tuple[Record, Record | None]


@dataclass(frozen=True)
class Shift:
    """How far a parameter moves, in sigmas of the joint fit."""

    stage: str
    name: str
    sigmas: float


def named(found: Iterable[Sought]) -> list[str]:
    """What the data ask for, each once, in words."""
    return list(dict.fromkeys(one.name for one in found if one.score["named"]))


def section(
    found: Sequence[Sought],
    lines: pd.DataFrame,
    gain: pd.DataFrame,
    parameters: pd.DataFrame,
    joint: Sequence[Estimate],
    decision: pd.DataFrame,
    worth: pd.DataFrame,
) -> Section:
    """The named effects, what they gain, what they do to the parameters, and the blind spots."""
    parts: list[Part] = [_summary(found)]
    for one in found:
        if one.score["named"]:
            parts += _named(one, lines)
    if rows := records(gain):
        parts += [Heading("What the extended model gains"), _gain(rows)]
    parts += extended.parts(decision, worth)
    parts += _extended(records(parameters), joint)
    missed = [one for one in found if not one.score["named"]]
    if missed:
        parts += [Heading("Looked for and not found: the blind spots"), blind_spots.table(missed)]
    return Section(
        "lacks",
        "What the model lacks",
        "Physical effects beyond bias, scale and cross-axis terms that the data ask for; how much "
        "they explain; and how small an effect this campaign would still have seen.",
        "An effect is named where noise alone would hardly ever ask for it. The drop is that of "
        "χ², on the data that were fitted and on held-out ones: each manoeuvre foretold from the "
        "others, with and without the effects. An effect that only fits noise does not gain there; "
        "a manoeuvre that alone shows it cannot be foretold and is not counted. A channel by "
        "itself is judged by its means over rests and whole turns. The blind spot is 5 σ: a "
        "smaller effect may be there unseen.",
        parts,
    )


def _summary(found: Sequence[Sought]) -> Paragraph:
    if not found:
        return Paragraph("None was looked for: the joint fits give no model to criticise.", "fair")
    if asked := named(found):
        return Paragraph(f"The data ask for {_listed(asked)}.", "fair")
    every = len({one.score["effect"] for one in found})
    shown = len({one.score["effect"] for one in found if one.score["degrees"]})
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


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


# ---- named effects


def _named(one: Sought, lines: pd.DataFrame) -> Iterator[Part]:
    score = one.score
    yield Heading(capital(one.name), f"lacks/{one.finding}")
    cause = numbers.shortened(score["cause"], 300)
    said = [f"Cause: {cause}."]
    if score["sought_in"] == "blocks":
        freedom = numbers.counted(score["degrees"], "degree")
        said.append(
            f"χ² drops by {numbers.significant(score['statistic'])} with {freedom} of freedom "
            f"({numbers.p_is(score['p_value'])})."
        )
    else:
        said.append(numbers.shortened(score["sentence"], 600))
    yield Sentences(tuple(said))
    clear = [row for row in one.parameters if _clear(row)]
    others = sum(row["value"] is not None for row in one.parameters) - len(clear)
    gaps = sum(row["value"] is None for row in one.parameters)
    more = [f"{numbers.counted(others, 'parameter')} within 3 σ of zero not listed"] * bool(others)
    more += [f"{numbers.counted(gaps, 'parameter')} not determined"] * bool(gaps)
    yield Table(
        f"{capital(one.name)}: the parameters beyond 3 σ.",
        (
            Column("", "symbol"),
            Column("value", "number", LABORATORY),
            Column("± σ", "sigma", LABORATORY),
            Column("unit", "unit", LABORATORY),
            Column("value", "number", SI),
            Column("± σ", "sigma", SI),
            Column("unit", "unit", SI),
            Column("in σ", "number"),
            Column("Meaning", "note"),
        ),
        tuple(_effect_rows(clear)),
        empty="None by itself: only together they are beyond noise.",
        note=capital("; ".join(more) + ".") if more else "",
    )
    if score["sought_in"] != "blocks" and (heard := _heard(lines)):
        yield heard


def _clear(row: Record) -> bool:
    value, sigma = row["value"], row["sigma"]
    return value is not None and bool(sigma) and bool(abs(value) > CLEAR * sigma)


def _effect_rows(rows: Sequence[Record]) -> Iterator[Row]:
    for row, cells in zip(rows, written(rows), strict=True):
        value, sigma, si_value, si_sigma = cells
        quantity = units.quantity(row["parameter"], row["unit"])
        yield Row(
            (
                symbol(row["parameter"]),
                *(value, sigma, quantity.laboratory.name),
                *(si_value, si_sigma, quantity.si.name),
                _ratio(row["value"] / row["sigma"]),
                numbers.shortened(row["meaning"], 160),
            ),
            row["id"],
        )


def _heard(lines: pd.DataFrame) -> Table | None:
    """The lines of the spectrum that stand out, the strongest first."""
    rows = [row for row in records(lines) if row["p_value"] < LOUD]
    rows.sort(key=lambda row: (-row["amplitude"], row["manoeuvre"], row["axis"]))
    if not rows:
        return None
    more = len(rows) - MOST_LINES
    cells = [
        (
            *_pair(row["frequency"], row["frequency_sigma"]),
            *_pair(row["amplitude"], row["amplitude_sigma"]),
        )
        for row in rows[:MOST_LINES]
    ]
    columns = [numbers.aligned(column) for column in zip(*cells, strict=True)]
    return Table(
        "Where it is heard: the strongest line of each gyro and turn, where it is beyond noise.",
        (
            Column("Manoeuvre"),
            Column("Gyro"),
            Column("Frequency", "number"),
            Column("± σ, Hz", "sigma"),
            Column("Amplitude", "number"),
            Column("± σ, rad/s", "sigma"),
            Column("p", "number"),
        ),
        tuple(
            Row((numbers.shortened(row["manoeuvre"], 60), row["axis"], *line, p))
            for row, line, p in zip(
                rows,
                zip(*columns, strict=True),
                [numbers.probability(row["p_value"]) for row in rows[:MOST_LINES]],
                strict=False,
            )
        ),
        note=f"{numbers.whole(more)} more in the table of lines." if more > 0 else "",
    )


def _pair(value: float, sigma: float) -> tuple[str, str]:
    return numbers.with_sigma(value, sigma, numbers.decimals_of(sigma))


# ---- gain, and the extended parameters


def _gain(rows: Sequence[Record]) -> Table:
    return Table(
        "Residuals without and with the effects, on the data that were fitted and on data that "
        "were held out.",
        (
            Column("Sensor"),
            Column("With"),
            Column("Data"),
            Column("Number", "number"),
            Column("Drop", "number"),
            Column("before", "number", "rms of the residuals"),
            Column("after", "number", "rms of the residuals"),
            Column("unit", "unit", "rms of the residuals"),
        ),
        tuple(
            Row(
                (
                    _sensor(row["sensor"]),
                    ", ".join(in_words(name) for name in row["effects"].split(", ")),
                    row["scope"],
                    numbers.whole(row["rows"]),
                    _drop(row),
                    numbers.significant(row["rms_before"]),
                    numbers.significant(row["rms_after"]),
                    "σ" if row["unit"] == "sigma" else numbers.shortened(row["unit"], 20),
                )
            )
            for row in rows
        ),
        note="In units of σ, 1 is what noise alone leaves.",
    )


def _drop(row: Record) -> str:
    if row["unit"] == "sigma":
        return numbers.fixed(row["drop"], 1)
    if not row["before"]:
        return "—"
    return f"{numbers.fixed(100 * row['drop'] / row['before'], 3)} % of the power"


def _sensor(name: str) -> str:
    kind, _, axis = name.partition(" ")
    sensor = {"gyro": "gyro", "accel": "accelerometer"}.get(kind, kind)
    return f"{axis} {sensor}" if axis else f"{sensor.capitalize()}s"


def _extended(rows: Sequence[Record], joint: Sequence[Estimate]) -> Iterator[Part]:
    """The parameters of the extended model beside those of the joint fit."""
    by_method = _pairs(rows, joint)
    if by_method:
        yield Heading("The parameters with the effects in the model")
    for method, pairs in by_method.items():
        yield Table(
            f"{in_words_of(method)}: the joint fit, and the same with the effects in the model.",
            (
                Column("", "symbol"),
                Column("value", "number", "Joint fit"),
                Column("± σ", "sigma", "Joint fit"),
                Column("value", "number", "Extended"),
                Column("± σ", "sigma", "Extended"),
                Column("unit", "unit"),
                Column("Shift, in σ of the joint fit", "number"),
                Column("Meaning", "note"),
            ),
            tuple(_beside(pairs)),
        )


def _pairs(rows: Sequence[Record], joint: Sequence[Estimate]) -> dict[str, list[Pair]]:
    """Each parameter of the extended model with its like in the joint fit, by method."""
    before = {
        (estimate.stage, estimate.method, row["parameter"]): row
        for estimate in joint
        for row in estimate.determined
    }
    pairs: dict[str, list[Pair]] = {}
    for row in by_kind(row for row in rows if "." not in row["parameter"]):
        stage, _, mount = row["method"].partition("@")
        key = (stage, f"joint@{mount}" if mount else "joint", row["parameter"])
        pairs.setdefault(row["method"], []).append((row, before.get(key)))
    return pairs


def shifts(extended: pd.DataFrame, joint: Sequence[Estimate]) -> list[Shift]:
    """How far each parameter moves with the effects in the model."""
    found = []
    for method, pairs in _pairs(records(extended), joint).items():
        for row, before in pairs:
            moved = _shift(row, before)
            if moved is not None:
                kind, _, axes = row["parameter"].partition("_")
                name = f"{KIND.get(kind, kind).lower()} {axes} of the {in_words_of(method).lower()}"
                found.append(Shift(method.partition("@")[0], name, moved))
    return found


def _beside(pairs: Sequence[Pair]) -> Iterator[Row]:
    gap = {"value": None, "sigma": None}
    cells: list[tuple[str, str]] = []
    for kind in dict.fromkeys(kind_of(row["parameter"]) for row, _ in pairs):
        group = [(row, old or row | gap) for row, old in pairs if kind_of(row["parameter"]) == kind]
        each = [units.quantity(row["parameter"], row["unit"]).laboratory for row, _ in group]
        both = in_units([r for pair in group for r in pair], [u for u in each for _ in range(2)])
        cells += both
    new, old = cells[::2], cells[1::2]
    columns = [
        numbers.aligned([pair[place] for pair in side]) for side in (old, new) for place in (0, 1)
    ]
    shifts = [_shift(row, before) for row, before in pairs]
    told = numbers.aligned([_ratio(shift) for shift in shifts])
    kind = ""
    for (row, _), shift, text, *line in zip(pairs, shifts, told, *columns, strict=True):
        if kind != kind_of(row["parameter"]):
            kind = kind_of(row["parameter"])
            yield Row((KIND.get(kind, kind),), heads=True)
        unit = units.quantity(row["parameter"], row["unit"]).laboratory
        far = shift is not None and abs(shift) > CLEAR
        yield Row(
            (
                symbol(row["parameter"]),
                *line,
                unit.name,
                text,
                numbers.shortened(row["meaning"], 160),
            ),
            row["id"],
            "fair" if far else "",
        )


def _shift(row: Record, before: Record | None) -> float | None:
    if before is None or row["value"] is None or not before["sigma"]:
        return None
    return float((row["value"] - before["value"]) / before["sigma"])


def _ratio(value: float | None) -> str:
    """A multiple of sigma."""
    return numbers.fixed(value, 1 if value is None or abs(value) < 1e4 else 0)


# ---- blind spots
