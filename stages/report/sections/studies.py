"""Studies: what a longer rest, another window or a larger angle changes, and the table."""

from collections.abc import Iterator, Mapping, Sequence
from math import degrees

import numpy as np
from matplotlib.axes import Axes

from inertial.campaign.records import grouped
from inertial.text import numbers
from inertial.text.messages import _
from inertial.text.units import DEGREES_PER_HOUR, PPM
from stages.report import drawing
from stages.report.outline import (
    Column,
    Figure,
    Heading,
    Paragraph,
    Part,
    Row,
    Section,
    Sentences,
    Table,
    table_row,
    value_and_sigma,
)
from stages.report.sections.averaging import epoch_parts
from stages.report.sections.table_motion import LIMITS, encoder_parts, time_and_angle
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
STUDIES = ("epochs", "spreads", "windows", "growing", "middles", "time_angle", "encoder")
MARGINS = drawing.Margins(left=0.5, across=0.52, down=0.42, top=0.26)


def parts(tables: Tables) -> Iterator[Part]:
    """Rests by epochs, turns by windows, and the table's time and angle."""
    if not any(tables.rows(name) for name in STUDIES):
        yield Paragraph(
            _(
                "None: there are no static positions of known attitude and no turns that could be "
                "studied."
            )
        )
        yield from _not_studied(tables)
        return
    yield Heading(_("Static positions, epoch by epoch"))
    yield from list(epoch_parts(tables)) or [_none(tables, "rests")]
    yield Heading(_("Turns, window by window"))
    yield from list(_windows(tables)) or [_none(tables, "turns")]
    yield from encoder_parts(tables)
    yield Heading(_("Angle of the table against time"))
    yield from list(time_and_angle(tables)) or [_none(tables, "turns")]
    yield _middles(tables)
    if tables.rows("time_angle"):
        yield from map(Paragraph, LIMITS)
    yield from _not_studied(tables)


def _not_studied(tables: Tables) -> Iterator[Part]:
    """What is in no study, with the reason."""
    if left_out := tables.rows("not_studied"):
        yield Heading(_("Not in these studies"))
        yield Sentences(
            tuple(numbers.shortened(f"{row['subject']}: {row['reason']}", 400) for row in left_out)
        )


SECTION = Section(
    "studies",
    _("Studies"),
    _(
        "The parameters by single epochs and running means of static positions, by a window that "
        "slides through the turns and by one that grows, and the angle of the table against time."
    ),
    _(
        "A window of N samples lies between N + 1 edges and lasts N sample intervals: "
        "its angle by time is N · interval · set rate. These studies change no result; "
        "they show how static positions, windows and the table limit it."
    ),
    (*STUDIES, "motions", "not_studied", "levels"),
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
    by_pair = grouped((row for row in rows if row["by"] == by and _pair(row) in wholes), _pair)
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
            "Windows of 180° by time ({count_} samples at the set rate) against where they start: "
            "over the steady part, its first second close up, and the bias. Coloured band: ± σ of "
            "noise and oscillation, without the table's speed; grey: the whole turn ± σ. {ALIAS}",
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
    drawing.around(panel, place, value, sigma, colour, 0.2)
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
        "{axis} gyro, {whole_turn}: with the start of the 180° the scale factor varies between "
        "{least} and {most} ppm, {rms} ppm rms about its mean, where noise and the remainder of an "
        "oscillation over a window of this length allow {allowed} ppm. Its mean differs by {off} "
        "ppm from that of the whole turn, whose σ is {sigma} ppm.",
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
        "{axis} gyro, {whole_turn}: the difference from the whole turn is {differences}. The "
        "larger the angle, the smaller the effect of noise and of an oscillation that is cut.",
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
            "By time, σ includes that of the table's rate; the last column includes only noise and "
            "the remainder of an oscillation, so a difference far beyond it is due to the speed of "
            "the table or, where all gyros have it alike, to the clock of the IMU."
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
