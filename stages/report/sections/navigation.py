"""What the calibration is worth in navigation: free, after alignment, and with rotation."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from math import sqrt

import numpy as np
from matplotlib.axes import Axes

from inertial.campaign.records import grouped
from inertial.sensors import SENSORS, SINGULAR
from inertial.text import numbers, units
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed
from inertial.text.units import DEGREES, Unit
from stages.report import drawing, outline
from stages.report.tables import Record, Tables, arrays
from stages.report.words import with_mount

QUANTITIES = {
    "attitude": (_("attitude"), DEGREES),
    "velocity": (_("velocity"), Unit("m/s", 1.0)),
    "position": (_("position"), Unit("m", 1.0)),
}
CALIBRATIONS = {
    "nominal": (_("uncalibrated"), "#a9b3be"),
    "published": (_("published"), "#cc79a7"),
    "calibrated": (_("calibrated"), drawing.AXIS_COLOUR["z"]),
}
KINDS = {"bias": _("bias"), "scale": _("scale factor"), "cross": _("cross-axis terms")}
OTHERS = {
    "noise white_noise": _("white noise while aligning and navigating"),
    "noise drift": _("bias instability and random walk since the alignment"),
    "earth_rate azimuth": _("the level earth rate, for the azimuth is not known"),
    "table angle": _("angle of the table"),
}
MIN_SHARE = 0.005  # below which a source is not listed
MOST_SOURCES = 8
Key = tuple[str, str, float | None]  # mount, motion, seconds; none: turns


def parts(tables: Tables) -> Iterator[outline.Part]:
    """A table of the errors, the longest course as a figure, a table of the shares."""
    rows = tables.rows("navigation_errors")
    groups = grouped((row for row in rows if row["predicted"] is not None), _key)
    if not groups:
        yield from (outline.Paragraph(f"{row['reason']}.") for row in rows[:1] if row["reason"])
        return
    yield _errors(groups)
    if untried := _untried(groups):
        yield outline.Paragraph(
            _(
                "The errors after {seconds} s at rest are predicted from the covariance and the "
                "noise, and not tried: no rest is so long beside its alignment.",
                seconds=listed(untried),
            )
        )
    yield from _courses(tables)
    yield _shares(tables, groups)


SECTION = outline.Section(
    "navigation",
    _("Navigation performance"),
    _(
        "The rests and whole turns of this campaign as free inertial navigation, before and after "
        "calibration: at rest, and after a whole turn, attitude, velocity and position should be "
        "those of the start. Every calibration aligns itself at rest before, level by its "
        "accelerometers, north by the plan, or by the earth's rate where the gyros show it. An "
        "error that this alignment removes is therefore not counted as a gain."
    ),
    _(
        "Errors are root mean squares over the manoeuvres, of all three axes; that of the attitude "
        "is its drift since the start. Predicted is what the covariance of the result and the "
        "noise lead to; in brackets its part by the parameters alone, which were estimated from "
        "these same data, so that the error found may be smaller. Where the campaign states power "
        "cycles, it contains that a bias differs from switch-on to switch-on."
    ),
    ("navigation_errors", "navigation_courses", "navigation_shares"),
    parts,
)


def _untried(groups: Mapping[Key, Sequence[Record]]) -> list[str]:
    """The times at rest, s, over which no rest of the campaign is tried on any mount."""
    tried: dict[float, bool] = {}
    for (_mount, _motion, seconds), rows in groups.items():
        if seconds is not None:
            found = any(row["calibrated"] is not None for row in rows)
            tried[seconds] = tried.get(seconds, False) or found
    return [numbers.whole(round(seconds)) for seconds in sorted(tried) if not tried[seconds]]


def _errors(groups: Mapping[Key, Sequence[Record]]) -> outline.Table:
    """A row for each motion, time and quantity."""
    published = any(row["published"] is not None for own in groups.values() for row in own)
    shown = [name for name in CALIBRATIONS if published or name != "published"]
    rows = [
        _error_row(key, quantity, [row for row in own if row["quantity"] == quantity], shown)
        for key, own in sorted(groups.items(), key=lambda item: _order(item[0]))
        for quantity in QUANTITIES
    ]
    return outline.Table(
        _("Errors of free inertial navigation."),
        (
            outline.Column(_("Motion"), "name"),
            outline.Column(_("Error of")),
            *outline.columns("number", *(CALIBRATIONS[name][0] for name in shown), group=_("rms")),
            outline.Column(_("predicted"), "number", _("rms")),
            outline.Column(_("(parameters)"), "number", _("rms")),
            outline.Column(_("unit"), "unit", _("rms")),
            outline.Column(_("manoeuvres"), "number"),
            outline.Column(_("χ² over its degrees"), "number"),
        ),
        rows,
        note=_(
            "χ² over its degrees, 3 for each manoeuvre: squared error after calibration by its "
            "predicted covariance; about 1 where the prediction is right, below 1 where it is too "
            "large. The parameters fit a part of the noise of these same manoeuvres, so it tends "
            "to be below 1."
        ),
    )


def _key(row: Record) -> Key:
    return row["mount"], row["motion"], None if row["motion"] == "turn" else row["seconds"]


def _order(key: Key) -> tuple[str, str, float]:
    return key[0], key[1], key[2] or 0.0


def _error_row(
    key: Key, quantity: str, rows: Sequence[Record], shown: Sequence[str]
) -> outline.Row:
    name, unit = QUANTITIES[quantity]
    tried = [row for row in rows if row["calibrated"] is not None]
    chi_squared = [row["normalised"] for row in tried]
    # Predictions beside errors that were found are those of the same manoeuvres.
    predicted = tried or rows
    return outline.table_row(
        _motion(key),
        name,
        *(_rms(tried, calibration, unit) for calibration in shown),
        _rms(predicted, "predicted", unit),
        f"({_rms(predicted, 'by_parameters', unit)})",
        unit.name,
        numbers.whole(len(tried)),
        numbers.fixed(sum(chi_squared) / len(tried) if tried else None, 2),
        anchor=rows[0]["id"],
    )


def _motion(key: Key) -> str:
    mount, _motion, seconds = key
    text = _("whole turn") if seconds is None else _("{seconds:.0f} s at rest", seconds=seconds)
    return with_mount(text, mount)


def _rms(rows: Sequence[Record], name: str, unit: Unit) -> str:
    values = [unit.of(row[name]) for row in rows if row[name] is not None]
    squares = [value**2 for value in values if value is not None]
    return numbers.significant(sqrt(sum(squares) / len(squares)) if squares else None, 2)


def _courses(tables: Tables) -> Iterator[outline.Figure]:
    """Errors against time in the longest rest of each mount."""
    by_mount = grouped(tables.rows("navigation_courses"), lambda row: row["mount"])
    for number, (mount, rows) in enumerate(by_mount.items(), 1):
        name = numbers.shortened(rows[0]["manoeuvre"], 60)
        yield outline.Figure(
            with_mount(
                _(
                    "{name}: errors against time; grey uncalibrated, blue calibrated, and the "
                    "band of ± 1 σ that is predicted for it.",
                    name=name,
                ),
                mount,
            ),
            _drawn(rows, f"navigation-{number}"),
            _("Errors of attitude, velocity and position of {name} against time.", name=name),
        )


def _drawn(rows: Sequence[Record], key: str) -> str:
    def panel_of(panel: Axes, quantity: str) -> None:
        name, unit = QUANTITIES[quantity]
        own = [row for row in rows if row["quantity"] == quantity and row["seconds"] > 0]
        at = np.array([row["seconds"] for row in own])
        predicted = np.array([row["predicted"] for row in own]) / unit.size
        colour = CALIBRATIONS["calibrated"][1]
        drawing.band(panel, at, 0 * predicted, predicted, colour, alpha=0.18, linewidth=0)
        for calibration, (_unused, line) in CALIBRATIONS.items():
            values = [row[calibration] for row in own]
            if None not in values:
                panel.plot(at, np.array(values) / unit.size, color=line)
        panel.set_title(f"{name}, {unit.name}", pad=3)
        panel.set_ylim(bottom=0)
        drawing.ticks(panel, 4)

    return drawing.grid(list(QUANTITIES), panel_of, 1.05, _("Time, s"), key)


def _shares(tables: Tables, groups: Mapping[Key, Sequence[Record]]) -> outline.Table:
    """What causes the predicted variance: families of parameters, and others."""
    keys = [key for key in sorted(groups, key=_order) if key[0] == min(groups, key=_order)[0]]
    total: dict[str, dict[tuple[Key, str], float]] = {}
    for row in tables.rows("navigation_shares"):
        place = (row["mount"], row["motion"], row["seconds"]), row["quantity"]
        own = total.setdefault(_family(row), {})
        own[place] = own.get(place, 0.0) + row["share"]
    largest = sorted(total, key=lambda name: -max(map(abs, total[name].values())))
    listed = [n for n in largest if max(map(abs, total[n].values())) >= MIN_SHARE][:MOST_SOURCES]
    columns = [(key, quantity) for key in keys for quantity in QUANTITIES]
    return outline.Table(
        _(
            "Shares of the predicted variance, per cent, over the manoeuvres of which the errors "
            "are predicted."
        ),
        (
            outline.Column(_("Source")),
            *(
                outline.Column(QUANTITIES[quantity][0], "number", _motion(key))
                for key, quantity in columns
            ),
        ),
        [
            outline.table_row(
                name,
                *(numbers.fixed(100 * total[name].get(column, 0.0), 1) for column in columns),
            )
            for name in listed
        ],
        note=_(
            "What two correlated parameters have in common counts by half for each, so a share "
            "may be negative."
        ),
    )


def _family(row: Record) -> str:
    """A family of sources in words."""
    sensor, _space, kind = row["family"].partition(" ")
    if sensor in SENSORS:
        name = KINDS.get(kind) or in_words(kind)
        said = name.startswith(SINGULAR[sensor])  # as that of an effect of the sensor does
        return name if said else f"{SINGULAR[sensor]}: {name}"
    return OTHERS[f"{row['family']} {row['source']}"]


# ---- Alignment at rest, and how far the attitude errs afterwards, with rotation and without.

MOST_FIGURES = 4
MARGINS = drawing.Margins(left=0.5, across=0.5)
ARC_MINUTE = units.Unit("arcmin", units.DEGREE / 60)
METHODS = {"static": _("means at rest"), "rotation": _("the turn that follows")}
UNITS = {"rad": units.DEGREES, "rad/s": units.DEGREES_PER_HOUR}


def alignment_parts(tables: Tables) -> Iterator[outline.Part]:
    """Nothing where the campaign has no alignment."""
    rows = tables.rows("alignments")
    if not rows:
        return
    yield outline.Table(
        _("Alignment by the means at rest and, where a turn follows, by that turn."),
        (
            *outline.columns("text", _("Alignment"), _("By"), _("Readings"), _("Quantity")),
            outline.Column(_("value"), "number"),
            outline.Column("± σ", "sigma"),
            outline.Column(_("known"), "number"),
            outline.Column(_("unit"), "unit"),
        ),
        [_row(row) for row in rows],
        note=_(
            "Tilt: at rest of the case, with the biases of the accelerometers in it; by a turn of "
            "the axis it is about. The level rate is the horizontal part of the earth's rate."
        ),
    )
    if wrong := [row for row in rows if row["method"] == "static" and row["per_bias"]]:
        per_hour = wrong[0]["per_bias"] * units.DEGREE_PER_HOUR / units.DEGREE
        yield outline.Paragraph(
            _(
                "At rest a bias of the gyros to the east of 1 °/h turns the azimuth by {turned}°, "
                "and nothing there tells the two apart. A turn does: the bias turns with the case, "
                "the earth's rate does not.",
                turned=numbers.significant(per_hour, 2),
            )
        )
    curves = tables.rows("attitude_errors")
    kinds = [(key, list(own)) for key, own in groupby(curves, key=_case)]
    for number, (key, own) in enumerate(kinds[:MOST_FIGURES]):
        yield _figure(number, key, own)
    yield from (outline.Paragraph(_gain(row)) for row in tables.rows("modulation_gains"))


ALIGNMENT = outline.Section(
    "alignment",
    _("Alignment and rotation modulation"),
    _(
        "The attitude found at rest, and the integral of the rate that remains after it: over a "
        "turn about the vertical and at rest."
    ),
    _(
        "What is fixed in the case, the bias and the cross terms of the rate, goes round with "
        "it, so its integral in the level frame is bounded; at rest it grows with time. Along the "
        "vertical nothing is modulated, and the scale factor's error times the angle remains."
    ),
    ("alignments", "attitude_errors", "modulation_gains"),
    alignment_parts,
)


def _row(row: Record) -> outline.Row:
    unit = UNITS[row["unit"]]
    if row["quantity"].startswith("tilt"):
        unit = units.SECONDS_OF_ARC
    value, sigma = unit.of(row["value"]), unit.of(row["sigma"])
    decimals = numbers.decimals_of(sigma)
    quantity = str(row["quantity"]).replace("_", " ")
    if row["direction"]:
        quantity = _("azimuth of {direction}", direction=row["direction"])
    known = "" if row["known"] is None else numbers.fixed(unit.of(row["known"]), decimals or 0)
    return outline.table_row(
        numbers.shortened(row["alignment"], 60),
        METHODS[row["method"]],
        row["readings"],
        quantity,
        *numbers.with_sigma(value, sigma, decimals),
        known,
        unit.name,
    )


def _case(row: Record) -> tuple[str, str, str]:
    return row["mount"], row["alignment"], row["readings"]


def _figure(number: int, key: tuple[str, str, str], rows: Sequence[Record]) -> outline.Figure:
    """The level error against time with its prediction, and the error about the vertical."""
    with drawing.style():
        figure, [axes] = drawing.panels(1, 2, 1.6, MARGINS)
        runs = {name: list(own) for name, own in groupby(rows, key=lambda row: row["manoeuvre"])}
        for name, own in runs.items():
            colour = drawing.AXIS_COLOUR["z" if own[0]["modulated"] else "x"]
            seconds, sigma = arrays(own, "seconds", "sigma")
            for panel, level in zip(axes, (True, False), strict=True):
                measured, predicted = (_size(own, prefix, level) for prefix in ("", "predicted_"))
                reach = sigma / ARC_MINUTE.size
                drawing.band(panel, seconds, measured - reach, measured + reach, colour, alpha=0.2)
                panel.plot(seconds, measured, color=colour, label=numbers.shortened(name, 24))
                panel.plot(seconds, predicted, color=drawing.INK, linewidth=0.6, linestyle="--")
        for panel, title in zip(axes, (_("levels"), _("about the vertical")), strict=True):
            panel.set_title(f"{title}, {ARC_MINUTE.name}", pad=3)
            panel.set_xlabel(_("Time, s"))
        axes[0].legend(loc="upper left")
        drawn = drawing.svg(figure, f"alignment-{number}")
    _mount, alignment, readings = key
    return outline.Figure(
        _(
            "Attitude error after {alignment}, readings {readings}: the integral of the rate that "
            "remains ± σ of white noise; dashed: as predicted from what is fixed in the case.",
            alignment=numbers.shortened(alignment, 60),
            readings=readings,
        ),
        drawn,
        _("Attitude error against time with rotation and without."),
    )


def _size(rows: Sequence[Record], prefix: str, level: bool) -> drawing.Array:
    """The error of the levels, or that about the vertical, arc minutes."""
    if not level:
        return arrays(rows, f"{prefix}up")[0] / ARC_MINUTE.size
    east, north = arrays(rows, f"{prefix}east", f"{prefix}north")
    return np.asarray(np.hypot(east, north) / ARC_MINUTE.size)


def _gain(row: Record) -> str:
    factor, sigma = numbers.with_own_sigma(row["factor"], row["factor_sigma"])
    still, modulated = (
        numbers.significant(ARC_MINUTE.of(row[key]), 3)
        for key in ("still_error", "modulated_error")
    )
    return _(
        "Readings {readings}: within {seconds} s the levels err by up to {still} arcmin at rest "
        "and by {modulated} arcmin under rotation, {factor} ± {sigma} times less; what is fixed in "
        "the case explains {predicted} times.",
        readings=row["readings"],
        seconds=numbers.fixed(row["seconds"], 0),
        still=still,
        modulated=modulated,
        factor=factor,
        sigma=sigma,
        predicted=numbers.significant(row["predicted_factor"], 3),
    )
