"""The certificate as a Digital Calibration Certificate: DCC 3.2.1 with quantities by D-SI 2.2.0.

https://www.ptb.de/dcc/v3.2.1/. Its numbers are those of calibration.json. What the schema demands
and nobody stated is `not stated`; a country that is not stated is ZZ (ISO 3166-1 leaves it to its
users), and a day that is not known is the first of the year 1.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from xml.etree.ElementTree import Element, indent, tostring

import pandas as pd

from inertial.campaign.records import Row, rows_of
from inertial.sensors import PLURAL
from inertial.text.messages import _
from inertial.text.parameters import SENSOR_OF
from inertial.text.statements import (
    IN_FULL_ONLY,
    NOT_STATED,
    REALISES,
    THIS_ITEM_ONLY,
    TRACEABILITY,
)
from stages.export.dcc_results import (
    NO_VALUES,
    Value,
    add,
    add_conformity,
    add_data,
    add_line,
    add_name,
    add_noise,
    add_real,
    add_result,
    add_rich,
    unusable,
)

SCHEMA_VERSION = "3.2.1"
LANGUAGE = "en"
UNKNOWN_COUNTRY = "ZZ"
UNKNOWN_DAY = "0001-01-01"
NAMESPACES = {"xmlns:dcc": "https://ptb.de/dcc", "xmlns:si": "https://ptb.de/si"}
TRIADS = {stage: PLURAL[sensor] for stage, sensor in SENSOR_OF.items()}
CONDITIONS = {
    "conditions.temperature": _("air temperature"),
    "conditions.humidity": _("relative humidity"),
    "conditions.warm_up": _("warm-up"),
}


# ---- What the laboratory states beside the numbers, and what follows from them


@dataclass(frozen=True)
class Stated:
    """The items of a certificate by key, where stated, and its tables.

    standards, conformity : rows of these tables
    days : on which the logs were recorded, by their own clock, YYYY-MM-DD, in order
    """

    items: Mapping[str, Row]
    standards: Sequence[Row]
    conformity: Sequence[Row]
    days: Sequence[str]

    def text(self, item: str) -> str | None:
        """A text that is stated; none where it is not."""
        row = self.items.get(item)
        return None if row is None else row["text"]

    def day(self, item: str) -> str | None:
        """A day that is stated, if it is one of the calendar."""
        return calendar_day(self.text(item))


def calendar_day(text: str | None) -> str | None:
    """A day YYYY-MM-DD; none where the text is none, such as `unknown` or 2026-02-30."""
    try:
        return date.fromisoformat(text or "").isoformat()
    except ValueError:
        return None


def stated_by(
    certificate: pd.DataFrame,
    standards: pd.DataFrame,
    conformity: pd.DataFrame,
    clocks: Sequence[Row],
) -> Stated:
    """From the tables of the plan, of the diagnosis and of the logs."""
    return Stated(
        {row["item"]: row for row in rows_of(certificate) if row["file"]},
        rows_of(standards),
        rows_of(conformity),
        sorted({row["recorded_on"] for row in clocks if row["recorded_on"]}),
    )


# ---- the certificate


def dcc(content: Row, stated: Stated) -> str:
    """The certificate; `content`: what calibration.json contains."""
    root = Element("dcc:digitalCalibrationCertificate", NAMESPACES)
    root.set("schemaVersion", SCHEMA_VERSION)
    administrative = add(root, "dcc:administrativeData")
    _software(administrative, content)
    _core(administrative, content, stated)
    _item(administrative, content, stated)
    _laboratory(administrative, content, stated)
    _persons(administrative, stated)
    customer = add(administrative, "dcc:customer")
    _contact(customer, stated.text("customer.name"), stated.text("customer.address"))
    _statements(administrative, content, stated)
    _measurements(add(root, "dcc:measurementResults"), content, stated)
    indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _software(parent: Element, content: Row) -> None:
    software = add(add(parent, "dcc:dccSoftware"), "dcc:software")
    add_name(software, content["format"])
    codes = [made["code"] for made in content["made_by"]]
    add_line(software, "dcc:release", codes[-1] if codes else None)
    add(software, "dcc:type", "application")


def _core(parent: Element, content: Row, stated: Stated) -> None:
    """Number, language and days: the day stated, else those of the logs, else none."""
    own = add(parent, "dcc:coreData")
    add(own, "dcc:countryCodeISO3166_1", UNKNOWN_COUNTRY)
    add(own, "dcc:usedLangCodeISO639_1", LANGUAGE)
    add(own, "dcc:mandatoryLangCodeISO639_1", LANGUAGE)
    add_line(own, "dcc:uniqueIdentifier", stated.text("number") or content["campaign"])
    received, issued = stated.day("received"), stated.day("issued")
    if received:
        add(own, "dcc:receiptDate", received)
    calibrated = stated.day("calibrated") or calendar_day(content["date"])
    days = [calibrated] if calibrated else [*stated.days] or [UNKNOWN_DAY]
    add(own, "dcc:beginPerformanceDate", days[0])
    add(own, "dcc:endPerformanceDate", days[-1])
    elsewhere = stated.text("laboratory.place")
    add(own, "dcc:performanceLocation", "other" if elsewhere else "laboratory")
    if issued:
        add(own, "dcc:issueDate", issued)


def _item(parent: Element, content: Row, stated: Stated) -> None:
    item = add(add(parent, "dcc:items"), "dcc:item")
    add_name(item, content["instrument"])
    described = [
        f"{name}: {stated.text(key) or NOT_STATED}"
        for key, name in (("item.condition", _("condition")), ("item.axes", _("axes of the case")))
    ]
    add_rich(item, "dcc:description", *described)
    if firmware := stated.text("item.firmware"):
        software = add(add(item, "dcc:installedSoftwares"), "dcc:software")
        add_name(software, _("firmware"))
        add_line(software, "dcc:release", firmware)
        add(software, "dcc:type", "firmware")
    if maker := stated.text("item.maker"):
        add_name(add(item, "dcc:manufacturer"), maker)
    if part := stated.text("item.part"):
        add_line(item, "dcc:model", part)
    serial = (content["serial"], _("serial number"), "basic_serialNumber")
    _identifications(item, "manufacturer", [serial])


def _identifications(
    parent: Element, issuer: str, named: Sequence[tuple[str | None, str, str]]
) -> None:
    """Value, name and refType of each."""
    identifications = add(parent, "dcc:identifications")
    for value, name, kind in named:
        one = add(identifications, "dcc:identification", refType=kind)
        add(one, "dcc:issuer", issuer)
        add_line(one, "dcc:value", value)
        add_name(one, name)


def _laboratory(parent: Element, content: Row, stated: Stated) -> None:
    laboratory = add(parent, "dcc:calibrationLaboratory")
    if accreditation := stated.text("laboratory.accreditation"):
        add_line(laboratory, "dcc:calibrationLaboratoryCode", accreditation)
    name = stated.text("laboratory.name") or content["laboratory"]
    contact = add(laboratory, "dcc:contact")
    _contact(contact, name, stated.text("laboratory.address"))


def _contact(parent: Element, name: str | None, address: str | None) -> None:
    add_name(parent, name)
    add_rich(add(parent, "dcc:location"), "dcc:further", address or NOT_STATED)


def _persons(parent: Element, stated: Stated) -> None:
    persons = add(parent, "dcc:respPersons")
    for item, role in (("released_by", _("released by")), ("calibrated_by", _("calibrated by"))):
        if item == "released_by" or stated.text(item):
            one = add(persons, "dcc:respPerson")
            add_name(add(one, "dcc:person"), stated.text(item))
            add_line(one, "dcc:role", role)
            add(one, "dcc:mainSigner", "true" if item == "released_by" else "false")


def _statements(parent: Element, content: Row, stated: Stated) -> None:
    """What holds for all results, and why a sensor has none."""
    statements = add(parent, "dcc:statements")
    said = [stated.text("traceability") or TRACEABILITY, THIS_ITEM_ONLY, IN_FULL_ONLY]
    if content["simulated"]:
        said.insert(0, _("Simulated: no real instrument has these errors."))
    if opinions := stated.text("opinions"):
        said.append(_("Opinion, not a result: {opinions}", opinions=opinions))
    if place := stated.text("laboratory.place"):
        said.append(_("Place of calibration: {place}", place=place))
    if content["notes"]:
        said.append(_("Remarks: {notes}", notes=content["notes"]))
    triads = [mount[kind] for mount in content["mounts"] for kind in TRIADS]
    said += [triad["sentence"] for triad in triads if unusable(triad)]
    for text in said:
        add_rich(add(statements, "dcc:statement"), "dcc:declaration", text)


# ---- the measurement results


def _measurements(parent: Element, content: Row, stated: Stated) -> None:
    """One for each mount, and one of the noise."""
    several = len(content["mounts"]) > 1
    for number, mount in enumerate(content["mounts"], 1):
        name = _("Errors of the sensors, mount {mount}", mount=mount["mount"])
        result = add(parent, "dcc:measurementResult")
        add_name(result, name if several else _("Errors of the sensors"))
        add_rich(result, "dcc:description", *content["equation"].values())
        _method(result, [mount[kind] for kind in TRIADS], stated)
        _equipment(result, content, stated)
        _conditions(result, content, stated)
        results = add(result, "dcc:results")
        for kind, sensors in TRIADS.items():
            add_result(results, f"{kind}-{number}", sensors, mount[kind])
        own = [row for row in stated.conformity if not several or row["mount"] == mount["mount"]]
        add_conformity(result, own, mount, number)
    if content["noise"]:
        add_noise(parent, content["noise"])
    if not len(parent):
        result = add(parent, "dcc:measurementResult")
        add_name(result, NO_VALUES)
        only = add(add(result, "dcc:results"), "dcc:result")
        add_name(only, NO_VALUES)
        add_data(only, content["not_exported"] or NO_VALUES)


def _method(parent: Element, triads: Sequence[Row], stated: Stated) -> None:
    method = add(
        add(parent, "dcc:usedMethods"), "dcc:usedMethod", refType="basic_calibrationMethod"
    )
    version = stated.text("procedure.version")
    name = stated.text("procedure.name") or NOT_STATED
    add_name(method, f"{name}, {version}" if version else name)
    deviations = stated.text("procedure.deviations") or NOT_STATED
    estimated = [
        f"{sensors}: {triad['method']} ({triad['why_this_method']})"
        for sensors, triad in zip(TRIADS.values(), triads, strict=True)
        if triad["method"]
    ]
    add_rich(
        method,
        "dcc:description",
        _("Deviations from it: {deviations}", deviations=deviations),
        *estimated,
    )


def _equipment(parent: Element, content: Row, stated: Stated) -> None:
    """The standards; the table, where nothing is stated for angle or rate."""
    equipment = add(parent, "dcc:measuringEquipments")
    for row in stated.standards:
        one = add(equipment, "dcc:measuringEquipment", refType="basic_referenceStandard")
        add_name(one, row["name"])
        words = [
            _("realises: {quantity}", quantity=REALISES[row["realises"]]),
            _("calibrated by: {laboratory}", laboratory=row["issued_by"] or NOT_STATED),
            _("valid until: {day}", day=row["valid_until"] or NOT_STATED),
        ]
        add_rich(one, "dcc:description", *words)
        number = (row["identification"], _("identification"), "basic_serialNumber")
        of = (row["certificate"], _("number of its certificate"), "basic_certificateNumber")
        _identifications(one, "calibrationLaboratory", [number, of])
    if not {"angle", "rate"} & {row["realises"] for row in stated.standards}:
        one = add(equipment, "dcc:measuringEquipment", refType="basic_referenceStandard")
        add_name(one, content["table"])


def _conditions(parent: Element, content: Row, stated: Stated) -> None:
    """Room and IMU, and the quantities that were taken as known."""
    found: list[tuple[str, str, list[Value], float | None]] = []
    instruments = stated.text("conditions.measured_with")
    measured_with = _("measured with: {instruments}", instruments=instruments or NOT_STATED)
    for item, name in CONDITIONS.items():
        row = stated.items.get(item)
        if row is not None and row["value"] is not None:
            value = Value(name, row["value"], None, row["unit"])
            found.append((name, measured_with, [value], row["expanded_uncertainty"]))
    if own := content["temperature"]:
        values = [Value(key, own[key], None, own["unit"]) for key in ("mean", "lowest", "highest")]
        found.append((_("temperature of the IMU"), _("as recorded"), values, None))
    for known in content["known"]:
        if known["value"] is not None:
            value = Value(known["quantity"], known["value"], known["sigma"], known["unit"])
            found.append((known["quantity"], known["origin"], [value], None))
    if not found:
        return
    conditions = add(parent, "dcc:influenceConditions")
    for name, origin, values, uncertainty in found:
        condition = add(conditions, "dcc:influenceCondition")
        add_name(condition, name)
        add_rich(condition, "dcc:description", origin)
        data = add(condition, "dcc:data")
        for value in values:
            add_real(add(data, "dcc:quantity"), value, uncertainty)
