"""Measured over simulated, manoeuvre by manoeuvre, and the residuals without and with effects."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from inertial.tables import AXES
from inertial.tables.parquet import Stream
from inertial.text import numbers
from inertial.text.units import DEGREES_PER_HOUR, MICRO_G
from stages.reporting.drawing import (
    AXIS_COLOUR,
    AXIS_MARK,
    QUIET,
    Margins,
    side_by_side,
    style,
    svg,
)
from stages.reporting.gained import FITTED, HELD_OUT, effects_of
from stages.reporting.outline import Figure
from stages.reporting.rows import Record, records
from stages.reporting.structures import SENSOR

Array = NDArray[np.float64]

UNIT = {"gyro": DEGREES_PER_HOUR, "accel": MICRO_G}
MOST_NAMES = 24  # manoeuvres whose names have room below each other
PIECES = 5  # of a rest, so that what changes within it is seen
APART = 0.04  # of a manoeuvre, between its axes


@dataclass(frozen=True)
class Left:
    """Mean residuals of one manoeuvre, of a rest in a few pieces, of a sensor.

    `mean`, `sigma`: (pieces, 3), and what noise alone would give.
    """

    manoeuvre: str
    mean: Array
    sigma: Array


Means = dict[str, list[Left]]  # by sensor, the manoeuvres in the order of the plan


def means(simulated: Stream, fidelity: pd.DataFrame, manoeuvres: pd.DataFrame) -> Means:
    """The mean of what was read less what was simulated: whole turns, and pieces of rests."""
    noise = {(row["manoeuvre"], row["channel"]): row["noise_rms"] for row in records(fidelity)}
    channels = [f"{sensor}_{axis}" for sensor in UNIT for axis in AXES]
    sums: dict[str, list[tuple[Array, Array]]] = {}  # of each manoeuvre sums and counts, (k, 6)
    for batch in simulated.columns(["manoeuvre", "phase", *(f"residual_{c}" for c in channels)]):
        rows = batch.to_pandas()
        for name, own in rows.groupby("manoeuvre", sort=False):
            values = own[[f"residual_{c}" for c in channels]].to_numpy(np.float64)
            if (own["phase"] != "rest").any():  # samples of a turn
                values, counts = _summed(values)
            else:
                counts = np.isfinite(values).astype(np.float64)
            sums.setdefault(str(name), []).append((values, counts))
    found: Means = {sensor: [] for sensor in UNIT}
    for name in manoeuvres["manoeuvre"]:
        if name not in sums:
            continue
        values, counts = (np.concatenate(each) for each in zip(*sums[name], strict=True))
        whole = bool((counts > 1).any())
        pieces = [np.arange(len(values))] if whole else _pieces(len(values))
        totals, numbers_of = (
            np.array([np.nansum(each[piece], axis=0) for piece in pieces])
            for each in (values, counts)
        )
        with np.errstate(invalid="ignore", divide="ignore"):
            level = np.array([noise.get((name, c), np.nan) for c in channels], np.float64)
            mean = totals / numbers_of
            sigma = level / np.sqrt(numbers_of)
        for sensor, columns in (("gyro", slice(3)), ("accel", slice(3, 6))):
            found[sensor].append(Left(name, mean[:, columns], sigma[:, columns]))
    return found


def _summed(values: Array) -> tuple[Array, Array]:
    """The sum of each column and how many there are, as one row."""
    return np.nansum(values, axis=0)[np.newaxis], np.isfinite(values).sum(axis=0)[np.newaxis] * 1.0


def _pieces(blocks: int) -> list[NDArray[np.int64]]:
    """The blocks of a rest in a few pieces of equal length."""
    return [piece for piece in np.array_split(np.arange(blocks), PIECES) if len(piece)]


def figure(
    finding: Record,
    mount: str,
    left: Means,
    plan: Sequence[Record],
    gain: Sequence[Record],
    key: str,
) -> Figure | None:
    """What the joint model leaves of each manoeuvre, and each channel without and with effects."""
    sensor = finding["sensor"]
    mounts = {row["manoeuvre"]: row["mount"] for row in plan}
    shown = [
        one
        for one in left.get(sensor or "", ())
        if np.isfinite(one.mean).any() and (not mount or mounts.get(one.manoeuvre) == mount)
    ]
    if not shown:
        return None
    changes = _changes(finding, mount, gain)
    said = (
        f"Measured over simulated: what the joint model leaves of the {SENSOR[sensor]}s in each "
        "manoeuvre, means over turns and over fifths of rests, ± σ of the noise alone."
    )
    if changes:
        scope = "held out" if any(row["scope"] == HELD_OUT for row in changes.values()) else FITTED
        said += (
            " Right: the residuals of each axis without (hollow) and with effects in the model "
            f"(filled), root mean square over rests and whole turns that were {scope}; at the "
            "dashed line noise alone is left."
        )
    return Figure(
        said,
        _draw(sensor, shown, changes, key),
        "Mean residuals of each manoeuvre, and residuals of each axis before and after.",
    )


def _changes(finding: Record, mount: str, gain: Sequence[Record]) -> dict[str, Record]:
    """By axis the row of the gain: on held-out data where there is one."""
    found: dict[str, Record] = {}
    for scope in (FITTED, HELD_OUT):
        for row in gain:
            sensor, _, axis = row["sensor"].partition(" ")
            if (
                axis in AXES
                and sensor == finding["sensor"]
                and row["scope"] == scope
                and row["unit"] == "sigma"
                and (row["mount"] or "") == mount
                and finding["cause"] in effects_of(row)
                and None not in (row["rms_before"], row["rms_after"])
            ):
                found[axis] = row
    return found


def _draw(sensor: str, shown: Sequence[Left], changes: dict[str, Record], key: str) -> str:
    named = len(shown) <= MOST_NAMES
    bottom = 0.75 if named else 0.4
    with style():
        drawn, panels = side_by_side(
            [2.6, 1.0] if changes else [1.0],
            1.35,
            Margins(top=0.2, bottom=bottom, left=0.5, across=0.5),
        )
        _manoeuvres(panels[0], sensor, shown, named)
        if changes:
            _axes(panels[1], changes)
        return svg(drawn, key)


def _manoeuvres(panel: Axes, sensor: str, shown: Sequence[Left], named: bool) -> None:
    unit = UNIT[sensor]
    for place, axis in enumerate(AXES):
        for number, one in enumerate(shown):
            pieces = len(one.mean)
            within = (np.arange(pieces) + 0.5) / pieces - 0.5
            panel.errorbar(
                number + 0.8 * within + APART * (place - 1),
                one.mean[:, place] / unit.size,
                yerr=one.sigma[:, place] / unit.size,
                fmt=AXIS_MARK[axis],
                linestyle="-",
                linewidth=0.5,
                color=AXIS_COLOUR[axis],
                markersize=2.4,
                elinewidth=0.6,
                label="_" if number else axis,
            )
    panel.axhline(0, color=QUIET, linewidth=0.5)
    panel.set_title(f"Measured less simulated, {unit.name}", pad=4)
    panel.legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), ncols=3, handletextpad=0.1)
    panel.yaxis.set_major_locator(MaxNLocator(5))
    panel.set_xlim(-0.6, len(shown) - 0.4)
    if named:
        names = [numbers.shortened(one.manoeuvre, 12) for one in shown]
        panel.set_xticks(range(len(shown)), names, rotation=90)
    else:
        panel.set_xlabel("Manoeuvre, in the order of the plan")


def _axes(panel: Axes, changes: dict[str, Record]) -> None:
    for place, axis in enumerate(AXES):
        if axis not in changes:
            continue
        row, colour = changes[axis], AXIS_COLOUR[axis]
        before, after = row["rms_before"], row["rms_after"]
        panel.plot([before, after], [place, place], color=colour, linewidth=0.9)
        panel.plot(before, place, marker="o", color=colour, fillstyle="none", markersize=5)
        panel.plot(after, place, marker="o", color=colour, markersize=5)
    panel.axvline(1.0, color=QUIET, linewidth=0.7, dashes=(4, 2))
    panel.set_yticks(range(len(AXES)), list(AXES))
    panel.set_ylim(len(AXES) - 0.5, -0.5)
    panel.set_xlim(left=0.0)
    panel.xaxis.set_major_locator(MaxNLocator(5))
    panel.set_title("Without → with, σ", pad=4)
