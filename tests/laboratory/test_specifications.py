"""A wrong specification is refused by name; campaign.yaml and the folder are as promised."""

from collections.abc import Callable
from math import radians
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

from laboratory import Recording, SpecificationError, perform, read, specify, write
from laboratory.__main__ import main

Change = Callable[[dict[str, Any]], object]
WRONG: list[tuple[Change, str]] = [
    (
        lambda d: d["noise"].update(angel_random_walk_deg_sqrt_h=1),
        "noise.angel_random_walk_deg_sqrt_h: found a key that is not known; expected one of "
        "angle_random_walk_deg_sqrt_h, velocity_random_walk_m_s_sqrt_h, "
        "gyro_rate_random_walk_deg_h_sqrt_h, accelerometer_random_walk_m_s2_sqrt_h, "
        "table_sway_m_s_sqrt_h (did you mean angle_random_walk_deg_sqrt_h?)",
    ),
    (
        lambda d: d["receiver"].pop("rate_hz"),
        "receiver.rate_hz: found nothing; expected samples per second, Hz, above 0",
    ),
    (
        lambda d: d["campaign"]["plan"][6].update(up="x"),
        "campaign.plan[6].up: found 'x' (text); expected a body axis, +x -x +y -y +z -z, "
        "or a vector of three numbers that is not zero",
    ),
    (
        lambda d: d["campaign"].update(serial=17),
        "campaign.serial: found 17 (number); expected serial number as text, in quotes, or unknown",
    ),
    (
        lambda d: d["campaign"]["plan"][1].update(id="x-up"),
        "campaign.plan[1].id: found x-up again; expected another id",
    ),
    (
        lambda d: d["campaign"]["plan"][6].pop("rate_deg_s"),
        "campaign.plan[6]: found degrees; expected two of degrees, rate_deg_s and seconds",
    ),
    (
        lambda d: d["campaign"]["plan"][0].update(mark="-x"),
        "campaign.plan[0].mark: found -x; expected a direction that is not vertical, "
        "because it defines the azimuth",
    ),
    (
        lambda d: [m.update(log="all.asc") for m in d["campaign"]["plan"]] and d["faults"].clear(),
        "handling.change_s: found nothing; expected the time from one position to the next, s, "
        "since a log has several",
    ),
    (
        lambda d: d["faults"][0]["lose"].update(log="z.asc"),
        "faults[0].lose.log: found z.asc; expected a log of the plan: x-up.asc, x-down.asc, "
        "y-up.asc, y-down.asc, z-up.asc, z-down.asc, x-forward.asc, x-backward.asc, "
        "y-forward.asc, y-backward.asc, z-forward.asc, z-backward.asc",
    ),
    (
        lambda d: d["faults"][0]["lose"].update(line=5000),
        "faults[0].lose: found lines up to 6196; expected lines of z-backward.asc, which has 5800",
    ),
    (
        lambda d: d["effects"].update(
            table_creep={"about": "up", "rate_deg_h": 1, "from_s": 9, "to_s": 9}
        ),
        "effects.table_creep.to_s: found 9; expected later than from_s, 9 s",
    ),
    (
        lambda d: d["effects"].update(oscillation={"amplitude_rad_s": 0.01, "axis": "+x"}),
        "effects.oscillation: found {'amplitude_rad_s': 0.01, 'axis': '+x'} (mapping); expected "
        "oscillation of the case about an axis while the table turns: frequency_hz, or order, "
        "periods per revolution",
    ),
    (
        lambda d: d["campaign"]["site"].update(latitude_deg=None),
        "truth.latitude_deg: found nothing; expected the true latitude, degrees north, "
        "since the campaign does not state it",
    ),
    (
        lambda d: d["truth"]["gyro"].update(bias_rad_s=[0, float("nan"), 0]),
        "truth.gyro.bias_rad_s[1]: found nan; expected a finite number",
    ),
]


@pytest.mark.parametrize(("change", "message"), WRONG)
def test_what_is_wrong_is_said_by_name(demo: dict[str, Any], change: Change, message: str) -> None:
    change(demo)
    with pytest.raises(SpecificationError) as refusal:
        specify(demo, "trial.yaml")
    assert str(refusal.value) == f"trial.yaml: {message}"


def test_a_date_without_quotes_is_refused_with_the_cure(tmp_path: Path, demo_file: Path) -> None:
    path = tmp_path / "trial.yaml"
    path.write_text(demo_file.read_text("utf-8").replace('"2026-11-02"', "2026-11-02"), "utf-8")
    with pytest.raises(SpecificationError, match=r"date: found 2026-11-02 .*put it in quotes"):
        read(path)


def test_the_command_says_what_is_wrong_and_writes_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "trial.yaml"
    path.write_text("campaign: [", "utf-8")
    monkeypatch.setattr("sys.argv", ["laboratory", str(path), str(tmp_path / "raw")])
    assert main() == 1
    assert capsys.readouterr().err.startswith(f"{path}: the file: found while parsing")
    assert not (tmp_path / "raw").exists()


def test_the_folder_holds_the_logs_and_the_campaign_as_specified(
    tmp_path: Path, demo: dict[str, Any], demo_recording: Recording
) -> None:
    write(demo_recording, tmp_path)
    campaign = YAML(typ="safe", pure=True).load(tmp_path / "campaign.yaml")
    assert campaign == demo["campaign"] | {"simulated": True}
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"campaign.yaml", *demo_recording.logs}
    assert (tmp_path / "z-up.asc").read_bytes() == demo_recording.logs["z-up.asc"]


def test_the_campaign_is_written_last(
    tmp_path: Path, demo_recording: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A performance that breaks off leaves no campaign.yaml, not even that of an earlier one."""
    write(demo_recording, tmp_path)

    def full_disk(path: Path, content: bytes) -> None:
        raise OSError("No space left on device")

    monkeypatch.setattr("laboratory.folder.put", full_disk)
    with pytest.raises(OSError, match="No space"):
        write(demo_recording, tmp_path)
    assert not (tmp_path / "campaign.yaml").exists()


@pytest.mark.parametrize(
    ("turn", "degrees", "seconds"),
    [
        ({"degrees": -360, "rate_deg_s": 10, "accel_deg_s2": 5}, -360, 58),
        ({"degrees": 360, "seconds": 38, "accel_deg_s2": 5}, 360, 58),
        ({"rate_deg_s": -10, "seconds": 38, "accel_deg_s2": 5}, -360, 58),
        ({"rate_deg_s": -80, "seconds": 30, "recorded": "steady"}, -2400, 30),
        ({"rate_deg_s": 80, "degrees": -720, "recorded": "steady"}, -720, 9),
    ],
)
def test_two_of_angle_rate_and_duration_make_a_turn(
    demo: dict[str, Any], turn: dict[str, Any], degrees: float, seconds: float
) -> None:
    """S0's turn: ramps of 2 s at 5 deg/s², 34 s at 10 deg/s, and 10 s of rest on both sides."""
    demo["campaign"]["plan"] = [{"id": "t", "do": "turn", "up": "+z", "log": "t.asc"} | turn]
    (manoeuvre,) = specify(demo | {"faults": []}).manoeuvres
    assert manoeuvre.profile.angle == pytest.approx(radians(degrees))
    assert manoeuvre.samples(0.01) == seconds * 100


def test_what_is_misstated_is_written_and_not_done(demo: dict[str, Any]) -> None:
    said = {"site": {"gravity_m_s2": 9.8066}, "plan": {"x-forward": {"degrees": 350}}}
    true, false = (
        perform(specify(demo | {"misstated": wrong} | {"faults": []})) for wrong in ({}, said)
    )
    assert {log: r.counts.tobytes() for log, r in true.records.items()} == {
        log: r.counts.tobytes() for log, r in false.records.items()
    }
    assert false.campaign["site"] == true.campaign["site"] | {"gravity_m_s2": 9.8066}
    stated = {one["id"]: one for one in false.campaign["plan"]}
    for one in true.campaign["plan"]:
        changed = {"degrees": 350} if one["id"] == "x-forward" else {}
        assert stated[one["id"]] == one | changed


def test_a_misstated_manoeuvre_is_one_of_the_plan(demo: dict[str, Any]) -> None:
    with pytest.raises(SpecificationError, match=r"misstated\.plan\.w-up"):
        specify(demo | {"misstated": {"plan": {"w-up": {"degrees": 350}}}})
