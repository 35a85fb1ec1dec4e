"""The export of a campaign: the files say what the tables say, and can be used on their own."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import chain
import jsonschema
import numpy as np
import pandas as pd
import pytest
import yaml

from inertial import tables
from inertial.campaign.solution import triad_of
from inertial.tables.code import hash_of_file
from inertial.tables.parquet import Writer
from stages.compensation.correction import truth_of
from stages.export.stage import STAGE
from stages.extension.stage import STAGE as EXTENSION
from tests.export.readers import mavproxy, qgroundcontrol

ENDINGS = (
    "calibration.json",
    "calibration.yaml",
    "kalibr.yaml",
    "px4.params",
    "ardupilot.param",
)
SCHEMA = chain.ROOT / "stages/export/calibration.schema.json"
GRAVITY, GRAVITY_SIGMA = 9.7936174, 5e-5
KINDS = {"accelerometer": slice(0, 3), "gyroscope": slice(3, 6)}
ESTIMATES = ("parameters", "covariance", "fit", "fit_manoeuvres")


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> chain.Results:
    folder = tmp_path_factory.mktemp("export")
    campaign = chain.simulate(chain.short(), folder / "short")
    results = chain.run(campaign, folder / "derived")
    write_nothing_extended(results.folder)
    return results


def write_nothing_extended(folder: Path) -> None:
    """The tables of an extension that had no effect to add."""
    writes = {name: EXTENSION.writes[name] for name in ESTIMATES}
    made_by = {"stage": "extension", "settings": {}, "code": "c0", "inputs": {}}
    with Writer(folder / "extension", writes, lambda: made_by) as writer:
        for name, table in writes.items():
            writer.write(name, table.empty())
    verdict = {"verdict": tables.VERDICTS}
    with Writer(folder / "diagnosis", verdict, lambda: made_by | {"stage": "diagnosis"}) as writer:
        writer.write("verdict", tables.VERDICTS.empty())


@pytest.fixture(scope="module")
def files(results: chain.Results, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the files, written as the workflow writes them."""
    folder = tmp_path_factory.mktemp("reports")
    STAGE.command_line([str(results.folder), "--documents", str(folder / "short")])
    return folder


@pytest.fixture(scope="module")
def content(files: Path) -> dict[str, Any]:
    return dict(json.loads((files / "short.calibration.json").read_text("utf-8")))


def exported(results: chain.Results, **changes: Any) -> dict[str, str]:
    """The texts, with some of the tables changed."""
    texts = STAGE.result(STAGE.inputs(STAGE.paths(results.folder)) | changes)
    return dict(texts)


def valid(text: str) -> dict[str, Any]:
    content = json.loads(text)
    jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text("utf-8"))).validate(content)
    return dict(content)


def numbers(values: Any) -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.array(values, np.float64)


# ---- the files


def test_the_command_writes_five_files_and_nothing_beside_them(files: Path) -> None:
    assert {path.name for path in files.iterdir()} == {f"short.{ending}" for ending in ENDINGS}
    assert STAGE.declared.documents == ENDINGS


def test_json_and_yaml_say_the_same_by_the_schema(files: Path, content: dict[str, Any]) -> None:
    assert valid(json.dumps(content)) == content
    assert yaml.safe_load((files / "short.calibration.yaml").read_text("utf-8")) == content
    assert (content["campaign"], content["serial"]) == ("short", "SIM-001")
    assert content["simulated"] is True
    assert content["not_exported"] is None


def test_the_same_tables_give_the_same_bytes(
    results: chain.Results, files: Path, tmp_path: Path
) -> None:
    STAGE.command_line([str(results.folder), "--documents", str(tmp_path / "new/short")])
    for ending in ENDINGS:
        first, second = (folder / f"short.{ending}" for folder in (files, tmp_path / "new"))
        assert first.read_bytes() == second.read_bytes()


def test_a_missing_table_is_named_and_nothing_is_written(
    results: chain.Results, tmp_path: Path
) -> None:
    derived = shutil.copytree(results.folder, tmp_path / "derived")
    (derived / "noise/noise.parquet").unlink()
    with pytest.raises(SystemExit) as refused:
        STAGE.command_line([str(derived), "--documents", str(tmp_path / "reports/short")])
    assert "noise.parquet" in str(refused.value)
    assert [path.name for path in tmp_path.iterdir()] == ["derived"]


# ---- what they say


@pytest.mark.parametrize("kind", KINDS)
def test_matrix_bias_sigma_and_covariance_are_those_of_the_tables(
    results: chain.Results, content: dict[str, Any], kind: str
) -> None:
    (mount,) = content["mounts"]
    triad = mount[kind]
    table = results.parameters(kind)
    matrix, bias = numbers(triad["matrix"]["value"]), numbers(triad["bias"]["value"])
    assert matrix[0, 0] == 1 + table["value"]["scale_x"]
    assert matrix[0, 1] == table["value"]["cross_xy"]
    assert matrix[2, 1] == table["value"]["cross_zy"]
    assert bias.tolist() == [table["value"][f"bias_{axis}"] for axis in "xyz"]
    assert triad["matrix"]["sigma"][1][0] == table["sigma"]["cross_yx"]
    assert triad["bias"]["sigma"][2] == table["sigma"]["bias_z"]
    assert numbers(triad["inverse"]["value"]) @ matrix == pytest.approx(np.eye(3), abs=1e-15)
    names = triad["covariance"]["names"]
    spread = pd.DataFrame(triad["covariance"]["value"], names, names)
    assert len(names) == 12
    for first, second, value in results[f"{kind}/covariance"].itertuples(index=False):
        if first in names and second in names:
            assert spread[second][first] == value
    assert np.sqrt(np.diag(spread)) == pytest.approx(
        [table["sigma"][name.rpartition("/")[2]] for name in names]
    )
    assert triad["fit"]["used"].startswith("x-up")


def test_the_worked_samples_can_be_done_again_from_the_file_alone(content: dict[str, Any]) -> None:
    (mount,) = content["mounts"]
    rest, turn = mount["worked_samples"]
    for sample in (rest, turn):
        for kind in KINDS:
            matrix = numbers(mount[kind]["matrix"]["value"])
            bias = numbers(mount[kind]["bias"]["value"])
            inverse = numbers(mount[kind]["inverse"]["value"])
            reading = numbers(sample[kind]["reading"])
            corrected = numbers(sample[kind]["corrected"])
            assert inverse @ (reading - bias) == pytest.approx(corrected, rel=0, abs=1e-12)
            solved = np.linalg.solve(matrix, reading - bias)
            assert solved == pytest.approx(corrected, rel=0, abs=1e-12)
            assert matrix @ corrected + bias == pytest.approx(reading, rel=0, abs=1e-12)


def test_the_worked_samples_are_real_readings_and_come_out_right(
    results: chain.Results, content: dict[str, Any]
) -> None:
    samples = results["decode/samples"]
    rest, turn = content["mounts"][0]["worked_samples"]
    assert (rest["manoeuvre"], turn["manoeuvre"]) == ("x-up", "x-forward")
    row = samples[(samples["log"] == turn["log"]) & (samples["record"] == turn["from_record"])]
    assert row["line"].tolist() == [turn["line"]]
    inside = samples[(samples["log"] == rest["log"])]
    inside = inside[inside["record"].between(rest["from_record"], rest["to_record"] - 1)]
    channels = list(tables.CHANNELS)
    for kind, own in KINDS.items():
        assert row[channels[own]].to_numpy()[0].tolist() == turn[kind]["reading"]
        mean = inside[channels[own]].to_numpy().mean(axis=0)
        assert mean == pytest.approx(rest[kind]["reading"], rel=0, abs=1e-12)
        truth = truth_of(numbers([turn[kind]["reading"]]), triad_of(results[f"{kind}/parameters"]))
        assert truth[0] == pytest.approx(turn[kind]["corrected"], rel=0, abs=1e-12)
    force = numbers(rest["accelerometer"]["corrected"])
    sigma = numbers(content["mounts"][0]["accelerometer"]["bias"]["sigma"])
    assert abs(force[0] - GRAVITY) < 5 * (GRAVITY_SIGMA + sigma[0])
    assert turn["gyroscope"]["corrected"][0] == pytest.approx(np.pi / 3, rel=0.02)


def test_noise_rate_gravity_inputs_and_makers(
    results: chain.Results, content: dict[str, Any]
) -> None:
    noise = results["noise/noise"]
    for row in content["noise"]:
        own = noise[noise["channel"] == row["channel"]]["white_noise"]
        assert row["density"] == pytest.approx(own.median())
        assert (row["least"], row["most"], row["stretches"]) == (own.min(), own.max(), len(own))
    assert [row["channel"] for row in content["noise"]] == list(tables.CHANNELS)
    assert content["rate"] == {"unit": "Hz", "measured": pytest.approx(100), "stated": 100}
    assert content["temperature"] is None
    gravity = content["known"][0]
    assert (gravity["quantity"], gravity["value"]) == ("gravity", GRAVITY)
    assert gravity["sigma"] == GRAVITY_SIGMA
    raw = {row["file"]: row["sha256"] for row in content["inputs"]}
    assert raw["x-up.asc"] == hash_of_file(results.folder.parent / "short/x-up.asc")
    stages = [made["stage"] for made in content["made_by"]]
    assert stages[-1] == "export"
    assert {"plan", "decode", "quality", "segment", "noise", "gyroscope"} <= set(stages)
    read = {row["file"]: row["sha256"] for row in content["made_by"][-1]["inputs"]}
    table = results.folder / "gyroscope/parameters.parquet"
    assert read["gyroscope/parameters.parquet"] == hash_of_file(table)


def test_a_temperature_that_was_recorded_is_exported(results: chain.Results) -> None:
    blocks = results["segment/blocks"]
    warm = blocks.assign(temperature=np.linspace(295.0, 299.0, len(blocks)))
    temperature = valid(exported(results, blocks=warm)["calibration.json"])["temperature"]
    assert (temperature["unit"], temperature["lowest"], temperature["highest"]) == (
        "K",
        295.0,
        299.0,
    )
    assert 295 < temperature["mean"] < 299


# ---- where the extended result counts


def extended(results: chain.Results) -> dict[str, pd.DataFrame]:
    """An extended result of the gyros: the joint one with another bias, and one effect."""
    rows = results["gyroscope/parameters"].query("method == 'joint'")
    rows = rows[rows["parameter"].str.match("scale|cross|bias")].assign(method="extended")
    rows["id"] = "extension/gyroscope/" + rows["parameter"]
    moved = rows["parameter"] == "bias_x"
    rows.loc[moved, "value"] += 1e-5
    effect = rows[moved].assign(
        id="extension/gyroscope/gyro_bias_ramp.c_x",
        parameter="gyro_bias_ramp.c_x",
        effect="gyro_bias_ramp",
        value=2.5e-9,
        unit="rad/s²",
    )
    ids = list(rows["id"])
    spread = np.diag(rows["sigma"].to_numpy() ** 2)
    verdict = {column.name: [None if column.nullable else ""] for column in tables.VERDICTS.columns}
    return {
        "extension_parameters": pd.concat([rows, effect]).assign(stage="extension"),
        "extension_covariance": pd.DataFrame(
            {
                "first": np.repeat(ids, len(ids)),
                "second": np.tile(ids, len(ids)),
                "covariance": spread.ravel(),
            }
        ),
        "extension_fit": results["gyroscope/fit"]
        .query("method == 'joint'")
        .assign(method="extended", chi_squared=77.0),
        "extension_fit_manoeuvres": results["gyroscope/fit_manoeuvres"]
        .query("method == 'joint'")
        .assign(method="extended"),
        "verdict": pd.DataFrame(verdict | {"sensor": ["gyro"], "method": ["extended"]}),
    }


def test_the_extended_result_is_exported_with_its_effects(results: chain.Results) -> None:
    plain = valid(exported(results)["calibration.json"])["mounts"][0]
    texts = exported(results, **extended(results))
    (mount,) = valid(texts["calibration.json"])["mounts"]
    gyros, accelerometers = mount["gyroscope"], mount["accelerometer"]
    assert (gyros["result"], accelerometers["result"]) == ("extended", "joint")
    assert accelerometers == plain["accelerometer"] and accelerometers["effects"] == []
    (effect,) = gyros["effects"]
    assert (effect["name"], effect["value"]) == ("gyro_bias_ramp.c_x", 2.5e-9)
    difference = numbers(gyros["bias"]["value"]) - numbers(plain["gyroscope"]["bias"]["value"])
    np.testing.assert_allclose(difference, [1e-5, 0, 0], atol=1e-18)
    assert gyros["matrix"] == plain["gyroscope"]["matrix"]
    assert gyros["fit"]["chi_squared"] == 77.0
    assert set(gyros["covariance"]["names"]) >= {"extension/gyroscope/bias_x"}
    offset = qgroundcontrol(texts["px4.params"])["CAL_GYRO0_XOFF"]
    assert float(offset) == pytest.approx(gyros["bias"]["value"][0], rel=1e-6)


@pytest.mark.parametrize("ending", ["kalibr.yaml", "px4.params", "ardupilot.param"])
def test_a_file_says_which_terms_of_effects_it_does_not_hold(
    results: chain.Results, ending: str
) -> None:
    assert "gyro_bias_ramp.c_x = 2.5e-09 rad/s^2" in said(
        exported(results, **extended(results))[ending]
    )
    assert "terms of effects" not in said(exported(results)[ending])


def said(text: str) -> str:
    """The comments of a file on one line."""
    lines = [line[1:].strip() for line in text.splitlines() if line.startswith("#")]
    return " ".join(lines)


# ---- what there is not


def test_a_sensor_that_was_not_recorded_is_null_everywhere(results: chain.Results) -> None:
    blocks = results["segment/blocks"].assign(gyro_y=np.nan)
    made = chain.again(results, "gyroscope", blocks=blocks)
    changed = {f"gyroscope_{name}": made[name] for name in ESTIMATES}
    texts = exported(results, blocks=blocks, **changed)
    (mount,) = valid(texts["calibration.json"])["mounts"]
    gyros = mount["gyroscope"]
    assert gyros["matrix"]["value"][1] == [None] * 3
    assert gyros["bias"]["value"][1] is None
    assert gyros["inverse"]["value"] is None
    assert all(sample["gyroscope"]["corrected"] is None for sample in mount["worked_samples"])
    assert mount["worked_samples"][0]["gyroscope"]["reading"][1] is None
    reasons = {row["name"]: row["reason"] for row in gyros["not_determined"]}
    assert reasons["gyroscope/joint/bias_y"] == "the y gyro is not recorded"
    assert "CAL_GYRO0_YOFF" not in qgroundcontrol(texts["px4.params"])
    assert "INS_GYROFFS_Y" not in mavproxy(texts["ardupilot.param"])
    assert "CAL_GYRO0_YOFF: the y gyro is not recorded" in texts["px4.params"]


def test_each_mount_has_its_own_result(results: chain.Results) -> None:
    plan = results["plan/manoeuvres"]
    plan["mount"] = np.where(plan["manoeuvre"].str.startswith("z"), "lying", "upright")
    changed: dict[str, Any] = {"manoeuvres": plan}
    for kind in KINDS:
        made = chain.again(results, kind, manoeuvres=plan)
        changed |= {f"{kind}_{name}": made[name] for name in ESTIMATES}
    texts = exported(results, **changed)
    upright, lying = valid(texts["calibration.json"])["mounts"]
    assert (upright["mount"], lying["mount"]) == ("upright", "lying")
    assert lying["worked_samples"][0]["manoeuvre"] == "z-up"
    names = lying["accelerometer"]["covariance"]["names"]
    assert names and all(name.startswith("accelerometer/joint@lying/") for name in names)
    assert lying["accelerometer"]["matrix"]["value"][0][0] is None  # no rest with x up or down
    assert "2 mounts" in texts["px4.params"]
    assert "upright" in texts["px4.params"]


def test_a_campaign_that_determines_nothing_exports_nulls(results: chain.Results) -> None:
    none = {
        f"{kind}_{name}": table.empty()
        for kind in KINDS
        for name, table in (
            ("parameters", tables.PARAMETERS),
            ("covariance", tables.COVARIANCE),
            ("fit", tables.FIT),
            ("fit_manoeuvres", tables.FIT_MANOEUVRES),
        )
    }
    texts = exported(results, **none, noise=tables.NOISE.empty(), blocks=tables.BLOCKS.empty())
    (mount,) = valid(texts["calibration.json"])["mounts"]
    assert mount["accelerometer"]["bias"]["value"] == [None] * 3
    assert mount["accelerometer"]["fit"] is None
    assert mount["worked_samples"] == []
    assert qgroundcontrol(texts["px4.params"]) == mavproxy(texts["ardupilot.param"]) == {}
    assert yaml.safe_load(texts["kalibr.yaml"]) == {"update_rate": pytest.approx(100)}


def test_a_compensated_campaign_exports_nothing_but_says_why(results: chain.Results) -> None:
    texts = exported(results, campaign=results["plan/campaign"].assign(compensated=True))
    content = valid(texts["calibration.json"])
    assert content["mounts"] == content["noise"] == content["known"] == []
    assert "taken out of its logs already" in content["not_exported"]
    assert yaml.safe_load(texts["calibration.yaml"]) == content
    assert qgroundcontrol(texts["px4.params"]) == mavproxy(texts["ardupilot.param"]) == {}
    assert yaml.safe_load(texts["kalibr.yaml"]) is None
    for ending in ("kalibr.yaml", "px4.params", "ardupilot.param"):
        assert "Nothing is exported." in texts[ending]
