"""The table's angle as a function of time, beside the trapezoid that was set."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from inertial.text import numbers
from inertial.text.units import DEGREE, PPM, SECONDS_OF_ARC
from stages.reporting.drawing import INK, QUIET, Margins, panels, style, svg
from stages.reporting.outline import Column, Equation, Figure, Paragraph, Part, Row, Table
from stages.reporting.rows import Record, records

COLUMNS = 3
MOST_TURNS = 9
COLOUR = "#0072b2"
RAMPS = (("Spin-up", "spin-up"), ("Spin-down", "spin-down"))
SET = (
    ("speed", DEGREE, "°/s"),
    ("spin-up acceleration", DEGREE, "°/s²"),
    ("spin-up seconds", 1.0, "s a ramp"),
)
LIMITS = (
    "Where it helps: it tells what the table did between its ends, so its real speed and its "
    "ramps, and serves other gyros, other turns, and marks at fixed angles. By the speed of turns "
    "about other axes the middle 180° become as good as their noise, whatever the table was set "
    "to, if it keeps the same speed in all of them.",
    "Where it cannot help: by the angle of its own turn a window gives the whole turn's scale "
    "factor again, for the gyro is measured by itself. That agreement shows only that nothing "
    "changed within the turn. And if all gyros read too much by one share, the same logs are those "
    "of a table that turned faster by that share and further: without the known whole angle a "
    "common scale factor and the table's speed are one unknown. An angle that the table itself "
    "records breaks it.",
)


def parts(time_angle: pd.DataFrame, motions: pd.DataFrame) -> Iterator[Part]:
    """The equation, a figure of what the angle differs by from what was set, speed and ramps."""
    rows, numbers_of = records(time_angle), records(motions)
    if not rows:
        return
    yield Equation(
        "θ(t) = A · C(t) / C(T)",
        "C: what the gyro along the axis summed, less bias and earth; A: the known whole angle.",
    )
    turns: dict[str, list[Record]] = {}
    for row in rows:
        turns.setdefault(row["manoeuvre"], []).append(row)
    yield _figure(turns)
    yield from (Paragraph(text) for text in _said(turns, numbers_of))
    yield _table(numbers_of)


def limits() -> Iterator[Paragraph]:
    """What the function is good for, and what not."""
    for text in LIMITS:
        yield Paragraph(text)


def _figure(turns: dict[str, list[Record]]) -> Figure:
    names = list(turns)[:MOST_TURNS]
    lines = -(-len(names) // COLUMNS)
    with style():
        drawn, axes = panels(lines, COLUMNS, 0.95, Margins(left=0.45, across=0.4, down=0.3))
        each = [panel for line in axes for panel in line]
        for panel, name in zip(each, names, strict=False):
            _panel(panel, name, turns[name])
        for panel in each[len(names) :]:
            panel.set_visible(False)
        for panel in each[max(0, len(names) - COLUMNS) : len(names)]:
            panel.tick_params(labelbottom=True)
            panel.set_xlabel("Time, s")
        text = svg(drawn, "time-angle")
    more = len(turns) - len(names)
    left = f" {numbers.whole(more)} more in the table time_angle." if more else ""
    return Figure(
        "Angle of the table less that of the set trapezoid, which is laid through the steady "
        "part, arcsec, and ± σ of the angle. σ is "
        "zero at the start and that of the known whole angle at the end. Light blue: the swing of "
        f"what is faster than the line is drawn.{left}",
        text,
        "The table's angle against time, less the trapezoid that was set.",
    )


def _panel(panel: Axes, name: str, rows: Sequence[Record]) -> None:
    time, angle, set_angle, sigma, swing = (
        np.array([np.nan if row[key] is None else row[key] for row in rows], dtype=np.float64)
        for key in ("seconds", "angle", "set_angle", "sigma", "swing")
    )
    off, sigma, swing = (
        values / SECONDS_OF_ARC.size for values in (angle - set_angle, sigma, swing)
    )
    panel.axhline(0, color=INK, linewidth=0.6)
    panel.fill_between(time, -sigma, sigma, color=QUIET, alpha=0.25, linewidth=0)
    panel.fill_between(time, off - swing, off + swing, color=COLOUR, alpha=0.3, linewidth=0)
    panel.plot(time, off, color=COLOUR, linewidth=0.7)
    panel.set_title(numbers.shortened(name, 30), pad=3)
    panel.yaxis.set_major_locator(MaxNLocator(4))


def _said(turns: dict[str, list[Record]], rows: Sequence[Record]) -> Iterator[str]:
    speeds = [row for row in rows if row["quantity"] == "speed" and row["set_value"]]
    if speeds:
        off = [(row["value"] / row["set_value"] - 1) / PPM.size for row in speeds]
        sigma = [row["sigma"] / row["set_value"] / PPM.size for row in speeds]
        yield (
            f"In the steady part of {numbers.counted(len(speeds), 'turn')} the table was off its "
            f"set rate by {numbers.fixed(min(off), 1)} to {numbers.fixed(max(off), 1)} ppm, known "
            f"to {numbers.fixed(min(sigma), 1)} to {numbers.fixed(max(sigma), 1)} ppm in each. By "
            "just this share a window by time is wrong in its scale factor."
        )
    sigma, name = max((row["sigma"], name) for name, own in turns.items() for row in own)
    yield (
        f"Between its ends the angle is known to {_seconds(sigma)} arcsec or better "
        f"({numbers.shortened(name, 30)} at most); an oscillation of the case counts as motion."
    )


def _seconds(sigma: float) -> str:
    return numbers.significant(SECONDS_OF_ARC.of(sigma), 2)


def _table(rows: Sequence[Record]) -> Table:
    turns: dict[str, dict[str, Record]] = {}
    for row in rows:
        turns.setdefault(row["manoeuvre"], {})[row["quantity"]] = row
    columns = [
        Column("Turn", "name"),
        Column("°/s", "number", "Speed"),
        Column("± σ", "sigma", "Speed"),
    ]
    for name, _ in RAMPS:
        columns += [Column("s", "number", name), Column("± σ", "sigma", name)]
        columns += [Column("°/s²", "number", name), Column("± σ", "sigma", name)]
    quantities = [
        "speed",
        *(f"{key} {of}" for _, key in RAMPS for of in ("seconds", "acceleration")),
    ]
    return Table(
        "Speed and ramps by time and angle; the ramps as if their acceleration were constant.",
        tuple(columns),
        tuple(
            Row((numbers.shortened(turn, 40), *_cells(own, quantities)))
            for turn, own in turns.items()
        ),
        empty="None.",
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
            yield from numbers.with_sigma(row["value"] / size, sigma, numbers.decimals_of(sigma))


def _was_set(rows: Sequence[Record]) -> str:
    """What was set, where it is the same for all turns."""
    said = []
    for quantity, size, unit in SET:
        values = {row["set_value"] for row in rows if row["quantity"] == quantity}
        if len(values) == 1 and None not in values:
            said.append(f"{numbers.significant(values.pop() / size, 4)} {unit}")
    return f"Set: {', '.join(said)}." if said else ""
