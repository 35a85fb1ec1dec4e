"""The campaign file: every grammar example is understood, every mistake is refused by name."""

import json
import shutil
from math import radians
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from campaign_by_table import BY_TABLE

from inertial import tables
from inertial.campaign.records import known_of, manoeuvres_of
from inertial.physics.site import normal_gravity
from inertial.tables.campaign_files import logs_of
from inertial.tables.errors import Refusal
from stages.plan.stage import plan

ROOT = Path(__file__).parent.parent
EXAMPLES = sorted((Path(__file__).parent / "campaigns").glob("*.yaml"))


def planned(folder: Path, text: str, *, logs: bool = True) -> dict[str, pd.DataFrame]:
    """The tables of a campaign file whose logs are there, though empty."""
    folder.mkdir(exist_ok=True)
    file = folder / "campaign.yaml"
    file.write_text(text, encoding="utf-8")
    raw = [folder / log for log in logs_of(file)] if logs else []
    for log in raw:
        log.write_bytes(b"")
    return dict(plan([file], raw, [ROOT / "data/instruments.yaml"]))


@pytest.mark.parametrize("example", EXAMPLES, ids=[path.stem for path in EXAMPLES])
def test_every_example_of_the_grammar_is_understood(example, tmp_path):
    made = planned(tmp_path / example.stem, example.read_text(encoding="utf-8"))
    for name, table in made.items():
        getattr(tables, name.upper()).arrow(table)
    assert len(made["manoeuvres"]) >= 2


def test_a_turn_is_made_explicit(tmp_path):
    turn = manoeuvres_of(planned(tmp_path, BY_TABLE)["manoeuvres"])[1]
    assert turn.angle == pytest.approx(2 * np.pi)
    assert turn.rate == pytest.approx(radians(10))
    assert turn.seconds == pytest.approx(38)  # 36 s at the rate and 2 s for the ramps, S0
    assert turn.angle_sigma == pytest.approx(radians(2 / 3600))
    np.testing.assert_array_equal(turn.axis, [1, 0, 0])


def test_about_takes_the_sign_of_up(tmp_path):
    text = BY_TABLE.replace("do: turn, up: +x", "do: turn, up: -z")
    turn = manoeuvres_of(planned(tmp_path, text)["manoeuvres"])[1]
    np.testing.assert_array_equal(turn.axis, [0, 0, -1])


def test_what_follows_in_one_log_and_attitude_shares_its_position(tmp_path):
    """Rest, turn and turn back of one setting have one error: with three sigmas are too small."""
    of = "do: turn, up: +x, rate_deg_s: 10, accel_deg_s2: 5, degrees"
    text = BY_TABLE + "".join(
        f"  - {{id: {row}}}\n"
        for row in (
            f"x-backward, {of}: -360",
            f"x-quarter, {of}: 90",
            "x-turned, do: rest, up: +x, seconds: 60",
            "x-elsewhere, do: rest, up: +x, seconds: 60, log: other.asc",
            "x-again, do: rest, up: +x, seconds: 60, log: other.asc, position: anew",
            "x-marked, do: rest, up: +x, mark: +y, seconds: 60, log: other.asc",
            "y-up, do: rest, up: +y, seconds: 60, log: other.asc",
        )
    )
    rows = manoeuvres_of(planned(tmp_path, text)["manoeuvres"])
    assert {row.name: row.position for row in rows} == {
        **dict.fromkeys(["x-up", "x-forward", "x-backward", "x-quarter"], "x-up"),
        "x-turned": "x-turned",  # a quarter further about the vertical
        "x-elsewhere": "x-elsewhere",
        "x-again": "anew",
        "x-marked": "x-marked",
        "y-up": "y-up",
    }


def test_of_one_position_it_is_known_how_far_each_manoeuvre_begins_further_about_the_vertical(
    tmp_path,
):
    """A turn back begins where the one before it ended; so do the marks say, where they are."""
    of = "do: turn, up: +x, rate_deg_s: 10, accel_deg_s2: 5, degrees"
    text = BY_TABLE + "".join(
        f"  - {{id: {row}}}\n"
        for row in (
            "face, do: rest, up: +x, seconds: 60, position: face",
            f"there, position: face, {of}: 86.5",
            f"back, position: face, {of}: -86.5",
            f"whole, position: face, {of}: 720",
            f"again, position: face, {of}: 86.5",
            "over, do: rest, up: -x, seconds: 60, position: other",
            f"anew, position: face, {of}: 86.5",
            f"y-mark, {of}: 90, mark: +y, position: marked",
            f"z-mark, {of}: -90, mark: -z, position: marked",
        )
    )
    rows = manoeuvres_of(planned(tmp_path, text)["manoeuvres"])
    on = {row.name: np.degrees(row.turned_on) for row in rows}
    # A quarter about x, up, takes what was along −z to y: so the mark, which stays, was along y.
    expected = dict.fromkeys(on, 0.0) | {"back": 86.5, "z-mark": 90.0}
    assert on == pytest.approx(expected)


def test_a_tumble_turns_the_body_under_the_plumb_line(tmp_path):
    tumble = "do: tumble, about: +x, up: +z, step_degrees: 20, steps: 18, and_back: true"
    text = BY_TABLE.split("plan:")[0] + f"plan:\n  - {{id: t, {tumble}, seconds: 20}}\n"
    rests = manoeuvres_of(planned(tmp_path, text)["manoeuvres"])
    assert [r.name for r in rests[:2]] == ["t-00", "t-01"]
    assert len(rests) == 36 and rests[18].name == "t-back-17"
    # After +90° about x the y axis, which lay level, has come up: it reads +g.
    quarter = 20 * np.arange(18)
    ups = np.array([r.up for r in rests[:18]])
    np.testing.assert_allclose(ups[:, 1], np.sin(np.radians(quarter)), atol=1e-12)
    np.testing.assert_allclose(ups[:, 2], np.cos(np.radians(quarter)), atol=1e-12)
    tumbled = np.array([r.tumbled for r in rests])
    np.testing.assert_allclose(np.degrees(tumbled[:18]), quarter[:, None] * [1, 0, 0], atol=1e-9)
    np.testing.assert_allclose(tumbled[18:], tumbled[17::-1])


def test_normal_gravity_is_taken_where_none_is_stated_and_said_so(tmp_path):
    text = BY_TABLE.replace(", gravity_m_s2: 9.7936174, gravity_sigma_m_s2: 5.0e-5", "")
    known = planned(tmp_path, text)["known"]
    gravity = known_of(known)["gravity"]
    assert gravity.number == pytest.approx(normal_gravity(radians(30.5278), 24))
    assert gravity.scatter > 1e-4
    assert "normal gravity" in known.set_index("quantity").loc["gravity", "origin"]


def test_normal_gravity_meets_the_published_values():
    # WGS 84, equator and pole; NGA.STND.0036, table 4.2.
    assert normal_gravity(0, 0) == pytest.approx(9.7803253359, abs=1e-10)
    assert normal_gravity(np.pi / 2, 0) == pytest.approx(9.8321849379, abs=1e-9)
    # Height and latitude of Wuhan: within 5 mGal of the stated 9.7936174 m/s² at 15 m.
    assert normal_gravity(radians(30.5278), 15) == pytest.approx(9.7936174, abs=5e-5)


def test_two_formats_of_one_file_are_two_logs(tmp_path):
    text = (Path(__file__).parent / "campaigns/hipnuc.yaml").read_text(encoding="utf-8")
    assert list(planned(tmp_path, text)["logs"]["log"]) == ["test.log:still", "test.log:turning"]


MEANS = """\
formats: {m: {kind: columns, mean_of: null, gyro: {columns: [1, 2, 3], unit: deg/s, sigma: 0.1}}}
"""
MISTAKES = {
    # what is wrong: (what to write instead of what, what the error must say)
    "mistyped key": ("serial:", "seriall:", ["line 3", "'seriall'", "write serial"]),
    "number as serial": ('"A-017"', "0017", ["line 3, serial", "put it in quotes"]),
    "unknown instrument": ("span-cpt", "span-cqt", ["line 2, instrument", "imar-fsas, span-cpt"]),
    "another version": ("campaign: 1", "campaign: 2", ["line 1, campaign", "2", "version 1"]),
    "unknown axis": (
        "up: +x, seconds",
        "up: +w, seconds",
        ["line 9, plan[0].up", "'+w'", "a body axis such as +x or -z, a vector"],
    ),
    "a decimal comma": (
        "latitude_deg: 30.5278",
        "latitude_deg: 30,5278",
        ["line 5, site[5278]", "write decimals with a point"],
    ),
    "a unit that is none": (
        "plan:",
        MEANS.replace("unit: deg/s", "unit: mg")
        + "plan:\n  - {id: r, do: rest, up: +x, format: m}",
        ["'mg'", "unit: g and counts_per_unit: 1000"],
    ),
    "key of another manoeuvre": ("seconds: 300", "degrees: 3", ["plan[0].degrees", "for do: rest"]),
    "unknown key": (
        "rate_deg_s: 10",
        "rate_degs: 10",
        ["plan[1].rate_degs (id x-forward)", "near to it: rate_deg_s", "required: id, do"],
    ),
    "same id twice": ("id: x-forward", "id: x-up", ["line 10, plan[1].id", "rename one"]),
    "a path as log": ("session.asc", "../session.asc", ["log", "plain file name"]),
    "no gravity at all": (
        "latitude_deg: 30.5278, height_m: 24, gravity_m_s2: 9.7936174, gravity_sigma_m_s2: 5.0e-5",
        "latitude_deg: null",
        ["line 5, site", "gravity_m_s2"],
    ),
    "by hand without a sigma": (
        "{name: three-axis, position_sigma_arcsec: 2, angle_sigma_arcsec: 2}",
        "{name: by hand}",
        ["line 6, table", "position_sigma_arcsec: 3600"],
    ),
    "set positions without a table": (
        "table: {name: three-axis, position_sigma_arcsec: 2, angle_sigma_arcsec: 2}\n",
        "",
        ["table", "position_sigma_arcsec: 3600"],
    ),
    "two rates": (
        "instrument: span-cpt",
        "instrument:\n  name: a\n  rate_hz: 100\n  format:\n    kind: columns\n"
        "    time: {rate_hz: 102.4}\n    gyro: {columns: [1, 2, 3], unit: deg/s}",
        ["line 7, instrument.format.time.rate_hz", "102.4", "100", "line 4, instrument.rate_hz"],
    ),
    "a rate that the list of instruments contradicts": (
        "plan:\n  - {id: x-up,",
        "formats: {f: {kind: columns, time: {rate_hz: 200}, "
        "gyro: {columns: [1, 2, 3], unit: deg/s}}}\nplan:\n  - {id: x-up, format: f,",
        ["formats.f.time.rate_hz", "instruments.yaml, line", "span-cpt.rate_hz"],
    ),
    "neither time nor a rate": (
        "span-cpt",
        "{name: a, format: {kind: columns, gyro: {columns: [1, 2, 3], unit: deg/s}}}",
        ["instrument.format", "neither time nor a rate", "rate_hz to the instrument"],
    ),
    "hand turn without a sigma": (
        "{name: three-axis, position_sigma_arcsec: 2, angle_sigma_arcsec: 2}",
        "{name: by hand, position_sigma_arcsec: 3600}",
        ["plan[1]", "degrees_sigma"],
    ),
    "a day that is none": ("2026-11-02", "2026-13-45", ["date", "2026-13-45", "YYYY-MM-DD"]),
    "a day that is none, unquoted": ('"2026-11-02"', "2026-13-45", ["date", "YYYY-MM-DD"]),
    "rate with a sign": ("rate_deg_s: 10", "rate_deg_s: -10", ["plan[1].rate_deg_s", "magnitude"]),
    "a turn that cannot last so long": (
        "accel_deg_s2: 5",
        "accel_deg_s2: 5, seconds: 60",
        ["plan[1].seconds", "about 38 s"],
    ),
    "a rate that is never reached": (
        "rate_deg_s: 10",
        "rate_deg_s: 50",  # the square root of 360 times 5 is 42.43
        ["plan[1].rate_deg_s", "50", "at most 42.43", "accel_deg_s2: 5"],
    ),
    "a turn of nothing": (", degrees: 360, rate_deg_s: 10", "", ["plan[1]", "two of them"]),
    "mark along up": ("up: +x, seconds", "up: +x, mark: -x, seconds", ["plan[0].mark"]),
    "a vector of zeros": ("up: +x, seconds", "up: [0, 0, 0], seconds", ["plan[0].up"]),
    "not a number": ("seconds: 300", "seconds: .nan", ["plan[0].seconds", "finite"]),
    "unknown format": ("seconds: 300", "seconds: 300, format: f", ["plan[0].format"]),
    "two selections": (
        "seconds: 300",
        "seconds: 300, rows: [0, 9], span: [0, 9]",
        ["plan[0]", "span and rows"],
    ),
    "a zero beyond the largest count": (
        "span-cpt",
        "{name: a, format: {kind: columns, time: {column: 1, unit: s}, gyro: {columns: [1, 2, 3], "
        "unit: deg/s, zero_counts: 32768, limit_counts: 32767}}}",
        ["instrument.format.gyro.limit_counts", "65535 for unsigned counts"],
    ),
    "two zeros for three channels": (
        "span-cpt",
        "{name: a, format: {kind: columns, gyro: {columns: [1, 2, 3], unit: deg/s, "
        "zero_counts: [1, 2]}}}",
        ["zero_counts", "correct the value"],
    ),
    "a log of gyros beside messages of a receiver": (
        "log: session.asc",
        "log: session.asc\ngyro: {log: gyro.asc}",
        ["format", "remove gyro: the messages of a receiver hold both sensors"],
    ),
    "an axis twice": (
        "span-cpt",
        "{name: a, gyro: {axes: [x, -x, z]}}",
        ["instrument.gyro.axes", "each once"],
    ),
    "a gyro that reads gravity": (
        "span-cpt",
        "{name: a, gyro: {reads: gravity}}",
        ["instrument.gyro.reads", "axes: [-x, -y, -z]"],
    ),
    "positions of means without rows": (
        "plan:",
        MEANS + "plan:\n  - {id: all, do: positions, format: m}",
        ["plan[0]", "positions without rows", "add rows"],
    ),
    "a whole turn in means": (
        "plan:",
        MEANS + "plan:\n  - {id: t, do: turn, up: +x, degrees: 360, seconds: 9, format: m}",
        ["plan[0]", "add recorded: steady"],
    ),
    "a sigma of samples": (
        "plan:",
        MEANS.replace("mean_of: null", "time: {rate_hz: 100}")
        + "plan:\n  - {id: r, do: rest, up: +x, format: m}",
        ["sigma of gyro, whose rows are no means", "mean_of, null"],
    ),
    "sigma columns of samples": (
        "plan:",
        MEANS.replace("mean_of: null", "time: {rate_hz: 100}").replace(
            "sigma: 0.1", "sigma_columns: [4, 5, 6]"
        )
        + "plan:\n  - {id: r, do: rest, up: +x, format: m}",
        ["sigma_columns of gyro, whose rows are no means", "remove sigma_columns"],
    ),
    "two statements of a sigma": (
        "plan:",
        MEANS.replace("sigma: 0.1", "sigma: 0.1, sigma_columns: [4, 4, 4]")
        + "plan:\n  - {id: r, do: rest, up: +x, format: m}",
        ["both sigma and sigma_columns of gyro", "remove one"],
    ),
    "a mean without its sigma": (
        "plan:",
        MEANS.replace("sigma: 0.1", "sigma_columns: [4, null, 6]")
        + "plan:\n  - {id: r, do: rest, up: +x, format: m}",
        ["null in sigma_columns of gyro, whose means are recorded", "name the column"],
    ),
    "positions of no duration": (
        "plan:",
        "plan:\n  - {id: all, do: positions}",
        ["plan[0]", "no key 'seconds'", "add seconds"],
    ),
    "broken YAML": ("serial: ", "serial: [", ["line", "YAML 1.2"]),
    "an open quotation mark": (
        'serial: "A-017"',
        'serial: "A-017',
        ["line 3\n", "a quotation mark without the second one", "add the second one"],
    ),
    "a tab": ("date: ", "\tdate: ", ["line 4\n", "a tab before the key", "write blanks"]),
    "a second colon": (
        'serial: "A-017"',
        "serial: A: 017",
        ["line 3\n", "a second colon in the line", "put the text in quotes"],
    ),
}


@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_refused_with_file_place_and_cure(mistake, tmp_path):
    right, wrong, said = mistake
    assert right in BY_TABLE
    with pytest.raises(Refusal) as refused:
        planned(tmp_path, BY_TABLE.replace(right, wrong, 1))
    for part in [str(tmp_path / "campaign.yaml"), "found:", "expected:", "cure:", *said]:
        assert part in str(refused.value)


def test_a_missing_log_is_refused_with_the_place_that_names_it(tmp_path):
    with pytest.raises(Refusal, match=r"plan\[0\][\s\S]*'session.asc'[\s\S]*put the log there"):
        planned(tmp_path, BY_TABLE, logs=False)


def test_a_mistake_in_the_list_of_instruments_is_refused(tmp_path):
    listed = tmp_path / "instruments.yaml"
    shutil.copy(ROOT / "data/instruments.yaml", listed)
    listed.write_text(listed.read_text().replace("count_rad", "count_radd", 1))
    campaign = tmp_path / "campaign.yaml"
    campaign.write_text(BY_TABLE)
    with pytest.raises(Refusal, match=r"instruments.yaml, line \d+[\s\S]*write count_rad"):
        plan([campaign], [], [listed])


def test_the_schemas_give_a_description_with_every_number():
    from inertial.tables.yaml_file import schema_of

    def numbers(rule: object, path: str):
        if isinstance(rule, dict):
            if rule.get("type") in ("number", "integer") and "items" not in path.split("/")[-1:]:
                yield path, rule
            for key, value in rule.items():
                yield from numbers(value, f"{path}/{key}")

    for name in ("campaign", "config", "published"):
        missing = [path for path, rule in numbers(schema_of(name), "") if "description" not in rule]
        assert missing == []


def test_the_noise_of_the_data_sheet_in_si(tmp_path):
    text = BY_TABLE.replace(
        "instrument: span-cpt",
        """instrument:
  name: of the data sheet
  rate_hz: 100
  axes: [z, -y, x]
  format: {kind: rawimus}
  gyro: {count_rad: 1.0e-7, bias_instability_deg_h: 0.5, rate_random_walk_deg_h_sqrt_h: 6}
  accelerometer:
    count_m_s: 1.5e-6
    bias_instability_ug: 50
    acceleration_random_walk_ug_sqrt_h: 60
""",
    )
    rows = planned(tmp_path, text)["sensors"].query("axis == 'z'").set_index("sensor")
    # 0.5 °/h is 2.4241e-6 rad/s, the lowest point of the curve, 0.6643 of the coefficient B
    assert rows["bias_instability"]["gyro"] == pytest.approx(2.4241e-6 / 0.6643, rel=1e-4)
    assert rows["bias_instability"]["accel"] == pytest.approx(4.90333e-4 / 0.6643, rel=1e-4)
    assert rows["random_walk"]["gyro"] == pytest.approx(2.9089e-5 / 60, rel=1e-4)
    assert rows["random_walk"]["accel"] == pytest.approx(9.80665e-6)
    stated = planned(tmp_path / "again", BY_TABLE)["sensors"]
    assert stated[["bias_instability", "random_walk"]].isna().all(axis=None)


def test_positions_of_means_are_a_static_position_for_each_row(tmp_path):
    positions = "plan:\n  - {id: all, do: positions, rows: [9, 12], format: m}"
    made = planned(tmp_path, BY_TABLE.replace("plan:", MEANS + positions))
    rests = made["manoeuvres"].head(3)
    assert list(rests["manoeuvre"]) == ["all-09", "all-10", "all-11"]
    assert list(rests["do"]) == ["rest"] * 3 and rests["up_x"].isna().all()
    assert [*zip(rests["from_row"], rests["to_row"], strict=True)] == [(9, 10), (10, 11), (11, 12)]
    sigma = made["ranges"].set_index(["log", "sensor"])["sigma"]
    assert sigma["session.asc:m", "gyro"].to_list() == pytest.approx([radians(0.1)] * 3)
    assert sigma["session.asc:m", "accel"].isna().all()


COUNTS = """{name: a, axes: [z, -x, y], accelerometer: {axes: [x, y, z], reads: gravity}, format: {
    kind: columns, time: {rate_hz: 100},
    gyro: {columns: [1, 2, 3], unit: rad/s, counts_per_unit: [1, 2, 4], limit_counts: 10},
    accelerometer: {columns: [4, 5, 6], unit: m/s2, counts_per_unit: 2, zero_counts: [5, 6, 7],
      limit_counts: 12}}}
"""


def test_counts_and_limits_go_with_the_axes_of_their_columns(tmp_path):
    made = planned(tmp_path, BY_TABLE.replace("span-cpt", COUNTS))
    ranges = made["ranges"].set_index(["sensor", "axis"])
    assert ranges["count"].loc["gyro"].to_dict() == {"x": 1 / 2, "y": 1 / 4, "z": 1}
    assert ranges["limit"].loc["gyro"].to_dict() == {"x": 5, "y": 2.5, "z": 10}
    # The farther end: 12 − 5 counts up, 6 and 7 down.
    assert ranges["limit"].loc["accel"].to_dict() == {"x": 3.5, "y": 3, "z": 3.5}
    axes = json.loads(made["logs"]["layout"].iloc[0])["axes"]
    assert axes == {"accel": ["-x", "-y", "-z"], "gyro": ["z", "-x", "y"]}


def test_a_count_of_increments_is_one_over_a_sample(tmp_path):
    counts = COUNTS.replace("unit: rad/s", "unit: rad")
    ranges = planned(tmp_path, BY_TABLE.replace("span-cpt", counts))["ranges"]
    ranges = ranges.set_index(["sensor", "axis"])
    assert ranges["increments"].loc["gyro"].all() and not ranges["increments"].loc["accel"].any()
    assert ranges["count"].loc["gyro"].to_dict() == {"x": 1 / 2, "y": 1 / 4, "z": 1}


def test_a_table_that_counts_clockwise_turns_the_other_way(tmp_path):
    clockwise = BY_TABLE.replace("{name: three-axis", "{name: three-axis, counts: clockwise")
    clockwise += "  - {id: t, do: tumble, about: +x, up: +z, step_degrees: 90, steps: 2}\n"
    planned_way = planned(tmp_path, clockwise)["manoeuvres"].set_index("manoeuvre")
    turn = planned_way.loc["x-forward"]
    assert turn["angle"] == pytest.approx(-2 * np.pi) and turn["rate"] == pytest.approx(
        -radians(10)
    )
    # The right-hand rule about x would bring y up.
    assert planned_way.loc["t-01", "up_y"] == pytest.approx(-1)


BY_HAND = """\
campaign: 1
instrument:
  {name: a, rate_hz: 50, format: {kind: columns, accelerometer: {columns: [1, 2, 3], unit: g}}}
serial: unknown
date: unknown
site: {latitude_deg: null, gravity_m_s2: 9.81}
log: log.txt
plan: [{id: by-hand, do: positions, seconds: 1}]
"""


def test_by_hand_the_table_may_be_left_out_where_no_position_is_set(tmp_path):
    made = planned(tmp_path, BY_HAND)
    assert made["campaign"]["table"].item() == "by hand"
    position = made["known"].set_index("quantity").loc["position"]
    assert not position["assumed"] and "no position is set" in position["origin"]


def test_a_date_needs_no_quotation_marks(tmp_path):
    made = planned(tmp_path, BY_HAND.replace("date: unknown", "date: 2026-11-02"))
    assert made["campaign"]["date"].item() == "2026-11-02"


def test_the_rate_of_the_instrument_counts_rows_without_time(tmp_path):
    (layout,) = planned(tmp_path, BY_HAND)["logs"]["layout"]
    assert json.loads(layout)["time"] == {"rate_hz": 50}
    one_place = BY_HAND.replace("rate_hz: 50, ", "").replace(
        "columns,", "columns, time: {rate_hz: 50},"
    )
    made = planned(tmp_path, one_place)
    assert json.loads(made["logs"]["layout"].item())["time"] == {"rate_hz": 50}
    assert made["campaign"]["rate"].item() == 50


APART = """\
formats:
  a: {kind: columns, time: {column: 1, unit: s}, accelerometer: {columns: [2, 3, 4], unit: g}}
  g: {kind: columns, time: {column: 1, unit: ms}, gyro: {columns: [2, 3, 4], unit: deg/s}}
gyro: {log: gyro.txt, format: g}
"""
BESIDE = BY_TABLE.replace("seconds: 300", "seconds: 300, format: a")
BESIDE = BESIDE.replace("accel_deg_s2: 5", "accel_deg_s2: 5, format: a")


def test_a_log_of_the_gyros_goes_with_the_log_of_the_campaign(tmp_path):
    made = planned(tmp_path, BESIDE + APART)
    assert list(made["logs"]["log"]) == ["session.asc"]
    assert set(made["inputs"]["file"]) == {"campaign.yaml", "session.asc", "gyro.txt"}
    own = "format: a, log: other.asc, gyro: {log: g2.txt, format: g}}"
    made = planned(tmp_path, BESIDE.replace("format: a}", own, 1) + APART)
    assert {"other.asc", "g2.txt"} < set(made["inputs"]["file"])


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ("time: {column: 1, unit: ms}", "mean_of: 1", ["formats.g", "no 'time'", "add time"]),
        (", gyro: {columns", ", accelerometer: {columns", ["formats.g", "no 'gyro'"]),
        ("format: g}", "format: h}", ["gyro.format", "'h'", "one of a, g"]),
        ("log: gyro.txt", "log: ../gyro.txt", ["gyro.log", "plain file name"]),
        ("seconds: 300", "seconds: 300, where: {a: 1}", ["plan[0].where", "select by time"]),
        ("accel_deg_s2: 5", "accel_deg_s2: 5, gyro: {log: b.txt, format: g}", ["plan[1].gyro"]),
    ],
)
def test_a_mistake_about_the_log_of_the_gyros_is_refused(tmp_path, before, after, said):
    text = BESIDE + APART
    assert before in text
    with pytest.raises(Refusal) as refused:
        planned(tmp_path, text.replace(before, after, 1))
    for part in [*said, "cure:"]:
        assert part in str(refused.value)


ENCODER = """\
encoder: {log: table.txt, format: table}
formats: {table: {kind: columns, time: {column: 1, unit: s}, table_angle: {column: 2, unit: deg}}}
"""


def test_the_encoder_s_log_goes_with_every_log_and_is_listed(tmp_path):
    made = planned(tmp_path, BY_TABLE + ENCODER)
    (layout,) = made["logs"]["layout"]
    assert '"encoder": {"file": "table.txt"' in layout
    assert set(made["inputs"]["file"]) == {"campaign.yaml", "session.asc", "table.txt"}


@pytest.mark.parametrize(
    ("before", "after", "found"),
    [
        ("format: table}", "format: tabel}", "tabel"),
        ("time: {column: 1, unit: s}, ", "", "no time"),
        ("log: table.txt", "log: ../table.txt", "table.txt"),
        (", format: table}", "}", "no key 'format'"),
    ],
)
def test_a_mistake_about_the_encoder_is_refused_by_name(tmp_path, before, after, found):
    text = ENCODER.replace(before, after, 1)
    assert text != ENCODER
    with pytest.raises(Refusal, match=found):
        planned(tmp_path, BY_TABLE + text)
