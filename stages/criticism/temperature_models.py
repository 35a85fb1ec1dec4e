"""Means at temperatures, without time: which polynomial each axis follows."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from inertial import tables
from inertial.arrays import Array
from inertial.campaign.records import Manoeuvre
from inertial.estimation.regression import Curve, Knee, curve_of, knee_of
from inertial.text.messages import _
from inertial.text.units import ICE_POINT, STANDARD_GRAVITY
from stages.criticism.finding_rows import TableRow

# ---- Means at temperatures, without time: readings at rest, and scale factors of turns.

ACCELEROMETERS, GYROS, SCALE = "accel", "gyro", "scale"
MIN_SPAN = 5.0  # K, of a sweep of temperatures
MIN_TEMPERATURES = 6  # so that the residuals of a parabola show the noise
MIN_SAMPLE_SHARE = 0.01  # of the median number of samples; means of fewer are omitted
MIN_ALONG = 0.5  # cosine of the angle between the axis of a gyro and that of a turn
MIN_PARALLEL = 0.999  # cosine of the angle between two attitudes taken as the same


@dataclass(frozen=True)
class Sweep:
    """Readings of three sensors at n temperatures in one manoeuvre.

    `kind`: ACCELEROMETERS, m/s², or GYROS, rad/s, at rest; SCALE, scale factor errors of gyros, 1;
    `temperature`: (n,), K; `readings`: (n, 3), NaN where there are none; `poor`: how many means
    were omitted for fewer than `least` samples; `unbiased`: whether the readings at rest were
    subtracted from those of a turn.
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
        """The sensor of its findings."""
        return ACCELEROMETERS if self.kind == ACCELEROMETERS else GYROS

    def along(self, axis: str) -> float:
        """Cosine between an axis and the vertical; NaN where that is unknown."""
        up = self.manoeuvre.up
        return float("nan") if up is None else min(1.0, abs(float(up[tables.AXES.index(axis)])))

    def channels(self) -> Iterator[tuple[str, Array, Array]]:
        """Axis, temperatures and readings of what was recorded over a span, and is not constant."""
        for axis, values in zip(tables.AXES, self.readings.T, strict=True):
            there = np.isfinite(values)
            at, readings = self.temperature[there], values[there]
            if (
                len(np.unique(at)) >= MIN_TEMPERATURES
                and np.ptp(at) > MIN_SPAN
                and np.ptp(readings) > 0
            ):
                yield axis, at, readings


def sweeps(blocks: pd.DataFrame, plan: Sequence[Manoeuvre]) -> list[Sweep]:
    """The sweeps of a mount in the order of the plan; none where times or samples were recorded."""
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
    """Scale factor errors: readings of the gyros less those at rest at that temperature, by rate.

    Without a rest in the attitude of the turn they include the bias.
    """
    m = turn.manoeuvre
    rest = next((r for r in rests if r.kind == GYROS and _same_attitude(r.manoeuvre, m)), None)
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


def _same_attitude(rest: Manoeuvre, turn: Manoeuvre) -> bool:
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

MIN_LOG_ODDS = float(np.log(20))  # of a knee
MIN_SENSITIVITY = 0.5  # cosine or sine: of an accelerometer to its scale factor, or to a tilt


@dataclass(frozen=True)
class AxisModel:
    """The model of an axis of a sweep.

    `degree`: of its law, 0 where it has none; `p_value`: of that by noise alone, after the search;
    `p_beyond`: of the residuals of the highest degree, after the search; `knee`: if it fits
    significantly better than that.
    """

    axis: str
    curve: Curve
    degree: int
    p_value: float
    p_beyond: float
    structure: bool
    knee: Knee | None

    @property
    def varies(self) -> bool:
        """Whether it depends on the temperature."""
        return self.degree > 0 or self.structure

    @property
    def change(self) -> float:
        """From the smallest reading to the largest."""
        return float(np.ptp(self.curve.readings))

    @property
    def described_degree(self) -> int:
        """The degree of the polynomial that represents it."""
        return self.curve.highest if self.structure else self.degree


@dataclass(frozen=True)
class TemperatureDependence:
    """The channels of a sweep that depend on the temperature, at least one."""

    sweep: Sweep
    axes: Sequence[AxisModel]

    @property
    def structured(self) -> bool:
        """Whether a polynomial does not describe all of them."""
        return any(channel.structure for channel in self.axes)

    @property
    def best(self) -> AxisModel:
        """The most significant channel."""
        if self.structured:
            own = [channel for channel in self.axes if channel.structure]
            return min(own, key=lambda axis: axis.p_beyond)
        return min(self.axes, key=lambda axis: axis.p_value)

    @property
    def tilts(self) -> dict[str, float]:
        """The tilt, rad, that would change each accelerometer across the vertical as much."""
        across = {
            a.axis: float(np.nan_to_num(np.sqrt(1 - self.sweep.along(a.axis) ** 2), nan=1.0))
            for a in self.axes
        }
        return {
            a.axis: a.change / (STANDARD_GRAVITY * across[a.axis])
            for a in self.axes
            if across[a.axis] >= MIN_SENSITIVITY
        }

    @property
    def middle(self) -> float:
        """The mean temperature, whole in °C, about which polynomials are given, K."""
        mean = np.mean([channel.curve.at.mean() for channel in self.axes])
        return float(np.round(mean - ICE_POINT)) + ICE_POINT


def temperature_dependences(swept: Sequence[Sweep], level: float) -> list[TemperatureDependence]:
    """The sweeps that depend on the temperature.

    `level`: accepted probability of a law in any channel where there is none, and of a structure.
    """
    every = [
        (sweep, {axis: curve_of(at, readings) for axis, at, readings in sweep.channels()})
        for sweep in swept
    ]
    curves = [curve for _, own in every for curve in own.values()]
    searched = (sum(len(c.degrees) for c in curves), len(curves))
    dependences = [
        TemperatureDependence(
            sweep, [m for a, c in own.items() if (m := _axis_model(a, c, level, searched)).varies]
        )
        for sweep, own in every
    ]
    return [dependence for dependence in dependences if dependence.axes]


def _axis_model(axis: str, curve: Curve, level: float, searched: tuple[int, int]) -> AxisModel:
    """`searched`: the total numbers of degrees of laws and of channels that are tested."""
    laws, structures = searched
    significant = [d for d in curve.degrees if curve.p_value(range(d, d + 1)) * laws < level]
    degree = max(significant, default=0)
    beyond = min(1.0, curve.misfit_p_value() * structures)
    knee = knee_of(curve.at, curve.readings) if beyond < level else None
    if knee is not None and _odds(curve, knee) < MIN_LOG_ODDS:
        knee = None
    p_value = min(1.0, curve.p_value(range(1, degree + 1)) * laws)
    return AxisModel(axis, curve, degree, p_value, beyond, beyond < level, knee)


def _odds(curve: Curve, knee: Knee) -> float:
    """How much likelier, as a logarithm, two lines are than the polynomial of highest degree."""
    tiny = np.finfo(np.float64).tiny  # two lines may fit synthetic readings exactly
    return len(curve.at) * float(
        np.log(curve.residual_rms(curve.highest) / max(knee.residual_rms, tiny))
    )


# ---- What means at temperatures in one attitude show of the parameters: their change from T0.
#
# A level stays unknown, and what one attitude does not separate from a bias changes with it: along
# the vertical g times the scale factor, across it g times a tilt. The sigma is that of the fitted
# curve, the residuals counting as noise, and what the curve leaves beyond the scatter of
# neighbours.

TEMPERATURES = 41  # of a curve, from the coldest to the warmest
UNITS = {ACCELEROMETERS: "m/s²", SCALE: "1"}
OR_SCALE = _("or the scale factor error of this axis times gravity")
OR_TILT = _("or a tilt times gravity")
OR_SPEED = _("or an error of the table's speed")


def curve_rows(dependence: TemperatureDependence, mount: str) -> Iterator[TableRow]:
    """The change of each parameter that depends on the temperature."""
    sweep = dependence.sweep
    for model in dependence.axes:
        at = np.linspace(model.curve.at[0], model.curve.at[-1], TEMPERATURES)
        value, sigma = _changes(model, at, dependence.middle)
        for temperature, here, scatter in zip(at, value, sigma, strict=True):
            yield (
                "temperature_curves",
                {
                    "mount": mount,
                    "sensor": sweep.sensor,
                    "parameter": f"{'scale' if sweep.kind == SCALE else 'bias'}_{model.axis}",
                    "temperature": float(temperature),
                    "value": float(here),
                    "sigma": float(scatter),
                    "unit": UNITS.get(sweep.kind, "rad/s"),
                    "order": 1 if model.knee else model.described_degree,
                    "knot": model.knee.at if model.knee else None,
                    "relative_to": dependence.middle,
                    "not_separated": _not_separated(sweep, model.axis),
                },
            )


def _changes(model: AxisModel, at: Array, middle: float) -> tuple[Array, Array]:
    """The change from the middle to each temperature, and its sigma, (m,) each."""
    curve, places = model.curve, np.append(at, middle)
    if model.knee is None:
        degree = model.described_degree
        design = np.vander(curve.at - middle, degree + 1, increasing=True)
        wanted = np.vander(places - middle, degree + 1, increasing=True)
        rms = curve.residual_rms(degree)
    else:
        knee, (below, above) = model.knee.at, model.knee.slopes
        design, wanted = (
            np.column_stack(
                [
                    np.ones(len(each)),
                    np.minimum(each - knee, 0.0),
                    np.maximum(each - knee, 0.0),
                    -np.where(each < knee, below, above),  # a shift of the knee
                ]
            )
            for each in (curve.at, places)
        )
        rms = model.knee.residual_rms
    inverse = np.linalg.pinv(design.T @ design)
    change = wanted[:-1] - wanted[-1]
    values = inverse @ design.T @ curve.readings
    if model.knee is not None:
        values = np.array([0.0, *model.knee.slopes, 0.0])
    beyond = max(rms**2 - curve.noise**2, 0.0)
    variance = rms**2 * np.einsum("ti,ij,tj->t", change, inverse, change) + beyond
    return change @ values, np.sqrt(variance)


def _not_separated(sweep: Sweep, axis: str) -> str | None:
    """What else the readings of this attitude may be."""
    if sweep.kind == SCALE:
        return OR_SPEED
    if sweep.kind != ACCELEROMETERS:
        return None
    return OR_SCALE if not sweep.along(axis) < MIN_SENSITIVITY else OR_TILT
