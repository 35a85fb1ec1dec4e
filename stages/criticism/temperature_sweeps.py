"""Means at temperatures, without time: readings at rest, and scale factors of turns."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial import tables
from inertial.campaign.records import Manoeuvre

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]

ACCELEROMETERS, GYROS, SCALE = "accel", "gyro", "scale"
SPAN = 5.0  # K, from which a sweep of temperatures is one
FEWEST = 6  # temperatures, of which a parabola leaves enough to see the noise
POOR = 0.01  # of the median number of samples: what holds fewer is left out
ALONG = 0.5  # cosine from which a gyro sees enough of a turn
PARALLEL = 0.999  # cosine from which two attitudes are one


@dataclass(frozen=True)
class Sweep:
    """Readings of three sensors at n temperatures in one manoeuvre.

    `kind`: ACCELEROMETERS, m/s², or GYROS, rad/s, at rest; SCALE, scale factor errors of gyros, 1;
    `temperature`: (n,), K; `readings`: (n, 3), NaN where there are none; `poor`: how many means
    were left out for they hold fewer than `least` samples; `unbiased`: whether of a turn the
    readings at rest were taken off.
    """

    manoeuvre: Manoeuvre
    kind: str
    temperature: Array
    readings: Array
    poor: int
    least: float
    unbiased: bool = True

    @property
    def sensor(self) -> str:
        """As findings call it."""
        return ACCELEROMETERS if self.kind == ACCELEROMETERS else GYROS

    def along(self, axis: str) -> float:
        """Cosine between an axis and the vertical; NaN where that is unknown."""
        up = self.manoeuvre.up
        return float("nan") if up is None else min(1.0, abs(float(up[tables.AXES.index(axis)])))

    def channels(self) -> Iterator[tuple[str, Array, Array]]:
        """Axis, temperatures and readings of what was recorded over a span, and is not constant."""
        for axis, values in zip(tables.AXES, self.readings.T, strict=True):
            there = np.isfinite(values)
            at, seen = self.temperature[there], values[there]
            if len(np.unique(at)) >= FEWEST and np.ptp(at) > SPAN and np.ptp(seen) > 0:
                yield axis, at, seen


def sweeps(blocks: pd.DataFrame, plan: Sequence[Manoeuvre]) -> list[Sweep]:
    """Those of one mount, in the order of the plan; none where times or samples were recorded."""
    means = _means(blocks)
    of = {name: own for name, own in means.groupby("manoeuvre", sort=False)}
    rests = [
        sweep
        for m in plan
        if m.do == "rest" and m.name in of
        for sweep in (_sweep(m, kind, of[m.name]) for kind in (ACCELEROMETERS, GYROS))
    ]
    turns = [
        _of_turn(_sweep(m, GYROS, of[m.name]), rests)
        for m in plan
        if m.do == "turn" and m.name in of and m.recorded == "steady" and m.rate
    ]
    return [*rests, *turns]


def _means(blocks: pd.DataFrame) -> pd.DataFrame:
    """The blocks that are means of many samples at a temperature, and have no time."""
    records = blocks["to_record"] - blocks["from_record"]
    own = blocks["time"].isna() & blocks["temperature"].notna() & (blocks["count"] > 0)
    many = (blocks["count"] > records).groupby(blocks["manoeuvre"]).transform("any")
    return blocks[own & many]


def _sweep(m: Manoeuvre, kind: str, own: pd.DataFrame) -> Sweep:
    counts = own["count"].to_numpy(np.float64)
    least = POOR * float(np.median(counts))
    poor = counts < least
    channels = [f"{kind}_{axis}" for axis in tables.AXES]
    kept = own[~poor]
    return Sweep(
        m,
        kind,
        kept["temperature"].to_numpy(np.float64),
        kept[channels].to_numpy(np.float64),
        int(poor.sum()),
        least,
    )


def _of_turn(turn: Sweep, rests: Sequence[Sweep]) -> Sweep:
    """Scale factor errors: what the gyros read above their rest at that temperature, by the rate.

    A turn without a rest in its attitude keeps the bias in it.
    """
    m = turn.manoeuvre
    rest = next((one for one in rests if one.kind == GYROS and _alike(one.manoeuvre, m)), None)
    level = np.zeros_like(turn.readings)
    if rest is not None:
        level = np.column_stack([_at(turn, rest, i) for i in range(3)])
    truth = np.where(np.abs(m.axis) >= ALONG, m.axis * (m.rate or np.nan), np.nan)
    return Sweep(
        m,
        SCALE,
        turn.temperature,
        (turn.readings - level) / truth - 1,
        turn.poor,
        turn.least,
        rest is not None,
    )


def _alike(rest: Manoeuvre, turn: Manoeuvre) -> bool:
    if rest.up is None or turn.up is None:
        return False
    return float(rest.up @ turn.up) > PARALLEL


def _at(turn: Sweep, rest: Sweep, i: int) -> Array:
    """A gyro at rest at the temperatures of a turn, (n,); NaN outside of those of the rest."""
    there = np.isfinite(rest.readings[:, i])
    if not there.any():
        return np.full(len(turn.temperature), np.nan)
    order = np.argsort(rest.temperature[there], kind="stable")
    at, level = rest.temperature[there][order], rest.readings[there, i][order]
    return np.asarray(np.interp(turn.temperature, at, level, left=np.nan, right=np.nan))
