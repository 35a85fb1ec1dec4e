"""`make check`: what is wrong with a recording, in words, and the exit code that goes with it."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import chain
import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
from chain import ROOT, Results

from commands.check import LINE_WIDTH, Recording, _beside_bias, as_text, main
from inertial import tables
from inertial.campaign.records import Performed
from inertial.tables.parquet import write_once
from inertial.text.numbers import significant

NAME = "demo"
SENSORS = ("accelerometer", "gyroscope")
FINDINGS = ("quality/findings", "segment/findings")
READ = (
    *FINDINGS,
    *("plan/repairs", "segment/repairs", "segment/channel_repairs"),
    *("segment/masks", "quality/gaps", "segment/segments", "segment/performed"),
    *("segment/blocks", "plan/manoeuvres", "decode/accounts", "decode/clocks"),
    *("accelerometer/parameters", "gyroscope/parameters"),
    *("accelerometer/findings", "gyroscope/findings", "noise/findings", "noise/terms"),
)


CRITICISED = (
    *("criticism/findings", "criticism/members", "criticism/cause_positions"),
    *("criticism/structure_manoeuvres", "criticism/effects"),
)


@pytest.fixture
def data(demo: Results, tmp_path: Path) -> Path:
    """A data folder with the tables of the demo that are read."""
    return copied(demo, tmp_path / "data")


def copied(results: Results, data: Path, names: tuple[str, ...] = READ) -> Path:
    for name in names:
        path = data / "derived" / NAME / f"{name}.parquet"
        path.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(results.folder / f"{name}.parquet", path)
    return data


def change(data: Path, table: str, **columns: object) -> None:
    """The same table with other values in some columns."""
    path = data / f"derived/{NAME}/{table}.parquet"
    old = pq.read_table(path)
    frame = old.to_pandas().assign(**columns)
    new = type(old).from_pandas(frame, schema=old.schema, preserve_index=False)
    pq.write_table(new.replace_schema_metadata(old.schema.metadata), path)


def check(data: Path) -> int:
    return main(["--campaign", NAME, "--data", str(data)])


def test_what_is_wrong_with_the_demo(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code = check(data)
    said = capsys.readouterr().out
    lines = said.splitlines()
    assert lines[0] == "demo: 12 of 12 manoeuvres found, 11 complete."
    assert "1 197 samples are missing between 2771.800 s and 2783.780 s" in " ".join(said.split())
    assert said.count("What it does: ") == said.count("What to do: ") == said.count(" · ") / 2
    assert lines[-1] == "2 causes: 2 are good to know."  # a gap, and an oscillation of the case
    assert code == 0


def test_what_the_demo_hides_is_a_cause_where_criticism_was_made(
    demo: Results, data: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    copied(demo, data, CRITICISED)
    assert check(data) == 0  # the model allows for them
    said = capsys.readouterr().out
    for cause in ("gyro g-sensitivity", "oscillation"):
        assert f" · {cause}" in said
    assert "Detected: gyro g-sensitivity" in said


def test_the_worst_comes_first(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = data / f"derived/{NAME}/quality/findings.parquet"
    causes = pd.read_parquet(path)["cause"].tolist()
    change(data, "quality/findings", severity=[2 if cause == "gap" else 1 for cause in causes])
    check(data)
    said = capsys.readouterr().out
    assert said.index("WEAKENS A RESULT · gap") < said.index("IS GOOD TO KNOW · oscillation")


def test_a_sensor_that_the_diagnosis_leaves_not_usable_has_no_result(
    data: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Though nothing is wrong with the recording: its residuals have a structure without a name."""
    row = {"mount": "", "method": "joint", "condition": None, "recorded": True}
    row["reason"] = "as a test has it"
    sentences = {"gyro": "Gyros: structure without a name. Not usable.", "accel": "Usable."}
    verdicts = [
        row | {"sensor": sensor, "verdict": verdict, "sentence": sentences[sensor]}
        for sensor, verdict in (("gyro", "not_usable"), ("accel", "usable"))
    ]
    (data / f"derived/{NAME}/diagnosis").mkdir()
    write_once(tables.VERDICTS, data / f"derived/{NAME}/diagnosis/verdict.parquet", verdicts)
    assert check(data) == 1
    said = capsys.readouterr().out
    assert "NO RESULT · gyros" in said and "NO RESULT · accelerometers" not in said
    assert "structure without a name" in said


@pytest.fixture(scope="module")
def reversed_gyro(tmp_path_factory: pytest.TempPathFactory) -> Results:
    """The y gyro reads -y, which the segments set right."""
    folder = tmp_path_factory.mktemp("reversed")
    fault = {"flip": {"log": "all", "sensor": "gyro", "axis": "y"}}
    chain.simulate(chain.short(faults=[fault]), folder / NAME)
    return chain.run(folder / NAME, folder / "derived", "gyroscope")


def test_what_is_set_right_spoils_nothing_and_states_its_condition(
    reversed_gyro: Results, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = copied(reversed_gyro, tmp_path / "data")
    assert check(data) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "IS SET RIGHT · reversed sign" in said
    assert "Valid if: of the gyros, in all logs, y reads −y" in said
    assert "accept: [signs/gyro]" in said
    assert said.endswith("1 cause: 1 is set right.")


def test_what_nobody_set_right_spoils_a_result(
    reversed_gyro: Results, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = copied(reversed_gyro, tmp_path / "data")
    change(data, "segment/repairs", state="refused")
    assert check(data) == 1
    assert "SPOILS A RESULT · reversed sign" in capsys.readouterr().out


@pytest.mark.parametrize("condition", [None, "The stamps are right."])
def test_what_is_assumed_spoils_nothing_either_and_states_its_condition(
    data: Path, capsys: pytest.CaptureFixture[str], condition: str | None
) -> None:
    """A clock that is off by 154 sigma, of which the result holds on a condition, or does not."""
    change(data, "quality/findings", severity=3, cause="clock_scale", sensor="gyro")
    row = dict.fromkeys(column.name for column in tables.CAUSES.columns) | {
        "id": "diagnosis/quality/clock_scale",
        "cause": "clock_scale",
        "verdict": "found",
        "mount": "",
        "sensor": "gyro",
        "count": 1,
        "sentence": "The interval by the stamps is 10000 ppm longer.",
        "unit": "ppm",
        "cure": "none",
        "moves": 154.0,
        "condition": condition,
        "consequence": "",
        "done": "",
        "action": "",
    }
    (data / f"derived/{NAME}/diagnosis").mkdir()
    write_once(tables.CAUSES, data / f"derived/{NAME}/diagnosis/causes.parquet", [row])
    assert check(data) == (0 if condition else 1)
    said = " ".join(capsys.readouterr().out.split())
    assert ("LEAVES A RESULT ON CONDITION · clock" in said) == (condition is not None)
    assert ("Valid if: The stamps are right." in said) == (condition is not None)
    assert ("SPOILS A RESULT · clock" in said) == (condition is None)


# ---- no result


def without(plan: list[str], tmp_path: Path) -> Path:
    """The data of a short campaign of which only these manoeuvres were planned.

    With 0.3 °/√h the gyros hardly see the earth turn, whose rate would tell what no turn does.
    """
    document = chain.short()
    document["noise"]["angle_random_walk_deg_sqrt_h"] = 0.3
    document["campaign"]["plan"] = [
        item for item in document["campaign"]["plan"] if item["id"] in plan
    ]
    chain.simulate(document, tmp_path / NAME)
    results = chain.run(tmp_path / NAME, tmp_path / "derived", "gyroscope")
    return copied(results, tmp_path / "data")


@pytest.mark.slow
def test_a_sensor_that_lacks_a_manoeuvre_has_an_incomplete_result(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rests = [f"{axis}-{way}" for axis in "xyz" for way in ("up", "down")]
    data = without([*rests, "x-forward", "x-backward", "z-forward", "z-backward"], tmp_path)
    assert check(data) == 1
    said = " ".join(capsys.readouterr().out.split())
    lacking = "3 of 12 parameters are not determined: m_xy, s_y, m_zy. The others are."
    assert f"INCOMPLETE RESULT · gyros {lacking}" in said
    assert "add one of 360° about y" in said
    assert "RESULT · accelerometers" not in said
    assert said.endswith("Incomplete result: gyros. 1 cause: 1 is good to know.")


def by_hand(recordings: Path, folder: Path, time: str) -> Results:
    """A real MPU-9150 in 22 positions by hand, without stamps, 100 Hz, the format having `time`."""
    (folder / NAME).mkdir()
    shutil.copy(recordings / "mikoff_mpu9150/imu0.log", folder / NAME)
    (folder / NAME / "campaign.yaml").write_text(
        f"""\
campaign: 1
instrument:
  name: MPU-9150
  format:
    kind: columns
    {time}
    accelerometer: {{columns: [1, 2, 3], unit: m/s2}}
    gyro: {{columns: [4, 5, 6], unit: rad/s}}
serial: unknown
date: unknown
site: {{latitude_deg: 55, gravity_m_s2: 9.81, gravity_sigma_m_s2: 0.005}}
table: {{name: by hand, position_sigma_arcsec: 3600}}
log: imu0.log
plan:
  - {{id: positions, do: positions, seconds: 1}}
"""
    )
    return chain.run(folder / NAME, folder / "derived", "gyroscope")


@pytest.mark.slow
def test_a_rate_stated_ten_times_too_low_cuts_rests_to_pieces(
    recordings: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    results = by_hand(recordings, tmp_path, "time: {rate_hz: 10}")
    assert check(copied(results, tmp_path / "data")) == 1
    said = " ".join(capsys.readouterr().out.split())
    assert "NO RESULT · positions 47 rests were found, and 25 stand as the one before" in said


def test_positions_by_hand_have_their_result(
    recordings: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    results = by_hand(recordings, tmp_path, "time: {rate_hz: 100}")
    check(copied(results, tmp_path / "data"))
    assert "NO RESULT" not in capsys.readouterr().out


def test_it_fits_into_a_terminal(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    change(data, "quality/findings", consequence="A result is not what it should be. " * 20)
    check(data)
    assert max(map(len, capsys.readouterr().out.splitlines())) <= LINE_WIDTH


def test_a_number_stays_in_one_line(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    change(data, "quality/findings", consequence=f"{'x' * 80} of 1\u202f576 ppm.")
    check(data)
    assert "1\u202f576 ppm" in capsys.readouterr().out


def test_what_spoils_a_result_is_told_by_the_exit_code(
    data: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    change(data, "quality/findings", severity=2)
    assert check(data) == 0
    change(data, "quality/findings", severity=3)
    assert check(data) == 1
    assert "2 spoil a result." in capsys.readouterr().out.splitlines()[-1]


def test_nothing_is_wrong(clean: list[Results], tmp_path: Path, capsys) -> None:
    data = copied(clean[0], tmp_path / "data")
    assert check(data) == 0
    assert capsys.readouterr().out.splitlines() == [
        "demo: 12 of 12 manoeuvres found, 12 complete.",
        "",
        "No cause of a fault was found in this recording.",
    ]


def test_what_is_no_fault_is_said_once_and_is_no_cause(
    clean: list[Results], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = copied(clean[0], tmp_path / "data")
    nothing = dict.fromkeys(column.name for column in tables.FINDINGS.columns)
    told = {"id": "segment/rests_divided", "cause": "rests_divided", "sensor": "accel"}
    told |= {"sentence": "24 rests lie in 6 stretches.", "consequence": "", "action": ""}
    told |= {"mount": "", "count": 6, "size": 24.0, "unit": "positions", "severity": 1}
    path = data / f"derived/{NAME}/segment/findings.parquet"
    path.unlink()
    write_once(tables.FINDINGS, path, tables.FINDINGS.frame([nothing | told]))
    assert check(data) == 0
    assert capsys.readouterr().out.splitlines() == [
        "demo: 12 of 12 manoeuvres found, 12 complete.",
        "24 rests lie in 6 stretches.",
        "",
        "No cause of a fault was found in this recording.",
    ]


def test_lines_that_cannot_be_read_are_not_passed_over(
    clean: list[Results], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = copied(clean[0], tmp_path / "data")
    change(data, "decode/accounts", kind="refused", lines=1)
    check(data)
    said = capsys.readouterr().out
    assert "1 line of x-up.asc cannot be read and is left out." in said
    assert "No cause, but 12 lines cannot be read." in said


def test_a_log_cannot_act_on_the_terminal(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    change(data, "quality/findings", log="a\x1b[2J\x07.asc", sentence="\x1b]0;title\x07 \x9b31m")
    check(data)
    said = capsys.readouterr().out
    assert all(letter.isprintable() or letter in "\n\u202f" for letter in said)
    assert "a�[2J�.asc" in said


def test_more_than_a_screenful_is_summed_up(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = data / f"derived/{NAME}/quality/findings.parquet"
    old = pq.read_table(path)
    many = pd.concat([old.to_pandas()] * 50)
    new = tables.FINDINGS.arrow(many)
    pq.write_table(new.replace_schema_metadata(old.schema.metadata), path)
    check(data)
    said = capsys.readouterr().out
    assert said.count("What it does: ") == 20
    assert "more: gap (" in said


def test_where_there_is_nothing_to_read(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert check(tmp_path) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"check: {tmp_path}/derived/demo/")
    assert "cure: " in said


@pytest.mark.slow
@pytest.mark.workflow
def test_a_campaign_that_names_no_log_is_refused_as_by_make_report(tmp_path: Path) -> None:
    raw = tmp_path / "data/raw" / NAME
    document = chain.short()
    chain.simulate(document, raw)
    (raw / "x-up.asc").rename(raw / "x_up.asc")
    goals = [f"data/derived/{NAME}/{stage}/parameters.parquet" for stage in SENSORS]
    command = [sys.executable, "-m", "snakemake", "--cores", "2", "--directory", str(tmp_path)]
    done = subprocess.run(
        [*command, "--snakefile", str(ROOT / "Snakefile"), "--", *goals],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode != 0
    said = done.stdout + done.stderr
    assert f"data/raw/{NAME}/campaign.yaml, line" in said
    assert "'x-up.asc'" in said
    assert "put the log there, or correct its name" in said
    assert check(tmp_path / "data") == 2


def test_a_session_of_one_manoeuvre_says_what_it_holds() -> None:
    """Of ten rests by hand "1 of 1 manoeuvre found" says nothing."""
    sentence = "10 rests of at least 1 s were found; their attitudes are unknown."
    said = as_text(Recording([], [], [Performed("positions", sentence)], {}), "cuyo")
    assert said.startswith(f"cuyo: {sentence}\n")


def test_what_a_force_does_to_a_bias_stands_beside_the_bias(data: Path) -> None:
    """5.66 × 10⁻⁵ (rad/s)/(m/s²) are 114 °/h at 1 g."""
    cause = {"id": "diagnosis/criticism/g", "unit": "(rad/s)/(m/s²)", "size": -5.66e-5}
    cause |= {"sensor": "gyro", "mount": "", "cause": "gyro_g_sensitivity"}
    path = data / f"derived/{NAME}/gyroscope/parameters.parquet"
    biases = pq.read_table(path).to_pandas().query("parameter.str.startswith('bias_')")["value"]
    largest = significant(float(np.degrees(biases.abs().max()) * 3600), 3)
    said = dict(_beside_bias([cause], path))
    assert said == {
        "criticism/g": "At 1 g it changes a bias by up to 114 °/h; "
        f"the largest bias is {largest} °/h."
    }
    assert not dict(_beside_bias([cause | {"unit": "1"}], path))
    rows = tables.PARAMETERS.read(path)
    terms = rows[rows["parameter"].str.startswith("bias_")].head(3)
    terms = terms.assign(effect="gyro_g_sensitivity")
    terms = terms.assign(parameter=["g_xy", "g_xz", "g_yx"], value=[1e-5, -1e-4, 2e-5])
    result = data / "result.parquet"
    write_once(tables.PARAMETERS, result, pd.concat([rows, terms], ignore_index=True))
    assert "by up to 202 °/h;" in dict(_beside_bias([cause], result))["criticism/g"]
