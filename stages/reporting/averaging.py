"""How the parameters settle as more of each rest is used."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from inertial.text import numbers
from inertial.text.units import RANDOM_WALK, Quantity, quantity
from stages.reporting.drawing import AXIS_COLOUR, INK, Margins, panels, plain_numbers, style, svg
from stages.reporting.outline import (
    Column,
    Figure,
    Heading,
    Paragraph,
    Part,
    Row,
    Section,
    Table,
)
from stages.reporting.parameters import SENSOR, Estimate, by_kind, kind_of
from stages.reporting.rows import Record, records

COLUMNS = 3
MOST_PANELS = 24
UNIT_OF = {"accelerometer": {"bias": "m/s²"}, "gyroscope": {"bias": "rad/s"}}


def section(
    accelerometer_averaging: pd.DataFrame,
    gyroscope_averaging: pd.DataFrame,
    wanted: Sequence[Record],
    parameters: Sequence[Record],
) -> Section:
    """One figure per sensor and method, one panel per parameter; the time for a wanted sigma."""
    unit_of = {row["id"]: row["unit"] for row in parameters}
    parts: list[Part] = []
    for frame, stage in (
        (accelerometer_averaging, "accelerometer"),
        (gyroscope_averaging, "gyroscope"),
    ):
        rows = records(frame)
        groups = dict.fromkeys(row["parameter"].rpartition("/")[0] for row in rows)
        parts.append(Heading(SENSOR[stage]))
        for number, group in enumerate(groups, 1):
            own = [row for row in rows if row["parameter"].rpartition("/")[0] == group]
            parts += _figures(group, f"{stage}-{number}", own, unit_of)
        if not groups:
            parts.append(
                Paragraph("None: the parameters were not followed over the averaging time.")
            )
    parts.append(_wanted(wanted))
    return Section(
        "averaging",
        "Parameters against averaging time",
        "Each parameter as it would have come out, had only the first seconds of each rest been "
        "used; relative to its final value.",
        "The band is value ± σ. Where it narrows about zero, longer rests would still help; where "
        "the line leaves the band and stays away, something drifts.",
        parts,
    )


def _wanted(rows: Sequence[Record]) -> Table:
    """How long each rest must last for a bias of a wanted sigma."""
    return Table(
        "How long each rest must last for a bias of a wanted σ, by S0's formulas.",
        (
            Column("Bias"),
            Column("random walk", "number"),
            Column("unit", "unit"),
            Column("σ", "number", "Recorded"),
            Column("rests of", "number", "Recorded"),
            Column("floor", "number"),
            Column("σ", "number", "Wanted"),
            Column("unit", "unit", "Wanted"),
            Column("rests of", "number", "Wanted"),
        ),
        tuple(_wanted_row(row) for row in rows),
        empty="None: no formula of S0 gives a bias here.",
        note="σ² = N²/T + floor², with the random walk N of the bias and rests of T each. The "
        "floor is what no time averages out: tilts of the positions, gravity, an unknown azimuth, "
        "and by what manoeuvres differ beyond noise.",
    )


def _wanted_row(row: Record) -> Row:
    stage, method, parameter = row["parameter"].split("/")
    unit = quantity(parameter, UNIT_OF[stage]["bias"]).laboratory
    walk = RANDOM_WALK["gyro" if stage == "gyroscope" else "accel"]
    sigma, floor, wanted = (
        numbers.significant(unit.of(row[which]), 2) for which in ("sigma", "floor", "wanted")
    )
    seconds = row["wanted_seconds"]
    return Row(
        (
            f"{parameter.replace('_', ' ')}, {Estimate(stage, method, (), None).name}",
            numbers.significant(walk.of(row["random_walk"]), 2),
            walk.name,
            sigma,
            f"{numbers.significant(row['seconds'], 3)} s",
            floor,
            wanted,
            unit.name,
            "no time does" if seconds is None else f"{numbers.significant(seconds, 2)} s",
        )
    )


def _figures(
    group: str, key: str, rows: Sequence[Record], unit_of: dict[str, str]
) -> Iterator[Figure]:
    curves: dict[str, list[Record]] = {}
    for row in by_kind({**row, "parameter": row["parameter"].rpartition("/")[2]} for row in rows):
        curves.setdefault(f"{group}/{row['parameter']}", []).append(row)
    stage, _, method = group.partition("/")
    title = Estimate(stage, method, (), None).name
    ids = list(curves)[:MOST_PANELS]
    lines = -(-len(ids) // COLUMNS)
    with style():
        figure, axes = panels(lines, COLUMNS, 0.95, Margins(left=0.45, across=0.5, down=0.3))
        each = [panel for row in axes for panel in row]
        for panel, name in zip(each, ids, strict=False):
            _panel(panel, name, sorted(curves[name], key=lambda row: row["seconds"]), unit_of)
        for panel in each[len(ids) :]:
            panel.set_visible(False)
        for panel in each[max(0, len(ids) - COLUMNS) : len(ids)]:
            panel.tick_params(labelbottom=True)
            panel.set_xlabel("Seconds of each rest")
        drawn = svg(figure, f"averaging-{key}")
    more = len(curves) - len(ids)
    left = f" {numbers.whole(more)} more in the averaging table." if more else ""
    yield Figure(
        f"{title}: value ± σ against averaging time, relative to the final value.{left}",
        drawn,
        f"{numbers.counted(len(ids), 'curve')} of {title}, each within its band of sigma.",
    )


def _panel(panel: Axes, name: str, rows: Sequence[Record], unit_of: dict[str, str]) -> None:
    parameter = name.rpartition("/")[2]
    unit = _quantity(name, parameter, unit_of).laboratory
    seconds = [row["seconds"] for row in rows]
    final = rows[-1]["value"]
    value = [(row["value"] - final) / unit.size for row in rows]
    sigma = [row["sigma"] / unit.size for row in rows]
    axis = parameter.rpartition("_")[2][:1]
    colour = AXIS_COLOUR.get(axis, INK)
    panel.axhline(0, color=INK, linewidth=0.6)
    panel.fill_between(
        seconds,
        [v - s for v, s in zip(value, sigma, strict=True)],
        [v + s for v, s in zip(value, sigma, strict=True)],
        color=colour,
        alpha=0.22,
        linewidth=0,
    )
    panel.plot(seconds, value, color=colour, marker="o", markersize=1.8)
    panel.set_xscale("log")
    plain_numbers(panel.xaxis)
    panel.set_title(f"{parameter.replace('_', ' ')}, {unit.name}", pad=3)
    panel.yaxis.set_major_locator(MaxNLocator(4))


def _quantity(name: str, parameter: str, unit_of: dict[str, str]) -> Quantity:
    kind = kind_of(parameter)
    stage = name.partition("/")[0]
    return quantity(parameter, unit_of.get(name) or UNIT_OF.get(stage, {}).get(kind, "1"))
