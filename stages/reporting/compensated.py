"""One manoeuvre before and after compensation, and what was taken out, as figures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from inertial.tables import AXES, CHANNELS
from inertial.text import numbers
from inertial.text.units import DEGREES_PER_HOUR, DEGREES_PER_SECOND, MILLIMETRES, Unit
from stages.reporting.drawing import AXIS_COLOUR, QUIET, Margins, panels, shade, style, svg
from stages.reporting.outline import Figure
from stages.reporting.rows import Record

Array = NDArray[np.float64]

POINTS = 130  # per curve
ALONG = 0.99  # cosine from which a direction is an axis
BEFORE = "#a9b3be"
BREAK = 3.0  # usual steps from one stretch to the next from which a curve breaks off
LEAST_SPAN = {"gyro": 2.0, "accel": 0.5}  # °/h, mm/s²: what is finer is noise of the extremes


@dataclass(frozen=True)
class Curves:
    """One channel: its extremes before and after, and what was taken out; NaN at a break."""

    least: Array
    most: Array
    least_after: Array
    most_after: Array
    taken: Array


@dataclass(frozen=True)
class Compensated:
    """One manoeuvre before and after, with the edges of the traces."""

    name: str
    view: str
    x: Array
    timed: bool
    curves: Mapping[str, Curves]  # by channel
    phases: tuple[Record, ...]
    turning: bool


def figures(
    before: pd.DataFrame,
    after: pd.DataFrame,
    segments: Sequence[Record],
    manoeuvres: Sequence[Record],
) -> Iterator[Figure]:
    """One axis down, the same up, and both turns about it; of the axis that has most of these."""
    by_name = {
        row["manoeuvre"]: one
        for row, view in _chosen(manoeuvres, {row["manoeuvre"] for row in segments})
        if (one := _compensated(row, view, before, after, segments))
    }
    for number, one in enumerate(by_name.values(), 1):
        name = numbers.shortened(one.name, 80)
        about = "" if one.turning else "; before and after about the middle of after"
        yield Figure(
            f"{name}, {one.view}: before (grey) and after (colour) compensation, and what was "
            f"taken out{about}.",
            _draw(one, f"compensated-{number}"),
            f"Six channels of {name} before and after compensation, and their difference.",
        )


def _chosen(manoeuvres: Sequence[Record], there: set[str]) -> list[tuple[Record, str]]:
    best: list[tuple[Record, str]] = []
    for axis in reversed(AXES):
        found: dict[str, Record] = {}
        for row in manoeuvres:
            up, about = row[f"up_{axis}"], row[f"about_{axis}"]
            view = ""
            if row["do"] == "turn" and about is not None and abs(about) > ALONG:
                view = "forward" if (row["angle"] or row["rate"] or 0.0) * about > 0 else "backward"
                view = f"turn {view} about {axis}"
            elif row["do"] == "rest" and up is not None and abs(up) > ALONG:
                view = f"{axis} up" if up > 0 else f"{axis} down"
            if view and row["manoeuvre"] in there:
                found.setdefault(view, row)
        views = (f"{axis} down", f"{axis} up", f"turn forward about {axis}")
        order = [v for v in (*views, f"turn backward about {axis}") if v in found]
        if len(order) > len(best):
            best = [(found[view], view) for view in order]
    return best


def _compensated(
    row: Record,
    view: str,
    before: pd.DataFrame,
    after: pd.DataFrame,
    segments: Sequence[Record],
) -> Compensated | None:
    own = tuple(part for part in segments if part["manoeuvre"] == row["manoeuvre"])
    first = min(part["from_record"] for part in own)
    last = max(part["to_record"] for part in own)
    log = own[0]["log"]
    inside = before[
        (before["log"] == log) & (before["to_record"] > first) & (before["from_record"] < last)
    ]
    both = inside.merge(after, on=["log", "from_record", "to_record"], suffixes=("", "_after"))
    if both.empty:
        return None
    timed = not both["from_s"].isna().any()
    start, end = ("from_s", "to_s") if timed else ("from_record", "to_record")
    count = len(both)
    edges = np.unique(np.arange(min(POINTS, count)) * count // min(POINTS, count))
    x = _mean((_of(both, start) + _of(both, end)) / 2, edges)
    breaks = _breaks(x)
    curves = {}
    for channel in CHANNELS:
        least, most = _of(both, f"least_{channel}"), _of(both, f"most_{channel}")
        least_after = _of(both, f"least_{channel}_after")
        most_after = _of(both, f"most_{channel}_after")
        bands = (
            np.fmin.reduceat(least, edges),
            np.fmax.reduceat(most, edges),
            np.fmin.reduceat(least_after, edges),
            np.fmax.reduceat(most_after, edges),
            _mean((least + most - least_after - most_after) / 2, edges),
        )
        curves[channel] = Curves(*(np.insert(band, breaks, np.nan) for band in bands))
    x = np.insert(x, breaks, x[breaks])
    phases = tuple(
        part | {"start": part[start], "end": part[end]} for part in own if part[start] is not None
    )
    turning = row["do"] == "turn"
    return Compensated(row["manoeuvre"], view, x, timed, curves, phases, turning)


def _mean(values: Array, edges: NDArray[np.int64]) -> Array:
    """Means over the stretches that begin at `edges`."""
    count = np.diff(np.append(edges, len(values)))
    return np.asarray(np.add.reduceat(values, edges) / count)


def _breaks(x: Array) -> NDArray[np.int64]:
    """Where something is missing between one stretch and the next."""
    steps = np.diff(x)
    if not len(steps):
        return np.empty(0, dtype=np.int64)
    return np.flatnonzero(steps > BREAK * np.median(steps)) + 1


def _of(frame: pd.DataFrame, column: str) -> Array:
    return frame[column].to_numpy(dtype=np.float64)


def _draw(one: Compensated, key: str) -> str:
    with style():
        figure, axes = panels(3, 4, 0.52, Margins(across=0.44, down=0.2))
        for place, sensor in enumerate(("gyro", "accel")):
            both, taken = ([row[2 * place + side] for row in axes] for side in (0, 1))
            unit = _unit(one, sensor)
            fine = DEGREES_PER_HOUR if sensor == "gyro" else MILLIMETRES
            name = "Gyro" if sensor == "gyro" else "Accelerometer"
            for axis, panel, beside in zip(AXES, both, taken, strict=True):
                _pair(panel, one, f"{sensor}_{axis}", unit)
                _difference(beside, one, f"{sensor}_{axis}", fine)
            both[0].set_title(f"{name}, {unit.name}", loc="left", pad=2)
            taken[0].set_title(f"difference, {fine.name}", loc="left", pad=2)
        for panel in axes[-1]:
            panel.set_xlabel("Time, s" if one.timed else "Record")
        if len(one.x) > 1:
            axes[0][0].set_xlim(float(one.x[0]), float(one.x[-1]))
        return svg(figure, key)


def _unit(one: Compensated, sensor: str) -> Unit:
    if sensor == "gyro":
        return DEGREES_PER_SECOND if one.turning else DEGREES_PER_HOUR
    return MILLIMETRES


def _pair(panel: Axes, one: Compensated, channel: str, unit: Unit) -> None:
    _background(panel, one, channel)
    curves = one.curves[channel]
    still = not one.turning or channel.startswith("accel")
    middle = _middle((curves.least_after + curves.most_after) / 2) if still else 0.0
    for low, high, colour in (
        (curves.least, curves.most, BEFORE),
        (curves.least_after, curves.most_after, AXIS_COLOUR[channel[-1]]),
    ):
        panel.fill_between(
            one.x,
            (low - middle) / unit.size,
            (high - middle) / unit.size,
            color=colour,
            linewidth=0.5,
        )


def _difference(panel: Axes, one: Compensated, channel: str, unit: Unit) -> None:
    _background(panel, one, channel)
    taken = one.curves[channel].taken / unit.size
    if not np.isfinite(taken).any():
        panel.annotate(
            "not compensated", (0.5, 0.5), xycoords="axes fraction", ha="center", color=QUIET
        )
        return
    panel.plot(one.x, taken, color=AXIS_COLOUR[channel[-1]], linewidth=0.8)
    low, high = float(np.nanmin(taken)), float(np.nanmax(taken))
    room = max(0.05 * (high - low), (LEAST_SPAN[channel[:-2]] - (high - low)) / 2)
    panel.set_ylim(low - room, high + room)


def _background(panel: Axes, one: Compensated, channel: str) -> None:
    for row in one.phases:
        shade(panel, row["phase"], row["start"], row["end"])
    panel.set_title(channel[-1], loc="right", color=AXIS_COLOUR[channel[-1]], fontsize=6.5, pad=2)
    panel.yaxis.set_major_locator(MaxNLocator(3))
    panel.xaxis.set_major_locator(MaxNLocator(3))
    panel.ticklabel_format(axis="both", useOffset=False)


def _middle(values: Array) -> float:
    return float(np.nanmedian(values)) if np.isfinite(values).any() else 0.0
