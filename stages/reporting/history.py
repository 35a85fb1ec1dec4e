"""Earlier calibrations of the same instrument, and where this one is kept."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from inertial.tables import AXES
from inertial.text import numbers
from inertial.text.units import quantity
from stages.reporting.drawing import AXIS_COLOUR, AXIS_MARK, INK, Margins, panels, style, svg
from stages.reporting.outline import Column, Figure, Paragraph, Part, Row, Section, Table
from stages.reporting.parameters import KIND, SENSOR
from stages.reporting.rows import Record, records

FOLDER = "data/history"
MOST_DRAWN = 12
MOST_ROWS = 40
THIS = "this one"


def section(
    earlier: pd.DataFrame, archived: pd.DataFrame, parameters: Sequence[Record], date: str | None
) -> Section:
    """The earlier ones as a table, bias and scale over the dates, and this one's archive file."""
    now = {row["id"]: row for row in parameters if row["value"] is not None}
    by_file: dict[str, list[Record]] = {}
    for row in records(earlier):
        by_file.setdefault(row["file"], []).append(row)
    calibrations = sorted(by_file.values(), key=_when)
    parts: list[Part] = []
    if calibrations:
        parts.append(_table(calibrations, now))
        parts.append(_figure(calibrations[-MOST_DRAWN + 1 :], now, date))
    else:
        parts.append(
            Paragraph("None: the archive holds no earlier calibration of this instrument.")
        )
    parts += [_kept(row) for row in records(archived)] or [
        Paragraph("This calibration is not in the archive.", "fair")
    ]
    return Section(
        "history",
        "Earlier calibrations",
        "What the same instrument, by its serial, was found to be before; and where this "
        "calibration is kept.",
        "Each point is value ± σ of the result that counts, of the joint fit or of the one with "
        "effects in the model, drawn from the last value. A bias may change "
        "from one time that the instrument is switched on to the next; a scale error should not.",
        parts,
    )


def _when(rows: Sequence[Record]) -> tuple[bool, str, str]:
    """Unknown dates first, then by date."""
    date = rows[0]["date"]
    return date[:1].isdigit(), date, rows[0]["file"]


def _kept(row: Record) -> Paragraph:
    text = f"This calibration is kept in the archive as {FOLDER}/{row['file']}"
    if row["supersedes"]:
        text += f"; it supersedes {row['supersedes']}"
    return Paragraph(numbers.shortened(f"{text}. SHA-256 of the file: {row['sha256']}.", 900))


def _table(calibrations: Sequence[Sequence[Record]], now: dict[str, Record]) -> Table:
    shown = calibrations[-MOST_ROWS:]
    more = len(calibrations) - len(shown)
    return Table(
        f"{numbers.counted(len(calibrations), 'earlier calibration').capitalize()}, the latest "
        "last.",
        (
            Column("Date", "name"),
            Column("Campaign"),
            Column("Parameters", "number"),
            Column("Largest change since, in σ", "number"),
            Column("of"),
            Column("File", "code"),
        ),
        tuple(_row(rows, now) for rows in shown),
        note=f"{numbers.whole(more)} more before these." if more > 0 else "",
    )


def _row(rows: Sequence[Record], now: dict[str, Record]) -> Row:
    changes = [
        (abs(now[row["id"]]["value"] - row["value"]) / both, row["id"])
        for row in rows
        if row["id"] in now and (both := hypot(row["sigma"], now[row["id"]]["sigma"] or 0.0)) > 0
    ]
    largest, identifier = max(changes, default=(None, ""))
    return Row(
        (
            numbers.shortened(rows[0]["date"], 20),
            numbers.shortened(rows[0]["campaign"], 80),
            numbers.whole(len(rows)),
            numbers.fixed(largest, 1),
            numbers.shortened(identifier, 80) or "—",
            numbers.shortened(rows[0]["file"], 200),
        )
    )


def _figure(
    calibrations: Sequence[Sequence[Record]], now: dict[str, Record], date: str | None
) -> Figure:
    """Bias and scale of each sensor, one panel each, x, y and z beside each other."""
    each = [{row["id"]: row for row in rows} for rows in calibrations] + [now]
    labels = [numbers.shortened(rows[0]["date"], 12) for rows in calibrations]
    labels.append(f"{numbers.shortened(date or 'unknown', 12)}\n{THIS}")
    with style():
        figure, axes = panels(
            2, 2, 0.95, Margins(left=0.6, across=0.7, bottom=0.5, down=0.3), sharex=True
        )
        for stage, row in zip(SENSOR, axes, strict=True):
            for kind, panel in zip(("bias", "scale"), row, strict=True):
                _panel(panel, stage, kind, each)
                panel.set_xticks(range(len(labels)), labels)
                panel.tick_params(axis="x", labelrotation=0 if len(labels) < 5 else 60)
        drawn = svg(figure, "history")
    return Figure(
        "Bias and scale error of the joint fits over the calibrations, each with its σ, less their "
        "last value: x orange "
        "circles, y green squares, z blue triangles.",
        drawn,
        "Bias and scale error of both sensors against the dates of the calibrations.",
    )


def _panel(panel: Axes, stage: str, kind: str, each: Sequence[dict[str, Record]]) -> None:
    unit = quantity(f"{kind}_x", {"accelerometer": "m/s²", "gyroscope": "rad/s"}[stage])
    if kind == "scale":
        unit = quantity("scale_x", "1")
    for place, axis in enumerate(AXES):
        found = [
            (number + (place - 1) * 0.12, rows[f"{stage}/joint/{kind}_{axis}"])
            for number, rows in enumerate(each)
            if f"{stage}/joint/{kind}_{axis}" in rows
        ]
        # A change is small beside the value itself, so it is drawn from the last value.
        last = found[-1][1]["value"] if found else 0.0
        panel.errorbar(
            [x for x, _ in found],
            [(row["value"] - last) / unit.laboratory.size for _, row in found],
            [(row["sigma"] or 0.0) / unit.laboratory.size for _, row in found],
            color=AXIS_COLOUR[axis],
            marker=AXIS_MARK[axis],
            markersize=3,
            linestyle="none",
            elinewidth=0.8,
            capsize=2,
        )
    name = f"{SENSOR[stage]}, {KIND[kind].lower()} less its last value"
    panel.set_title(f"{name}, {unit.laboratory.name}", loc="left", pad=2)
    panel.axhline(0, color=INK, linewidth=0.4)
    panel.set_xlim(-0.5, len(each) - 0.5)
    panel.yaxis.set_major_locator(MaxNLocator(4))
