"""A missing stretch of steady rate is bridged with its sigma; one in a ramp is not, by name."""

from dataclasses import replace
from math import degrees, radians
from pathlib import Path

import chain
import numpy as np
import pandas as pd
import pytest

from stages.contracts.records import (
    Manoeuvre,
    Performed,
    known_of,
    manoeuvres_of,
    performed_of,
)
from stages.contracts.tables import CHANNELS
from stages.estimation.blocks import Blocks
from stages.estimation.evidence import campaign_of
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.solution import solution_of
from stages.estimation.turns import GyroInputs, Recorded, gyro_inputs, turn_of
from stages.inference.triad import errors_of, linear_names
from stages.inference.whole_turns import (
    Angle,
    Earth,
    Position,
    Still,
    Turn,
    joint,
    known_angle,
)
from stages.model.motion import turned_all
from stages.model.site import earth_rate
from stages.segmentation.missing import ENOUGH, FEW, missing_of

UP, LEVEL = earth_rate(radians(30.5278))
EARTH = Earth(UP, 1e-12, LEVEL)
NOISE = radians(0.012 / 60)  # rad/√s, as the demo has it
STEP, BLOCK = 0.01, 50  # s, samples
ANGLE = radians(2 / 3600)  # of the table
GAP = (2192, 1197)  # S0's: the first sample that is lost, how many; the turn begins at 1000
MATRIX = np.eye(3) + 1e-3 * np.array([[0.6, 2.5, 7.5], [-2.4, 0.0, -0.7], [-7.6, 0.8, 0.6]])
BIAS = np.array([1.3e-6, -2.1e-6, 0.9e-6])
Z_SCALE = 8  # place of M_zz among the unknowns


def levels() -> NoiseLevels:
    rows = [
        {"manoeuvre": "any", "phase": "rest", "channel": channel, "white_noise": NOISE}
        for channel in CHANNELS
    ]
    return NoiseLevels(pd.DataFrame(rows).assign(sigma=NOISE / 100, per_sample=NOISE / STEP**0.5))


def planned(name: str, axis: int, sign: int) -> Manoeuvre:
    up = np.eye(3)[axis]
    nothing = dict.fromkeys(("from_s", "to_s", "from_row", "to_row", "label"))
    words = {"do": "turn", "log": "log", "position": name, "mount": "", "recorded": "whole"}
    return Manoeuvre(
        name, **words, up=up, mark=None, about=up, angle=sign * 2 * np.pi, angle_sigma=ANGLE,
        rate=sign * radians(10), acceleration=radians(5), seconds=None, **nothing,
    )  # fmt: skip


def turn(
    m: Manoeuvre,
    rng: np.random.Generator,
    gap: tuple[int, int] | None = None,
    wander=lambda time, lost: 0.0 * time,
    rate_sigma: float = 1e-4,
) -> Turn:
    """S0's turn in blocks by exact physics: two ramps of 2 s, 34 s about 10 °/s, from rest to rest.

    `wander`: by what its rate differs from the mean one, relative, by the time of each sample and
    whether it was lost.
    """
    n = 3800
    time = STEP * (np.arange(n) + 0.5)
    lost = np.zeros(n, bool)
    if gap:
        lost[gap[0] - 1000 : gap[0] - 1000 + gap[1]] = True
    rate = np.clip(np.minimum(time, 38 - time) / 2, 0, 1) * (1 + wander(time, lost))
    angle = rate / rate.sum() * (m.angle + ANGLE * rng.standard_normal())
    middle = np.cumsum(angle) - angle / 2
    edges = {*range(0, n + 1, BLOCK), *(np.flatnonzero(np.diff(lost)) + 1).tolist()}
    starts = np.array(sorted(edges))[:-1]
    seconds = STEP * np.diff(sorted(edges))
    north = np.cross(m.up, np.roll(m.up, 1))
    earth = UP * m.up + LEVEL * turned_all(north, m.axis, middle)
    truth = np.add.reduceat(np.outer(angle, m.axis) + STEP * earth, starts)
    sums = truth @ MATRIX.T + np.outer(seconds, BIAS)
    sums += NOISE * np.sqrt(seconds)[:, None] * rng.standard_normal(sums.shape)
    begins = STEP * starts
    phase = np.select([begins < 2.4, begins < 35.4], ["spin-up", "steady"], "spin-down")
    kept, ends = ~lost[starts], begins + seconds
    missing = np.append(0.0, begins[kept][1:] - ends[kept][:-1]).round(6)
    blocks = Blocks(
        log=np.full(kept.sum(), "log"),
        phase=phase[kept],
        counts=seconds[kept] / STEP,
        seconds=seconds[kept],
        missing=missing,
        time=(begins + seconds / 2)[kept],
        temperature=np.full(kept.sum(), np.nan),
        gyro=(sums / seconds[:, None])[kept],
        accel=np.full((kept.sum(), 3), np.nan),
    )
    return turn_of(Recorded(m, Performed(m.name, ""), blocks, ""), levels(), None, rate_sigma)


def rests(rng: np.random.Generator) -> list[Still]:
    """Six rests of 300 s, each at its own azimuth."""
    sigma = np.full(3, NOISE / np.sqrt(300))
    found = []
    for axis in range(3):
        for sign in (1, -1):
            up = sign * np.eye(3)[axis]
            truth = UP * up + LEVEL * np.roll(up, 1)
            mean = MATRIX @ truth + BIAS + sigma * rng.standard_normal(3)
            found.append(Still(Position(f"rest {axis} {sign}", up), mean, sigma, up))
    return found


def session(seed: int, **of_the_gap) -> tuple[list[Still], list[Turn]]:
    """Six rests and six turns; the last one, z backward, has lost what S0's has."""
    rng = np.random.default_rng(seed)
    stills = rests(rng)
    names = [(f"turn {axis} {sign}", axis, sign) for axis in range(3) for sign in (1, -1)]
    turns = [turn(planned(*name), rng) for name in names[:-1]]
    return stills, [*turns, turn(planned(*names[-1]), rng, GAP, **of_the_gap)]


def pulls(fit) -> np.ndarray:
    return (fit.values[:12] - np.append(MATRIX.ravel(), BIAS)) / fit.sigma[:12]


# ---- closure


def test_the_truth_comes_back_within_the_stated_sigma():
    """Over 16 sessions in whose gap the table was off its rate by its sigma, 100 ppm."""
    every = []
    for seed in range(16):
        off = 1e-4 * np.random.default_rng([seed, 1]).standard_normal()
        stills, turns = session(seed, wander=lambda time, lost, off=off: off * lost)
        # A forward turn about z would know its scale factor better; without it the bridge shows.
        fit = joint(stills, [*turns[:4], turns[5]], [], EARTH, 1e-9)
        assert fit.determined[:12].all()
        every.append(pulls(fit))
    every = np.array(every)
    assert np.abs(every).max() < 4.5
    assert 0.87 < np.sqrt(np.mean(every**2)) < 1.13  # 192 pulls: within 5 % of 1
    assert 0.5 < np.sqrt(np.mean(every[:, Z_SCALE] ** 2)) < 1.5  # 16 pulls: 18 %


def test_the_sigma_is_what_the_table_leaves_and_less_than_without_the_turn():
    stills, turns = session(1)
    without = joint(stills, turns[:5], [], EARTH, 1e-9)
    bridged = joint(stills, turns, [], EARTH, 1e-9)
    assert bridged.sigma[Z_SCALE] < without.sigma[Z_SCALE]
    assert bridged.sigma[2] < 0.85 * without.sigma[2]  # γ_xz: the turn shows it without its angle
    stills, turns = session(1, rate_sigma=1e-5)
    better = joint(stills, turns, [], EARTH, 1e-9)
    assert better.sigma[Z_SCALE] < 0.85 * without.sigma[Z_SCALE]
    # By this turn alone: 100 ppm of 119.7° beside the whole angle, noise and bias hardly add.
    alone = joint(stills, [*turns[:4], session(1)[1][5]], [], EARTH, 1e-9)
    assert alone.sigma[Z_SCALE] == pytest.approx(1e-4 * 119.7 / 360, rel=0.03)
    assert joint(stills, turns[:4], [], EARTH, 1e-9).sigma[Z_SCALE] > 1e-3


@pytest.mark.parametrize(
    ("name", "wander", "rate_sigma"),
    [
        ("another rate than the set one", lambda time, lost: 1e-4 * (time > 2), 1e-4),
        ("100 ppm of drift", lambda time, lost: 1e-4 * (time / 38 - 0.5), 1e-4),
        # As if the table were stated to keep 1 ppm: then the data must show that it does not.
        ("300 ppm of drift", lambda time, lost: 3e-4 * (time / 38 - 0.5), 1e-6),
        ("a jump of 300 ppm", lambda time, lost: 3e-4 * (time > 14), 1e-6),
        ("a slow ripple", lambda time, lost: 2e-4 * np.sin(2 * np.pi * time / 9), 1e-6),
        ("a fast ripple", lambda time, lost: 1e-3 * np.sin(2 * np.pi * time / 0.83), 1e-6),
    ],
)
def test_a_table_that_strays_is_covered(name, wander, rate_sigma):
    every = []
    for seed in range(4):
        stills, turns = session(seed, wander=wander, rate_sigma=rate_sigma)
        every.append(pulls(joint(stills, turns[5:], [], EARTH, 1e-9))[Z_SCALE])
    assert np.abs(np.mean(every)) < 1.5, every
    assert np.abs(every).max() < 2.5, every


def test_two_gaps_are_bridged_like_one():
    rng = np.random.default_rng(5)
    m = planned("turn", 2, -1)
    one = turn(m, rng, GAP)
    both = replace(one, bridges=[*one.bridges, *one.bridges])  # the same stretch lost twice
    assert one.weights @ one.seconds == pytest.approx(38.0)
    assert both.weights @ both.seconds == pytest.approx(38.0 + 11.97)
    angle = one.sums @ m.axis
    assert one.weights @ angle == pytest.approx(m.angle, rel=1e-3)
    # After the gap the table stands where it would without: at 350° when it begins to brake.
    there = np.interp(36.0, one.elapsed, one.turned(angle))
    assert degrees(there) == pytest.approx(-350, abs=0.5)


# ---- what can be bridged, and what cannot


def blocks(*stretches: tuple[str, float, float, bool]) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Blocks of a turn: phase, seconds recorded, seconds missing before, whether they were lost."""
    rows, gaps, record = [], [], 0
    for phase, seconds, missing, lost in stretches:
        if lost:
            gaps.append({"record": record})
        else:
            record += round(missing / STEP)
        for number in range(max(round(seconds / 0.2), 1)):
            after = record + round(min(seconds, 0.2) / STEP)
            rows.append(
                {"phase": phase, "seconds": min(seconds, 0.2), "count": float(after - record),
                 "missing_s": 0.0 if number else missing, "from_record": record,
                 "to_record": after}
            )  # fmt: skip
            record = after
    return pd.DataFrame(rows), pd.DataFrame(gaps, columns=["record"])


UP_RAMP, DOWN_RAMP = ("spin-up", 2.0, 0.0, False), ("spin-down", 2.0, 0.0, False)
STEADY = ("steady", 10.0, 0.0, False)
NOT_STEADY = "the rate is not steady there"


@pytest.mark.parametrize(
    ("stretches", "hindrance"),
    [
        ([UP_RAMP, STEADY, DOWN_RAMP], ""),
        ([UP_RAMP, STEADY, ("steady", 10.0, 12.0, True), DOWN_RAMP], ""),
        ([UP_RAMP, STEADY, ("steady", 5, 12.0, True), ("steady", 5, 3, True), DOWN_RAMP], ""),
        ([UP_RAMP, STEADY, ("spin-down", 2.0, 1.0, True)], NOT_STEADY),
        ([UP_RAMP, STEADY, ("spin-down", 1.0, 0.0, False), ("spin-down", 1.0, 0.5, True)],
         NOT_STEADY),
        ([("spin-up", 1.0, 0.0, False), ("spin-up", 0.6, 0.01, True), STEADY, DOWN_RAMP],
         NOT_STEADY),
        ([("spin-up", 1.0, 0.0, False), ("steady", 10.0, 1.0, True), DOWN_RAMP], NOT_STEADY),
        # one of two gaps touches a ramp
        ([UP_RAMP, STEADY, ("steady", 10.0, 12.0, True), ("spin-down", 1.0, 1.0, True)],
         NOT_STEADY),
        # hardly any steady rate on one side
        ([UP_RAMP, ("steady", 0.4, 0.0, False), ("steady", 10.0, 12.0, True), DOWN_RAMP],
         "only 0.40 s of steady rate are recorded before them, of 1.00 s that are needed"),
        ([UP_RAMP, STEADY, ("steady", 0.6, 12.0, True), DOWN_RAMP],
         "only 0.60 s of steady rate are recorded after them, of 1.00 s that are needed"),
        # a single sample needs no more beside it than itself
        ([UP_RAMP, STEADY, ("steady", 0.2, STEP, True), DOWN_RAMP], ""),
        # masked samples: few in a ramp, or many
        ([("spin-up", 1.0, 0.0, False), ("spin-up", 1.0, FEW * STEP, False), STEADY, DOWN_RAMP],
         ""),
        ([("spin-up", 1.0, 0.0, False), ("spin-up", 1.0, 5 * STEP, False), STEADY, DOWN_RAMP],
         f"{NOT_STEADY}, and more than 3 samples in a row are masked"),
        ([("spin-up", 0.2, 0.0, False), *[("spin-up", 0.2, 0.03, False)] * 9, STEADY,
          ("spin-down", 0.6, 0.0, False)],
         f"{NOT_STEADY}, and more than 10% of its samples are masked"),
        ([UP_RAMP, STEADY, ("steady", 10.0, 2.0, False), DOWN_RAMP], ""),
        # by hand
        ([("turning", 5.0, 0.0, False), ("turning", 5.0, 0.5, True)],
         "a turn by hand has no steady rate"),
        ([("turning", 5.0, 0.0, False), ("turning", 5.0, 2 * STEP, False)], ""),
        ([UP_RAMP, STEADY, ("steady", 10.0, -3.0, False), DOWN_RAMP],
         "the time goes back while it turns"),
    ],
)  # fmt: skip
def test_what_can_be_bridged(stretches, hindrance):
    moving, gaps = blocks(*stretches)
    found = missing_of(moving, np.ones(len(moving)), gaps)
    assert found.hindrance == hindrance
    assert found.seconds == pytest.approx(sum(max(missing, 0) for _, _, missing, _ in stretches))
    assert ENOUGH == 1.0 and FEW == 3


# ---- from the log on


def z_turns(**changes) -> dict:
    """Two rests and the two turns about z, with S0's gap in the backward one."""
    document = chain.demo(**{"faults": lose((2193, 1197)), **changes})
    wanted = ("z-up", "z-down", "z-forward", "z-backward")
    plan = [entry for entry in document["campaign"]["plan"] if entry["id"] in wanted]
    document["campaign"]["plan"] = [
        entry | ({"seconds": 60} if entry["do"] == "rest" else {}) for entry in plan
    ]
    return document


def lose(*stretches: tuple[int, int]) -> list[dict]:
    return [
        {"lose": {"log": "z-backward.asc", "line": line, "samples": samples}}
        for line, samples in stretches
    ]


def recorded(folder: Path, until: str = "segment", **changes) -> chain.Results:
    return chain.run(chain.simulate(z_turns(**changes), folder / "raw"), folder / "derived", until)


@pytest.fixture(scope="module")
def gapped(tmp_path_factory) -> chain.Results:
    return recorded(tmp_path_factory.mktemp("gapped"), "gyroscope")


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> chain.Results:
    return recorded(tmp_path_factory.mktemp("whole"), "gyroscope", faults=[])


def inputs_of(results: chain.Results, tables: dict[str, pd.DataFrame] | None = None) -> GyroInputs:
    tables = tables or {name: results[f"segment/{name}"] for name in ("blocks", "performed")}
    return gyro_inputs(
        tables["blocks"],
        manoeuvres_of(results["plan/manoeuvres"]),
        performed_of(tables["performed"]),
        NoiseLevels(results["noise/noise"]),
        known_of(results["plan/known"]),
    )


def of_z(results_or_tables, key: str = "performed") -> pd.Series:
    return results_or_tables[key].set_index("manoeuvre").loc["z-backward"]


def test_the_gap_of_the_demo_is_bridged_and_said(gapped):
    done = of_z(gapped, "segment/performed")
    assert done["bridged"] and not done["complete"]
    assert done["missing_s"] == pytest.approx(11.97)
    assert degrees(done["missing_angle"]) == pytest.approx(-119.74, abs=0.02)
    assert "11.97 s are missing while it turns" in done["sentence"]
    assert "the joint estimate bridges what is missing" in done["sentence"]
    fit = gapped["gyroscope/fit"].iloc[0]
    assert "z-backward" in fit["used"].split(", ") and fit["left_out"] == ""
    # S0's own formulas need the whole turn, and have it not.
    formula = gapped.parameters("gyroscope", "turns").loc["scale_z"]
    assert np.isnan(formula["value"])
    assert "not whole: z-backward" in formula["reason"]


def test_the_bridge_takes_its_place_in_time_and_angle(gapped):
    one = inputs_of(gapped).turns[-1]
    (bridge,) = one.bridges
    assert bridge.seconds == pytest.approx(11.97)
    angle = one.sums[:, 2]
    # 119.7° at the set speed as the gyro reads it, bias and earth rate with it.
    read = -119.7 * 1.0006442 + degrees(11.97 * (UP + BIAS[2]))
    assert degrees(bridge.shares @ angle) == pytest.approx(read, abs=0.001)
    assert degrees(one.turned(angle)[-1]) == pytest.approx(-360.2, abs=0.1)
    # 100 ppm of the campaign's file are more than the table of the laboratory strays.
    assert degrees(one.bridged_sigma) == pytest.approx(1e-4 * 119.7, rel=0.02)


@pytest.mark.parametrize(
    ("stretches", "words"),
    [
        ([(4500, 200)], "2.00 s are missing while it turns, and the rate is not steady there"),
        ([(1050, 20)], "0.20 s are missing while it turns, and the rate is not steady there"),
        ([(2193, 1197), (3350, 200)], "and the rate is not steady there"),
        ([(1300, 1500)], "of steady rate are recorded before them, of 1.00 s that are needed"),
        ([(1, 1500)], "the log begins while it turns"),
    ],
)
def test_a_gap_that_touches_a_ramp_is_refused_by_name(stretches, words, tmp_path):
    results = recorded(tmp_path, faults=lose(*stretches))
    done = of_z(results, "segment/performed")
    assert not done["complete"] and not done["bridged"]
    assert words in done["sentence"]


def test_two_gaps_in_the_steady_part_are_both_bridged(tmp_path):
    results = recorded(tmp_path, "noise", faults=lose((1800, 300), (2600, 500)))
    done = of_z(results, "segment/performed")
    assert done["bridged"] and done["missing_s"] == pytest.approx(8.0)
    one = inputs_of(results).turns[-1]
    assert [bridge.seconds for bridge in one.bridges] == pytest.approx([3.0, 5.0])
    assert degrees(one.turned(one.sums[:, 2])[-1]) == pytest.approx(-360.2, abs=0.1)


# ---- masked records


def masked(results: chain.Results, *stretches: tuple[int, int], **more) -> dict[str, pd.DataFrame]:
    """`segment` once more, with these records of z-backward masked."""
    rows = [
        {"log": "z-backward.asc", "from_record": first, "to_record": after, "finding": "spike",
         "channel": None, "repeated": False, **more}
        for first, after in stretches
    ]  # fmt: skip
    return chain.again(results, "segment", masks=pd.DataFrame(rows))


@pytest.mark.parametrize(
    "channel", [None, "gyro_z", "gyro_x"], ids=["all channels", "gyro z", "gyro x"]
)
@pytest.mark.parametrize(
    ("stretches", "most"),
    [
        ([(2000, 2001)], 0.1),  # a spike in the steady part
        ([(n, n + 1) for n in range(1500, 3000, 100)], 1.0),
        ([(2000, 2300)], 12.0),
        ([(1100, 1101)], 10.0),  # in a ramp: 5 °/s² × 0.2 s × 0.01 s / 4 are 9″
        ([(1100, 1103), (3500, 3502)], 30.0),
    ],
)
def test_a_masked_record_loses_no_angle(whole, stretches, most, channel):
    """`most`: arc seconds, what the sigma may be."""
    tables = masked(whole, *stretches, channel=channel)
    done = of_z(tables)
    missing = STEP * sum(after - first for first, after in stretches)
    assert done["bridged"] and not done["complete"]
    assert done["missing_s"] == pytest.approx(missing)
    before, now = inputs_of(whole).turns[-1], inputs_of(whole, tables).turns[-1]
    assert now.weights @ now.seconds == pytest.approx(before.seconds.sum())
    off = now.weights @ now.sums[:, 2] - before.sums[:, 2].sum()
    noise = NOISE * np.sqrt(missing * (1 + missing / 30))
    # Unbridged it would lack 0.1° for each record.
    assert abs(off) < 3 * np.hypot(noise, now.bridged_sigma)
    assert degrees(now.bridged_sigma) * 3600 < most
    assert np.isfinite(now.sums).all()


def test_a_masked_stretch_of_a_ramp_is_refused(whole):
    done = of_z(masked(whole, (1080, 1110)))
    assert not done["complete"] and not done["bridged"]
    assert "more than 3 samples in a row are masked" in done["sentence"]


def test_a_repeated_record_and_a_masked_accelerometer_leave_the_turn_whole(whole):
    for more in ({"repeated": True}, {"channel": "accel_x"}):
        assert of_z(masked(whole, (1100, 1101), **more))["complete"]


def test_a_gyro_that_is_masked_all_the_time_is_one_that_is_not_recorded(whole):
    tables = masked(whole, (0, 6000), channel="gyro_x")
    assert of_z(tables)["complete"]
    one = inputs_of(whole, tables).turns[-1]
    assert np.isnan(one.sums[:, 0]).all() and np.isfinite(one.sums[:, 1:]).all()


# ---- stamps


COLUMNS = """
campaign: 1
instrument: {name: made up}
serial: unknown
date: unknown
site: {latitude_deg: null, gravity_m_s2: 9.8}
table: {name: table}
log: log.csv
formats:
  log:
    kind: columns
    delimiter: ","
    time: {column: 1, unit: s}
    accelerometer: {columns: [2, 3, 4], unit: m/s2}
    gyro: {columns: [5, 6, 7], unit: deg/s}
plan:
  - {id: turn, do: turn, up: +z, degrees: 90, rate_deg_s: 10, accel_deg_s2: 20, format: log}
"""


@pytest.mark.parametrize(("later", "missing"), [(0.0, 205 / 102.4), (0.003, 205 / 102.4 + 0.003)])
def test_stamps_of_a_millisecond_still_tell_a_whole_number_of_samples(later, missing, tmp_path):
    """102.4 samples per second, 205 of them lost; or a logger that began anew, 3 ms out of step."""
    n, rng = 3000, np.random.default_rng(4)
    time = np.arange(n) / 102.4
    turning = time - 10  # the turn takes 9.5 s
    rate = 10 * np.clip(np.minimum(turning, 9.5 - turning) / 0.5, 0, 1)
    values = np.column_stack([np.zeros((n, 2)), np.full(n, 9.8), np.zeros((n, 2)), rate])
    values += 1e-3 * rng.standard_normal(values.shape)
    time[1505:] += later
    kept = np.r_[:1300, 1505:n]
    rows = [f"{t:.3f}," + ",".join(f"{v:.6f}" for v in values[i]) for i, t in enumerate(time)]
    (tmp_path / "raw").mkdir()
    (tmp_path / "raw/campaign.yaml").write_text(COLUMNS)
    (tmp_path / "raw/log.csv").write_text("\n".join(rows[i] for i in kept) + "\n")
    results = chain.run(tmp_path / "raw", tmp_path / "derived", "segment")
    done = results["segment/performed"].iloc[0]
    assert done["bridged"]
    assert done["missing_s"] == pytest.approx(missing, abs=1e-3 if later else 1e-4)
    assert degrees(done["angle"] + done["missing_angle"]) == pytest.approx(90, abs=0.1)


# ---- what an assumed angle would do


def test_an_assumed_angle_is_wrong_by_far_more_than_its_sigma(gapped):
    """S0's 360° of which a third is missing, and its 240° for what are 240.30°."""
    truth = chain.demo()["truth"]["gyro"]
    scale, bias = truth["matrix"][2][2] - 1, truth["bias_rad_s"][2]
    inputs = inputs_of(gapped)
    forward, backward = inputs.recorded
    sums = [float(r.blocks.gyro[:, 2] @ r.blocks.seconds) for r in (forward, backward)]
    seconds = [float(r.blocks.seconds.sum()) for r in (forward, backward)]
    up = inputs.earth.up

    # S0 (3-9), (3-10) as printed, both turns over the same time: a sixth of the scale factor.
    by_formula = (sums[0] - sums[1]) / (4 * np.pi) - 1 - scale
    assert 1e6 * by_formula == pytest.approx(-166320, abs=15)
    bias_by_formula = degrees((sums[0] + sums[1]) / (2 * seconds[0]) - up)
    assert bias_by_formula == pytest.approx(119.7 / (2 * seconds[0]), rel=2e-3)

    # With the times of each, and 240° for the backward turn.
    def formulas(angle: float):
        pairs = zip(sums, (2 * np.pi, -radians(angle)), seconds, strict=True)
        return known_angle([Angle(s, a, ANGLE, t, 1.0, NOISE) for s, a, t in pairs], inputs.earth)

    assumed = formulas(240)
    assert 1e6 * (assumed.values[1] - scale) == pytest.approx(612, abs=15)
    assert degrees(assumed.values[0] - bias) * 3600 == pytest.approx(-20.6, abs=0.5)  # °/h
    assert abs(assumed.values[1] - scale) > 150 * assumed.sigma[1]

    # The joint estimate, with nothing but this turn about z.
    def together(turn: Turn):
        fit = joint(inputs.rests, [turn], [], inputs.earth, inputs.position_sigma)
        return fit.values[Z_SCALE] - 1 - scale, fit.sigma[Z_SCALE]

    gap = inputs.turns[-1]
    unbridged = replace(gap, bridges=(), bridged_sigma=0.0)
    by_240, sigma_240 = together(replace(unbridged, angle=-radians(240)))
    assert 1e6 * by_240 == pytest.approx(1251, abs=25)
    assert by_240 > 100 * sigma_240
    by_bridge, sigma = together(gap)
    assert 1e6 * sigma == pytest.approx(34, abs=2)
    assert abs(by_bridge) < 1.5 * sigma


def test_criticism_and_extension_take_the_turn_as_the_joint_estimate_does(tmp_path):
    document = chain.demo(faults=lose((2193, 1197)))
    for entry in document["campaign"]["plan"]:
        entry |= {"seconds": 30} if entry["do"] == "rest" else {}
    campaign = chain.simulate(document, tmp_path / "raw")
    results = chain.run(campaign, tmp_path / "derived", "gyroscope")
    given = known_of(results["plan/known"])
    of_stages = [results[f"{stage}/parameters"] for stage in ("accelerometer", "gyroscope")]
    set_up = [results[f"{stage}/positions"] for stage in ("accelerometer", "gyroscope")]
    campaign = campaign_of(
        results["segment/blocks"],
        manoeuvres_of(results["plan/manoeuvres"]),
        performed_of(results["segment/performed"]),
        NoiseLevels(results["noise/noise"]),
        given,
        solution_of(tuple(of_stages), tuple(set_up), given, ""),
        shared_clock=True,
    )
    assert "z-backward" in campaign.manoeuvres
    system, _ = campaign.systems([], 1.0)
    assert system.column("bridged", "z-backward 5") is not None
    again = system.solve()
    joint_result = results.parameters("gyroscope").loc[list(linear_names())]
    values = errors_of(again.values[:12]) - joint_result["value"].to_numpy(float)
    assert np.abs(values / joint_result["sigma"].to_numpy(float)).max() < 0.02
    np.testing.assert_allclose(again.sigma[:12], joint_result["sigma"], rtol=1e-3)


def test_the_bridged_turn_lowers_the_sigma_of_the_scale_factor(gapped):
    inputs = inputs_of(gapped)
    fixed = (inputs.rests, [], inputs.earth, inputs.position_sigma)

    def sigma(turns: list[Turn]) -> float:
        return float(joint(fixed[0], turns, *fixed[1:]).sigma[Z_SCALE])

    assert sigma(inputs.turns) < sigma(inputs.turns[:1])
