"""What else differs between two campaigns: IMU, place, conditions, manoeuvres, settings, code."""

import json
from collections.abc import Iterator, Mapping
from math import degrees
from typing import Any

from inertial.text import numbers
from inertial.text.messages import _
from inertial.text.units import DEGREE, ICE_POINT
from overviews.compare.pair import READ, Pair
from stages.report.tables import Record, Tables

Line = tuple[str, str, str]  # what, and what it is in the first and in the second
FACTS = {
    "instrument": _("instrument"),
    "serial": _("serial number"),
    "date": _("date"),
    "laboratory": _("laboratory"),
    "operator": _("operator"),
    "table": _("table"),
    "mounting": _("mounting"),
    "switch_on": _("switch-on"),
    "simulated": _("simulated"),
    "compensated": _("compensated logs"),
}
UNITS = {"rad": (DEGREE, "°"), "rad/s": (DEGREE, "°/s")}
MOST = 160  # characters of a text
DIGITS = 7  # of a stated number
MOST_NAMED = 8  # manoeuvres


def conditions(pair: Pair) -> list[Line]:
    """Facts, known quantities, temperatures and manoeuvres that differ."""
    first, second = (list(_conditions(tables)) for tables in pair.tables)
    return [*_differing(dict(first), dict(second)), *_manoeuvres(pair)]


def _differing(first: Mapping[str, str], second: Mapping[str, str]) -> Iterator[Line]:
    for name in dict.fromkeys([*first, *second]):
        both = first.get(name, "—"), second.get(name, "—")
        if both[0] != both[1]:
            yield name, *both


def _conditions(tables: Tables) -> Iterator[tuple[str, str]]:
    about = tables.row("campaign")
    for key, name in FACTS.items():
        yield name, _text(about[key])
    yield _("stated sample rate"), _number(about["rate"], "Hz")
    yield _("latitude"), _number(about["latitude"], "rad")
    yield _("height"), _number(about["height"], "m")
    for row in tables.rows("known"):
        sigma = f" ± {_number(row['sigma'], row['unit'], 2)}" if row["sigma"] else ""
        name = row["quantity"].replace("_", " ")
        yield name, f"{_number(row['value'], row['unit'])}{sigma}"
    temperatures = [row["temperature"] for row in tables.rows("blocks") if row["temperature"]]
    if temperatures:
        low, high = (
            numbers.fixed(t - ICE_POINT, 1) for t in (min(temperatures), max(temperatures))
        )
        yield _("temperature of the IMU"), f"{low} … {high} °C"
    for row in tables.rows("certificate"):
        if row["item"].startswith("conditions.") or row["item"].startswith("procedure."):
            yield row["item"].partition(".")[2].replace("_", " "), _stated(row)


def _stated(row: Record) -> str:
    return _number(row["value"], row["unit"]) if row["value"] is not None else _text(row["text"])


def _text(value: object) -> str:
    if isinstance(value, bool):
        return _("yes") if value else _("no")
    return "—" if value is None else numbers.shortened(str(value), MOST)


def _number(value: float | None, unit: str, digits: int = DIGITS) -> str:
    if value is None:
        return "—"
    size, name = UNITS.get(unit, (1.0, unit if unit != "1" else ""))
    return f"{_plain(value / size, digits)} {name}".strip()


def _plain(value: float, digits: int = DIGITS) -> str:
    """As it may have been stated: without the zeros behind its last digit."""
    return f"{value:.{digits}g}".replace("-", "−")


def _manoeuvres(pair: Pair) -> Iterator[Line]:
    """Manoeuvres of one plan alone, and those of both that were stated in another way."""
    first, second = (
        {row["manoeuvre"]: _shape(row) for row in tables.rows("manoeuvres")}
        for tables in pair.tables
    )
    alone = [
        [name for name in own if name not in other]
        for own, other in ((first, second), (second, first))
    ]
    if any(alone):
        yield _("manoeuvres of one plan alone"), _named(alone[0]), _named(alone[1])
    for name in first:
        if name in second and first[name] != second[name]:
            yield _("manoeuvre {name}", name=name), first[name], second[name]


def _named(names: list[str]) -> str:
    more = len(names) - MOST_NAMED
    shown = ", ".join(names[:MOST_NAMED]) or "—"
    return shown + (_(" and {count} more", count=more) if more > 0 else "")


def _shape(row: Record) -> str:
    """What was done, in words."""
    words = [row["do"]]
    for key, unit in (("angle", "°"), ("rate", "°/s")):
        if row[key] is not None:
            words.append(f"{_plain(degrees(row[key]))}{unit}")
    if row["seconds"] is not None:
        words.append(f"{_plain(row['seconds'])} s")
    ups = [row[f"up_{axis}"] for axis in "xyz"]
    if None not in ups:
        words.append(f"up ({', '.join(_plain(up, 4) for up in ups)})")
    return numbers.shortened(" ".join(words), MOST)


# ---- Settings and code.


def settings(pair: Pair) -> list[Line]:
    """Settings that differ, and stages whose code does."""
    first, second = (dict(_settings(tables)) for tables in pair.tables)
    return list(_differing(first, second))


def _settings(tables: Tables) -> Iterator[tuple[str, str]]:
    makers: dict[str, Mapping[str, Any]] = {}
    for name in READ:
        maker = tables.maker(name)
        makers[maker["stage"]] = maker
    for stage, maker in makers.items():
        for key, value in maker["settings"].items():
            yield f"{stage}: {key}", numbers.shortened(json.dumps(value), MOST)
        yield _("{stage}: code", stage=stage), str(maker["code"])[:12]
