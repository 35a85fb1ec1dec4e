"""A finding as a picture: where it is in its log, and the samples around it close up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from inertial.tables import AXES, CHANNELS
from inertial.text import numbers
from inertial.text.units import DEGREES_PER_HOUR, DEGREES_PER_SECOND, METRES, MILLIMETRES, Unit
from stages.reporting.close_ups import Axis, CloseUp, axis, gaps_in, masked_in
from stages.reporting.drawing import (
    AXIS_COLOUR,
    INK,
    MISSING,
    QUIET,
    Margins,
    hatch_masked,
    hatch_missing,
    mark_place,
    shade,
    side_by_side,
    style,
    svg,
)
from stages.reporting.logs import Log, envelope
from stages.reporting.outline import Figure
from stages.reporting.rows import Record

Array = NDArray[np.float64]
Span = tuple[float, float]

WHOLE_LOG = 120  # points of an envelope
HARDLY = 0.2  # of the distance between channels: they are drawn about their middles
ALL = 0.9  # of a log: what is so long is not marked in it
WIDTHS = (1.0, 2.0)  # of the whole log and of the close-up
HEIGHT = 1.0  # inches
PAD = 6  # points: room for the wedge below a title
FEW = 40  # records that are ringed one by one; more are a band
DOTTED = 160  # records up to which each has a dot
SMALL_RATE = 0.2 * DEGREES_PER_SECOND.size
SECONDS_OF_OSCILLATION = 1.0  # as S0 shows its 20 Hz
# What is wrong is the time: the steps from record to record are shown instead of readings.
OF_TIME = frozenset(
    {"duplicate", "time_backwards", "time_stands_still", "clock_jitter", "clock_step"}
)
# What no sample shows: it is about the log as a whole, or about what the campaign says.
OF_NO_SAMPLE = frozenset(
    {
        "clock_scale",
        "gravity_error",
        "rate_off",
        "temperature_drift",
        "wrong_day",
        "wrong_imu_type",
        "wrong_scale_factor",
    }
)
SENSOR = {"gyro": "gyro", "accel": "accelerometer"}


@dataclass(frozen=True)
class Place:
    """What a picture is made of: the finding, its log, the samples around it."""

    row: Record
    log: Log
    span: Span | None  # in the coordinate of the log: s, or records where it has no time
    close_up: CloseUp | None
    gaps: pd.DataFrame
    masks: pd.DataFrame

    @property
    def channels(self) -> tuple[str, ...]:
        """The channel that is concerned, or all of a sensor; of a turn the liveliest of these."""
        sensor, of_axis = self.row["sensor"], self.row["axis"]
        own = tuple(f"{sensor}_{each}" for each in AXES) if sensor in SENSOR else CHANNELS
        if sensor in SENSOR and of_axis in AXES:
            return (f"{sensor}_{of_axis}",)
        if sensor in SENSOR and (self.log.static or not self.row["manoeuvre"]):
            return own
        return (_liveliest(self.log, own),)

    @property
    def marked(self) -> Span | None:
        """The span, where it is not the whole log."""
        start, end = self.log.extent
        if self.span is None or self.span[1] - self.span[0] > ALL * (end - start):
            return None
        return self.span

    @property
    def name(self) -> str:
        """The concerned channels in words."""
        sensor, _, of_axis = self.channels[0].partition("_")
        named = SENSOR[sensor]
        return f"{of_axis} {named}" if len(self.channels) == 1 else f"{named}s"

    @property
    def middles(self) -> dict[str, float]:
        """About what each channel is drawn: its middle, if several hardly move; else 0."""
        nothing = dict.fromkeys(self.channels, 0.0)
        if len(self.channels) == 1 or not self.log.static:
            return nothing
        middles, widths = {}, []
        for channel in self.channels:
            least, most = self.log.least[channel], self.log.most[channel]
            if np.isfinite(least).any():
                middles[channel] = float(np.nanmedian((least + most) / 2))
                widths.append(float(np.nanmax(most) - np.nanmin(least)))
        apart = max(middles.values(), default=0.0) - min(middles.values(), default=0.0)
        return nothing | middles if max(widths, default=0.0) < HARDLY * apart else nothing


def figure(place: Place, key: str) -> Figure | None:
    """The whole log with the place marked, and beside it the samples; none without either."""
    if place.row["cause"] in OF_NO_SAMPLE or not len(place.log.start):
        return None
    if place.span is None and place.close_up is None:
        return None
    if not any(np.isfinite(place.log.least[channel]).any() for channel in place.channels):
        return None
    name = numbers.shortened(place.log.name, 80)
    marked = ", the wedge marks the place" if place.marked else ""
    if place.close_up is None or not len(place.close_up.line):
        drawn = _whole_log_alone(place, key)
        caption = f"{name}, {place.name}: the whole log{marked}."
    else:
        close_up = _shown(place, place.close_up)
        drawn = _both(place, close_up, key)
        first, last = (numbers.whole(int(close_up.line[end])) for end in (0, -1))
        caption = (
            f"{name}, {place.name}: the whole log{marked}; and lines {first} to {last} of it "
            f"close up.{_signs(place, close_up)}"
        )
    words = f"The log {name} over time with the place of the finding, and the samples around it."
    return Figure(caption, drawn, words)


def _liveliest(log: Log, channels: Sequence[str]) -> str:
    """The channel that moves most against the width of its band: of a turn its gyro."""

    def moves(channel: str) -> float:
        least, most = log.least[channel], log.most[channel]
        if not np.isfinite(least).any():
            return -1.0
        width = float(np.nanmedian(most - least)) or 1e-12
        return float(np.nanmax(most) - np.nanmin(least)) / width

    return max(channels, key=moves)


def _shown(place: Place, close_up: CloseUp) -> CloseUp:
    """Of an oscillation a second, the one in which nothing else happens; of anything else all."""
    if place.row["cause"] != "oscillation" or not close_up.timed:
        return close_up
    inside = np.flatnonzero(close_up.concerned)
    start, end = (int(inside[0]), int(inside[-1]) + 1) if len(inside) else (0, len(close_up.time))
    step = float(np.median(np.diff(close_up.time))) or 1.0
    length = min(max(round(SECONDS_OF_OSCILLATION / step), 2), end - start)
    values = close_up.values[place.channels[0]]
    starts = range(start, end - length + 1, max(length // 4, 1))
    changes = [_change(values[first : first + length]) for first in starts]
    calm = starts[int(np.argmin(changes))]
    return close_up.part(calm, calm + length)


def _change(values: Array) -> float:
    """By how much the second half is off the first."""
    first, second = np.array_split(values, 2)
    return abs(float(np.nanmean(second)) - float(np.nanmean(first)))


def _signs(place: Place, close_up: CloseUp) -> str:
    """What the signs in this figure mean."""
    if place.row["cause"] in OF_TIME:
        said = " Close up: the time from each record to the one before it, over the lines."
        return said + _concerned(int(close_up.concerned.sum()), len(close_up.concerned))
    said = ""
    if len(place.channels) > 1:
        said = " x orange, y green, z blue"
        said += ", each about its middle." if any(place.middles.values()) else "."
    inside = int(close_up.concerned.sum())
    if place.row["cause"] == "oscillation":
        inside = 0
    said += _concerned(inside, len(close_up.concerned))
    if gaps_in(close_up, place.gaps):
        said += " Hatched: not recorded."
    if masked_in(close_up, place.masks, place.channels):
        said += " Ruled: masked, so not used."
    return said


def _concerned(inside: int, count: int) -> str:
    if not 0 < inside < count:
        return ""
    return " Ringed: concerned." if inside <= FEW else " Shaded: concerned."


# ---- drawing


def _whole_log_alone(place: Place, key: str) -> str:
    with style():
        drawn, (panel,) = side_by_side((1.0,), 0.8, Margins(top=0.28))
        _whole_log(panel, place, _unit(place), points=3 * WHOLE_LOG)
        return svg(drawn, key)


def _both(place: Place, close_up: CloseUp, key: str) -> str:
    unit = _unit(place)
    with style():
        drawn, (left, right) = side_by_side(WIDTHS, HEIGHT, Margins(top=0.28))
        _whole_log(left, place, unit, points=WHOLE_LOG)
        if place.row["cause"] in OF_TIME:
            _steps_of_time(right, close_up)
        else:
            _samples(right, place, close_up, unit)
        return svg(drawn, key)


def _whole_log(panel: Axes, place: Place, unit: Unit, *, points: int) -> None:
    log = place.log
    for row in log.phases:
        shade(panel, row["phase"], row["start"], row["end"])
    for start, end in log.missing:
        hatch_missing(panel, start, end)
    middles = place.middles
    for channel in place.channels:
        middle = middles[channel]
        x, low, high = envelope(log, channel, points)
        panel.fill_between(
            x,
            (low - middle) / unit.size,
            (high - middle) / unit.size,
            color=AXIS_COLOUR[channel[-1]],
            linewidth=0.5,
            zorder=2,
        )
    if place.marked is not None:
        mark_place(panel, *place.marked)
    start, end = log.extent
    panel.set_xlim(start, end if end > start else start + 1.0)
    panel.set_title(f"{place.name}, {unit.name}", loc="left", pad=PAD)
    _few_ticks(panel)
    panel.set_xlabel("Time, s" if log.timed else "Record")


def _few_ticks(panel: Axes) -> None:
    panel.yaxis.set_major_locator(MaxNLocator(4))
    panel.xaxis.set_major_locator(MaxNLocator(4))
    panel.ticklabel_format(axis="both", useOffset=False, style="plain")


def _samples(panel: Axes, place: Place, close_up: CloseUp, unit: Unit) -> None:
    along = axis(close_up.x)
    places, after_gaps = along.places, gaps_in(close_up, place.gaps)
    for i in after_gaps:
        hatch_missing(panel, places[i - 1], places[i])
    for first, last in masked_in(close_up, place.masks, place.channels):
        hatch_masked(panel, *_between(places, first, last))
    inside = np.flatnonzero(close_up.concerned)
    some = 0 < len(inside) < len(places) and place.row["cause"] != "oscillation"
    if some and len(inside) > FEW:
        start, end = _between(places, int(inside[0]), int(inside[-1]))
        panel.axvspan(start, end, color=MISSING, alpha=0.12, linewidth=0, zorder=0.5)
    for channel in place.channels:
        values = (close_up.values[channel] - place.middles[channel]) / unit.size
        panel.plot(
            np.insert(places, after_gaps, np.nan),
            np.insert(values, after_gaps, np.nan),
            color=AXIS_COLOUR[channel[-1]],
            linewidth=0.7,
            marker="." if len(places) <= DOTTED else "",
            markersize=2.5,
        )
        if some and len(inside) <= FEW:
            panel.plot(
                places[inside], values[inside], "o", markersize=5, color=MISSING, fillstyle="none"
            )
    _ticked(panel, along)
    seconds = "Time, s" if close_up.timed else "Line"
    panel.set_xlabel(seconds)
    panel.set_title(_title(close_up, place, after_gaps), loc="left", pad=PAD)


def _title(close_up: CloseUp, place: Place, after_gaps: Sequence[int]) -> str:
    if len(close_up.line) > 1 and len(after_gaps) == 1:
        i = after_gaps[0]
        lost = float(close_up.time[i] - close_up.time[i - 1])
        return f"lines {close_up.line[i - 1]} and {close_up.line[i]}, {lost:.3f} s apart"
    return f"lines {close_up.line[0]} to {close_up.line[-1]}"


def _between(places: Array, first: int, last: int) -> Span:
    """From half a step before the record `first` to half a step after `last`."""
    half = float(np.median(np.diff(places))) / 2 if len(places) > 1 else 0.5
    return float(places[first]) - half, float(places[last]) + half


def _ticked(panel: Axes, along: Axis) -> None:
    panel.set_xticks(along.ticks, along.labels)
    room = 0.01 * float(along.places[-1] - along.places[0]) or 0.5
    panel.set_xlim(along.places[0] - room, along.places[-1] + room)
    panel.yaxis.set_major_locator(MaxNLocator(4))
    panel.ticklabel_format(axis="y", useOffset=False, style="plain")


def _steps_of_time(panel: Axes, close_up: CloseUp) -> None:
    """The time from each record to the one before it, over the lines of the log."""
    steps = np.diff(close_up.time) * 1e3
    line = close_up.line[1:]
    usual = float(np.nanmedian(steps)) if np.isfinite(steps).any() else 0.0
    panel.axhline(usual, color=INK, linewidth=0.5, dashes=(4, 2))
    panel.plot(line, steps, color=QUIET, linewidth=0.7, marker=".", markersize=2.5)
    inside = close_up.concerned[1:]
    if FEW < inside.sum() < len(inside):
        panel.axvspan(*line[inside][[0, -1]], color=MISSING, alpha=0.12, linewidth=0, zorder=0.5)
    if 0 < inside.sum() <= FEW:
        panel.plot(line[inside], steps[inside], "o", markersize=5, color=MISSING, fillstyle="none")
    _few_ticks(panel)
    panel.set_xlabel("Line")
    panel.set_title("time since the record before, ms", loc="left", pad=PAD)


def _unit(place: Place) -> Unit:
    """The unit in which the largest reading, or deviation from the middle, has few digits."""
    largest = 0.0
    for channel in place.channels:
        both = np.concatenate([place.log.least[channel], place.log.most[channel]])
        if np.isfinite(both).any():
            largest = max(largest, float(np.nanmax(np.abs(both - place.middles[channel]))))
    if place.channels[0].startswith("gyro"):
        return DEGREES_PER_HOUR if largest < SMALL_RATE else DEGREES_PER_SECOND
    return MILLIMETRES if largest < 1.0 else METRES
