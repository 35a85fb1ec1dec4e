"""Results against each other; the one that counts against published and earlier ones."""

from collections.abc import Iterator, Mapping, Sequence
from math import floor, hypot, log10

from matplotlib.axes import Axes

from inertial.campaign.records import grouped
from inertial.sensors import PLURAL, SINGULAR, UNITS
from inertial.tables import AXES
from inertial.text import numbers, units
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed
from inertial.text.parameters import SENSOR_OF, sign_of
from inertial.text.typography import capital
from inertial.text.units import quantity
from stages.report import outline
from stages.report.drawing import AXIS_COLOUR, AXIS_MARK, INK, Margins, panels, style, svg, ticks
from stages.report.results import (
    KIND,
    METHOD,
    RESULT_TABLES,
    STATIC_SCALE,
    final_results,
    kind_of,
)
from stages.report.tables import Record, Tables
from stages.report.words import SENSOR_OF_STAGE, parameter, with_mount

KINDS = {
    "static_against_turns": _("Static, rotation"),
    "forward_against_backward": _("Forward, backward"),
    "straight_line": _("Rates, straight line"),
    "published": _("Published, this one"),
    "fencepost": _("Published, this one"),
}
MOST_DIFFERENCES = 120
MOST_CHANGES = 3  # that a sentence names
OF_A_CHANGE = _(
    "A shock, another mounting or set-up does that; so few calibrations may not tell it from a "
    "drift. make compare with that campaign shows whether the IMU was only turned in its mounting."
)


def comparison_parts(tables: Tables) -> Iterator[outline.Part]:
    """Every difference in units of its sigma with the verdict in words, the weightiest first."""
    rows = _weightiest_first(tables, tables.rows("differences"))
    yield from _judged(rows, _effects_of(tables, rows))
    static_scale = any(
        row["kind"] == "static_against_turns" and kind_of(row["quantity"]) == "scale"
        for row in rows
    )
    yield _differences(
        rows,
        _("None: no parameter was estimated in two ways that could be compared."),
        STATIC_SCALE if static_scale else "",
    )
    yield outline.Heading(_("Published values against the final result"))
    published = _weightiest_first(tables, tables.rows("published_differences"))
    yield from _judged(published)
    yield _differences(published, _("None: no published value is known for this instrument."))


def _effects_of(tables: Tables, rows: Sequence[Record]) -> list[str]:
    """The effects, in words, that results have and the methods compared beyond chance have not."""
    beyond = {(row["sensor"], row["mount"]) for row in rows if _beyond(row)}
    results = [one for one in final_results(tables) if (SENSOR_OF[one.stage], one.mount) in beyond]
    return list(dict.fromkeys(in_words(row["effect"]) for one in results for row in one.effects))


def _judged(rows: Sequence[Record], effects: Sequence[str] = ()) -> Iterator[outline.Paragraph]:
    """How many of them are more than chance; `effects`: that may be why."""
    compared = [row for row in rows if row["in_sigmas"] is not None]
    beyond = sum(map(_beyond, compared))
    if compared:
        verb = _("differs") if beyond == 1 else _("differ")
        text = _(
            "{beyond} of {pairs} of values {verb} by more than chance.",
            beyond=numbers.whole(beyond),
            pairs=numbers.counted(len(compared), "pair"),
            verb=verb,
        )
        if beyond and effects:
            text += _(
                " The methods compared here have no effects in their model; the result contains "
                "{effects}, which can cause such differences.",
                effects=listed(effects),
            )
        yield outline.Paragraph(text, "fair" if beyond else "good")
    for row in filter(_fencepost, rows):
        yield outline.Paragraph(capital(str(row["sentence"])), "fair")


COMPARISONS = outline.Section(
    "comparisons",
    _("Comparisons"),
    _(
        "Static against rotation, forward against backward, method against method: the same "
        "parameter by two ways that should agree. Then published values against the final result."
    ),
    _(
        "First come differences beyond chance, then the most exact comparisons, then the largest "
        "differences in units of their σ. p is the probability of a difference this large if the "
        "two are equal; among many comparisons some are large by chance, which the verdict takes "
        "into account. Two methods that use the same data are correlated: the variance of their "
        "difference is the difference of their variances if one is the joint fit and has the "
        "smaller σ throughout, else their sum. Static against rotation is judged by the σ of "
        "noise, table and site alone; the σ in “Parameters” also contain the scatter between "
        "manoeuvres and are larger."
    ),
    ("differences", "published_differences", *RESULT_TABLES),
    comparison_parts,
)


def _weightiest_first(tables: Tables, rows: Sequence[Record]) -> list[Record]:
    """What differs beyond chance, then what says most of the result; within, the worst first."""
    known = {
        (row["sensor"], row["mount"], row["parameter"]): row["sigma"]
        for result in final_results(tables)
        for row in result.determined
    }

    def order(row: Record) -> tuple[bool, bool, bool, int, float, str]:
        size, of_result = (
            row["in_sigmas"],
            known.get((row["sensor"], row["mount"], row["quantity"])),
        )
        coarse = log10(row["sigma"] / of_result) if row["sigma"] and of_result else 0.0
        steps = max(0, floor(coarse))
        place = not _fencepost(row), size is None, not _beyond(row), steps
        return *place, -abs(size or 0.0), row["id"]

    return sorted(rows, key=order)


def _fencepost(row: Record) -> bool:
    """Whether it says why published values are wrong, rather than that they are."""
    return bool(row["kind"] == "fencepost")


def _beyond(row: Record) -> bool:
    return bool(row["significant"]) or _fencepost(row)


def _differences(rows: Sequence[Record], none: str, remark: str = "") -> outline.Part:
    apart = [row for row in rows if row["in_sigmas"] is None and not _fencepost(row)]
    rows = [row for row in rows if row not in apart]
    if not rows:
        return outline.Paragraph(" ".join(filter(None, (none, _not_compared(apart)))))
    shown = rows[:MOST_DIFFERENCES]
    return outline.Table(
        _("Differences: {counted} of values.", counted=numbers.counted(len(rows), "pair")),
        (
            *outline.columns("text", _("Compared"), _("What")),
            *outline.columns("number", _("first named"), _("second named"), group=_("Values")),
            *outline.value_and_sigma(_("Difference"), unit=True),
            outline.Column(_("in σ"), "number", _("Difference")),
            outline.Column("p", "number"),
        ),
        [_difference(row) for row in shown],
        note=" ".join(
            filter(
                None,
                (
                    outline.more(len(rows) - len(shown), _(" in the table of differences")),
                    remark,
                    _not_compared(apart),
                ),
            )
        ),
    )


def _not_compared(rows: Sequence[Record]) -> str:
    """What has two values that were not compared, by the reason."""
    said = (str(row["sentence"]).partition(": ") for row in rows)
    each = (
        f"{capital(reason).rstrip('.')}: {', '.join(what for what, _colon, _reason in own)}."
        for reason, own in grouped(said, lambda parts: parts[2]).items()
    )
    return _("Not compared. {each}", each=numbers.shortened(" ".join(each), 900)) if rows else ""


def _difference(row: Record) -> outline.Row:
    unit = units.quantity(row["quantity"], row["unit"]).shown
    decimals = numbers.decimals_of(unit.of(row["sigma"]))
    first, second = (_value(unit.of(row[key]), decimals) for key in ("first_value", "second_value"))
    apart = None if row["in_sigmas"] is None else unit.of(row["in_sigmas"] * row["sigma"])
    return outline.table_row(
        with_mount(_compared(row), row["mount"]),
        capital(numbers.shortened(str(row["sentence"]).partition(": ")[0], 600)),
        *(first, second),
        *numbers.with_own_sigma(apart, unit.of(row["sigma"])),
        *(unit.name, numbers.fixed(row["in_sigmas"], 1)),
        numbers.probability(row["p_value"]),
        anchor=row["id"],
        tone="fair" if _beyond(row) else "",
    )


def _compared(row: Record) -> str:
    """Which two values a difference is of, the first named first."""
    kind, both = str(row["kind"]), [str(row[which]) for which in ("first", "second")]
    if kind == "method_against_method":  # stage, method with its mount, parameter
        methods = [[*name.split("/"), ""][1].partition("@")[0] for name in both]
        both = [METHOD.get(name, name) for name in methods]
    elif kind != "forward_against_backward":
        return KINDS.get(kind, numbers.shortened(kind, 60))
    first, second = (numbers.shortened(name, 60) for name in both)
    named = _("{first}; {second}", first=first, second=second)
    return f"{KINDS[kind]}: {named}" if kind in KINDS else capital(named)


def _value(value: float | None, decimals: int | None) -> str:
    """As far as the sigma of the difference goes, but at least to two digits: it may be surer."""
    if value is None or decimals is None:
        return numbers.significant(value, 5)
    own = numbers.decimals_of(abs(value))
    return numbers.fixed(value, decimals if own is None else max(decimals, min(own, 0)))


# ---- earlier calibrations of the same instrument

FOLDER = "data/history"
MOST_DRAWN = 12
MOST_CALIBRATIONS = 40
THIS = _("this one")
VERDICTS = {
    "usable": _("usable"),
    "usable_within_limits": _("usable, with departures from the ideal"),
    "on_condition": _("on condition:"),
    "not_usable": _("not usable"),
}
Key = tuple[str, str, str]  # mount, sensor and parameter
Calibration = Mapping[Key, Record]  # the parameters of the result that counts


def history_parts(tables: Tables) -> Iterator[outline.Part]:
    """The earlier ones as a table, bias and scale over the dates, and this one's archive file."""
    now = {
        (row["mount"], row["sensor"], row["parameter"]): row
        for row in tables.rows("result")
        if row["effect"] is None and row["value"] is not None
    }
    by_file = grouped(tables.rows("earlier"), lambda row: row["file"])
    calibrations = sorted(by_file.values(), key=_date)
    if calibrations:
        yield _calibrations(calibrations, now)
        if changed := changed_in_words(tables):
            yield outline.Paragraph(f"{changed} {OF_A_CHANGE}", "fair")
        date = tables.row("campaign")["date"] or "unknown"
        yield _figure(calibrations[-MOST_DRAWN + 1 :], now, date)
    else:
        yield outline.Paragraph(
            _("None: the archive holds no earlier calibration of this instrument.")
        )
    for row in tables.rows("archived"):
        text = _(
            "This calibration is kept in the archive as {folder}/{file}",
            folder=FOLDER,
            file=row["file"],
        )
        text += (
            _("; it supersedes {supersedes}", supersedes=row["supersedes"])
            if row["supersedes"]
            else ""
        )
        yield outline.Paragraph(
            numbers.shortened(
                _("{text}. SHA-256 of the file: {sha256}.", text=text, sha256=row["sha256"]), 900
            )
        )
    if not tables.rows("archived"):
        yield outline.Paragraph(_("This calibration is not in the archive."), "fair")


HISTORY = outline.Section(
    "history",
    _("Earlier calibrations"),
    _("Earlier results of the same instrument, by its serial number, and the file of this one."),
    _(
        "Each point is value ± σ of the result that counted, relative to the last value. A bias "
        "may change from one switch-on to the next; a scale error should not."
    ),
    ("result", "verdict", "campaign", "earlier", "changes", "archived"),
    history_parts,
)


def changed_in_words(tables: Tables) -> str:
    """Scale factors and cross terms that are others than in the last calibration; or nothing.

    Biases may change from one switch-on to the next.
    """
    compared = [row for row in tables.rows("changes") if kind_of(row["quantity"]) != "bias"]
    changed = sorted(
        (row for row in compared if row["beyond"]), key=lambda row: -abs(row["size"] / row["sigma"])
    )
    if not changed:
        return ""
    return _(
        "{count} of {all} scale factors and cross terms changed by more than chance since "
        "{campaign} of {since}: {each}.",
        count=len(changed),
        all=len(compared),
        campaign=numbers.shortened(changed[0]["since_campaign"], 60),
        since=numbers.shortened(changed[0]["since"], 20),
        each=listed([_change(row) for row in changed[:MOST_CHANGES]])
        + (_(" and others") if len(changed) > MOST_CHANGES else ""),
    )


def _change(row: Record) -> str:
    unit = quantity(row["quantity"], row["unit"]).laboratory
    return _(
        "{parameter} of the {sensor} by {size} {unit} ({sigmas} σ)",
        parameter=sign_of(row["quantity"]),
        sensor=PLURAL[row["sensor"]],
        size=numbers.plus_minus(unit.of(row["size"]), unit.of(row["sigma"])),
        unit=unit.name,
        sigmas=numbers.fixed(abs(row["size"] / row["sigma"]), 1),
    )


def _key(row: Record) -> Key:
    return row["mount"], row["sensor"], row["quantity"]


def _date(rows: Sequence[Record]) -> tuple[bool, str, str]:
    """Unknown dates first, then by date."""
    date = rows[0]["date"]
    return date[:1].isdigit(), date, rows[0]["file"]


def _calibrations(calibrations: Sequence[Sequence[Record]], now: Calibration) -> outline.Table:
    count = numbers.counted(len(calibrations), _("earlier calibration")).capitalize()
    return outline.Table(
        _("{count_}, the latest last.", count_=count),
        (
            outline.Column(_("Date"), "name"),
            outline.Column(_("Campaign")),
            *outline.columns("number", _("Parameters"), _("Largest change since, in σ")),
            outline.Column(_("of")),
            outline.Column(_("Verdict")),
            outline.Column(_("File"), "code"),
        ),
        [_calibration(rows, now) for rows in calibrations[-MOST_CALIBRATIONS:]],
        note=outline.more(len(calibrations) - MOST_CALIBRATIONS, _(" before these")),
    )


def _calibration(rows: Sequence[Record], now: Calibration) -> outline.Row:
    changes = [
        (abs(like["value"] - row["value"]) / both, parameter(row["sensor"], row["quantity"]))
        for row in rows
        if (like := now.get(_key(row))) and (both := hypot(row["sigma"], like["sigma"] or 0.0)) > 0
    ]
    largest, name = max(changes, default=(None, ""))
    return outline.table_row(
        numbers.shortened(rows[0]["date"], 20),
        numbers.shortened(rows[0]["campaign"], 80),
        numbers.whole(len(rows)),
        numbers.fixed(largest, 1),
        name or "—",
        _verdicts(rows),
        numbers.shortened(rows[0]["file"], 200),
    )


def _verdicts(rows: Sequence[Record]) -> str:
    """The verdicts of the sensors of a calibration, with the conditions."""
    said = {
        row["sensor"]: f"{VERDICTS.get(row['verdict'], row['verdict'])} {row['condition'] or ''}"
        for row in rows
        if row["verdict"]
    }
    parts = [f"{capital(SINGULAR[sensor])}: {words.strip()}" for sensor, words in said.items()]
    return numbers.shortened("; ".join(parts), 200) or "—"


def _figure(
    calibrations: Sequence[Sequence[Record]], now: Calibration, date: str
) -> outline.Figure:
    """Bias and scale of each sensor, one panel each, x, y and z beside each other."""
    each = [{_key(row): row for row in rows} for rows in calibrations] + [now]
    labels = [numbers.shortened(rows[0]["date"], 12) for rows in calibrations]
    labels.append(f"{numbers.shortened(date, 12)}\n{THIS}")
    with style():
        figure, axes = panels(2, 2, 0.95, Margins(left=0.6, across=0.7, bottom=0.5, down=0.3))
        for stage, line in zip(SENSOR_OF_STAGE, axes, strict=True):
            for kind, panel in zip(("bias", "scale"), line, strict=True):
                _panel(panel, stage, kind, each)
                panel.set_xticks(range(len(labels)), labels)
                panel.tick_params(axis="x", labelrotation=0 if len(labels) < 5 else 60)
        drawn = svg(figure, "history")
    return outline.Figure(
        _(
            "Bias and scale error over the calibrations, each with its σ, relative to the "
            "last value: x orange circles, y green squares, z blue triangles."
        ),
        drawn,
        _("Bias and scale error of both sensors against the dates of the calibrations."),
    )


def _panel(panel: Axes, stage: str, kind: str, each: Sequence[Calibration]) -> None:
    unit = quantity(f"{kind}_x", "1" if kind == "scale" else UNITS[SENSOR_OF[stage]]).shown
    for place, axis in enumerate(AXES):
        key = ("", SENSOR_OF[stage], f"{kind}_{axis}")
        points = [
            (number + (place - 1) * 0.12, own[key]) for number, own in enumerate(each) if key in own
        ]
        # A change is small beside the value itself, so it is drawn from the last value.
        last = points[-1][1]["value"] if points else 0.0
        panel.errorbar(
            [x for x, _unused in points],
            [(row["value"] - last) / unit.size for _unused, row in points],
            [(row["sigma"] or 0.0) / unit.size for _unused, row in points],
            color=AXIS_COLOUR[axis],
            marker=AXIS_MARK[axis],
            markersize=3,
            linestyle="none",
            elinewidth=0.8,
            capsize=2,
        )
    name = _(
        "{sensor_of_stage}, {lower} relative to its last value",
        sensor_of_stage=SENSOR_OF_STAGE[stage],
        lower=KIND[kind].lower(),
    )
    panel.set_title(f"{name}, {unit.name}", loc="left", pad=2)
    panel.axhline(0, color=INK, linewidth=0.4)
    panel.set_xlim(-0.5, len(each) - 0.5)
    ticks(panel, 4)
