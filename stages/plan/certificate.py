"""What a certificate states beside its numbers, from campaign.yaml and laboratory.yaml.

And by how much parameters may change until the IMU is due for calibration again.
"""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from inertial.campaign.records import Row
from inertial.sensors import FILE_KEYS
from inertial.tables.errors import Refusal
from inertial.tables.yaml_file import YamlFile
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND, DEGREE, STANDARD_GRAVITY

STRICT = "strict"
# In the order of the certificate, and whether ISO/IEC 17025:2017 (7.8.2.1, 7.8.4.1) wants it.
REQUIRED = {
    "number": True,
    "laboratory.name": True,
    "laboratory.address": True,
    "laboratory.place": False,
    "laboratory.accreditation": False,
    "customer.name": True,
    "customer.address": True,
    "item.maker": False,
    "item.part": False,
    "item.firmware": False,
    "item.condition": True,
    "item.axes": False,
    "received": False,
    "calibrated": True,
    "issued": True,
    "calibrated_by": False,
    "released_by": True,
    "procedure.name": True,
    "procedure.version": False,
    "procedure.deviations": True,
    "conditions.temperature": True,
    "conditions.humidity": False,
    "conditions.warm_up": False,
    "conditions.measured_with": False,
    "traceability": False,
    "opinions": False,
}
UNITS = {"temperature": "°C", "humidity": "%", "warm_up": "min"}
STANDARD = ("name", "identification", "certificate", "issued_by", "valid_until")
# What the campaign states outside its certificate, too.
ELSEWHERE = {"laboratory.name": "laboratory", "calibrated_by": "operator", "calibrated": "date"}
UNKNOWN = "unknown"
LIMITS = {  # by their key: parameter's kind, one unit in SI, and the SI unit
    "bias_micro_g": ("bias", STANDARD_GRAVITY * 1e-6, "m/s²"),
    "bias_deg_h": ("bias", DEGREE / 3600, "rad/s"),
    "scale_ppm": ("scale", 1e-6, "1"),
    "cross_arcsec": ("cross", ARC_SECOND, "1"),
}
GUARD_BAND = "guard_band"


class Statements:
    """What the campaign states of its certificate, and the laboratory of all of them.

    Raises
    ------
    Refusal
        where a key is not known or a value is none; with `strict` where a required item is missing
    """

    def __init__(self, campaign: YamlFile, laboratory: Sequence[Path], demanded: str) -> None:
        self._files: list[tuple[Mapping[str, Any], str]] = []
        if "certificate" in campaign.content:
            campaign.check("certificate", within=["certificate"])
            self._files.append((campaign.content["certificate"], campaign.path.name))
        elsewhere = {
            item: campaign.content.get(key)
            for item, key in ELSEWHERE.items()
            if campaign.content.get(key) not in (None, UNKNOWN)
        }
        self._files.append((_nested(elsewhere), campaign.path.name))
        for file in map(YamlFile, laboratory):
            file.check("certificate")
            self._files.append((file.content, file.path.name))
        self.items = [self._item(item, required) for item, required in REQUIRED.items()]
        missing = [row["item"] for row in self.items if row["required"] and not row["file"]]
        if demanded == STRICT and missing:
            raise Refusal(
                str(campaign.path),
                "certificate",
                _("no {missing}", missing=", ".join(missing)),
                _("all that ISO/IEC 17025 wants, for config.yaml says certificate: strict"),
                _("state them there, or what never changes in data/laboratory.yaml"),
            )

    def _item(self, item: str, required: bool) -> Row:
        found, file = self._stated(item)
        measured = found if isinstance(found, Mapping) else {}
        return {
            "item": item,
            "text": found if isinstance(found, str) else None,
            "value": measured.get("value"),
            "expanded_uncertainty": measured.get("expanded_uncertainty"),
            "unit": UNITS.get(item.partition(".")[2], "") if measured else "",
            "required": required,
            "file": file,
        }

    def _stated(self, item: str) -> tuple[Any, str]:
        """The first that is stated, and the file that states it."""
        for content, file in self._files:
            found: Any = content
            for key in item.split("."):
                found = found.get(key) if isinstance(found, Mapping) else None
            if found is not None:
                return found, file
        return None, ""

    def standards(self) -> list[Row]:
        """What the results are traced to."""
        found, _file = self._stated("standards")
        return [
            {"realises": one["quantity"]} | {key: one.get(key) for key in STANDARD}
            for one in found or ()
        ]

    def tolerances(self) -> Iterator[Row]:
        """The limits of the parameters of each sensor, in SI."""
        rule, _file = self._stated("tolerances.decision_rule")
        for sensor, key in FILE_KEYS.items():
            for name, (kind, size, unit) in LIMITS.items():
                limit, _file = self._stated(f"tolerances.{key}.{name}")
                if limit is not None:
                    yield {
                        "sensor": sensor,
                        "kind": kind,
                        "limit": limit * size,
                        "unit": unit,
                        "decision_rule": rule or GUARD_BAND,
                    }


def allowed_changes(campaign: YamlFile) -> Iterator[Row]:
    """The changes that a campaign file allows under `may_change`, in SI."""
    stated = campaign.content.get("may_change", {})
    for sensor, key in FILE_KEYS.items():
        for name, limit in stated.get(key, {}).items():
            kind, size, unit = LIMITS[name]
            yield {"sensor": sensor, "kind": kind, "limit": limit * size, "unit": unit}


def _nested(items: Mapping[str, Any]) -> Row:
    """Items by their dotted keys as they stand in a file."""
    content: Row = {}
    for item, text in items.items():
        inside, _dot, key = item.rpartition(".")
        (content.setdefault(inside, {}) if inside else content)[key] = text
    return content
