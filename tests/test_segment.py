"""Where the manoeuvres are: in the demo, in one long log, and where plan and log disagree."""

from dataclasses import fields, replace
from math import degrees

import chain
import numpy as np
import pytest

import laboratory
from inertial import tables
from inertial.campaign.masked_samples import Batch, Masks
from inertial.campaign.records import Clock, Manoeuvre
from inertial.signal.rests_and_motions import BinStretch, slow_motion, steady_part
from stages.segment import windows
from stages.segment.located import begun_as_recorded, divide, locate
from stages.segment.matching import Observation, match, rest_part, turn_parts
from stages.segment.recording_explanations import explained_of


def performed(results: chain.Results):
    return results["segment/performed"].set_index("manoeuvre")


def recorded(document, folder, until="segment") -> chain.Results:
    return chain.run(chain.simulate(document, folder / "campaign"), folder / "derived", until)


def test_the_gap_of_the_demo_is_the_one_that_was_found_by_hand(demo):  # T4
    gap = demo["quality/gaps"].iloc[0]
    assert len(demo["quality/gaps"]) == 1
    assert gap["log"] == "z-backward.asc"
    assert gap["missing"] == 1197
    assert gap["to_s"] - gap["from_s"] == pytest.approx(11.98, abs=1e-6)
    # At the -10.00935 °/s that S0's lines have, 1197 samples are 119.81°.
    assert pytest.approx(119.81, abs=5e-3) == 1197 * 0.01 * 10.00935
    turn = performed(demo).loc["z-backward"]
    assert turn["missing_s"] == pytest.approx(11.97)
    assert degrees(turn["missing_angle"]) == pytest.approx(-119.7, abs=0.1)
    assert degrees(turn["angle"]) == pytest.approx(-240.3, abs=0.1)


def test_the_turn_with_a_gap_is_bridged_and_its_gap_the_only_finding(demo):
    assert demo["segment/findings"].empty
    found = demo["quality/findings"]
    (gap,) = found[found["cause"] == "gap"].to_dict("records")
    assert gap["log"] == "z-backward.asc"
    # 1197 samples at 100 Hz and 10 °/s
    assert "gap of 12.0 s" in gap["sentence"] and "turned by 120° during the gap" in gap["sentence"]
    turn = performed(demo).loc["z-backward"]
    assert turn["bridged"] and not turn["complete"]
    fitted = demo["gyroscope/fit_manoeuvres"].query("method == 'joint'")
    assert fitted.set_index("manoeuvre").loc[["z-backward"], "used"].all()
    others = performed(demo).drop("z-backward")
    assert others["complete"].all() and not others["bridged"].any()


def test_the_phases_of_a_turn_follow_its_profile(clean):
    segments = clean[0]["segment/segments"]
    turn = segments[segments["manoeuvre"] == "x-forward"]
    assert list(turn["phase"]) == ["rest-before", "spin-up", "steady", "spin-down", "rest-after"]
    steady = turn.set_index("phase").loc["steady"]
    # 34 s at the rate between two ramps of 2 s; a bin of 0.1 s at each end is left to the ramps.
    assert steady["to_s"] - steady["from_s"] == pytest.approx(34, abs=0.4)
    # No record belongs to two phases, and none between them is lost.
    assert (turn["from_record"].iloc[1:].to_numpy() == turn["to_record"].iloc[:-1].to_numpy()).all()


def test_blocks_keep_every_increment(clean):
    """The sum of a turn's blocks is the sum of its samples: angles never pass through a rate."""
    blocks = clean[0]["segment/blocks"]
    samples = clean[0]["decode/samples"]
    turn = blocks[(blocks["manoeuvre"] == "y-forward")]
    inside = samples[
        (samples["log"] == "y-forward.asc")
        & (samples["record"] >= turn["from_record"].min())
        & (samples["record"] < turn["to_record"].max())
    ]
    interval = clean[0]["decode/clocks"]["interval"].iloc[0]
    by_blocks = (turn["gyro_y"] * turn["seconds"]).sum()
    assert by_blocks == pytest.approx(inside["gyro_y"].sum() * interval, abs=1e-12)
    count = 0.1 / (3600 * 256)
    assert inside["gyro_y"].sum() * interval / count == pytest.approx(
        round(inside["gyro_y"].sum() * interval / count), abs=1e-4
    )


def test_the_bins_of_a_long_campaign_are_longer_and_find_the_same(clean, monkeypatch):
    fine = clean[0]["segment/segments"]
    monkeypatch.setattr(windows, "MAX_BINS", 8000)
    binned = windows.Bins.binned
    bins = []

    def counted(self):
        for window in binned(self):
            bins.append(window.bins)
            yield window

    monkeypatch.setattr(windows.Bins, "binned", counted)
    coarse = chain.again(clean[0], "segment")
    assert sum(bins) <= 8000 + len(bins)  # each window may begin another one
    assert coarse["performed"]["complete"].all()
    assert list(coarse["segments"]["phase"]) == list(fine["phase"])
    length = clean[0]["decode/clocks"]["records"].sum() * 0.01 / 8000
    for end in ("from_s", "to_s"):
        np.testing.assert_allclose(coarse["segments"][end], fine[end], atol=3 * length)
    assert coarse["findings"].empty


def rest_and_turn(folder, stated, read):
    """A rest and a turn of 360° recorded by the laboratory; `read` in place of what it states."""
    document = chain.demo()
    document["campaign"]["plan"] = [
        {"id": "still", "do": "rest", "up": "+z", "seconds": 20, "log": "still.asc"},
        {"id": "turn", "do": "turn", "up": "+z", "degrees": 360, "rate_deg_s": 10,
         "accel_deg_s2": 5, "log": "turn.asc"},
    ]  # fmt: skip
    campaign = chain.simulate(document, folder) / "campaign.yaml"
    campaign.write_text(campaign.read_text().replace(stated, read))
    return folder


@pytest.mark.slow
def test_a_turn_the_wrong_way_is_found_and_refused(tmp_path):
    folder = rest_and_turn(tmp_path / "campaign", "degrees: 360", "degrees: -360")
    results = chain.run(folder, tmp_path / "derived")
    assert "wrong_direction" in set(results["segment/findings"]["cause"])
    scale = results.parameters("gyroscope").loc["scale_z"]
    assert np.isnan(scale["value"])


def rotated(*degrees):
    """What motions through these angles about z show, with a rest of 20 s before each."""
    zero, up = np.zeros(3), np.array([0, 0, 9.8])
    rest = Observation(False, 20.0, up, zero, zero, zero)
    shown = []
    for angle in np.radians(degrees):
        rate = np.array([0, 0, angle / 10.0])
        shown += [rest, Observation(True, 10.0, up, rate, 10.0 * rate, zero)]
    return [*shown, rest]


def planned_turns(*degrees):
    """Turns about z, which is up."""
    nothing = dict.fromkeys(field.name for field in fields(Manoeuvre))
    z = np.array([0.0, 0.0, 1.0])
    turn = nothing | {"do": "turn", "recorded": "whole", "log": "log", "up": z, "about": z}
    return [Manoeuvre(**turn | {"name": f"{k}", "angle": np.radians(d)})
            for k, d in enumerate(degrees)]  # fmt: skip


@pytest.mark.parametrize(
    ("planned", "done", "places"),
    [
        # A change of position, then the turn, once as planned and once the other way.
        ((360, -360), (5, 360, -360), (3, 5)),
        ((360, -360), (5, -360, -360), (3, 5)),
        ((360, -360), (90, -360, -360), (3, 5)),
        # One of two was not done: the other one is as planned, and not this one the other way.
        ((360, -360), (5, -360), (1, 3)),
        ((360, -360), (5, 360), (3, None)),
        # The log ends in a turn, and the table went back without plan.
        ((360, 360), (360, -360, 200), (1, 5)),
    ],
)
def test_a_whole_turn_the_other_way_is_the_turn_and_a_small_motion_is_not(planned, done, places):
    found = match(planned_turns(*planned), rotated(*done))
    assert tuple(found.values()) == places


def test_of_two_motions_through_one_angle_the_turn_is_that_in_its_time():
    """The table went back by the planned angle in 10 s, and then turned so at 5°/s, in 17 s."""
    (turn,) = planned_turns(-86.5)
    *_, back, rest = rotated(-86.5)
    slow = replace(back, seconds=17.3, rate=back.rate / 1.73)
    planned = replace(turn, rate=-np.radians(5))
    assert match([planned], [rest, back, rest, slow, rest]) == {"0": 3}
    assert match([planned], [rest, slow, rest, back, rest]) == {"0": 1}


@pytest.mark.parametrize("unit", [180 / np.pi, np.pi / 180, 1000.0, 0.25])
def test_turns_in_another_unit_are_not_the_changes_of_position(unit):
    """A change by 90° before each turn is, in the wrong unit, as near to its plan or nearer."""
    plan, done = planned_turns(360, -360, 720, -180), np.array([90, 360, 45, -360, 720, -90, -180])
    assert list(match(plan, rotated(*done)).values()) == [3, 7, 9, 13]
    assert list(match(plan, rotated(*unit * done)).values()) == [3, 7, 9, 13]


def test_changes_of_position_alone_are_no_turns_in_another_unit():
    """They are not all by one share of the planned angles; what is nearest is taken for each."""
    found = match(planned_turns(360, -360, 360), rotated(90, 45, 90))
    assert found == {"0": 1, "1": None, "2": 5}


@pytest.mark.slow
def test_one_turn_of_a_long_log_the_wrong_way_is_the_only_finding(tmp_path):
    document = session()
    plan = document["campaign"]["plan"]
    # Before it the table goes from up-z to down-z, and a little about the axis of the turn.
    (turn,) = (one for one in plan if one["id"] == "down-z-forward")
    turn["degrees"] = -360
    document["misstated"] = {"plan": {"down-z-forward": {"degrees": 360}}}
    results = recorded(document, tmp_path)
    (finding,) = results["segment/findings"].to_dict("records")
    assert (finding["cause"], finding["manoeuvre"]) == ("wrong_direction", "down-z-forward")
    assert finding["size"] == pytest.approx(-1, abs=2e-3)
    assert "in place of 360°" in finding["sentence"]
    assert "state degrees: -360 for down-z-forward" in finding["action"]
    assert performed(results).drop("down-z-forward")["complete"].all()


def test_a_count_of_the_wrong_unit_is_named(tmp_path):  # T3, what S0's own log says of its IMU
    folder = rest_and_turn(tmp_path / "campaign", "span-cpt", "imar-fsas")
    results = chain.run(folder, tmp_path / "derived", "segment")
    wrong = results["segment/findings"].set_index("cause").loc["wrong_scale_factor"]
    assert 1 / wrong["size"] == pytest.approx(57.29578, rel=2e-3)
    assert "the counts are those of span-cpt" in wrong["sentence"]
    assert "radians but are read as degrees" in wrong["sentence"]
    assert "rate_off" in set(results["quality/findings"]["cause"])  # 100 Hz, stated 200 Hz


def session() -> dict:
    """Rests and turns one after another in one log, as S3 records them."""
    document = chain.demo()
    plan = []
    for up in ("+z", "-z", "+x"):
        name = up.translate({ord("+"): "up-", ord("-"): "down-"})
        place = {"up": up, "position": name}
        turn = {"rate_deg_s": 12, "accel_deg_s2": 12}
        plan += [
            {"id": f"{name}-before", "do": "rest", **place, "seconds": 20},
            {"id": f"{name}-forward", "do": "turn", **place, "degrees": 360, **turn},
            {"id": f"{name}-back", "do": "turn", **place, "degrees": -360, **turn},
            {"id": f"{name}-after", "do": "rest", **place, "seconds": 20},
        ]
    document["campaign"] |= {"plan": plan, "log": "session.asc"}
    document["handling"] = {"still_s": 10, "change_s": 15}
    return document


def test_one_long_log_is_aligned_with_the_plan(tmp_path):
    results = recorded(session(), tmp_path)
    done = performed(results)
    assert done["found"].all() and done["complete"].all()
    turns = done[done.index.str.contains("forward|back")]
    np.testing.assert_allclose(np.degrees(turns["angle"].abs()), 360, atol=1)
    rests = done[done.index.str.contains("before|after")]
    assert (rests["seconds"] > 18).all()
    assert results["segment/findings"].empty


def tumbled(degrees):
    """What rests with these angles about y show: z up at 0, turned by 3° in the fixture."""
    lean = np.radians(np.asarray(degrees, float) + 3.0)
    forces = 9.8 * np.column_stack([np.sin(lean), np.zeros(len(lean)), np.cos(lean)])
    zero = np.zeros(3)
    return [Observation(False, 20.0, force, zero, zero, zero) for force in forces]


def planned_tumble(degrees):
    lean = np.radians(np.asarray(degrees, float))
    nothing = dict.fromkeys(field.name for field in fields(Manoeuvre))
    rest = nothing | {"do": "rest", "log": "log", "seconds": 20.0}
    ups = np.column_stack([np.sin(lean), np.zeros(len(lean)), np.cos(lean)])
    return [Manoeuvre(**rest | {"name": f"{k}", "up": up}) for k, up in enumerate(ups)]


def test_a_position_of_a_tumble_that_was_not_done_shifts_no_other():
    """In steps of 20 degrees: each rest after it was taken for the next one, within 25 degrees."""
    steps = np.arange(0, 360, 20)
    done = np.delete(steps, 5)
    found = match(planned_tumble(steps), tumbled(done))
    assert found["5"] is None
    for k in range(len(steps)):
        if k != 5:
            assert done[found[f"{k}"]] == steps[k]


def test_two_rests_of_one_position_that_are_one_rest_shift_no_other():
    """There and back: the turning point is planned twice, and nothing moves there."""
    there = [*range(0, 360, 20)]
    plan, done = [*there, *there[::-1]], [*there, *there[-2::-1]]
    found = match(planned_tumble(plan), tumbled(done))
    (lost,) = (k for k in range(len(plan)) if found[f"{k}"] is None)
    assert plan[lost] == 340
    assert all(done[found[f"{k}"]] == plan[k] for k in range(len(plan)) if k != lost)


def test_a_manoeuvre_that_was_not_done_is_a_finding_and_the_rest_are_still_aligned(tmp_path):
    document = session()
    folder = chain.simulate(document, tmp_path / "campaign")
    campaign = folder / "campaign.yaml"
    text = campaign.read_text()
    # The plan claims a rest with y up that never was, between two that were.
    extra = "- {id: extra, do: rest, up: +y, seconds: 20}"
    lines = text.splitlines()
    at = next(i for i, line in enumerate(lines) if "down-z-before" in line)
    while not lines[at].lstrip().startswith("-"):
        at -= 1
    indent = lines[at][: len(lines[at]) - len(lines[at].lstrip())]
    campaign.write_text("\n".join([*lines[:at], indent + extra, *lines[at:]]) + "\n")
    results = chain.run(folder, tmp_path / "derived", "segment")
    done = performed(results)
    assert not done.loc["extra", "found"]
    assert done.drop("extra")["complete"].all()
    assert list(results["segment/findings"]["cause"]) == ["manoeuvre_missing"]


@pytest.mark.parametrize(
    ("bin_seconds", "margin", "first", "after"),
    [(0.1, 0.5, 35, 85), (1.2, 0.5, 31, 89), (1.2, 0.0, 30, 90)],
)
def test_a_rest_keeps_clear_of_motion_however_long_the_bins_are(bin_seconds, margin, first, after):
    """A campaign of more than 23 days has bins longer than its margins."""
    window, nothing = windows.Window("log", 0, 120, []), np.zeros((120, 3))
    time = bin_seconds * np.arange(120)
    one = windows.Binned(
        window, np.arange(121), nothing, nothing, np.full(120, bin_seconds), time, time
    )
    part = rest_part(one, BinStretch(moves=False, first=30, after=90), "rest", margin)
    assert (part.first, part.after) == (first, after)


def test_a_masked_tail_is_not_what_the_gyros_read_at_rest():
    """Its rates are on a straight line from the last one, of a motion, and have no scatter."""
    noise = np.random.default_rng(3).normal(0, 1e-4, (100, 3))
    bias = np.array([0.01, -0.02, 0.005])
    moves = np.arange(100) % 40 >= 30
    rates = np.vstack([bias + noise + moves[:, None] * [0.5, 0.2, 0.0], np.full((400, 3), 0.3)])
    seconds = np.where(np.arange(500) < 100, 0.1, 0.0)
    forces, time = np.tile([0.0, 0.0, 9.8], (500, 1)), 0.1 * np.arange(500)
    window = windows.Window("log", 0, 500, [])
    one = windows.Binned(window, np.arange(501), rates, forces, seconds, time, time)
    level, _explained = explained_of([one], [], 0.0)
    assert level == pytest.approx(bias, abs=1e-4)


NOISE_OF_BIN = np.radians(1e-3)  # rad/s, of a mean over 0.1 s


def turned_through(plateau_s: float, poles: np.ndarray, seed: int = 6):
    """What a gyro shows of a turn at 24 °/s with ramps of 1 s, and the table's rate, in bins.

    The gyro's low pass has these poles, 1/s, and gain 1: each a residue of its partial fractions.
    """
    fine, step = 100, 1e-3
    rate = np.radians(24)
    time = step * np.arange(round((plateau_s + 3) / step))
    table = rate * np.clip(np.minimum(time, plateau_s + 2 - time), 0, 1)
    shown = table.astype(complex) if not len(poles) else np.zeros(len(time), complex)
    for pole in poles:
        others = poles[poles != pole]
        residue = np.prod(-poles) / np.prod(pole - others)
        kept, state = np.exp(pole * step), 0j
        for k, value in enumerate(table):
            state = kept * state + residue * value * (kept - 1) / pole
            shown[k] += state
    noise = NOISE_OF_BIN * np.random.default_rng(seed).standard_normal(len(time) // fine)
    return shown.real.reshape(-1, fine).mean(axis=1) + noise, rate


# 1st order 2 Hz; 2nd order 4 Hz with a damping of 0.5, which rings.
ONE_POLE = np.array([-2 * np.pi * 2 + 0j])
TWO_POLES = 2 * np.pi * 4 * np.exp(1j * np.pi * np.array([2 / 3, -2 / 3]))


@pytest.mark.parametrize("poles", [ONE_POLE, TWO_POLES], ids=["one pole", "two poles"])
@pytest.mark.parametrize("plateau_s", [5.0, 15.0, 120.0])
def test_a_rate_is_steady_once_the_gyro_has_settled(poles, plateau_s):
    """Behind the ramp it lacks c exp(-t/τ): of 24 °/s² and 80 ms 1.9 °/s, in 0.6 s the noise."""
    about, rate = turned_through(plateau_s, poles)
    first, after = steady_part(about)
    # Of a ramp of 1 s the fractions are residue/pole² exp(pole t) since it ended, at 1 s.
    parts = [np.prod(-poles) / np.prod(p - poles[poles != p]) / p**2 for p in poles]
    left = rate * np.abs(parts).sum() * np.exp(poles.real.max() * (0.1 * first - 1.0))
    assert left < NOISE_OF_BIN
    assert 0.1 * first < 1.0 + 1.3 and abs(after - 10 * (plateau_s + 1.0)) <= 1
    assert (after - first) >= 7 * plateau_s


@pytest.mark.parametrize("plateau_s", [2.0, 15.0])
def test_a_turn_at_once_at_its_rate_is_steady_from_the_ramp_on(plateau_s):
    about, _rate = turned_through(plateau_s, np.array([]))
    first, after = steady_part(about)
    assert abs(0.1 * first - 1.0) <= 0.11 and abs(0.1 * after - plateau_s - 1.0) <= 0.11


def test_a_rate_that_does_not_settle_is_kept_whole():
    """The drive drifts by 4 % of its rate all along: no settling explains that."""
    about, _rate = turned_through(15.0, np.array([]))
    first, after = steady_part(about * np.linspace(1.02, 0.98, len(about)))
    assert abs(0.1 * first - 1.0) <= 0.11 and abs(0.1 * after - 16.0) <= 0.11


MARKS = {"x": "yz", "y": "zx", "z": "xy"}


def by_azimuths(without: tuple[str, ...] = ()) -> dict:
    """Four azimuths on each of six faces, in one log, but for rests that are not done."""
    document = chain.short()
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "simulated", "rate_hz": 100}
    document["campaign"]["plan"] = [
        {"id": f"{up}-{k}", "do": "rest", "up": up, "mark": sign + mark, "seconds": 20}
        for up in (way + axis for axis in "xyz" for way in "+-")
        for k, (sign, mark) in enumerate((s, m) for s in "+-" for m in MARKS[up[1]])
        if f"{up}-{k}" not in without
    ]
    document["campaign"]["log"] = "session.csv"
    document["campaign"]["table"]["heading_deg"] = 20
    document["handling"]["change_s"] = 8
    return document


def of_accelerometers(text: str) -> str:
    """The columns of the gyros are not read."""
    start = text.index("gyro: {columns")
    return text[:start] + text[text.index("accelerometer: {columns") :]


@pytest.mark.slow
def test_turns_that_accelerometers_do_not_see_leave_the_rests_of_the_plan():
    recording = laboratory.perform(laboratory.specify(by_azimuths()))
    results = chain.in_memory(recording, "diagnosis", edit=of_accelerometers)
    done, rests = performed(results), results["segment/segments"].set_index("manoeuvre")
    assert done["found"].all() and len(rests) == 24
    # Where they were, one every 28 s, but for a part of the time of a change: none shows it better.
    np.testing.assert_allclose(rests["from_s"], 28.0 * np.arange(24), atol=4)
    (finding,) = results["segment/findings"].to_dict("records")
    assert (finding["cause"], finding["count"], finding["size"]) == ("rests_divided", 6, 24)
    assert "+x-0, +x-1, +x-2, +x-3" in finding["sentence"]
    # It is no fault, and nothing is said of gyros but that there are none.
    assert results["diagnosis/causes"].empty
    first, second = results["diagnosis/verdict"].to_dict("records")
    assert (first["sensor"], first["verdict"]) == ("accel", "usable")
    assert second["sentence"] == "Gyros: none is recorded."


@pytest.mark.slow
def test_three_rests_of_accelerometers_that_walk_have_no_result_and_no_exception():
    document = by_azimuths()
    rests = [{"id": f"{axis}-up", "do": "rest", "up": f"+{axis}", "seconds": 300} for axis in "xyz"]
    document["campaign"]["plan"] = rests
    document["noise"]["accelerometer_random_walk_m_s2_sqrt_h"] = 0.05
    recording = laboratory.perform(laboratory.specify(document))
    results = chain.in_memory(recording, "diagnosis", edit=of_accelerometers)
    first, _second = results["diagnosis/verdict"].to_dict("records")
    assert (first["sensor"], first["verdict"]) == ("accel", "not_usable")
    assert "Not usable: no parameter is determined." in first["sentence"]
    assert results["noise/levels"]["random_walk"].max() > 0  # which no equation can be without


def test_gyros_that_are_recorded_show_the_turns_between():
    recording = laboratory.perform(laboratory.specify(by_azimuths()))
    results = chain.in_memory(recording, "segment")
    assert performed(results)["found"].all() and results["segment/findings"].empty


def still(forces, seconds):
    """A log of accelerometers alone in bins of 0.1 s, with z up, that nothing is seen to move."""
    time = 0.1 * np.arange(round(10 * seconds))
    nothing = np.full((len(time), 3), np.nan)
    level = np.array([0, 0, 9.8]) + forces(time)
    window = windows.Window("log", 0, len(time), [])
    edges = np.arange(len(time) + 1)
    return windows.Binned(window, edges, nothing, level, np.full(len(time), 0.1), time, time)


def planned_rests(*seconds):
    nothing = dict.fromkeys(field.name for field in fields(Manoeuvre))
    rest = nothing | {"do": "rest", "log": "log", "up": np.array([0.0, 0.0, 1.0])}
    return [Manoeuvre(**rest | {"name": f"{k}", "seconds": s}) for k, s in enumerate(seconds)]


def parts(binned, plan):
    division = divide(binned, np.zeros(3), 0.01, 0.001, swings=False)
    located = locate(division, manoeuvres=plan)
    places = [located.place(m) for m in plan]
    return [None if p is None else (located.stretches[p].first, located.stretches[p].after)
            for p in places]  # fmt: skip


def test_a_still_stretch_is_divided_at_equal_distances_where_no_reading_shows_more():
    noise = np.random.default_rng(7).standard_normal((1000, 3))
    quiet = still(lambda time: 1e-4 * noise, 100)
    # Three rests of 20 s in 100 s, and 20 s between them.
    assert parts(quiet, planned_rests(20, 20, 20)) == [(0, 200), (400, 600), (800, 1000)]


def test_another_tilt_divides_a_still_stretch_where_it_begins():
    """The second position is off by 1 mrad, and begins at 30 s: equal distances are 20 s off."""
    noise = np.random.default_rng(7).standard_normal((1000, 3))
    tilted = still(
        lambda time: 1e-4 * noise + np.outer((time > 30) & (time < 55), [9.8e-3, 0, 0]), 100
    )
    first, second, third = parts(tilted, planned_rests(20, 20, 20))
    assert first[1] <= 301 and third[0] >= 549
    assert second[0] >= 300 and second[1] <= 551


def test_a_rest_for_which_a_still_stretch_has_no_time_is_missing():
    noise = np.random.default_rng(7).standard_normal((500, 3))
    quiet = still(lambda time: 1e-4 * noise, 50)
    assert parts(quiet, planned_rests(20, 20, 20)).count(None) == 1


@pytest.mark.parametrize(("behind", "rests"), [((9.8, 0, 0), 2), ((0, 0, 9.8), 1)])
@pytest.mark.parametrize("inside", [False, True], ids=["between two bins", "within one"])
def test_what_is_set_anew_in_a_pause_of_the_recording_is_another_rest(behind, rests, inside):
    """30 s with z up, and after 40 min another 30 s; it was one rest of both."""
    first = np.concatenate([0.1 * np.arange(300), 2430 + 0.1 * np.arange(300)])
    last = first + 0.08
    if inside:
        last[299] = 2429.98
    forces = np.repeat([(0, 0, 9.8), behind], 300, axis=0)
    rates = 1e-4 * np.random.default_rng(8).standard_normal((600, 3))
    window = windows.Window("log", 0, 600, [])
    edges, seconds = np.arange(601), np.full(600, 0.1)
    binned = windows.Binned(window, edges, rates, forces, seconds, first, last)
    found = locate(divide(binned, np.zeros(3), 0.01, 0.001, swings=False), manoeuvres=[])
    still = [stretch for stretch in found.stretches if not stretch.moves]
    assert len(still) == rests and still[-1].after == 600
    assert rests == 1 or (still[0].after == 299 and still[1].first in (300, 301))


def test_the_windows_of_a_log_may_overlap():
    """Turns that the plan selects lay in the window of all others; nine "were not there"."""
    n = 1000
    readings = {channel: np.arange(n, dtype=float) for channel in tables.CHANNELS}
    columns = {"record": np.arange(n), "time": 0.01 * np.arange(n), "mean_of": np.ones(n)}
    made = [windows.Window("log", *span, []) for span in ((0, n), (200, 400), (300, 500))]
    masks = Masks(tables.MASKS.empty())
    bins = windows.Bins(made, {"log": Clock(0.01)}, masks)
    for part in np.array_split(np.arange(n), 3):
        bins.add(
            Batch("log", {name: column[part] for name, column in (columns | readings).items()})
        )
    for window, binned in zip(made, bins.binned(), strict=True):
        assert binned.window == window
        middles = np.arange(window.first, window.after, 10) + 4.5
        assert binned.forces[:, 0] == pytest.approx(middles)


def in_bins(forces: np.ndarray, seed: int) -> windows.Binned:
    """Rests in bins of 0.1 s without a pause, the gyros still in all of them."""
    k, noise = len(forces), np.random.default_rng(seed)
    time, rates = 0.1 * np.arange(k), 1e-4 * noise.standard_normal((k, 3))
    forces = forces + 1e-3 * noise.standard_normal((k, 3))
    window, edges = windows.Window("log", 0, k, []), np.arange(k + 1)
    return windows.Binned(window, edges, rates, forces, np.full(k, 0.1), time, time + 0.08)


def rests_of(binned: windows.Binned) -> list[BinStretch]:
    divided = divide(binned, np.zeros(3), 0.01, 0.001, swings=False)
    found = locate(divided, manoeuvres=[]).stretches
    return [stretch for stretch in found if not stretch.moves]


def test_rests_joined_without_what_lay_between_are_several():
    """They were one, in which biases jump by −19.6 m/s²; a tilt of 2° is none of these."""
    ups = [(9.8, 0, 0), (-9.8, 0, 0), (0, 9.8, 0), (0.34, 9.79, 0)]
    still = rests_of(in_bins(np.repeat(ups, 200, axis=0), 9))
    assert [(s.first, s.after) for s in still] == [(0, 199), (201, 399), (401, 800)]


def test_a_hand_that_shakes_the_accelerometers_alone_is_no_part_of_a_rest():
    forces = np.tile([0, 0, 9.8], (300, 1)).astype(float)
    forces[:8] += 0.05 * np.random.default_rng(2).choice([-1, 1], (8, 3))
    forces[293:] += 0.05 * np.random.default_rng(3).choice([-1, 1], (7, 3))
    forces[150] += 0.05  # a knock within it is no end
    around = np.array([(9.8, 0, 0)] * 20)
    (_, middle, _) = rests_of(in_bins(np.vstack([around, forces, around]), 10))
    assert (middle.first, middle.after) == (29, 312)  # one more on each side


@pytest.mark.parametrize("step", [0.02, 2.0])
def test_a_log_without_a_pause_has_none_however_slow_it_is(step):
    time = step * np.arange(100)
    nothing, edges = np.zeros((100, 3)), np.arange(101)
    window = windows.Window("log", 0, 100, [])
    binned = windows.Binned(window, edges, nothing, nothing, np.full(100, step), time, time)
    assert not binned.beside_pauses.any()


def test_a_table_set_a_degree_further_between_two_turns_moves():
    """1.5° in 8 s is at most 0.35 °/s, a fiftieth of a turn at 20 °/s, and no rest."""
    rng, bins, step = np.random.default_rng(4), 400, 0.1
    time = step * np.arange(bins)
    s = np.clip((time - 15) / 8, 0, 1)
    rate = 1.5 / 8 * 30 * s**2 * (1 - s) ** 2  # °/s, of a minimum-jerk motion
    still = 0.003 * rng.standard_normal((bins, 3)) + [0.02, -0.5, 0.1]
    moved = slow_motion(np.radians(still + np.outer(rate, [0, 1, 0])), step)
    assert moved is not None
    assert 15 < step * moved[0] < 16.5 and 21.5 < step * moved[1] < 23
    # Beside short rests it lasts as long as they do, and begins no later for that: 0.031 °/s,
    # 6 sigma of three axes, are reached in 0.65 s.
    short = slow_motion(np.radians(still + np.outer(rate, [0, 1, 0]))[110:270], step)
    assert short is not None
    assert 15.5 < 11 + step * short[0] < 15.9 and 22.1 < 11 + step * short[1] < 22.6
    # Nor for two thirds of the time in which it is thousands of times as fast as the noise: 8° in
    # 10 s, which reach 0.01 °/s, 6 sigma of three axes, in 0.1 s.
    s = np.clip((time[:150] - 2.5) / 10, 0, 1)
    rate, quiet = 8 / 10 * 30 * s**2 * (1 - s) ** 2, 0.001 * rng.standard_normal((150, 3))
    long = slow_motion(np.radians(quiet + np.outer(rate, [0, 1, 0])), step)
    assert long is not None
    assert 2.5 < step * long[0] < 2.9 and 12.1 < step * long[1] < 12.5
    for quiet in (
        still,
        still + np.outer(0.3 * np.sin(2 * np.pi * 1.3 * time), [1, 0, 0]),  # vibrates
        still + np.outer(0.2 * np.exp(-time / 10), [1, 0, 0]),  # warms up
        still + np.outer(0.1 * (time > 20), [0, 0, 1]),  # its bias jumps
        np.where((time > 12) & (time < 15), np.nan, still.T).T,  # readings are masked
    ):
        assert slow_motion(np.radians(quiet), step) is None


def test_what_a_table_swings_on_after_a_turn_is_one_block_and_no_rest():
    """1.7 Hz of 165″ about an axis across, which is gone to a third in 1.5 s (IEEE Std 1554)."""
    step, fine = 0.1, 20
    rng, time = np.random.default_rng(5), step / fine * (0.5 + np.arange(10_000))
    stop = 23.0  # s, after two ramps of 1 s and 10 s at 20 °/s from 12 s on
    rate = 20 * np.clip(np.minimum(time - 12, stop - time), 0, 1)
    since = np.clip(time - stop, 0, None)
    swing = 8e-4 * np.exp(-since / 1.5) * np.sin(2 * np.pi * 1.7 * since)
    across = np.degrees(np.gradient(swing, time))
    sensed = np.stack([0.3 * across, 0.95 * across, rate], axis=1)
    rates = np.radians(sensed).reshape(-1, fine, 3).mean(axis=1)
    rates += np.radians(0.003) * rng.standard_normal(rates.shape)
    bins = len(rates)
    window = windows.Window("log", 0, bins, [])
    level, places = np.tile([0, 0, 9.8], (bins, 1)), step * np.arange(bins)
    binned = windows.Binned(
        window, np.arange(bins + 1), rates, level, np.full(bins, step), places, places
    )
    nothing = dict.fromkeys(field.name for field in fields(Manoeuvre))
    up = np.array([0.0, 0.0, 1.0])
    turn = Manoeuvre(
        **nothing
        | {"name": "turn", "do": "turn", "log": "log", "up": up, "about": up}
        | {"angle": np.radians(220), "rate": np.radians(20)}
    )
    noise = 6 * np.radians(0.003) * np.sqrt(3)
    division = divide(binned, np.zeros(3), np.radians(1), noise, swings=True)
    located = locate(division, manoeuvres=[turn])
    made = turn_parts(binned, located.stretches, turn, located.matched, np.zeros(3), 0.4)
    phases = {part.phase: (step * part.first, step * part.after) for part in made}
    # 165″ at 1.7 Hz are 0.49 °/s at first, and as small as the noise of a bin after 4 to 7 s.
    assert list(phases)[-3:] == ["spin-down", "settling", "rest-after"]
    assert stop - 0.7 < phases["settling"][0] < stop
    assert stop + 4 < phases["rest-after"][0] < stop + 8
    assert phases["rest-before"][1] == pytest.approx(12, abs=0.6)
    # Beside a soak neither rest reaches far into it.
    beside = located.stretches, turn, located.matched, np.zeros(3), 0.4, (5.0, 6.0)
    near = {part.phase: step * (part.after - part.first) for part in turn_parts(binned, *beside)}
    assert near["rest-before"] == pytest.approx(5.0)
    assert near["rest-after"] == pytest.approx(6.0)
    assert phases["rest-after"][1] - phases["rest-after"][0] > 7


COUNT = float(np.radians(0.02))  # rad/s


@pytest.mark.parametrize("noise", [0.05, 0.14, 0.25])  # counts, of a reading
@pytest.mark.parametrize("bias", [0.0, 0.25])  # counts: that toggle seldom, or now and then
def test_counts_that_toggle_are_no_motion_and_a_turn_begins_where_it_does(noise, bias):
    """A turn of 360° at 72 °/s with ramps of 60 °/s²: it takes 6.2 s, between rests of 30 s."""
    step, ramp, plateau = 0.1, 1.2, 3.8
    time = 0.01 * np.arange(6620)
    rate = 72 * np.clip(np.minimum(time - 30, 36.2 - time) / ramp, 0, 1)
    assert rate.sum() * 0.01 == pytest.approx(72 * (plateau + ramp))
    sensed = np.radians(np.outer(rate, [0, 0, 1])) / COUNT + bias
    readings = np.round(sensed + noise * np.random.default_rng(8).standard_normal(sensed.shape))
    rates = COUNT * readings.reshape(-1, 10, 3).mean(axis=1)
    bins, up = len(rates), np.array([0.0, 0.0, 1.0])
    turn = Manoeuvre(
        **dict.fromkeys(field.name for field in fields(Manoeuvre))
        | {"name": "turn", "do": "turn", "log": "log", "up": up, "about": up, "recorded": "whole"}
        | {"angle": 2 * np.pi, "rate": np.radians(72)}
    )
    binned = windows.Binned(
        windows.Window("log", 0, bins, [turn]),
        np.arange(bins + 1),
        rates,
        np.tile(9.8 * up, (bins, 1)),
        np.full(bins, step),
        step * np.arange(bins),
        step * np.arange(bins) + 0.09,
        quantum=np.append(np.full(3, np.nan), np.full(3, COUNT)),
    )
    (located,) = explained_of([binned], [turn], 0.0)[1].located
    place = located.place(turn)
    assert place is not None
    stretch = located.stretches[place]
    assert (stretch.first, stretch.after) == (pytest.approx(300, abs=2), pytest.approx(362, abs=2))


def test_a_rest_in_which_counts_toggle_holds_no_slow_motion():
    rng = np.random.default_rng(4)
    readings = np.round(0.4 + 0.14 * rng.standard_normal((3000, 3))) * COUNT
    still = readings.reshape(300, 10, 3).mean(axis=1)
    assert slow_motion(still, 0.1, np.full(3, COUNT)) is None
    turning = still.copy()
    turning[100:200, 1] += np.radians(0.1)  # 1° in 10 s
    first, after = slow_motion(turning, 0.1, np.full(3, COUNT))
    assert abs(first - 100) <= 1 and abs(after - 200) <= 1


def test_a_gyro_masked_for_long_from_within_a_turn_does_not_turn_on():
    rates = np.zeros((2000, 3))
    rates[1000:1050, 1] = 0.4  # rad/s, a turn in which its mask ends
    rates[500:600, 0] = 0.5  # meanwhile another one turns
    rates[:1010, 1] = np.nan
    filled = windows._sought_in(rates, 300, None)
    assert (filled[:1010, 1] == 0).all()
    assert (filled[:, 0] == rates[:, 0]).all()
    short = rates.copy()
    short[:1010, 1] = 0.0
    short[1010:1040, 1] = np.nan  # within the turn: it stays one
    short[1000:1010, 1] = 0.4
    assert windows._sought_in(short, 300, None)[1000:1050, 1] == pytest.approx(0.4)


def test_what_a_masked_gyro_is_taken_to_read_is_no_reading():
    window = windows.Window("log", 0, 100, [])
    time, unread = 0.1 * np.arange(10), np.zeros((10, 6), bool)
    unread[:5, 4] = True
    one = windows.Binned(
        window, np.arange(11), np.zeros((10, 3)), np.ones((10, 3)), np.full(10, 0.1), time, time,
        unread=unread,
    )  # fmt: skip
    assert np.isnan(one.read_rates[:5, 1]).all()
    assert np.isfinite(one.read_rates[:, [0, 2]]).all()


def test_a_mark_that_is_set_right_says_how_far_its_manoeuvre_begins_turned_on():
    """About z up the mark goes from x to −y while the case turns by 90°; it was stated as x."""
    up, x, y = np.array([0.0, 0, 1]), np.array([1.0, 0, 0]), np.array([0.0, 1, 0])
    first = Manoeuvre("there", "turn", "log", "face", "as mounted", up, x, up)
    stated = replace(first, name="back", mark=-y, turned_on=0.0)
    beside = replace(first, name="over", up=-up, mark=y)
    made = begun_as_recorded([first, stated, beside], [])
    assert [m.turned_on for m in made] == pytest.approx([0.0, np.pi / 2, 0.0])
