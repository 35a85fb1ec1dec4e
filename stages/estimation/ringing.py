"""Oscillations of the case while the table turns, in the full-rate residuals of the gyros."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from stages.contracts.parquet import Stream
from stages.contracts.tables import AXES
from stages.inference.lines import Line, strongest
from stages.model.forward import Triad

Array = NDArray[np.float64]

FEW = 3  # samples in a row without which an oscillation is still the same


@dataclass(frozen=True)
class Ringing:
    """The strongest line of one axis of the case in one turn; amplitude in rad/s of true rate."""

    manoeuvre: str
    axis: str
    line: Line


def steady_residuals(simulated: Stream) -> Iterator[tuple[str, Array]]:
    """The gyro residuals of the steady part of each turn, (n, 3), rad/s; one turn at a time.

    Of a turn with a gap it is the longest stretch without one.
    """
    columns = ["manoeuvre", "phase", "time", *(f"residual_gyro_{axis}" for axis in AXES)]
    name, parts = "", []  # type: str, list[Array]
    for batch in simulated.columns(columns):
        frame = batch.to_pandas()
        steady = frame[frame["phase"] == "steady"]
        for manoeuvre, rows in steady.groupby("manoeuvre", sort=False):
            if manoeuvre != name and parts:
                yield name, _unbroken(np.concatenate(parts))
                parts = []
            name = str(manoeuvre)
            parts.append(rows[columns[2:]].to_numpy(np.float64))
    if parts:
        yield name, _unbroken(np.concatenate(parts))


def _unbroken(rows: Array) -> Array:
    """The longest stretch of residuals, (m, 3), from rows of time and residuals, (n, 4).

    A few samples that are missing or masked break none: they hold nothing but noise, so nothing.
    """
    rows = rows[~np.isnan(rows[:, 1:]).all(axis=1)]
    if len(rows) < 2 or np.isnan(rows[:, 0]).any():
        return rows[:, 1:]
    pause = np.diff(rows[:, 0])
    step = np.mean(pause[pause < 1.5 * np.median(pause)])
    passed = np.maximum(np.round(pause / step), 1).astype(np.int64)
    edges = [0, *(np.flatnonzero(passed > FEW + 1) + 1).tolist(), len(rows)]
    first, after = max(pairwise(edges), key=lambda edge: edge[1] - edge[0])
    place = np.append(0, np.cumsum(passed[first : after - 1]))
    stretch = np.zeros((place[-1] + 1, len(AXES)))
    stretch[place] = rows[first:after, 1:]
    return stretch


def ringing(
    name: str, residuals: Array, gyro: Triad, step: float, averaged: bool, lowest: float
) -> list[Ringing]:
    """The strongest line about each axis of the case, the coupling by M undone.

    An increment is the mean of the rate over its interval, which lessens a line by
    sin(πfT)/(πfT); where samples are `averaged` so, that is undone too.

    Parameters
    ----------
    residuals : (n, 3), rad/s, of the gyros; `step`, s, of a sample
    lowest : Hz, below which nothing is looked for
    """
    truth = residuals @ np.linalg.inv(gyro.matrix).T
    found = []
    for i, axis in enumerate(AXES):
        record = truth[:, i]
        line = strongest(record, 1 / step, lowest) if np.isfinite(record).all() else None
        if line is not None:
            share = float(np.sinc(line.frequency * step)) if averaged else 1.0
            whole = Line(
                line.frequency,
                line.sigma_frequency,
                line.amplitude / share,
                line.sigma_amplitude / share,
                line.p_value,
            )
            found.append(Ringing(name, axis, whole))
    return found


@dataclass(frozen=True)
class Oscillating:
    """One oscillation over all turns that show it: axis, frequency, amplitude, with sigmas."""

    axis: str
    manoeuvres: tuple[str, ...]
    frequency: float
    frequency_sigma: float
    amplitude: float
    amplitude_sigma: float
    p_value: float  # of the clearest turn, the search over turns and axes paid for


def together(every: Sequence[Ringing], level: float) -> list[Oscillating]:
    """The oscillations that chance does not explain, the clearest first.

    Turns that ring about one axis at one frequency are one oscillation.
    """
    trials = max(len(every), 1)
    clear = [one for one in every if one.line.p_value * trials < level]
    clear.sort(key=lambda one: (one.line.p_value, -one.line.amplitude))
    found = []
    while clear:
        first = clear[0]
        same = [
            one
            for one in clear
            if one.axis == first.axis
            and abs(one.line.frequency - first.line.frequency)
            < 5 * np.hypot(one.line.sigma_frequency, first.line.sigma_frequency)
        ]
        clear = [one for one in clear if one not in same]
        frequency = _weighted([(o.line.frequency, o.line.sigma_frequency) for o in same])
        amplitude = _weighted([(o.line.amplitude, o.line.sigma_amplitude) for o in same])
        names = tuple(one.manoeuvre for one in same)
        p_value = min(first.line.p_value * trials, 1.0)
        found.append(Oscillating(first.axis, names, *frequency, *amplitude, p_value))
    return found


def _weighted(values: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Mean of several values, each with its sigma, and the sigma of the mean."""
    numbers, sigmas = np.array(values).T
    weights = sigmas**-2
    return float(np.average(numbers, weights=weights)), float(weights.sum() ** -0.5)
