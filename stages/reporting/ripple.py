"""What is left of gyros against the angle that the table has turned, where its angle is off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from inertial.tables import AXES
from inertial.tables.parquet import Stream
from inertial.text import numbers
from inertial.text.units import DEGREE, DEGREES_PER_HOUR
from stages.reporting.drawing import AXIS_COLOUR, QUIET, Margins, side_by_side, style, svg
from stages.reporting.oscillation import turns_about
from stages.reporting.outline import Figure
from stages.reporting.rows import Record

Array = NDArray[np.float64]

WHOLE = 360.0  # degrees
MOST_PERIODS = 12  # that can be told apart in a panel
BINS = 90  # of a panel


@dataclass(frozen=True)
class Left:
    """What is left of the gyro along the axis of a turn, °/h, against the angle turned, degrees."""

    turn: str
    axis: str
    angle: Array
    left: Array


def figure(
    simulated: Stream, manoeuvres: Sequence[Record], order: float, key: str
) -> Figure | None:
    """A turn about each axis; `order`: how many periods a turn has."""
    span = WHOLE * min(1.0, MOST_PERIODS / max(order, 1.0))
    shown = _left(simulated, manoeuvres, span)
    if not shown:
        return None
    named = "; ".join(f"{one.axis} gyro in {numbers.shortened(one.turn, 24)}" for one in shown)
    return Figure(
        f"What is left of the gyro along the axis of a turn, over the steady part, against the "
        f"angle turned since its start, means of {numbers.significant(span / BINS, 2)}°: {named}.",
        _draw(shown, span, key),
        "Residuals of gyros against the angle of the table.",
    )


def _left(simulated: Stream, manoeuvres: Sequence[Record], span: float) -> list[Left]:
    about = turns_about(manoeuvres)
    rates = {row["manoeuvre"]: row["rate"] for row in manoeuvres if row["rate"]}
    first: dict[str, list[pd.DataFrame]] = {}  # of each axis a turn
    chosen: dict[str, str] = {}
    residuals = [f"residual_gyro_{axis}" for axis in AXES]
    for batch in simulated.columns(["manoeuvre", "phase", "time", *residuals]):
        rows = batch.to_pandas()
        steady = rows[(rows["phase"] == "steady") & rows["manoeuvre"].isin(set(rates) & set(about))]
        for name, own in steady.groupby("manoeuvre", sort=False):
            axis = about[str(name)]
            if chosen.setdefault(axis, str(name)) == name:
                first.setdefault(axis, []).append(own)
    found = []
    for axis in AXES:
        if axis not in first:
            continue
        rows = pd.concat(first[axis])
        time = rows["time"].to_numpy(np.float64)
        angle = abs(rates[chosen[axis]]) / DEGREE * (time - time.min())
        inside = np.isfinite(angle) & (angle < span)
        place = (angle[inside] / span * BINS).astype(np.int64)
        if not len(place):
            continue
        values = rows[f"residual_gyro_{axis}"].to_numpy(np.float64)[inside]
        means = pd.Series(values - np.nanmean(values)).groupby(place).mean()
        at = (means.index.to_numpy(np.float64) + 0.5) * span / BINS
        left = means.to_numpy(np.float64) / DEGREES_PER_HOUR.size
        found.append(Left(chosen[axis], axis, at, left))
    return found


def _draw(shown: Sequence[Left], span: float, key: str) -> str:
    with style():
        drawn, panels = side_by_side([1.0] * len(shown), 1.1, Margins(left=0.55, across=0.45))
        for panel, one in zip(panels, shown, strict=True):
            panel.plot(
                one.angle,
                one.left,
                color=AXIS_COLOUR[one.axis],
                linewidth=0.8,
                marker=".",
                markersize=2.5,
            )
            panel.axhline(0, color=QUIET, linewidth=0.5)
            panel.set_title(f"{one.axis} gyro in {numbers.shortened(one.turn, 24)}", pad=3)
            panel.set_xlabel("Angle turned, °")
            panel.set_xlim(0, span)
            panel.xaxis.set_major_locator(MaxNLocator(5))
            panel.yaxis.set_major_locator(MaxNLocator(4))
        panels[0].set_ylabel("Left, °/h", labelpad=2)
        return svg(drawn, key)
