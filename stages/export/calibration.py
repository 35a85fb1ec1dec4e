"""A calibration as it is exported: M and bias of both triads on every mount, and their context.

    reading = M · truth + bias            truth = M⁻¹ · (reading − bias)

An element that was not determined is NaN here and null in the files, never 0 or 1.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from statistics import median

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.estimates import UNIT
from inertial.campaign.final_result import of_sensors
from inertial.campaign.records import (
    Manoeuvre,
    Part,
    Row,
    by_mount,
    parts_of,
    rows_of,
    with_mount,
)
from inertial.estimation.triad import linear_names
from inertial.tables import CHANNELS
from inertial.text.messages import _
from inertial.text.parameters import EXTENDED, JOINT, SENSOR_OF
from stages.export.examples import Example

Array = NDArray[np.float64]

PARAMETERS = linear_names()  # M − I by rows, then the bias
MAX_CONDITION = 1e6  # condition number of M; that of three good sensors is 1.01
COMPENSATED = _(
    "The campaign says that the errors were taken out of its logs already. Its "
    "parameters are what that first compensation has left over, not those of the "
    "IMU, and would be wrong for its raw readings. To export a calibration, give "
    "the raw logs."
)


@dataclass(frozen=True)
class Fitted:
    """The tables of parameters of a stage."""

    parameters: pd.DataFrame
    covariance: pd.DataFrame
    fit: pd.DataFrame
    manoeuvres: pd.DataFrame


@dataclass(frozen=True)
class Triad:
    """The estimates of three sensors of one kind on one mount.

    kind : accelerometer or gyroscope
    id_prefix : what the ids of its parameters begin with
    matrix, matrix_sigma : M, (3, 3), unit 1, NaN where not determined; row: the sensor
    bias, bias_sigma : (3,), `unit`, NaN where not determined
    ids, covariance : ids of the n parameters that are determined, and their covariance, (n, n)
    reasons : parameter → why it is not determined
    fit : the row of the fit table; none where nothing was fitted
    manoeuvres : those of the fit, and those that it leaves out
    effects : rows of the parameters of effects, where the extended result is the final one
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
    effects: Sequence[Row] = ()

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
        elements = [self.ids.index(f"{self.id_prefix}/{name}") for name in PARAMETERS[:9]]
        covariance = self.covariance[np.ix_(elements, elements)]
        return np.asarray(np.sqrt(np.diag(jacobian @ covariance @ jacobian.T)).reshape(3, 3))

    def truth(self, reading: Array) -> Array | None:
        """M⁻¹ · (reading − bias), (3,); none where an element of it is unknown."""
        inverse = self.inverse
        if inverse is None or not np.isfinite([*self.bias, *reading]).all():
            return None
        return np.asarray(inverse @ (reading - self.bias))


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


@dataclass(frozen=True)
class Calibration:
    """What is exported of a campaign.

    campaign : the row of the campaign table
    not_exported : why there is no calibration, if there is none
    noise : per channel the random walk, and its spread over the manoeuvres
    rate : measured sample rate, Hz; none without time
    temperature : K, mean, lowest and highest of the blocks; none where it is not recorded
    """

    campaign: Row
    inputs: Sequence[Row]
    made_by: Sequence[Row] = ()
    known: Sequence[Row] = ()
    noise: Sequence[Row] = ()
    rate: float | None = None
    temperature: Row | None = None
    mounts: Sequence[Mount] = ()
    not_exported: str | None = None

    def best(self, kind: str) -> tuple[str, Triad]:
        """The mount that determines most of a triad, and the triad; the first one of equals."""
        triads = [(mount.name, mount.triad(kind)) for mount in self.mounts]
        return max(triads, key=lambda named: len(named[1].ids))


def mounts_of(
    plan: list[Manoeuvre],
    fits: Mapping[str, Fitted],
    extended: Collection[tuple[str, str]],
    examples: Mapping[str, Sequence[Example]],
) -> list[Mount]:
    """The final result of every mount: the joint one, or the extended one.

    Parameters
    ----------
    fits : accelerometer, gyroscope and extension → its tables
    extended : sensor and mount of every extended result that is the final one
    examples : mount → worked examples
    """

    def triad(kind: str, mount: str) -> Triad:
        of = SENSOR_OF[kind], mount
        if of in extended:
            return _triad(
                kind, f"extension/{with_mount(kind, mount)}", EXTENDED, of, fits["extension"]
            )
        return _triad(kind, f"{kind}/{with_mount(JOINT, mount)}", JOINT, of, fits[kind])

    return [
        Mount(
            name := manoeuvres[0].mount,
            triad("accelerometer", mount),
            triad("gyroscope", mount),
            examples.get(name, ()),
        )
        for mount, manoeuvres in by_mount(plan)
    ]


def _triad(kind: str, id_prefix: str, method: str, of: tuple[str, str], fit: Fitted) -> Triad:
    """The result of a method for `of`, a sensor and its mount."""

    def own(table: pd.DataFrame) -> list[Row]:
        return [row for row in of_sensors(rows_of(table), [of]) if row["method"] == method]

    rows = {row["parameter"]: row for row in own(fit.parameters)}
    determined = [n for n in PARAMETERS if rows.get(n, {}).get("value") is not None]
    ids = [f"{id_prefix}/{name}" for name in determined]
    values, sigmas = (
        np.array([rows[n][key] if n in determined else np.nan for n in PARAMETERS], np.float64)
        for key in ("value", "sigma")
    )
    products = {
        (first, second): value
        for first, second, value in fit.covariance.itertuples(index=False)
        if first in ids and second in ids
    }
    no_result = {"reason": _("there is no result for the {kind}", kind=kind)}
    return Triad(
        kind,
        id_prefix,
        matrix=np.eye(3) + values[:9].reshape(3, 3),
        matrix_sigma=sigmas[:9].reshape(3, 3),
        bias=values[9:],
        bias_sigma=sigmas[9:],
        ids=tuple(ids),
        covariance=np.array([products[a, b] for a in ids for b in ids]).reshape(len(ids), len(ids)),
        reasons={n: rows.get(n, no_result)["reason"] for n in PARAMETERS if n not in determined},
        fit=next(iter(own(fit.fit)), None),
        manoeuvres=parts_of(own(fit.manoeuvres)),
        effects=[row for row in rows.values() if row["effect"]],
    )


def noise_of(noise: pd.DataFrame) -> list[Row]:
    """White noise by channel as random walk: median, least and most of all manoeuvres."""
    rows = rows_of(noise)
    summaries = []
    for channel in CHANNELS:
        of_channel = [row for row in rows if row["channel"] == channel]
        if of_channel:
            levels = [row["white_noise"] for row in of_channel]
            summaries.append(
                {
                    "channel": channel,
                    "density": median(levels),
                    "least": min(levels),
                    "most": max(levels),
                    "stretches": len(levels),
                    "data_sheet": of_channel[0]["data_sheet"],
                }
            )
    return summaries


def rate_of(clocks: pd.DataFrame) -> float | None:
    """The measured sample rate, Hz: the median of the logs; none where no log has time."""
    steps = [row["integration_step"] for row in rows_of(clocks)]
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
