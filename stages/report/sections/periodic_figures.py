"""Periodic effects of turns: an oscillation over one second, a ripple over the table's angle."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import degrees, pi

import numpy as np
import pandas as pd
import pyarrow as pa
from matplotlib.axes import Axes

from inertial.arrays import nearest_axis
from inertial.tables import AXES, GYRO
from inertial.text.messages import _
from inertial.text.numbers import fixed, shortened, significant
from inertial.text.units import (
    DEGREE,
    DEGREES_PER_HOUR,
    DEGREES_PER_SECOND,
    PPM,
    SECONDS_OF_ARC,
)
from stages.report import drawing
from stages.report.drawing import Array
from stages.report.outline import Figure
from stages.report.results import final_results
from stages.report.tables import Record, Tables

MAX_P = 1e-3  # below which a line is named
SECONDS = 1.0  # of a turn that are drawn
RESIDUALS = [f"residual_{name}" for name in GYRO]
COLUMNS = ["manoeuvre", "phase", "record", "time", *GYRO, *RESIDUALS]
TURN = 360.0  # degrees
MOST_PERIODS = 12  # that are distinct in a panel
BINS = 90  # of a panel


def turns_about(manoeuvres: Sequence[Record]) -> dict[str, str]:
    """The turns, each with the axis of the case that is nearest to its own."""
    return {row["manoeuvre"]: axis for row in manoeuvres if (axis := axis_of_turn(row))}


def axis_of_turn(row: Record) -> str:
    """The axis of the case that is nearest to that of a turn; empty where it is not known."""
    parts = [row[f"about_{axis}"] for axis in AXES]
    if row["do"] != "turn" or None in parts:
        return ""
    return AXES[nearest_axis(parts)]


def _steady(tables: Tables, turns: Collection[str]) -> Iterator[tuple[str, pd.DataFrame]]:
    """The steady part of these turns, as the batches of the simulation hold it."""
    for batch in tables.stream("simulated").columns(COLUMNS):
        if not set(turns).isdisjoint(pa.compute.unique(batch.column("manoeuvre")).to_pylist()):
            rows = batch.to_pandas()
            rows = rows[rows["manoeuvre"].isin(turns) & (rows["phase"] == "steady")]
            for name, own in rows.groupby("manoeuvre", sort=False):
                yield str(name), own


# ---- over time


@dataclass(frozen=True)
class View:
    """One gyro in one turn about `about`, and its strongest line."""

    line: Record
    about: str

    @property
    def gyro(self) -> str:
        """The axis of the gyro."""
        return str(self.line["axis"])

    @property
    def turn(self) -> str:
        """The turn."""
        return str(self.line["manoeuvre"])

    @property
    def title(self) -> str:
        """Which gyro in which turn."""
        return _("{gyro} gyro in {turn}", gyro=self.gyro, turn=shortened(self.turn, 24))


def _views(tables: Tables, effect: str) -> list[View]:
    """The gyro with the largest line, in a turn about its own axis and in one about another.

    Between these the gyro of the other axis, in the turn about it: whether it has one by itself.
    """
    about = turns_about(tables.rows("manoeuvres"))
    lines = _lines(tables.rows("lines"), effect)
    own = [View(row, about[row["manoeuvre"]]) for row in lines if row["manoeuvre"] in about]
    beyond_noise = [view for view in own if view.line["p_value"] < MAX_P]
    if not beyond_noise:
        return []
    axis = max(beyond_noise, key=lambda view: float(view.line["amplitude"])).gyro
    same = [view for view in own if view.gyro == axis]
    first, *others = sorted(same, key=lambda view: (view.about != axis, own.index(view)))
    for view in others:
        if view.about != first.about:
            beside = [v for v in own if v.turn == view.turn and v.gyro == v.about]
            return [first, *(v for v in beside if v.gyro != axis), view]
    return [first]


def _lines(lines: Sequence[Record], effect: str) -> list[Record]:
    """Of each gyro and turn the line that is taken for an effect; else one taken for none."""
    best: dict[tuple[str, str], Record] = {}
    for name in (effect, None):
        for row in lines:
            if row["effect"] == name:
                best.setdefault((row["manoeuvre"], row["axis"]), row)
    return list(best.values())


def over_time(tables: Tables, effect: str, key: str) -> Figure | None:
    """A second of the steady part of each turn, the samples as they were measured; or none."""
    shown = _views(tables, effect)
    samples = _seconds(tables, {view.turn for view in shown})
    shown = [view for view in shown if view.turn in samples]
    if not shown:
        return None
    with drawing.style():
        margins = drawing.Margins(top=0.34, left=0.55, across=0.4)
        drawn, panels = drawing.side_by_side([1.0] * len(shown), 1.0, margins)
        for panel, view in zip(panels, shown, strict=True):
            _curve(panel, view, samples[view.turn])
        largest = max(max(map(abs, panel.get_ylim())) for panel in panels)
        for panel in panels:
            panel.set_ylim(-largest, largest)
        panels[0].set_ylabel(DEGREES_PER_SECOND.name, labelpad=2)
        picture = drawing.svg(drawn, key)
    return Figure(
        _("One second of the steady part as measured by the gyros, the mean removed: ")
        + "; ".join(
            _("{title}, a turn about {about}", title=view.title, about=view.about) for view in shown
        )
        + _(
            ". Dashed: the amplitude of the line, where it is significant; single samples "
            "miss its peaks."
        ),
        picture,
        _("The readings of gyros over one second of a turn."),
    )


def _seconds(tables: Tables, turns: Collection[str]) -> dict[str, Mapping[str, Array]]:
    """A second from the middle of the steady part of each turn: time and what the gyros read."""
    pieces: dict[str, list[pd.DataFrame]] = {}
    for name, own in _steady(tables, turns) if turns else ():
        pieces.setdefault(name, []).append(own)
    seconds: dict[str, Mapping[str, Array]] = {}
    for name, each in pieces.items():
        rows = pd.concat(each).sort_values("record")
        time = rows["time"].to_numpy(dtype=np.float64)
        if not len(time) or not np.isfinite(time).all():
            continue
        start = time[0] + max((time[-1] - time[0] - SECONDS) / 2, 0.0)
        rows = rows[(time >= start) & (time <= start + SECONDS)]
        readings = {
            axis: (rows[f"gyro_{axis}"] + rows[f"residual_gyro_{axis}"]).to_numpy(np.float64)
            for axis in AXES
        }
        seconds[name] = {"time": rows["time"].to_numpy(dtype=np.float64), **readings}
    return seconds


def _curve(panel: Axes, view: View, samples: Mapping[str, Array]) -> None:
    line, time = view.line, samples["time"]
    values = (samples[view.gyro] - np.nanmean(samples[view.gyro])) / DEGREES_PER_SECOND.size
    colour = drawing.AXIS_COLOUR[view.gyro]
    panel.plot(time - time[0], values, color=colour, linewidth=0.7, marker=".", markersize=2.5)
    label = _("no significant line")
    if line["p_value"] < MAX_P:
        amplitude = line["amplitude"] / DEGREES_PER_SECOND.size
        for side in (-amplitude, amplitude):
            panel.axhline(side, color=drawing.QUIET, linewidth=0.6, dashes=(4, 2))
        label = _(
            "{frequency} Hz, {amplitude} °/s",
            frequency=fixed(line["frequency"], 3),
            amplitude=significant(amplitude, 3),
        )
    panel.set_title(f"{view.title}\n{label}", loc="left", pad=3, fontsize=6.8)
    panel.set_xlabel(_("Time, s"))
    drawing.ticks(panel, 4, 4)


def angle(tables: Tables, effect: str) -> Iterator[str]:
    """The angle of the oscillation against that of the turn and the sigma of the scale factor."""
    shown = _views(tables, effect)
    if not shown:
        return
    line, axis = shown[0].line, shown[0].gyro
    amplitude = line["amplitude"] / (2 * pi * line["frequency"])
    plan = {row["manoeuvre"]: row for row in tables.rows("manoeuvres")}
    whole = abs(plan[line["manoeuvre"]]["angle"] or 0.0)
    sentence = _(
        "As an angle, A/(2πf), it is {amplitude} arcsec",
        amplitude=significant(SECONDS_OF_ARC.of(amplitude), 3),
    )
    if whole:
        share = significant(PPM.of(amplitude / whole), 2)
        sentence += _(
            ": {share} ppm of {fixed}°, if the turn were cut off in mid-swing",
            share=share,
            fixed=fixed(degrees(whole), 0),
        )
        results = [
            result.calibration for result in final_results(tables) if result.stage == "gyroscope"
        ]
        name = f"scale_{axis}"
        sigma = next((row[name]["sigma"] for row in results if name in row), None)
        if sigma:
            sentence += _(
                "; the σ of the scale factor of the {axis} gyro is {significant} ppm",
                axis=axis,
                significant=significant(PPM.of(sigma), 2),
            )
    yield sentence + "."


# ---- over the angle of the table


def over_angle(tables: Tables, order: float, key: str) -> Figure | None:
    """Residuals of a turn about each axis; `order`: how many periods a turn has."""
    span = TURN * min(1.0, MOST_PERIODS / max(order, 1.0))
    shown = list(_binned(tables, span))
    if not shown:
        return None
    names = [
        _("{axis} gyro in {turn}", axis=axis, turn=shortened(turn, 24))
        for turn, axis, *_unused in shown
    ]
    with drawing.style():
        margins = drawing.Margins(left=0.55, across=0.45)
        drawn, panels = drawing.side_by_side([1.0] * len(shown), 1.1, margins)
        for panel, name, (_unused, axis, x, y) in zip(panels, names, shown, strict=True):
            colour = drawing.AXIS_COLOUR[axis]
            panel.plot(x, y, color=colour, linewidth=0.8, marker=".", markersize=2.5)
            panel.axhline(0, color=drawing.QUIET, linewidth=0.5)
            panel.set_title(name, pad=3)
            panel.set_xlabel(_("Angle turned, °"))
            panel.set_xlim(0, span)
            drawing.ticks(panel, 4, 5)
        panels[0].set_ylabel(_("Residual, °/h"), labelpad=2)
        picture = drawing.svg(drawn, key)
    return Figure(
        _(
            "Residual of the gyro along the axis of rotation, over the steady part, against "
            "the angle turned since its start, means of {significant}°: {names}.",
            significant=significant(span / BINS, 2),
            names="; ".join(names),
        ),
        picture,
        _("Residuals of gyros against the angle of the table."),
    )


def spun_up(plan: Sequence[Record], turn: str) -> float:
    """The angle in which a turn reaches its rate, rad; 0 where its acceleration is not stated."""
    (row,) = (row for row in plan if row["manoeuvre"] == turn)
    return float(row["rate"] ** 2 / (2 * row["acceleration"])) if row["acceleration"] else 0.0


def _binned(tables: Tables, span: float) -> Iterator[tuple[str, str, Array, Array]]:
    """Of each axis a turn: its name, the axis, the angle turned, °, and the residual, °/h."""
    plan = tables.rows("manoeuvres")
    about = turns_about(plan)
    rates = {row["manoeuvre"]: row["rate"] for row in plan if row["rate"]}
    chosen: dict[str, str] = {}
    pieces: dict[str, list[pd.DataFrame]] = {}
    for name, own in _steady(tables, set(rates) & set(about)):
        if chosen.setdefault(about[name], name) == name:
            pieces.setdefault(about[name], []).append(own)
    for axis in (axis for axis in AXES if axis in pieces):
        rows = pd.concat(pieces[axis])
        time = rows["time"].to_numpy(np.float64)
        turned = abs(rates[chosen[axis]]) / DEGREE * (time - time.min())
        turned += spun_up(plan, chosen[axis]) / DEGREE  # since the start, not of the steady part
        inside = np.isfinite(turned) & (turned < span)
        place = (turned[inside] / span * BINS).astype(np.int64)
        if len(place):
            values = rows[f"residual_gyro_{axis}"].to_numpy(np.float64)[inside]
            means = pd.Series(values - np.nanmean(values)).groupby(place).mean()
            middle = (means.index.to_numpy(np.float64) + 0.5) * span / BINS
            residual = means.to_numpy(np.float64) / DEGREES_PER_HOUR.size
            yield chosen[axis], axis, middle, residual
