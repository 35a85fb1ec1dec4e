"""From a number to its lines: the trace names the right ones, and detects what has changed."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import chain
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from commands.trace import provenance
from commands.trace.__main__ import main
from inertial import tables
from inertial.campaign.records import parts_of, rows_of
from inertial.tables.code import code_of, hash_of, hash_of_file
from inertial.tables.parquet import Writer
from stages.extension import stage
from stages.history import stage as history

BIAS = "gyroscope/joint/bias_x"
REMARK = b"# the operator has opened the door\r\n"  # no message of the receiver: a line, no record
PLACE = re.compile(r"(\S+\.asc), line (\d+) \(from byte (\d+)\) to line (\d+) \(from byte (\d+)\)")
RECORDS = re.compile(r"(\S+): (\d+) blocks, (\d+) samples, records (\d+) to (\d+)")
WEEK = re.compile(r"GPS week (\d+), ([\d.]+) s to ([\d.]+) s")


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A data folder with a campaign of two rests and two turns about x, run to its archive.

    A remark stands before the first line of one log and in the middle of another.
    """
    data = tmp_path_factory.mktemp("trace") / "data"
    document = chain.demo(handling={"still_s": 5})
    document["start"] = {**document["start"], "pause_s": 10}
    plan = [
        {**item, "seconds": 15}
        if item["do"] == "rest"
        else {**item, "rate_deg_s": 60, "accel_deg_s2": 60}
        for item in document["campaign"]["plan"]
        if item["id"].startswith("x-")
    ]
    document["campaign"] = {**document["campaign"], "plan": plan}
    raw = chain.simulate(document, data / "raw/short")
    for log, line in (("x-up.asc", 0), ("x-forward.asc", 300)):
        lines = (raw / log).read_bytes().splitlines(keepends=True)
        (raw / log).write_bytes(b"".join([*lines[:line], REMARK, *lines[line:]]))
    derived = data / "derived/short"
    chain.run(raw, derived, until="studies")
    nothing = {name: stage.STAGE.writes[name] for name in ("parameters", "covariance")}
    with Writer(derived / "extension", nothing, made_by_extension) as writer:
        for name, table in nothing.items():
            writer.write(name, table.empty())
    made_by = made_by_extension() | {"stage": "diagnosis", "code": hash_of(code_of("diagnosis"))}
    none = {
        "result": tables.PARAMETERS,
        "covariance": tables.COVARIANCE,
        "verdict": tables.VERDICTS,
    }
    with Writer(derived / "diagnosis", none, lambda: made_by) as writer:
        for name, table in none.items():
            writer.write(name, table.empty())
    budget = {"uncertainty_budget": tables.UNCERTAINTY_BUDGET}
    with Writer(
        derived / "compensation", budget, lambda: made_by | {"stage": "compensation"}
    ) as writer:
        writer.write("uncertainty_budget", tables.UNCERTAINTY_BUDGET.empty())
    history.STAGE.run(derived, {"archive": [data / "history"]}, {"level": 0.01})
    return data


def made_by_extension(**inputs: str) -> dict[str, Any]:
    return {
        "stage": "extension",
        "settings": chain.SETTINGS.get("extension", {}),
        "code": hash_of(code_of("extension")),
        "inputs": inputs,
    }


@dataclass(frozen=True)
class Said:
    """What the command says, and its exit code."""

    code: int
    text: str

    def step(self, title: str) -> str:
        """The paragraph with this title."""
        (found,) = [part for part in self.text.split("\n\n") if part.partition("\n")[0] == title]
        return found


@pytest.fixture
def trace(data: Path, capsys: pytest.CaptureFixture[str]):
    def run(identifier: str = BIAS, *more: str, campaign: str = "short") -> Said:
        code = main([f"--campaign={campaign}", f"--id={identifier}", f"--data={data}", *more])
        captured = capsys.readouterr()
        return Said(code, captured.out + captured.err)

    return run


@contextmanager
def put_back(file: Path) -> Iterator[Path]:
    """Whatever is done to a file, afterwards it is as it was."""
    before = file.read_bytes()
    yield file
    file.write_bytes(before)


# ---- the way down


def test_every_link_is_intact_after_a_run(trace) -> None:
    said = trace()
    assert said.code == 0, said.text
    assert "Every link is intact" in said.text
    assert "CHANGED" not in said.text


def test_it_begins_with_the_number_and_its_method(trace, data: Path) -> None:
    said = trace()
    row = pq.read_table(data / "derived/short/gyroscope/parameters.parquet").to_pandas()
    row = row.set_index("id").loc[BIAS]
    number, plus_minus, unit = re.match(rf"{BIAS} = (\S+) ± (\S+) (\S+)\n", said.text).groups()
    assert float(number) == pytest.approx(row["value"], rel=1e-9)
    assert float(plus_minus) == pytest.approx(row["sigma"], rel=0.05)
    assert unit == "rad/s"
    assert "reading of the x gyro without input, frame: body" in said.text
    assert "averaging_steps: 20" in said.step("estimated by the stage gyroscope, method joint")
    assert "rest_block: 5.0" in said.text
    assert "degrees of freedom" in said.step("the fit of the stage gyroscope, method joint")


def test_the_lines_are_those_of_the_log(trace, data: Path) -> None:
    """Number, byte, time and text of each line against the log itself."""
    said = trace()
    fit = tables.FIT_MANOEUVRES.read(data / "derived/short/gyroscope/fit_manoeuvres.parquet")
    parts = parts_of(rows_of(fit[fit["method"] == "joint"]))
    labels = [part.label for part in parts if not part.reason]
    assert {"x-up", "x-down", "x-forward", "x-backward", "x-forward (rest-after)"} <= {*labels}
    seen = 0
    for label in labels:
        step = said.step(f"used: {label}")
        places, records, weeks = (found.findall(step) for found in (PLACE, RECORDS, WEEK))
        assert len(places) == len(records) == len(weeks) > 0
        for place, record, (week, *seconds) in zip(places, records, weeks, strict=True):
            path, *numbers = place
            assert Path(path) == data / f"raw/short/{label.partition(' ')[0]}.asc"
            lines = Path(path).read_bytes().splitlines(keepends=True)
            messages = [line for line in lines if line != REMARK]
            for line, byte, at, number in zip(
                numbers[::2], numbers[1::2], seconds, record[3:], strict=True
            ):
                text = lines[int(line) - 1]
                assert int(byte) == sum(map(len, lines[: int(line) - 1]))
                assert text == messages[int(number)]
                assert f"line {line}: {text.decode().rstrip()}\n" in f"{step}\n"
                _, _, _, text_week, text_seconds, *_ = re.split("[,;]", text.decode())
                assert text_week == week
                assert float(at) == pytest.approx(float(text_seconds), abs=1e-3)
            assert int(record[2]) == int(record[4]) - int(record[3]) + 1
            seen += 1
    assert seen > len(labels)  # a turn has several phases


def test_a_method_without_a_fit_of_its_own_says_so(trace) -> None:
    said = trace("gyroscope/turns/bias_x")
    assert said.code == 0
    assert "gyroscope, method turns, keeps no record of what it used" in said.text
    assert "used: x-forward\n" in said.text


def test_a_stage_without_a_fit_rests_on_those_behind_it(trace, data: Path) -> None:
    """As one does that refits with more effects what the gyroscope stage has found."""
    derived = data / "derived/short"
    parameters = pq.read_table(derived / "gyroscope/parameters.parquet").to_pandas()
    joint = parameters[parameters["method"] == "joint"]
    again = joint.assign(stage="extension", method="gyroscope")
    again["id"] = "extension/gyroscope/" + again["parameter"]
    read = ("gyroscope/parameters.parquet", "accelerometer/parameters.parquet")
    made_by = made_by_extension(**{file: hash_of_file(derived / file) for file in read})
    with put_back(derived / "extension/parameters.parquet"):
        with Writer(
            derived / "extension", {"parameters": tables.PARAMETERS}, lambda: made_by
        ) as writer:
            writer.write("parameters", again)
        (derived / "history").rename(data / "away")  # it was made from what the stage said before
        said = trace("extension/gyroscope/bias_x")
        (data / "away").rename(derived / "history")
    assert said.code == 0, said.text
    assert "extension, method gyroscope, keeps no record" in said.text
    assert "the fit of the stage gyroscope, method joint\n" in said.text
    assert "the fit of the stage accelerometer" not in said.text
    assert "used: x-forward\n" in said.text


def test_a_number_that_is_not_determined_says_why(trace) -> None:
    said = trace("gyroscope/joint/scale_z")
    assert said.text.startswith("gyroscope/joint/scale_z is not determined\n")
    assert "add one of 360° about z" in said.text


def test_an_unknown_number_lists_near_ones(trace) -> None:
    said = trace("gyroscope/join/bias_x")
    assert said.code == 1
    assert BIAS in said.text
    assert "no number 'gyroscope/join/bias_x'" in said.text
    of_any = trace("x").text
    assert "such as accelerometer/joint/" in of_any and of_any.count("joint/") <= 6


def test_a_campaign_without_results_says_how_to_get_them(trace) -> None:
    said = trace(campaign="other")
    assert said.code == 1
    assert "make report CAMPAIGN=other" in said.text


# ---- what has changed


@pytest.mark.parametrize("file", ["x-forward.asc", "campaign.yaml"])
def test_a_changed_byte_in_a_file_of_the_laboratory_is_noticed(
    trace, data: Path, file: str
) -> None:
    with put_back(data / "raw/short" / file) as path:
        content = bytearray(path.read_bytes())
        content[-20] ^= 1
        path.write_bytes(content)
        said = trace()
    assert said.code == 1
    assert f"{path} has changed since plan read it" in said.text
    assert "CHANGED" in said.step("read from the laboratory")
    others = {path.name for path in (data / "raw/short").iterdir()} - {file}
    assert not any(f"{other} has changed" in said.text for other in others)
    assert trace().code == 0


def test_a_log_that_is_gone_is_noticed(trace, data: Path) -> None:
    with put_back(data / "raw/short/x-up.asc") as path:
        path.unlink()
        said = trace()
    assert said.code == 1
    assert f"{path} is missing, which decode read." in said.text


@pytest.mark.parametrize(
    ("table", "column", "noticed"),
    [
        ("segment/blocks", "gyro_x", "since gyroscope read it"),
        ("decode/samples", "gyro_x", "since segment read it"),
        ("gyroscope/parameters", "value", "history/archived.parquet was made from it"),
        ("plan/inputs", "size", "history/archived.parquet was made from it"),
    ],
)
def test_a_changed_number_in_a_table_is_noticed(
    trace, data: Path, table: str, column: str, noticed: str
) -> None:
    with put_back(data / f"derived/short/{table}.parquet") as path:
        content = pq.read_table(path)
        values = content[column].to_pylist()
        values[0] = (values[0] or 0) * 2 + 1
        place = content.schema.get_field_index(column)
        field = content.schema.field(column)
        changed = content.set_column(place, field, pa.array(values, field.type))
        metadata = {b"made_by": pq.read_metadata(path).metadata[b"made_by"]}
        pq.write_table(changed.replace_schema_metadata(content.schema.metadata | metadata), path)
        said = trace()
    assert said.code == 1
    assert f"{path} has changed since" in said.text
    assert noticed in said.text


@pytest.mark.parametrize("table", ["segment/blocks", "decode/samples", "gyroscope/fit"])
def test_a_damaged_table_is_named_and_the_rest_is_told(trace, data: Path, table: str) -> None:
    with put_back(data / f"derived/short/{table}.parquet") as path:
        path.write_bytes(path.read_bytes()[:-100])
        said = trace()
    assert said.code == 1
    assert said.text.startswith(f"{BIAS} = ")
    assert f"{path} cannot be read" in said.text
    assert "read from the laboratory" in said.text


def test_where_no_table_says_what_was_used_the_chain_does_not_hold(trace, data: Path) -> None:
    with put_back(data / "derived/short/gyroscope/fit.parquet") as path:
        path.unlink()
        said = trace()
    assert said.code == 1
    assert f"No table says what {BIAS} was estimated from." in said.text


def test_a_table_that_another_program_wrote_is_noticed(trace, data: Path) -> None:
    with put_back(data / "derived/short/gyroscope/parameters.parquet") as path:
        pq.write_table(pq.read_table(path), path)
        said = trace()
    assert said.code == 1
    assert f"{path} has no provenance" in said.text


def test_a_table_of_another_run_is_noticed(trace, data: Path) -> None:
    """The fit is read by no stage that would have noted its hash."""
    with put_back(data / "derived/short/gyroscope/fit.parquet") as path:
        content = pq.read_table(path)
        metadata = pq.read_metadata(path).metadata
        older = metadata[b"made_by"].replace(b'"averaging_steps": 20', b'"averaging_steps": 19')
        changed = {**content.schema.metadata, b"made_by": older}
        pq.write_table(content.replace_schema_metadata(changed), path)
        said = trace()
    assert said.code == 1
    assert f"{path} and " in said.text
    assert "of different runs of gyroscope" in said.text


def test_a_changed_setting_is_noticed(trace, tmp_path: Path) -> None:
    text = (chain.ROOT / "config.yaml").read_text(encoding="utf-8")
    config = tmp_path / "config.yaml"
    config.write_text(text.replace("rest_block: 5.0", "rest_block: 2.5"), encoding="utf-8")
    said = trace(BIAS, f"--config={config}")
    assert said.code == 1
    assert "The setting rest_block of segment has changed" in said.text
    assert "was 5.0, is 2.5" in said.text


def test_changed_code_is_noticed(trace, monkeypatch: pytest.MonkeyPatch) -> None:
    def of_other_code(files: list[Path]) -> str:
        return "0" * 64 if files == code_of("gyroscope") else hash_of(files)

    monkeypatch.setattr(provenance, "hash_of", of_other_code)
    said = trace()
    assert said.code == 1
    assert "The code of gyroscope has changed since its tables were made" in said.text
    assert "The code of noise" not in said.text


# ---- make


@pytest.mark.parametrize(
    "identifier",
    [
        "gyroscope/joint@a/bias_x",
        "",
        "a b",
        "--help",
        "$(touch run)",
        "`touch run`",
        "$(shell touch run)",
        "x; touch run",
        "'\"; touch run",
        "x\ntouch run",
    ],
)
def test_make_hands_the_identifier_on_word_for_word(tmp_path: Path, identifier: str) -> None:
    """With a Python that only notes its arguments."""
    shutil.copy(chain.ROOT / "Makefile", tmp_path)
    (tmp_path / ".venv/bin").mkdir(parents=True)
    (tmp_path / "requirements.lock").touch()
    (tmp_path / ".venv/complete").touch()
    python = tmp_path / ".venv/bin/python"
    python.write_text('#!/bin/sh\n[ "$1" = -c ] || printf "%s\\0" "$@" > arguments\n')
    python.chmod(0o755)
    inherited = ("MAKEFLAGS", "MAKELEVEL", "MFLAGS", "MAKEOVERRIDES", "CAMPAIGN", "ID")
    env = {name: value for name, value in os.environ.items() if name not in inherited}
    make = ["make", "trace", f"ID={identifier}"]
    done = subprocess.run(make, cwd=tmp_path, env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    given = (tmp_path / "arguments").read_text().split("\0")[:-1]
    assert given == ["-m", "turntable_calibration", "trace", "--", "demo", identifier]
    assert not (tmp_path / "run").exists()
