"""The archive: a calibration is kept once and for ever, whoever else writes at the same time."""

from __future__ import annotations

import json
import multiprocessing
import os
import signal
import time
from collections.abc import Sequence
from dataclasses import replace
from multiprocessing.synchronize import Barrier
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from inertial import tables
from inertial.tables.errors import Refusal
from inertial.tables.parquet import Table, Writer, provenance, write_once
from stages.history.archive import Archive, file_name
from stages.history.stage import STAGE

Row = dict[str, Any]
SPAWN = multiprocessing.get_context("spawn")  # a fork would copy Arrow's threads
ROUNDS = 25
PATIENCE = 60  # s, until another process must have begun

EMPTY = {pa.string(): "", pa.bool_(): False, pa.int64(): 0}
CAMPAIGN: Row = {
    **{c.name: None if c.nullable else EMPTY[c.type] for c in tables.CAMPAIGN.columns},
    "campaign": "spring",
    "simulated": False,
    "instrument": "span-cpt",
    "serial": "A-017",
    "date": "2026-03-02",
    "table": "three-axis",
}
SETTINGS = {"averaging_steps": 20}


def parameter(name: str, value: float | None, sigma: float | None, method: str = "joint") -> Row:
    return {
        "id": f"gyroscope/{method}/{name}",
        "stage": "gyroscope",
        "mount": "",
        "sensor": "gyro",
        "method": method,
        "effect": None,
        "parameter": name,
        "value": value,
        "sigma": sigma,
        "unit": "rad/s",
        "frame": "body",
        "meaning": "reading without input",
        "reason": "" if value is not None else "not recorded",
    }


def calibration(
    bias: float = 1e-5, settings: Row = SETTINGS, code: str = "c0", **facts: Any
) -> Row:
    """A row of the archive as the stage makes it, but for what the archive adds."""
    maker = {"stage": "gyroscope", "settings": json.dumps(settings), "code": code, "inputs": "{}"}
    return {
        **CAMPAIGN,
        **facts,
        "parameters": [parameter("bias_x", bias, 1e-7), parameter("bias_y", None, None)],
        "covariance": [],
        "inputs": [{"file": "x-up.asc", "size": 9, "sha256": "ab"}],
        "made_by": [maker],
    }


def files(root: Path) -> set[str]:
    return {str(path.relative_to(root)) for path in root.rglob("*") if path.is_file()}


# ---- the stage


def write(folder: Path, name: str, table: Table, rows: Sequence[Row], made_by: Row) -> None:
    with Writer(folder, {name: table}, lambda: made_by) as writer:
        writer.write(name, pd.DataFrame(list(rows)) if rows else table.empty())


def run(
    place: Path, bias: float = 1e-5, code: str = "c0", extended: float | None = None, **facts: Any
) -> Row:
    """Run the stage on a campaign in `place`, into the archive there; its row of `archived`.

    `extended`: the bias with an effect in the model, whose result then counts.
    """
    campaign = CAMPAIGN | facts
    derived = place / "derived" / str(campaign["campaign"])
    by = {"settings": {}, "code": code, "inputs": {}}
    plan, gyro = (by | {"stage": stage} for stage in ("plan", "gyroscope"))
    log = {"file": "x-up.asc", "size": 9, "sha256": "ab"}
    write(derived / "plan", "campaign", tables.CAMPAIGN, [campaign], plan)
    write(derived / "plan", "inputs", tables.INPUTS, [log], plan)
    estimates = [
        parameter("bias_x", bias, 1e-7),
        parameter("bias_y", None, None),
        parameter("bias_x", bias + 1e-9, 2e-7, method="turns"),
    ]
    spread = [
        {"first": row["id"], "second": row["id"], "covariance": row["sigma"] ** 2}
        for row in estimates
        if row["sigma"]
    ]
    for stage, rows, product in (("accelerometer", [], []), ("gyroscope", estimates, spread)):
        write(derived / stage, "parameters", tables.PARAMETERS, rows, gyro | {"stage": stage})
        write(derived / stage, "covariance", tables.COVARIANCE, product, gyro | {"stage": stage})
    better = {"id": "extension/gyroscope/bias_x", "stage": "extension", "method": "extended"}
    rows = [] if extended is None else [parameter("bias_x", extended, 2e-7) | better]
    product = [{"first": r["id"], "second": r["id"], "covariance": r["sigma"] ** 2} for r in rows]
    by_extension = gyro | {"stage": "extension"}
    write(derived / "extension", "parameters", tables.PARAMETERS, rows, by_extension)
    write(derived / "extension", "covariance", tables.COVARIANCE, product, by_extension)
    verdict = {"mount": "", "sensor": "gyro", "verdict": "usable", "sentence": "It counts."}
    verdict |= {"method": "extended" if rows else "joint", "condition": None, "reason": ""}
    by_diagnosis = gyro | {"stage": "diagnosis"}
    write(derived / "diagnosis", "verdict", tables.VERDICTS, [verdict], by_diagnosis)
    STAGE.run(derived, {"archive": [place / "history"]}, {})
    return dict(pd.read_parquet(derived / "history/archived.parquet").iloc[0])


def earlier(place: Path, campaign: str) -> pd.DataFrame:
    return pd.read_parquet(place / "derived" / campaign / "history/earlier.parquet")


def test_the_file_holds_the_calibration_and_what_it_was_made_from(tmp_path: Path) -> None:
    archived = run(tmp_path)
    assert files(tmp_path / "history") == {archived["file"]}
    assert Path(archived["file"]).parent == Path("span-cpt/A-017")
    assert Path(archived["file"]).name.startswith("2026-03-02-spring-")
    held = tables.CALIBRATION.read(tmp_path / "history" / archived["file"]).iloc[0]
    assert (held["campaign"], held["instrument"], held["serial"]) == ("spring", "span-cpt", "A-017")
    by_id = {row["id"]: row for row in held["parameters"]}
    assert by_id["gyroscope/joint/bias_x"]["value"] == 1e-5
    assert by_id["gyroscope/joint/bias_x"]["unit"] == "rad/s"
    assert by_id["gyroscope/joint/bias_x"]["frame"] == "body"
    assert by_id["gyroscope/joint/bias_y"]["value"] is None
    assert by_id["gyroscope/turns/bias_x"]["sigma"] == 2e-7
    (variance,) = held["covariance"]  # of the joint method alone
    assert variance["first"] == "gyroscope/joint/bias_x"
    assert variance["covariance"] == pytest.approx(1e-14)
    assert [(row["file"], row["sha256"]) for row in held["inputs"]] == [("x-up.asc", "ab")]
    assert {row["stage"] for row in held["made_by"]} == {"plan", "accelerometer", "gyroscope"}


def test_the_same_content_writes_nothing(tmp_path: Path) -> None:
    first = run(tmp_path)
    file = tmp_path / "history" / first["file"]
    before = (file.read_bytes(), file.stat().st_mtime_ns)
    again = run(tmp_path, code="c1")  # a program that was only tidied up
    assert again == first
    assert files(tmp_path / "history") == {first["file"]}
    assert (file.read_bytes(), file.stat().st_mtime_ns) == before


def test_changed_content_adds_a_file_that_names_the_one_it_supersedes(tmp_path: Path) -> None:
    first = run(tmp_path)
    before = (tmp_path / "history" / first["file"]).read_bytes()
    second = run(tmp_path, bias=2e-5)
    assert second["supersedes"] == first["file"] != second["file"]
    assert files(tmp_path / "history") == {first["file"], second["file"]}
    assert (tmp_path / "history" / first["file"]).read_bytes() == before
    held = tables.CALIBRATION.read(tmp_path / "history" / second["file"]).iloc[0]
    assert list(held["supersedes"]) == [first["file"]]


def test_the_report_gets_the_earlier_calibrations_of_the_same_imu(tmp_path: Path) -> None:
    run(tmp_path, bias=1e-5, campaign="spring", date="2026-03-02")
    held = run(tmp_path, bias=2e-5, campaign="spring", date="2026-03-02")  # it supersedes the first
    run(tmp_path, bias=3e-5, campaign="other-imu", serial="A-018")
    run(tmp_path, bias=4e-5, campaign="simulated", simulated=True)
    run(tmp_path, bias=0.0, campaign="compensated", compensated=True)
    run(tmp_path, bias=5e-5, campaign="winter", date="2026-12-02")
    run(tmp_path, bias=6e-5, campaign="autumn", date="2026-10-02")
    (row,) = earlier(tmp_path, "autumn").to_dict("records")
    assert row == {
        "campaign": "spring",
        "date": "2026-03-02",
        "file": held["file"],
        "id": "gyroscope/joint/bias_x",
        "mount": "",
        "sensor": "gyro",
        "quantity": "bias_x",
        "value": 2e-5,
        "sigma": 1e-7,
        "unit": "rad/s",
    }


def test_the_extended_result_is_kept_beside_the_joint_one_and_compared_later(
    tmp_path: Path,
) -> None:
    held = run(tmp_path, bias=1e-5, extended=3e-5, campaign="spring", date="2026-03-02")
    entry = tables.CALIBRATION.read(tmp_path / "history" / held["file"]).iloc[0]
    by_id = {row["id"]: row for row in entry["parameters"]}
    assert by_id["gyroscope/joint/bias_x"]["value"] == 1e-5
    assert by_id["extension/gyroscope/bias_x"]["value"] == 3e-5
    assert {row["first"] for row in entry["covariance"]} == {
        "gyroscope/joint/bias_x",
        "extension/gyroscope/bias_x",
    }
    assert "extension" in {row["stage"] for row in entry["made_by"]}
    run(tmp_path, bias=2e-5, campaign="autumn", date="2026-10-02")
    (then,) = earlier(tmp_path, "autumn").to_dict("records")
    assert (then["id"], then["value"], then["sigma"]) == ("gyroscope/joint/bias_x", 3e-5, 2e-7)


def test_a_file_of_version_1_is_read_by_its_identifiers(tmp_path: Path) -> None:
    """It had neither mount nor sensor nor parameter, and the mount in the method."""
    ids = {
        "gyroscope/joint@a/bias_x": "joint@a",
        "gyroscope/joint@a/bias_y": "joint@a",
        "gyroscope/turns@a/bias_x": "turns@a",
        "extension/gyroscope@a/bias_x": "gyroscope@a",
        "extension/gyroscope@a/gyro_bias_ramp.c_x": "gyroscope@a",
    }
    numbers = {"sigma": 1e-7, "unit": "rad/s", "frame": "body", "meaning": "", "reason": ""}
    (nested,) = (column for column in tables.CALIBRATION.columns if column.name == "parameters")
    kept = tuple(f for f in nested.type if f.name not in ("mount", "sensor", "parameter"))
    older = replace(
        tables.CALIBRATION,
        version=1,
        columns=tuple(
            replace(column, type=kept) if column is nested else column
            for column in tables.CALIBRATION.columns
        ),
    )
    rows = [
        {"id": i, "method": m, "value": 1e-6 * n, **numbers} for n, (i, m) in enumerate(ids.items())
    ]
    row = calibration(campaign="spring", date="2026-03-02") | {"parameters": rows}
    folder = tmp_path / "history/span-cpt/A-017"
    write_once(
        older,
        folder / "2026-03-02-spring-0123456789ab.parquet",
        [row | {"content": "", "supersedes": []}],
    )
    run(tmp_path, campaign="autumn", date="2026-10-02")
    found = earlier(tmp_path, "autumn").set_index("id")
    assert list(found.index) == ["gyroscope/joint@a/bias_x", "gyroscope/joint@a/bias_y"]
    assert list(found["value"]) == [3e-6, 1e-6]
    assert set(found["mount"]) == {"a"} and set(found["sensor"]) == {"gyro"}
    assert list(found["quantity"]) == ["bias_x", "bias_y"]


def test_imus_without_a_serial_number_are_not_taken_for_one(tmp_path: Path) -> None:
    for campaign in ("first", "second"):
        archived = run(tmp_path, campaign=campaign, serial="unknown", date="unknown")
        assert Path(archived["file"]).parent == Path("span-cpt/unknown")
        assert Path(archived["file"]).name.startswith(f"unknown-{campaign}-")
    assert earlier(tmp_path, "second").empty


def test_a_file_that_cannot_be_read_is_named_and_not_to_be_deleted(tmp_path: Path) -> None:
    first = run(tmp_path)
    file = tmp_path / "history" / first["file"]
    file.write_bytes(file.read_bytes()[:1000])
    with pytest.raises(Refusal) as refused:
        run(tmp_path, bias=2e-5)
    assert str(file) in str(refused.value)
    assert "delete" not in str(refused.value)


# ---- what holds good


@pytest.mark.parametrize(
    "changed",
    [
        calibration(bias=1e-5 * (1 + 1e-15)),
        calibration(settings={"averaging_steps": 21}),
        calibration(date="2026-03-03"),
        calibration() | {"inputs": [{"file": "x-up.asc", "size": 9, "sha256": "cd"}]},
        calibration() | {"covariance": [{"first": "a", "second": "b", "covariance": 0.1}]},
    ],
    ids=["number", "setting", "date", "log", "covariance"],
)
def test_what_makes_it_another_calibration(tmp_path: Path, changed: Row) -> None:
    archive = Archive(tmp_path, simulated=False)
    first = archive.add(calibration())
    second = archive.add(changed)
    assert list(second.row["supersedes"]) == [first.file]


def test_going_back_to_an_older_content_is_a_new_file(tmp_path: Path) -> None:
    archive = Archive(tmp_path, simulated=False)
    first, second, third = (archive.add(calibration(bias)) for bias in (1e-5, 2e-5, 1e-5))
    assert list(third.row["supersedes"]) == [second.file]
    assert first.row["content"] == third.row["content"]
    assert [entry.file for entry in archive.current("spring")] == [third.file]


def test_a_corrected_serial_number_takes_the_calibration_to_the_right_imu(tmp_path: Path) -> None:
    archive = Archive(tmp_path, simulated=False)
    mistyped = archive.add(calibration(serial="A-071"))
    corrected = archive.add(calibration(serial="A-017"))
    assert list(corrected.row["supersedes"]) == [mistyped.file]
    assert archive.earlier(calibration(serial="A-071", campaign="next", date="2027-01-01")) == []


def test_simulated_campaigns_are_kept_apart(tmp_path: Path) -> None:
    real = Archive(tmp_path, simulated=False).add(calibration())
    simulated = Archive(tmp_path, simulated=True).add(calibration(bias=2e-5, simulated=True))
    assert simulated.file.startswith("simulated/span-cpt/A-017/")
    assert list(simulated.row["supersedes"]) == []
    assert [e.file for e in Archive(tmp_path, simulated=False).current("spring")] == [real.file]
    odd = Archive(tmp_path, simulated=False).add(calibration(instrument="simulated"))
    assert not odd.file.startswith("simulated/")


# ---- names from outside

EVIL = [
    *("..", ".", "../../etc/passwd", "/root", "a/b", "a\\b", "A 17", "A+17", "A%2017", ".hidden"),
    *("~", "-rf", "*", "a\nb", "a\0b", "Prüfling 7", "日本", "simulated", "x.parquet", "*-[0-9]"),
    *("x" * 300, "x" * 299 + "y", "日" * 300, "2026-01-01-spring-0123456789ab.parquet"),
]


def test_a_name_from_outside_never_leaves_its_place(tmp_path: Path) -> None:
    archive = Archive(tmp_path / "history", simulated=False)
    folders = set()
    for serial in EVIL:
        entry = archive.add(calibration(serial=serial, instrument=serial, campaign=serial))
        path = (tmp_path / "history" / entry.file).resolve()
        assert path.parents[2] == (tmp_path / "history").resolve()
        assert entry.row["serial"] == serial
        assert [held.file for held in archive.current(serial)] == [entry.file]
        folders.add(path.parent)
    assert len(folders) == len(EVIL)
    assert [path.name for path in tmp_path.iterdir()] == ["history"]


@given(st.text(st.characters(exclude_categories=["Cs"])), st.text(alphabet="aA.~%+/ -é"))
def test_names_are_safe_and_differ_where_the_texts_do(one: str, other: str) -> None:
    for text in (one, other):
        name = file_name(text)
        assert name == file_name(text)
        assert len(name.encode()) <= 100
        assert not name.startswith(".")
        assert not set(name) & set("/\\\0 \n*?[")
        assert name != "simulated"
    assert (file_name(one) == file_name(other)) == (one == other)


# ---- several at once


def add_together(
    root: Path, biases: Sequence[float], campaigns: Sequence[str], gate: Barrier
) -> None:
    """One of several processes, which all add their next calibration at the same moment."""
    for bias, campaign in zip(biases, campaigns, strict=True):
        gate.wait(PATIENCE)
        Archive(root, simulated=False).add(calibration(bias, campaign=campaign))


def test_two_at_once_do_no_harm(tmp_path: Path) -> None:
    alike = [f"alike-{i}" for i in range(ROUNDS)]
    apart = [f"apart-{i}" for i in range(ROUNDS)]
    own = [[f"{name}-{i}" for i in range(ROUNDS)] for name in ("left", "right")]
    gate = SPAWN.Barrier(2)
    both = [
        SPAWN.Process(
            target=add_together,
            args=(
                tmp_path,
                [1e-5] * ROUNDS + [bias] * ROUNDS + [1e-5] * ROUNDS,
                [*alike, *apart, *names],
                gate,
            ),
        )
        for bias, names in zip((2e-5, 3e-5), own, strict=True)
    ]
    for process in both:
        process.start()
    for process in both:
        process.join(PATIENCE)
        assert process.exitcode == 0
    assert all(name.endswith(".parquet") for name in files(tmp_path))
    archive = Archive(tmp_path, simulated=False)
    for campaign in (*alike, *own[0], *own[1]):
        assert len(list(tmp_path.glob(f"*/*/*-{campaign}-*"))) == 1
        assert len(archive.current(campaign)) == 1
    for campaign in apart:  # one after the other, or both
        held = archive.current(campaign)
        assert len(list(tmp_path.glob(f"*/*/*-{campaign}-*"))) == 2
        last = archive.add(calibration(4e-5, campaign=campaign))
        assert set(last.row["supersedes"]) == {entry.file for entry in held}
        assert [entry.file for entry in archive.current(campaign)] == [last.file]


def add_many(root: Path, number: int) -> None:
    for i in range(number):
        Archive(root, simulated=False).add(calibration(campaign=f"campaign-{i}"))


def test_a_kill_leaves_nothing_half_written(tmp_path: Path) -> None:
    killed, whole, number = tmp_path / "killed", tmp_path / "whole", 60
    process = SPAWN.Process(target=add_many, args=(killed, 10_000))
    process.start()
    until = time.monotonic() + PATIENCE
    while len(list(killed.glob("*/*/*.parquet"))) < number // 2:
        assert time.monotonic() < until
    assert process.pid is not None
    os.kill(process.pid, signal.SIGKILL)
    process.join()
    for path in killed.glob("*/*/*.parquet"):
        tables.CALIBRATION.read(path)
    done = len(list(killed.glob("*/*/*.parquet")))
    for root in (killed, whole):
        add_many(root, max(number, done))
    assert {name for name in files(killed) if not name.endswith(".part")} == files(whole)
    assert all((killed / name).read_bytes() == (whole / name).read_bytes() for name in files(whole))


def test_the_part_of_a_file_that_could_not_be_finished_is_taken_away(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(self: Path, target: Path) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "hardlink_to", full)
    with pytest.raises(OSError, match="No space"):
        Archive(tmp_path, simulated=False).add(calibration())
    assert files(tmp_path) == set()


def test_tables_of_the_stage_say_what_made_them(tmp_path: Path) -> None:
    run(tmp_path)
    made_by = provenance(tmp_path / "derived/spring/history/archived.parquet")
    assert made_by["stage"] == "history"
    assert "gyroscope/covariance.parquet" in made_by["inputs"]
