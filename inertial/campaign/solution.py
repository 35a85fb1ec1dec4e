"""The joint result of one mount as the forward model takes it."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from inertial.arrays import Array
from inertial.campaign.records import Known, Manoeuvre, Row, rows_of
from inertial.estimation.gyroscope_equations import horizontal_axes, horizontal_names
from inertial.estimation.gyroscope_observations import TABLE, Earth, Position
from inertial.estimation.position_outlier import is_off
from inertial.estimation.scatter_and_random_walk import covering
from inertial.estimation.triad import linear_names, triad_of_errors
from inertial.physics.forward import Site, Triad
from inertial.physics.motion import level_axes
from inertial.tables import AXES
from inertial.text.parameters import BIAS, FREE, JOINT


@dataclass(frozen=True)
class Solution:
    """M and bias of both triads, the site, and the parameters of the positions.

    A triad whose bias is not determined is None. `random_walks`: of the biases of gyros and
    accelerometers, rad/s/√s and m/s²/√s. `free`: the sensors, gyro or accel, whose triad is that of
    static positions of unknown attitude. `switch_ons`: by sensor, by what the biases differ between
    switch-ons, (3,), rad/s or m/s²; `deviations`: by sensor and switch-on, the bias after it less
    that of the campaign, the same.
    """

    gyro: Triad | None
    accelerometer: Triad | None
    site: Site
    position_parameters: Mapping[tuple[str, str, int], float]  # position, quantity, component; SI
    random_walks: tuple[float, float] = (0.0, 0.0)
    free: frozenset[str] = frozenset()
    switch_ons: Mapping[str, Array | None] = field(default_factory=dict)
    deviations: Mapping[tuple[str, int], Array] = field(default_factory=dict)

    def since(self, switch_on: int) -> "Solution":
        """The same with the biases that the sensors have after a switch-on."""

        def of(sensor: str, triad: Triad | None) -> Triad | None:
            deviation = self.deviations.get((sensor, switch_on))
            if triad is None or deviation is None:
                return triad
            return replace(triad, bias=triad.bias + deviation)

        gyro, accelerometer = of("gyro", self.gyro), of("accel", self.accelerometer)
        return replace(self, gyro=gyro, accelerometer=accelerometer)

    @property
    def knows_azimuth(self) -> bool:
        """Whether the gyros tell the azimuth of the table, so that none was known."""
        return (TABLE, "horizontal", 0) in self.position_parameters

    def off_positions(self, position_sigma: float) -> frozenset[str]:
        """The positions that are off by far more than the sigma, rad, of the planned attitudes."""
        tilts: dict[str, list[float]] = {}
        for (position, quantity, _component), value in self.position_parameters.items():
            if quantity == "tilt":
                tilts.setdefault(position, []).append(value)
        sizes = {position: float(np.linalg.norm(own)) for position, own in tilts.items()}
        return frozenset(one for one, size in sizes.items() if is_off(size, position_sigma))

    def upright(self, m: Manoeuvre) -> Array:
        """The direction that points up at the start of a manoeuvre, its tilt included, (3,)."""
        assert m.up is not None  # a manoeuvre without it is not simulated
        tilt = np.zeros(3)
        for i, axis in enumerate(level_axes(m.up)):
            tilt = tilt + self.position_parameters.get((m.position, "tilt", i), 0.0) * axis
        return np.asarray(Rotation.from_rotvec(tilt).apply(m.up))

    def north(self, position: Position) -> Array:
        """The direction of the horizontal earth rate in body axes, relative to the known size.

        NaN where the azimuth follows neither from mark and heading nor from the gyros.
        """
        if position.north is not None:
            return position.north
        name, axes = horizontal_names(position)[0][1], horizontal_axes(position)
        parts = [self.position_parameters.get((name, "horizontal", i), np.nan) for i in (0, 1)]
        return np.asarray((parts[0] * axes[0] + parts[1] * axes[1]) / self.site.earth_level)


@dataclass(frozen=True)
class Estimated:
    """The tables of one stage of estimation; None where they are not read."""

    parameters: pd.DataFrame
    positions: pd.DataFrame | None = None
    fit: pd.DataFrame | None = None
    switch_on_biases: pd.DataFrame | None = None

    def position_parameters(
        self, mount: str, quantity: str, below: float
    ) -> dict[tuple[str, str, int], float]:
        """The parameters of the positions, by component, whose sigma is `below` this limit."""
        rows = [] if self.positions is None else joint_rows(self.positions, mount)
        return {
            (row["position"], quantity, row["component"]): row["value"]
            for row in rows
            if row["quantity"] == quantity and row["sigma"] < below
        }

    def deviations(self, mount: str) -> dict[int, Array]:
        """The bias after each switch-on by the joint fit, less that of the campaign, (3,)."""
        table = self.switch_on_biases
        found: dict[int, Array] = {}
        for row in [] if table is None else joint_rows(table, mount):
            bias = found.setdefault(row["switch_on"], np.zeros(len(AXES)))
            bias[AXES.index(row["axis"])] = row["value"]
        return found

    def random_walk(self, mount: str) -> float:
        """The random walk of the bias by the joint fit."""
        rows = [] if self.fit is None else joint_rows(self.fit, mount)
        return float(next((row["random_walk"] or 0.0 for row in rows), 0.0))


def solution_of(
    mount: str, known: Mapping[str, Known], accelerometer: Estimated, gyro: Estimated
) -> Solution:
    """The joint result of a mount, tilts from the accelerometers, azimuths from the gyros.

    An azimuth counts as determined where its horizontal earth rate is known to a third. Where the
    joint fit does not determine the accelerometers, positions of unknown attitude may, and then the
    gyros too, in the same axes.
    """
    up, level = _earth_rate(known, gyro, mount)
    tilts = accelerometer.position_parameters(mount, "tilt", np.inf)
    levels = gyro.position_parameters(mount, "horizontal", level / 3)
    triads: dict[str, Triad | None] = {}
    free: set[str] = set()
    for sensor, tables in (("accel", accelerometer), ("gyro", gyro)):
        triads[sensor] = triad_of(tables.parameters, mount)
        if not _whole(tables.parameters, mount) and (sensor == "accel" or "accel" in free):
            by_hand = triad_of(tables.parameters, mount, FREE)
            if by_hand is not None:
                triads[sensor] = by_hand
                free |= {sensor}
    return Solution(
        triads["gyro"],
        triads["accel"],
        Site(known["gravity"].number, up, level),
        tilts | levels,
        (gyro.random_walk(mount), accelerometer.random_walk(mount)),
        frozenset(free),
        {
            "gyro": switch_ons_of(gyro.fit, mount),
            "accel": switch_ons_of(accelerometer.fit, mount),
        },
        {
            (sensor, switch_on): bias
            for sensor, of in (("gyro", gyro), ("accel", accelerometer))
            for switch_on, bias in of.deviations(mount).items()
        },
    )


def _earth_rate(known: Mapping[str, Known], gyro: Estimated, mount: str) -> tuple[float, float]:
    """The earth's rate upwards and level, rad/s: without a latitude those of the joint fit."""
    up, level = known["earth_rate_up"], known["earth_rate_level"].number
    rows = [] if "latitude" in known or gyro.fit is None else joint_rows(gyro.fit, mount)
    found = next((row["earth_rate_up"] for row in rows), None)
    if found is None:
        return up.number, level
    return float(found), Earth(up.number, up.scatter, level).level_beside(float(found))


def joint_rows(table: pd.DataFrame, mount: str, method: str = JOINT) -> list[Row]:
    """The rows of a method of a mount, whose name is empty where there is a single one."""
    return [row for row in rows_of(table) if (row["method"], row["mount"]) == (method, mount)]


def switch_ons_of(fit: pd.DataFrame | None, mount: str) -> Array | None:
    """By what the biases differ between switch-ons by the joint fit, (3,); None: there is one."""
    for row in [] if fit is None else joint_rows(fit, mount):
        if row["switch_ons"] > 1:
            sizes = [row[f"switch_on_{axis}"] for axis in AXES]
            return covering(np.array(sizes, np.float64), row["switch_ons"])
    return None


def scatter_by_mount(fit: pd.DataFrame) -> dict[str, float]:
    """The scatter between manoeuvres by the joint fit of each mount, in the unit of the table."""
    return {r["mount"]: r["scatter"] or 0.0 for r in rows_of(fit) if r["method"] == JOINT}


def _whole(parameters: pd.DataFrame, mount: str) -> bool:
    """Whether the joint fit determines all twelve parameters."""
    values = {row["parameter"]: row["value"] for row in joint_rows(parameters, mount)}
    return all(values.get(name) is not None for name in linear_names())


def triad_of(parameters: pd.DataFrame, mount: str = "", method: str = JOINT) -> Triad | None:
    """M and bias of a method; M is that of ideal sensors where it is not determined.

    There no reading of the campaign depends on it. None where a bias is not determined.
    """
    values = {row["parameter"]: row["value"] for row in joint_rows(parameters, mount, method)}
    if any(values.get(name) is None for name in BIAS):
        return None
    return triad_of_errors([values.get(name) or 0.0 for name in linear_names()])
