"""An IMU that is switched off and on between manoeuvres, while one log goes on, and nobody says so.

The laboratory records a log for each switch-on; here they are one, with gaps of two seconds.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import chain
import numpy as np
import pytest
from ruamel.yaml import YAML

from inertial.campaign.equations import Campaign
from inertial.campaign.observations import campaign_of
from inertial.effects.restarts import Restarts
from inertial.estimation.triad import linear_names
from inertial.physics.effect import Reading, Truth
from inertial.physics.motion import stretches
from laboratory.folder import campaign_yaml
from stages.criticism.residual_structure import moved_by
from tests.expressions import value_of

XYZ = "xyz"
PAUSE_S = 2.0
AFTER_RESTART = ("z-down", "x-up", "y-up")  # positions of which the first manoeuvre is the first
BIASES = {"gyro_deg_h": 4, "accelerometer_micro_g": 100}


def test_each_run_has_a_bias_of_its_own_and_the_terms_say_the_same() -> None:
    time = np.array([5.0, 15.0, 25.0, 35.0])
    motion = stretches(time, np.full(4, 2.0), np.full(4, 300.0))
    effect = Restarts("gyro", [10.0, 30.0])
    values = np.arange(1.0, 10.0)  # of runs 0, 1, 2 on x, y, z
    none = np.zeros((4, 3))
    read = effect.reads(Reading(none, none), Truth(none, none), motion, values)
    expected = np.array([[1, 2, 3], [4, 5, 6], [4, 5, 6], [7, 8, 9]])
    assert (read.gyro == expected).all() and not read.accel.any()
    names = {constant.name: constant.value for constant in effect.constants(motion)}
    assert effect.with_constants(names).columns == effect.columns
    sizes = dict(zip([p.name for p in effect.parameters], values, strict=True))
    by_terms = np.zeros((4, 3))
    for term in effect.terms:
        factor = value_of(term.factor, {"t": time, **names})
        by_terms[:, "xyz".index(term.channel[-1])] += sizes[term.parameter] * factor
    assert (by_terms == expected).all()


def _short(**effects: Any) -> Campaign:
    tables = chain.in_memory_of(chain.short(effects=effects, seed=3), "gyroscope")
    (data,) = chain.mounts(tables)
    return campaign_of(data)


def test_a_bias_that_does_not_scatter_is_the_same_in_every_run() -> None:
    """It was taken for one of which nothing is known, and the mean bias with it."""
    campaign, scatter = _short(), 1e-3  # m/s²
    middle = float(np.median(campaign.motion.time))
    restarts = Restarts("accel", [middle]).with_spread(np.array([0, scatter, 0]))
    biases = [linear_names().index(f"bias_{axis}") for axis in XYZ]
    systems = [campaign.system("accel", effects, 1e4) for effects in ([], [restarts])]
    alone, beside = [each.solve_shared().sigma[biases] for each in systems if each is not None]
    assert beside[[0, 2]] == pytest.approx(alone[[0, 2]], rel=1e-6)
    assert scatter / 2 < beside[1] < scatter


def test_what_a_structure_does_is_counted_in_the_joint_result() -> None:
    """A step of a bias that the joint result averages moves it, whatever beside it is small."""
    place = _short()
    at = float(np.median(place.motion.time))
    jumped = _short(gyro_bias_jump={"size_deg_h": [0, 200, 0], "at_s": at})
    step = [Restarts("gyro", [at], first=1)]
    clean = moved_by(place, "gyro", ["x-up"])
    moved = moved_by(jumped, "gyro", ["x-up"], step)
    assert clean is not None and clean < 1
    assert moved is not None and moved > 3


def recorded(
    folder: Path,
    seed: int,
    restarts: Sequence[str] = AFTER_RESTART,
    gaps_alone: Sequence[str] = (),
    **effects: Any,
) -> tuple[dict[str, Any], Path]:
    """Six positions of a rest and two turns each, in one log with a gap before some of them.

    gaps_alone : those of them where the IMU stays on
    """
    document = chain.short(effects=effects, seed=seed)
    document["start"]["pause_s"] = PAUSE_S
    document["handling"] |= {"still_s": 5, "change_s": 8}
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "simulated", "rate_hz": 100}
    plan: list[dict[str, Any]] = []
    part = 0
    for axis, mark in ("zx", "xy", "yz"):
        for way, up in (("up", "+"), ("down", "-")):
            place = f"{axis}-{way}"
            own = {"position": place, "up": up + axis, "mark": f"+{mark}"}
            part += place in restarts
            log = {"log": f"part-{part}.csv"}
            plan.append({"id": place, "do": "rest", "seconds": 40, **own, **log})
            plan[-1]["power_cycle"] = (
                "turn_on_bias" in effects and place in restarts and place not in gaps_alone
            )
            for name, degrees in (("forward", 360), ("backward", -360)):
                turn = {"degrees": degrees, "rate_deg_s": 60, "accel_deg_s2": 50}
                plan.append({"id": f"{place}-{name}", "do": "turn", **own, **turn, **log})
                plan[-1]["power_cycle"] = False
    document["campaign"]["plan"] = plan
    raw = chain.simulate(document, folder / "raw")
    parts = sorted(raw.glob("part-*.csv"))
    assert len(parts) == len(restarts) + 1
    head, *_rest = parts[0].read_text().splitlines()
    lines = [line for part in parts for line in part.read_text().splitlines()[1:]]
    (raw / "session.csv").write_text("\n".join([head, *lines, ""]))
    for part in parts:
        part.unlink()
    written = YAML(typ="safe", pure=True).load(raw / "campaign.yaml")
    for each in written["plan"]:
        each.pop("power_cycle", None)
        each["log"] = "session.csv"
    (raw / "campaign.yaml").write_bytes(campaign_yaml(written))
    return document, raw


@pytest.mark.slow
def test_biases_that_change_at_gaps_are_restarts_and_the_result_is_right(tmp_path: Path) -> None:
    """Three in one log were g-sensitivity, an asymmetry, and jumps where nothing happened."""
    document, raw = recorded(tmp_path, 5, turn_on_bias=BIASES)
    made = chain.run(raw, tmp_path / "derived", "compensation", chain.BESIDE)
    (cause,) = made["diagnosis/causes"].to_dict("records")
    assert cause["cause"] in ("gyro_restarts", "accel_restarts") and cause["verdict"] == "found"
    assert "It is one event with this" in cause["sentence"] and ": gap of " in cause["sentence"]
    assert "power_cycle: true in z-down, x-up and y-up:" in cause["action"]
    assert set(made["diagnosis/verdict"]["verdict"]) == {"usable_within_limits"}
    result = made["diagnosis/result"].set_index(["sensor", "parameter"])
    for sensor, stage in (("gyro", "gyro"), ("accel", "accelerometer")):
        matrix = np.array(document["truth"][stage]["matrix"])
        for i, axis in enumerate("xyz"):
            scale = result.loc[(sensor, f"scale_{axis}")]
            assert abs(scale["value"] - (matrix[i, i] - 1)) < 4 * scale["sigma"]
            assert scale["sigma"] < 1e-3
    gaps = made["quality/gaps"].sort_values("from_s")
    middles = (gaps["from_s"] + gaps["to_s"]).to_numpy() / 2
    times = [result.loc[("gyro", f"gyro_restarts.t{k}"), "value"] for k in (1, 2, 3)]
    assert times == pytest.approx(middles)


@pytest.mark.slow
def test_gaps_where_no_bias_changes_are_gaps_alone(tmp_path: Path) -> None:
    for seed in (6, 7):
        _document, raw = recorded(tmp_path / str(seed), seed)
        made = chain.run(raw, tmp_path / str(seed) / "derived", "diagnosis", chain.BESIDE)
        (cause,) = made["diagnosis/causes"].to_dict("records")
        assert cause["cause"] == "gap" and "none need be recorded again" in cause["action"]
        assert set(made["diagnosis/verdict"]["verdict"]) == {"usable_within_limits"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("effect", "sizes"),
    [
        ("gyro_bias_jump", {"size_deg_h": [3, -4, 2.5], "at_s": 252}),
        ("gyro_warm_up", {"start_deg_h": [9, -6, 0], "time_constant_s": 150}),
    ],
)
def test_a_jump_elsewhere_or_a_drift_keeps_its_name_beside_gaps(
    tmp_path: Path, effect: str, sizes: dict[str, Any]
) -> None:
    _document, raw = recorded(tmp_path, 8, **{effect: sizes})
    made = chain.run(raw, tmp_path / "derived", "diagnosis", chain.BESIDE)
    assert set(made["diagnosis/causes"]["cause"]) == {effect, "gap"}


@pytest.mark.slow
@pytest.mark.parametrize("alone", [(), ("z-down", "y-up", "y-down")])
def test_a_restart_at_one_gap_has_the_time_of_the_gap(
    tmp_path: Path, alone: tuple[str, ...]
) -> None:
    """It was a jump at a time that was known to seconds, one of each sensor, and gaps beside it."""
    places = sorted(("x-up", *alone), key=["z-down", "x-up", "y-up", "y-down"].index)
    _document, raw = recorded(tmp_path, 9, places, alone, turn_on_bias=BIASES)
    made = chain.run(raw, tmp_path / "derived", "diagnosis", chain.BESIDE)
    (cause,) = made["diagnosis/causes"].to_dict("records")
    assert cause["cause"] in ("gyro_restarts", "accel_restarts") and cause["verdict"] == "found"
    assert "power_cycle: true in x-up:" in cause["action"]
    gaps = made["quality/gaps"].sort_values("from_s")
    middle = ((gaps["from_s"] + gaps["to_s"]) / 2).to_numpy()[places.index("x-up")]
    result = made["diagnosis/result"].set_index("parameter")["value"]
    times = result[result.index.str.match(r"gyro_restarts\.t\d")]
    assert times.to_numpy() == pytest.approx([middle])
    sigma = made["diagnosis/result"].set_index(["sensor", "parameter"])["sigma"]
    for axis in XYZ:  # of the mean of two biases, half their difference
        assert sigma["gyro", f"bias_{axis}"] < np.radians(3 * BIASES["gyro_deg_h"] / 3600)
        assert sigma["accel", f"bias_{axis}"] < 3e-6 * BIASES["accelerometer_micro_g"] * 9.81
    assert set(made["diagnosis/verdict"]["verdict"]) == {"usable_within_limits"}


@pytest.mark.slow
def test_a_warm_up_begins_again_at_restarts_that_nobody_stated(tmp_path: Path) -> None:
    """One from the beginning of the log had sizes and a time that were three times too large."""
    start = {"start_deg_h": [30, -20, 0], "time_constant_s": 45}
    _document, raw = recorded(
        tmp_path, 10, ("x-up", "y-up"), turn_on_bias=BIASES, gyro_warm_up=start
    )
    made = chain.run(raw, tmp_path / "derived", "diagnosis", chain.BESIDE)
    assert {"gyro_warm_up"} < set(made["diagnosis/causes"]["cause"])
    result = made["diagnosis/result"].set_index("parameter")
    hour = np.degrees(1) * 3600
    for axis, true in zip("xy", (30, -20), strict=True):
        row = result.loc[f"gyro_warm_up.b_{axis}"]
        assert abs(row["value"] * hour - true) < 0.15 * abs(true)
        assert row["sigma"] * hour < 3
    assert 35 < result.loc["gyro_warm_up.tau", "value"] < 60


@pytest.mark.slow
def test_only_gaps_at_which_biases_change_are_restarts(tmp_path: Path) -> None:
    """Of four gaps the IMU stays on at two: no bias changes there, and no switch-on is advised."""
    places = ("z-down", "x-up", "x-down", "y-up")
    _document, raw = recorded(tmp_path, 5, places, ("x-up", "y-up"), turn_on_bias=BIASES)
    made = chain.run(raw, tmp_path / "derived", "diagnosis", chain.BESIDE)
    (cause,) = made["diagnosis/causes"].to_dict("records")
    assert cause["cause"] in ("gyro_restarts", "accel_restarts") and cause["verdict"] == "found"
    assert "power_cycle: true in z-down and x-down:" in cause["action"]
    assert cause["sentence"].count("It is one event with this") == 1
    assert cause["sentence"].count(" s, by up to ") == 2
    assert "The log has 4 gaps in all" in cause["sentence"] and "gap of" not in cause["sentence"]
    gaps = made["quality/gaps"].sort_values("from_s")
    middles = (gaps["from_s"] + gaps["to_s"]).to_numpy() / 2
    result = made["diagnosis/result"].set_index("parameter")["value"]
    times = result[result.index.str.match(r"gyro_restarts\.t\d")]
    assert times.to_numpy() == pytest.approx(middles[[0, 2]])
