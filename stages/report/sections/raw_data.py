"""The raw data of every log: envelope over time, phases, what is missing and what is masked."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from numpy.typing import NDArray

from inertial.campaign.records import grouped
from inertial.sensors import SINGULAR
from inertial.tables import AXES, CHANNEL_PARTS, CHANNELS, STATIC_PHASES
from inertial.text.cause_names import in_words
from inertial.text.messages import _, first_of
from inertial.text.numbers import counted, fixed, shortened
from inertial.text.units import DEGREES_PER_SECOND, METRES, Unit
from stages.report import drawing
from stages.report.drawing import Array
from stages.report.outline import Figure, Paragraph, Part, Section
from stages.report.tables import Record, Tables, once

Stretch = tuple[float, float]

MOST_MISSING = 50  # stretches that are marked in one log
MOST_MASKED = 100  # parts of a log; a masked sample is marked as wide as one of them at least


@dataclass(frozen=True)
class Masked:
    """Samples that a finding excludes: where, its cause, of which channel, "" where of all."""

    span: Stretch
    samples: int
    cause: str
    channel: str


@dataclass(frozen=True)
class Log:
    """One log as it is drawn: envelope over time, phases, missing and masked stretches."""

    name: str
    start: Array  # of each row of the envelope, s, or records where there is no time
    end: Array
    least: dict[str, Array]
    most: dict[str, Array]
    phases: tuple[Record, ...]
    missing: tuple[Stretch, ...]  # the longest of them
    lost: float  # s, of all gaps, from the record before to the one after
    timed: bool
    records: int
    masked: tuple[Masked, ...] = ()

    @property
    def static(self) -> bool:
        """Whether the plan has the table at rest all through."""
        return bool(self.phases) and all(row["phase"] in STATIC_PHASES for row in self.phases)

    @property
    def extent(self) -> Stretch:
        """From its first to its last sample."""
        return (float(self.start.min()), float(self.end.max())) if len(self.start) else (0.0, 0.0)

    def rows(self, index: NDArray[np.integer[Any]]) -> Log:
        """The rows of the envelope that `index` lists, as often as it does."""
        return replace(
            self,
            start=self.start[index],
            end=self.end[index],
            least={name: values[index] for name, values in self.least.items()},
            most={name: values[index] for name, values in self.most.items()},
        )


@once
def logs(tables: Tables) -> list[Log]:
    """Every log with its envelope, the phases of its manoeuvres, what is missing and masked."""
    causes = {
        row["id"]: row["cause"] for name in MASKING for row in tables.rows(f"{name}_findings")
    }
    masks = grouped(tables.rows("masks"), lambda row: row["log"])
    clock = {row["log"]: row for row in tables.rows("clocks")}
    gaps = tables.frame("gaps")
    stated = gaps[["from_s", "to_s"]].to_numpy(dtype=np.float64)
    each = []
    for name, rows in tables.frame("traces").groupby("log", sort=False, observed=True):
        log = str(name)
        timed = not bool(rows["from_s"].isna().any() or rows["to_s"].isna().any())
        columns = ("from_s", "to_s") if timed else ("from_record", "to_record")
        start, end = (rows[column].to_numpy(dtype=np.float64) for column in columns)
        interval = clock.get(log, {}).get("interval")
        own_gaps = stated[(gaps["log"] == log).to_numpy()]
        missing = _missing(start, end, interval, own_gaps) if timed else []
        longest = tuple(sorted(_longest(missing, MOST_MISSING)))
        lost = sum(b - a for a, b in missing)
        least, most = (
            {name: rows[f"{which}_{name}"].to_numpy(dtype=np.float64) for name in CHANNELS}
            for which in ("least", "most")
        )
        own = tuple(
            row | {"start": row[columns[0]], "end": row[columns[1]]}
            for row in tables.rows("segments")
            if row["log"] == log and row[columns[0]] is not None and row[columns[1]] is not None
        )
        count = int(clock.get(log, {}).get("records") or rows["to_record"].max())
        hidden = tuple(_masked(rows, start, end, masks.get(log, ()), causes))
        drawn = Log(log, start, end, least, most, own, longest, lost, timed, count, hidden)
        each.append(_cut(drawn))
    return each


def _missing(start: Array, end: Array, interval: float | None, gaps: Array) -> list[Stretch]:
    """Stretches without samples: the gaps, and wherever else the envelope breaks off."""
    step = interval or (float(np.median(start[1:] - end[:-1])) if len(start) > 1 else np.inf)
    breaks = np.flatnonzero(start[1:] - end[:-1] > 2.5 * step)
    seen = np.column_stack([end[breaks], start[breaks + 1]])
    gaps = gaps[np.argsort(gaps[:, 0])]
    before = np.searchsorted(gaps[:, 0], seen[:, 1]) - 1  # the last gap that begins before its end
    stated = np.zeros(len(seen), bool)
    if len(gaps):
        stated = (before >= 0) & (gaps[before, 1] > seen[:, 0])
    return [(float(a), float(b)) for a, b in np.concatenate([gaps, seen[~stated]])]


def _masked(
    rows: pd.DataFrame, start: Array, end: Array, masks: Sequence[Record], causes: dict[str, str]
) -> Iterator[Masked]:
    """Where the masked samples of a log are, by the records and places of its envelope."""
    records = rows[["from_record", "to_record"]].to_numpy(dtype=np.float64) - [0.0, 1.0]
    places = np.column_stack([start, end])
    for row in masks:
        first, after = row["from_record"], row["to_record"]
        span = np.interp([first, after - 1], records.ravel(), places.ravel())
        channel = f"{row['sensor']}_{row['axis']}" if row["sensor"] else ""
        cause = causes.get(row["finding"], "")
        yield Masked((float(span[0]), float(span[1])), after - first, cause, channel)


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


# ---- the section

MASKING = ("quality", "segment")  # the stages whose findings mask samples
MOST_POINTS = 45_000  # of all figures together: what a page may weigh
POINTS_PER_CURVE = (60, 300)
MANY_LOGS = 24  # from here on the figures are small, x, y and z in one panel
MOST_LOGS = 110
MOST_MANOEUVRES = 6  # named below a figure
ABSOLUTE = {"gyro": DEGREES_PER_SECOND, "accel": METRES}
NAMES = {"gyro": _("Angular rate"), "accel": _("Specific force")}


def parts(tables: Tables) -> Iterator[Part]:
    """One figure per log."""
    each = logs(tables)
    points = int(np.clip(MOST_POINTS / (6 * max(len(each), 1)), *POINTS_PER_CURVE))
    for number, log in enumerate(each[:MOST_LOGS], 1):
        yield _figure(log, f"log-{number}", points, small=len(each) > MANY_LOGS)
    if len(each) > MOST_LOGS:
        more = counted(len(each) - MOST_LOGS, _("further log"))
        yield Paragraph(_("{more} not drawn, to keep the page light.", more=more))
    if not each:
        yield Paragraph(_("None: no log gave samples that could be drawn."), "poor")
    elif not any(log.missing for log in each):
        yield Paragraph(_("Missing stretches: none."), "good")


SECTION = Section(
    "raw-data",
    _("Raw data"),
    _("Gyros and accelerometers of every log, as recorded."),
    _(
        "Each band runs from the smallest to the largest sample of a short stretch, so no spike is "
        "lost; logs at rest are drawn relative to the median. Behind the "
        "curves, x orange, y green, z blue: rest grey, spin-up and spin-down yellow, steady turn "
        "blue; hatched: not recorded, close up among the findings; cross-hatched: recorded, but "
        "masked by a finding, so that nothing is estimated from it."
    ),
    ("traces", "segments", "clocks", "gaps", "masks", *(f"{name}_findings" for name in MASKING)),
    parts,
)


def _figure(log: Log, key: str, points: int, *, small: bool) -> Figure:
    manoeuvres = list(dict.fromkeys(row["manoeuvre"] for row in log.phases))
    named = first_of(manoeuvres, MOST_MANOEUVRES)
    length = log.extent[1] - log.extent[0]
    lasting = f", {fixed(length, 1)} s" if log.timed else _(", without time stamps")
    view = _("each channel relative to its median") if log.static else _("as recorded")
    caption = (
        f"{shortened(log.name, 80)}: {shortened(named, 160) or _('no manoeuvre found')}; "
        f"{counted(log.records, 'sample')}{lasting}; {view}."
    )
    if log.missing:
        caption += _(" Gaps of {lost} s in all, from record to record.", lost=fixed(log.lost, 2))
    caption += _masked_in_words(log)
    words = _(
        "Six curves over time: rates and specific forces of x, y and z of the log {name}.",
        name=log.name,
    )
    drawn = _draw(log, key, points, small=small)
    return Figure(caption, drawn, words, "fair" if log.missing else "")


def _masked_in_words(log: Log) -> str:
    """What the cross-hatched stretches of a log are, as a sentence; nothing where it has none."""
    samples: dict[str, int] = {}
    for one in log.masked:
        sensor, axis = CHANNEL_PARTS.get(one.channel, ("", ""))
        name = in_words(one.cause) + (f", {axis} {SINGULAR[sensor]}" if sensor else "")
        samples[name] = samples.get(name, 0) + one.samples
    if not samples:
        return ""
    each = "; ".join(f"{name}: {counted(count, 'sample')}" for name, count in samples.items())
    return _(" Cross-hatched: masked, not used ({each}).", each=shortened(each, 300))


def _draw(log: Log, key: str, points: int, *, small: bool) -> str:
    """Gyros on the left, accelerometers on the right, one panel per axis."""
    with drawing.style():
        lines, height = (1, 0.75) if small else (3, 0.62)
        figure, axes = drawing.panels(lines, 2, height, drawing.Margins())
        for column, sensor in enumerate(ABSOLUTE):
            middles = {a: _middle(log, f"{sensor}_{a}") if log.static else 0.0 for a in AXES}
            unit = _unit(log, sensor, middles) if log.static else ABSOLUTE[sensor]
            own = [row[column] for row in axes]
            for panel, axis in zip(own, AXES, strict=False):
                draw_phases(panel, log, [f"{sensor}_{each}" for each in (AXES if small else axis)])
                drawing.ticks(panel, 4)
                panel.ticklabel_format(axis="y", useOffset=False)
            for panel, axis in zip(own * 3 if small else own, AXES, strict=True):
                channel = f"{sensor}_{axis}"
                if not len(log.start) or not np.isfinite(log.least[channel]).any():
                    drawing.write_inside(panel, _("not recorded"))
                else:
                    draw_channel(panel, log, channel, points, unit, middles[axis])
                if not small:
                    drawing.name_axis(panel, axis, _label(axis, middles[axis], sensor, log))
            own[0].set_title(f"{NAMES[sensor]}, {unit.name}", loc="left", pad=2)
            own[-1].set_xlabel(_("Time, s") if log.timed else _("Record"))
        if len(log.start):
            left, right = log.extent
            axes[0][0].set_xlim(left, right if right > left else left + 1.0)
        return drawing.svg(figure, key)


def draw_phases(panel: Axes, log: Log, channels: Sequence[str]) -> None:
    """The phases behind the curves of these channels, what is missing and what is masked."""
    drawing.shade(panel, log.phases)
    for start, end in log.missing:
        drawing.hatch_missing(panel, start, end)
    masked = [one.span for one in log.masked if one.channel in ("", *channels)]
    for start, end in _joined(masked, log):
        drawing.hatch_masked(panel, start, end)


def _joined(spans: Sequence[Stretch], log: Log) -> list[Stretch]:
    """Stretches as wide as a line at least, those that would touch each other as one."""
    start, end = log.extent
    width = (end - start) / MOST_MASKED
    joined: list[Stretch] = []
    for first, last in sorted(spans):
        middle = (first + last) / 2
        wide = min(first, middle - width / 2), max(last, middle + width / 2)
        if joined and wide[0] <= joined[-1][1]:
            joined[-1] = joined[-1][0], max(joined[-1][1], wide[1])
        else:
            joined.append(wide)
    return joined


def draw_channel(
    panel: Axes, log: Log, channel: str, points: int, unit: Unit, middle: float
) -> None:
    """One channel as the band from its smallest to its largest samples, relative to `middle`."""
    time, low, high = envelope(log, channel, points)
    low, high = (low - middle) / unit.size, (high - middle) / unit.size
    drawing.band(panel, time, low, high, drawing.AXIS_COLOUR[channel[-1]], zorder=2)


def _label(axis: str, middle: float, sensor: str, log: Log) -> str:
    if not log.static or not np.isfinite(middle):
        return axis
    unit = ABSOLUTE[sensor]
    return _(
        "{axis}, about {fixed} {name}", axis=axis, fixed=fixed(unit.of(middle), 5), name=unit.name
    )


def _middle(log: Log, channel: str) -> float:
    both = (log.least[channel] + log.most[channel]) / 2
    return float(np.nanmedian(both)) if np.isfinite(both).any() else float("nan")


def _unit(log: Log, sensor: str, middles: dict[str, float]) -> Unit:
    """The unit in which the largest deviation of a log at rest has few digits."""
    deviations = (
        float(np.nanmax(np.abs(values[f"{sensor}_{axis}"] - middles[axis])))
        for values in (log.least, log.most)
        for axis in AXES
        if np.isfinite(middles[axis])
    )
    return drawing.readable(sensor, max(deviations, default=0.0))
