"""The parameters by rests, epoch by epoch: single epochs, running means, and how they scatter."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import sqrt

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from inertial.text import numbers
from inertial.text.units import Quantity, quantity
from stages.reporting.drawing import (
    AXIS_COLOUR,
    INK,
    QUIET,
    Margins,
    panels,
    plain_numbers,
    style,
    svg,
)
from stages.reporting.outline import Column, Figure, Paragraph, Part, Row, Table
from stages.reporting.parameters import SENSOR, by_kind, kind_of
from stages.reporting.rows import Record, records

COLUMNS = 3
MOST_PANELS = 12
KINDS = {"bias": "bias", "scale": "scale", "cross": "cross-axis terms"}


def parts(epochs: pd.DataFrame, spreads: pd.DataFrame) -> Iterator[Part]:
    """A figure of the values per sensor, one of their scatter, and the variances as a table."""
    rows, scattered = records(epochs), records(spreads)
    groups = dict.fromkeys(row["parameter"].rpartition("/")[0] for row in rows)
    for number, group in enumerate(groups, 1):
        yield from _values(group, f"epochs-{number}", _of(group, rows))
    if scattered:
        yield _scatter(scattered)
        yield Paragraph(_said(scattered))
        yield _table(scattered)


def _of(group: str, rows: Sequence[Record]) -> list[Record]:
    return [row for row in rows if row["parameter"].rpartition("/")[0] == group]


def _name(row: Record) -> str:
    return str(row["parameter"].rpartition("/")[2])


def _quantity(row: Record) -> Quantity:
    return quantity(_name(row), row["unit"])


def _title(group: str) -> str:
    stage, _, method = group.partition("/")
    mount = numbers.shortened(method.partition("@")[2], 60)
    return SENSOR.get(stage, stage) + (f" (mount {mount})" if mount else "")


def _values(group: str, key: str, rows: Sequence[Record]) -> Iterator[Figure]:
    curves: dict[str, list[Record]] = {}
    for row in by_kind({**row, "parameter": _name(row)} for row in rows):
        curves.setdefault(row["parameter"], []).append(row)
    names = list(curves)[:MOST_PANELS]
    lines = -(-len(names) // COLUMNS)
    with style():
        figure, axes = panels(lines, COLUMNS, 0.78, Margins(left=0.45, across=0.5, down=0.3))
        each = [panel for line in axes for panel in line]
        for panel, name in zip(each, names, strict=False):
            _panel(panel, name, curves[name])
        for panel in each[len(names) :]:
            panel.set_visible(False)
        for panel in each[max(0, len(names) - COLUMNS) : len(names)]:
            panel.tick_params(labelbottom=True)
            panel.set_xlabel("Seconds of every rest")
        drawn = svg(figure, key)
    first = rows[0]["seconds"]
    yield Figure(
        f"{_title(group)}: by single epochs of {numbers.significant(first, 3)} s (grey) and by "
        "running means (colour, with ± σ of white noise), relative to the final value. The panels "
        "show ± 4 σ of a single epoch.",
        drawn,
        f"{numbers.counted(len(names), 'parameter')} against the seconds of every rest.",
    )


def _panel(panel: Axes, name: str, rows: Sequence[Record]) -> None:
    unit = quantity(name, rows[0]["unit"]).laboratory
    seconds = np.array([row["seconds"] for row in rows])
    final = rows[-1]["running"]
    single, running, sigma = (
        np.array([np.nan if row[key] is None else row[key] for row in rows]) / unit.size
        for key in ("single", "running", "running_sigma")
    )
    colour = AXIS_COLOUR.get(name.rpartition("_")[2][:1], INK)
    panel.plot(seconds, single - final / unit.size, color=QUIET, linewidth=0.35, alpha=0.6)
    away = running - final / unit.size
    panel.fill_between(seconds, away - sigma, away + sigma, color=colour, alpha=0.25, linewidth=0)
    panel.plot(seconds, away, color=colour, linewidth=0.9)
    height = 4 * rows[0]["single_sigma"] / unit.size
    if height > 0:
        panel.set_ylim(-height, height)
    panel.set_xlim(0, float(seconds[-1]))
    panel.set_title(f"{name.replace('_', ' ')}, {unit.name}", pad=3)
    panel.yaxis.set_major_locator(MaxNLocator(4))


def _ratio(row: Record) -> float:
    """Standard deviation by single epochs over that of white noise."""
    return sqrt(row["single"] / row["white"]) if row["white"] > 0 else float("nan")


def _scatter(rows: Sequence[Record]) -> Figure:
    kinds = list(dict.fromkeys((r["parameter"].partition("/")[0], kind_of(_name(r))) for r in rows))
    kinds.sort(key=lambda pair: (pair[0], list(KINDS).index(pair[1])))
    with style():
        figure, axes = panels(
            1, len(kinds), 1.25, Margins(left=0.45, across=0.34, top=0.24), sharex=True
        )
        for panel, (stage, kind) in zip(axes[0], kinds, strict=True):
            own = [
                r
                for r in rows
                if r["parameter"].startswith(f"{stage}/") and kind_of(_name(r)) == kind
            ]
            _scatter_panel(panel, own)
            panel.set_title(f"{SENSOR.get(stage, stage)}, {KINDS[kind]}", pad=3, fontsize=6.8)
            panel.set_xlabel("Epoch, s")
        axes[0][0].set_ylabel("σ / σ of white noise")
        drawn = svg(figure, "spreads")
    return Figure(
        "Standard deviation of the values by single epochs over what white noise gives, against "
        "the length of an epoch; band: what chance alone allows, ± 2 σ. What rises with the length "
        "drifts, what falls to 1 is an oscillation that averages out.",
        drawn,
        "Scatter of single epochs in units of that of white noise.",
    )


def _scatter_panel(panel: Axes, rows: Sequence[Record]) -> None:
    lengths = sorted({row["seconds"]: row["epochs"] for row in rows}.items())
    seconds = np.array([length for length, _ in lengths])
    chance = 1 / np.sqrt(2.0 * np.maximum(np.array([k for _, k in lengths]) - 1, 1))
    low, high = 1 - 2 * chance, 1 + 2 * chance
    panel.fill_between(seconds, low, high, color=QUIET, alpha=0.18, linewidth=0)
    panel.axhline(1, color=INK, linewidth=0.6)
    for name in dict.fromkeys(row["parameter"] for row in rows):
        own = sorted((row["seconds"], _ratio(row)) for row in rows if row["parameter"] == name)
        colour = AXIS_COLOUR.get(name.rpartition("_")[2][:1], INK)
        panel.plot(*zip(*own, strict=True), color=colour, marker="o", markersize=1.8, linewidth=0.8)
    panel.set_xscale("log")
    plain_numbers(panel.xaxis)
    panel.set_xticks([t for t in (0.01, 0.1, 1.0, 10.0, 100.0) if seconds[0] <= t <= seconds[-1]])
    panel.set_ylim(0, max(2.0, 1.1 * max(map(_ratio, rows))))


def _said(rows: Sequence[Record]) -> str:
    """How far the scatter is off that of white noise, at the shortest and the longest epochs."""
    lengths = [row["seconds"] for row in rows]
    return " ".join(_at(rows, seconds) for seconds in dict.fromkeys((min(lengths), max(lengths))))


def _at(rows: Sequence[Record], seconds: float) -> str:
    own = [row for row in rows if row["seconds"] == seconds]
    ratios = sorted((_ratio(row), _name(row), row["parameter"].partition("/")[0]) for row in own)
    epochs = own[0]["epochs"]
    chance = 1 / sqrt(2 * max(epochs - 1, 1))
    largest, name, stage = ratios[-1]
    return (
        f"Epochs of {numbers.significant(seconds, 3)} s ({numbers.whole(epochs)} of them) scatter "
        f"{numbers.fixed(ratios[0][0], 2)} to {numbers.fixed(largest, 2)} times as much as white "
        f"noise, most of all the {name.replace('_', ' ')} of the {stage}; chance alone gives 1 ± "
        f"{numbers.fixed(chance, 3 if chance < 0.01 else 2)}."
    )


def _table(rows: Sequence[Record]) -> Table:
    shortest = {}
    for row in sorted(rows, key=lambda row: -row["seconds"]):
        shortest[row["parameter"]] = row
    cells = []
    for row in by_kind(
        {**row, "id": row["parameter"], "parameter": _name(row)} for row in shortest.values()
    ):
        unit = quantity(row["parameter"], row["unit"]).laboratory
        cells.append(
            Row(
                (
                    row["parameter"].replace("_", " "),
                    SENSOR.get(row["id"].partition("/")[0], ""),
                    unit.name,
                    *(
                        numbers.significant(sqrt(row[key]) / unit.size, 3)
                        for key in ("single", "white", "running")
                    ),
                    numbers.significant(row["single"], 3),
                    numbers.significant(row["running"], 3),
                )
            )
        )
    epoch = numbers.significant(min(row["seconds"] for row in rows), 3)
    return Table(
        f"Scatter of the values epoch by epoch, epochs of one sample ({epoch} s).",
        (
            Column("Parameter", "name"),
            Column("Sensor", "name"),
            Column("unit", "unit", "Standard deviation"),
            Column("single epochs", "number", "Standard deviation"),
            Column("white noise", "number", "Standard deviation"),
            Column("running means", "number", "Standard deviation"),
            Column("single epochs", "number", "Variance, SI"),
            Column("running means", "number", "Variance, SI"),
        ),
        tuple(cells),
        note="The variance of running means tells how far they wandered on the way, not how sure "
        "the last one is: its σ is that of white noise over all of the rest.",
    )
