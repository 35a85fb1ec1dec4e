"""Residuals of the joint fit: whole turns sample by sample, and their size over the noise."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pyarrow as pa
from matplotlib.axes import Axes
from numpy.typing import NDArray

from inertial.sensors import PLURAL
from inertial.tables import AXES, CHANNELS, GYRO
from inertial.tables.parquet import Stream
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, shortened
from inertial.text.typography import capital
from inertial.text.units import DEGREES_PER_SECOND, Unit
from stages.report.drawing import (
    AXIS_COLOUR,
    INK,
    Array,
    Margins,
    band,
    name_axis,
    panels,
    readable,
    shade,
    style,
    svg,
    ticks,
)
from stages.report.outline import (
    Column,
    Figure,
    Heading,
    Paragraph,
    Part,
    Row,
    Section,
    Table,
    columns,
    head,
    more,
    table_row,
)
from stages.report.sections.periodic_figures import turns_about
from stages.report.sections.residual_figures import MIN_EXCESS_RATIO, beyond_noise
from stages.report.tables import Record, Tables
from stages.report.words import term

AT_REST = _("at rest")
MOST_TURNS = 6
POINTS = 150  # per curve
MARK = "▲"
MOST_ROWS = 80
RESIDUALS = tuple(f"residual_{channel}" for channel in CHANNELS)


class Ratio(NamedTuple):
    """An rms of residuals over that of the noise, and of how many values."""

    size: float
    values: int


Ratios = Mapping[tuple[str, str], dict[str, Ratio]]  # by profile and manoeuvre, by channel


def parts(tables: Tables) -> Iterator[Part]:
    """One figure per turn that is drawn, and the residuals over the noise as a table."""
    stated = {row["manoeuvre"] for row in tables.rows("manoeuvres")}
    fidelity = [
        row
        for row in tables.rows("fidelity")
        if row["profile"] != AT_REST or row["manoeuvre"] in stated
    ]
    if not fidelity and tables.rows("fidelity"):  # of the rests that the plan does not name
        yield Paragraph(_("None: no attitude is known to simulate readings by."))
        return
    drawn = envelopes(tables.stream("simulated"), drawn_turns(tables))
    for number, envelope in enumerate(drawn, 1):
        yield _figure(envelope, f"simulated-{number}")
    every = {row["manoeuvre"] for row in fidelity if row["profile"] != AT_REST}
    if drawn and len(every) > len(drawn):
        others = counted(len(every) - len(drawn), _("further turn"))
        yield Paragraph(_("{others} simulated but not drawn.", others=others))
    if not drawn:
        yield Paragraph(_("No whole turn was simulated."), "fair")
    yield Heading(_("Ratio of residual to noise"))
    yield _table(fidelity)


SECTION = Section(
    "residuals-of-turns",
    _("Residuals of the joint fit"),
    _(
        "Measured readings less those simulated from the joint parameters, without effects, and "
        "the motion of the table."
    ),
    _(
        "Left, the gyro along the axis of rotation, measured (band) and simulated (line); right, "
        "the residuals, x orange, y green, z blue, from the smallest to the largest sample. In the "
        "table noise alone gives a ratio of 1.0 with a scatter of 1/√(2n) of n values; {mark} "
        "marks ratios beyond that (4 σ, and above {least}).",
        mark=MARK,
        least=MIN_EXCESS_RATIO,
    ),
    ("simulated", "fidelity", "manoeuvres", "segments"),
    parts,
)


# ---- which turns, and their envelopes


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


def drawn_turns(tables: Tables) -> list[Turn]:
    """Up to six of the turns that were simulated, an axis at a time; in the order of the plan."""
    simulated = (row for row in tables.rows("fidelity") if row["profile"] != AT_REST)
    profiles = {row["manoeuvre"]: row["profile"] for row in simulated}
    by_axis: dict[str, list[Turn]] = {axis: [] for axis in AXES}
    order: list[str] = []
    for name, axis in turns_about(tables.rows("manoeuvres")).items():
        own = tuple(part for part in tables.rows("segments") if part["manoeuvre"] == name)
        if name in profiles and own:
            first = min(part["from_record"] for part in own)
            after = max(part["to_record"] for part in own)
            by_axis[axis].append(Turn(name, profiles[name], axis, first, after, own))
            order.append(name)
    chosen: list[Turn] = []
    for place in range(MOST_TURNS):
        chosen += [turns[place] for turns in by_axis.values() if place < len(turns)]
    return sorted(chosen[:MOST_TURNS], key=lambda turn: order.index(turn.name))


def envelopes(simulated: Stream, turns: Sequence[Turn]) -> list[Envelope]:
    """The extremes of each turn, in one pass over the table."""
    by_turn = {turn.name: Envelope(turn) for turn in turns}
    if not by_turn:
        return []
    for batch in simulated.columns(["manoeuvre", "record", "time", *GYRO, *RESIDUALS]):
        names = batch.column("manoeuvre").dictionary_encode()
        index = names.indices.to_numpy(zero_copy_only=False)
        record = batch.column("record").to_numpy(zero_copy_only=False)
        for number, name in enumerate(names.dictionary.to_pylist()):
            if name not in by_turn:
                continue
            own = np.flatnonzero(index == number)
            gyro = f"gyro_{by_turn[name].turn.axis}"
            columns = {
                column: _numbers(batch.column(column))[own] for column in ("time", gyro, *RESIDUALS)
            }
            columns["simulated"] = columns.pop(gyro)
            columns["measured"] = columns["simulated"] + columns[f"residual_{gyro}"]
            by_turn[name].add(record[own], columns)
    return list(by_turn.values())


def _numbers(column: pa.Array) -> Array:
    return np.asarray(column.to_numpy(zero_copy_only=False), dtype=np.float64)


# ---- how they are drawn


def _figure(envelope: Envelope, key: str) -> Figure:
    turn = envelope.turn
    name = shortened(turn.name, 80)
    return Figure(
        _(
            "{name}: the {axis} gyro measured (band) and simulated (line); residuals of all "
            "gyros and accelerometers. Profile of the turn: {profile}.",
            name=name,
            axis=turn.axis,
            profile=shortened(term(turn.profile), 60),
        ),
        _draw(envelope, key),
        _(
            "Measured and simulated rate of {name}, and the residuals of six channels over time.",
            name=name,
        ),
    )


def _draw(envelope: Envelope, key: str) -> str:
    turn, x = envelope.turn, envelope.x
    label = _("Time, s") if envelope.timed else _("Record")
    with style():
        figure, axes = panels(3, 3, 0.44, Margins(across=0.5, down=0.17))
        whole = _merged([line[0] for line in axes])
        _background(whole, envelope)
        _band(whole, envelope, "measured", turn.axis, DEGREES_PER_SECOND)
        low, high = envelope.curve("simulated")
        middle = (low + high) / 2 / DEGREES_PER_SECOND.size
        whole.plot(x, middle, color=INK, linewidth=0.7, dashes=(4, 2))
        whole.set_title(
            _("{axis} gyro, {name}", axis=turn.axis, name=DEGREES_PER_SECOND.name), pad=2
        )
        whole.set_xlabel(label)
        for column, sensor, title in ((1, "gyro", _("Gyro")), (2, "accel", _("Accel."))):
            unit = _unit(envelope, sensor)
            own = [line[column] for line in axes]
            for panel, axis in zip(own, AXES, strict=True):
                _background(panel, envelope)
                _band(panel, envelope, f"residual_{sensor}_{axis}", axis, unit)
                panel.axhline(0, color=INK, linewidth=0.4)
                name_axis(panel, axis)
            own[0].set_title(
                _("{title} residual, {name}", title=title, name=unit.name), loc="left", pad=2
            )
            own[-1].set_xlabel(label)
        there = x[np.isfinite(x)]
        if len(there) > 1:
            whole.set_xlim(float(there.min()), float(there.max()))
        return svg(figure, key)


def _band(panel: Axes, envelope: Envelope, curve: str, axis: str, unit: Unit) -> None:
    low, high = envelope.curve(curve)
    band(panel, envelope.x, low / unit.size, high / unit.size, AXIS_COLOUR[axis])


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
    return readable(sensor, largest, DEGREES_PER_SECOND.size)


def _background(panel: Axes, envelope: Envelope) -> None:
    start, end = ("from_s", "to_s") if envelope.timed else ("from_record", "to_record")
    known = [row for row in envelope.turn.phases if None not in (row[start], row[end])]
    shade(panel, known, start, end)
    ticks(panel, 3, 5)
    panel.ticklabel_format(axis="both", useOffset=False)


# ---- the table


def _table(rows: Sequence[Record]) -> Table:
    ratios: dict[tuple[str, str], dict[str, Ratio]] = {}
    for row in rows:
        if row["noise_rms"] and row["residual_rms"] is not None:
            own = ratios.setdefault((row["profile"], row["manoeuvre"]), {})
            own[row["channel"]] = Ratio(row["residual_rms"] / row["noise_rms"], row["samples"])
    keys = list(ratios)
    left_out = len(keys) - MOST_ROWS
    if left_out > 0:
        keys = sorted(keys, key=lambda key: -max(ratios[key].values()).size)[:MOST_ROWS]
    # turns first: they are what the figures show
    keys.sort(key=lambda key: (key[0] == AT_REST, key[0]))
    return Table(
        _("Ratio of the root mean square of the residuals to that of the noise."),
        (
            Column(_("Manoeuvre")),
            *columns("number", *AXES, group=capital(PLURAL["accel"])),
            *columns("number", *AXES, group=capital(PLURAL["gyro"])),
        ),
        list(_rows(keys, ratios)),
        _("None: nothing was simulated, since the joint fits determine no model."),
        more(left_out, _(", closer to the noise than these")),
    )


def _rows(keys: Sequence[tuple[str, str]], ratios: Ratios) -> Iterator[Row]:
    order = [f"{sensor}_{axis}" for sensor in ("accel", "gyro") for axis in AXES]
    cells = [[_written(ratios[key].get(name)) for key in keys] for name in order]
    headed = ""
    for (profile, manoeuvre), *own in zip(keys, *cells, strict=True):
        if profile != headed:
            headed = profile
            turns = _("Turns, by samples; profile: {profile}", profile=shortened(term(profile), 60))
            yield head(_("Static positions, by means of blocks") if profile == AT_REST else turns)
        yield table_row(shortened(manoeuvre, 60), *own)


def _written(ratio: Ratio | None) -> str:
    if ratio is None:
        return "—"
    text = fixed(ratio.size, 2)
    return f"{MARK} {text}" if beyond_noise(ratio.size, ratio.values) else text
