"""Campaigns of known plans as tables of blocks, made without the simulated laboratory.

The readings are those of the forward model without noise: what a plan can show depends on the
motion and the noise levels alone. Instrument: 0.1 °/√h and 0.03 m/s/√h (the data sheet of the
iMAR-FSAS), positions set to 2″, earth and gravity of Wuhan, heading known.
"""

from dataclasses import dataclass, field

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.equations import Campaign
from inertial.campaign.noise_levels import NoiseLevels, effective_levels
from inertial.campaign.observations import campaign_of
from inertial.campaign.records import Known, Manoeuvre, Performed
from inertial.campaign.solution import Solution
from inertial.physics.forward import Site, Triad, predict
from inertial.physics.motion import Profile, turning
from inertial.physics.site import earth_rate
from inertial.tables import CHANNELS

ARC_SECOND = np.radians(1 / 3600)
GYRO_NOISE = np.radians(0.1) / 60  # rad/√s
ACCEL_NOISE = 0.03 / 60  # m/s/√s
LATITUDE = np.radians(30.5278)
GRAVITY = 9.7936174
BLOCK = 0.2  # s, while the table turns
AXES = dict(zip("xyz", np.eye(3), strict=True))
# Which body axis points to the mark of the table, north, when an axis is up.
MARK = {"+x": "y", "-x": "y", "+y": "-z", "-y": "z", "+z": "y", "-z": "y"}
SITE = Site(GRAVITY, *earth_rate(LATITUDE))
RNG = np.random.default_rng(5)
GYRO = Triad(np.eye(3) + RNG.normal(0, 1e-3, (3, 3)), RNG.normal(0, 2e-6, 3))
ACCELEROMETER = Triad(np.eye(3) + RNG.normal(0, 1e-3, (3, 3)), RNG.normal(0, 2e-2, 3))


def axis(name: str) -> Array:
    """A signed axis such as -z."""
    return AXES[name[-1]] * (-1.0 if name.startswith("-") else 1.0)


@dataclass
class Plan:
    """Manoeuvres one after another, and the blocks of what was recorded of them."""

    heading: bool = True
    temperature: bool = True
    clock: bool = True
    anew: bool = False  # every manoeuvre at a position that is set anew
    manoeuvres: list[Manoeuvre] = field(default_factory=list)
    rows: list[pd.DataFrame] = field(default_factory=list)
    now: float = 0.0
    places: int = 0  # set positions so far
    set_to: Array = field(default_factory=lambda: np.zeros(3))  # up of the last of them

    def rest(self, up: Array, mark: Array, seconds: float, block: float = 5.0) -> None:
        """Stand for a while."""
        name = f"{len(self.manoeuvres)}-rest"
        self._plan(name, "rest", up, mark, seconds)
        self._record(name, "rest", up, mark, np.zeros((2, round(seconds / block))), block)

    def turn(
        self, up: Array, mark: Array, about: Array, degrees: float, rate: float, acceleration: float
    ) -> None:
        """Turn from rest to rest; degrees, °/s, °/s²."""
        name = f"{len(self.manoeuvres)}-turn"
        profile = Profile(*np.radians([abs(degrees), rate, acceleration]))
        self._plan(name, "turn", up, mark, profile.seconds, about, np.radians(degrees))
        edges = np.arange(0, profile.seconds + BLOCK, BLOCK)
        angles, _ = profile.at(edges)
        self._record(
            name, "steady", up, mark, np.sign(degrees) * np.stack([angles[:-1], angles[1:]]), BLOCK,
            about,
        )  # fmt: skip

    def _plan(
        self,
        name: str,
        do: str,
        up: Array,
        mark: Array,
        seconds: float,
        about: Array | None = None,
        angle: float | None = None,
    ) -> None:
        if self.anew or not np.array_equal(up, self.set_to):
            self.places, self.set_to = self.places + 1, up
        sigma = None if angle is None else 0.1 * ARC_SECOND
        where = ("log", f"position {self.places}", "", up, mark, about, angle, sigma)
        unset = (None,) * 5
        self.manoeuvres.append(Manoeuvre(name, do, *where, None, None, seconds, "whole", *unset))

    def _record(
        self,
        name: str,
        phase: str,
        up: Array,
        mark: Array,
        angles: Array,  # (2, k) at the start and end of each block
        block: float,
        about: Array | None = None,
    ) -> None:
        first, after = angles
        time = self.now + block * (np.arange(len(first)) + 0.5)
        rate = (after - first) / block
        acceleration = np.gradient(rate, block) if len(rate) > 1 else np.zeros(1)
        motion = turning(
            up if about is None else about, up, mark, (first + after) / 2, rate, acceleration,
            time, np.full(len(first), block),
        )  # fmt: skip
        read = predict(motion, SITE, GYRO, ACCELEROMETER)
        warm = 300 + 3 * (1 - np.exp(-time / 900)) + 0.5 * np.sin(time / 400)
        self.rows.append(
            pd.DataFrame(
                {
                    "manoeuvre": name,
                    "phase": phase,
                    "log": "log",
                    "time": time if self.clock else np.nan,
                    "seconds": block,
                    "count": block * 100,
                    "missing_s": 0.0,
                    "temperature": warm if self.temperature else np.nan,
                    **dict(zip(CHANNELS, np.hstack([read.accel, read.gyro]).T, strict=True)),
                }
            )
        )
        self.now = float(time[-1]) + block / 2

    def campaign(self) -> Campaign:
        """What the equations are made of."""
        done = {
            m.name: Performed(m.name, "", angle=m.angle, seconds=m.seconds or 0.0)
            for m in self.manoeuvres
        }
        up, level = earth_rate(LATITUDE)
        known = {
            "gravity": Known(GRAVITY, 5e-5),
            "heading": Known(0.0 if self.heading else None, None),
            "earth_rate_up": Known(up, 1e-10),
            "earth_rate_level": Known(level, None),
            "position": Known(None, 2 * ARC_SECOND),
            "turn_rate": Known(None, 1e-4),
        }
        solution = Solution(GYRO, ACCELEROMETER, SITE, {})
        blocks = pd.concat(self.rows, ignore_index=True)
        return campaign_of(
            CampaignData(
                self.manoeuvres,
                done,
                blocks,
                NoiseLevels(effective_levels(self._noise())),
                known,
                shared_clock=self.clock,
                solution=solution,
            )
        )

    def _noise(self) -> pd.DataFrame:
        rows = []
        for i, m in enumerate(self.manoeuvres):
            for channel in CHANNELS:
                level = GYRO_NOISE if channel.startswith("gyro") else ACCEL_NOISE
                # The table shakes a little more in every other manoeuvre.
                shaken = 10 * level * (1 + i % 2)
                rows += [
                    (m.name, phase, channel, level, level / 50, shaken)
                    for phase in ("rest", "steady")
                ]
        names = ["manoeuvre", "phase", "channel", "white_noise", "sigma", "per_sample"]
        return pd.DataFrame(rows, columns=names)


def six_positions(plan: Plan, seconds: float = 300.0) -> Plan:
    """Each axis up and down."""
    for name in MARK:
        plan.rest(axis(name), axis(MARK[name]), seconds)
    return plan


def plan_b(times: int = 1, **kind: bool) -> Plan:
    """Six positions of five minutes, then a turn forward and one back about each axis, up."""
    plan = Plan(**kind)
    for _ in range(times):
        six_positions(plan)
        for name in ("+x", "+y", "+z"):
            for degrees in (360, -360):
                plan.turn(axis(name), axis(MARK[name]), axis(name), degrees, 10, 10)
    return plan


def plan_c(**kind: bool) -> Plan:
    """Turn and stop, in six positions: rest, turn forward and back, rest; up 6, down 12 °/s."""
    plan = Plan(**kind)
    for name in ("+z", "-z", "+x", "-x", "+y", "-y"):
        up, mark = axis(name), axis(MARK[name])
        rate = 6 if name.startswith("+") else 12
        plan.rest(up, mark, 120)
        for degrees in (360, -360):
            plan.turn(up, mark, up, degrees, rate, rate)
        plan.rest(up, mark, 120)
    return plan


def plan_d(**kind: bool) -> Plan:
    """A rate table: both ways at five rates about each axis, up, a few seconds of rest before."""
    plan = Plan(**kind)
    for name in ("+x", "+y", "+z"):
        up, mark = axis(name), axis(MARK[name])
        for rate in (10, 20, 40, 60, 80):
            for sign in (1, -1):
                plan.rest(up, mark, 3, 3)
                plan.turn(up, mark, up, sign * 360, rate, 50)
    return plan


def plan_e(**kind: bool) -> Plan:
    """A tumble in three mounts: eighteen positions, 20° apart, of 20 s, about a level axis."""
    plan = Plan(**kind)
    for about, first in (("x", "z"), ("y", "x"), ("z", "y")):
        u, v = AXES[first], np.cross(AXES[about], AXES[first])
        for angle in np.radians(np.arange(0, 360, 20)):
            plan.rest(np.cos(angle) * u + np.sin(angle) * v, AXES[about], 20, 20)
    return plan
