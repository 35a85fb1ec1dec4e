"""The raw data of every log."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from inertial.tables import AXES
from inertial.text import numbers
from inertial.text.units import DEGREES_PER_HOUR, DEGREES_PER_SECOND, METRES, MILLIMETRES, Unit
from stages.reporting.drawing import (
    AXIS_COLOUR,
    QUIET,
    Margins,
    hatch_missing,
    panels,
    shade,
    style,
    svg,
)
from stages.reporting.logs import Log, envelope
from stages.reporting.outline import Figure, Paragraph, Part, Section

MOST_POINTS = 45_000  # of all figures together: what a page may weigh
POINTS_PER_CURVE = (60, 380)
MANY_LOGS = 24  # from here on the figures are small, x, y and z in one panel
MOST_LOGS = 110
SMALL_RATE = 0.2 * DEGREES_PER_SECOND.size
ABSOLUTE = {"gyro": DEGREES_PER_SECOND, "accel": METRES}


def section(found: Sequence[Log]) -> Section:
    """One figure per log."""
    points = int(np.clip(MOST_POINTS / (6 * max(len(found), 1)), *POINTS_PER_CURVE))
    small = len(found) > MANY_LOGS
    parts: list[Part] = [
        _figure(log, f"log-{number}", points, small)
        for number, log in enumerate(found[:MOST_LOGS], 1)
    ]
    if len(found) > MOST_LOGS:
        more = numbers.counted(len(found) - MOST_LOGS, "further log")
        parts.append(Paragraph(f"{more} not drawn, to keep the page light."))
    if not found:
        parts.append(Paragraph("None: no log gave samples that could be drawn.", "poor"))
    elif not any(log.missing for log in found):
        parts.append(Paragraph("Missing stretches: none.", "good"))
    return Section(
        "raw-data",
        "Raw data",
        "Gyroscope and accelerometer of every log, as recorded.",
        "Each band runs from the smallest to the largest sample of a short stretch, so no spike is "
        "lost. Logs at rest are drawn about their middle, so that deviations show. Behind the "
        "curves, x orange, y green, z blue: rest grey, spin-up and spin-down yellow, steady turn "
        "blue; hatched: not recorded, close up among the findings.",
        parts,
    )


# ---- how it is drawn


def _figure(log: Log, key: str, points: int, small: bool) -> Figure:
    manoeuvres = list(dict.fromkeys(row["manoeuvre"] for row in log.phases))
    named = ", ".join(manoeuvres[:6]) + (
        f" and {len(manoeuvres) - 6} more" if len(manoeuvres) > 6 else ""
    )
    length = log.extent[1] - log.extent[0]
    lasting = f", {numbers.fixed(length, 1)} s" if log.timed else ", without time stamps"
    view = "each channel about its middle" if log.static else "as recorded"
    found = numbers.shortened(named, 160) or "no manoeuvre found"
    caption = (
        f"{numbers.shortened(log.name, 80)}: {found}; "
        f"{numbers.counted(log.records, 'sample')}{lasting}; {view}."
    )
    if log.missing:
        caption += f" Gaps of {numbers.fixed(log.lost, 2)} s in all, from record to record."
    drawn = _draw(log, key, points, about_middle=log.static, small=small)
    words = f"Six curves over time: rates and specific forces of x, y and z of the log {log.name}."
    return Figure(caption, drawn, words, "fair" if log.missing else "")


def _draw(
    log: Log,
    key: str,
    points: int,
    *,
    about_middle: bool = False,
    small: bool = False,
) -> str:
    """Gyroscope on the left, accelerometer on the right, one panel per axis."""
    with style():
        figure, axes = panels(1, 2, 0.75, Margins()) if small else panels(3, 2, 0.62, Margins())
        for column, sensor in enumerate(("gyro", "accel")):
            middles = {a: _middle(log, f"{sensor}_{a}") if about_middle else 0.0 for a in AXES}
            unit = _unit(log, sensor, middles) if about_middle else ABSOLUTE[sensor]
            own = [row[column] for row in axes]
            for panel in own:
                _background(panel, log)
            for panel, axis in zip(own * 3 if small else own, AXES, strict=True):
                _curve(panel, log, f"{sensor}_{axis}", points, unit, middles[axis])
                if not small:
                    label = _label(axis, middles[axis], sensor) if about_middle else axis
                    panel.set_title(
                        label, loc="right", color=AXIS_COLOUR[axis], fontsize=6.5, pad=2
                    )
            name = "Angular rate" if sensor == "gyro" else "Specific force"
            own[0].set_title(f"{name}, {unit.name}", loc="left", pad=2)
            own[-1].set_xlabel("Time, s" if log.timed else "Record")
        if len(log.start):
            left, right = log.extent
            axes[0][0].set_xlim(left, right if right > left else left + 1.0)
        return svg(figure, key)


def _background(panel: Axes, log: Log) -> None:
    """The phases behind the curves, and what is missing."""
    for row in log.phases:
        shade(panel, row["phase"], row["start"], row["end"])
    for start, end in log.missing:
        hatch_missing(panel, start, end)
    panel.yaxis.set_major_locator(MaxNLocator(4))
    panel.ticklabel_format(axis="y", useOffset=False)


def _curve(panel: Axes, log: Log, channel: str, points: int, unit: Unit, middle: float) -> None:
    """One channel as the band from its smallest to its largest samples."""
    if not len(log.start) or not np.isfinite(log.least[channel]).any():
        panel.annotate(
            "not recorded",
            (0.5, 0.5),
            xycoords="axes fraction",
            ha="center",
            va="center",
            color=QUIET,
        )
        return
    time, low, high = envelope(log, channel, points)
    panel.fill_between(
        time,
        (low - middle) / unit.size,
        (high - middle) / unit.size,
        color=AXIS_COLOUR[channel[-1]],
        linewidth=0.5,
        zorder=2,
    )


def _label(axis: str, middle: float, sensor: str) -> str:
    if not np.isfinite(middle):
        return axis
    unit = ABSOLUTE[sensor]
    return f"{axis}, about {numbers.fixed(unit.of(middle), 5)} {unit.name}"


def _middle(log: Log, channel: str) -> float:
    both = (log.least[channel] + log.most[channel]) / 2
    return float(np.nanmedian(both)) if np.isfinite(both).any() else float("nan")


def _unit(log: Log, sensor: str, middles: dict[str, float]) -> Unit:
    """The unit in which the largest deviation of a log at rest has few digits."""
    largest = max(
        (
            float(np.nanmax(np.abs(values[f"{sensor}_{axis}"] - middles[axis])))
            for values in (log.least, log.most)
            for axis in AXES
            if np.isfinite(middles[axis])
        ),
        default=0.0,
    )
    if sensor == "gyro":
        return DEGREES_PER_HOUR if largest < SMALL_RATE else DEGREES_PER_SECOND
    return MILLIMETRES if largest < 1.0 else METRES
