"""One mount of a campaign, as the stages between segment and diagnosis work on it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.noise_levels import NoiseLevels
from inertial.campaign.passages import Handled, with_attitudes
from inertial.campaign.rate_segments import GyroInputs, gyro_inputs
from inertial.campaign.records import (
    Clock,
    Known,
    Manoeuvre,
    Part,
    Performed,
    by_mount,
    clocks_of,
    known_of,
    manoeuvres_of,
    performed_of,
    share_a_clock,
    switch_on_times,
    with_mount,
)
from inertial.campaign.solution import Estimated, Solution, solution_of
from inertial.campaign.static_positions import StaticPosition, static_positions
from inertial.estimation.accelerometers import Reference
from inertial.estimation.gyroscope_observations import Earth
from inertial.estimation.random_walk import MeasuredDrift


@dataclass(frozen=True, eq=False)
class CampaignData:
    """What was planned and recorded on one mount, what is known, and the joint result.

    plan : the manoeuvres of the mount, in their order
    performed, clocks, known : by the name of the manoeuvre, the log, the quantity
    blocks : the table, of all mounts
    noise : the effective noise levels, on which every sigma rests
    mount : its name; empty where the campaign has a single one
    shared_clock : whether times of different logs are comparable
    switched_on : s, when the IMU was switched on again, by `switch_on` of manoeuvres
    solution : None until there is one
    by_hand : the positions of unknown attitude, where these give the solution
    """

    plan: Sequence[Manoeuvre]
    performed: Mapping[str, Performed]
    blocks: pd.DataFrame
    noise: NoiseLevels
    known: Mapping[str, Known]
    mount: str = ""
    clocks: Mapping[str, Clock] = field(default_factory=dict)
    shared_clock: bool = False
    solution: Solution | None = None
    by_hand: Handled | None = None
    switched_on: Mapping[int, float] = field(default_factory=dict)

    def named(self, name: str) -> str:
        """A method or an effect as identifiers call it, with the mount where there are several."""
        return with_mount(name, self.mount)

    @property
    def gravity(self) -> Known:
        """Gravity at the site, m/s²."""
        return self.known["gravity"]

    @property
    def heading(self) -> float | None:
        """The azimuth of the table's zero mark, clockwise from north, rad; None if unknown."""
        return self.known["heading"].value

    @property
    def without_heading(self) -> "CampaignData":
        """The same as if no heading were stated."""
        return replace(self, known={**self.known, "heading": Known(None, None)})

    @property
    def position_sigma(self) -> float:
        """Sigma of the attitude of a set position, rad."""
        return self.known["position"].scatter

    @property
    def reference(self) -> Reference:
        """What the static positions of the accelerometers are compared with."""
        known = (self.gravity.number, self.gravity.scatter, self.position_sigma)
        if self.solution is None:
            return Reference(*known)
        return Reference(*known, free=self.solution.off_positions(self.position_sigma))

    @property
    def rate_sigma(self) -> float:
        """Relative sigma of the table's rate."""
        return self.known["turn_rate"].scatter

    @property
    def earth(self) -> Earth:
        """The components of the earth's rate at the site, rad/s."""
        up = self.known["earth_rate_up"]
        return Earth(up.number, up.scatter, self.known["earth_rate_level"].number)

    def drift(self, sensor: str) -> MeasuredDrift:
        """The drift of the biases of a sensor, `gyro` or `accel`, that is known before a fit."""
        switched = None if self.solution is None else self.solution.switch_ons.get(sensor)
        return replace(self.noise.drift(sensor), switch_on=switched)

    @property
    def course(self) -> tuple[Array, Array]:
        """Time, s, and temperature, K, of the blocks, (k,) each."""
        time, warm = (self.blocks[name].to_numpy(np.float64) for name in ("time", "temperature"))
        return time, warm

    @property
    def result(self) -> Solution:
        """The joint result of stages that run after the estimation."""
        assert self.solution is not None
        return self.solution

    @cached_property
    def accelerometer_positions(self) -> tuple[list[StaticPosition], list[Part]]:
        """The static positions with readings of accelerometers; those left out, with the reason."""
        return static_positions(self, "accel")

    @cached_property
    def gyro_positions(self) -> tuple[list[StaticPosition], list[Part]]:
        """The same of the gyros."""
        return static_positions(self, "gyro")

    @cached_property
    def gyro_inputs(self) -> GyroInputs:
        """Static positions and rate segments as the equations of the gyros take them."""
        return gyro_inputs(self)


@dataclass(frozen=True, eq=False)
class CampaignTables:
    """The tables of a campaign, as stages name them; None where they are not read."""

    manoeuvres: pd.DataFrame
    performed: pd.DataFrame
    blocks: pd.DataFrame
    levels: pd.DataFrame
    known: pd.DataFrame
    clocks: pd.DataFrame | None = None
    accelerometer_parameters: pd.DataFrame | None = None
    accelerometer_positions: pd.DataFrame | None = None
    accelerometer_fit: pd.DataFrame | None = None
    accelerometer_switch_ons: pd.DataFrame | None = None
    gyroscope_parameters: pd.DataFrame | None = None
    gyroscope_positions: pd.DataFrame | None = None
    gyroscope_fit: pd.DataFrame | None = None
    gyroscope_switch_ons: pd.DataFrame | None = None

    @cached_property
    def given(self) -> dict[str, Known]:
        """What is known, by quantity."""
        return known_of(self.known)

    def solution(self, mount: str) -> Solution | None:
        """The joint result of a mount; None where there are no parameters."""
        if self.accelerometer_parameters is None or self.gyroscope_parameters is None:
            return None
        accelerometer = Estimated(
            self.accelerometer_parameters,
            self.accelerometer_positions,
            self.accelerometer_fit,
            self.accelerometer_switch_ons,
        )
        gyro = Estimated(
            self.gyroscope_parameters,
            self.gyroscope_positions,
            self.gyroscope_fit,
            self.gyroscope_switch_ons,
        )
        return solution_of(mount, self.given, accelerometer, gyro)


def campaigns_of(campaign_tables: CampaignTables) -> list[CampaignData]:
    """The mounts of a campaign from its tables, with a solution where there are parameters.

    Each mount has parameters of its own, for its mounting rotation is one of them.
    """
    tables = campaign_tables
    done, noise = performed_of(tables.performed), NoiseLevels(tables.levels)
    clocks = {} if tables.clocks is None else clocks_of(tables.clocks)
    shared = tables.clocks is not None and share_a_clock(tables.clocks)
    shared = shared and _time_goes_on(tables.blocks)
    result, whole = [], manoeuvres_of(tables.manoeuvres)
    blocks = _since_first_sample(tables.blocks, clocks)
    switched_on = switch_on_times(whole, clocks, blocks) if shared else {}
    for mount, plan in by_mount(whole):
        data = CampaignData(
            plan,
            done,
            blocks,
            noise,
            tables.given,
            mount,
            clocks,
            shared,
            solution := tables.solution(mount),
            switched_on=switched_on,
        )
        if solution is not None and solution.knows_azimuth:  # whatever heading is stated
            data = data.without_heading
        if solution is not None and solution.free and solution.accelerometer is not None:
            data = with_attitudes(data, solution.accelerometer)
        result.append(data)
    return result


def _time_goes_on(blocks: pd.DataFrame) -> bool:
    """Whether no block is before that which was recorded before it, in any log."""
    by_log = blocks.sort_values("from_record", kind="stable").groupby("log", sort=False)["time"]
    return not bool((by_log.diff() < 0).any())


def _since_first_sample(blocks: pd.DataFrame, clocks: Mapping[str, Clock]) -> pd.DataFrame:
    """Blocks with times since the first sample of all logs, where the logs share a clock."""
    offsets = {log: clock.offset for log, clock in clocks.items()}
    if not any(offsets.values()):
        return blocks
    return blocks.assign(time=blocks["time"] + blocks["log"].map(offsets))


# How a stage takes the mounts: `gathers` of its Stage.
MOUNTS: Mapping[str, Callable[..., Any]] = {
    "campaign_tables": CampaignTables,
    "mounts": campaigns_of,
}
