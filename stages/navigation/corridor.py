"""How large an error of navigation with the result is expected, and what causes it.

Errors of the corrected readings are, per parameter, the change of the correction with its value, at
the readings themselves: so M, bias and effects of every kind are one case. They grow as
`inertial.physics.strapdown` says, the alignment with the same errors before them, so that what
it absorbs is no error: of an accelerometer's bias at rest remains its upright part.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.linalg import block_diag

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.measurement import Measurement, measurement_of
from inertial.campaign.records import Row
from inertial.estimation.noise_model import FLOOR_VARIANCE
from inertial.physics.motion import stretches
from inertial.physics.strapdown import (
    ATTITUDE,
    POSITION,
    VELOCITY,
    Growth,
    Start,
    of_alignment,
)
from inertial.sensors import SENSORS
from inertial.tables import ACCEL, GYRO
from inertial.text.parameters import BIAS, PARTS

Source = tuple[str, str]  # family and source, as in the table of shares

QUANTITIES = {"attitude": ATTITUDE, "velocity": VELOCITY, "position": POSITION}
NOT_PARAMETERS = ("noise", "earth_rate", "table")  # families
DRIFT, AZIMUTH, ANGLE = ("noise", "drift"), ("earth_rate", "azimuth"), ("table", "angle")
WHITE = ("noise", "white_noise")


@dataclass(frozen=True)
class Uncertain:
    """The result of one mount with its covariance (p, p), over the parameters that have a sigma.

    `shifted`: the measurement equation with each of them one sigma larger.
    """

    measurement: Measurement
    shifted: Sequence[Measurement]
    sources: Sequence[Source]
    covariance: Array

    @property
    def sigma(self) -> Array:
        """Of each parameter, (p,)."""
        return np.sqrt(np.diagonal(self.covariance))

    def slopes(self, recorded: Array, time: Array, seconds: Array, temperature: Array) -> Array:
        """Change of the corrected rates and forces by one sigma of each parameter, (n, 6, p).

        Parameters
        ----------
        recorded : (n, 6), readings, forces first; time, seconds, temperature : (n,), of them
        """
        motion = stretches(time, seconds, temperature)

        def corrected(measurement: Measurement) -> Array:
            force = measurement.force(recorded[:, :3], motion)
            return np.hstack([measurement.rate(recorded[:, 3:], motion, force), force])

        plain = corrected(self.measurement)
        return np.stack([corrected(each) - plain for each in self.shifted], axis=-1)

    @property
    def correlation(self) -> Array:
        """The covariance in units of sigma, (p, p)."""
        return self.covariance / np.outer(self.sigma, self.sigma)


def uncertain(
    rows: Sequence[Row],
    covariance: pd.DataFrame,
    along: Callable[[Measurement], Measurement],
    switch_ons: Mapping[str, Array | None],
) -> Uncertain | None:
    """The result of a mount by its rows; none where M and bias of a sensor are not determined.

    along : puts a measurement into the campaign's course of time and temperature
    switch_ons : by sensor, by what biases differ between switch-ons, (3,), none where that is not
        known; navigation has those of another one than the result
    """
    measurement = along(measurement_of(rows))
    if measurement.accelerometer.triad is None or measurement.gyro.triad is None:
        return None
    free = [row for row in rows if row["sigma"] is not None and row["sigma"] > 0]
    ids = [row["id"] for row in free]
    own = covariance[covariance["first"].isin(ids) & covariance["second"].isin(ids)]
    square = own.pivot(index="first", columns="second", values="covariance")
    matrix = square.reindex(index=ids, columns=ids).to_numpy(np.float64, copy=True)
    matrix = np.nan_to_num(matrix)
    # A row of the covariance that is missing leaves the sigma that its parameter has.
    diagonal = np.diagonal(matrix).copy()
    stated = np.array([row["sigma"] ** 2 for row in free])
    others = np.array([_between_switch_ons(row, switch_ons) ** 2 for row in free])
    np.fill_diagonal(matrix, np.where(diagonal > 0, diagonal, stated) + others)
    sigma = np.sqrt(np.diagonal(matrix))
    shifted = [
        along(
            measurement_of(
                [row | {"value": row["value"] + s} if row is one else row for row in rows]
            )
        )
        for one, s in zip(free, sigma, strict=True)
    ]
    return Uncertain(measurement, shifted, [source_of(row) for row in free], matrix)


def _between_switch_ons(row: Row, sizes: Mapping[str, Array | None]) -> float:
    """By what a parameter differs from one switch-on to the next; 0 but for a bias."""
    own = sizes.get(row["sensor"])
    known = own is not None and row["effect"] is None and row["parameter"] in BIAS
    return float(own[BIAS.index(row["parameter"])]) if own is not None and known else 0.0


def source_of(row: Row) -> Source:
    """Family and name of a parameter."""
    kind = row["effect"] or PARTS[row["parameter"]].kind
    return f"{row['sensor']} {kind}", row["parameter"]


@dataclass(frozen=True)
class Corridor:
    """The expected errors after some times, k of them.

    `responses`: (k, 9, c), by each of c causes; `covariance`: of the causes, (c, c); `noise`:
    (k, 9, 9), what the noise of the readings adds, by its source.
    """

    sources: Sequence[Source]
    responses: Array
    covariance: Array
    noise: Mapping[Source, Array]

    def covariances(self, *, parameters_alone: bool = False) -> Array:
        """Of attitude, velocity and position errors, (k, 9, 9)."""
        x = self.responses
        if parameters_alone:
            own = np.array([family not in NOT_PARAMETERS for family, _name in self.sources])
            x = x * own
        by_causes = x @ self.covariance @ x.transpose(0, 2, 1)
        return by_causes if parameters_alone else by_causes + sum(self.noise.values())

    def shares(self, quantity: str) -> dict[Source, Array]:
        """What each source contributes to the variance of an error, (k,); they add up to it."""
        rows = QUANTITIES[quantity]
        x = self.responses[:, rows]
        each = np.einsum("krc,krc->kc", x, x @ self.covariance)
        result: dict[Source, Array] = {}
        for i, source in enumerate(self.sources):
            result[source] = result.get(source, np.zeros(len(x))) + each[:, i]
        for source, own in self.noise.items():
            added = np.trace(own[:, rows, rows], axis1=1, axis2=2)
            result[source] = result.get(source, np.zeros(len(x))) + added
        return result


@dataclass(frozen=True)
class NavigatedStretch:
    """What is navigated: readings in n steps, or one that stands for all of them.

    `at_rest`, `moving`: (1, 6) and (n, 6), recorded, forces first; `time`, s, `temperature`, K: of
    the steps, (n,); `attitude`: (n, 3, 3), case to the axes of the start; `alignment`, `step`: s;
    `azimuth`: plan, gyros or unknown; `angle_error`: (3,), rad, sigma of the angle of a turn along
    its axis, axes of the start.
    """

    manoeuvre: str
    at_rest: Array
    moving: Array
    time: Array
    temperature: Array
    attitude: Array
    start: Start
    alignment: float
    step: float
    azimuth: str
    angle_error: Array


def white_of(data: CampaignData, measurement: Measurement, manoeuvre: str) -> Array:
    """Covariance of the white noise of corrected rates and forces, (6, 6), per √s."""
    level = data.noise.of(manoeuvre, "rest", [*GYRO, *ACCEL])
    return _corrected(measurement, level**2)


def _corrected(measurement: Measurement, variance: Array) -> Array:
    """The covariance of corrected readings by the variances of six readings, rates first."""
    gyro, accelerometer = measurement.gyro.triad, measurement.accelerometer.triad
    assert gyro is not None and accelerometer is not None  # else there is no result
    inverse = block_diag(np.linalg.inv(gyro.matrix), np.linalg.inv(accelerometer.matrix))
    return np.asarray(inverse @ np.diag(variance) @ inverse.T)


def corridor(
    data: CampaignData, result: Uncertain, stretch: NavigatedStretch, after: Sequence[int]
) -> Corridor:
    """The errors that are expected after some of its steps, (k,) ascending.

    A bias instability enters as the random walk of the same Allan deviation at the longest time.
    """
    gravity, earth, start = data.gravity.number, stretch.start.earth, stretch.start.attitude
    growth = Growth(gravity, earth, stretch.step)
    seconds = np.full(len(stretch.time), stretch.step)
    middle, temperature = (np.array([np.mean(x)]) for x in (stretch.time, stretch.temperature))
    first = result.slopes(stretch.at_rest, middle, seconds[:1], temperature)[0]
    white = white_of(data, result.measurement, stretch.manoeuvre)
    factor = np.linalg.cholesky(white / stretch.alignment)
    axes = np.kron(np.eye(2), start)
    compass = stretch.azimuth == "gyros"
    at_rest = np.hstack([axes @ first, axes @ factor])
    sources = [*result.sources, *([WHITE] * 6)]
    tilt = of_alignment(at_rest[3:], at_rest[:3], gravity, earth, compass=compass)
    turn = np.kron(np.eye(2), stretch.attitude)
    errors = turn @ result.slopes(stretch.moving, stretch.time, seconds, stretch.temperature)
    errors = np.concatenate([errors, np.zeros((len(errors), 6, 6))], axis=-1)
    if stretch.azimuth == "unknown":
        level = np.zeros((len(errors), 6, 2))
        level[:, 0, 0] = level[:, 1, 1] = data.earth.level / np.sqrt(2)
        errors, tilt = np.concatenate([errors, level], axis=-1), np.hstack([tilt, np.zeros((3, 2))])
        sources += [AZIMUTH] * 2
    initial = np.vstack([tilt, np.zeros((6, tilt.shape[1]))])
    responses = growth.of(errors, initial, after)
    responses[:, ATTITUDE] -= tilt  # what it drifts by
    angle = np.zeros((len(after), 9, 1))
    angle[:, ATTITUDE, 0] = stretch.angle_error
    responses = np.concatenate([responses, angle], axis=-1)
    others = np.eye(responses.shape[-1] - len(result.sources))
    drifts = [data.noise.drift(sensor) for sensor in SENSORS]
    instability, walks = (
        np.concatenate([getattr(d, name) for d in drifts]) for name in ("instability", "walk")
    )
    longest = max(after) * stretch.step
    walk = _corrected(result.measurement, walks**2 + 3 * FLOOR_VARIANCE * instability**2 / longest)
    none = np.zeros((6, 6))
    noise = {WHITE: growth.of_noise(stretch.attitude, white, none, after)}
    if walk.any():
        noise[DRIFT] = growth.of_noise(stretch.attitude, none, walk, after)
    whole = block_diag(result.correlation, others)
    return Corridor([*sources, ANGLE], responses, whole, noise)
