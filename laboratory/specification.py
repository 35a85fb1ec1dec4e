"""What is to be simulated: a file data/simulated/<campaign>.yaml, checked and in SI and radians."""

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from laboratory.chance import Chance
from laboratory.checking import check
from laboratory.effects import EFFECTS, NOISE
from laboratory.effects.effect import Effect
from laboratory.errors import Complaint, SpecificationError
from laboratory.faults import FAULTS
from laboratory.faults.fault import Fault
from laboratory.gps_time import NANOSECONDS, gps_nanoseconds
from laboratory.layout import changes_between, length, logs_of
from laboratory.plan import Manoeuvre, PlanError, written_out
from laboratory.rawimusa import Samples
from laboratory.records import Records
from laboratory.rehearsal import rehearse
from laboratory.sensor import Sensors, Triad
from laboratory.site import Site, normal_gravity
from laboratory.units import ARCSECOND, DEGREE


@dataclass(frozen=True)
class Receiver:
    """What writes the logs."""

    step: int  # ns from sample to sample
    gyro_count: float  # rad
    accelerometer_count: float  # m/s
    status: str
    line_end: bytes

    @property
    def interval(self) -> float:
        """Time from sample to sample, s."""
        return self.step / NANOSECONDS

    def records(self, samples: Samples) -> Records:
        """A log before any fault."""
        return Records(
            stamps=samples.stamps,
            counts=np.hstack([samples.accelerometer, samples.gyro]),
            ends=samples.stamps,
            units=np.repeat([self.accelerometer_count, self.gyro_count], 3) / self.interval,
            interval=self.interval,
        )


@dataclass(frozen=True)
class Specification:
    """A checked specification; make one with `read` or `specify`."""

    source: str  # the file it comes from, for messages
    _document: dict[str, Any]

    @property
    def document(self) -> dict[str, Any]:
        """A copy of what was written, to vary and to `specify` again."""
        return deepcopy(self._document)

    @property
    def campaign(self) -> dict[str, Any]:
        """What the laboratory tells the pipeline."""
        return {**self.document["campaign"], "simulated": True}

    @cached_property
    def manoeuvres(self) -> list[Manoeuvre]:
        return written_out(self._document["campaign"], self._document["handling"]["still_s"])

    @property
    def change_seconds(self) -> float:
        """Time to go from one position to the next within a log, s; 0 where none does."""
        return float(self._document["handling"].get("change_s", 0.0))

    @property
    def start(self) -> int:
        """GPS time of the campaign's first sample, ns."""
        written = self._document["start"]
        return gps_nanoseconds(written["gps_week"], written["gps_second"])

    @property
    def pause(self) -> int:
        """From the last sample of a log to the first of the next, ns."""
        return round(float(self._document["start"]["pause_s"]) * NANOSECONDS)

    @property
    def receiver(self) -> Receiver:
        written = self._document["receiver"]
        return Receiver(
            round(NANOSECONDS / written["rate_hz"]),
            written["gyro_count_rad"],
            written["accelerometer_count_m_s"],
            written["status"],
            {"crlf": b"\r\n", "lf": b"\n"}[written["line_end"]],
        )

    @property
    def sensors(self) -> Sensors:
        accelerometer = self._document["truth"]["accelerometer"]
        gyro = self._document["truth"]["gyro"]
        return Sensors(
            Triad(np.array(accelerometer["matrix"], float), np.array(accelerometer["bias_m_s2"])),
            Triad(np.array(gyro["matrix"], float), np.array(gyro["bias_rad_s"])),
        )

    @property
    def site(self) -> Site:
        """The true place: what `truth` says, else the campaign, else normal gravity."""
        site, truth = self._document["campaign"]["site"], self._document["truth"]
        latitude = truth.get("latitude_deg", site.get("latitude_deg")) * DEGREE
        gravity = truth.get("gravity_m_s2", site.get("gravity_m_s2"))
        if gravity is None:
            gravity = normal_gravity(latitude, site.get("height_m", 0.0))
        return Site(latitude, gravity)

    @property
    def heading(self) -> float | None:
        """True azimuth of the table's zero mark, rad; None: by chance."""
        said = self._document["campaign"]["table"].get("heading_deg")
        heading = self._document["truth"].get("heading_deg", said)
        return None if heading is None else heading * DEGREE

    @property
    def position_sigma(self) -> float:
        """Standard deviation of both tilts of a position, rad."""
        return float(self._document["campaign"]["table"]["position_sigma_arcsec"]) * ARCSECOND

    @property
    def chance(self) -> Chance:
        return Chance(self._document["seed"])

    def effects(self) -> dict[str, Effect]:
        """Noise and hidden effects by name, new ones at every call: some remember."""
        hidden = self._document.get("effects", {})
        return {
            **{
                name: specified(hidden[name])
                for name, specified in EFFECTS.items()
                if name in hidden
            },
            **{name: specified(self._document["noise"]) for name, specified in NOISE.items()},
        }

    @property
    def faults(self) -> list[Fault]:
        """Faults in the order in which they strike."""
        return [
            FAULTS[name].specified(parameters)
            for fault in self._document.get("faults", [])
            for name, parameters in fault.items()
        ]

    @property
    def empty_logs(self) -> dict[str, Records]:
        """The logs in their full length, before any fault, with nothing but zeros in them."""
        interval, change_seconds = self.receiver.interval, self.change_seconds
        logs = {}
        for log, manoeuvres in logs_of(self.manoeuvres).items():
            samples = length(manoeuvres, interval, change_seconds)
            counts = np.zeros((samples, 3), dtype=np.int64)
            logs[log] = self.receiver.records(Samples(counts[:, 0], counts, counts))
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
    """A specification from what such a file would hold; `source` is its name in messages."""
    check(document, source)
    specification = Specification(source, deepcopy(dict(document)))
    try:
        complaints = list(impossible(specification))
    except PlanError as error:
        complaints = [error.complaint]
    if complaints:
        raise SpecificationError(source, *complaints)
    return specification


def impossible(specification: Specification) -> list[Complaint]:
    """What the schema allows and no laboratory can do."""
    document = specification.document
    complaints = []
    if (
        document["truth"].get("latitude_deg", document["campaign"]["site"].get("latitude_deg"))
        is None
    ):
        expected = "the true latitude, degrees north, since the campaign does not tell it"
        complaints.append(Complaint("truth.latitude_deg", "nothing", expected))
    logs = logs_of(specification.manoeuvres)
    pairs = [pair for log in logs.values() for pair in pairwise(log)]
    if "change_s" not in document["handling"] and any(changes_between(*pair) for pair in pairs):
        expected = "the time from one position to the next, s, since a log has several"
        complaints.append(Complaint("handling.change_s", "nothing", expected))
    creep = document.get("effects", {}).get("table_creep")
    if creep is not None and creep["to_s"] <= creep["from_s"]:
        expected = f"later than from_s, {creep['from_s']} s"
        complaints.append(Complaint("effects.table_creep.to_s", f"{creep['to_s']}", expected))
    return [*complaints, *rehearse(specification.faults, specification.empty_logs)]
