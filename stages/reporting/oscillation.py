"""An oscillation over one second of a turn, and in numbers whether it harms the result."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import degrees, pi

import numpy as np
import pandas as pd
import pyarrow as pa
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from inertial.tables import AXES, GYRO
from inertial.tables.parquet import Stream
from inertial.text import numbers
from inertial.text.units import PPM, SECONDS_OF_ARC
from stages.reporting.drawing import AXIS_COLOUR, QUIET, Margins, side_by_side, style, svg
from stages.reporting.outline import Figure
from stages.reporting.rows import Record, records

Array = NDArray[np.float64]

LOUD = 1e-3  # p-value below which a line is named
SECONDS = 1.0
MILLIRADIANS = 1e-3  # rad/s
COLUMNS = ["manoeuvre", "phase", "record", "time"]


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
    def title(self) -> str:
        """Which gyro in which turn."""
        return f"{self.gyro} gyro in {numbers.shortened(self.line['manoeuvre'], 24)}"


def views(lines: Sequence[Record], manoeuvres: Sequence[Record]) -> list[View]:
    """The gyro that rings loudest, in a turn about its own axis and in one about another.

    Between these the gyro of the other axis, in the turn about it: whether it rings by itself.
    """
    about = turns_about(manoeuvres)
    own = [View(row, about[row["manoeuvre"]]) for row in lines if row["manoeuvre"] in about]
    heard = [view for view in own if view.line["p_value"] < LOUD]
    if not heard:
        return []
    axis = max(heard, key=lambda view: float(view.line["amplitude"])).gyro
    mine = [view for view in own if view.gyro == axis]
    mine.sort(key=lambda view: (view.about != axis, own.index(view)))
    chosen = mine[:1]
    for view in mine[1:]:
        if view.about != chosen[0].about:
            turn = view.line["manoeuvre"]
            beside = [v for v in own if v.line["manoeuvre"] == turn and v.gyro == v.about]
            return [*chosen, *(v for v in beside if v.gyro != axis), view]
    return chosen


def turns_about(manoeuvres: Sequence[Record]) -> dict[str, str]:
    """The turns, each with the axis of the case that is nearest to its own."""
    return {row["manoeuvre"]: axis for row in manoeuvres if (axis := _axis(row))}


def _axis(row: Record) -> str:
    parts = [row[f"about_{axis}"] for axis in AXES]
    if row["do"] != "turn" or None in parts:
        return ""
    return AXES[int(np.argmax(np.abs(parts)))]


def of_effect(lines: pd.DataFrame, effect: str) -> list[Record]:
    """Of each gyro and turn the line that is taken for an effect; else one taken for none."""
    rows = [row for row in records(lines) if row["effect"] in (None, effect)]
    rows.sort(key=lambda row: row["effect"] is None)
    best: dict[tuple[str, str], Record] = {}
    for row in rows:
        best.setdefault((row["manoeuvre"], row["axis"]), row)
    return [best[place] for place in dict.fromkeys((r["manoeuvre"], r["axis"]) for r in rows)]


def figure(
    simulated: Stream, lines: pd.DataFrame, manoeuvres: pd.DataFrame, effect: str, key: str
) -> Figure | None:
    """A second of the steady part of each turn, the samples as they were read; or none."""
    shown = views(of_effect(lines, effect), records(manoeuvres))
    samples = _samples(simulated, {view.line["manoeuvre"] for view in shown})
    there = [view for view in shown if view.line["manoeuvre"] in samples]
    if not there:
        return None
    return Figure(
        "A second of the steady part, the mean taken off, as the gyros read it: "
        + "; ".join(f"{view.title}, a turn about {view.about}" for view in there)
        + ". Dashed: the amplitude of the line, where it is beyond noise; single samples miss its "
        "peaks.",
        _draw([(view, samples[view.line["manoeuvre"]]) for view in there], key),
        "The readings of gyros over one second of a turn.",
    )


def _samples(simulated: Stream, turns: set[str]) -> dict[str, dict[str, Array]]:
    """A second from the middle of the steady part of each turn: time and what the gyros read."""
    if not turns:
        return {}
    found: dict[str, list[pd.DataFrame]] = {}
    for batch in simulated.columns([*COLUMNS, *GYRO, *(f"residual_{name}" for name in GYRO)]):
        names = pa.compute.unique(batch.column("manoeuvre")).to_pylist()
        if turns.isdisjoint(names):
            continue
        rows = batch.to_pandas()
        rows = rows[rows["manoeuvre"].isin(turns) & (rows["phase"] == "steady")]
        for name, own in rows.groupby("manoeuvre"):
            found.setdefault(str(name), []).append(own)
    cut = {}
    for name, pieces in found.items():
        rows = pd.concat(pieces).sort_values("record")
        time = rows["time"].to_numpy(dtype=np.float64)
        if not len(time) or not np.isfinite(time).all():
            continue
        start = time[0] + max((time[-1] - time[0] - SECONDS) / 2, 0.0)
        rows = rows[(time >= start) & (time <= start + SECONDS)]
        cut[name] = {"time": rows["time"].to_numpy(dtype=np.float64)} | {
            axis: (rows[f"gyro_{axis}"] + rows[f"residual_gyro_{axis}"]).to_numpy(np.float64)
            for axis in AXES
        }
    return cut


def _draw(shown: Sequence[tuple[View, dict[str, Array]]], key: str) -> str:
    with style():
        drawn, panels = side_by_side(
            [1.0] * len(shown), 1.0, Margins(top=0.34, left=0.55, across=0.4)
        )
        for panel, (view, samples) in zip(panels, shown, strict=True):
            _curve(panel, view, samples)
        largest = max(max(map(abs, panel.get_ylim())) for panel in panels)
        for panel in panels:
            panel.set_ylim(-largest, largest)
        panels[0].set_ylabel("10⁻³ rad/s", labelpad=2)
        return svg(drawn, key)


def _curve(panel: Axes, view: View, samples: dict[str, Array]) -> None:
    line, time = view.line, samples["time"]
    values = (samples[view.gyro] - np.nanmean(samples[view.gyro])) / MILLIRADIANS
    panel.plot(
        time - time[0],
        values,
        color=AXIS_COLOUR[view.gyro],
        linewidth=0.7,
        marker=".",
        markersize=2.5,
    )
    said = "no line beyond noise"
    if line["p_value"] < LOUD:
        amplitude = line["amplitude"] / MILLIRADIANS
        for side in (-amplitude, amplitude):
            panel.axhline(side, color=QUIET, linewidth=0.6, dashes=(4, 2))
        said = (
            f"{numbers.fixed(line['frequency'], 3)} Hz, "
            f"{numbers.significant(line['amplitude'], 3)} rad/s"
        )
    panel.set_title(f"{view.title}\n{said}", loc="left", pad=3, fontsize=6.8)
    panel.set_xlabel("Time, s")
    panel.yaxis.set_major_locator(MaxNLocator(4))
    panel.xaxis.set_major_locator(MaxNLocator(4))


def harm(
    lines: pd.DataFrame, manoeuvres: pd.DataFrame, effect: str, gyro: Sequence[Record]
) -> Iterator[str]:
    """The angle of the oscillation against that of the turn; `gyro`: the parameters that count."""
    shown = views(of_effect(lines, effect), records(manoeuvres))
    if not shown:
        return
    line, axis = shown[0].line, shown[0].gyro
    angle = line["amplitude"] / (2 * pi * line["frequency"])
    plan = {row["manoeuvre"]: row for row in records(manoeuvres)}
    whole = abs(plan[line["manoeuvre"]]["angle"] or 0.0)
    said = (
        f"As an angle, A/(2πf), it is {numbers.significant(angle, 3)} rad, "
        f"{numbers.significant(SECONDS_OF_ARC.of(angle), 3)} arcsec"
    )
    if whole:
        share = numbers.significant(PPM.of(angle / whole), 2)
        said += (
            f": {share} ppm of {numbers.fixed(degrees(whole), 0)}°, were the turn cut off in "
            "mid-swing"
        )
        sigma = next((row["sigma"] for row in gyro if row["parameter"] == f"scale_{axis}"), None)
        if sigma:
            said += (
                f"; the σ of the scale factor of the {axis} gyro is "
                f"{numbers.significant(PPM.of(sigma), 2)} ppm"
            )
    yield said + "."
