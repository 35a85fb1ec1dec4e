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

from inertial.campaign.estimates import UNIT, by_mount
from inertial.campaign.records import Manoeuvre, Row, rows_of
from inertial.estimation.triad import linear_names
from inertial.tables import CHANNELS
from stages.exporting.worked import Worked

Array = NDArray[np.float64]

NAMES = linear_names()  # M − I by rows, then the bias
WORST = 1e6  # condition number of M; that of three good sensors is 1.01
COMPENSATED = (
    "The campaign says that the errors were taken out of its logs already. Its parameters are what"
    " that first compensation has left over, not those of the IMU, and would be wrong for its raw"
    " readings. To export a calibration, give the raw logs."
)


@dataclass(frozen=True)
class Sensors:
    """Three sensors of one kind on one mount: what was found of them.

    kind : accelerometer or gyroscope
    matrix, matrix_sigma : M, (3, 3), unit 1, NaN where not determined; row: the sensor
    bias, bias_sigma : (3,), `unit`, NaN where not determined
    stem : what the ids of its parameters begin with: kind/method, or that of the extended fit
    names, covariance : ids of the n numbers that are determined, and their covariance, (n, n)
    reasons : parameter → why it is not determined
    fit : the row of the fit table; none where nothing was fitted
    effects : rows of the parameters of effects, where the extended fit counts
    """

    kind: str
    stem: str
    matrix: Array
    matrix_sigma: Array
    bias: Array
    bias_sigma: Array
    names: tuple[str, ...]
    covariance: Array
    reasons: Mapping[str, str]
    fit: Row | None
    effects: Sequence[Row] = ()

    @property
    def unit(self) -> str:
        """Unit of reading, truth and bias."""
        return UNIT[self.kind]

    @property
    def no_inverse(self) -> str | None:
        """Why M has no inverse that is of use, if it has none."""
        if not np.isfinite(self.matrix).all():
            return "it needs all nine elements of M"
        if np.linalg.cond(self.matrix) > WORST:
            return "M cannot be inverted: some sensor does not feel its axis"
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
        own = self._covariance_of(NAMES[:9])
        return np.asarray(np.sqrt(np.diag(jacobian @ own @ jacobian.T)).reshape(3, 3))

    def truth(self, reading: Array) -> Array | None:
        """What was felt where `reading` (3,) was read; none where that cannot be said."""
        inverse = self.inverse
        if inverse is None or not np.isfinite([*self.bias, *reading]).all():
            return None
        return np.asarray(inverse @ (reading - self.bias))

    def _covariance_of(self, names: Sequence[str]) -> Array:
        index = [self.names.index(f"{self.stem}/{name}") for name in names]
        return self.covariance[np.ix_(index, index)]


@dataclass(frozen=True)
class Mount:
    """Both triads as they were found on one mount, and readings of it to try the equation on."""

    name: str
    accelerometer: Sensors
    gyroscope: Sensors
    worked: Sequence[Worked]


@dataclass(frozen=True)
class Calibration:
    """What is exported of a campaign; `nothing` says why there is nothing.

    about : the row of the campaign table
    noise : per channel the random walk, and its spread over the manoeuvres
    rate : measured sample rate, Hz; none without time
    temperature : K, mean, lowest and highest of the blocks; none where it is not recorded
    """

    about: Row
    inputs: Sequence[Row]
    known: Sequence[Row]
    noise: Sequence[Row]
    rate: float | None
    temperature: Row | None
    mounts: Sequence[Mount]
    made_by: Sequence[Row]
    nothing: str | None = None

    def best(self, kind: str) -> tuple[str, Sensors]:
        """The mount that determines most of a triad, and the triad; the first one of equals."""
        each = [(mount.name, _of(mount, kind)) for mount in self.mounts]
        return max(each, key=lambda named: len(named[1].names))


def _of(mount: Mount, kind: str) -> Sensors:
    return mount.accelerometer if kind == "accelerometer" else mount.gyroscope


def mounts_of(
    plan: list[Manoeuvre],
    tables: Mapping[str, tuple[pd.DataFrame, pd.DataFrame, pd.DataFrame]],
    extended: Collection[str],
    worked: Mapping[str, Sequence[Worked]],
) -> list[Mount]:
    """The result of every mount that counts: the joint one, or the extended one.

    Parameters
    ----------
    tables : accelerometer, gyroscope and extension → parameters, covariance, fit
    extended : methods of the extension that count
    worked : mount → readings
    """

    def sensors(kind: str, suffix: str) -> Sensors:
        if f"{kind}{suffix}" in extended:
            return _sensors(kind, "extension", f"{kind}{suffix}", *tables["extension"])
        return _sensors(kind, kind, f"joint{suffix}", *tables[kind])

    return [
        Mount(
            own[0].mount,
            sensors("accelerometer", suffix),
            sensors("gyroscope", suffix),
            worked.get(own[0].mount, ()),
        )
        for suffix, own in by_mount(plan)
    ]


def _sensors(
    kind: str,
    stage: str,
    method: str,
    parameters: pd.DataFrame,
    covariance: pd.DataFrame,
    fit: pd.DataFrame,
) -> Sensors:
    rows = {row["parameter"]: row for row in rows_of(parameters) if row["method"] == method}
    found = [name for name in NAMES if rows.get(name, {}).get("value") is not None]
    ids = [f"{stage}/{method}/{name}" for name in found]
    values = np.array([rows[n]["value"] if n in found else np.nan for n in NAMES], np.float64)
    sigmas = np.array([rows[n]["sigma"] if n in found else np.nan for n in NAMES], np.float64)
    product = {
        (first, second): value
        for first, second, value in covariance.itertuples(index=False)
        if first in ids and second in ids
    }
    nothing = {"reason": f"there is no result for the {kind}"}
    return Sensors(
        kind,
        f"{stage}/{method}",
        matrix=np.eye(3) + values[:9].reshape(3, 3),
        matrix_sigma=sigmas[:9].reshape(3, 3),
        bias=values[9:],
        bias_sigma=sigmas[9:],
        names=tuple(ids),
        covariance=np.array([product[a, b] for a in ids for b in ids]).reshape(len(ids), len(ids)),
        reasons={n: rows.get(n, nothing)["reason"] for n in NAMES if n not in found},
        fit=next((row for row in rows_of(fit) if row["method"] == method), None),
        effects=[row for name, row in rows.items() if "." in name],
    )


def noise_of(noise: pd.DataFrame) -> list[Row]:
    """White noise by channel as random walk: median, least and most of all manoeuvres."""
    rows = rows_of(noise)
    told = []
    for channel in CHANNELS:
        own = [row for row in rows if row["channel"] == channel]
        if own:
            levels = [row["white_noise"] for row in own]
            told.append(
                {
                    "channel": channel,
                    "density": median(levels),
                    "least": min(levels),
                    "most": max(levels),
                    "stretches": len(levels),
                    "data_sheet": own[0]["data_sheet"],
                }
            )
    return told


def rate_of(clocks: pd.DataFrame) -> float | None:
    """The measured sample rate, Hz: the median of the logs; none where no log has time."""
    steps = [row["step"] for row in rows_of(clocks) if row["step"] and isfinite(row["step"])]
    return 1 / median(steps) if steps else None


def temperature_of(blocks: pd.DataFrame) -> Row | None:
    """Mean, lowest and highest temperature of the blocks, K; none where it is not recorded."""
    own = blocks[blocks["temperature"].notna()]
    if own.empty:
        return None
    degrees, count = own["temperature"].to_numpy(), own["count"].to_numpy()
    return {
        "mean": float(np.average(degrees, weights=count if count.any() else None)),
        "lowest": float(degrees.min()),
        "highest": float(degrees.max()),
    }
