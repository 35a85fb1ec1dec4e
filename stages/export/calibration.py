"""A calibration as it is exported: M and bias of both triads on every mount, and their context.

reading = M · truth + bias + effects(truth)
    truth = M⁻¹ · (reading − bias − effects(truth))

by the result that counts. An element that was not determined, or is not usable, is NaN here and
null in the files, never 0 or 1.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import exp, isfinite
from statistics import median

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.estimates import UNIT
from inertial.campaign.measurement import (
    NOTHING,
    EffectOfResult,
    SensorResult,
    measurements_of,
)
from inertial.campaign.records import (
    Manoeuvre,
    Part,
    Row,
    by_mount,
    parts_of,
    rows_of,
    share_a_clock,
    with_mount,
)
from inertial.estimation.triad import linear_names
from inertial.physics import forward as physics
from inertial.physics.forward import Sized, force_of, rate_of
from inertial.physics.motion import stretches
from inertial.tables import AXES, BODY, CHANNELS
from inertial.text.messages import _
from inertial.text.parameters import SENSOR_OF
from stages.export.examples import Example

PARAMETERS = linear_names()  # M − I by rows, then the bias
MAX_CONDITION = 1e6  # condition number of M; that of three good sensors is 1.01
INSTANT = 1e-6  # s, duration of a sample that has none
NOT_USABLE = "not_usable"
COMPENSATED = _(
    "The campaign says that the errors were taken out of its logs already. Its parameters are what "
    "that first compensation has left over, not those of the IMU, and would be wrong for its raw "
    "readings. To export a calibration, give the raw logs."
)


@dataclass(frozen=True)
class Use:
    """The use for which a filter is to be right.

    seconds : T, over which the filter integrates before something else corrects it
    rate_rms, force_rms : rad/s and m/s², of the motion about and along each axis, mean 0
    correlation : τ, s, after which the motion is another one
    """

    seconds: float
    rate_rms: float
    force_rms: float
    correlation: float

    def rms(self, kind: str) -> float:
        """The rms of what the sensors of a kind feel of the motion."""
        return self.rate_rms if kind == "gyroscope" else self.force_rms

    @property
    def moving(self) -> float:
        """Variance of the integral over T of a motion with rms 1, over T, s."""
        t, tau = self.seconds, self.correlation
        return 2 * tau * (1 - tau / t * (1 - exp(-t / tau)))


@dataclass(frozen=True)
class Fits:
    """The tables of the fits by all methods."""

    fit: pd.DataFrame
    manoeuvres: pd.DataFrame


@dataclass(frozen=True)
class Triad:
    """The result that counts of three sensors of one kind on one mount.

    kind : accelerometer or gyroscope
    id_prefix : what the ids of its parameters begin with
    matrix, matrix_sigma : M, (3, 3), unit 1, NaN where not determined; row: the sensor
    bias, bias_sigma : (3,), `unit`, NaN where not determined
    ids, covariance : ids of the n parameters that are determined, those of effects last, and their
        covariance, (n, n)
    reasons : parameter → why it is not determined
    fit : the row of the fit table; none where nothing was fitted, or several fits share the result
    manoeuvres : those of the fit, and those that it leaves out
    effects : those in the model
    verdict : row of the diagnosis; none where there is no result
    frame : of matrix and bias, body or accelerometer triad
    """

    kind: str
    id_prefix: str
    matrix: Array
    matrix_sigma: Array
    bias: Array
    bias_sigma: Array
    ids: tuple[str, ...]
    covariance: Array
    reasons: Mapping[str, str]
    fit: Row | None
    manoeuvres: Sequence[Part] = ()
    effects: Sequence[EffectOfResult] = ()
    verdict: Row | None = None
    frame: str = BODY

    @property
    def determined(self) -> int:
        """How many of the twelve parameters have a value."""
        return int(np.isfinite(self.matrix).sum() + np.isfinite(self.bias).sum())

    @property
    def unusable(self) -> str | None:
        """Why nothing of it is to be used, if so."""
        if self.verdict is None or self.verdict["verdict"] != NOT_USABLE:
            return None
        return str(self.verdict["sentence"])

    @property
    def removable(self) -> list[EffectOfResult]:
        """The effects that can be taken out of readings."""
        return [one for one in self.effects if one.effect.terms]

    @property
    def model(self) -> tuple[physics.Triad | None, list[Sized]]:
        """M and bias with the effects that can be taken out; none where M has no inverse."""
        sized = [(one.effect, one.values) for one in self.removable]
        whole = not self.no_inverse and np.isfinite(self.bias).all()
        return (physics.Triad(self.matrix, self.bias) if whole else None), sized

    @property
    def unit(self) -> str:
        """Unit of reading, truth and bias."""
        return UNIT[self.kind]

    @property
    def no_inverse(self) -> str | None:
        """Why M has no usable inverse, if it has none."""
        if not np.isfinite(self.matrix).all():
            return _("it needs all nine elements of M")
        if np.linalg.cond(self.matrix) > MAX_CONDITION:
            return _("M cannot be inverted: some sensor does not feel its axis")
        return None

    @property
    def inverse(self) -> Array | None:
        """M⁻¹, (3, 3); none where `no_inverse` says why."""
        if self.no_inverse:
            return None
        return np.asarray(np.linalg.inv(self.matrix), np.float64)

    @property
    def inverse_sigma(self) -> Array | None:
        """Standard deviations of M⁻¹, (3, 3), to first order: d(M⁻¹) = −M⁻¹ dM M⁻¹."""
        inverse = self.inverse
        if inverse is None:
            return None
        jacobian = -np.kron(inverse, inverse.T)
        covariance = self.covariance[:9, :9]  # M comes first, and is whole
        return np.asarray(np.sqrt(np.diag(jacobian @ covariance @ jacobian.T)).reshape(3, 3))


@dataclass(frozen=True)
class Mount:
    """Both triads on one mount, and readings of it as worked examples of the equation."""

    name: str
    accelerometer: Triad
    gyroscope: Triad
    examples: Sequence[Example]

    def triad(self, kind: str) -> Triad:
        """The triad of a kind: accelerometer or gyroscope."""
        return self.accelerometer if kind == "accelerometer" else self.gyroscope

    def corrected(self, example: Example) -> dict[str, Array | None]:
        """Specific force and angular rate of an example, by kind; none where one is unknown.

        The time of a mean is its middle, as if it were one sample: the equation of the file is
        that of one sample.
        """
        instant = np.array([INSTANT])
        motion = stretches(np.array([example.time]), instant, np.array([example.temperature]))
        readings = example.reading[None]
        force = force_of(readings[:, :3], *self.accelerometer.model, motion)
        rate = rate_of(readings[:, 3:], *self.gyroscope.model, motion, force)
        return {
            kind: truth[0] if np.isfinite(truth).all() else None
            for kind, truth in (("accelerometer", force), ("gyroscope", rate))
        }


@dataclass(frozen=True)
class Calibration:
    """What is exported of a campaign.

    campaign : the row of the campaign table
    not_exported : why there is no calibration, if there is none
    noise : per channel the random walk, its spread over the manoeuvres, the terms of the noise
    use : for which filters get their noise
    epoch_gps : GPS time at time 0, s; none where the logs share no such clock
    rate : measured sample rate, Hz; none without time
    temperature : K, mean, lowest and highest of the blocks; none where it is not recorded
    """

    campaign: Row
    inputs: Sequence[Row]
    use: Use
    made_by: Sequence[Row] = ()
    known: Sequence[Row] = ()
    noise: Sequence[Row] = ()
    rate: float | None = None
    temperature: Row | None = None
    epoch_gps: float | None = None
    mounts: Sequence[Mount] = ()
    not_exported: str | None = None

    def best(self, kind: str) -> tuple[str, Triad]:
        """The mount that determines most of a triad, and the triad; the first one of equals."""
        triads = [(mount.name, mount.triad(kind)) for mount in self.mounts]
        return max(triads, key=lambda named: named[1].determined)


def mounts_of(
    plan: list[Manoeuvre],
    result: pd.DataFrame,
    covariance: pd.DataFrame,
    verdicts: pd.DataFrame,
    fits: Fits,
    examples: Mapping[str, Sequence[Example]],
) -> list[Mount]:
    """The result that counts of every mount; `examples`: by mount."""
    products = {
        (first, second): value for first, second, value in covariance.itertuples(index=False)
    }
    verdict_of = {(row["mount"], row["sensor"]): row for row in rows_of(verdicts)}
    measurements = measurements_of(result)

    def triad(kind: str, mount: str) -> Triad:
        measurement = measurements.get(mount, NOTHING)
        own = measurement.accelerometer if kind == "accelerometer" else measurement.gyro
        return _triad(kind, mount, own, products, verdict_of.get((mount, SENSOR_OF[kind])), fits)

    return [
        Mount(
            name := manoeuvres[0].mount,
            triad("accelerometer", mount),
            triad("gyroscope", mount),
            examples.get(name, ()),
        )
        for mount, manoeuvres in by_mount(plan)
    ]


def _triad(
    kind: str,
    mount: str,
    result: SensorResult,
    products: Mapping[tuple[str, str], float],
    verdict: Row | None,
    fits: Fits,
) -> Triad:
    rows = result.rows
    determined = [n for n in PARAMETERS if rows.get(n, {}).get("value") is not None]
    of_effects = [row for one in result.effects for row in one.parameters.values()]
    ids = [rows[name]["id"] for name in determined]
    ids += [row["id"] for row in of_effects if row["sigma"] is not None]
    values, sigmas = (
        np.array([rows[n][key] if n in determined else np.nan for n in PARAMETERS], np.float64)
        for key in ("value", "sigma")
    )
    no_result = {"reason": _("there is no result for the {kind}", kind=kind)}
    key = [mount, result.sensor, verdict["method"] if verdict else ""]

    def own(table: pd.DataFrame) -> list[Row]:
        return [r for r in rows_of(table) if [r["mount"], r["sensor"], r["method"]] == key]

    return Triad(
        kind,
        f"diagnosis/{with_mount(kind, mount)}",
        matrix=np.eye(3) + values[:9].reshape(3, 3),
        matrix_sigma=sigmas[:9].reshape(3, 3),
        bias=values[9:],
        bias_sigma=sigmas[9:],
        ids=tuple(ids),
        covariance=np.array([products[a, b] for a in ids for b in ids]).reshape(len(ids), len(ids)),
        reasons={n: rows.get(n, no_result)["reason"] for n in PARAMETERS if n not in determined},
        fit=next(iter(own(fits.fit)), None),
        manoeuvres=parts_of(own(fits.manoeuvres)),
        effects=result.effects,
        verdict=verdict,
        frame=next((row["frame"] for row in rows.values()), BODY),
    )


def noise_of(noise: pd.DataFrame, terms: pd.DataFrame) -> list[Row]:
    """White noise by channel as random walk, and the terms of the noise by name.

    The density is that of the terms where it is detected, else the median of all manoeuvres.
    """
    rows = rows_of(noise)
    by_channel: dict[str, dict[str, Row]] = {}
    for row in rows_of(terms):
        by_channel.setdefault(row["channel"], {})[row["term"]] = row
    summaries = []
    for channel in CHANNELS:
        of_channel = [row for row in rows if row["channel"] == channel]
        if of_channel:
            levels = [row["white_noise"] for row in of_channel]
            own = by_channel.get(channel, {})
            white = own.get("white_noise", {})
            summaries.append(
                {
                    "channel": channel,
                    "density": white["value"] if white.get("detected") else median(levels),
                    "sigma": white["sigma"] if white.get("detected") else None,
                    "least": min(levels),
                    "most": max(levels),
                    "stretches": len(levels),
                    "data_sheet": of_channel[0]["data_sheet"],
                    "terms": own,
                }
            )
    return summaries


def epoch_of(clocks: pd.DataFrame) -> float | None:
    """GPS time at time 0, s, where all logs count from it; else none."""
    epochs = {row["epoch_gps"] for row in rows_of(clocks)}
    if not share_a_clock(clocks) or len(epochs) != 1:
        return None
    (epoch,) = epochs
    return None if epoch is None else float(epoch)


def sample_rate(clocks: pd.DataFrame) -> float | None:
    """The measured sample rate, Hz: the median of the logs; none where no log has time."""
    steps = [row["interval"] for row in rows_of(clocks)]
    steps = [step for step in steps if step and isfinite(step)]
    return 1 / median(steps) if steps else None


def temperature_of(blocks: pd.DataFrame) -> Row | None:
    """Mean, lowest and highest temperature of the blocks, K; none where it is not recorded."""
    recorded = blocks[blocks["temperature"].notna()]
    if recorded.empty:
        return None
    kelvin, count = recorded["temperature"].to_numpy(), recorded["count"].to_numpy()
    return {
        "mean": float(np.average(kelvin, weights=count if count.any() else None)),
        "lowest": float(kelvin.min()),
        "highest": float(kelvin.max()),
    }


# ---- The measurement equation of three sensors as text, which C and Python evaluate alike.
#
# reading_x = M_xx * w_x + M_xy * w_y + M_xz * w_z + bias_x + <effect>.<parameter> * f_x + …

TRUTH = {"accelerometer": "f", "gyroscope": "w"}  # what the three sensors feel


def added_by(effect: EffectOfResult, kind: str) -> dict[str, str]:
    """What an effect adds to the reading of each axis, by axis."""
    sensor = SENSOR_OF[kind]
    sums: dict[str, list[str]] = {}
    for term in effect.effect.terms:
        of, _unused, axis = term.channel.partition("_")
        if of == sensor and term.parameter in effect.parameters:
            factor = _qualified(term.factor, effect)
            sums.setdefault(axis, []).append(f"{effect.effect.name}.{term.parameter} * {factor}")
    return {axis: " + ".join(terms) for axis, terms in sums.items()}


def _qualified(factor: str, effect: EffectOfResult) -> str:
    """The factor with each constant under the name that it has in the file."""
    for name in effect.constants:
        factor = re.sub(rf"\b{name}\b", f"{effect.effect.name}.{name}", factor)
    return factor


def equations(kind: str, effects: list[EffectOfResult]) -> dict[str, str]:
    """The reading of each axis as a function of what is sensed, time and temperature."""
    truth = TRUTH[kind]
    added = [added_by(effect, kind) for effect in effects]
    return {
        axis: " + ".join(
            [
                *(f"M_{axis}{other} * {truth}_{other}" for other in AXES),
                f"bias_{axis}",
                *(terms[axis] for terms in added if axis in terms),
            ]
        )
        for axis in AXES
    }
