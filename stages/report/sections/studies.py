"""Studies: what a longer rest, another window or a larger angle changes, and the table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import degrees

import numpy as np
from matplotlib.axes import Axes

from inertial.text import numbers
from inertial.text.messages import _
from inertial.text.units import DEGREE, DEGREES_PER_HOUR, PPM, SECONDS_OF_ARC
from stages.report import drawing
from stages.report.outline import (
    Column,
    Equation,
    Figure,
    Heading,
    Paragraph,
    Part,
    Row,
    Section,
    Sentences,
    Table,
    more,
    table_row,
    value_and_sigma,
)
from stages.report.sections.averaging import epoch_parts
from stages.report.sections.encoder import encoder_parts
from stages.report.tables import Record, Tables, arrays
from stages.report.words import plain

Pair = tuple[str, str, str]  # axis, turn forward, turn backward
By = dict[Pair, list[Record]]
Wholes = Mapping[Pair, Record]

CLOSE_SECONDS = 1.0  # of the start of a window that are drawn close up
MOST_PAIRS = 6
MAX_OFF = 5.0  # °, of a window that stands for one of a round angle
SHOWN_SIGMAS = 5.0  # of a half turn that a panel of growing windows shows
ALIAS = _("Not every sample is drawn: a fast oscillation shows its size here, not its frequency.")
WHOLE_TURN = "whole turn"
STUDIED = {"rests": _("static positions"), "turns": _("turns")}
BY = {
    WHOLE_TURN: _("the whole turn"),
    "set rate": _("180° by time, at the set rate"),
    "own angle": _("180° by the time and angle of these turns"),
    "encoder": _("180° by the encoder of the table"),
    "other turns": _("180° by the speed of turns about other axes"),
}
SIGMA = {"scale": "cut_sigma", "bias": "bias_sigma"}
UNIT = {"scale": PPM, "bias": DEGREES_PER_HOUR}
MARGINS = drawing.Margins(left=0.5, across=0.52, down=0.42, top=0.26)


def parts(tables: Tables) -> Iterator[Part]:
    """Rests by epochs, turns by windows, and the table's time and angle."""
    yield Heading(_("Static positions, epoch by epoch"))
    yield from list(epoch_parts(tables)) or [_none(tables, "rests")]
    yield Heading(_("Turns, window by window"))
    yield from list(_windows(tables)) or [_none(tables, "turns")]
    yield from encoder_parts(tables)
    yield Heading(_("Angle of the table against time"))
    yield from list(_time_and_angle(tables)) or [_none(tables, "turns")]
    yield _middles(tables)
    yield from map(Paragraph, LIMITS)
    if left_out := tables.rows("not_studied"):
        yield Heading(_("Not in these studies"))
        yield Sentences(
            tuple(numbers.shortened(f"{row['subject']}: {row['reason']}", 400) for row in left_out)
        )


SECTION = Section(
    "studies",
    _("Studies"),
    _(
        "The parameters by single epochs and running means of static positions, by a "
        "window that slides through the turns and by one that grows, and the angle of "
        "the table against time."
    ),
    _(
        "A window of N samples lies between N + 1 edges and lasts N sample intervals: "
        "its angle by time is N · interval · set rate. These studies change no result; "
        "they show how static positions, windows and the table limit it."
    ),
    (
        *("epochs", "spreads", "windows", "growing", "middles"),
        *("time_angle", "motions", "encoder", "not_studied", "levels"),
    ),
    parts,
)


def _none(tables: Tables, study: str) -> Paragraph:
    reasons = any(row["study"] == study for row in tables.rows("not_studied"))
    why = _("; the reasons are below") if reasons else ""
    return Paragraph(
        _(
            "None: there are no {studied} that could be studied{why}.",
            studied=STUDIED[study],
            why=why,
        )
    )


# ---- windows


def _windows(tables: Tables) -> Iterator[Part]:
    """Windows against their start and against their angle, each with what it says."""
    wholes = _wholes(tables)
    if slides := _by_time(tables.rows("windows"), wholes):
        yield _sliding(slides, wholes)
        yield from (Paragraph(_on_place(own, wholes[pair])) for pair, own in slides.items())
    if grows := _by_time(tables.rows("growing"), wholes):
        yield _growing(grows, wholes)
        yield from (Paragraph(_on_angle(own, wholes[pair])) for pair, own in grows.items())
    if read := _by_time(tables.rows("growing"), wholes, "encoder"):
        yield _growing(read, wholes, by_encoder=True)


def _pair(row: Record) -> Pair:
    return row["axis"], row["forward"], row["backward"]


def _wholes(tables: Tables) -> dict[Pair, Record]:
    return {_pair(row): row for row in tables.rows("middles") if row["by"] == WHOLE_TURN}


def _by_time(rows: Sequence[Record], wholes: Wholes, by: str = "set rate") -> By:
    by_pair: By = {}
    for row in rows:
        if row["by"] == by and _pair(row) in wholes:
            by_pair.setdefault(_pair(row), []).append(row)
    return dict(list(by_pair.items())[:MOST_PAIRS])


def _sliding(slides: By, wholes: Wholes) -> Figure:
    with drawing.style():
        figure, axes = drawing.panels(len(slides), 3, 0.95, MARGINS, sharex=False)
        for line, (pair, rows) in zip(axes, slides.items(), strict=True):
            close = [row for row in rows if row["from_s"] <= CLOSE_SECONDS]
            views = ((rows, "scale"), (close, "scale"), (rows, "bias"))
            for panel, (own, key) in zip(line, views, strict=True):
                _panel(panel, [row["from_s"] for row in own], own, wholes[pair], key)
            line[1].set_ylim(line[0].get_ylim())
        for panel in axes[-1]:
            panel.set_xlabel(_("Start in the steady part, s"))
        drawn = drawing.svg(figure, "windows")
    count = numbers.whole(next(iter(slides.values()))[0]["samples"])
    return Figure(
        _(
            "Windows of 180° by time ({count_} samples at the set rate) against "
            "where they start: over the steady part, its first second close up, and "
            "the bias. Coloured band: ± σ of noise and oscillation, without the "
            "table's speed; grey: the whole turn ± σ. {ALIAS}",
            count_=count,
            ALIAS=ALIAS,
        ),
        drawn,
        _("Scale factor and bias by a window of 180° against its start."),
    )


def _growing(grows: By, wholes: Wholes, *, by_encoder: bool = False) -> Figure:
    with drawing.style():
        figure, axes = drawing.panels(len(grows), 2, 0.95, MARGINS, sharex=False)
        for line, (pair, rows) in zip(axes, grows.items(), strict=True):
            half = min(rows, key=lambda row: abs(float(row["angle"]) - np.pi))
            for panel, (key, unit) in zip(line, UNIT.items(), strict=True):
                _panel(panel, [degrees(row["angle"]) for row in rows], rows, wholes[pair], key)
                reach = SHOWN_SIGMAS * half[SIGMA[key]] / unit.size
                middle = wholes[pair][key] / unit.size
                panel.set_ylim(middle - reach, middle + reach)
        for panel in axes[-1]:
            panel.set_xlabel(_("Angle from the start of the steady part, °"))
        drawn = drawing.svg(figure, "growing-encoder" if by_encoder else "growing")
    if by_encoder:
        return Figure(
            _(
                "The same windows by the encoder, whatever the speed of the table, corrected for "
                "its harmonics. Coloured band: ± σ of noise and of an oscillation cut at any "
                "phase; grey: the whole turn ± σ."
            ),
            drawn,
            _("Scale factor and bias against the angle of the window, by the encoder."),
        )
    return Figure(
        _(
            "Windows by time from the start of the steady part to an angle that "
            "grows. Coloured band: ± σ of noise and of an oscillation cut at any "
            "phase, without the table's speed; grey: the whole turn ± σ. {ALIAS}",
            ALIAS=ALIAS,
        ),
        drawn,
        _("Scale factor and bias against the angle of the window."),
    )


def _panel(
    panel: Axes, place: Sequence[float], rows: Sequence[Record], whole_turn: Record, key: str
) -> None:
    """Value ± sigma by each window, and that of the whole turn."""
    axis, unit = whole_turn["axis"], UNIT[key]
    value, sigma = (column / unit.size for column in arrays(rows, key, SIGMA[key]))
    colour = drawing.AXIS_COLOUR.get(axis, drawing.INK)
    drawing.band(panel, place, value - sigma, value + sigma, colour, alpha=0.2, linewidth=0)
    panel.plot(place, value, color=colour, linewidth=0.8)
    drawing.ticks(panel, 4)
    panel.yaxis.get_major_formatter().set_useOffset(False)  # type: ignore[attr-defined]
    middle, reach = whole_turn[key] / unit.size, whole_turn[f"{key}_sigma"] / unit.size
    panel.axhspan(middle - reach, middle + reach, color=drawing.QUIET, alpha=0.2, linewidth=0)
    panel.axhline(middle, color=drawing.INK, linewidth=0.7)
    panel.set_title(
        _("{axis} gyro: {key}, {name}", axis=axis, key=plain(key), name=unit.name), pad=3
    )


def _on_place(rows: Sequence[Record], whole_turn: Record) -> str:
    """How far the result varies with the start of the window."""
    value = arrays(rows, "scale")[0] / PPM.size
    mean = float(value.mean())
    least, most, rms, allowed, off, sigma = (
        numbers.fixed(size, 1)
        for size in (
            *(float(value.min()), float(value.max()), float(value.std())),
            PPM.of(rows[0]["cut_sigma"]),
            mean - whole_turn["scale"] / PPM.size,
            PPM.of(whole_turn["scale_sigma"]),
        )
    )
    return _(
        "{axis} gyro, {whole_turn}: with the start of the 180° the scale factor varies "
        "between {least} and {most} ppm, {rms} ppm rms about its mean, where noise and "
        "the remainder of an oscillation over a window of this length allow {allowed} "
        "ppm. Its mean differs by {off} ppm from that of the whole turn, whose σ is "
        "{sigma} ppm.",
        axis=whole_turn["axis"],
        whole_turn=_names(whole_turn),
        least=least,
        most=most,
        rms=rms,
        allowed=allowed,
        off=off,
        sigma=sigma,
    )


def _on_angle(rows: Sequence[Record], whole_turn: Record) -> str:
    """How far the result still is from that of the whole turn at some angles."""
    differences = []
    for angle in (90.0, 180.0, 270.0, degrees(rows[-1]["angle"])):
        row = min(rows, key=lambda row: abs(degrees(row["angle"]) - angle))
        if abs(degrees(row["angle"]) - angle) < MAX_OFF:
            off = numbers.fixed(PPM.of(row["scale"] - whole_turn["scale"]), 1)
            sigma = numbers.fixed(PPM.of(row["cut_sigma"]), 1)
            differences.append(
                _(
                    "{off} ± {sigma} ppm at {angle}°",
                    off=off,
                    sigma=sigma,
                    angle=numbers.fixed(angle, 0),
                )
            )
    return _(
        "{axis} gyro, {whole_turn}: the difference from the whole turn is "
        "{differences}. The larger the angle, the smaller the effect of noise and of an "
        "oscillation that is cut.",
        axis=whole_turn["axis"],
        whole_turn=_names(whole_turn),
        differences="; ".join(differences),
    )


def _names(row: Record) -> str:
    return _(
        "{forward} and {backward}",
        forward=numbers.shortened(row["forward"], 30),
        backward=numbers.shortened(row["backward"], 30),
    )


def _middles(tables: Tables) -> Table:
    """The scale factor of each gyro by the whole turn and by the middle 180°."""
    wholes = _wholes(tables)
    return Table(
        _("Scale factor by the whole turn, and by the middle 180° of the same turns."),
        (
            Column(_("Turns"), "name"),
            Column(_("Angle of the table")),
            *value_and_sigma(_("ppm"), _("scale")),
            *value_and_sigma(_("ppm"), _("less whole turn")),
        ),
        [_middle(row, wholes[_pair(row)]) for row in tables.rows("middles")],
        _("None: no pair of whole turns forward and backward was recorded."),
        _(
            "By time, σ includes that of the table's rate; the last column includes "
            "only noise and the "
            "remainder of an oscillation, so a difference far beyond it is due to "
            "the table's speed."
        ),
    )


def _middle(row: Record, whole_turn: Record) -> Row:
    own_sigma = row["cut_sigma"] if row["by"] != "other turns" else row["scale_sigma"]
    off = sigma = None
    if row["by"] != WHOLE_TURN:
        off = row["scale"] - whole_turn["scale"]
        sigma = float(np.hypot(own_sigma, whole_turn["scale_sigma"])) if own_sigma else None
    # The scale has the digits of its difference, whatever the σ of the table's rate.
    decimals = max(numbers.decimals_of(PPM.of(whole_turn["scale_sigma"])) or 1, 1)
    own_decimals = numbers.decimals_of(PPM.of(row["scale_sigma"]))
    return table_row(
        _names(row),
        BY.get(row["by"], str(row["by"])),
        numbers.fixed(PPM.of(row["scale"]), decimals),
        numbers.with_sigma(PPM.of(row["scale"]), PPM.of(row["scale_sigma"]), own_decimals)[1],
        *numbers.with_sigma(PPM.of(off), PPM.of(sigma), decimals),
    )


# ---- time and angle of the table

MOST_TURNS = 9
COLOUR = "#0072b2"
RAMPS = ((_("Spin-up"), "spin-up"), (_("Spin-down"), "spin-down"))
SET = (
    ("speed", DEGREE, "°/s"),
    ("spin-up acceleration", DEGREE, "°/s²"),
    ("spin-up seconds", 1.0, _("s a ramp")),
)
LIMITS = (
    _(
        "Use: the function gives the motion of the table between its ends, so its real "
        "speed and its ramps, for other gyros, for other turns and for marks at fixed "
        "angles. With the speed from turns about other axes the middle 180° become as "
        "good as their noise, whatever the set rate, if the table keeps the same speed "
        "in all turns."
    ),
    _(
        "Limits: with the angle of its own turn a window gives the scale factor of the "
        "whole turn again, since the gyro is compared with itself; the agreement shows "
        "only that nothing changed within the turn. If all gyros had the same scale "
        "error, the same logs would be those of a table that turned faster and further "
        "by that share: without the known whole angle a common scale factor and the "
        "table's speed are one unknown. An angle recorded by the table resolves this."
    ),
)


def _time_and_angle(tables: Tables) -> Iterator[Part]:
    """The equation, a figure of what the angle differs by from what was set, speed and ramps."""
    turns: dict[str, list[Record]] = {}
    for row in tables.rows("time_angle"):
        turns.setdefault(row["manoeuvre"], []).append(row)
    if not turns:
        return
    yield Equation(
        "θ(t) = A · C(t) / C(T)",
        _("C: what the gyro along the axis summed, less bias and earth; A: the known whole angle."),
    )

    def draw(panel: Axes, name: str) -> None:
        _angle(panel, name, turns[name])

    names = list(turns)[:MOST_TURNS]
    rest = more(len(turns) - len(names), _(" in the table time_angle"))
    margins = drawing.Margins(left=0.45, across=0.4, down=0.3)
    yield Figure(
        _(
            "Angle of the table less that of the set trapezoid, which is laid through the "
            "steady part, arcsec, and ± σ of the angle. σ is zero at the start and that of "
            "the known whole angle at the end. Light blue: the amplitude of motion that is "
            "faster than the line resolves. {rest}",
            rest=rest,
        ).rstrip(),
        drawing.grid(names, draw, 0.95, margins, _("Time, s"), "time-angle"),
        _("The table's angle against time, less the trapezoid that was set."),
    )
    yield from map(Paragraph, _sentences(turns, tables.rows("motions")))
    yield _motions(tables.rows("motions"))


def _angle(panel: Axes, name: str, rows: Sequence[Record]) -> None:
    time, angle, set_angle, sigma, swing = arrays(
        rows, "seconds", "angle", "set_angle", "sigma", "swing"
    )
    off, sigma, swing = (
        values / SECONDS_OF_ARC.size for values in (angle - set_angle, sigma, swing)
    )
    panel.axhline(0, color=drawing.INK, linewidth=0.6)
    drawing.band(panel, time, -sigma, sigma, drawing.QUIET, alpha=0.25, linewidth=0)
    drawing.band(panel, time, off - swing, off + swing, COLOUR, alpha=0.3, linewidth=0)
    panel.plot(time, off, color=COLOUR, linewidth=0.7)
    panel.set_title(numbers.shortened(name, 30), pad=3)
    drawing.ticks(panel, 4)


def _sentences(turns: dict[str, list[Record]], rows: Sequence[Record]) -> Iterator[str]:
    """The deviation of the table from its set rate, and how well its angle is known."""
    speeds = [row for row in rows if row["quantity"] == "speed" and row["set_value"]]
    if speeds:
        off = [(row["value"] / row["set_value"] - 1) / PPM.size for row in speeds]
        sigmas = [row["sigma"] / row["set_value"] / PPM.size for row in speeds]
        least, most, best, worst = (
            numbers.fixed(size, 1) for size in (min(off), max(off), min(sigmas), max(sigmas))
        )
        yield (
            _(
                "In the steady part of {counted} the table deviated from its set rate by "
                "{least} to {most} ppm, with a σ of {best} to {worst} ppm in each. The scale "
                "factor of a window by time is in error by the same share.",
                counted=numbers.counted(len(speeds), "turn"),
                least=least,
                most=most,
                best=best,
                worst=worst,
            )
        )
    sigma, name = max((row["sigma"], name) for name, own in turns.items() for row in own)
    angle, turn = numbers.significant(SECONDS_OF_ARC.of(sigma), 2), numbers.shortened(name, 30)
    yield (
        _(
            "Between the ends of a turn the σ of the angle is at most {angle} arcsec "
            "({turn}); an oscillation of the case counts as motion.",
            angle=angle,
            turn=turn,
        )
    )


def _motions(rows: Sequence[Record]) -> Table:
    turns: dict[str, dict[str, Record]] = {}
    for row in rows:
        turns.setdefault(row["manoeuvre"], {})[row["quantity"]] = row
    ramps: list[Column] = []
    quantities = ["speed"]
    for name, ramp in RAMPS:
        ramps += [*value_and_sigma(name, "s"), *value_and_sigma(name, "°/s²")]
        quantities += [f"{ramp} seconds", f"{ramp} acceleration"]
    return Table(
        _("Speed and ramps by time and angle; the ramps as if their acceleration were constant."),
        (Column(_("Turn"), "name"), *value_and_sigma(_("Speed"), "°/s"), *ramps),
        [
            table_row(numbers.shortened(turn, 40), *_cells(own, quantities))
            for turn, own in turns.items()
        ],
        note=_was_set(rows),
    )


def _cells(own: dict[str, Record], quantities: Sequence[str]) -> Iterator[str]:
    for quantity in quantities:
        row = own.get(quantity)
        if row is None:
            yield from ("—", "—")
        else:
            size = DEGREE if "rad" in row["unit"] else 1.0
            sigma = row["sigma"] / size
            yield from numbers.with_own_sigma(row["value"] / size, sigma)


def _was_set(rows: Sequence[Record]) -> str:
    """What was set, where it is the same for all turns."""
    settings = []
    for quantity, size, unit in SET:
        values = {row["set_value"] for row in rows if row["quantity"] == quantity}
        if len(values) == 1 and None not in values:
            settings.append(f"{numbers.significant(values.pop() / size, 4)} {unit}")
    return _("Set: {settings}.", settings=", ".join(settings)) if settings else ""
