"""Turntables and instruments by which a campaign is designed, from their files in data/."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from math import cos, radians
from pathlib import Path
from typing import Any

import numpy as np

from inertial.arrays import Array
from inertial.campaign.foreseen import Pace, stated_noise
from inertial.campaign.noise_levels import NoiseLevels
from inertial.campaign.records import Known
from inertial.physics.site import EARTH_RATE, earth_rate
from inertial.tables.code import ROOT
from inertial.tables.errors import Refusal
from inertial.tables.yaml_file import YamlFile
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND, DEGREE, DEGREE_PER_HOUR, MICRO_G, PER_ROOT_HOUR, in_si

Entry = dict[str, Any]

LATITUDE_SIGMA = radians(0.01)
LOWEST = float(np.sqrt(2 * np.log(2) / np.pi))  # of an Allan deviation, in the bias instability B
FULL_SCALE_SHARE = 0.9  # of the full scale of the gyros, which their errors must not exceed


@dataclass(frozen=True)
class Turntable:
    """An entry of data/tables.yaml.

    `ups`: (n, 3), the attitudes it sets, each by what is up; `known`: what the estimation takes as
    known at this table, SI, by quantity.
    """

    entry: Entry
    ups: Array
    known: Mapping[str, Known]

    @property
    def pace(self) -> Pace:
        """How it goes from one manoeuvre to the next."""
        return Pace(self.entry["still_s"], self.entry["change_s"])

    @property
    def rate(self) -> float:
        """Its largest rate, °/s."""
        return float(self.entry["max_rate_deg_s"])

    @property
    def angle_sigma(self) -> float:
        """Of the angle of a turn, rad."""
        return self.known["turn_angle"].scatter

    @property
    def oriented(self) -> bool:
        """Whether the azimuth of its zero mark is known."""
        return self.known["heading"].value is not None


@dataclass(frozen=True)
class Instrument:
    """An entry of data/instruments.yaml: its noise, and the largest rate of its gyros, °/s."""

    name: str
    entry: Entry
    noise: NoiseLevels
    max_rate: float


def turntable(name: str, data: Path) -> Turntable:
    """The table of this name.

    Raises
    ------
    Refusal
        where there is none, or its entry breaks the schema
    """
    file = _entries(data / "tables.yaml")
    file.check("turntables")
    entry = _entry(file, name, "TABLE")
    return Turntable(entry, _ups(entry["attitudes"]), _known(entry))


def _entries(file: Path) -> YamlFile:
    """The file of a folder of data, or where it has none that of the project."""
    return YamlFile(file if file.is_file() else ROOT / "data" / file.name)


def _known(entry: Entry) -> dict[str, Known]:
    site, heading = entry["site"], entry["heading_deg"]
    latitude = radians(site["latitude_deg"])
    up, level = earth_rate(latitude)
    return {
        "gravity": Known(site["gravity_m_s2"], site["gravity_sigma_m_s2"]),
        "earth_rate_up": Known(up, EARTH_RATE * abs(cos(latitude)) * LATITUDE_SIGMA),
        "earth_rate_level": Known(level, None),
        "heading": Known(None if heading is None else radians(heading), None),
        "position": Known(0.0, entry["position_sigma_arcsec"] * ARC_SECOND),
        "turn_angle": Known(0.0, entry["angle_sigma_arcsec"] * ARC_SECOND),
        "turn_rate": Known(0.0, entry["rate_sigma_ppm"] * 1e-6),
    }


def instrument(name: str, data: Path) -> Instrument:
    """The instrument of this name.

    Raises
    ------
    Refusal
        where there is none, or it states no noise
    """
    file = _entries(data / "instruments.yaml")
    file.check("campaign", "instrument")
    entry = _entry(file, name, "INSTRUMENT")
    accelerometer, gyro = entry.get("accelerometer", {}), entry.get("gyro", {})
    keys = (
        ("gyro", gyro, "angle_random_walk_deg_sqrt_h"),
        ("accelerometer", accelerometer, "velocity_random_walk_m_s_sqrt_h"),
    )
    for sensor, own, key in keys:
        if key not in own:
            raise file.refuse_text(
                [name, sensor],
                _("no {key}", key=key),
                _("{key}: the white noise, without which nothing can be foreseen", key=key),
                _("add it from the data sheet, or from the noise of a recording"),
            )
    hour = PER_ROOT_HOUR * DEGREE_PER_HOUR, PER_ROOT_HOUR * MICRO_G.size
    figures: dict[str, Mapping[str, float | None]] = {
        "gyro": {
            "white_noise": gyro[keys[0][2]] * DEGREE * PER_ROOT_HOUR,
            "bias_instability": in_si(gyro.get("bias_instability_deg_h"), DEGREE_PER_HOUR / LOWEST),
            "random_walk": in_si(gyro.get("rate_random_walk_deg_h_sqrt_h"), hour[0]),
        },
        "accel": {
            "white_noise": accelerometer[keys[1][2]] * PER_ROOT_HOUR,
            "bias_instability": in_si(
                accelerometer.get("bias_instability_ug"), MICRO_G.size / LOWEST
            ),
            "random_walk": in_si(accelerometer.get("acceleration_random_walk_ug_sqrt_h"), hour[1]),
        },
    }
    limit = FULL_SCALE_SHARE * gyro.get("full_scale_deg_s", np.inf)
    return Instrument(name, entry, stated_noise(figures), limit)


def _entry(file: YamlFile, name: str, key: str) -> Entry:
    if name not in file.content:
        raise Refusal(
            key,
            "",
            repr(name),
            _("an entry of {path}: {names}", path=file.path, names=", ".join(file.content)),
            _("name one: {key}={name}", key=key, name=next(iter(file.content))),
        )
    return dict(file.content[name])


def _ups(attitudes: str | list[Any]) -> Array:
    """The directions that may point up, (n, 3), unit vectors in body axes.

    Any: faces, edges and corners of a cube, of which none lies farther than 27° from the next.
    """
    if attitudes == "faces":
        return np.vstack([np.eye(3), -np.eye(3)])
    if attitudes == "any":
        every = np.array([v for v in product((-1, 0, 1), repeat=3) if any(v)], np.float64)
        return np.asarray(every / np.linalg.norm(every, axis=1)[:, None])
    return np.array([direction(each) for each in attitudes])


def direction(stated: str | list[float]) -> Array:
    """A unit vector in body axes, of a body axis with its sign or of three numbers."""
    if isinstance(stated, str):
        return np.asarray((-1.0 if stated[0] == "-" else 1.0) * np.eye(3)["xyz".index(stated[1])])
    return np.asarray(np.array(stated, np.float64) / np.linalg.norm(stated))
