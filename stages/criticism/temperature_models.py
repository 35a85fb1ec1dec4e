"""Means at temperatures, without time: which polynomial each axis follows."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial import tables
from inertial.campaign.records import Manoeuvre
from inertial.estimation.regression import Curve, Knee, curve_of, knee_of
from inertial.text.units import STANDARD_GRAVITY

# ---- Means at temperatures, without time: readings at rest, and scale factors of turns.

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]

ACCELEROMETERS, GYROS, SCALE = "accel", "gyro", "scale"
MIN_SPAN = 5.0  # K, from which a sweep of temperatures is one
MIN_TEMPERATURES = 6  # temperatures, of which a parabola leaves enough to see the noise
MIN_SAMPLE_SHARE = 0.01  # of the median number of samples: what holds fewer is left out
MIN_ALONG = 0.5  # cosine from which a gyro sees enough of a turn
MIN_PARALLEL = 0.999  # cosine from which two attitudes are one


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
            if (
                len(np.unique(at)) >= MIN_TEMPERATURES
                and np.ptp(at) > MIN_SPAN
                and np.ptp(seen) > 0
            ):
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
    least = MIN_SAMPLE_SHARE * float(np.median(counts))
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
    truth = np.where(np.abs(m.axis) >= MIN_ALONG, m.axis * (m.rate or np.nan), np.nan)
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
    return float(rest.up @ turn.up) > MIN_PARALLEL


def _at(turn: Sweep, rest: Sweep, i: int) -> Array:
    """A gyro at rest at the temperatures of a turn, (n,); NaN outside of those of the rest."""
    there = np.isfinite(rest.readings[:, i])
    if not there.any():
        return np.full(len(turn.temperature), np.nan)
    order = np.argsort(rest.temperature[there], kind="stable")
    at, level = rest.temperature[there][order], rest.readings[there, i][order]
    return np.asarray(np.interp(turn.temperature, at, level, left=np.nan, right=np.nan))


# ---- The polynomial that each axis follows, and its residuals.

ICE_POINT = 273.15  # K
MIN_LOG_ODDS = float(np.log(20))  # from which a knee is told
MIN_SENSITIVITY = 0.5  # cosine or sine from which an accelerometer sees its scale factor, or a tilt


@dataclass(frozen=True)
class AxisModel:
    """One axis of a sweep, judged.

    `degree`: of its law, 0 where it has none; `p_value`: of that by noise alone, after the search;
    `p_beyond`: of what the highest degree leaves, after the search; `knee`: where it
    fits clearly better than that.
    """

    axis: str
    curve: Curve
    degree: int
    p_value: float
    p_beyond: float
    structure: bool
    knee: Knee | None

    @property
    def moves(self) -> bool:
        """Whether it goes with the temperature."""
        return self.degree > 0 or self.structure

    @property
    def change(self) -> float:
        """From the smallest reading to the largest."""
        return float(np.ptp(self.curve.readings))

    @property
    def described_degree(self) -> int:
        """The degree of the polynomial that stands for it."""
        return self.curve.highest if self.structure else self.degree


@dataclass(frozen=True)
class TemperatureDependence:
    """The channels of a sweep that go with the temperature, at least one."""

    sweep: Sweep
    axes: Sequence[AxisModel]

    @property
    def structured(self) -> bool:
        """Whether a polynomial does not hold all of them."""
        return any(channel.structure for channel in self.axes)

    @property
    def best(self) -> AxisModel:
        """The channel in which it is clearest."""
        if self.structured:
            own = [channel for channel in self.axes if channel.structure]
            return min(own, key=lambda one: one.p_beyond)
        return min(self.axes, key=lambda one: one.p_value)

    @property
    def tilts(self) -> dict[str, float]:
        """The tilt, rad, that would move each accelerometer across the vertical so much."""
        across = {
            one.axis: float(np.nan_to_num(np.sqrt(1 - self.sweep.along(one.axis) ** 2), nan=1.0))
            for one in self.axes
        }
        return {
            one.axis: one.change / (STANDARD_GRAVITY * across[one.axis])
            for one in self.axes
            if across[one.axis] >= MIN_SENSITIVITY
        }

    @property
    def middle(self) -> float:
        """The mean temperature, whole in °C, about which polynomials are told, K."""
        mean = np.mean([channel.curve.at.mean() for channel in self.axes])
        return float(np.round(mean - ICE_POINT)) + ICE_POINT


def temperature_dependences(swept: Sequence[Sweep], level: float) -> list[TemperatureDependence]:
    """Of all sweeps those that go with the temperature.

    `level`: accepted chance of a law in any channel where there is none, and of a structure.
    """
    every = [
        (sweep, {axis: curve_of(at, seen) for axis, at, seen in sweep.channels()})
        for sweep in swept
    ]
    curves = [curve for _, own in every for curve in own.values()]
    searched = (sum(len(c.degrees) for c in curves), len(curves))
    judged = [
        TemperatureDependence(
            sweep, [one for a, c in own.items() if (one := _judged(a, c, level, searched)).moves]
        )
        for sweep, own in every
    ]
    return [one for one in judged if one.axes]


def _judged(axis: str, curve: Curve, level: float, searched: tuple[int, int]) -> AxisModel:
    """`searched`: how many degrees of laws, and how many channels, are looked at in all."""
    laws, structures = searched
    clear = [d for d in curve.degrees if curve.p_value(range(d, d + 1)) * laws < level]
    degree = max(clear, default=0)
    beyond = min(1.0, curve.misfit_p_value() * structures)
    knee = knee_of(curve.at, curve.readings) if beyond < level else None
    if knee is not None and _odds(curve, knee) < MIN_LOG_ODDS:
        knee = None
    chance = min(1.0, curve.p_value(range(1, degree + 1)) * laws)
    return AxisModel(axis, curve, degree, chance, beyond, beyond < level, knee)


def _odds(curve: Curve, knee: Knee) -> float:
    """How much likelier, as a logarithm, two lines are than the polynomial of highest degree."""
    rounded = np.finfo(np.float64).tiny  # two lines may hold made-up readings wholly
    return len(curve.at) * float(
        np.log(curve.residual_rms(curve.highest) / max(knee.residual_rms, rounded))
    )
