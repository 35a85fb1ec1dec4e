"""What a calibration rests on: manoeuvres and bytes recorded, known quantities, ideal readings."""

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from inertial.formats.account import KINDS, OTHER_MESSAGE
from inertial.tables import AXES
from inertial.text import numbers, units
from inertial.text.messages import _
from inertial.text.statements import NOT_USED
from stages.report.declared import DECLARED
from stages.report.outline import (
    Column,
    Heading,
    Paragraph,
    Part,
    Row,
    Section,
    Table,
    Tone,
    columns,
    head,
    more,
    table_row,
    value_and_sigma,
)
from stages.report.tables import Record, Tables
from stages.report.words import term

MOST_LINES = 20
MOST_REASONS = 20
UNIT_VECTOR = 1e-9  # by which the length along an axis may be off 1


def recorded_parts(tables: Tables) -> Iterator[Part]:
    """One row per manoeuvre of the plan."""
    done = {row["manoeuvre"]: row for row in tables.rows("performed")}
    rows = [_manoeuvre(row, done.get(row["manoeuvre"])) for row in tables.rows("manoeuvres")]
    yield Table(
        _("{counted} of the plan.", counted=numbers.counted(len(rows), "manoeuvre")).capitalize(),
        (
            Column("", "mark"),
            *columns("name", _("Manoeuvre"), _("Set")),
            *columns("number", _("plan"), _("recorded"), _("missing"), group=_("Angle, °")),
            *columns("number", _("plan"), _("recorded"), group=_("Rate, °/s")),
            *columns("number", _("plan"), _("recorded"), group=_("Time, s")),
            Column(_("Remarks"), "note"),
        ),
        rows,
        _("None: the plan has no manoeuvre."),
    )


RECORDED = Section(
    "recorded",
    _("Recorded manoeuvres"),
    _("Every manoeuvre of the plan, and what its log contains of it."),
    _(
        "✓ recorded from rest to rest as planned, or its rests found where their attitudes are "
        "unknown, of which the plan states no time; ◐ incomplete; ✗ not found. Angle and rate are "
        "about the axis of the turn, right-hand rule; the angle is a sum of increments."
    ),
    ("manoeuvres", "performed"),
    recorded_parts,
)


def _manoeuvre(plan: Record, done: Record | None) -> Row:
    mark, tone = _mark(done)
    done = done or dict.fromkeys(("angle", "missing_angle", "rate", "seconds", "sentence"))
    turn = done if plan["do"] == "turn" else dict.fromkeys(done)
    # Of a session of positions the plan states the least length of a rest: no time of it all.
    whole = plan["do"] != "positions"
    return table_row(
        mark,
        numbers.shortened(plan["manoeuvre"], 28),
        attitude(plan),
        _number(units.DEGREES.of(plan["angle"]), 1),
        _number(units.DEGREES.of(turn["angle"]), 2),
        _number(units.DEGREES.of(turn["missing_angle"]) or None, 2),
        _number(units.DEGREES_PER_SECOND.of(plan["rate"]), 1),
        _number(units.DEGREES_PER_SECOND.of(turn["rate"]), 4),
        _number(plan["seconds"] if whole else None, 1),
        _number(done["seconds"] if whole else None, 1),
        numbers.shortened(done["sentence"] or _("not found"), 300),
        tone=tone,
    )


def _mark(done: Record | None) -> tuple[str, Tone]:
    if done is None or not done["found"]:
        return "✗", "poor"
    return ("✓", "") if done["complete"] else ("◐", "fair")


def _number(value: float | None, decimals: int) -> str:
    return "" if value is None else numbers.fixed(value, decimals)


def attitude(plan: Record) -> str:
    """A manoeuvre in a few words: rest, +x up; turn about +x."""
    if plan["do"] == "turn":
        return _("turn about {plan}", plan=_direction(plan, "about"))
    if plan["do"] == "positions":
        return _("positions, attitudes unknown")
    return _("{do}, {direction} up", do=term(plan["do"]), direction=_direction(plan, "up"))


def _direction(plan: Record, stem: str) -> str:
    """A unit vector in words: +x, or its three components; unknown where it is not stated."""
    vector = [plan[f"{stem}_{axis}"] for axis in AXES]
    if any(value is None for value in vector):
        return term("unknown")
    for axis, value in zip(AXES, vector, strict=True):
        if abs(abs(value) - 1) < UNIT_VECTOR:
            return ("+" if value > 0 else "−") + axis
    return f"({', '.join(numbers.fixed(value, 2) for value in vector)})"


# ---- data accounting


def account_parts(tables: Tables) -> Iterator[Part]:
    """Lines by kind per log, bytes against the size of the file, and the refused lines."""
    rows, refused = tables.rows("accounts"), tables.rows("refused")
    size = {row["file"]: row["size"] for row in tables.rows("inputs")}  # that of the gyros, too
    size |= {row["log"]: size.get(row["file"]) for row in tables.rows("logs")}
    yield Table(
        _("Lines of each log by kind."),
        (
            Column(_("Log")),
            *columns(
                "number",
                *(term(kind).capitalize() for kind in KINDS),
                _("Bytes"),
                _("Size of the file"),
            ),
            Column("", "mark"),
        ),
        [_log(log, rows, size) for log in dict.fromkeys(row["log"] for row in rows)],
        _("None: no log was read."),
    )
    if others := [row for row in rows if row["kind"] == OTHER_MESSAGE]:
        yield _other_messages(others)
    yield Heading(_("Refused lines"))
    if refused:
        yield from _refused(refused)
    else:
        yield Paragraph(_("Refused lines: none."), "good")


ACCOUNT = Section(
    "account",
    _("Data accounting"),
    _("What became of every line of the logs, so that no byte is lost without notice."),
    _("✓ the bytes of all kinds add up to the size of the file."),
    ("accounts", "refused", "inputs", "logs"),
    account_parts,
)


def _log(log: str, rows: Sequence[Record], size: dict[str, int | None]) -> Row:
    own = [row for row in rows if row["log"] == log]
    lines: Counter[str] = Counter()
    for row in own:
        lines[row["kind"]] += row["lines"]
    accounted = sum(row["bytes"] for row in own)
    expected = size.get(log)
    difference = "" if expected is None else f" {numbers.whole(accounted - expected)}"
    balanced = accounted == expected
    return table_row(
        numbers.shortened(log, 60),
        *(numbers.whole(lines[kind]) if lines[kind] else "" for kind in KINDS),
        numbers.whole(accounted),
        numbers.whole(expected),
        "✓" if balanced else _("✗ does not add up{difference}", difference=difference),
        tone="" if balanced else "poor",
    )


def _other_messages(rows: Sequence[Record]) -> Table:
    lines: Counter[str] = Counter()
    size: Counter[str] = Counter()
    for row in rows:
        name = row["name"] or _("without a name")
        lines[name] += row["lines"]
        size[name] += row["bytes"]
    return Table(
        _("Messages that the calibration does not use, all logs together."),
        (Column(_("Message")), *columns("number", _("Lines"), _("Bytes"))),
        [
            table_row(
                numbers.shortened(name, 60), numbers.whole(lines[name]), numbers.whole(size[name])
            )
            for name in sorted(lines)[:MOST_LINES]
        ],
    )


def _refused(lines: Sequence[Record]) -> Iterator[Table]:
    where = _(" in the table of refused lines")
    reasons = Counter((row["log"], row["reason"]) for row in lines)
    yield Table(
        _("{counted}, by log and reason.", counted=numbers.counted(len(lines), "refused line")),
        (*columns("text", _("Log"), _("Reason")), Column(_("Lines"), "number")),
        [
            table_row(
                numbers.shortened(log, 60), numbers.shortened(reason, 300), numbers.whole(count)
            )
            for (log, reason), count in reasons.most_common(MOST_REASONS)
        ],
        note=more(len(reasons) - MOST_REASONS, where),
    )
    yield Table(
        _("The first of them, as they begin."),
        (Column(_("Log")), *columns("number", _("Line"), _("Byte")), Column(_("Text"), "code")),
        [
            table_row(
                numbers.shortened(row["log"], 60),
                numbers.whole(row["line"]),
                numbers.whole(row["offset"]),
                numbers.shortened(row["text"], 110) or _("(empty)"),
            )
            for row in lines[:MOST_LINES]
        ],
        note=more(len(lines) - MOST_LINES, where),
    )


# ---- known quantities and provenance

NAME = {
    "gravity": _("gravity"),
    "latitude": _("latitude"),
    "earth_rate_up": _("earth rate, vertical component"),
    "earth_rate_level": _("earth rate, horizontal component"),
    "heading": _("azimuth of the table's zero mark"),
    "position": _("attitude of a set position"),
    "turn_angle": _("angle of a turn"),
    "turn_rate": _("rate of the table, relative"),
}
UNIT = {
    "latitude": units.DEGREES,
    "earth_rate_up": units.DEGREES_PER_HOUR,
    "earth_rate_level": units.DEGREES_PER_HOUR,
    "heading": units.DEGREES,
    "position": units.SECONDS_OF_ARC,
    "turn_angle": units.SECONDS_OF_ARC,
    "turn_rate": units.PPM,
}
# Known as exactly what was set: only how far it may be off says something.
ERRORS = ("position", "turn_angle", "turn_rate")


def known_parts(tables: Tables) -> Iterator[Part]:
    """One row per quantity that the plan uses."""
    yield Table(
        _("Known quantities."),
        (
            Column(_("Quantity")),
            *value_and_sigma(value=_("Value")),
            Column(_("Unit"), "unit"),
            Column(_("Origin")),
        ),
        list(_quantities(tables.rows("known"))),
    )


KNOWN = Section(
    "known",
    _("Known quantities"),
    _("The quantities that were given to the estimation."),
    _(
        "The σ of the parameters include those of these quantities; one without σ is taken as "
        "exact. Stated: by the campaign file; computed: from what is stated; assumed: by the "
        "pipeline, in the absence of a statement."
    ),
    ("known",),
    known_parts,
)


def _quantities(known: list[Record]) -> Iterator[Row]:
    for row in known:
        if row["origin"] in NOT_USED:
            continue
        yield table_row(
            NAME.get(row["quantity"]) or numbers.shortened(row["quantity"], 60),
            *_cells(row),
            _unit(row).name,
            numbers.shortened(row["origin"], 300),
            anchor=f"known/{row['quantity']}",
            tone="fair" if row["assumed"] else "",
        )


def _unit(row: Record) -> units.Unit:
    return UNIT.get(row["quantity"]) or units.Unit(row["unit"], 1.0)


def _cells(row: Record) -> tuple[str, str]:
    unit = _unit(row)
    value, sigma = unit.of(row["value"]), unit.of(row["sigma"])
    decimals = numbers.decimals_of(sigma)
    if value is None:
        return _("not known"), "—"
    if row["quantity"] in ERRORS:
        return _("as set"), numbers.significant(sigma, 2) if sigma else "—"
    if decimals is None:
        return numbers.significant(value, 7), "—"
    return numbers.with_sigma(value, sigma, decimals)


def provenance_parts(tables: Tables) -> Iterator[Part]:
    """The inputs with their SHA-256; the stages with settings and code."""
    yield Table(
        _("Inputs."),
        (Column(_("File")), Column(_("Bytes"), "number"), Column("SHA-256", "code")),
        [
            table_row(numbers.shortened(row["file"], 60), numbers.whole(row["size"]), row["sha256"])
            for row in tables.rows("inputs")
        ],
    )
    stages: dict[str, tuple[Mapping[str, Any], list[str]]] = {}
    for name in (*DECLARED.reads, "report"):
        maker = tables.maker(name)
        stages.setdefault(str(maker.get("stage", "unknown")), (maker, []))[1].append(name)
    yield Table(
        _("Stages."),
        (
            Column(_("Stage"), "name"),
            *columns("text", _("Tables in this report"), _("Settings")),
            Column(_("SHA-256 of its code"), "code"),
        ),
        [
            table_row(
                stage,
                ", ".join(name.replace("_", " ") for name in names),
                _settings(maker.get("settings")),
                str(maker.get("code", "unknown")),
            )
            for stage, (maker, names) in stages.items()
        ],
    )


PROVENANCE = Section(
    "provenance",
    _("Provenance"),
    _("The inputs, and per stage its settings and the hash of its code."),
    _(
        "The same inputs, settings and code give this report again, byte for byte. A hash is "
        "SHA-256; that of a stage covers every module it uses and the lock file of the libraries."
    ),
    ("inputs",),
    provenance_parts,
)


def _settings(settings: object) -> str:
    if not isinstance(settings, Mapping) or not settings:
        return _("none")
    stated = "; ".join(f"{name}: {json.dumps(value)}" for name, value in settings.items())
    return numbers.shortened(stated, 400)


# ---- Annex: what ideal sensors would read at the site of the campaign.

FRAMES = {
    "NED": _("North, east, down (NED; body axes forward, right, down)"),
    "ENU": _("East, north, up (ENU; body axes right, forward, up)"),
}
SITUATIONS = {
    "at_rest": _("at rest on the level"),
    "in_free_fall": _("in free fall"),
    "at_equator": _("at rest at the equator"),
    "at_pole": _("at rest at the pole of this hemisphere"),
    "under_way_north": _("{speed:g} m/s to the north at {height:g} m"),
    "under_way_east": _("{speed:g} m/s to the east at {height:g} m"),
}


def ideal_parts(tables: Tables) -> Iterator[Part]:
    """One table in both frames, and how gravity of the site compares."""
    readings = tables.rows("ideal_readings")
    if not readings:
        return
    site = readings[0]
    yield Table(
        _(
            "Ideal readings at latitude {latitude}° and height {height} m; the equator and the "
            "pole at the same height.",
            latitude=numbers.fixed(units.DEGREES.of(site["latitude"]), 4),
            height=numbers.fixed(site["height"], 0),
        ),
        (
            Column(_("Situation")),
            *columns("number", "1", "2", "3", group=_("Gyros, °/h")),
            *columns("number", "1", "2", "3", group=_("Accelerometers, m/s²")),
        ),
        list(_ideal_rows(readings)),
        note=_(
            "Under way: at a steady speed, the triad on the level and to the north. In free fall "
            "accelerometers read zero however fast the fall becomes."
        ),
    )
    for gravity in tables.rows("known"):
        if gravity["quantity"] != "gravity":
            continue
        value, sigma = numbers.with_own_sigma(gravity["value"], gravity["sigma"])
        yield Paragraph(
            _(
                "Normal gravity of the site is {normal} m/s²; the calibration takes gravity as "
                "{value} ± {sigma} m/s² ({origin}).",
                normal=numbers.fixed(-site["down"], 6),
                value=value,
                sigma=sigma,
                origin=numbers.shortened(gravity["origin"], 300),
            )
        )


IDEAL = Section(
    "ideal",
    _("Ideal readings at the site"),
    _("What sensors without errors would read, by the earth's rate, gravity and the speed alone."),
    _(
        "1, 2, 3: the axes in the order of the frame. Gyros read the rate against inertial space, "
        "accelerometers specific force, acceleration less gravity: at rest the axis that points up "
        "reads +g, the one that points down −g."
    ),
    ("ideal_readings", "known"),
    ideal_parts,
)


def _ideal_rows(readings: list[Record]) -> Iterator[Row]:
    """A row per situation, for the accelerometers and the gyros of one stand one after another."""
    for frame, name in FRAMES.items():
        yield head(name)
        for accel, gyro in zip(readings[::2], readings[1::2], strict=True):
            rates = (each / units.DEGREE_PER_HOUR for each in _in_frame(gyro, frame))
            yield table_row(
                SITUATIONS[gyro["situation"]].format(**gyro),
                *(numbers.fixed(each, 4) for each in rates),
                *(numbers.fixed(each, 6) for each in _in_frame(accel, frame)),
            )


def _in_frame(reading: Record, frame: str) -> tuple[float, float, float]:
    north, east, down = (reading[name] for name in ("north", "east", "down"))
    return (north, east, down) if frame == "NED" else (east, north, -down)
