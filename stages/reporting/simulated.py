"""Measured over simulated: whole turns sample by sample, and what is left beside the noise."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
import pyarrow as pa
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from inertial.tables import AXES, CHANNELS, GYRO
from inertial.tables.parquet import Stream
from inertial.text import numbers
from inertial.text.units import DEGREES_PER_HOUR, DEGREES_PER_SECOND, METRES, MILLIMETRES, Unit
from stages.reporting.drawing import AXIS_COLOUR, INK, Margins, panels, shade, style, svg
from stages.reporting.outline import Column, Figure, Heading, Paragraph, Part, Row, Section, Table
from stages.reporting.rows import Record, records

Array = NDArray[np.float64]

AT_REST = "at rest"
MOST_TURNS = 6
POINTS = 150  # per curve
TOO_MUCH = 1.2  # residual over noise from which it is marked
MARK = "▲"
MOST_ROWS = 80
RESIDUALS = tuple(f"residual_{channel}" for channel in CHANNELS)


@dataclass(frozen=True)
class Turn:
    """One turn that is drawn: its records, its phases and the gyro along its axis."""

    name: str
    profile: str
    axis: str
    first: int
    after: int
    phases: tuple[Record, ...]


class Envelope:
    """The extremes of the curves of one turn over equal shares of its records.

    It takes batch after batch and never holds more than POINTS numbers a curve.
    """

    def __init__(self, turn: Turn) -> None:
        self.turn = turn
        self.points = min(POINTS, max(turn.after - turn.first, 1))
        self._least: dict[str, Array] = {}
        self._most: dict[str, Array] = {}

    def add(self, record: NDArray[np.int64], columns: dict[str, Array]) -> None:
        """The samples of one batch."""
        turn = self.turn
        inside = (record >= turn.first) & (record < turn.after)
        place = (record[inside] - turn.first) * self.points // max(turn.after - turn.first, 1)
        for name, values in columns.items():
            least = self._least.setdefault(name, np.full(self.points, np.nan))
            most = self._most.setdefault(name, np.full(self.points, np.nan))
            np.fmin.at(least, place, values[inside])
            np.fmax.at(most, place, values[inside])

    def curve(self, name: str) -> tuple[Array, Array]:
        """The smallest and the largest of each share; NaN where there is none."""
        nothing = np.full(self.points, np.nan)
        return self._least.get(name, nothing), self._most.get(name, nothing)

    @property
    def timed(self) -> bool:
        """Whether its samples have times."""
        return bool(np.isfinite(self.curve("time")[0]).any())

    @property
    def x(self) -> Array:
        """The middle of each share: its time, or its record where there is no time."""
        if self.timed:
            least, most = self.curve("time")
            return (least + most) / 2
        shares = (np.arange(self.points) + 0.5) / self.points
        return self.turn.first + shares * (self.turn.after - self.turn.first)


def section(
    simulated: Stream, fidelity: pd.DataFrame, manoeuvres: pd.DataFrame, segments: pd.DataFrame
) -> Section:
    """One figure per turn that is drawn, and the residuals over the noise as a table."""
    rows = records(fidelity)
    turns = drawn_turns(rows, records(manoeuvres), records(segments))
    found = envelopes(simulated, turns)
    parts: list[Part] = [
        _figure(envelope, f"simulated-{number}") for number, envelope in enumerate(found, 1)
    ]
    if not parts:
        parts.append(Paragraph("No whole turn was simulated.", "fair"))
    more = len({row["manoeuvre"] for row in rows if row["profile"] != AT_REST}) - len(found)
    if found and more > 0:
        parts.append(Paragraph(f"{numbers.counted(more, 'further turn')} simulated but not drawn."))
    parts += [Heading("Residual over noise"), _table(rows)]
    return Section(
        "simulated",
        "Measured over simulated",
        "What the instrument read, over what it should have read by the joint parameters and the "
        "motion of the table.",
        "Left: the gyro along the axis of the turn, measured as a band and simulated as a line. "
        "Right: what is left when the simulation is taken off, x orange, y green, z blue, from "
        "the smallest to the largest sample. A residual that is noise alone gives 1.0 in the "
        f"table; {MARK} marks what is above {TOO_MUCH}. Of a turn every sample counts, of a rest "
        "the means of its blocks.",
        parts,
    )


# ---- which turns, and their envelopes


def drawn_turns(
    fidelity: Sequence[Record], manoeuvres: Sequence[Record], segments: Sequence[Record]
) -> list[Turn]:
    """Up to six of the turns that were simulated, an axis at a time; in the order of the plan."""
    profiles = {row["manoeuvre"]: row["profile"] for row in fidelity if row["profile"] != AT_REST}
    by_axis: dict[str, list[Turn]] = {axis: [] for axis in AXES}
    order: list[str] = []
    for row in manoeuvres:
        own = tuple(part for part in segments if part["manoeuvre"] == row["manoeuvre"])
        about = [row[f"about_{axis}"] for axis in AXES]
        if row["manoeuvre"] not in profiles or not own or None in about:
            continue
        axis = AXES[int(np.argmax(np.abs(about)))]
        first = min(part["from_record"] for part in own)
        after = max(part["to_record"] for part in own)
        name = row["manoeuvre"]
        by_axis[axis].append(Turn(name, profiles[name], axis, first, after, own))
        order.append(name)
    chosen: list[Turn] = []
    for place in range(MOST_TURNS):
        chosen += [turns[place] for turns in by_axis.values() if place < len(turns)]
    return sorted(chosen[:MOST_TURNS], key=lambda turn: order.index(turn.name))


def envelopes(simulated: Stream, turns: Sequence[Turn]) -> list[Envelope]:
    """The extremes of each turn, in one pass over the table."""
    found = {turn.name: Envelope(turn) for turn in turns}
    if not found:
        return []
    for batch in simulated.columns(["manoeuvre", "record", "time", *GYRO, *RESIDUALS]):
        names = batch.column("manoeuvre").dictionary_encode()
        index = names.indices.to_numpy(zero_copy_only=False)
        record = batch.column("record").to_numpy(zero_copy_only=False)
        for number, name in enumerate(names.dictionary.to_pylist()):
            if name not in found:
                continue
            own = np.flatnonzero(index == number)
            gyro = f"gyro_{found[name].turn.axis}"
            columns = {
                column: _numbers(batch.column(column))[own] for column in ("time", gyro, *RESIDUALS)
            }
            columns["simulated"] = columns.pop(gyro)
            columns["measured"] = columns["simulated"] + columns[f"residual_{gyro}"]
            found[name].add(record[own], columns)
    return list(found.values())


def _numbers(column: pa.Array) -> Array:
    return np.asarray(column.to_numpy(zero_copy_only=False), dtype=np.float64)


# ---- how they are drawn


def _figure(envelope: Envelope, key: str) -> Figure:
    turn = envelope.turn
    name = numbers.shortened(turn.name, 80)
    return Figure(
        f"{name}: the {turn.axis} gyro measured (band) and simulated (line); residuals of all "
        f"gyros and accelerometers. Profile of the turn: {_profile(turn.profile)}.",
        _draw(envelope, key),
        f"Measured and simulated rate of {name}, and the residuals of six channels over time.",
    )


def _profile(profile: str) -> str:
    return numbers.shortened(profile, 60)


def _draw(envelope: Envelope, key: str) -> str:
    turn = envelope.turn
    with style():
        figure, axes = panels(3, 3, 0.44, Margins(across=0.5, down=0.17))
        whole = _merged([row[0] for row in axes])
        _background(whole, envelope)
        low, high = envelope.curve("measured")
        unit = DEGREES_PER_SECOND
        x = envelope.x
        whole.fill_between(
            x, low / unit.size, high / unit.size, color=AXIS_COLOUR[turn.axis], linewidth=0.5
        )
        low, high = envelope.curve("simulated")
        middle = (low + high) / 2 / unit.size
        whole.plot(x, middle, color=INK, linewidth=0.7, dashes=(4, 2))
        whole.set_title(f"{turn.axis} gyro, {unit.name}", pad=2)
        label = "Time, s" if envelope.timed else "Record"
        whole.set_xlabel(label)
        for column, sensor, title in ((1, "gyro", "Gyro"), (2, "accel", "Accel.")):
            unit = _unit(envelope, sensor)
            own = [row[column] for row in axes]
            for panel, axis in zip(own, AXES, strict=True):
                _background(panel, envelope)
                low, high = envelope.curve(f"residual_{sensor}_{axis}")
                panel.fill_between(
                    x, low / unit.size, high / unit.size, color=AXIS_COLOUR[axis], linewidth=0.5
                )
                panel.axhline(0, color=INK, linewidth=0.4)
                panel.set_title(axis, loc="right", color=AXIS_COLOUR[axis], fontsize=6.5, pad=2)
            own[0].set_title(f"{title} residual, {unit.name}", loc="left", pad=2)
            own[-1].set_xlabel(label)
        there = x[np.isfinite(x)]
        if len(there) > 1:
            whole.set_xlim(float(there.min()), float(there.max()))
        return svg(figure, key)


def _merged(panels: Sequence[Axes]) -> Axes:
    """The first of some panels that stand below each other, stretched over all of them."""
    top, bottom = panels[0].get_position(), panels[-1].get_position()
    for panel in panels[1:]:
        panel.set_visible(False)
    panels[0].set_position((top.x0, bottom.y0, top.width, top.y1 - bottom.y0))
    panels[0].tick_params(labelbottom=True)
    return panels[0]


def _unit(envelope: Envelope, sensor: str) -> Unit:
    """The unit in which the largest residual has few digits."""
    curves = [c for axis in AXES for c in envelope.curve(f"residual_{sensor}_{axis}")]
    largest = float(np.nanmax(np.abs(curves), initial=0.0))
    if sensor == "gyro":
        return DEGREES_PER_HOUR if largest < DEGREES_PER_SECOND.size else DEGREES_PER_SECOND
    return MILLIMETRES if largest < 1.0 else METRES


def _background(panel: Axes, envelope: Envelope) -> None:
    start, end = ("from_s", "to_s") if envelope.timed else ("from_record", "to_record")
    for row in envelope.turn.phases:
        if row[start] is not None and row[end] is not None:
            shade(panel, row["phase"], row[start], row[end])
    panel.yaxis.set_major_locator(MaxNLocator(3))
    panel.xaxis.set_major_locator(MaxNLocator(5))
    panel.ticklabel_format(axis="both", useOffset=False)


# ---- the table


def _table(rows: Sequence[Record]) -> Table:
    lines: dict[tuple[str, str], dict[str, float]] = {}
    for row in rows:
        ratio = row["residual_rms"] / row["noise_rms"] if row["noise_rms"] else None
        if ratio is not None:
            lines.setdefault((row["profile"], row["manoeuvre"]), {})[row["channel"]] = ratio
    keys = list(lines)
    more = len(keys) - MOST_ROWS
    if more > 0:
        keys = sorted(keys, key=lambda key: -max(lines[key].values()))[:MOST_ROWS]
    # turns first: they are what the figures show
    keys.sort(key=lambda key: (key[0] == AT_REST, key[0]))
    columns = [
        numbers.aligned([_written(lines[key].get(channel)) for key in keys]) for channel in CHANNELS
    ]
    return Table(
        "Root mean square of the residuals over that of the noise.",
        (
            Column("Manoeuvre"),
            *(
                Column(channel[-1], "number", sensor)
                for sensor, name in (("Accelerometers", "accel"), ("Gyros", "gyro"))
                for channel in CHANNELS
                if channel.startswith(name)
            ),
        ),
        tuple(_rows(keys, lines, columns)),
        empty="None: nothing was simulated, for the joint fits determine no model.",
        note=f"{numbers.whole(more)} more, closer to the noise than these." if more > 0 else "",
    )


def _rows(
    keys: Sequence[tuple[str, str]],
    lines: dict[tuple[str, str], dict[str, float]],
    columns: Sequence[Sequence[str]],
) -> Iterator[Row]:
    said = ""
    for place, (profile, manoeuvre) in enumerate(keys):
        if profile != said:
            said = profile
            way = "Rests, block by block" if profile == AT_REST else "Turns, sample by sample"
            what = "" if profile == AT_REST else f"; profile: {_profile(profile)}"
            yield Row((f"{way}{what}",), heads=True)
        yield Row((numbers.shortened(manoeuvre, 60), *(column[place] for column in columns)))


def _written(ratio: float | None) -> str:
    if ratio is None:
        return "—"
    return f"{MARK} {numbers.fixed(ratio, 2)}" if ratio > TOO_MUCH else numbers.fixed(ratio, 2)
