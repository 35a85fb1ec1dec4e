"""The comparison of two campaigns as a page, and as plain text for the screen."""

import json
import textwrap
from argparse import Namespace
from collections.abc import Iterator, Mapping, Sequence
from math import degrees
from pathlib import Path
from typing import Any

from inertial.sensors import PLURAL, SENSORS, SINGULAR
from inertial.text import numbers
from inertial.text.messages import _, plural
from inertial.text.typography import capital
from inertial.text.units import DEGREE, ICE_POINT, Unit
from overviews.compare.pair import READ, Compared, Pair, pair_of_campaigns
from overviews.compare.remounted import in_words, remounted
from overviews.compare.shared import in_sentences
from overviews.tables_of import files_of, made_from, tables_of
from stages.report import outline
from stages.report.drawing import AXIS_COLOUR, INK, QUIET, Margins, panels, style, svg, ticks
from stages.report.page import page
from stages.report.results import kind_of, quantity_of, symbol
from stages.report.sections.findings import causes, title_of
from stages.report.sections.verdict import LEVELS
from stages.report.tables import Record, Tables
from stages.report.words import with_mount

LINE_WIDTH = 100
KINDS = ("bias", "scale", "cross")
Line = tuple[str, str, str]  # what, and what it is in the first and in the second


def documents(given: Namespace, code: str) -> dict[str, str]:
    """reports/compare-A-B.html and .txt."""
    first, second = given.names
    both = tables_of(given.derived / first, READ), tables_of(given.derived / second, READ)
    pair = pair_of_campaigns((first, second), both, given.settings["comparison"]["level"])
    html = comparison_page(pair, given.derived, code)
    return {f"compare-{first}-{second}.html": html, f"compare-{first}-{second}.txt": as_text(pair)}


def comparison_page(pair: Pair, derived: Path, code: str) -> str:
    """One HTML page, without network and script."""
    first, second = (numbers.shortened(name, 80) for name in pair.names)
    title = _("{first} and {second}", first=first, second=second)
    files = [file for name in pair.names for file in files_of(derived / name, READ)]
    sections = [
        _differences(pair),
        _effects(pair),
        _verdicts(pair),
        _circumstances(pair),
        made_from(files, code),
    ]
    chapters = [
        outline.Chapter(str(number), section, list(section.parts(Tables({}, {}))))
        for number, section in enumerate(sections, 1)
    ]
    about = [tables.row("campaign") for tables in pair.tables]
    imus = dict.fromkeys(
        f"{numbers.shortened(row['instrument'], 60)} · {numbers.shortened(row['serial'], 60)}"
        for row in about
    )
    return page(
        outline.Report(
            title=title,
            campaign=title,
            instrument=_("Comparison of two campaigns: {imus}", imus=", ".join(imus)),
            running=title,
            simulated=all(row["simulated"] for row in about),
            chapters=chapters,
        )
    )


def _section(
    key: str, title: str, shows: str, reading: str, parts: Sequence[outline.Part]
) -> outline.Section:
    return outline.Section(key, title, shows, reading, (), lambda _tables: parts)


# ---- Differences.


def remarks(pair: Pair) -> Iterator[outline.Paragraph]:
    """How many differ by more than chance, all of a sensor together, and what they share."""
    about = [tables.row("campaign") for tables in pair.tables]
    if any(about[0][key] != about[1][key] for key in ("instrument", "serial")):
        yield outline.Paragraph(_("They are of different IMUs."), "fair")
    if pair.common_logs:
        yield outline.Paragraph(
            _(
                "Both were computed from {logs}: their values are not independent, and no σ of a "
                "difference is given.",
                logs=plural("{count} log", "{count} logs", len(pair.common_logs)),
            ),
            "fair",
        )
    tested = [one for one in pair.compared if one.p_value is not None]
    beyond = [one for one in tested if one.beyond]
    if tested:
        yield outline.Paragraph(
            _(
                "{count} of {all} values differ by more than chance.",
                count=len(beyond),
                all=len(tested),
            ),
            "fair" if beyond else "good",
        )
    for sensor in SENSORS:
        if together := pair.together(sensor):
            chi2, count, p_value = together
            yield outline.Paragraph(
                _(
                    "All values of the {sensor} together: χ² = {chi2} of {count}, {p}.",
                    sensor=PLURAL[sensor],
                    chi2=numbers.significant(chi2, 3),
                    count=count,
                    p=numbers.p_is(p_value),
                )
            )
    for found in remounted(pair):
        yield outline.Paragraph(with_mount(in_words(found), found.mount), "fair")
    for sentence in in_sentences(pair.shared, pair.names) if not pair.common_logs else ():
        yield outline.Paragraph(sentence)


def _differences(pair: Pair) -> outline.Section:
    parts: list[outline.Part] = [*remarks(pair)]
    if any(one.in_sigmas is not None for one in pair.compared):
        parts.append(_figure(pair))
    for sensor in SENSORS:
        if rows := _ordered(pair.of(sensor)):
            caption = _("Parameters of the {sensor}.", sensor=PLURAL[sensor])
            parts.append(_table(pair, rows, caption))
    return _section(
        "differences",
        _("Differences"),
        _("Each parameter of both results that count, the second less the first."),
        _(
            "σ is that of the difference, the errors that both contain alike taken out. p is the "
            "probability of a difference this large if the two are equal; which of them are more "
            "than chance takes the number of comparisons into account (Holm 1979)."
        ),
        parts,
    )


def _ordered(rows: Sequence[Compared]) -> list[Compared]:
    order = {kind: place for place, kind in enumerate(KINDS)}
    return sorted(rows, key=lambda one: (one.key[0], order.get(kind_of(one.key[2]), len(order))))


def _table(pair: Pair, rows: Sequence[Compared], caption: str) -> outline.Table:
    repeating = any(one.repeating is not None for one in rows)
    first, second = (numbers.shortened(name, 40) for name in pair.names)
    columns = [
        outline.Column("", "symbol"),
        *outline.value_and_sigma(first),
        *outline.value_and_sigma(second),
        *outline.value_and_sigma(_("difference"), unit=True),
        *outline.columns("number", _("in σ"), "p"),
        *([outline.Column(_("σ if the table repeats"), "number")] if repeating else []),
    ]
    lines = []
    for one in rows:
        cells = _cells(one)
        if one.key[0]:
            cells[0] = with_mount(cells[0], one.key[0])
        tone: outline.Tone = "fair" if one.beyond else ""
        lines.append(outline.table_row(*cells[: len(columns)], tone=tone))
    return outline.Table(caption, columns, lines)


def _cells(one: Compared) -> list[str]:
    """Symbol, both values with sigma, difference with sigma and unit, in sigmas, p, last sigma."""
    unit = _unit(one.row)
    sigmas = [
        unit.of(sigma)
        for sigma in (one.sigma, *((row or {}).get("sigma") for row in (one.first, one.second)))
    ]
    decimals = numbers.common_decimals(sigmas)
    values: list[str] = []
    for row in (one.first, one.second):
        if row is None:
            values += ["—", "—"]
        else:
            both = unit.of(row["value"]), unit.of(row["sigma"])
            values += numbers.with_sigma(*both, decimals)
    return [
        symbol(one.key[2]),
        *values,
        *numbers.with_sigma(unit.of(one.difference), unit.of(one.sigma), decimals),
        unit.name,
        numbers.fixed(one.in_sigmas, 1),
        numbers.probability(one.p_value),
        numbers.significant(unit.of(one.repeating), 2),
    ]


def _unit(row: Record) -> Unit:
    return quantity_of(row).laboratory


def _figure(pair: Pair) -> outline.Figure:
    """The differences in units of their sigma."""
    with style():
        figure, axes = panels(1, 2, 1.6, Margins(bottom=0.45, left=0.35), sharex=False)
        for panel, sensor in zip(axes[0], SENSORS, strict=True):
            rows = [one for one in _ordered(pair.of(sensor)) if one.in_sigmas is not None]
            sizes = [one.in_sigmas or 0.0 for one in rows]
            names = [symbol(one.key[2]).replace("_", "") for one in rows]
            colours = [AXIS_COLOUR[one.key[2].partition("_")[2][0]] for one in rows]
            panel.axhspan(-2, 2, color=QUIET, alpha=0.1, linewidth=0, zorder=0)
            panel.bar(range(len(rows)), sizes, width=0.6, color=colours)
            panel.axhline(0, color=INK, linewidth=0.5)
            panel.set_xticks(range(len(rows)), names, rotation=60)
            panel.grid(visible=False, axis="x")
            panel.set_title(_("{sensor}, σ", sensor=capital(PLURAL[sensor])), loc="left", pad=2)
            ticks(panel, 5)
        drawn = svg(figure, "differences")
    return outline.Figure(
        _("The second less the first in units of the σ of the difference; grey: within 2 σ."),
        drawn,
        _("Bars of the differences of all parameters in units of their σ, for both sensors."),
    )


# ---- Effects, verdicts, circumstances.


def _effects(pair: Pair) -> outline.Section:
    parts: list[outline.Part] = []
    for sensor in SENSORS:
        rows = [one for one in pair.effects if one.key[1] == sensor]
        if rows:
            caption = _("Effects in the results of the {sensor}.", sensor=PLURAL[sensor])
            table = _table(pair, rows, caption)
            lines = [
                outline.Row((one.effect_in_words, *row.cells[1:]), tone=row.tone)
                for one, row in zip(rows, table.rows, strict=True)
            ]
            head = outline.Column(_("Effect"))
            parts.append(outline.Table(table.caption, (head, *table.columns[1:]), lines))
    if not parts:
        parts.append(outline.Paragraph(_("None: neither result has an effect in its model.")))
    return _section(
        "effects",
        _("Effects"),
        _("Physical effects in the models of the results, with their sizes."),
        _("— where a result has none; its size is then in no parameter but the residuals."),
        parts,
    )


def _verdicts(pair: Pair) -> outline.Section:
    lines: list[outline.Row] = []
    for name, tables in zip(pair.names, pair.tables, strict=True):
        lines.append(outline.head(numbers.shortened(name, 80)))
        for row in tables.rows("verdict"):
            word, tone, _meaning = LEVELS[row["verdict"]]
            sensor = capital(with_mount(SINGULAR[row["sensor"]], row["mount"]))
            sentence = numbers.shortened(row["sentence"], 500)
            lines.append(outline.table_row(sensor, word, sentence, tone=_tone(tone)))
        titles = [title_of(tables, row) for row in causes(tables)]
        text = "; ".join(titles) or _("none")
        lines.append(outline.table_row(_("Causes"), "", numbers.shortened(text, 500)))
    table = outline.Table(
        _("Verdicts and causes."),
        (
            outline.Column(_("Of"), "name"),
            outline.Column(_("Verdict")),
            outline.Column(_("In words")),
        ),
        lines,
    )
    return _section(
        "verdicts",
        _("Verdicts and causes"),
        _("What each campaign is worth, and why."),
        "",
        [table],
    )


def _tone(tone: outline.Tone) -> outline.Tone:
    return "" if tone == "good" else tone


def _circumstances(pair: Pair) -> outline.Section:
    return _section(
        "circumstances",
        _("Conditions and settings that differ"),
        _("Only what differs: all else that the tables hold of both is the same."),
        "",
        [
            _lines(pair, _("Conditions."), conditions(pair)),
            _lines(pair, _("Settings and code."), settings(pair)),
        ],
    )


def _lines(pair: Pair, caption: str, lines: Sequence[Line]) -> outline.Table:
    first, second = (numbers.shortened(name, 40) for name in pair.names)
    return outline.Table(
        caption,
        (outline.Column(""), outline.Column(first), outline.Column(second)),
        [outline.table_row(*line) for line in lines],
        _("None: they are the same."),
    )


# ---- On the screen.


def as_text(pair: Pair) -> str:
    """The same in plain text: remarks, verdicts, parameters, effects, conditions, settings."""
    texts = [_("A: {first}\nB: {second}", first=pair.names[0], second=pair.names[1])]
    texts += [textwrap.fill(part.text, LINE_WIDTH) for part in remarks(pair)]
    verdicts = [
        textwrap.fill(
            f"{letter}: {with_mount(row['sentence'], row['mount'])}",
            LINE_WIDTH,
            subsequent_indent="   ",
        )
        for letter, tables in zip("AB", pair.tables, strict=True)
        for row in tables.rows("verdict")
    ]
    texts.append("\n".join([_("Verdicts"), *verdicts]))
    for sensor in SENSORS:
        texts += _block(capital(PLURAL[sensor]), _ordered(pair.of(sensor)))
    texts += _block(_("Effects"), pair.effects)
    for title, lines in (
        (_("Conditions that differ"), conditions(pair)),
        (_("Settings and code that differ"), settings(pair)),
    ):
        rows = [f"  {name}: {first} | {second}" for name, first, second in lines]
        texts.append("\n".join([title, *(rows or [_("  none")])]))
    return numbers.visible("\n\n".join(texts) + "\n")


def _block(title: str, rows: Sequence[Compared]) -> list[str]:
    if not rows:
        return []
    heads = ["", "A", "± σ", "B", "± σ", "B − A", "± σ", "", _("in σ"), "p"]
    if any(one.repeating is not None for one in rows):
        heads.append(_("σ if the table repeats"))
    table = [heads]
    for one in rows:
        cells = _cells(one)
        cells[0] = with_mount(one.key[2], one.key[0]) + (" *" if one.beyond else "")
        table.append(cells[: len(heads)])
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    lines = [
        "  ".join(
            cell.ljust(width) if place in (0, 7) else cell.rjust(width)
            for place, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in table
    ]
    note = [_("* more than chance")] if any(one.beyond for one in rows) else []
    return ["\n".join([title, *lines, *note])]


# ---- What else differs: IMU, place, conditions, manoeuvres, settings, code.

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
