"""The Digital Calibration Certificate: its schema, its numbers, and how pydcc reads it."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy import stats

from inertial.effects import KNOWN
from inertial.physics.laws import UNITS
from stages.export.calibration import NOT_USABLE, Calibration
from stages.export.dcc import Stated, dcc
from stages.export.dcc_results import CONSTANTS, unit
from stages.export.document import document
from tests.export.made_up import EVIL, calibration, mount, moving_mount, named, with_terms

ROOT = Path(__file__).parents[2]
SCHEMAS = Path(os.environ.get("DCC_SCHEMAS", ROOT.parent / "shared/dcc"))
NAMESPACES = {"dcc": "https://ptb.de/dcc", "si": "https://ptb.de/si"}
NOTHING = Stated({}, [], [], [])
ITEMS = {
    "number": "2026-17",
    "laboratory.name": "Inertial laboratory",
    "laboratory.address": "1 Table Road",
    "laboratory.place": "a cellar",
    "laboratory.accreditation": "none",
    "customer.name": "<script>alert('&')</script>",
    "item.maker": "NovAtel",
    "item.part": "01018",
    "item.firmware": "1.2",
    "item.condition": "as new",
    "received": "2026-10-30",
    "calibrated": "2026-11-02",
    "issued": "2026-02-31",
    "released_by": "the head",
    "calibrated_by": "the night shift",
    "procedure.name": "Six positions",
    "procedure.version": "3",
    "conditions.measured_with": "thermometer T-4",
    "opinions": "fair",
}
TOLERANCE = {"limit": 0.0031, "unit": "1", "decision_rule": "guard_band", "mount": ""}
CONFORMITY: list[dict[str, Any]] = [
    TOLERANCE | {"sensor": sensor, "quantity": quantity, "statement": statement, "risk": risk}
    for sensor, quantity, statement, risk in (
        ("accel", "scale_x", "not_shown", 0.1),  # 0.003
        ("accel", "scale_y", "not_shown", 0.1),  # -0.004
        ("gyro", "scale_x", "conforms", 1e-9),
        ("gyro", "cross_xz", "does_not_conform", 1e-9),
        ("gyro", "cross_xy", "not_assessed", None),
    )
]
WHOLE = Stated(
    {
        item: {"item": item, "text": text, "value": None, "expanded_uncertainty": None, "unit": ""}
        for item, text in ITEMS.items()
    }
    | {
        "conditions.temperature": {
            "text": None,
            "value": 21.3,
            "expanded_uncertainty": 0.4,
            "unit": "°C",
        }
    },
    [
        {
            **{"realises": "angle", "name": "Turntable", "identification": "T-1"},
            **{"certificate": "A-77", "issued_by": None, "valid_until": "2027-06-30"},
        }
    ],
    CONFORMITY,
    ["2026-11-01"],
)


def not_usable() -> Calibration:
    whole = mount()
    verdict = (whole.gyroscope.verdict or {}) | {"verdict": NOT_USABLE, "sentence": "Broken & bad."}
    return calibration(replace(whole, gyroscope=replace(whole.gyroscope, verdict=verdict)))


CASES: dict[str, Calibration] = {
    "plain": calibration(),
    "with effects": calibration(moving_mount()),
    "two mounts": with_terms(calibration(moving_mount("a b"), mount("c"))),
    "gaps": calibration(mount(missing={"gyroscope": ["cross_xy", "bias_z"]})),
    "not usable": not_usable(),
    "nothing": replace(calibration(), mounts=[], noise=[], not_exported="compensated"),
    "warm": replace(calibration(), temperature={"mean": 297.1, "lowest": 290.0, "highest": 300.5}),
}


def root_of(whole: Calibration, stated: Stated = NOTHING) -> ElementTree.Element:
    return ElementTree.fromstring(dcc(document(whole), stated))  # noqa: S314, of our own


def listed(element: ElementTree.Element, name: str) -> list[str]:
    return (element.findtext(f".//si:{name}XMLList", namespaces=NAMESPACES) or "").split()


@cache
def schema() -> Any:
    etree = pytest.importorskip("lxml.etree", reason="lxml is not installed")
    if not (SCHEMAS / "dcc.xsd").is_file():
        pytest.skip(f"no schema in {SCHEMAS}: DCC 3.2.1 is not part of the project (LGPL)")
    return etree.XMLSchema(etree.parse(str(SCHEMAS / "dcc.xsd")))


def assert_valid(text: str) -> None:
    parsed = sys.modules["lxml.etree"].fromstring(text.encode())
    assert schema().validate(parsed), schema().error_log


@pytest.mark.parametrize("stated", [NOTHING, WHOLE], ids=["nothing stated", "all stated"])
@pytest.mark.parametrize("case", CASES)
def test_it_follows_the_schema(case: str, stated: Stated) -> None:
    schema()
    assert_valid(dcc(document(CASES[case]), stated))


def test_the_schema_notices_an_error() -> None:
    schema()
    with pytest.raises(AssertionError):
        assert_valid(dcc(document(CASES["plain"]), NOTHING).replace("0.95", "1.95"))


@pytest.mark.parametrize("name", EVIL)
def test_any_name_is_a_text(name: str) -> None:
    schema()
    assert_valid(dcc(document(named(name)), NOTHING))


def test_a_hostile_name_reads_back_as_text() -> None:
    root = root_of(CASES["plain"], WHOLE)
    (customer,) = root.findall(".//dcc:customer/dcc:name/dcc:content", NAMESPACES)
    assert customer.text == ITEMS["customer.name"]
    assert "<script" not in dcc(document(CASES["plain"]), WHOLE)


# ---- numbers


def numbers_of(triad: dict[str, Any]) -> dict[str, tuple[float, float | None]]:
    """Value and sigma of the JSON by the symbols of its equation."""
    found = {
        f"M_{a}{b}": (triad["matrix"]["value"][i][j], triad["matrix"]["sigma"][i][j])
        for i, a in enumerate("xyz")
        for j, b in enumerate("xyz")
    }
    for i, axis in enumerate("xyz"):
        found[f"bias_{axis}"] = (triad["bias"]["value"][i], triad["bias"]["sigma"][i])
    for effect in triad["effects"]:
        for row in [*effect["parameters"], *effect["constants"]]:
            found[row["name"]] = (row["value"], row["sigma"])
    return {symbol: pair for symbol, pair in found.items() if pair[0] is not None}


@pytest.mark.parametrize("case", ["plain", "with effects", "two mounts", "gaps"])
def test_every_number_is_that_of_the_json_to_the_last_bit(case: str) -> None:
    content = document(CASES[case])
    root = root_of(CASES[case])
    measured = root.findall("dcc:measurementResults/dcc:measurementResult", NAMESPACES)
    assert len(measured) == len(content["mounts"]) + 1  # noise
    for mount_, result in zip(content["mounts"], measured, strict=False):
        for kind, element in zip(
            ("accelerometer", "gyroscope"),
            result.findall("dcc:results/dcc:result", NAMESPACES),
            strict=True,
        ):
            triad, expected = mount_[kind], numbers_of(mount_[kind])
            (whole, *_inverse) = element.findall(".//si:realListXMLList", NAMESPACES)
            labels, values = listed(whole, "label"), listed(whole, "value")
            assert len(labels) == len(set(labels)) == len(triad["covariance"]["names"])
            assert [repr(expected[label][0]) for label in labels] == values
            spreads = [float(one) for one in listed(whole, "valueExpandedMU")]
            assert [one / 2 for one in spreads] == [expected[label][1] for label in labels]
            columns = whole.findall(".//si:columnXMLList", NAMESPACES)
            matrix = [[float(v) for v in listed(column, "value")] for column in columns]
            assert np.transpose(matrix).tolist() == triad["covariance"]["value"]
            constants = {
                one.findtext("si:label", namespaces=NAMESPACES): one.findtext(
                    "si:value", namespaces=NAMESPACES
                )
                for one in element.findall(".//si:real", NAMESPACES)
            }
            assert {*labels, *constants} == {*expected}
            assert all(repr(expected[str(name)][0]) == value for name, value in constants.items())
            inverse = triad["inverse"]
            if inverse["value"] is not None:
                own = element.findall(".//si:realListXMLList", NAMESPACES)[1]
                assert np.ravel(inverse["value"]).tolist() == list(map(float, listed(own, "value")))
    noise = measured[-1].find(".//si:realListXMLList", NAMESPACES)
    assert noise is not None
    assert listed(noise, "value") == [repr(row["density"]) for row in content["noise"]]


def test_u_is_the_95_percent_of_each_and_the_ellipsoid_that_of_all() -> None:
    whole = root_of(CASES["plain"]).find(".//si:realListXMLList", NAMESPACES)
    assert whole is not None
    region = whole.find(".//si:ellipsoidalRegionMUXMLList", NAMESPACES)
    assert region is not None
    matrix = [
        [float(v) for v in listed(column, "value")]
        for column in region.findall(".//si:columnXMLList", NAMESPACES)
    ]
    drawn = np.random.default_rng(5).multivariate_normal(np.zeros(12), matrix, 20000)
    squared = np.einsum("ni,ij,nj->n", drawn, np.linalg.inv(matrix), drawn)
    (k,) = listed(region, "coverageFactor")
    assert np.mean(squared < float(k) ** 2) == pytest.approx(0.95, abs=0.006)  # 4 sigma
    spreads = np.array(listed(whole, "valueExpandedMU"), np.float64)
    assert np.mean(np.abs(drawn) < spreads) == pytest.approx(
        stats.norm.cdf(2) - stats.norm.cdf(-2), abs=0.006
    )


def test_a_covariance_has_the_product_of_the_units() -> None:
    root = root_of(CASES["with effects"])
    gyros = root.findall(".//si:realListXMLList", NAMESPACES)[2]
    units = dict(zip(listed(gyros, "label"), listed(gyros, "unit"), strict=True))
    assert units["M_xy"] == r"\one"
    assert units["bias_x"] == r"\radian\second\tothe{-1}"
    assert units["gyro_g_sensitivity.g_xx"] == r"\radian\second\metre\tothe{-1}"
    labels, column = listed(gyros, "label"), gyros.findall(".//si:columnXMLList", NAMESPACES)
    of_bias = dict(zip(labels, listed(column[labels.index("bias_x")], "unit"), strict=True))
    assert of_bias["bias_y"] == r"\radian\tothe{2}\second\tothe{-2}"
    assert of_bias["gyro_g_sensitivity.g_xx"] == r"\radian\tothe{2}\metre\tothe{-1}"


def test_every_unit_of_the_catalogue_has_its_notation() -> None:
    assert unit("(m/s²)/√Hz") == r"\metre\second\tothe{-2}\hertz\tothe{-0.5}"
    assert unit("rad/s/√s") == r"\radian\second\tothe{-1.5}"
    assert unit("(rad/s)/(m/s²)²") == r"\radian\second\tothe{3}\metre\tothe{-2}"
    for effect in KNOWN.values():
        for parameter in effect.parameters:
            assert unit(parameter.unit).startswith("\\")
    scans = [effect.scan.unit for effect in KNOWN.values() if effect.scan is not None]
    for constant in {*UNITS.values(), "g", *scans}:  # of laws, and what is searched
        assert unit(CONSTANTS.get(constant, (1.0, constant))[1]).startswith("\\")


# ---- what else it says


def texts(element: ElementTree.Element, path: str) -> list[str | None]:
    return [one.text for one in element.findall(path, NAMESPACES)]


def test_what_is_stated_stands_in_its_place() -> None:
    root = root_of(CASES["plain"], WHOLE)
    assert texts(root, ".//dcc:uniqueIdentifier") == ["2026-17"]
    assert texts(root, ".//dcc:beginPerformanceDate") == ["2026-11-02"]
    assert texts(root, ".//dcc:receiptDate") == ["2026-10-30"]
    assert texts(root, ".//dcc:issueDate") == []  # no day of the calendar
    assert texts(root, ".//dcc:performanceLocation") == ["other"]
    assert "2026-17" not in dcc(document(CASES["plain"]), NOTHING)
    (method,) = texts(root, ".//dcc:usedMethod/dcc:name/dcc:content")
    assert method == "Six positions, 3"
    assert texts(root, ".//dcc:measuringEquipment/dcc:name/dcc:content") == ["Turntable"]
    assert texts(root, ".//dcc:measuringEquipment//dcc:value") == ["T-1", "A-77"]
    (air, gravity) = root.findall(".//dcc:influenceCondition", NAMESPACES)
    for element, value, spread, name in (
        (air, "21.3", "0.4", r"\degreecelsius"),
        (gravity, "9.7936174", "0.0001", r"\metre\second\tothe{-2}"),
    ):
        assert texts(element, ".//si:value") == [value]
        assert texts(element, ".//si:valueExpandedMU") == [spread]
        assert texts(element, ".//si:unit") == [name]


def test_conformity_refers_to_the_values_and_states_limit_and_rule() -> None:
    root = root_of(CASES["plain"], WHOLE)
    rows = root.findall(".//dcc:metaData", NAMESPACES)
    assert [row.findtext("dcc:conformity", None, NAMESPACES) for row in rows] == [
        "conditionalPass",
        "conditionalFail",
        "pass",
        "fail",
        None,
    ]
    ids = {one.get("id") for one in root.iter() if one.get("id")}
    assert {row.get("refId") for row in rows} == {"accelerometer-1", "gyroscope-1"} <= ids
    assert set(texts(root, ".//dcc:metaData//si:value")) == {"0.0031"}


def test_a_sensor_that_is_not_usable_has_a_sentence_and_no_value() -> None:
    root = root_of(CASES["not usable"], WHOLE)
    _accelerometers, gyros = root.findall(".//dcc:results", NAMESPACES)[0]
    assert texts(gyros, ".//dcc:data/dcc:text/dcc:content") == ["Broken & bad."]
    assert gyros.findall(".//dcc:quantity", NAMESPACES) == []
    assert "Broken & bad." in texts(root, ".//dcc:declaration/dcc:content")


def test_the_same_content_gives_the_same_text() -> None:
    content = document(CASES["with effects"])
    assert dcc(content, WHOLE) == dcc(content, WHOLE)


# ---- another program


def pydcc(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """pydcc without what needs the network: schemas, which it fetches from PTB, and signatures.

    The check of signatures cannot even be imported: oscrypto 1.3.0 knows no OpenSSL after 3.0.9.
    """
    stand_in: Any = ModuleType("certvalidator")
    stand_in.CertificateValidator = stand_in.ValidationContext = stand_in.errors = None
    monkeypatch.setitem(sys.modules, "certvalidator", stand_in)
    module: ModuleType = pytest.importorskip("dcc", reason="pydcc is not installed")
    monkeypatch.setattr("dcc.dcc.DCCXMLValidator", lambda: None)
    return module


def test_pydcc_reads_number_laboratory_day_and_values(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    module = pydcc(monkeypatch)
    file = tmp_path / "a.dcc.xml"
    file.write_text(dcc(document(CASES["with effects"]), WHOLE), "utf-8")
    read = module.DCC(str(file))
    assert read.is_loaded() and read.uid() == "2026-17" and read.version() == "3.2.1"
    assert read.calibration_laboratory_name() == "Inertial laboratory"
    assert read.calibration_date().date().isoformat() == "2026-11-02"
    quantities = [found for _name, found in read.get_calibration_results("name", "en")]
    lists = [one["si:realListXMLList"] for one in quantities if "si:realListXMLList" in one]
    for kind, own in zip(("accelerometer", "gyroscope"), lists[::2], strict=False):
        expected = numbers_of(document(CASES["with effects"])["mounts"][0][kind])
        labels, values = own["si:labelXMLList"].split(), own["si:valueXMLList"].split()
        assert {*labels} <= {*expected}
        assert [float(value) for value in values] == [expected[label][0] for label in labels]
