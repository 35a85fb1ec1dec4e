"""The raw data of every log, and each missing stretch close up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from stages.contracts.tables import AXES
from stages.reporting import numbers
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
from stages.reporting.outline import Figure, Heading, Paragraph, Part, Section
from stages.reporting.rows import Record, records
from stages.reporting.units import (
    DEGREES_PER_HOUR,
    DEGREES_PER_SECOND,
    METRES,
    MILLIMETRES,
    Unit,
)

Array = NDArray[np.float64]
Stretch = tuple[float, float]

MOST_POINTS = 45_000  # of all figures together: what a page may weigh
POINTS_PER_CURVE = (60, 380)
MOST_CLOSE_UPS = 12
MOST_MISSING = 50  # stretches that are marked in one log
MANY_LOGS = 24  # from here on the figures are small, x, y and z in one panel
MOST_LOGS = 110
SMALL_RATE = 0.2 * DEGREES_PER_SECOND.size
ABSOLUTE = {"gyro": DEGREES_PER_SECOND, "accel": METRES}


@dataclass(frozen=True)
class Log:
    """One log as it is drawn: envelope over time, phases, missing stretches."""

    name: str
    start: Array  # of each row of the envelope, s, or records where there is no time
    end: Array
    least: dict[str, Array]
    most: dict[str, Array]
    phases: tuple[Record, ...]
    missing: tuple[Stretch, ...]  # the longest of them
    lost: float  # s that are missing in all
    timed: bool
    records: int

    @property
    def static(self) -> bool:
        """Whether the plan has the table at rest all through."""
        return bool(self.phases) and all(row["phase"].startswith("rest") for row in self.phases)

    def rows(self, index: NDArray[np.integer[Any]]) -> Log:
        """The rows of the envelope that `index` lists, as often as it does."""
        return replace(
            self,
            start=self.start[index],
            end=self.end[index],
            least={name: values[index] for name, values in self.least.items()},
            most={name: values[index] for name, values in self.most.items()},
        )

    def within(self, start: float, end: float) -> Log:
        """The stretch from `start` to `end` alone."""
        return self.rows(np.flatnonzero((self.end >= start) & (self.start <= end)))


def section(
    traces: pd.DataFrame,
    segments: pd.DataFrame,
    clocks: pd.DataFrame,
    findings: Sequence[Record],
) -> Section:
    """One figure per log, one per missing stretch."""
    found = logs(traces, segments, clocks, findings)
    points = int(np.clip(MOST_POINTS / (6 * max(len(found), 1)), *POINTS_PER_CURVE))
    small = len(found) > MANY_LOGS
    parts: list[Part] = [
        _figure(log, f"log-{number}", points, small)
        for number, log in enumerate(found[:MOST_LOGS], 1)
    ]
    if len(found) > MOST_LOGS:
        more = numbers.counted(len(found) - MOST_LOGS, "further log")
        parts.append(Paragraph(f"{more} not drawn, to keep the page light."))
    close_ups = [(log, stretch) for log in found for stretch in log.missing]
    if close_ups:
        parts.append(Heading("Missing stretches, close up"))
        parts += [
            _close_up(log, f"missing-{number}", stretch)
            for number, (log, stretch) in enumerate(close_ups[:MOST_CLOSE_UPS], 1)
        ]
    if len(close_ups) > MOST_CLOSE_UPS:
        more = numbers.counted(
            len(close_ups) - MOST_CLOSE_UPS, "further stretch", "further stretches"
        )
        parts.append(Paragraph(f"{more} missing; the findings list them."))
    if not found:
        parts.append(Paragraph("None: no log gave samples that could be drawn.", "poor"))
    elif not close_ups:
        parts.append(Paragraph("Missing stretches: none.", "good"))
    return Section(
        "raw-data",
        "Raw data",
        "Gyroscope and accelerometer of every log, as recorded.",
        "Each band runs from the smallest to the largest sample of a short stretch, so no spike is "
        "lost. Logs at rest are drawn about their middle, so that deviations show. Behind the "
        "curves, x orange, y green, z blue: rest grey, spin-up and spin-down yellow, steady turn "
        "blue; hatched: not recorded.",
        parts,
    )


# ---- what is drawn


def logs(
    traces: pd.DataFrame,
    segments: pd.DataFrame,
    clocks: pd.DataFrame,
    findings: Sequence[Record],
) -> list[Log]:
    """Every log with its envelope, the phases of its manoeuvres and what is missing."""
    clock = {row["log"]: row for row in records(clocks)}
    phases = records(segments)
    found = []
    for name, rows in traces.groupby("log", sort=False, observed=True):
        log = str(name)
        timed = not bool(rows["from_s"].isna().any() or rows["to_s"].isna().any())
        columns = ("from_s", "to_s") if timed else ("from_record", "to_record")
        start, end = (rows[column].to_numpy(dtype=np.float64) for column in columns)
        interval = clock.get(log, {}).get("interval")
        missing = _missing(log, start, end, interval, findings) if timed else []
        longest = tuple(sorted(_longest(missing, MOST_MISSING)))
        lost = sum(b - a for a, b in missing)
        least, most = (
            {
                channel: rows[f"{prefix}_{channel}"].to_numpy(dtype=np.float64)
                for channel in (f"{s}_{a}" for s in ("gyro", "accel") for a in AXES)
            }
            for prefix in ("least", "most")
        )
        own = tuple(
            row | {"start": row[columns[0]], "end": row[columns[1]]}
            for row in phases
            if row["log"] == log and row[columns[0]] is not None and row[columns[1]] is not None
        )
        count = int(clock.get(log, {}).get("records") or rows["to_record"].max())
        drawn = Log(log, start, end, least, most, own, longest, lost, timed, count)
        found.append(_cut(drawn))
    return found


def _missing(
    log: str, start: Array, end: Array, interval: float | None, findings: Sequence[Record]
) -> list[Stretch]:
    """Stretches without samples: by the findings, and wherever the envelope breaks off."""
    stated = [
        (row["from_s"], row["to_s"])
        for row in findings
        if row["log"] == log
        and row["count"] == 1
        and any(word in row["cause"] for word in ("gap", "missing"))
        and row["from_s"] is not None
        and row["to_s"] is not None
        and row["to_s"] > row["from_s"]
    ]
    step = interval or (float(np.median(start[1:] - end[:-1])) if len(start) > 1 else np.inf)
    breaks = np.flatnonzero(start[1:] - end[:-1] > 2.5 * step)
    seen = [(float(end[i]), float(start[i + 1])) for i in breaks]
    unstated = [(a, b) for a, b in seen if not any(c < b and d > a for c, d in stated)]
    return list({*stated, *unstated})


def _longest(stretches: Sequence[Stretch], most: int) -> list[Stretch]:
    return sorted(stretches, key=lambda stretch: (stretch[0] - stretch[1], stretch[0]))[:most]


def _cut(log: Log) -> Log:
    """The same log with rows of the envelope cut where a missing stretch lies inside them."""
    if not log.missing:
        return log
    keep: list[int] = []
    start: list[float] = []
    end: list[float] = []
    for i, (a, b) in enumerate(zip(log.start.tolist(), log.end.tolist(), strict=True)):
        inside = [(c, d) for c, d in log.missing if c < b and d > a]
        edges = [a, *(edge for stretch in inside for edge in stretch), b]
        for left, right in zip(edges[::2], edges[1::2], strict=True):
            if left <= right:
                keep.append(i)
                start.append(left)
                end.append(right)
    return replace(log.rows(np.array(keep)), start=np.array(start), end=np.array(end))


def envelope(log: Log, channel: str, points: int) -> tuple[Array, Array, Array]:
    """Middle, smallest and largest of about `points` stretches; a nan where the log breaks off."""
    count = len(log.start)
    broken = np.zeros(count, dtype=np.int64)
    for a, b in log.missing:
        broken += log.start >= (a + b) / 2
    groups = broken * (points + 1) + np.arange(count) * min(points, count) // max(count, 1)
    first = np.flatnonzero(np.diff(groups, prepend=groups[0] - 1 if count else 0))
    last = np.append(first[1:], count) - 1
    middle = (log.start[first] + log.end[last]) / 2
    low = np.fmin.reduceat(log.least[channel], first)
    high = np.fmax.reduceat(log.most[channel], first)
    between = np.flatnonzero(np.diff(broken[first])) + 1
    return (
        np.insert(middle, between, middle[between]),
        np.insert(low, between, np.nan),
        np.insert(high, between, np.nan),
    )


# ---- how it is drawn


def _figure(log: Log, key: str, points: int, small: bool) -> Figure:
    manoeuvres = list(dict.fromkeys(row["manoeuvre"] for row in log.phases))
    named = ", ".join(manoeuvres[:6]) + (
        f" and {len(manoeuvres) - 6} more" if len(manoeuvres) > 6 else ""
    )
    length = float(log.end.max() - log.start.min()) if len(log.start) else 0.0
    lasting = f", {numbers.fixed(length, 1)} s" if log.timed else ", without time stamps"
    view = "each channel about its middle" if log.static else "as recorded"
    found = numbers.shortened(named, 160) or "no manoeuvre found"
    caption = (
        f"{numbers.shortened(log.name, 80)}: {found}; "
        f"{numbers.counted(log.records, 'sample')}{lasting}; {view}."
    )
    if log.missing:
        caption += f" {numbers.fixed(log.lost, 2)} s are missing."
    drawn = _draw(log, key, points, about_middle=log.static, small=small)
    words = f"Six curves over time: rates and specific forces of x, y and z of the log {log.name}."
    return Figure(caption, drawn, words, "fair" if log.missing else "")


def _close_up(log: Log, key: str, stretch: Stretch) -> Figure:
    start, end = stretch
    room = max(2.0, 0.5 * (end - start))
    near = log.within(start - room, end + room)
    limits = (start - room, end + room)
    drawn = _draw(near, key, POINTS_PER_CURVE[1], limits=limits)
    caption = (
        f"{numbers.shortened(log.name, 80)}: not recorded from {numbers.fixed(start, 3)} s to "
        f"{numbers.fixed(end, 3)} s, {numbers.fixed(end - start, 3)} s."
    )
    return Figure(
        caption, drawn, f"The samples before and after a missing stretch of {log.name}.", "fair"
    )


def _draw(
    log: Log,
    key: str,
    points: int,
    *,
    about_middle: bool = False,
    small: bool = False,
    limits: Stretch | None = None,
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
        if limits or len(log.start):
            left, right = limits or (float(log.start.min()), float(log.end.max()))
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
