"""The white noise of every channel in every manoeuvre, beside the data sheet."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import median

import pandas as pd

from inertial.tables import AXES, CHANNELS
from inertial.text import numbers
from inertial.text.units import RANDOM_WALK
from stages.reporting.drawing import (
    AXIS_COLOUR,
    AXIS_MARK,
    INK,
    Margins,
    panels,
    plain_numbers,
    style,
    svg,
)
from stages.reporting.outline import Column, Figure, Part, Row, Section, Table
from stages.reporting.rows import Record, records

SENSOR = {"gyro": "Angle random walk", "accel": "Velocity random walk"}
DATA_SHEET = "data sheet"
MOST_ROWS = 48
MOST_NAMES = 30
Place = tuple[str, str]


def section(noise: pd.DataFrame, sensors: pd.DataFrame) -> Section:
    """A figure of all manoeuvres, a table by channel and one by manoeuvre."""
    rows = records(noise)
    sheet = {row["channel"]: row["white_noise"] for row in records(sensors)}
    sources = list(dict.fromkeys(row["source"] for row in records(sensors) if row["source"]))
    parts: list[Part] = [_summary(rows, sheet, sources)]
    if rows:
        parts = [_figure(rows, sheet), *parts, *(_by_manoeuvre(rows, sensor) for sensor in SENSOR)]
    return Section(
        "noise",
        "Noise",
        "The white noise of each channel, estimated from the data of each manoeuvre. Every σ of "
        "this report rests on it.",
        "As random walk: multiplied by the root of the averaging time it is the spread of the "
        "integral. The data sheet is shown for comparison only and is used nowhere. A channel "
        "that is louder in one attitude than in another feels the table or the building.",
        parts,
    )


def _places(rows: Sequence[Record]) -> list[Place]:
    return list(dict.fromkeys((row["manoeuvre"], row["phase"]) for row in rows))


def _figure(rows: Sequence[Record], sheet: dict[str, float | None]) -> Figure:
    places = {place: number for number, place in enumerate(_places(rows))}
    with style():
        margins = Margins(left=0.46, right=0.95, bottom=1.05)
        figure, axes = panels(2, 1, 1.45, margins)
        for (panel,), sensor in zip(axes, SENSOR, strict=True):
            unit = RANDOM_WALK[sensor]
            for offset, axis in zip((-0.2, 0.0, 0.2), AXES, strict=True):
                own = [row for row in rows if row["channel"] == f"{sensor}_{axis}"]
                panel.errorbar(
                    [places[row["manoeuvre"], row["phase"]] + offset for row in own],
                    [row["white_noise"] / unit.size for row in own],
                    [row["sigma"] / unit.size for row in own],
                    fmt=AXIS_MARK[axis],
                    color=AXIS_COLOUR[axis],
                    markersize=3.5,
                    elinewidth=0.8,
                    label=axis,
                )
            stated = {sheet.get(f"{sensor}_{axis}") for axis in AXES} - {None}
            for value in sorted(v for v in stated if v is not None):
                panel.axhline(
                    value / unit.size, color=INK, linewidth=0.8, dashes=(5, 3), label=DATA_SHEET
                )
            panel.set_yscale("log")
            plain_numbers(panel.yaxis)
            panel.set_title(f"{SENSOR[sensor]}, {unit.name}", pad=3)
        handles = dict(zip(*reversed(axes[0][0].get_legend_handles_labels()), strict=True))
        shown = [name for name in (*AXES, DATA_SHEET) if name in handles]
        axes[0][0].legend(
            [handles[name] for name in shown], shown, loc="upper left", bbox_to_anchor=(1.0, 1.0)
        )
        ticks = list(places.items())[:: max(1, -(-len(places) // MOST_NAMES))]
        panel.set_xticks(
            [number for _, number in ticks],
            [_named(place, 24) for place, _ in ticks],
            rotation=60 if len(places) > 6 else 0,
            ha="right" if len(places) > 6 else "center",
            rotation_mode="anchor",
        )
        drawn = svg(figure, "noise")
    return Figure(
        "White noise by manoeuvre, with its σ; dashed: the data sheet.",
        drawn,
        "White noise of the six channels by manoeuvre; gyroscope above, accelerometer below.",
    )


def _named(place: Place, most: int) -> str:
    manoeuvre, phase = place
    return numbers.shortened(manoeuvre if phase == "rest" else f"{manoeuvre}, {phase}", most)


def _summary(
    rows: Sequence[Record], sheet: dict[str, float | None], sources: Sequence[str]
) -> Table:
    def line(channel: str, own: Sequence[Record]) -> tuple[str, ...]:
        unit = RANDOM_WALK[channel.partition("_")[0]]
        values = [row["white_noise"] / unit.size for row in own]
        stated = unit.of(sheet.get(channel))
        ratio = median(values) / stated if stated else None
        return (
            *(numbers.significant(each, 3) for each in (median(values), min(values), max(values))),
            numbers.significant(stated, 3),
            numbers.significant(ratio, 2),
            unit.name,
        )

    lines = {
        channel: line(channel, own)
        for channel in CHANNELS
        if (own := [row for row in rows if row["channel"] == channel])
    }
    set_right = [numbers.aligned(column) for column in zip(*lines.values(), strict=True)]
    return Table(
        "White noise by channel, over all manoeuvres.",
        (
            Column("Channel"),
            Column("Median", "number"),
            Column("Least", "number"),
            Column("Most", "number"),
            Column("Data sheet", "number"),
            Column("Median ÷ data sheet", "number"),
            Column("Unit", "unit"),
        ),
        tuple(
            Row((_channel(channel), *cells))
            for channel, cells in zip(lines, zip(*set_right, strict=True), strict=True)
        ),
        empty="None: no manoeuvre is long enough to estimate the noise.",
        note="Data sheet: " + numbers.shortened("; ".join(sources), 400) + "." if sources else "",
    )


def _channel(channel: str) -> str:
    sensor, _, axis = channel.partition("_")
    return f"{'gyroscope' if sensor == 'gyro' else 'accelerometer'} {axis}"


def _by_manoeuvre(rows: Sequence[Record], sensor: str) -> Table:
    unit = RANDOM_WALK[sensor]
    by_place = {(row["manoeuvre"], row["phase"], row["channel"]): row for row in rows}
    places = _places(rows)
    decimals = numbers.common_decimals(
        row["sigma"] / unit.size for row in rows if row["channel"].startswith(sensor)
    )

    def cells(place: Place) -> Iterator[str]:
        for axis in AXES:
            row = by_place.get((*place, f"{sensor}_{axis}"))
            value = row["white_noise"] / unit.size if row else None
            sigma = row["sigma"] / unit.size if row else None
            yield from numbers.with_sigma(value, sigma, decimals)

    more = len(places) - MOST_ROWS
    return Table(
        f"{SENSOR[sensor]} by manoeuvre, {unit.name}.",
        (
            Column("Manoeuvre", "name"),
            *(
                column
                for axis in AXES
                for column in (Column("value", "number", axis), Column("± σ", "sigma", axis))
            ),
        ),
        tuple(Row((_named(place, 40), *cells(place))) for place in places[:MOST_ROWS]),
        note=f"{numbers.whole(more)} more in the noise table of the campaign." if more > 0 else "",
    )
