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

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from inertial import tables
from inertial.campaign.records import rows_of
from inertial.tables.errors import Refusal
from inertial.tables.parquet import Table, Writer, provenance, write_once
from stages.history import archive
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


def verdict(verdict: str = "usable", condition: str | None = None) -> Row:
    return {
        "mount": "",
        "sensor": "gyro",
        "recorded": True,
        "verdict": verdict,
        "sentence": "It is usable.",
        "method": "extended",
        "condition": condition,
        "reason": "held-out manoeuvres gain",
    }


def counted(name: str, value: float | None, sigma: float | None) -> Row:
    """A row of the result that counts."""
    row = parameter(name, value, sigma, method="extended")
    return row | {"id": f"diagnosis/gyroscope/{name}", "stage": "diagnosis"}


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
        "references": [],
        "verdicts": [verdict()],
        "inputs": [{"file": "x-up.asc", "size": 9, "sha256": facts.get("campaign", "ab")}],
        "made_by": [maker],
    }


def files(root: Path) -> set[str]:
    return {str(path.relative_to(root)) for path in root.rglob("*") if path.is_file()}


# ---- the stage


def write(folder: Path, name: str, table: Table, rows: Sequence[Row], made_by: Row) -> None:
    with Writer(folder, {name: table}, lambda: made_by) as writer:
        writer.write(name, pd.DataFrame(list(rows)) if rows else table.empty())


def run(
    place: Path,
    bias: float = 1e-5,
    code: str = "c0",
    verdicts: Sequence[Row] = (),
    published: Sequence[Row] = (),
    settings: Row | None = None,
    may_change: Sequence[Row] = (),
    further: Sequence[Row] = (),
    recorded: str = "",
    **facts: Any,
) -> Row:
    """Run the stage on a campaign in `place`, into the archive there; its row of `archived`.

    `bias`: by the result that counts, by the joint method half as much; `further`: rows of that
    result; `recorded`: the hash of its log, one of its own where none is given.
    """
    campaign = CAMPAIGN | facts
    derived = place / "derived" / str(campaign["campaign"])
    by = {"settings": {}, "code": code, "inputs": {}}
    log = {"file": "x-up.asc", "size": 9, "sha256": recorded or str(campaign["campaign"])}
    estimates = [
        parameter("bias_x", bias / 2, 1e-7),
        parameter("bias_y", None, None),
        parameter("bias_x", bias + 1e-9, 2e-7, method="turns"),
    ]
    result = [counted("bias_x", bias, 1e-7), counted("bias_y", None, None)]
    effect = counted("gyro_bias_ramp.c_x", 1e-9, 1e-10) | {"effect": "gyro_bias_ramp"}
    own = result[0]["id"]
    made: dict[str, dict[str, tuple[Table, Sequence[Row]]]] = {
        "plan": {
            "campaign": (tables.CAMPAIGN, [campaign]),
            "inputs": (tables.INPUTS, [log]),
            "published": (tables.PUBLISHED, published),
            "allowed_changes": (tables.ALLOWED_CHANGES, may_change),
            "known": (tables.KNOWN, []),
        },
        "accelerometer": {"parameters": (tables.PARAMETERS, []), "fit": (tables.FIT, [])},
        "gyroscope": {"parameters": (tables.PARAMETERS, estimates), "fit": (tables.FIT, [])},
        "segment": {"blocks": (tables.BLOCKS, []), "manoeuvres": (tables.MANOEUVRES, [])},
        "compensation": {"uncertainty_budget": (tables.UNCERTAINTY_BUDGET, [])},
        "studies": {"growing": (tables.WINDOWS, []), "motions": (tables.MOTIONS, [])},
        "diagnosis": {
            "result": (tables.PARAMETERS, [*result, effect, *further]),
            "covariance": (
                tables.COVARIANCE,
                [{"first": own, "second": own, "covariance": 1e-14}],
            ),
            "verdict": (tables.VERDICTS, verdicts or [verdict()]),
        },
    }
    for stage, each in made.items():
        for name, (table, rows) in each.items():
            write(derived / stage, name, table, rows, by | {"stage": stage})
    STAGE.run(derived, {"archive": [place / "history"]}, settings or {"level": 0.01})
    return dict(pd.read_parquet(derived / "history/archived.parquet").iloc[0])


def changes_of(place: Path, campaign: str) -> pd.DataFrame:
    return pd.read_parquet(place / f"derived/{campaign}/history/changes.parquet")


def test_what_changed_since_the_last_calibration_is_a_row_each(tmp_path: Path) -> None:
    """By 30 σ of the difference, √2 · 1e-7; against the latest before, not the latest that came."""
    for bias, date in ((1.0e-5, "2024-01-02"), (9.0e-5, "2026-01-02")):
        run(tmp_path, bias, campaign=f"on-{date}", date=date)
    run(tmp_path, 1.0e-5 + 30 * 2**0.5 * 1e-7, campaign="between", date="2025-01-02")
    (row,) = pd.read_parquet(tmp_path / "derived/between/history/changes.parquet").to_dict(
        "records"
    )
    assert (row["quantity"], row["since_campaign"]) == ("bias_x", "on-2024-01-02")
    assert row["size"] / row["sigma"] == pytest.approx(30) and row["beyond"]
    assert changes_of(tmp_path, "on-2024-01-02").empty


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
    assert by_id["diagnosis/gyroscope/bias_x"]["value"] == 1e-5
    assert by_id["gyroscope/joint/bias_x"]["value"] == 5e-6
    assert by_id["gyroscope/joint/bias_x"]["unit"] == "rad/s"
    assert by_id["gyroscope/joint/bias_x"]["frame"] == "body"
    assert by_id["gyroscope/joint/bias_y"]["value"] is None
    assert by_id["gyroscope/turns/bias_x"]["sigma"] == 2e-7
    assert by_id["diagnosis/gyroscope/gyro_bias_ramp.c_x"]["effect"] == "gyro_bias_ramp"
    (variance,) = held["covariance"]  # of the result that counts alone
    assert variance["first"] == "diagnosis/gyroscope/bias_x"
    kept = {key: value for key, value in verdict().items() if key != "recorded"}
    assert list(held["verdicts"]) == [kept]
    assert variance["covariance"] == pytest.approx(1e-14)
    assert [(row["file"], row["sha256"]) for row in held["inputs"]] == [("x-up.asc", "spring")]
    assert {row["stage"] for row in held["made_by"]} == {
        *("plan", "accelerometer", "gyroscope", "diagnosis")
    }


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
    (row,) = rows_of(earlier(tmp_path, "autumn"))
    assert row == {
        "campaign": "spring",
        "date": "2026-03-02",
        "table": "three-axis",
        "file": held["file"],
        "id": "diagnosis/gyroscope/bias_x",
        "mount": "",
        "sensor": "gyro",
        "quantity": "bias_x",
        "value": 2e-5,
        "sigma": 1e-7,
        "unit": "rad/s",
        "verdict": "usable",
        "condition": None,
    }


def test_the_same_logs_once_more_are_no_earlier_calibration(tmp_path: Path) -> None:
    """As with a repair confirmed: they would repeat to the last digit."""
    run(tmp_path, campaign="spring", recorded="one log", date="2026-04-01")
    run(tmp_path, campaign="accepted", recorded="one log", date="2026-04-01")
    run(tmp_path, campaign="autumn", date="2026-10-02")
    assert earlier(tmp_path, "accepted").empty
    assert len(set(earlier(tmp_path, "autumn")["campaign"])) == 1


def test_the_condition_of_an_earlier_result_is_handed_on(tmp_path: Path) -> None:
    wired = "the y gyro is wired in reverse"
    run(tmp_path, verdicts=[verdict("on_condition", wired)], campaign="spring")
    run(tmp_path, bias=2e-5, campaign="autumn", date="2026-10-02")
    (row,) = rows_of(earlier(tmp_path, "autumn"))
    assert (row["verdict"], row["condition"]) == ("on_condition", wired)


def test_each_file_of_the_archive_is_read_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for number in range(4):
        Archive(tmp_path, simulated=False).add(calibration(campaign=f"c{number}"))
    read: list[Path] = []
    row_of = archive._row
    monkeypatch.setattr(archive, "_row", lambda path: read.append(path) or row_of(path))
    kept = Archive(tmp_path, simulated=False)
    kept.add(calibration(campaign="c9"))
    assert len(kept.earlier(calibration(campaign="c9"))) == 4
    assert len(read) == len(set(read)) == 5


def test_another_verdict_is_another_calibration(tmp_path: Path) -> None:
    first = run(tmp_path)
    second = run(tmp_path, verdicts=[verdict("on_condition", "as wired")])
    assert second["supersedes"] == first["file"]


# ---- archives of older versions: what they lacked


def older(version: int, *lacking: str) -> Table:
    """The contract of an older version, whose parameters lacked some of the columns."""
    return replace(
        tables.CALIBRATION,
        version=version,
        columns=tuple(
            replace(column, type=tuple(f for f in column.type if f.name not in lacking))
            if column.name == "parameters"
            else column
            for column in tables.CALIBRATION.columns
            if column.name not in ("verdicts", "references")
        ),
    )


def archived_as(version: Table, place: Path, parameters: Sequence[Row]) -> None:
    """A calibration of spring in the archive as an older version wrote it."""
    facts = calibration(campaign="spring", date="2026-03-02") | {"content": "", "supersedes": []}
    del facts["verdicts"], facts["references"]
    file = place / "history/span-cpt/A-017/2026-03-02-spring-0123456789ab.parquet"
    write_once(version, file, [facts | {"parameters": parameters}])


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
    rows = [
        {"id": i, "method": m, "value": 1e-6 * n, **numbers} for n, (i, m) in enumerate(ids.items())
    ]
    version = older(1, "stage", "effect", "mount", "sensor", "parameter")
    archived_as(version, tmp_path, rows)
    run(tmp_path, campaign="autumn", date="2026-10-02")
    found = earlier(tmp_path, "autumn").set_index("id")
    assert list(found.index) == ["gyroscope/joint@a/bias_x", "gyroscope/joint@a/bias_y"]
    assert list(found["value"]) == [3e-6, 1e-6]
    assert set(found["mount"]) == {"a"} and set(found["sensor"]) == {"gyro"}
    assert list(found["quantity"]) == ["bias_x", "bias_y"]
    assert found["verdict"].isna().all()


def test_of_a_file_of_version_2_the_extended_result_counts_where_there_is_one(
    tmp_path: Path,
) -> None:
    """It had no verdict, and no rows of the result that counts."""
    extended = parameter("bias_x", 3e-5, 2e-7, method="extended")
    rows = [
        parameter("bias_x", 1e-5, 1e-7),
        parameter("bias_z", 4e-5, 1e-7),
        parameter("bias_x", 9e-5, 1e-7, method="turns"),
        extended | {"id": "extension/gyroscope/bias_x"},
    ]
    archived_as(older(2, "stage", "effect"), tmp_path, rows)
    run(tmp_path, campaign="autumn", date="2026-10-02")
    found = earlier(tmp_path, "autumn").set_index("quantity")
    assert dict(found["value"]) == {"bias_x": 3e-5, "bias_z": 4e-5}
    assert found.loc["bias_x", "id"] == "gyroscope/joint/bias_x"
    assert found.loc["bias_x", "sigma"] == 2e-7


# ---- what others published


def told(place: Path, value: float, sigma: float | None = None, name: str = "bias_x") -> Row:
    """The difference of the result from one published value."""
    other = dict.fromkeys(("window", "samples")) | {"sensor": "gyro", "unit": "rad/s"}
    other |= {"quantity": name, "value": value, "sigma": sigma, "source": "data sheet"}
    run(place, bias=1e-5, published=[other])
    (row,) = pd.read_parquet(
        place / "derived/spring/history/published_differences.parquet"
    ).to_dict("records")
    return {str(key): value for key, value in row.items()}


def test_published_values_are_held_against_the_result_that_counts(tmp_path: Path) -> None:
    """The joint method has half of it: against that one the published value would be far off."""
    agrees = told(tmp_path, 1.01e-5, 3e-7)
    assert agrees["first"] == "diagnosis/gyroscope/bias_x"
    assert agrees["in_sigmas"] == pytest.approx(-1e-7 / np.hypot(1e-7, 3e-7))
    assert not agrees["significant"]
    far = told(tmp_path, 0.5e-5)
    assert far["in_sigmas"] == pytest.approx(50) and far["significant"]
    assert "the published value (data sheet)" in far["sentence"]
    assert "No sigma is published, so it is ours alone" in far["sentence"]


def test_a_published_value_of_what_has_no_value_here_is_not_judged(tmp_path: Path) -> None:
    row = told(tmp_path, 1e-5, name="bias_y")
    assert np.isnan(row["in_sigmas"]) and row["sentence"].endswith("judged: not recorded.")


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
        calibration() | {"verdicts": [verdict("not_usable")]},
    ],
    ids=["number", "setting", "date", "log", "covariance", "verdict"],
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


@pytest.mark.slow
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
    assert "diagnosis/covariance.parquet" in made_by["inputs"]
