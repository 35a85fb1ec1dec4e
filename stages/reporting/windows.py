"""Gyro parameters by windows of two turns: against their start, and against their angle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import degrees

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from inertial.text import numbers
from inertial.text.units import DEGREES_PER_HOUR, PPM, Unit
from stages.reporting.drawing import AXIS_COLOUR, INK, QUIET, Margins, panels, style, svg
from stages.reporting.outline import Column, Figure, Paragraph, Part, Row, Table
from stages.reporting.rows import Record, records

Array = NDArray[np.float64]

CLOSE = 1.0  # s
MOST_PAIRS = 6
NEAR = 5.0  # °, of a window that stands for one of a round angle
FAR = 5.0  # sigmas of a half turn that a panel of growing windows shows
ALIAS = "Not every sample is drawn: a fast oscillation shows its size here, not its frequency."
BY = {
    "whole turn": "the whole turn",
    "set rate": "180° by time, at the set rate",
    "own angle": "180° by the time and angle of these turns",
    "other turns": "180° by the speed of turns about other axes",
}
MARGINS = Margins(left=0.5, across=0.52, down=0.42, top=0.26)


def parts(windows: pd.DataFrame, growing: pd.DataFrame, middles: pd.DataFrame) -> Iterator[Part]:
    """Both figures with what they say, and the middle of the turns as a table."""
    whole = {_pair(row): row for row in records(middles) if row["by"] == "whole turn"}
    slides, grows = (_by_time(frame, whole) for frame in (windows, growing))
    if slides:
        yield _sliding(slides, whole)
        yield from (Paragraph(_said_of_place(rows, whole[pair])) for pair, rows in slides.items())
    if grows:
        yield _growing(grows, whole)
        yield from (Paragraph(_said_of_angle(rows, whole[pair])) for pair, rows in grows.items())


def middle(middles: pd.DataFrame) -> Table:
    """The scale factor of each gyro by the whole turn and by the middle 180°."""
    rows = records(middles)
    whole = {_pair(row): row for row in rows if row["by"] == "whole turn"}
    return Table(
        "Scale factor by the whole turn, and by the middle 180° of the same turns.",
        (
            Column("Turns", "name"),
            Column("Angle of the table"),
            Column("scale", "number", "ppm"),
            Column("± σ", "sigma", "ppm"),
            Column("less whole turn", "number", "ppm"),
            Column("± σ", "sigma", "ppm"),
        ),
        tuple(_middle(row, whole[_pair(row)]) for row in rows),
        empty="None: no pair of whole turns there and back was recorded.",
        note="By time, σ holds what is stated of the table's rate; the last column holds noise and "
        "what an oscillation leaves alone, so a difference far beyond it is the table's speed.",
    )


def _pair(row: Record) -> tuple[str, str, str]:
    return row["axis"], row["forward"], row["backward"]


def _by_time(
    frame: pd.DataFrame, whole: dict[tuple[str, str, str], Record]
) -> dict[tuple[str, str, str], list[Record]]:
    found: dict[tuple[str, str, str], list[Record]] = {}
    for row in records(frame):
        if row["by"] == "set rate" and _pair(row) in whole:
            found.setdefault(_pair(row), []).append(row)
    return dict(list(found.items())[:MOST_PAIRS])


def _column(rows: Sequence[Record], key: str, unit: Unit) -> Array:
    return np.array([row[key] for row in rows], dtype=np.float64) / unit.size


def _sliding(
    slides: dict[tuple[str, str, str], list[Record]], whole: dict[tuple[str, str, str], Record]
) -> Figure:
    with style():
        drawn, axes = panels(len(slides), 3, 0.95, MARGINS, sharex=False)
        for line, (pair, rows) in zip(axes, slides.items(), strict=True):
            close = [row for row in rows if row["from_s"] <= CLOSE]
            for panel, own, key, unit in (
                (line[0], rows, "scale", PPM),
                (line[1], close, "scale", PPM),
                (line[2], rows, "bias", DEGREES_PER_HOUR),
            ):
                sigma = "cut_sigma" if key == "scale" else "bias_sigma"
                start = [row["from_s"] for row in own]
                _curve(panel, pair[0], start, own, key, sigma, unit)
                _level(panel, whole[pair], key, unit)
                panel.set_title(f"{pair[0]} gyro: {key}, {unit.name}", pad=3)
            line[1].set_ylim(line[0].get_ylim())
        for panel in axes[-1]:
            panel.set_xlabel("Start in the steady part, s")
        text = svg(drawn, "windows")
    count = numbers.whole(next(iter(slides.values()))[0]["samples"])
    return Figure(
        f"Windows of 180° by time ({count} samples at the set rate) against where they start: over "
        "the steady part, its first second close up, and the bias. Coloured band: ± σ of noise and "
        f"oscillation, without the table's speed; grey: the whole turn ± σ. {ALIAS}",
        text,
        "Scale factor and bias by a window of 180° against its start.",
    )


def _growing(
    grows: dict[tuple[str, str, str], list[Record]], whole: dict[tuple[str, str, str], Record]
) -> Figure:
    with style():
        drawn, axes = panels(len(grows), 2, 0.95, MARGINS, sharex=False)
        for line, (pair, rows) in zip(axes, grows.items(), strict=True):
            half = min(rows, key=lambda row: abs(row["angle"] - np.pi))
            for panel, key, unit in zip(
                line, ("scale", "bias"), (PPM, DEGREES_PER_HOUR), strict=True
            ):
                sigma = "cut_sigma" if key == "scale" else "bias_sigma"
                angle = [degrees(row["angle"]) for row in rows]
                _curve(panel, pair[0], angle, rows, key, sigma, unit)
                _level(panel, whole[pair], key, unit)
                reach = FAR * half[sigma] / unit.size
                middle = whole[pair][key] / unit.size
                panel.set_ylim(middle - reach, middle + reach)
                panel.set_title(f"{pair[0]} gyro: {key}, {unit.name}", pad=3)
        for panel in axes[-1]:
            panel.set_xlabel("Angle from the start of the steady part, °")
        text = svg(drawn, "growing")
    return Figure(
        "Windows by time from the start of the steady part to an angle that grows. Coloured band: "
        "± σ of noise and of an oscillation cut at any phase, without the table's speed; grey: the "
        f"whole turn ± σ. {ALIAS}",
        text,
        "Scale factor and bias against the angle of the window.",
    )


def _curve(
    panel: Axes,
    axis: str,
    place: Sequence[float],
    rows: Sequence[Record],
    key: str,
    sigma_key: str,
    unit: Unit,
) -> None:
    value, sigma = _column(rows, key, unit), _column(rows, sigma_key, unit)
    colour = AXIS_COLOUR.get(axis, INK)
    panel.fill_between(place, value - sigma, value + sigma, color=colour, alpha=0.2, linewidth=0)
    panel.plot(place, value, color=colour, linewidth=0.8)
    panel.yaxis.set_major_locator(MaxNLocator(4))
    panel.yaxis.get_major_formatter().set_useOffset(False)  # type: ignore[attr-defined]


def _level(panel: Axes, whole: Record, key: str, unit: Unit) -> None:
    value, sigma = whole[key] / unit.size, whole[f"{key}_sigma"] / unit.size
    panel.axhspan(value - sigma, value + sigma, color=QUIET, alpha=0.2, linewidth=0)
    panel.axhline(value, color=INK, linewidth=0.7)


def _said_of_place(rows: Sequence[Record], whole: Record) -> str:
    """How far the result goes up and down with the place of the window."""
    value = _column(rows, "scale", PPM)
    cut, mean = PPM.of(rows[0]["cut_sigma"]), float(value.mean())
    off = numbers.fixed(mean - whole["scale"] / PPM.size, 1)
    least, most, wander = (
        numbers.fixed(float(one), 1) for one in (value.min(), value.max(), value.std())
    )
    own = numbers.fixed(PPM.of(whole["scale_sigma"]), 1)
    return (
        f"{whole['axis']} gyro, {_names(whole)}: wherever the 180° lie, the scale factor is "
        f"between {least} and {most} ppm, {wander} ppm rms about its mean, where noise and what an "
        f"oscillation leaves of a window of this length allow {numbers.fixed(cut, 1)} ppm. Its "
        f"mean is off that of the whole turn, which is known to {own} ppm, by {off} ppm."
    )


def _said_of_angle(rows: Sequence[Record], whole: Record) -> str:
    """How far the result still is from that of the whole turn at some angles."""
    told = []
    for wanted in (90.0, 180.0, 270.0, degrees(rows[-1]["angle"])):
        row = min(rows, key=lambda row: abs(degrees(row["angle"]) - wanted))
        if abs(degrees(row["angle"]) - wanted) < NEAR:
            off = numbers.fixed(PPM.of(row["scale"] - whole["scale"]), 1)
            sigma = numbers.fixed(PPM.of(row["cut_sigma"]), 1)
            told.append(f"{off} ± {sigma} ppm at {numbers.fixed(wanted, 0)}°")
    return (
        f"{whole['axis']} gyro, {_names(whole)}: off the whole turn by {'; '.join(told)}. The "
        "larger the angle, the less count noise and an oscillation that is cut."
    )


def _names(row: Record) -> str:
    return f"{numbers.shortened(row['forward'], 30)} and {numbers.shortened(row['backward'], 30)}"


def _middle(row: Record, whole: Record) -> Row:
    is_whole = row["by"] == "whole turn"
    apart = row["cut_sigma"] if row["by"] != "other turns" else row["scale_sigma"]
    sigma = None if is_whole or not apart else float(np.hypot(apart, whole["scale_sigma"]))
    off = None if is_whole else PPM.of(row["scale"] - whole["scale"])
    decimals = numbers.decimals_of(PPM.of(whole["scale_sigma"])) or 1
    return Row(
        (
            _names(row),
            BY.get(row["by"], str(row["by"])),
            numbers.fixed(PPM.of(row["scale"]), decimals),
            numbers.fixed(PPM.of(row["scale_sigma"]), decimals),
            numbers.fixed(off, decimals),
            numbers.fixed(PPM.of(sigma), decimals),
        )
    )
