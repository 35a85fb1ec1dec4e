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
import scipy.optimize
import yaml

from inertial import tables
from inertial.campaign.solution import triad_of
from inertial.tables.code import hash_of_file
from inertial.tables.parquet import Writer
from stages.export.stage import STAGE
from stages.extension.stage import STAGE as EXTENSION
from tests.export.readers import mavproxy, qgroundcontrol
from tests.expressions import value_of

ENDINGS = (
    "calibration.json",
    "calibration.yaml",
    "calibration.h",
    "dcc.xml",
    "kalibr.yaml",
    "ros.yaml",
    "px4.params",
    "ardupilot.param",
)
SETTINGS = chain.SETTINGS["export"]
SCHEMA = chain.ROOT / "stages/export/calibration.schema.json"
GRAVITY, GRAVITY_SIGMA = 9.7936174, 5e-5
ESTIMATES = ("parameters", "covariance")
KINDS = {"accelerometer": slice(0, 3), "gyroscope": slice(3, 6)}
FITS = ("fit", "fit_manoeuvres")
TWELVE = "scale|cross|bias"


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> chain.Results:
    """A campaign whose joint result counts."""
    folder = tmp_path_factory.mktemp("export")
    campaign = chain.simulate(chain.short(), folder / "short")
    results = chain.run(campaign, folder / "derived")
    made_by = {"stage": "extension", "settings": {}, "code": "c0", "inputs": {}}
    writes = {name: EXTENSION.writes[name] for name in FITS}
    with Writer(results.folder / "extension", writes, lambda: made_by) as writer:
        for name, table in writes.items():
            writer.write(name, table.empty())
    counted = joint_counts(
        {f"{kind}_{name}": results[f"{kind}/{name}"] for kind in KINDS for name in ESTIMATES}
    )
    writes = {
        "result": tables.PARAMETERS,
        "covariance": tables.COVARIANCE,
        "verdict": tables.VERDICTS,
        "conformity": tables.CONFORMITY,
    }
    made_by["stage"] = "diagnosis"
    with Writer(results.folder / "diagnosis", writes, lambda: made_by) as writer:
        for name in writes:
            writer.write(name, counted[name])
    return results


def joint_counts(estimates: dict[str, pd.DataFrame]) -> dict[str, pd.DataFrame]:
    """The tables of a diagnosis that finds nothing wrong; `estimates`: accelerometer_parameters…"""
    joint = pd.concat([estimates[f"{kind}_parameters"] for kind in KINDS])
    joint = joint[(joint["method"] == "joint") & joint["parameter"].str.match(TWELVE)]
    stage = joint["sensor"].map({"accel": "accelerometer", "gyro": "gyroscope"})
    mount = joint["mount"].where(joint["mount"] == "", "@" + joint["mount"])
    ids = dict(
        zip(joint["id"], "diagnosis/" + stage + mount + "/" + joint["parameter"], strict=True)
    )
    products = pd.concat([estimates[f"{kind}_covariance"] for kind in KINDS])
    products = products[products["first"].isin(list(ids)) & products["second"].isin(list(ids))]
    verdicts = [
        verdict(mount, sensor)
        for mount, sensor in joint[["mount", "sensor"]].drop_duplicates().itertuples(index=False)
    ]
    return {
        "result": joint.assign(id=joint["id"].map(ids), stage="diagnosis"),
        "covariance": products.assign(
            first=products["first"].map(ids), second=products["second"].map(ids)
        ),
        "verdict": tables.VERDICTS.frame(verdicts),
        "conformity": tables.CONFORMITY.empty(),
    }


def verdict(mount: str, sensor: str, **changes: Any) -> dict[str, Any]:
    return {
        "mount": mount,
        "sensor": sensor,
        "verdict": "usable",
        "sentence": "Nothing is wrong.",
        "method": "joint",
        "recorded": True,
        "condition": None,
        "reason": "no effect was named",
        **changes,
    }


def write(derived: Path, documents: Path) -> None:
    """The files, as the workflow writes them."""
    settings = ["--settings", json.dumps(SETTINGS)]
    STAGE.command_line([str(derived), *settings, "--documents", str(documents)])


@pytest.fixture(scope="module")
def files(results: chain.Results, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the files, written as the workflow writes them."""
    folder = tmp_path_factory.mktemp("reports")
    write(results.folder, folder / "short")
    return folder


@pytest.fixture(scope="module")
def content(files: Path) -> dict[str, Any]:
    return dict(json.loads((files / "short.calibration.json").read_text("utf-8")))


def exported(results: chain.Results, **changes: Any) -> dict[str, str]:
    """The texts, with some of the tables changed."""
    texts = STAGE.result(STAGE.inputs(STAGE.paths(results.folder)) | SETTINGS | changes)
    return dict(texts)


def valid(text: str) -> dict[str, Any]:
    content = json.loads(text)
    jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text("utf-8"))).validate(content)
    return dict(content)


def numbers(values: Any) -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.array(values, np.float64)


# ---- the files


def test_the_command_writes_its_files_and_nothing_beside_them(files: Path) -> None:
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
    write(results.folder, tmp_path / "new/short")
    for ending in ENDINGS:
        first, second = (folder / f"short.{ending}" for folder in (files, tmp_path / "new"))
        assert first.read_bytes() == second.read_bytes()


def test_a_missing_table_is_named_and_nothing_is_written(
    results: chain.Results, tmp_path: Path
) -> None:
    derived = shutil.copytree(results.folder, tmp_path / "derived")
    (derived / "noise/noise.parquet").unlink()
    with pytest.raises(SystemExit) as refused:
        write(derived, tmp_path / "reports/short")
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
    for first, second, value in results["diagnosis/covariance"].itertuples(index=False):
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
        by_table = triad_of(results[f"{kind}/parameters"])
        assert by_table is not None
        less = numbers(turn[kind]["reading"]) - by_table.bias
        truth = np.linalg.solve(by_table.matrix, less)
        assert truth == pytest.approx(turn[kind]["corrected"], rel=0, abs=1e-12)
    force = numbers(rest["accelerometer"]["corrected"])
    sigma = numbers(content["mounts"][0]["accelerometer"]["bias"]["sigma"])
    assert abs(force[0] - GRAVITY) < 5 * (GRAVITY_SIGMA + sigma[0])
    assert turn["gyroscope"]["corrected"][0] == pytest.approx(np.pi / 3, rel=0.02)


def test_noise_rate_gravity_inputs_and_makers(
    results: chain.Results, content: dict[str, Any]
) -> None:
    noise = results["noise/noise"]
    terms = results["noise/terms"].query("term == 'white_noise' and detected").set_index("channel")
    for row in content["noise"]:
        own = noise[noise["channel"] == row["channel"]]["white_noise"]
        fitted = terms["value"].get(row["channel"], own.median())
        assert row["density"] == pytest.approx(fitted)
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
    assert {"plan", "decode", "segment", "noise", "gyroscope", "diagnosis"} <= set(stages)
    read = {row["file"]: row["sha256"] for row in content["made_by"][-1]["inputs"]}
    table = results.folder / "diagnosis/result.parquet"
    assert read["diagnosis/result.parquet"] == hash_of_file(table)


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


# ---- effects of the result


def with_a_ramp(results: chain.Results) -> dict[str, pd.DataFrame]:
    """The joint result of the gyros with another bias, and two effects; one is of the table."""
    rows, products = results["diagnosis/result"], results["diagnosis/covariance"]
    moved = (rows["sensor"] == "gyro") & (rows["parameter"] == "bias_x")
    rows.loc[moved, "value"] += 1e-5
    rows.loc[rows["sensor"] == "gyro", "method"] = "extended"

    def effect(name: str, parameter: str, value: float, unit: str) -> pd.DataFrame:
        full = f"{name}.{parameter}"
        return rows[moved].assign(
            id=f"diagnosis/gyroscope/{full}", parameter=full, effect=name, value=value, unit=unit
        )

    added = [
        effect("gyro_bias_jump", "b_x", 2.5e-6, "rad/s"),
        effect("gyro_bias_jump", "t0", 30.0, "s").assign(sigma=np.nan),
        effect("table_wobble", "north", 1e-5, "rad").assign(sigma=np.nan),
    ]
    names = [*rows[rows["sensor"] == "gyro"]["id"], added[0]["id"].iloc[0]]
    uncorrelated = pd.MultiIndex.from_product([names, names], names=["first", "second"])
    spread = pd.DataFrame({"covariance": 0.0}, uncorrelated).reset_index()
    spread = pd.concat([products, spread]).drop_duplicates(["first", "second"])
    of_gyro = results["gyroscope/fit"].query("method == 'joint'")
    parts = results["gyroscope/fit_manoeuvres"].query("method == 'joint'")
    return {
        "result": pd.concat([rows, *added]),
        "covariance": spread,
        "verdict": tables.VERDICTS.frame(
            [verdict("", "accel"), verdict("", "gyro", method="extended")]
        ),
        "extension_fit": of_gyro.assign(method="extended", chi_squared=77.0),
        "extension_fit_manoeuvres": parts.assign(method="extended"),
    }


def test_the_result_that_counts_is_exported_with_its_effects(results: chain.Results) -> None:
    plain = valid(exported(results)["calibration.json"])["mounts"][0]
    texts = exported(results, **with_a_ramp(results))
    (mount,) = valid(texts["calibration.json"])["mounts"]
    gyros, accelerometers = mount["gyroscope"], mount["accelerometer"]
    assert (gyros["method"], accelerometers["method"]) == ("extended", "joint")
    assert accelerometers == plain["accelerometer"] and accelerometers["effects"] == []
    jump, wobble = gyros["effects"]
    (parameter,), (constant,) = jump["parameters"], jump["constants"]
    assert (parameter["name"], parameter["value"]) == ("gyro_bias_jump.b_x", 2.5e-6)
    assert (constant["name"], constant["value"], constant["sigma"]) == (
        *("gyro_bias_jump.t0", 30.0),
        None,
    )
    (added,) = jump["added"]
    assert added == {"axis": "x", "to_reading": "gyro_bias_jump.b_x * (t > gyro_bias_jump.t0)"}
    assert gyros["equation"]["x"].endswith(f"+ bias_x + {added['to_reading']}")
    assert gyros["equation"]["y"] == "M_yx * w_x + M_yy * w_y + M_yz * w_z + bias_y"
    assert wobble["effect"] == "table_wobble" and not wobble["in_equation"]
    assert "the IMU feels it" in wobble["not_in_equation"] and wobble["added"] == []
    difference = numbers(gyros["bias"]["value"]) - numbers(plain["gyroscope"]["bias"]["value"])
    np.testing.assert_allclose(difference, [1e-5, 0, 0], atol=1e-18)
    assert gyros["matrix"] == plain["gyroscope"]["matrix"]
    assert gyros["fit"]["chi_squared"] == 77.0
    assert gyros["covariance"]["names"][-1] == "diagnosis/gyroscope/gyro_bias_jump.b_x"
    offset = qgroundcontrol(texts["px4.params"])["CAL_GYRO0_XOFF"]
    assert float(offset) == pytest.approx(gyros["bias"]["value"][0], rel=1e-6)


@pytest.mark.parametrize("ending", ["kalibr.yaml", "ros.yaml", "px4.params", "ardupilot.param"])
def test_a_file_says_which_effects_it_does_not_hold(results: chain.Results, ending: str) -> None:
    head = said(exported(results, **with_a_ramp(results))[ending])
    assert "gyro_bias_jump.b_x = 2.5e-06 rad/s, gyro_bias_jump.t0 = 30 s" in head
    assert "x: gyro_bias_jump.b_x * (t > gyro_bias_jump.t0)" in head
    assert "table wobble" in head and "in no correction of readings" in head
    assert "those of a model with it" not in said(exported(results)[ending])


def names_of(mount: dict[str, Any], sample: dict[str, Any]) -> dict[str, float]:
    """Every number of a mount under the name that its equations have for it, but for M and bias."""
    effects = [one for kind in KINDS for one in mount[kind]["effects"]]
    given = [row for one in effects for row in (*one["parameters"], *one["constants"])]
    return {row["name"]: row["value"] for row in given} | {
        "t": sample["time"],
        "T": sample["temperature"],
    }


def readings_of(mount: dict[str, Any], sample: dict[str, Any], truth: Any) -> Any:
    """What the equations of the file read for f_x, f_y, f_z, w_x, w_y, w_z, (6,)."""
    names = names_of(mount, sample)
    names |= dict(zip([f"{s}_{axis}" for s in "fw" for axis in "xyz"], truth, strict=True))
    values = []
    for kind in KINDS:
        triad = mount[kind]
        own = {f"bias_{axis}": triad["bias"]["value"][i] for i, axis in enumerate("xyz")} | {
            f"M_{row}{column}": triad["matrix"]["value"][i][j]
            for i, row in enumerate("xyz")
            for j, column in enumerate("xyz")
        }
        felt = truth[:3] if kind == "accelerometer" else truth[3:]
        along = np.array(triad["matrix"]["value"], float) @ felt
        own |= {f"s_{axis}": along[i] for i, axis in enumerate("xyz")}
        values += [value_of(triad["equation"][axis], names | own) for axis in "xyz"]
    return np.array(values)


@pytest.mark.slow
def test_by_the_equations_of_the_file_a_corrected_rest_reads_the_rate_of_the_earth(
    coupled: chain.Results,
) -> None:
    """A g-sensitivity is hidden: without it a rest with x up reads 21.6 °/h, not 7.64.

    The equations are solved by a general solver from what the JSON says, and nothing else.
    """
    content = valid(exported(coupled)["calibration.json"])
    (mount,) = content["mounts"]
    rest, turn = mount["worked_samples"]
    for sample in (rest, turn):
        reading = np.concatenate([numbers(sample[kind]["reading"]) for kind in KINDS])
        corrected = np.concatenate([numbers(sample[kind]["corrected"]) for kind in KINDS])
        # In units of 1 m/s² and 1e-5 rad/s, so that the solver takes both alike.
        scale = np.array([1.0] * 3 + [1e-5] * 3)
        solved = scipy.optimize.root(
            lambda x, s=sample, r=reading, u=scale: (readings_of(mount, s, x * u) - r) / u,
            reading / scale,
        )
        assert np.abs(solved.fun).max() < 1e-10 * np.abs(reading / scale).max()
        np.testing.assert_allclose(solved.x * scale, corrected, rtol=1e-9, atol=1e-13)
    assert rest["manoeuvre"] == "x-up"
    hour = np.radians(1 / 3600)
    earth = 7.292115e-5 * np.sin(np.radians(30.5278))  # Wuhan
    assert earth / hour == pytest.approx(7.64, abs=0.01)
    noise = next(row["density"] for row in content["noise"] if row["channel"] == "gyro_x")
    seconds = (rest["to_record"] - rest["from_record"]) / content["rate"]["measured"]
    rate = rest["gyroscope"]["corrected"][0]
    assert abs(rate - earth) < 3 * noise / np.sqrt(seconds)
    inverse, bias = (mount["gyroscope"][key]["value"] for key in ("inverse", "bias"))
    without = numbers(inverse) @ (numbers(rest["gyroscope"]["reading"]) - numbers(bias))
    assert without[0] / hour == pytest.approx(7.64 + 14, abs=0.5)


def said(text: str) -> str:
    """The comments of a file on one line."""
    lines = [line[1:].strip() for line in text.splitlines() if line.startswith("#")]
    return " ".join(lines)


# ---- conditions, and what is not usable


def test_a_condition_stands_in_every_file(results: chain.Results) -> None:
    wired = "valid if the y gyro is wired in reverse"
    verdicts = [verdict("", "accel"), verdict("", "gyro", verdict="on_condition", condition=wired)]
    texts = exported(results, verdict=tables.VERDICTS.frame(verdicts))
    (mount,) = valid(texts["calibration.json"])["mounts"]
    assert mount["gyroscope"]["verdict"] == "on_condition"
    assert mount["gyroscope"]["condition"] == wired
    assert mount["accelerometer"]["condition"] is None
    for ending in ("kalibr.yaml", "ros.yaml", "px4.params", "ardupilot.param"):
        assert f"The numbers of the gyroscopes are valid on this condition: {wired}" in said(
            texts[ending]
        )


def test_of_a_sensor_that_is_not_usable_there_are_nulls_and_the_reason(
    results: chain.Results,
) -> None:
    why = "Gravity is off by 1326 ppm."
    verdicts = [verdict("", "accel", verdict="not_usable", sentence=why), verdict("", "gyro")]
    rows = results["diagnosis/result"]
    spoilt = rows["sensor"] == "accel"
    rows.loc[spoilt, ["value", "sigma"]] = np.nan
    rows.loc[spoilt, "reason"] = why
    texts = exported(results, result=rows, verdict=tables.VERDICTS.frame(verdicts))
    (mount,) = valid(texts["calibration.json"])["mounts"]
    triad = mount["accelerometer"]
    assert (triad["verdict"], triad["sentence"]) == ("not_usable", why)
    assert triad["matrix"]["value"] == [[None] * 3] * 3 and triad["bias"]["value"] == [None] * 3
    assert {row["reason"] for row in triad["not_determined"][:12]} == {why}
    assert all(one["accelerometer"]["corrected"] is None for one in mount["worked_samples"])
    assert all(one["gyroscope"]["corrected"] is not None for one in mount["worked_samples"])
    assert set(qgroundcontrol(texts["px4.params"])) == {f"CAL_GYRO0_{a}OFF" for a in "XYZ"}
    assert set(mavproxy(texts["ardupilot.param"])) == {f"INS_GYROFFS_{a}" for a in "XYZ"}
    kalibr = yaml.safe_load(texts["kalibr.yaml"])
    assert "accelerometer_noise_density" not in kalibr and "gyroscope_noise_density" in kalibr
    for ending in ("kalibr.yaml", "ros.yaml", "px4.params", "ardupilot.param"):
        assert f"The accelerometers are not usable, so nothing is given for them. {why}" in said(
            texts[ending]
        )


# ---- what there is not


def test_a_sensor_that_was_not_recorded_is_null_everywhere(results: chain.Results) -> None:
    blocks = results["segment/blocks"].assign(gyro_y=np.nan)
    made = chain.again(results, "gyroscope", blocks=blocks)
    estimates = {f"accelerometer_{name}": results[f"accelerometer/{name}"] for name in ESTIMATES}
    estimates |= {f"gyroscope_{name}": made[name] for name in ESTIMATES}
    changed = joint_counts(estimates) | {f"gyroscope_{name}": made[name] for name in FITS}
    texts = exported(results, blocks=blocks, **changed)
    (mount,) = valid(texts["calibration.json"])["mounts"]
    gyros = mount["gyroscope"]
    assert gyros["matrix"]["value"][1] == [None] * 3
    assert gyros["bias"]["value"][1] is None
    assert gyros["inverse"]["value"] is None
    assert all(sample["gyroscope"]["corrected"] is None for sample in mount["worked_samples"])
    assert mount["worked_samples"][0]["gyroscope"]["reading"][1] is None
    reasons = {row["name"]: row["reason"] for row in gyros["not_determined"]}
    assert reasons["diagnosis/gyroscope/bias_y"] == "the y gyro is not recorded, or masked"
    assert "CAL_GYRO0_YOFF" not in qgroundcontrol(texts["px4.params"])
    assert "INS_GYROFFS_Y" not in mavproxy(texts["ardupilot.param"])
    assert "CAL_GYRO0_YOFF: the y gyro is not recorded, or masked" in texts["px4.params"]


def test_each_mount_has_its_own_result(results: chain.Results) -> None:
    plan = results["plan/manoeuvres"]
    plan["mount"] = np.where(plan["manoeuvre"].str.startswith("z"), "lying", "upright")
    changed: dict[str, Any] = {"manoeuvres": plan}
    estimates: dict[str, Any] = {}
    for kind in KINDS:
        made = chain.again(results, kind, manoeuvres=plan)
        estimates |= {f"{kind}_{name}": made[name] for name in ESTIMATES}
        changed |= {f"{kind}_{name}": made[name] for name in FITS}
    texts = exported(results, **changed, **joint_counts(estimates))
    upright, lying = valid(texts["calibration.json"])["mounts"]
    assert (upright["mount"], lying["mount"]) == ("upright", "lying")
    assert lying["worked_samples"][0]["manoeuvre"] == "z-up"
    names = lying["accelerometer"]["covariance"]["names"]
    assert names and all(name.startswith("diagnosis/accelerometer@lying/") for name in names)
    assert lying["accelerometer"]["matrix"]["value"][0][0] is None  # no rest with x up or down
    assert "2 mounts" in texts["px4.params"]
    assert "upright" in texts["px4.params"]


def test_a_campaign_that_determines_nothing_exports_nulls(results: chain.Results) -> None:
    none = {
        "result": tables.PARAMETERS.empty(),
        "covariance": tables.COVARIANCE.empty(),
        "verdict": tables.VERDICTS.empty(),
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
    for ending in ("kalibr.yaml", "ros.yaml", "px4.params", "ardupilot.param"):
        assert "Nothing is exported." in texts[ending]
