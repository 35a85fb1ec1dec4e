"""JSON and YAML: the same content, by the schema, whatever the names in it are made of."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
import yaml as version_1_1
from hypothesis import given
from hypothesis import strategies as st
from ruamel.yaml import YAML

from stages.export.document import as_json, as_yaml, document
from tests.export.made_up import EVIL, REASON, calibration, mount, named

ROOT = Path(__file__).parents[2]
SCHEMA = json.loads((ROOT / "stages/export/calibration.schema.json").read_text("utf-8"))


def version_1_2(text: str) -> Any:
    return YAML(typ="safe", pure=True).load(text)


def valid(content: Any) -> Any:
    jsonschema.Draft202012Validator(SCHEMA).validate(content)
    return content


def test_a_calibration_follows_the_schema_and_reads_back_to_the_last_bit() -> None:
    expected = document(calibration())
    content = valid(json.loads(as_json(expected)))
    assert content == expected
    assert version_1_2(as_yaml(expected)) == content
    assert version_1_1.safe_load(as_yaml(expected)) == content


def test_a_row_of_a_matrix_stands_on_one_line() -> None:
    expected = document(calibration())
    row = next(line for line in as_json(expected).splitlines() if "1.003" in line)
    assert (
        json.loads(row.strip().rstrip(","))
        == expected["mounts"][0]["accelerometer"]["matrix"]["value"][0]
    )
    assert "[1.003, 0.002, 0.0075]" in as_yaml(expected)


def test_what_was_not_determined_is_null_with_its_reason() -> None:
    expected = document(calibration(mount(missing={"gyroscope": ["cross_xy", "bias_z"]})))
    gyros = valid(json.loads(as_json(expected)))["mounts"][0]["gyroscope"]
    assert gyros["matrix"]["value"][0][1] is None
    assert gyros["matrix"]["sigma"][0][1] is None
    assert gyros["bias"]["value"][2] is None
    assert gyros["inverse"] == {"unit": "1", "value": None, "sigma": None}
    assert "gyroscope/joint/cross_xy" not in gyros["covariance"]["names"]
    assert np.shape(gyros["covariance"]["value"]) == (10, 10)
    assert {row["name"]: row["reason"] for row in gyros["not_determined"]} == {
        "gyroscope/joint/cross_xy": REASON,
        "gyroscope/joint/bias_z": REASON,
        "gyroscope/joint/inverse": "it needs all nine elements of M",
    }
    (sample,) = expected["mounts"][0]["worked_samples"]
    assert sample["gyroscope"]["corrected"] is None
    assert sample["accelerometer"]["corrected"] is not None


def test_a_sensor_that_feels_nothing_leaves_no_inverse() -> None:
    dead = mount()
    dead.accelerometer.matrix[2] = 0.0
    triad = valid(document(calibration(dead)))["mounts"][0]["accelerometer"]
    assert triad["inverse"]["value"] is None
    assert "cannot be inverted" in triad["not_determined"][0]["reason"]


def test_the_sigmas_of_the_inverse_are_those_of_drawn_matrices() -> None:
    triad = mount().accelerometer
    generator = np.random.default_rng(3)
    nine = generator.multivariate_normal(triad.matrix.ravel(), triad.covariance[:9, :9], 20000)
    drawn = np.linalg.inv(nine.reshape(-1, 3, 3)).std(axis=0)
    assert triad.inverse_sigma == pytest.approx(drawn, rel=0.03)  # 6 sigma of the draw


@pytest.mark.parametrize("name", EVIL)
def test_any_name_reads_back_as_it_is(name: str) -> None:
    expected = document(named(name))
    assert valid(json.loads(as_json(expected))) == expected
    assert version_1_2(as_yaml(expected)) == expected
    assert version_1_1.safe_load(as_yaml(expected)) == expected


NUMBERS = st.floats(allow_nan=False, allow_infinity=False) | st.integers() | st.none()


@pytest.mark.slow
@given(st.text(st.characters(exclude_categories=["Cs"])), st.lists(NUMBERS))
def test_any_text_and_number_reads_back_as_it_is(text: str, numbers: list[float | None]) -> None:
    content = {"text": text, "texts": [text, text], "numbers": numbers, "rows": [numbers, numbers]}
    assert json.loads(as_json(content)) == content
    assert version_1_2(as_yaml(content)) == content
    assert version_1_1.safe_load(as_yaml(content)) == content


# ---- the schema itself


def objects(schema: Any) -> Iterator[dict[str, Any]]:
    if isinstance(schema, dict):
        if schema.get("type") == "object":
            yield schema
        for part in schema.values():
            yield from objects(part)
    elif isinstance(schema, list):
        for part in schema:
            yield from objects(part)


def test_the_schema_allows_no_other_key_requires_each_and_says_what_it_is() -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    schemas = list(objects(SCHEMA))
    assert len(schemas) > 15
    for schema in schemas:
        assert schema["additionalProperties"] is False
        assert sorted(schema["required"]) == sorted(schema["properties"])
        for name, part in schema["properties"].items():
            assert "description" in part or "$ref" in part, name
            number = part.get("type") in ("number", "integer", ["number", "null"])
            unit = ("unit", "Hz", "K", ", 1", "byte", "record", "line", "version")
            if number:
                assert any(word in part["description"] for word in unit), f"{name} has no unit"


def test_the_schema_refuses_another_version_and_another_key() -> None:
    expected = document(calibration())
    for wrong in (expected | {"version": 1}, expected | {"gain": 1}):
        with pytest.raises(jsonschema.ValidationError):
            valid(wrong)
