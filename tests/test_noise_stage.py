"""Stage noise: hidden terms come back by channel, and no average spans what it must not."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import chain
import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from ruamel.yaml import YAML

import laboratory
from inertial import tables
from inertial.campaign.noise_levels import NoiseLevels, drifts_of_axes

RATE, STRETCH, COUNT = 10.0, 6000, 10  # Hz, samples of a stretch, stretches
WHITE = {"accel": 1e-4, "gyro": 3.5e-6}  # m/s/√s, rad/√s
WALK, INSTABILITY = 2e-7, 1.5e-6  # rad/s/√s of gyro y, rad/s of gyro z
STATED = 2e-6  # rad/s, m/s²: B by the data sheet
IMU = YAML(typ="safe").load(chain.ROOT / "data/instruments.yaml")["span-cpt"]
SETTINGS = {"from_hz": 0.5, "to_hz": 5.0}


@dataclass
class Batches:
    """The samples in batches of some size, and how often they are read."""

    table: pa.Table
    size: int = 4096
    passes: list[int] = field(default_factory=list)

    def columns(self, names: list[str]) -> Iterator[pa.RecordBatch]:
        self.passes.append(1)
        yield from self.table.select(names).to_batches(self.size)


def white(rng: np.random.Generator, samples: int) -> np.ndarray:
    """Samples (n, 6) of white noise alone."""
    level = np.repeat([WHITE["accel"], WHITE["gyro"]], 3)
    return level * np.sqrt(RATE) * rng.standard_normal((samples, 6))


def flicker(rng: np.random.Generator, samples: int) -> np.ndarray:
    """B = 1, shaped in the frequency domain."""
    frequency = np.fft.rfftfreq(4 * samples, 1 / RATE)
    shape = np.zeros(len(frequency))
    shape[1:] = np.sqrt(RATE / (2 * np.pi * frequency[1:]))
    drawn = np.fft.irfft(np.fft.rfft(rng.standard_normal(4 * samples)) * shape)
    return np.asarray(drawn[:samples])


def data_sheet(instability: float | None) -> pd.DataFrame:
    """That of an IMU that states nothing but its bias instability, B."""
    nothing = {"white_noise": None, "random_walk": None}
    places = [{"sensor": sensor, "axis": axis} for sensor in WHITE for axis in tables.AXES]
    return pd.DataFrame([place | nothing | {"bias_instability": instability} for place in places])


def of_stretches(values: np.ndarray, **changes: Any) -> dict[str, Any]:
    """What the stage reads: equally long rests one after the other in one log."""
    count = len(values)
    starts = np.arange(0, count, STRETCH)
    samples = {"log": ["a"] * count, "record": np.arange(count)}
    samples |= dict(zip(tables.CHANNELS, values.T, strict=True))
    segments = {"manoeuvre": [f"m{i}" for i in range(len(starts))], "phase": "rest", "log": "a"}
    segments |= {"from_record": starts, "to_record": np.minimum(starts + STRETCH, count)}
    clock = {"log": "a", "interval": 1 / RATE, "clock": "GPS"}
    clock |= {"epoch_gps": None, "began": None, "from_s": None, "to_s": None}
    clock |= {"begin": 0.0, "end": count / RATE}
    return {
        "campaign": pd.DataFrame({"table": ["three-axis"]}),
        "samples": Batches(pa.table(samples)),
        "mean_sigmas": tables.MEAN_SIGMAS.empty(),
        "blocks": tables.BLOCKS.empty(),
        "segments": pd.DataFrame(segments),
        "manoeuvres": tables.MANOEUVRES.empty(),
        "clocks": pd.DataFrame([clock]),
        "gaps": pd.DataFrame({"log": [], "record": []}),
        "masks": tables.MASKS.empty(),
        "channel_repairs": tables.CHANNEL_REPAIRS.empty(),
        "sensors": data_sheet(None),
        "ranges": tables.RANGES.empty(),
        **SETTINGS,
        **changes,
    }


def noise_of(inputs: dict[str, Any]) -> dict[str, pd.DataFrame]:
    stage = chain.stage_of("noise")
    made = stage.result(inputs)
    return {name: table.arrow(made[name]).to_pandas() for name, table in stage.writes.items()}


def drifting(seed: int) -> np.ndarray:
    """Each rest with a mean of its own; a walk of gyro y and flicker of gyro z go on and on."""
    rng = np.random.default_rng(seed)
    count = STRETCH * COUNT
    values = white(rng, count)
    values[:, 4] += WALK / np.sqrt(RATE) * np.cumsum(rng.standard_normal(count))
    values[:, 5] += INSTABILITY * flicker(rng, count)
    return values + np.repeat(rng.standard_normal((COUNT, 6)), STRETCH, axis=0)


@pytest.fixture(scope="module")
def hidden() -> dict[str, pd.DataFrame]:
    return noise_of(of_stretches(drifting(3), sensors=data_sheet(STATED)))


def test_hidden_terms_come_back_with_their_sigma(hidden):
    terms = hidden["terms"].set_index(["channel", "term"])
    assert len(terms) == 30 and (terms["seconds"] == STRETCH / RATE).all()
    for place, true in {
        ("gyro_y", "random_walk"): WALK,
        ("gyro_z", "bias_instability"): INSTABILITY,
        **{(f"{s}_{a}", "white_noise"): level for s, level in WHITE.items() for a in tables.AXES},
    }.items():
        found = terms.loc[place]
        assert found["detected"] and abs(found["value"] - true) < 3.5 * found["sigma"], place
        assert found["sigma"] < 0.2 * true
    others = terms[~terms["detected"]]
    assert len(others) >= 20
    assert others["upper"].notna().all() and others["value"].isna().all()
    assert (terms.xs("bias_instability", level="term")["data_sheet"] == STATED).all()


def test_only_the_axes_that_drift_have_a_drift_in_the_covariance():
    levels = NoiseLevels(noise_of(of_stretches(drifting(3)))["levels"])
    gyro = levels.drift("gyro")
    assert gyro.walk[1] == pytest.approx(WALK, rel=0.4) and not gyro.walk[[0, 2]].any()
    assert gyro.instability[2] == pytest.approx(INSTABILITY, rel=0.4)
    assert not gyro.instability[:2].any() and not levels.drift("accel")


def test_an_axis_that_shows_no_flicker_has_that_of_the_two_others_as_far_as_it_leaves_open():
    """They are of one design: a stretch of white noise says only what its flicker is below."""
    rng = np.random.default_rng(8)
    values = white(rng, STRETCH * COUNT)
    for axis, size in ((4, INSTABILITY), (5, 2 * INSTABILITY)):
        values[:, axis] += size * flicker(rng, len(values))
    found = noise_of(of_stretches(values))
    limit = found["terms"].set_index(["channel", "term"]).loc[("gyro_x", "bias_instability")]
    drift = NoiseLevels(found["levels"]).drift("gyro")
    assert not limit["detected"] and drift.instability[0] == limit["upper"]


def test_an_axis_with_a_step_in_one_rest_has_the_flicker_of_the_two_others():
    """The step is no drift, and says nothing against the flicker."""
    size, rng = 0.3 * INSTABILITY, np.random.default_rng(8)
    values = white(rng, STRETCH * COUNT)
    for axis in (3, 4, 5):
        values[:, axis] += size * flicker(rng, len(values))
    values[STRETCH // 2 : STRETCH, 3] += 4 * INSTABILITY
    found = noise_of(of_stretches(values))
    assert found["terms"].set_index("channel").loc["gyro_x", "stepped"].all()
    instability = NoiseLevels(found["levels"]).drift("gyro").instability
    assert instability[0] == pytest.approx(np.sqrt(np.mean(instability[1:] ** 2)))
    assert instability[0] == pytest.approx(size, rel=0.4)


@pytest.mark.parametrize(
    ("shown", "limit", "third"), [((3.0, 4.0), 9.0, 12.5**0.5), ((3.0, 4.0), 2.0, 2.0)]
)
def test_the_third_axis_has_the_mean_power_of_the_two_others(shown, limit, third):
    open_to, hinting = (
        SimpleNamespace(terms={"bias_instability": SimpleNamespace(most=limit, p_value=p_value)})
        for p_value in (0.4, 0.03)
    )
    axes: list[dict[str, float]] = [{}, *({"bias_instability": size} for size in shown)]
    assert drifts_of_axes(axes, [open_to] * 3)[0] == {"bias_instability": pytest.approx(third)}
    assert drifts_of_axes([{}, {}, axes[1]], [open_to] * 3) == [{}, {}, axes[1]]
    beside_one = drifts_of_axes([{}, {}, axes[1]], [open_to, hinting, open_to])
    assert beside_one == [{}, {"bias_instability": min(shown[0], limit)}, axes[1]]
    walking = {"random_walk": 1.0}
    assert drifts_of_axes([walking, *axes[1:]], [open_to] * 3)[0] == walking


def on_faces(seed: int, tilt: float = 0.0, walk: float = 0.0) -> np.ndarray:
    """Six rests on faces: the support tilts by a walk, rad/√s; so does the bias of x, m/s²/√s."""
    rng = np.random.default_rng(seed)
    values = white(rng, 6 * STRETCH)
    for i, face in enumerate(np.vstack([np.eye(3), -np.eye(3)])):
        rest = slice(i * STRETCH, (i + 1) * STRETCH)
        steps = rng.standard_normal((STRETCH, 3)) / np.sqrt(RATE)
        angle = tilt * np.cumsum(steps, axis=0)
        values[rest, :3] += 9.8 * (face + np.cross(face, angle))  # to the first order
        values[rest, 0] += walk * np.cumsum(rng.standard_normal(STRETCH)) / np.sqrt(RATE)
    return values


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_by_hand_a_support_that_tilts_is_no_drift_of_the_accelerometers(seed):
    """1e-6 rad/√s are 1e-5 m/s²/√s where an axis is level, and nothing where it is upright."""
    by_hand = {"campaign": pd.DataFrame({"table": ["by hand"]})}
    tilting, drifting = on_faces(seed, tilt=1e-6), on_faces(seed, walk=1e-5)
    supported = noise_of(of_stretches(tilting, **by_hand))
    assert not NoiseLevels(supported["levels"]).drift("accel")
    tilted = supported["terms"].groupby("channel")["tilted"].any()
    assert [channel for channel in tilted.index if tilted[channel]] == [
        f"accel_{axis}" for axis in tables.AXES
    ]
    own = NoiseLevels(noise_of(of_stretches(drifting, **by_hand))["levels"]).drift("accel")
    assert own.walk[0] == pytest.approx(1e-5, rel=0.3) and not own.walk[1:].any()
    on_table = NoiseLevels(noise_of(of_stretches(tilting))["levels"]).drift("accel")
    assert on_table.walk == pytest.approx(1e-5 * np.sqrt(2 / 3), rel=0.3)


@pytest.mark.parametrize("shaken", [0, 2])
@pytest.mark.parametrize("disturbance", ["swing", "creep"])
def test_by_hand_a_rest_that_is_shaken_or_creeps_is_not_in_the_noise_of_all(shaken, disturbance):
    """Of twelve rests of 5 s one swings at 1.3 Hz by 30 times the noise of 0.4 s, or creeps as far.

    From one sample to the next it is as the others; it was in their noise, eight times as much.
    """
    rate, samples, rests = 100.0, 500, 12
    sigma = np.repeat([WHITE["accel"], WHITE["gyro"]], 3) * np.sqrt(rate)
    values = sigma * np.random.default_rng(shaken).standard_normal((rests * samples, 6))
    time = np.arange(samples) / rate
    course = np.sin(2 * np.pi * 1.3 * time) if disturbance == "swing" else time
    own = slice(shaken * samples, (shaken + 1) * samples)
    values[own] += 5.0 * sigma * course[:, None]
    inputs = of_stretches(values, campaign=pd.DataFrame({"table": ["by hand"]}))
    starts = np.arange(rests) * samples
    inputs["segments"] = pd.DataFrame(
        {"manoeuvre": [f"m{i}" for i in range(rests)], "phase": "rest", "log": "a"}
        | {"from_record": starts, "to_record": starts + samples}
    )
    inputs["clocks"] = inputs["clocks"].assign(interval=1 / rate, end=len(values) / rate)
    made = noise_of(inputs)
    terms = made["terms"].set_index(["channel", "term"])
    for channel in tables.CHANNELS:
        found, true = terms.loc[(channel, "white_noise")], WHITE[channel.split("_")[0]]
        assert found["value"] == pytest.approx(true, rel=0.05)
        assert not terms.loc[channel, "detected"].drop("white_noise").any()
    allan = made["allan"]
    true = allan["channel"].str.split("_").str[0].map(WHITE) / np.sqrt(allan["tau"])
    assert (np.abs(allan["deviation"] / true - 1) < 5 / np.sqrt(allan["degrees"])).all()
    assert set(allan["stretches"]) == {rests - 1}


def test_where_none_is_seen_the_instability_of_the_data_sheet_enters_as_far_as_it_may_be(hidden):
    """2e-6 m/s² are far below what the rests show; 1e-4 rad/s are excluded by them."""
    levels, terms = NoiseLevels(hidden["levels"]), hidden["terms"].set_index(["channel", "term"])
    gyro, upper = levels.drift("gyro"), terms.loc[("gyro_x", "bias_instability"), "upper"]
    assert gyro.instability[0] == min(upper, STATED) and not gyro.instability[1]
    assert gyro.instability[2] == pytest.approx(INSTABILITY, rel=0.4)
    assert levels.drift("accel").instability.tolist() == [STATED] * 3
    too_much = noise_of(of_stretches(drifting(3), sensors=data_sheet(1e-4)))
    assert NoiseLevels(too_much["levels"]).drift("gyro").instability[0] == pytest.approx(upper)


def test_deviation_and_spectrum_stand_beside_the_model(hidden):
    allan = hidden["allan"]
    assert set(allan["channel"]) == set(tables.CHANNELS) and (allan["stretches"] == COUNT).all()
    assert (allan["lower"] < allan["deviation"]).all() and (
        allan["deviation"] < allan["upper"]
    ).all()
    assert allan["tau"].max() <= STRETCH / RATE / 4
    off = (allan["model"] - allan["deviation"]) / (allan["upper"] - allan["lower"])
    assert np.mean(np.abs(2 * off) < 2) > 0.9
    spectrum = hidden["spectra"].query("channel == 'gyro_x'")
    mean = np.average(spectrum["density"], weights=spectrum["degrees"])
    assert mean == pytest.approx(WHITE["gyro"] ** 2, rel=0.02)
    assert not hidden["spectra"]["line"].any()


def test_no_average_spans_a_gap_a_masked_sample_or_a_channel_that_is_masked():
    """The level jumps at each of them by 1000 sigma."""
    rng = np.random.default_rng(5)
    values = white(rng, 4 * STRETCH)
    gap, masked, of_channel = 2000, STRETCH + 3000, 2 * STRETCH + 1000
    jump = np.repeat([WHITE["accel"], WHITE["gyro"]], 3) * 1000
    for record in (gap, masked, of_channel):
        values[record:] += jump
    mask = dict.fromkeys((column.name for column in tables.MASKS.columns), None)
    mask |= {"log": "a", "repeated": False, "censored": False}
    masks = [
        mask | {"from_record": masked, "to_record": masked + 1},
        mask | {"from_record": of_channel - 5, "to_record": of_channel + 5}
        | {"sensor": "gyro", "axis": "x"},
    ]  # fmt: skip
    for size in (777, 1 << 20):
        inputs = of_stretches(values)
        inputs["gaps"] = pd.DataFrame({"log": ["a"], "record": [gap]})
        inputs["masks"] = pd.DataFrame(masks)
        inputs["samples"].size = size
        made = noise_of(inputs)
        assert inputs["samples"].passes == [1]
        gyro = made["allan"].query("channel == 'gyro_x' and tau > 10")
        expected = WHITE["gyro"] / np.sqrt(gyro["tau"])
        np.testing.assert_allclose(gyro["deviation"], expected, rtol=0.3)
        assert not NoiseLevels(made["levels"]).drift("gyro")
        if size == 777:
            in_pieces = made
    for name in ("allan", "spectra", "terms"):
        pd.testing.assert_frame_equal(made[name], in_pieces[name], rtol=1e-6)


def test_an_oscillation_is_marked_and_not_fitted():
    rng = np.random.default_rng(6)
    values = white(rng, 4 * STRETCH)
    time = np.arange(len(values)) / RATE
    values[:, 3] += 3 * WHITE["gyro"] * np.sqrt(RATE) * np.sin(2 * np.pi * 1.7 * time)
    made = noise_of(of_stretches(values))
    lines = made["spectra"].query("line")
    assert set(lines["channel"]) == {"gyro_x"} and (abs(lines["frequency"] - 1.7) < 0.1).all()
    found = made["terms"].set_index(["channel", "term"]).loc[("gyro_x", "white_noise")]
    assert abs(found["value"] - WHITE["gyro"]) < 3.5 * found["sigma"]


@pytest.mark.parametrize("samples", [0, 10, 40, 70, 150])
def test_what_is_too_short_has_no_terms_or_upper_limits(samples):
    values = white(np.random.default_rng(7), samples)
    values[:, 4] = np.nan  # a channel that is not recorded
    made = noise_of(of_stretches(values))
    assert "gyro_y" not in set(made["allan"]["channel"])
    assert not NoiseLevels(made["levels"]).drift("gyro")
    if samples < 64:
        assert made["terms"].empty and made["spectra"].empty


def test_a_rest_in_one_attitude_is_a_recording_of_its_noise_and_no_calibration():
    document = chain.demo(seed=7)
    rest = {"id": "still", "do": "rest", "up": "+z", "seconds": 1900, "log": "still.asc"}
    document["campaign"]["plan"] = [rest]
    document["receiver"]["rate_hz"] = 10
    recording = laboratory.perform(laboratory.specify(document))
    recording.campaign["plan"][0]["up"] = "unknown"
    recording.campaign["instrument"] = {**IMU, "rate_hz": 10}
    results = chain.in_memory(recording, "diagnosis")
    assert results["noise/terms"].query("term == 'white_noise'")["detected"].all()
    verdicts = results["diagnosis/verdict"]
    assert set(verdicts["verdict"]) == {"usable_within_limits"}
    assert verdicts["sentence"].str.contains("No calibration, noise only").all()
    result = results["diagnosis/result"].set_index("parameter")["value"]
    assert result.drop(["bias_x", "bias_y", "bias_z"]).isna().all()  # of gyros, ± earth's rate


@pytest.mark.parametrize(
    ("times", "told"), [(2.0, []), (6.0, ["noise/noise_above_data_sheet/gyro"])]
)
def test_noise_at_rest_that_is_far_above_the_data_sheet_is_told_with_its_ratio(times, told):
    document = chain.short(seed=8)
    stated = IMU["gyro"]["angle_random_walk_deg_sqrt_h"]
    document["noise"]["angle_random_walk_deg_sqrt_h"] = times * stated
    findings = chain.in_memory_of(document, "noise")["noise/findings"]
    assert findings["id"].tolist() == told
    assert findings["size"].tolist() == [pytest.approx(times, rel=0.2)] * len(told)
