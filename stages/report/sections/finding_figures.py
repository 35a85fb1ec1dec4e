"""A finding as a picture: where it is in its log, and the samples around it close up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from inertial.sensors import PLURAL, SENSORS, SINGULAR
from inertial.tables import AXES, CHANNEL_PARTS, CHANNELS
from inertial.text.messages import _
from inertial.text.numbers import shortened, whole
from inertial.text.units import Unit
from stages.report.drawing import (
    AXIS_COLOUR,
    INK,
    MISSING,
    QUIET,
    Array,
    Margins,
    hatch_masked,
    hatch_missing,
    mark_place,
    readable,
    side_by_side,
    style,
    svg,
    ticks,
)
from stages.report.outline import Figure
from stages.report.sections.raw_data import Log, draw_channel, draw_phases
from stages.report.tables import Record, Tables, once

Span = tuple[float, float]

POINTS = 120  # of an envelope
MAX_MOTION = 0.2  # of the distance between channels up to which they are drawn about their middles
MAX_MARKED = 0.9  # of a log: what is longer is not marked in it
WIDTHS = (1.0, 2.0)  # of the whole log and of the close-up
HEIGHT = 1.0  # inches
PAD = 6  # points: room for the wedge below a title
MAX_RINGED = 40  # records that are ringed one by one; more are a band
MAX_DOTTED = 160  # records up to which each has a dot
MAX_GAP = 0.3  # of what is recorded: a gap that is longer is drawn as if it lasted so long
MOST_TICKS = 6
SECONDS_OF_OSCILLATION = 1.0  # as S0 shows its 20 Hz
# What is wrong is the time: the steps from record to record are shown instead of readings.
OF_TIME = frozenset(
    {"duplicate", "time_backwards", "time_stands_still", "clock_jitter", "clock_step"}
)
# What no sample shows: it is about the log as a whole, or about what the campaign says.
OF_NO_SAMPLE = frozenset(
    {
        "arrival_stamps",
        "clock_scale",
        "gravity_error",
        "rate_off",
        "temperature_drift",
        "wrong_day",
        "wrong_imu_type",
        "wrong_scale_factor",
        "wrong_time_unit",
    }
)


# ---- the samples around a finding


@dataclass(frozen=True)
class CloseUp:
    """n records around one finding.

    record, line, time: (n,), time s, NaN where there is none; values: (n,) of each channel;
    concerned: (n,), whether a record lies in the stretch that the finding is about.
    """

    log: str
    record: NDArray[np.int64]
    line: NDArray[np.int64]
    time: Array
    values: dict[str, Array]
    concerned: NDArray[np.bool_]

    @property
    def timed(self) -> bool:
        """Whether it can be drawn over time: every record has one, and none goes back."""
        return bool(np.isfinite(self.time).all() and (np.diff(self.time) >= 0).all())

    @property
    def x(self) -> Array:
        """Time, or the number of the line where there is none that can be drawn over."""
        return self.time if self.timed else self.line.astype(np.float64)

    def longest_gap(self, gaps: Sequence[int]) -> int:
        """The place of the record that follows the longest of these gaps."""
        return max(gaps, key=lambda place: float(self.time[place] - self.time[place - 1]))

    def part(self, first: int, after: int) -> CloseUp:
        """Some of its records, by their places."""
        own = slice(first, after)
        values = {channel: readings[own] for channel, readings in self.values.items()}
        arrays = (self.record[own], self.line[own], self.time[own], values, self.concerned[own])
        return CloseUp(self.log, *arrays)


@once
def close_ups(tables: Tables) -> dict[str, CloseUp]:
    """The samples around each finding of two stages, by the identifier of the finding."""
    by_finding = {}
    for name in ("quality_close_ups", "segment_close_ups"):
        frame = tables.frame(name)
        for finding, rows in frame.groupby("finding", sort=False, observed=True):
            record, line = (rows[key].to_numpy(dtype=np.int64) for key in ("record", "line"))
            time, *each = (rows[key].to_numpy(dtype=np.float64) for key in ("time", *CHANNELS))
            values = dict(zip(CHANNELS, each, strict=True))
            concerned = rows["concerned"].to_numpy(dtype=np.bool_)
            log = str(rows["log"].iloc[0])
            by_finding[str(finding)] = CloseUp(log, record, line, time, values, concerned)
    return by_finding


@dataclass(frozen=True)
class Axis:
    """Where records stand along the figure, when long gaps are drawn short; its ticks."""

    places: Array
    ticks: Array
    labels: tuple[str, ...]


def axis(x: Array) -> Axis:
    """Records in their distances, but for gaps that would leave no room for the samples."""
    steps = np.diff(x)
    usual = float(np.median(steps)) if len(steps) else 1.0
    gaps = steps > 2.5 * usual
    recorded = float(steps[~gaps].sum()) or 1.0
    longest = np.where(gaps, MAX_GAP * recorded, np.inf)
    drawn = np.minimum(steps, longest)
    places = np.concatenate([[0.0], np.cumsum(drawn)]) + (x[0] if len(x) else 0.0)
    cuts = np.flatnonzero(steps > longest) + 1
    ticks: list[float] = []
    at: list[float] = []
    stretches = [own for own in np.split(np.arange(len(x)), cuts) if len(own) > 1]
    for own in stretches:
        count = max(MOST_TICKS // len(stretches), 2)
        nice = MaxNLocator(count).tick_values(x[own[0]], x[own[-1]])
        inside = nice[(nice >= x[own[0]]) & (nice <= x[own[-1]])]
        ticks += inside.tolist()
        at += np.interp(inside, x[own], places[own]).tolist()
    return Axis(places, np.array(at), _written(ticks))


def _written(ticks: Sequence[float]) -> tuple[str, ...]:
    """With as many decimals as tell them apart."""
    for decimals in range(5):
        texts = [f"{tick:.{decimals}f}" for tick in ticks]
        if all(abs(float(text) - tick) < 1e-6 for text, tick in zip(texts, ticks, strict=True)):
            break
    return tuple(text.replace("-", "−") for text in texts) if ticks else ()


def gaps_in(close_up: CloseUp, gaps: pd.DataFrame) -> list[int]:
    """The places of the records that follow a gap."""
    own = gaps["record"][(gaps["log"] == close_up.log).to_numpy()].to_numpy(dtype=np.int64)
    after = np.searchsorted(close_up.record, own)
    there = (after > 0) & (after < len(close_up.record))
    return sorted(
        int(i)
        for i, record in zip(after[there], own[there], strict=True)
        if close_up.record[i] == record
    )


def masked_in(
    close_up: CloseUp, masks: pd.DataFrame, channels: Sequence[str]
) -> list[tuple[int, int]]:
    """Stretches that are masked, of all channels or of one of these: first and last place."""
    record = close_up.record
    masked = masks["sensor"] + "_" + masks["axis"]
    concerned = masks["sensor"].isna() | masked.isin(channels)
    near = (masks["to_record"] > record[0]) & (masks["from_record"] <= record[-1])
    own = masks[(masks["log"] == close_up.log) & concerned & near]
    hidden = np.zeros(len(record) + 2, dtype=np.int64)
    for row in own.itertuples():
        first, after = np.searchsorted(record, [row.from_record, row.to_record])
        hidden[first + 1 : after + 1] = 1
    edges = np.diff(hidden)
    both = zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True)
    return [(int(first), int(after) - 1) for first, after in both]


# ---- the figure


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
        """The channel that is concerned, or all of a sensor; of a turn the one that moves most."""
        sensor, of_axis = self.row["sensor"], self.row["axis"]
        own = tuple(f"{sensor}_{each}" for each in AXES) if sensor in SENSORS else CHANNELS
        if sensor in SENSORS and of_axis in AXES:
            return (f"{sensor}_{of_axis}",)
        if sensor in SENSORS and (self.log.static or not self.row["manoeuvre"]):
            return own
        return (_most_active(self.log, own),)

    @property
    def marked(self) -> Span | None:
        """The span, where it is not the whole log."""
        start, end = self.log.extent
        if self.span is None or self.span[1] - self.span[0] > MAX_MARKED * (end - start):
            return None
        return self.span

    @property
    def name(self) -> str:
        """The concerned channels in words."""
        sensor, of_axis = CHANNEL_PARTS[self.channels[0]]
        return f"{of_axis} {SINGULAR[sensor]}" if len(self.channels) == 1 else PLURAL[sensor]

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
        return nothing | middles if max(widths, default=0.0) < MAX_MOTION * apart else nothing


def figure(place: Place, key: str) -> Figure | None:
    """The whole log with the place marked, and beside it the samples; none without either."""
    if place.row["cause"] in OF_NO_SAMPLE or not len(place.log.start):
        return None
    if place.span is None and place.close_up is None:
        return None
    if not any(np.isfinite(place.log.least[channel]).any() for channel in place.channels):
        return None
    name = shortened(place.log.name, 80)
    marked = _(", the wedge marks the place") if place.marked else ""
    caption, close_up = (
        _("{name}, {name_2}: the whole log{marked}.", name=name, name_2=place.name, marked=marked)
        + _masked_in_words(place),
        None,
    )
    if place.close_up is not None and len(place.close_up.line):
        close_up = _shown(place, place.close_up)
        first, last = (whole(int(close_up.line[end])) for end in (0, -1))
        caption = _(
            "{name}, {name_2}: the whole log{marked}; and lines {first} to {last} of it "
            "close up.{place}",
            name=name,
            name_2=place.name,
            marked=marked,
            first=first,
            last=last,
            place=_signs(place, close_up),
        )
    words = _(
        "The log {name} over time with the place of the finding, and the samples around it.",
        name=name,
    )
    return Figure(caption, _draw(place, close_up, key), words)


def _most_active(log: Log, channels: Sequence[str]) -> str:
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
    cause, inside = place.row["cause"], int(close_up.concerned.sum())
    affected = ""
    if 0 < inside < len(close_up.concerned) and cause != "oscillation":
        affected = _(" Ringed: affected.") if inside <= MAX_RINGED else _(" Shaded: affected.")
    if cause in OF_TIME:
        return _(
            " Close up: the time between successive records, by line.{affected}", affected=affected
        )
    signs = ""
    if len(place.channels) > 1:
        signs = _(" x orange, y green, z blue")
        signs += _(", each relative to its median.") if any(place.middles.values()) else "."
    signs += affected
    if gaps_in(close_up, place.gaps):
        signs += _(" Hatched: not recorded.")
    return signs + _masked_in_words(place)


def _masked_in_words(place: Place) -> str:
    """What is cross-hatched in the picture of the whole log; nothing where nothing is."""
    hidden = any(one.channel in ("", *place.channels) for one in place.log.masked)
    return _(" Cross-hatched: masked, not used.") if hidden else ""


# ---- drawing


def _draw(place: Place, close_up: CloseUp | None, key: str) -> str:
    unit = _unit(place)
    widths, height, points = (WIDTHS, HEIGHT, POINTS) if close_up else ((1.0,), 0.8, 3 * POINTS)
    with style():
        drawn, panels = side_by_side(widths, height, Margins(top=0.28))
        _whole_log(panels[0], place, unit, points=points)
        if close_up and place.row["cause"] in OF_TIME:
            _steps_of_time(panels[1], close_up)
        elif close_up:
            _samples(panels[1], place, close_up, unit)
        return svg(drawn, key)


def _whole_log(panel: Axes, place: Place, unit: Unit, *, points: int) -> None:
    log = place.log
    draw_phases(panel, log, place.channels)
    for channel, middle in place.middles.items():
        draw_channel(panel, log, channel, points, unit, middle)
    if place.marked is not None:
        mark_place(panel, *place.marked)
    start, end = log.extent
    panel.set_xlim(start, end if end > start else start + 1.0)
    panel.set_title(f"{place.name}, {unit.name}", loc="left", pad=PAD)
    _plain_ticks(panel)
    panel.set_xlabel(_("Time, s") if log.timed else _("Record"))


def _plain_ticks(panel: Axes) -> None:
    ticks(panel, 4, 4)
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
    if some and len(inside) > MAX_RINGED:
        start, end = _between(places, int(inside[0]), int(inside[-1]))
        panel.axvspan(start, end, color=MISSING, alpha=0.12, linewidth=0, zorder=0.5)
    for channel in place.channels:
        values = (close_up.values[channel] - place.middles[channel]) / unit.size
        panel.plot(
            np.insert(places, after_gaps, np.nan),
            np.insert(values, after_gaps, np.nan),
            color=AXIS_COLOUR[channel[-1]],
            linewidth=0.7,
            marker="." if len(places) <= MAX_DOTTED else "",
            markersize=2.5,
        )
        if some and len(inside) <= MAX_RINGED:
            panel.plot(
                places[inside], values[inside], "o", markersize=5, color=MISSING, fillstyle="none"
            )
    panel.set_xticks(along.ticks, along.labels)
    room = 0.01 * float(places[-1] - places[0]) or 0.5
    panel.set_xlim(places[0] - room, places[-1] + room)
    ticks(panel, 4)
    panel.ticklabel_format(axis="y", useOffset=False, style="plain")
    panel.set_xlabel(_("Time, s") if close_up.timed else _("Line"))
    panel.set_title(_title(close_up, after_gaps), loc="left", pad=PAD)


def _title(close_up: CloseUp, after_gaps: Sequence[int]) -> str:
    if len(close_up.line) > 1 and len(after_gaps) == 1:
        i = after_gaps[0]
        lost = float(close_up.time[i] - close_up.time[i - 1])
        return _(
            "lines {line} and {line_2}, {lost:.3f} s apart",
            line=close_up.line[i - 1],
            line_2=close_up.line[i],
            lost=lost,
        )
    return _("lines {line} to {line_2}", line=close_up.line[0], line_2=close_up.line[-1])


def _between(places: Array, first: int, last: int) -> Span:
    """From half a step before the record `first` to half a step after `last`."""
    half = float(np.median(np.diff(places))) / 2 if len(places) > 1 else 0.5
    return float(places[first]) - half, float(places[last]) + half


def _steps_of_time(panel: Axes, close_up: CloseUp) -> None:
    """The time from each record to the one before it, over the lines of the log."""
    steps = np.diff(close_up.time) * 1e3
    line = close_up.line[1:]
    usual = float(np.nanmedian(steps)) if np.isfinite(steps).any() else 0.0
    panel.axhline(usual, color=INK, linewidth=0.5, dashes=(4, 2))
    panel.plot(line, steps, color=QUIET, linewidth=0.7, marker=".", markersize=2.5)
    inside = close_up.concerned[1:]
    if MAX_RINGED < inside.sum() < len(inside):
        panel.axvspan(*line[inside][[0, -1]], color=MISSING, alpha=0.12, linewidth=0, zorder=0.5)
    if 0 < inside.sum() <= MAX_RINGED:
        panel.plot(line[inside], steps[inside], "o", markersize=5, color=MISSING, fillstyle="none")
    _plain_ticks(panel)
    panel.set_xlabel(_("Line"))
    panel.set_title(_("time since the previous record, ms"), loc="left", pad=PAD)


def _unit(place: Place) -> Unit:
    """The unit in which the largest reading, or deviation from the middle, has few digits."""
    largest = 0.0
    for channel in place.channels:
        both = np.concatenate([place.log.least[channel], place.log.most[channel]])
        if np.isfinite(both).any():
            largest = max(largest, float(np.nanmax(np.abs(both - place.middles[channel]))))
    return readable(CHANNEL_PARTS[place.channels[0]][0], largest)
