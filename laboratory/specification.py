"""Specification of a simulation: data/simulated/<campaign>.yaml, checked, in SI and radians."""

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass
from functools import cached_property
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from laboratory.arrays import Array
from laboratory.chance import Chance
from laboratory.checking import check
from laboratory.effects import EFFECTS, NOISE
from laboratory.effects.effect import Effect
from laboratory.encoder import Encoder
from laboratory.errors import Complaint, SpecificationError
from laboratory.faults import FAULTS
from laboratory.faults.fault import Fault
from laboratory.feasibility import impossible
from laboratory.gps_time import NANOSECONDS, gps_nanoseconds
from laboratory.layout import Handling, length, logs_of
from laboratory.manoeuvre import Manoeuvre, PlanError
from laboratory.misstatement import misstated, unknown_manoeuvres
from laboratory.plan import expanded_plan
from laboratory.rawimu import Samples
from laboratory.receiver import Receiver
from laboratory.records import Records
from laboratory.rehearsal import rehearse
from laboratory.rotation import rotation_of
from laboratory.sensor import Sensors, Triad
from laboratory.site import Site, normal_gravity
from laboratory.temperature import Temperature
from laboratory.units import ARCSECOND, DEGREE, MILLIRADIAN


@dataclass(frozen=True)
class Specification:
    """A checked specification; make one with `read` or `specify`."""

    source: str  # the file it comes from, for messages
    _document: dict[str, Any]

    @property
    def document(self) -> dict[str, Any]:
        """A copy of the document, to vary and to `specify` again."""
        return deepcopy(self._document)

    @property
    def campaign(self) -> dict[str, Any]:
        """The campaign file that is written."""
        campaign: dict[str, Any] = {**self.document["campaign"], "simulated": True}
        if self.receiver.format is not None:
            campaign["instrument"] = {**campaign["instrument"], "format": self.receiver.format}
        return misstated(campaign, self.document.get("misstated", {}))

    @cached_property
    def manoeuvres(self) -> list[Manoeuvre]:
        return expanded_plan(self._document["campaign"], self._document["handling"]["still_s"])

    @cached_property
    def handling(self) -> Handling:
        """How positions are changed within a log, in true time."""
        written = self._document["handling"]
        step = written.get("step", {"rate_deg_s": 1.0, "accel_deg_s2": 1.0})
        clock_ratio = prod(effect.clock_ratio() for effect in self.effects().values())
        return Handling(
            self.receiver.interval * clock_ratio,
            float(written.get("change_s", 0.0)),
            step["rate_deg_s"] * DEGREE,
            step["accel_deg_s2"] * DEGREE,
        )

    @property
    def start(self) -> int:
        """GPS time of the campaign's first sample, ns."""
        written = self._document["start"]
        return gps_nanoseconds(written["gps_week"], written["gps_second"])

    @property
    def pause(self) -> int:
        """From the last sample of a log to the first of the next, ns."""
        return round(float(self._document["start"]["pause_s"]) * NANOSECONDS)

    @cached_property
    def receiver(self) -> Receiver:
        return Receiver.specified(self._document["receiver"], self.encoder is not None)

    @property
    def encoder(self) -> Encoder | None:
        """The encoder of the table, where its angle is recorded."""
        return Encoder.specified(self._document.get("encoder"))

    @property
    def sensors(self) -> Sensors:
        accelerometer = self._document["truth"]["accelerometer"]
        gyro = self._document["truth"]["gyro"]
        return Sensors(
            Triad(np.array(accelerometer["matrix"], float), np.array(accelerometer["bias_m_s2"])),
            Triad(np.array(gyro["matrix"], float), np.array(gyro["bias_rad_s"])),
        )

    @property
    def mountings(self) -> dict[str, Array]:
        """By mount, the matrix from the axes of the case to those that the plan names, (3, 3)."""
        mounts = self._document["truth"].get("mounts", {})
        return {
            name: rotation_of(np.array(mount["rotation_mrad"], float) * MILLIRADIAN)
            for name, mount in mounts.items()
        }

    @property
    def temperature(self) -> Temperature:
        """The course of the temperature; constant where it is not specified."""
        written = self._document.get("temperature", {"start_deg_c": 20.0})
        return Temperature.specified(written)

    @property
    def site(self) -> Site:
        """The true site: from `truth`, else from the campaign, else normal gravity."""
        site, truth = self._document["campaign"]["site"], self._document["truth"]
        latitude = truth.get("latitude_deg", site.get("latitude_deg")) * DEGREE
        gravity = truth.get("gravity_m_s2", site.get("gravity_m_s2"))
        if gravity is None:
            gravity = normal_gravity(latitude, site.get("height_m", 0.0))
        stated = self._document["campaign"]["table"].get("heading_deg")
        heading = truth.get("heading_deg", stated)
        return Site(latitude, gravity, None if heading is None else heading * DEGREE)

    @property
    def position_sigma(self) -> float:
        """Standard deviation of both table_tilt of a position, rad."""
        return float(self._document["campaign"]["table"]["position_sigma_arcsec"]) * ARCSECOND

    @property
    def tilted_axis(self) -> bool:
        """Whether the error of a position tilts the axis of the table with the case."""
        return bool(self._document["truth"].get("tilted") == "axis")

    @property
    def chance(self) -> Chance:
        return Chance(self._document["seed"])

    def effects(self) -> dict[str, Effect]:
        """Noise and hidden effects by name, new objects at every call: some have a state."""
        hidden = self._document.get("effects", {})
        cycles = self.power_cycles
        if any(cycles):
            begin_anew = ("turn_on_bias", "gyro_warm_up", "accel_warm_up")
            of_runs = {name: {"cycles": cycles} for name in begin_anew if name in hidden}
            hidden = {**hidden, **{name: hidden[name] | of for name, of in of_runs.items()}}
        return {
            **{
                name: specified(hidden[name])
                for name, specified in EFFECTS.items()
                if name in hidden
            },
            **{name: specified(self._document["noise"]) for name, specified in NOISE.items()},
        }

    @property
    def power_cycles(self) -> list[bool]:
        """For each log in its order, whether the IMU is switched off and on before it."""
        campaign = self._document["campaign"]
        begins: dict[str, bool] = {}
        for written in campaign["plan"]:
            log = written.get("log", campaign.get("log"))
            begins.setdefault(log, bool(written.get("power_cycle", False)))
        return list(begins.values())

    @property
    def faults(self) -> list[Fault]:
        """Faults in the order in which they are applied."""
        return [
            FAULTS[name].specified(parameters)
            for fault in self._document.get("faults", [])
            for name, parameters in fault.items()
        ]

    @property
    def empty_logs(self) -> dict[str, Records]:
        """The logs in their full length, before any fault, filled with zeros."""
        logs = {}
        for log, manoeuvres in logs_of(self.manoeuvres).items():
            zeros = np.zeros((length(manoeuvres, self.handling), 3), dtype=np.int64)
            samples = Samples(zeros[:, 0], zeros, zeros)
            logs[log] = self.receiver.records(samples, np.zeros(len(zeros)), None)
        return logs


def read(path: Path | str) -> Specification:
    """The specification in a file; SpecificationError where it is wrong."""
    path = Path(path)
    try:
        document = YAML(typ="safe", pure=True).load(path)
    except (OSError, UnicodeDecodeError, YAMLError) as error:
        found = " ".join(str(error).split())
        raise SpecificationError(str(path), Complaint("the file", found, "YAML 1.2")) from error
    return specify(document, str(path))


def specify(document: Mapping[str, Any], source: str = "specification") -> Specification:
    """A specification from the content of such a file; `source` is its name in messages."""
    check(document, source)
    specification = Specification(source, deepcopy(dict(document)))
    try:
        complaints = [
            *impossible(document, specification.manoeuvres, [*specification.effects().values()]),
            *unknown_manoeuvres(document["campaign"], document.get("misstated", {})),
            *rehearse(specification.faults, specification.empty_logs),
        ]
    except PlanError as error:
        complaints = [error.complaint]
    if complaints:
        raise SpecificationError(source, *complaints)
    return specification
