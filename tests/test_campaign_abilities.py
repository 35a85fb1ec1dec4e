"""What a campaign file can say, through the real chain, on logs whose truth the laboratory knows.

The campaign is that of `chain.short`, written as columns of counts; each test states the same
recording in another way.
"""

import copy
import shutil
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import chain
import numpy as np
import pytest
from ruamel.yaml import YAML

from inertial.estimation.triad import linear_names
from inertial.tables.errors import Refusal

Document = dict[str, Any]
CAMPAIGNS = Path(__file__).parent / "campaigns"
MAX_SIGMA = 4.5  # of 24 parameters with Gaussian errors, in 1 of 6000 campaigns
HEADERS = {
    8: "time,gyro_x,gyro_y,gyro_z,accel_x,accel_y,accel_z,temperature",
    4: "columns of one sensor",
}
STAGES = {"accelerometer": "accel", "gyroscope": "gyro"}


def in_columns(rate_hz: float = 100, seed: int = 5) -> Document:
    """The short campaign as columns of counts."""
    document = copy.deepcopy(chain.short(seed=seed))
    document["receiver"] |= {"message": "columns", "rate_hz": rate_hz, "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "made up"}
    return document


@pytest.fixture(scope="session")
def simple(tmp_path_factory) -> Path:
    """Its folder, whose campaign file says what any could say before."""
    return chain.simulate(in_columns(), tmp_path_factory.mktemp("simple") / "raw")


@pytest.fixture(scope="session")
def simple_results(simple, tmp_path_factory) -> chain.Results:
    return chain.run(simple, tmp_path_factory.mktemp("simple") / "derived")


def told(folder: Path) -> Document:
    """A campaign file as a plain dict."""
    return YAML(typ="safe").load(folder / "campaign.yaml")


def tell(folder: Path, campaign: Document) -> None:
    folder.mkdir(exist_ok=True)
    with (folder / "campaign.yaml").open("w", encoding="utf-8") as file:
        YAML(typ="safe").dump(campaign, file)


@cache
def numbers(log: Path) -> np.ndarray:
    """Time, gyros, accelerometers, temperature."""
    return np.loadtxt(log, delimiter=",", skiprows=1)


def write(log: Path, rows: np.ndarray) -> None:
    whole = ",".join(["%.6f", *["%.6g"] * (rows.shape[1] - 1)])
    np.savetxt(log, rows, fmt=whole, header=HEADERS[rows.shape[1]], comments="")


def off_truth(results: chain.Results) -> np.ndarray:
    """The errors of the 24 parameters in their sigmas."""
    truth = in_columns()["truth"]
    errors = []
    for stage, key, bias in (
        ("accelerometer", "accelerometer", "bias_m_s2"),
        ("gyroscope", "gyro", "bias_rad_s"),
    ):
        joint = results.parameters(stage).loc[list(linear_names())]
        matrix = np.array(truth[key]["matrix"]) - np.eye(3)
        right = np.append(matrix.ravel(), truth[key][bias])
        errors.append((joint["value"] - right) / joint["sigma"])
    return np.concatenate(errors)


def values(results: chain.Results, column: str = "value") -> np.ndarray:
    return np.concatenate([results.parameters(stage)[column].to_numpy() for stage in STAGES])


def test_the_campaign_itself_is_calibrated(simple_results):
    assert np.abs(off_truth(simple_results)).max() < MAX_SIGMA


# ---- unsigned counts


def rewritten(simple: Path, folder: Path, change: Callable[[np.ndarray], np.ndarray]) -> Document:
    """The same logs with other numbers in them, and the campaign, of which nothing is written."""
    folder.mkdir()
    for log in simple.glob("*.asc"):
        write(folder / log.name, change(numbers(log)))
    return told(simple)


@pytest.mark.slow
def test_counts_with_a_zero_of_their_own_are_the_same_campaign(simple, simple_results, tmp_path):
    zeros, sizes = np.array([70000, 65536, 70001]), np.array([1, 2, 4])

    def unsigned(rows):
        rows = rows.copy()
        rows[:, 1:4] += 32768
        rows[:, 4:7] = rows[:, 4:7] * sizes + zeros
        return rows

    campaign = rewritten(simple, tmp_path / "raw", unsigned)
    layout = campaign["instrument"]["format"]
    layout["gyro"]["zero_counts"] = 32768
    layout["accelerometer"]["zero_counts"] = zeros.tolist()
    per_unit = layout["accelerometer"]["counts_per_unit"]
    layout["accelerometer"]["counts_per_unit"] = (per_unit * sizes).tolist()
    tell(tmp_path / "raw", campaign)
    results = chain.run(tmp_path / "raw", tmp_path / "derived")
    np.testing.assert_allclose(values(results), values(simple_results), atol=1e-12, rtol=1e-9)


def test_unsigned_counts_that_are_not_said_to_be_are_refused_with_their_zero(simple, tmp_path):
    def unsigned(rows):
        rows = rows.copy()
        rows[:, 4:7] = np.rint(rows[:, 4:7] / 16) + 32768  # 1 g: 4010 counts
        return rows

    campaign = rewritten(simple, tmp_path / "raw", unsigned)
    campaign["instrument"]["format"]["accelerometer"]["counts_per_unit"] /= 16
    tell(tmp_path / "raw", campaign)
    with pytest.raises(Refusal, match=r"accelerometer[\s\S]*add zero_counts: 32768"):
        chain.run(tmp_path / "raw", tmp_path / "derived", "decode")
    campaign["instrument"]["format"]["accelerometer"]["zero_counts"] = 32768
    tell(tmp_path / "raw", campaign)
    results = chain.run(tmp_path / "raw", tmp_path / "derived", "quality")
    assert results["quality/findings"].empty


# ---- axes, signs, conventions


@pytest.mark.slow
def test_axes_and_signs_of_each_sensor_undo_those_of_the_log(simple, simple_results, tmp_path):
    """Columns z, −x, y of the gyros; accelerometers that read −g on the axis that points up."""

    def turned(rows):
        rows = rows.copy()
        rows[:, 1:4] = rows[:, [3, 1, 2]] * [1, -1, 1]
        rows[:, 4:7] = -rows[:, [5, 4, 6]]
        return rows

    campaign = rewritten(simple, tmp_path / "raw", turned)
    campaign["instrument"]["gyro"] = {"axes": ["z", "-x", "y"]}
    campaign["instrument"]["accelerometer"] = {"axes": ["y", "x", "z"], "reads": "gravity"}
    tell(tmp_path / "raw", campaign)
    results = chain.run(tmp_path / "raw", tmp_path / "derived")
    assert results["segment/repairs"].empty
    np.testing.assert_allclose(values(results), values(simple_results), atol=1e-12, rtol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("message", ["columns", "RAWIMUSA"])
def test_one_reversed_gyro_that_is_stated_needs_no_repair(message, tmp_path):
    document = in_columns()
    document["faults"] = [{"flip": {"log": "all", "sensor": "gyro", "axis": "x"}}]
    if message != "columns":
        document["receiver"]["message"] = message
        document["campaign"]["instrument"] = "span-cpt"
    folder = chain.simulate(document, tmp_path / "raw")
    campaign = told(folder)
    repaired = chain.run(folder, tmp_path / "derived")
    assert list(repaired["segment/repairs"]["repair"]) == ["signs"]
    if message == "columns":
        campaign["instrument"]["gyro"] = {"axes": ["-x", "y", "z"]}
    else:
        listed = YAML(typ="safe").load(chain.ROOT / "data/instruments.yaml")["span-cpt"]
        # Its fields are z, −y, x.
        campaign["instrument"] = listed | {"gyro": listed["gyro"] | {"axes": ["z", "-y", "-x"]}}
    tell(folder, campaign)
    results = chain.run(folder, tmp_path / "stated")
    assert results["segment/repairs"].empty and results["segment/findings"].empty
    np.testing.assert_allclose(values(results), values(repaired), atol=1e-12, rtol=1e-9)


@pytest.mark.slow
def test_a_table_that_counts_clockwise(simple, simple_results, tmp_path):
    campaign = rewritten(simple, tmp_path / "raw", lambda rows: rows)
    for manoeuvre in campaign["plan"]:
        if "degrees" in manoeuvre:
            manoeuvre["degrees"] *= -1
    campaign["table"]["counts"] = "clockwise"
    tell(tmp_path / "raw", campaign)
    results = chain.run(tmp_path / "raw", tmp_path / "derived")
    assert results["segment/repairs"].empty
    np.testing.assert_array_equal(values(results), values(simple_results))


# ---- what is not known: attitude, time


@pytest.mark.parametrize("recorded", ["whole", pytest.param("steady", marks=pytest.mark.slow)])
def test_a_turn_of_which_only_the_axis_is_known_gives_its_scale(
    recorded, simple, simple_results, tmp_path
):
    """The rests beside it show the earth's rate along its axis; steady, the table's rate counts."""
    campaign = rewritten(simple, tmp_path / "raw", lambda rows: rows)
    for manoeuvre in campaign["plan"]:
        if manoeuvre["do"] == "turn":
            manoeuvre |= {"about": manoeuvre["up"], "up": "unknown", "recorded": recorded}
            if recorded == "steady":
                manoeuvre["rate_deg_s"] *= -1 if manoeuvre.pop("degrees") < 0 else 1
    tell(tmp_path / "raw", campaign)
    results = chain.run(tmp_path / "raw", tmp_path / "derived", "diagnosis", chain.BESIDE)
    assert np.abs(off_truth(results)).max() < MAX_SIGMA
    assert results["diagnosis/causes"].empty
    scale, known = (
        each.parameters("gyroscope").loc["scale_x", "sigma"] for each in (results, simple_results)
    )
    if recorded == "whole":
        assert known < scale < 3 * known
    else:
        # Of two turns each rate is off by 100 ppm, and both by as much together.
        assert scale == pytest.approx(100e-6 * np.sqrt(1 + 1 / 2), rel=0.02)


@pytest.mark.slow
def test_rows_without_a_time_are_counted_at_the_rate_of_the_instrument(
    simple, simple_results, tmp_path
):
    campaign = rewritten(simple, tmp_path / "raw", lambda rows: rows)
    del campaign["instrument"]["format"]["time"]
    campaign["instrument"]["rate_hz"] = 100
    tell(tmp_path / "raw", campaign)
    results = chain.run(tmp_path / "raw", tmp_path / "derived")
    away = values(results) - values(simple_results)
    assert np.abs(away / values(results, "sigma")).max() < 0.01


# ---- means only


NOISE = in_columns()["noise"]
GYRO_SAMPLE = np.radians(NOISE["angle_random_walk_deg_sqrt_h"]) / 60 / np.sqrt(0.01)  # rad/s
FORCE_SAMPLE = NOISE["velocity_random_walk_m_s_sqrt_h"] / 60 / np.sqrt(0.01)  # m/s²


def means_of(simple: Path, folder: Path, pieces: int) -> Document:
    """Each rest as some means, each turn as the mean of its steady part: one row each."""
    campaign = told(simple)
    layout, plan, rows = campaign["instrument"]["format"], [], []
    sizes = np.repeat([layout[s]["counts_per_unit"] for s in ("gyro", "accelerometer")], 3)
    for manoeuvre in campaign["plan"]:
        samples = numbers(simple / manoeuvre.pop("log"))
        rest = manoeuvre["do"] == "rest"
        parts = np.array_split(samples, pieces) if rest else [samples[450:850]]
        for number, part in enumerate(parts):
            own = {"id": f"{manoeuvre['id']}-{number}", "rows": [len(rows), len(rows) + 1]}
            own["position"] = manoeuvre["id"]
            plan.append({key: manoeuvre[key] for key in ("do", "up")} | own)
            if not rest:
                sign = -1 if manoeuvre["degrees"] < 0 else 1
                plan[-1] |= {"recorded": "steady", "rate_deg_s": sign * manoeuvre["rate_deg_s"]}
            rows.append([*part[:, 1:7].mean(axis=0) / sizes, len(part)])
    folder.mkdir()
    np.savetxt(folder / "means.txt", np.array(rows), fmt="%.12g")
    layout = {"kind": "columns", "gyro": {"columns": [1, 2, 3], "unit": "rad/s"}}
    layout["accelerometer"] = {"columns": [4, 5, 6], "unit": "m/s2"}
    campaign["instrument"] = {"name": "made up", "format": layout}
    return campaign | {"log": "means.txt", "plan": plan}


def test_means_with_the_sigma_of_a_sample_are_as_good_as_their_samples(
    simple, simple_results, tmp_path
):
    campaign = means_of(simple, tmp_path / "raw", 1)
    layout = campaign["instrument"]["format"] | {"mean_of": 7}
    layout["gyro"]["sigma"] = float(GYRO_SAMPLE)
    layout["accelerometer"]["sigma"] = [float(FORCE_SAMPLE)] * 3
    campaign["instrument"]["format"] = layout
    tell(tmp_path / "raw", campaign)
    results = chain.run(tmp_path / "raw", tmp_path / "derived", "diagnosis", chain.BESIDE)
    assert results["diagnosis/causes"].empty
    assert np.abs(off_truth(results)).max() < MAX_SIGMA
    for stage, names in (("accelerometer", None), ("gyroscope", ["bias_x", "bias_y", "bias_z"])):
        ratio = results.parameters(stage)["sigma"] / simple_results.parameters(stage)["sigma"]
        ratio = ratio if names is None else ratio[names]
        assert ratio.min() > 0.7 and ratio.max() < 1.4


def test_of_enough_means_the_residuals_show_the_sigma(simple, tmp_path):
    campaign = means_of(simple, tmp_path / "raw", 4)
    campaign["instrument"]["format"]["mean_of"] = None
    campaign["table"]["position_sigma_arcsec"] = 0.01
    tell(tmp_path / "raw", campaign)
    results = chain.run(tmp_path / "raw", tmp_path / "derived")
    scatter = [results[f"{s}/fit"].query("method == 'joint'")["scatter"].item() for s in STAGES]
    # 24 means of 5 s; the gyros' turns are 6 means of 4 s.
    expected = np.array([FORCE_SAMPLE, GYRO_SAMPLE]) / np.sqrt(500)
    assert scatter[0] == pytest.approx(
        np.hypot(expected[0], 2 * np.radians(1 / 3600) * 9.8), rel=0.4
    )
    assert scatter[1] == pytest.approx(expected[1], rel=0.4)
    assert np.abs(off_truth(results)).max() < MAX_SIGMA


def test_few_means_of_unknown_sigma_give_nothing_and_say_what_is_missing(simple, tmp_path):
    campaign = means_of(simple, tmp_path / "raw", 1)
    campaign["instrument"]["format"]["mean_of"] = 7
    tell(tmp_path / "raw", campaign)
    results = chain.run(tmp_path / "raw", tmp_path / "derived")
    joint = results.parameters("accelerometer")
    assert joint["value"].isna().all() and joint["reason"].str.contains("state sigma").all()


GRAVITY = 9.83218  # m/s², at the pole, where the earth turns about the vertical: as the table does
UP = 7.292115e-5  # rad/s
FACES = np.vstack([np.eye(3), -np.eye(3)])
EDGES = np.array([[1, 1, 0], [-1, 1, 0], [0, 1, 1], [0, -1, 1], [1, 0, 1], [1, 0, -1]]) / 2**0.5
SPINS = np.array([1.0, -1.0, 2.0, -2.0])  # rad/s, about each axis


def known_means(folder: Path, seed: int) -> tuple[Document, dict[str, list[np.ndarray]]]:
    """Means whose sigmas differ up to thirtyfold, written with them, and as an own fit takes them.

    Attitudes in g, of which the IMU counts 4096, with a column for each axis; rates with one for
    all. By sensor: inputs (n, 3), means and sigmas, SI.
    """
    random = np.random.default_rng(seed)
    truth = in_columns()["truth"]
    ups = np.vstack([FACES, EDGES])
    forces, rates = GRAVITY * ups, np.kron(SPINS[:, None], np.eye(3))
    turning = rates + UP * np.tile(np.eye(3), (len(SPINS), 1))
    inputs = {"accelerometer": forces, "gyro": np.vstack([UP * ups, turning])}
    usual = {"accelerometer": 1e-3, "gyro": 1e-5}
    known = {}
    for (sensor, own), bias in zip(inputs.items(), ("bias_m_s2", "bias_rad_s"), strict=True):
        sigma = usual[sensor] * 10 ** random.uniform(-0.75, 0.75, own.shape)
        if sensor == "gyro":
            sigma[len(ups) :] = sigma[len(ups) :, :1]
        means = own @ np.array(truth[sensor]["matrix"]).T + truth[sensor][bias]
        known[sensor] = [own, means + sigma * random.standard_normal(own.shape), sigma]
    folder.mkdir()
    count = GRAVITY / 4096  # a unit of its own, to which counts_per_unit leads
    (_, means, sigma), (_, of_gyros, gyro_sigma) = known["accelerometer"], known["gyro"]
    still = [means / count, of_gyros[: len(ups)], sigma / count, gyro_sigma[: len(ups)]]
    np.savetxt(folder / "still.txt", np.hstack(still), fmt="%.12g")
    moving = [of_gyros[len(ups) :], gyro_sigma[len(ups) :, :1]]
    np.savetxt(folder / "moving.txt", np.hstack(moving), fmt="%.12g")
    per_unit = {"unit": "m/s2", "counts_per_unit": 1 / count}
    accelerometer = per_unit | {"columns": [1, 2, 3], "sigma_columns": [7, 8, 9]}
    gyro = {"unit": "rad/s", "columns": [4, 5, 6], "sigma_columns": [10, 11, 12]}
    turned = {"unit": "rad/s", "columns": [1, 2, 3], "sigma_columns": [4, 4, 4]}
    plan = [
        {"id": f"up-{i}", "do": "rest", "up": up.tolist(), "log": "still.txt", "format": "still"}
        | {"rows": [i, i + 1]}
        for i, up in enumerate(ups)
    ]
    for i, (spin, axis) in enumerate((spin, axis) for spin in SPINS for axis in "xyz"):
        steady = {"do": "turn", "up": f"+{axis}", "recorded": "steady", "id": f"turn-{i}"}
        steady |= {"rate_deg_s": float(np.degrees(spin)), "rows": [i, i + 1]}
        plan.append(steady | {"log": "moving.txt", "format": "moving"})
    means_only = {"kind": "columns", "mean_of": None}
    campaign = {
        "campaign": 1,
        "instrument": {"name": "made up"},
        "serial": "unknown",
        "date": "unknown",
        "site": {"latitude_deg": 90, "gravity_m_s2": GRAVITY, "gravity_sigma_m_s2": 1e-9},
        "table": {"name": "a", "position_sigma_arcsec": 1e-4, "rate_sigma_ppm": 1e-3},
        "formats": {
            "still": means_only | {"accelerometer": accelerometer, "gyro": gyro},
            "moving": means_only | {"gyro": turned},
        },
        "plan": plan,
    }
    tell(folder, campaign)
    return campaign, known


def weighted(own: np.ndarray, means: np.ndarray, sigma: np.ndarray) -> tuple[np.ndarray, ...]:
    """M less the unit matrix by rows, then the bias, and their sigmas, axis by axis."""
    design = np.column_stack([own, np.ones(len(own))])
    normal = np.einsum("ni,na,nj->aij", design, sigma**-2, design)
    right = np.einsum("ni,na,na->ai", design, sigma**-2, means)
    covariance = np.linalg.inv(normal)
    found = np.einsum("aij,aj->ai", covariance, right)
    spread = np.sqrt(np.diagonal(covariance, axis1=1, axis2=2))
    found[:, :3] -= np.eye(3)
    return tuple(np.append(each[:, :3].ravel(), each[:, 3]) for each in (found, spread))


@pytest.mark.slow
def test_means_with_a_sigma_each_are_weighted_by_it(tmp_path):
    pulls = []
    for seed in range(4):
        _, known = known_means(tmp_path / f"raw-{seed}", seed)
        results = chain.run(tmp_path / f"raw-{seed}", tmp_path / f"derived-{seed}")
        for stage, sensor in zip(STAGES, known, strict=True):
            joint = results.parameters(stage).loc[list(linear_names())]
            value, sigma = weighted(*known[sensor])
            fit = results[f"{stage}/fit"].query("method == 'joint'").iloc[0]
            assert fit["scatter"] == 0, (seed, stage)
            np.testing.assert_allclose(joint["sigma"], sigma, rtol=1e-3)
            assert np.abs((joint["value"] - value) / sigma).max() < 1e-2
        pulls.append(off_truth(results))
    # 96 pulls; those of one campaign are correlated, so that the sum of squares scatters by more
    # than √(2 · 96) = 14.
    assert 55 < np.sum(np.square(pulls)) < 145
    assert np.abs(pulls).max() < MAX_SIGMA


def test_the_mean_of_two_means_has_the_sigma_of_both(tmp_path):
    """Two rows of one rest count alike: σ = √(σ₁² + σ₂²) / 2."""
    campaign, known = known_means(tmp_path / "raw", 0)
    log = tmp_path / "raw/still.txt"
    rows = np.loadtxt(log)
    rows[1, :6] = rows[0, :6] * (1 + 1e-7)  # equal ones would be a copy
    np.savetxt(log, rows, fmt="%.12g")
    (first, _second, *others) = campaign["plan"]
    campaign["plan"] = [first | {"rows": [0, 2]}, *others]
    tell(tmp_path / "raw", campaign)
    levels = chain.run(tmp_path / "raw", tmp_path / "derived", "noise")["noise/levels"]
    own = levels[levels["manoeuvre"] == first["id"]].set_index("channel")
    expected = np.linalg.norm(known["accelerometer"][2][:2], axis=0) / 2
    channels = ["accel_x", "accel_y", "accel_z"]
    np.testing.assert_allclose(own.loc[channels, "white_noise"] / np.sqrt(2), expected)
    assert (own["source"] == "stated").all()


@pytest.mark.parametrize("nonsense", ["0", "-0.001", "nan", "none"])
def test_a_sigma_that_is_none_refuses_its_row_by_name(nonsense, tmp_path):
    known_means(tmp_path / "raw", 0)
    log = tmp_path / "raw/still.txt"
    lines = [line.split() for line in log.read_text().splitlines()]
    lines[2][7] = nonsense
    log.write_text("\n".join(map(" ".join, lines)) + "\n")
    results = chain.run(tmp_path / "raw", tmp_path / "derived", "segment")
    (refused,) = results["decode/refused"].itertuples()
    assert (refused.log, refused.line) == ("still.txt", 3)
    assert f"column 8 is '{nonsense}'" in refused.reason
    assert "the standard deviation of a mean, above 0" in refused.reason
    performed = results["segment/performed"].set_index("manoeuvre")["found"]
    assert list(performed[~performed].index) == ["up-2"]


# ---- accelerometers and gyros in a log each


def apart(
    simple: Path,
    folder: Path,
    gyros: Callable[[np.ndarray], np.ndarray],
    accelerometers: Callable[[np.ndarray], np.ndarray] = lambda rows: rows,
    gyros_of: Path | None = None,
) -> Document:
    """The same campaign with the two sensors in logs of their own."""
    folder.mkdir()
    campaign = told(simple)
    for manoeuvre in campaign["plan"]:
        log = manoeuvre["log"]
        rows = accelerometers(numbers(simple / log))
        write(folder / log, rows[:, [0, 4, 5, 6]])
        rows = gyros(numbers((gyros_of or simple) / log))
        write(folder / f"gyro-{log}", rows[:, :4])
        manoeuvre["gyro"] = {"log": f"gyro-{log}"}
    layout = campaign["instrument"]["format"]
    del layout["temperature"]
    layout["time"]["column"] = 1
    layout["gyro"]["columns"] = layout["accelerometer"]["columns"] = [2, 3, 4]
    tell(folder, campaign)
    return campaign


@pytest.mark.slow
def test_two_logs_with_the_same_stamps_are_the_same_campaign(simple, simple_results, tmp_path):
    apart(simple, tmp_path / "raw", gyros=lambda rows: rows)
    results = chain.run(tmp_path / "raw", tmp_path / "derived")
    np.testing.assert_array_equal(values(results), values(simple_results))
    np.testing.assert_array_equal(values(results, "sigma"), values(simple_results, "sigma"))
    sizes = {log.name: log.stat().st_size for log in (tmp_path / "raw").glob("*.asc")}
    assert results["decode/accounts"].groupby("log")["bytes"].sum().to_dict() == sizes


@pytest.mark.slow
@pytest.mark.parametrize(
    ("gyro_hz", "late_s"),
    [
        (100, 0.0037),
        (73, 0.0),
        (400, 0.0),
    ],
)
def test_two_logs_with_stamps_of_their_own_are_joined(simple, gyro_hz, late_s, tmp_path):
    """The motion is the same; stamps, rates and noise of the gyros are others."""
    document = in_columns(gyro_hz, seed=6)
    other = chain.simulate(document, tmp_path / "other")

    def shifted(rows):
        rows = rows.copy()
        rows[:, 0] += late_s  # of which a turn from rest to rest knows nothing
        return rows[5:]

    campaign = apart(simple, tmp_path / "raw", shifted, gyros_of=other)
    counts = told(other)["instrument"]["format"]["gyro"]["counts_per_unit"]
    campaign["formats"] = {"gyros": copy.deepcopy(campaign["instrument"]["format"])}
    campaign["formats"]["gyros"]["gyro"]["counts_per_unit"] = counts
    for manoeuvre in campaign["plan"]:
        manoeuvre["gyro"]["format"] = "gyros"
    tell(tmp_path / "raw", campaign)
    results = chain.run(tmp_path / "raw", tmp_path / "derived")
    assert np.abs(off_truth(results)).max() < MAX_SIGMA
    assert results["quality/findings"].empty and results["segment/findings"].empty
    # The noise of a mean is that of the readings, whatever the rate, to a tenth.
    levels = results["noise/levels"].query("manoeuvre.isna()").set_index("channel")["white_noise"]
    noise = document["noise"]
    for sensor, level in (
        ("gyro", np.radians(noise["angle_random_walk_deg_sqrt_h"]) / 60),
        ("accel", noise["velocity_random_walk_m_s_sqrt_h"] / 60),
    ):
        found = levels[[f"{sensor}_{axis}" for axis in "xyz"]]
        np.testing.assert_allclose(found, level, rtol=0.1)
    samples = results["decode/samples"].query("log == 'x-up.asc'")
    lines = (tmp_path / "raw/x-up.asc").read_bytes().split(b"\n")
    told_time = [float(lines[line - 1].split(b",")[0]) for line in samples["line"]]
    apart_by = np.array(told_time) - float(lines[1].split(b",")[0]) - samples["time"]
    assert np.ptp(apart_by) < 0.011  # the line of the accelerometers nearest to the sample
    rate = 1 / results["decode/clocks"]["interval"]
    np.testing.assert_allclose(rate, min(gyro_hz, 100), rtol=1e-5)


@pytest.mark.slow
def test_two_logs_that_arrive_in_packets_of_their_own_are_joined(simple, simple_results, tmp_path):
    """5 accelerometer readings every 50 ms, 4 of the gyros every 40 ms, some ms late."""
    rng = np.random.default_rng(3)

    def arriving(size):
        def stamped(rows):
            row = np.arange(len(rows))
            packet = row // size
            last = np.minimum(size * (packet + 1), len(rows)) - 1
            late = rng.exponential(0.004, packet[-1] + 1)[packet] + 1e-4 * (row % size)
            rows = rows.copy()
            rows[:, 0] = rows[last, 0] + late
            return rows

        return stamped

    apart(simple, tmp_path / "raw", arriving(4), arriving(5))
    results = chain.run(tmp_path / "raw", tmp_path / "derived")
    assert set(results["quality/findings"]["cause"]) == {"arrival_stamps"}
    assert results["segment/performed"]["complete"].all()
    away = values(results) - values(simple_results)
    assert np.abs(away).max() < 2e-4  # the clock of 13 s by stamps that are 4 ms late


@pytest.mark.slow
def test_what_one_log_lacks_is_a_gap_of_both(simple, tmp_path):
    """1 s of the gyros are lost: nothing is made up in between."""

    def lost(rows):
        return rows[(rows[:, 0] < rows[0, 0] + 5) | (rows[:, 0] > rows[0, 0] + 6)]

    apart(simple, tmp_path / "raw", lost)
    results = chain.run(tmp_path / "raw", tmp_path / "derived", "segment")
    gaps = results["quality/gaps"]
    assert len(gaps) == 12 and gaps["missing"].between(99, 101).all()
    kinds = results["decode/accounts"].groupby("kind")["lines"].sum()
    assert kinds["not selected"] == gaps["missing"].sum()


def test_logs_without_common_time_are_refused(simple, tmp_path):
    def later(rows):
        return rows + np.eye(1, rows.shape[1]) * 1e4

    campaign = apart(simple, tmp_path / "raw", later)
    with pytest.raises(Refusal, match=r"gyro-x-up.asc, gyro.log[\s\S]*add offset_s to gyro"):
        chain.run(tmp_path / "raw", tmp_path / "derived", "decode")
    for manoeuvre in campaign["plan"]:
        manoeuvre["gyro"]["offset_s"] = -1e4
    tell(tmp_path / "raw", campaign)
    chain.run(tmp_path / "raw", tmp_path / "derived", "decode")


# ---- stamps of arrival


@pytest.mark.slow
def test_the_rate_of_a_clock_by_stamps_of_arrival_is_in_the_scale_factors(tmp_path):
    """The IMU samples at 100.03 Hz; a host fetches and stamps what waits every 20 to 60 ms.

    A scale factor by a turn either way is off by the mean error of their two clocks.
    """
    rate = 100.03
    exact = chain.simulate(in_columns(rate_hz=rate), tmp_path / "exact/raw")
    known = chain.run(exact, tmp_path / "exact/derived").parameters("gyroscope")
    turns = [m for m in told(exact)["plan"] if m["do"] == "turn"]
    scales, pulls = [f"scale_{axis}" for axis in "xyz"], []
    for seed in range(2):
        random = np.random.default_rng(seed)
        raw = tmp_path / f"raw-{seed}"
        raw.mkdir()
        tell(raw, told(exact))
        for log in sorted(exact.glob("*.asc")):
            rows = numbers(log).copy()
            fetched = rows[0, 0] + np.cumsum(random.uniform(0.02, 0.06, len(rows)))
            rows[:, 0] = fetched[np.searchsorted(fetched, rows[:, 0])]
            write(raw / log.name, rows)
        results = chain.run(raw, tmp_path / f"derived-{seed}")
        clocks = results["decode/clocks"].set_index("log")
        sigma = clocks["interval_sigma"] / clocks["interval"]
        assert sigma.between(20e-6, 1e-3).all()
        errors = (clocks["interval"] * rate - 1) / sigma
        assert np.abs(errors).max() < 4.5 and np.sqrt(np.mean(errors**2)) < 1.5
        joint = results.parameters("gyroscope")
        for axis, scale in zip("xyz", scales, strict=True):
            own = [sigma[m["log"]] for m in turns if m["up"][1] == axis]
            assert len(own) == 2
            expected = 1 / np.sqrt(np.sum(np.power(own, -2.0)))  # the better clock weighs more
            added = np.sqrt(joint.loc[scale, "sigma"] ** 2 - known.loc[scale, "sigma"] ** 2)
            assert added == pytest.approx(expected, rel=0.25)
            pulls.append((joint.loc[scale, "value"] - known.loc[scale, "value"]) / expected)
    # Six pulls: their rms scatters by 29 %.
    assert 0.4 < np.sqrt(np.mean(np.square(pulls))) < 1.9
    assert np.abs(pulls).max() < MAX_SIGMA


# ---- real recordings that need them


def test_ctu_turns_of_unknown_attitude_and_means_alone(recordings, tmp_path):
    raw = shutil.copytree(recordings / "ctu_prague", tmp_path / "raw")
    shutil.copy(CAMPAIGNS / "ctu.yaml", raw / "campaign.yaml")
    results = chain.run(raw, tmp_path / "derived", "diagnosis", chain.BESIDE)
    gyro = results.parameters("gyroscope").loc[["scale_x", "scale_y", "scale_z"]]
    simple_integration = np.array([0.9950, 0.9998, 1.0055]) - 1  # SOURCE.md
    assert np.abs((gyro["value"] - simple_integration) / gyro["sigma"]).max() < 2
    assert gyro["sigma"].max() < 0.002
    free = results.parameters("accelerometer", "free_positions")
    assert len(free["value"].dropna()) == 18 and free["sigma"].max() < 0.01
    fit = results["accelerometer/fit"].iloc[0]
    assert 1e-3 < fit["scatter"] < 2e-2  # m/s², of means of a MEMS
    verdict = results["diagnosis/verdict"].set_index("sensor")
    assert verdict.loc["accel", "method"] == "free_positions"


def test_sunsided_logs_apart_that_read_gravity(recorded):
    results = recorded("sunsided")
    assert results["segment/repairs"].empty and results["segment/findings"].empty
    turns = results["segment/performed"].set_index("manoeuvre")["angle"].dropna()
    np.testing.assert_allclose(np.abs(np.degrees(turns)), 720, atol=20)  # by hand, twice round
    lines = results["decode/accounts"].set_index("log")["lines"]
    assert len(lines) == 14 and set(results["decode/accounts"]["kind"]) == {"decoded"}
