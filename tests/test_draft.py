"""`make draft`: what it says of logs whose truth is known, and what the chain makes of it."""

import re
from pathlib import Path

import chain
import numpy as np
import pytest
from click.testing import CliRunner
from drafting import Document, comments, drafted, told, written
from logs_by_hand import EIGHTEEN, by_hand_log
from moved_by_hand import FACES, GRAVITY, RATE

from commands.check import no_results
from commands.draft.__main__ import draft, main
from inertial.campaign.references import NOT_NAMED
from inertial.estimation.triad import linear_names
from inertial.physics.site import EARTH_RATE
from inertial.tables.errors import Refusal
from inertial.tables.stage import Stage
from inertial.text.statements import NO_POSITION_SET, NO_TABLE, NO_TURN_SET
from laboratory.rawimu import Samples, log_bytes
from turntable_calibration.__main__ import main as program

MAX_SIGMA = 4.5  # of some twenty parameters with Gaussian errors, in 1 of 6000 campaigns


# ---- a table's campaign, in the messages of a receiver


@pytest.fixture(scope="module")
def on_a_table(tmp_path_factory) -> tuple[Path, chain.Results]:
    place = tmp_path_factory.mktemp("table")
    simulated = chain.simulate(chain.short(seed=3), place / "simulated")
    logs = sorted(simulated.glob("*.asc"))
    folder = draft(logs, "short", place / "data")
    return folder, chain.run(folder, place / "derived")


def test_the_plan_is_that_by_which_the_table_was_moved(on_a_table):
    folder, _results = on_a_table
    campaign = told(folder)
    by_log = {m["log"]: m for m in campaign["plan"]}
    assert campaign["instrument"] == "span-cpt"
    keys = ("do", "up", "degrees", "rate_deg_s")
    for planned in chain.short()["campaign"]["plan"]:
        assert {key: by_log[planned["log"]].get(key) for key in keys} == {
            key: planned.get(key) for key in keys
        }


def test_a_draft_of_a_table_is_calibrated_as_well_as_a_guess_allows(on_a_table):
    _folder, results = on_a_table
    truth = chain.short()["truth"]
    for stage, key, bias in (
        ("accelerometer", "accelerometer", "bias_m_s2"),
        ("gyroscope", "gyro", "bias_rad_s"),
    ):
        joint = results.parameters(stage).loc[list(linear_names())]
        matrix = np.array(truth[key]["matrix"]) - np.eye(3)
        right = np.append(matrix.ravel(), truth[key][bias])
        assert np.abs((joint["value"] - right) / joint["sigma"]).max() < MAX_SIGMA
    # What the log alone fixes is as precise as with the table's own certificate.
    gyro = results.parameters("gyroscope")["sigma"]
    assert gyro[["bias_x", "bias_y", "bias_z"]].max() < 0.3 * EARTH_RATE
    assert gyro[["scale_x", "scale_y", "scale_z"]].max() < 3e-4
    # Gravity is a guess, 0.03 m/s².
    scale = results.parameters("accelerometer").loc["scale_x", "sigma"]
    assert scale == pytest.approx(0.03 / 9.80665, rel=0.2)


def turn_and_stop() -> list[Document]:
    """A rest, a turn and back, and a rest, in four positions."""
    plan: list[Document] = []
    for up, rate in (("+z", 30), ("-z", 60), ("+x", 30), ("-x", 60)):
        turn = {"do": "turn", "up": up, "rate_deg_s": rate, "accel_deg_s2": rate, "position": up}
        plan += [
            {"id": f"{len(plan)}", "do": "rest", "up": up, "seconds": 20, "position": up},
            {"id": f"{len(plan) + 1}", "degrees": 360} | turn,
            {"id": f"{len(plan) + 2}", "degrees": -360} | turn,
            {"id": f"{len(plan) + 3}", "do": "rest", "up": up, "seconds": 20, "position": up},
        ]
    return plan


def test_rests_and_turns_of_one_log_come_in_their_order(tmp_path):
    """In columns of counts; how the table gets from one position to the next is no manoeuvre."""
    document = chain.demo(seed=4)
    document["receiver"] |= {"message": "columns"}
    document["handling"] = {"still_s": 5, "change_s": 8}
    document["campaign"] |= {"instrument": {"name": "made up"}, "log": "session.csv"}
    document["campaign"]["plan"] = turn_and_stop()
    simulated = chain.simulate(document, tmp_path / "simulated")
    campaign = told(draft([simulated / "session.csv"], "drafted", tmp_path / "data"))
    keys = ("do", "up", "degrees", "rate_deg_s")
    assert [[m.get(key) for key in keys] for m in campaign["plan"]] == [
        [m.get(key) for key in keys] for m in turn_and_stop()
    ]
    places = [m["position"] for m in campaign["plan"]]  # else each has a tilt of its own
    assert [places[i] == places[i - 1] for i in range(1, 16)] == [i % 4 > 0 for i in range(1, 16)]
    assert campaign["table"]["name"] == NOT_NAMED  # by which no two tables are one
    layout = campaign["instrument"]["format"]
    assert layout["temperature"] == {"column": "temperature", "unit": "degC"}
    # The laboratory's counts are increments: so many in 1 °/s at 100 Hz.
    right = np.radians(1) / 100 / document["receiver"]["gyro_count_rad"]
    assert layout["gyro"]["counts_per_unit"] == pytest.approx(right, rel=0.01)


# ---- by hand, in columns without a name

UNITS = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}


@pytest.mark.parametrize("seed", [1, 2])
def test_columns_without_a_name_are_known_by_what_they_do(seed, tmp_path):
    """Temperature, magnetometer, gyros in counts, accelerometers in g, and ms, in this order."""
    log = by_hand_log(seed)
    n = len(log.force)
    temperature = 25 + 0.1 * np.random.default_rng(0).standard_normal(n)
    counts = np.rint(np.degrees(log.rate) * 65.5)
    time = 1000 + np.arange(n) * 1e3 / RATE
    text = written([temperature, log.field, counts, log.force / 9.80665, time])
    folder = drafted({"log.txt": text}, tmp_path)
    campaign = told(folder)
    layout = campaign["instrument"]["format"]
    assert layout["accelerometer"] == {"columns": [8, 9, 10], "unit": "g"}
    assert layout["gyro"] == {"columns": [5, 6, 7], "unit": "deg/s", "counts_per_unit": 65.5}
    assert layout["time"] == {"column": 11, "unit": "ms"}
    (plan,) = campaign["plan"]
    assert plan["do"] == "positions" and 1 <= plan["seconds"] < 4
    assert f"# {log.positions} static positions" in (folder / "campaign.yaml").read_text()


IN_XY = (EIGHTEEN[:, 0] != 0) & (EIGHTEEN[:, 1] != 0)


@pytest.mark.parametrize(
    ("ups", "said"),
    [
        (EIGHTEEN, "The attitudes of 18 positions determine all parameters of the accelerometers."),
        (EIGHTEEN[~IN_XY], "static positions: no rest has both x and y far from level"),
    ],
)
def test_a_draft_judges_by_the_attitudes_that_it_found(ups, said, tmp_path):
    """Of 14 positions none is between x and y: a number of them says nothing of their angle."""
    log = by_hand_log(3, ups=ups, degrees=0.02)
    text = written([np.arange(len(log.force)) / RATE, log.force, log.rate])
    found = comments(drafted({"log.txt": text}, tmp_path))
    assert said in found and "Nothing is missing" not in found
    assert ("What is missing" in found) == (len(ups) < len(EIGHTEEN))


def test_faces_by_hand_calibrate_the_gyros_by_the_motions_between(tmp_path):
    """Twelve rests on six faces, no turn: as set positions they showed biases of gyros alone."""
    log = by_hand_log(4, ups=np.repeat(FACES, 2, axis=0), degrees=1.0)
    text = written([np.arange(len(log.force)) / RATE, log.force, log.rate])
    folder = drafted({"log.txt": text}, tmp_path)
    assert [m["do"] for m in told(folder)["plan"]] == ["positions"]
    results = chain.run(folder, tmp_path / "derived")
    gyro = results.parameters("gyroscope", "free_positions").loc[list(linear_names())]
    right = log.imu.rates - np.append(np.eye(3).ravel(), np.zeros(3))
    assert np.abs((gyro["value"] - right) / gyro["sigma"]).max() < MAX_SIGMA


def test_a_draft_by_hand_is_calibrated_to_its_truth(tmp_path):
    log = by_hand_log(5)
    n = len(log.force)
    text = written([np.arange(n) / RATE, log.force, log.rate])
    folder = drafted({"log.txt": text}, tmp_path)
    results = chain.run(folder, tmp_path / "derived")
    accel = results.parameters("accelerometer", "free_positions")
    assert set(accel.loc[list(linear_names()), "frame"]) == {"accelerometer triad"}
    assert (
        told(folder)["guessed"]
        == [*results["plan/guesses"]["part"]]
        == ["instrument", "format", "site"]
    )
    gravity = results["plan/known"].set_index("quantity").loc["gravity"]
    assert gravity["assumed"] and gravity["origin"].startswith("guessed")
    origins = results["plan/known"].set_index("quantity")["origin"]
    assert origins["turn_angle"] == NO_TURN_SET and origins["position"] == NO_POSITION_SET
    assert origins["turn_rate"] == origins["heading"] == NO_TABLE
    # Of a direction anywhere on a sphere: √(2/3 − π²/16) of 15.04 °/h
    assert "its sigma, 3.4 °/h, is neglected" in origins["earth_rate_level"]
    symmetric = [f"symmetric_{pair}" for pair in ("xx", "yy", "zz", "xy", "xz", "yz")]
    found = accel.loc[[*symmetric, "bias_x", "bias_y", "bias_z"]]
    right = log.imu.free - np.array([1, 1, 1, 0, 0, 0, 0, 0, 0])
    # Gravity at the site is 9.7936; the draft guesses 9.80665 with a sigma of 0.03.
    assert abs(9.80665 - GRAVITY) < 0.03
    assert np.abs((found["value"] - right) / found["sigma"]).max() < MAX_SIGMA
    gyro = results.parameters("gyroscope", "free_positions")
    matrix = gyro.loc[list(linear_names())]
    right = log.imu.rates - np.append(np.eye(3).ravel(), np.zeros(3))
    assert np.abs((matrix["value"] - right) / matrix["sigma"]).max() < MAX_SIGMA


@pytest.mark.parametrize("unit", UNITS)
def test_the_unit_of_a_time_follows_from_a_plausible_rate(unit, tmp_path):
    log = by_hand_log(1)
    time = np.arange(len(log.force)) / RATE * UNITS[unit]
    text = written([time, log.force, log.rate], digits=15)
    layout = told(drafted({"log.txt": text}, tmp_path))["instrument"]["format"]
    assert layout["time"] == {"column": 1, "unit": unit}


def test_names_with_units_behind_the_axis_are_those_of_their_sensor(tmp_path):
    log = by_hand_log(3)
    sensors = {"acc_{}_mps2": log.force, "gyro_{}_rad_s": log.rate}
    names = ["time_s", *(name.format(axis) for name in sensors for axis in "xyz")]
    columns = [np.arange(len(log.force)) / RATE, *sensors.values()]
    logs = {"log.csv": ",".join(names) + "\n" + written(columns)}
    layout = told(drafted(logs, tmp_path))["instrument"]["format"]
    assert layout["accelerometer"] == {"columns": names[1:4], "unit": "m/s2"}
    assert layout["gyro"] == {"columns": names[4:], "unit": "rad/s"}


def test_increments_of_velocity_and_angle_are_divided_by_their_interval(tmp_path):
    """As VectorNav's and Xsens's Δv and Δθ: m/s and rad over a sample."""
    log = by_hand_log(4)
    time = np.arange(len(log.force)) / RATE
    text = written([time, log.force / RATE, log.rate / RATE])
    layout = told(drafted({"log.txt": text}, tmp_path))["instrument"]["format"]
    for sensor, unit in (("accelerometer", "m/s2"), ("gyro", "rad/s")):
        assert layout[sensor]["unit"] == unit
        assert layout[sensor]["counts_per_unit"] == pytest.approx(1 / RATE, rel=1e-6)


def test_without_a_clock_gravity_shows_the_rate(tmp_path):
    """Gyros in rad/s carry gravity from rest to rest at the right rate only, to 1 % of scale."""
    log = by_hand_log(2)
    folder = drafted({"log.txt": written([log.rate[::2], log.force[::2]])}, tmp_path)
    campaign = told(folder)
    assert campaign["instrument"]["format"]["time"] == {"rate_hz": RATE / 2}
    text = (folder / "campaign.yaml").read_text(encoding="utf-8")
    assert "how many samples a second" in " ".join(text.replace("#", "").split())


def test_a_clock_stays_one_through_pauses(tmp_path):
    """Of a recording that was paused seven times a column `time` was not used, the rate a guess."""
    log = by_hand_log(2)
    samples = np.arange(len(log.force))
    time = samples / RATE + 60.0 * np.digitize(samples, np.linspace(0, len(samples), 9)[1:-1])
    folder = drafted({"log.txt": written([time, log.rate, log.force])}, tmp_path)
    assert told(folder)["instrument"]["format"]["time"] == {"column": 1, "unit": "s"}


def test_unsigned_counts_of_sensors_with_a_log_each(tmp_path):
    log = by_hand_log(3)
    time = np.arange(len(log.force)) / RATE
    force = np.rint(log.force / 9.80665 * 4096) + 32768
    rate = np.rint(np.degrees(log.rate) * 80) + 32768
    logs = {"first.txt": written([time, force]), "second.txt": written([time, rate])}
    campaign = told(drafted(logs, tmp_path))
    layout = campaign["instrument"]["format"]["accelerometer"]
    assert layout | {"columns": 0} == {
        "columns": 0,
        "unit": "g",
        "counts_per_unit": 4096,
        "zero_counts": 32768,
    }
    assert campaign["log"] == "first.txt"
    gyros = campaign["formats"][campaign["gyro"]["format"]]["gyro"]
    assert campaign["gyro"]["log"] == "second.txt" and gyros["zero_counts"] == 32768
    assert gyros["unit"] == "deg/s" and gyros["counts_per_unit"] == pytest.approx(80, rel=0.03)


def test_gyros_wired_otherwise_are_seen(tmp_path):
    log = by_hand_log(1)
    rate = log.rate[:, [1, 0, 2]] * [1, -1, 1]  # columns: y, −x, z
    time = np.arange(len(rate)) / RATE
    folder = drafted({"log.txt": written([time, log.force, rate])}, tmp_path)
    assert told(folder)["instrument"]["gyro"]["axes"] == ["y", "-x", "z"]
    assert "gyro.axes" in (folder / "campaign.yaml").read_text(encoding="utf-8")


def test_the_report_of_a_draft_tells_that_two_gyros_are_reversed(tmp_path):
    log = by_hand_log(2)
    rate = log.rate * [-1, -1, 1]
    time = np.arange(len(rate)) / RATE
    folder = drafted({"log.txt": written([time, log.force, rate])}, tmp_path)
    campaign = told(folder)
    assert campaign["instrument"]["gyro"]["axes"] == ["-x", "-y", "z"]
    shares = re.findall(r"([xyz]) (−?[\d.]+) ± ([\d.]+\d)", campaign["notes"])
    for (axis, share, sigma), sign in zip(shares, (-1, -1, 1), strict=True):
        value = float(share.replace("−", "-"))
        assert float(sigma) < 0.1 and value == pytest.approx(sign, abs=0.1), axis
    assert "x reads −x and y reads −y" in campaign["notes"]
    assert "A reversed z axis of the accelerometers would look the same" in campaign["notes"]
    (tmp_path / "plain").mkdir()
    plain = drafted({"log.txt": written([time, log.force, log.rate])}, tmp_path / "plain")
    assert "notes" not in told(plain)


def test_text_as_programs_of_other_countries_write_it(tmp_path):
    """Dates, semicolons, decimal commas and a comment."""
    log = by_hand_log(1)
    head = "# some program\nwhen;ax;ay;az;gx;gy;gz\n"
    numbers = written([log.force, log.rate], ";").replace(".", ",").splitlines()
    stamps = np.datetime64("2026-03-01T10:00:00.000") + np.arange(len(numbers)) * np.timedelta64(
        10, "ms"
    )
    rows = "".join(f"{t};{row}\n" for t, row in zip(stamps, numbers, strict=True))
    folder = drafted({"log.csv": head + rows}, tmp_path)
    layout = told(folder)["instrument"]["format"]
    assert layout["time"] == {"column": "when", "unit": "iso8601"}
    assert (layout["delimiter"], layout["decimal"], layout["comment"]) == (";", ",", "#")
    results = chain.run(folder, tmp_path / "derived", "segment")
    assert results["segment/segments"]["manoeuvre"].nunique() >= log.positions


# ---- what cannot be drafted


# ---- means of one attitude at temperatures


def at_temperatures(names: bool) -> str:
    """Thirty means from 0 to 58 °C: gravity along z, 2 mm/s² less for each K below 30 °C."""
    random = np.random.default_rng(1)
    warm = np.linspace(0.0, 58.0, 30)
    force = np.column_stack([np.full(30, 0.1), np.full(30, -0.1), 9.8 - 2e-3 * warm.clip(max=30)])
    force += 5e-4 * random.standard_normal((30, 3))
    rate = np.radians(0.1) + np.radians(1e-4) * random.standard_normal((30, 3))
    text = "bin,temperature,samples,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z\n" if names else ""
    for number, (t, f, w) in enumerate(zip(warm, force, rate, strict=True)):
        read = ",".join(f" {v:.6f}" for v in (*f, *w))
        text += f"BIN:  {number},  {t:.2f}, {20_000 + 10 * number},{read}\n"
    return text


def test_named_means_at_temperatures_are_of_use_for_these(tmp_path):
    folder = drafted({"chamber.csv": at_temperatures(names=True)}, tmp_path)
    campaign = told(folder)
    (rest,) = campaign["plan"]
    assert (rest["do"], rest["up"]) == ("rest", "+z")
    layout = campaign["instrument"]["format"]
    assert layout["mean_of"] == "samples" and layout["delimiter"] == ","
    assert layout["temperature"] == {"column": "temperature", "unit": "degC"}
    results = chain.run(folder, tmp_path / "derived", "diagnosis", chain.BESIDE)
    curves = results["diagnosis/temperature_curves"]
    own = curves[(curves["sensor"] == "accel") & (curves["parameter"] == "bias_z")]
    cold, warm = own.iloc[0], own.iloc[-1]
    assert cold["value"] - warm["value"] == pytest.approx(30 * 2e-3, abs=5 * warm["sigma"])
    assert warm["sigma"] < 2e-3
    # No parameter is determined, and yet the accelerometers have a result; of the gyros, which do
    # not change, nothing can be said.
    assert [each.subject for each in no_results(tmp_path / "derived")] == ["gyros"]


def test_means_without_names_are_refused_with_what_names_them(tmp_path):
    with pytest.raises(Refusal, match="30 rows of numbers") as refusal:
        drafted({"chamber.csv": at_temperatures(names=False)}, tmp_path)
    assert "the means of one at temperatures, whose columns are named" in refusal.value.expected
    assert "add a first line that names the columns" in refusal.value.cure


def refused(capsys: pytest.CaptureFixture[str], arguments: list[str]) -> str:
    assert main(arguments) == 2
    return capsys.readouterr().err


def test_what_is_there_is_never_overwritten(tmp_path, capsys):
    data = tmp_path / "data"
    (data / "raw/june").mkdir(parents=True)
    log = tmp_path / "log.txt"
    log.write_text("1 2 3\n")
    error = refused(capsys, [str(log), "--name", "june", "--data", str(data)])
    assert "there is a campaign of this name" in error
    assert not any((data / "raw/june").iterdir())


def test_a_draft_that_asks_for_the_rate_is_replaced_with_it_unless_edited(tmp_path, capsys):
    """The advice was refused: its own folder was there."""
    log, data = by_hand_log(41), tmp_path / "data"
    path, file = tmp_path / "log.txt", data / "raw/june/campaign.yaml"
    np.savetxt(path, np.hstack([log.force / 9.80665 * 8192, log.rate * 3752]).round(), "%d")
    options = ["--name", "june", "--data", str(data)]
    assert main([str(path), *options]) == 0
    assert "draft it again with RATE=" in " ".join(capsys.readouterr().out.split())
    assert "there is a campaign of this name" in refused(capsys, [str(path), *options])
    with_rate = [*options, "--rate", "200"]
    other = tmp_path / "other/log.txt"
    other.parent.mkdir()
    other.write_text(path.read_text()[:-20])
    before = file.read_text()
    assert "there is a campaign of this name" in refused(capsys, [str(other), *with_rate])
    edited = before.replace("serial: unknown", "serial: 4711")
    file.write_text(edited)
    assert "no longer, the draft of these logs without a rate" in refused(
        capsys, [str(path), *with_rate]
    )
    assert file.read_text() == edited
    file.write_text(before)
    assert main([str(file.parent / "log.txt"), *with_rate]) == 0
    assert "rate_hz: 200" in file.read_text() and "how many samples" not in file.read_text()
    assert (file.parent / "log.txt").read_bytes() == path.read_bytes()


@pytest.mark.parametrize(
    ("arguments", "found"),
    [
        (["nowhere.txt", "--name", "june"], "no such file"),
        (["--name", "june"], "no log"),
        (["nowhere.txt", "--name", "June 3"], "'June 3'"),
    ],
)
def test_what_is_asked_wrongly_is_said(arguments, found, tmp_path, capsys):
    error = refused(capsys, [*arguments, "--data", str(tmp_path / "data")])
    assert found in error and "cure:" in error
    assert not (tmp_path / "data").exists()


@pytest.mark.parametrize(
    "text", ["1,2,3\n" * 99, "Dear all,\nthis is no log.\n", "1 2 3\n1 2 3\n", "", "1,2\n" * 100]
)
def test_what_is_no_log_is_refused_and_nothing_is_written(text, tmp_path, capsys):
    log = tmp_path / "log.txt"
    log.write_text(text)
    error = refused(capsys, [str(log), "--name", "june", "--data", str(tmp_path / "data")])
    assert "log.txt" in error and "cure:" in error
    assert not (tmp_path / "data").exists()


@pytest.mark.parametrize("seed", range(3))
def test_bytes_that_are_no_log_are_refused(seed, tmp_path, capsys):
    """Some ended with an exception: fields that look named, of which no line holds numbers."""
    log = tmp_path / "log.csv"
    log.write_bytes(np.random.default_rng(seed).bytes(50_000))
    error = refused(capsys, [str(log), "--name", "june", "--data", str(tmp_path / "data")])
    assert "log.csv" in error and "cure:" in error


def test_a_few_messages_of_a_receiver_are_refused_by_their_number(tmp_path):
    counts = np.arange(21, dtype=np.int64).reshape(7, 3)
    log = tmp_path / "few.bin"
    log.write_bytes(
        log_bytes(Samples(10_000_000 * np.arange(7), counts, counts), "RAWIMUSXB", "77")
    )
    with pytest.raises(Refusal, match="7 messages of an IMU"):
        draft([log], "few", tmp_path / "data")


# ---- no permission


def test_a_folder_that_may_not_be_written_is_named(tmp_path, monkeypatch):
    def denied(*_options: object, **_more: object) -> None:
        raise PermissionError(13, "Permission denied", "data/raw/june")

    (tmp_path / "log.csv").write_text("1,2,3\n")
    monkeypatch.setattr("commands.draft.__main__.draft", denied)
    done = CliRunner().invoke(program, ["draft", "--name=june", str(tmp_path / "log.csv")])
    assert done.exit_code == 1 and "draft: data/raw/june\n  found:    no perm" in done.output
    monkeypatch.setattr(Stage, "run", denied)
    with pytest.raises(SystemExit, match=r"plan: data/raw/june\n[\s\S]*chmod"):
        chain.stage_of("plan").command_line([str(tmp_path)])
