"""Alignment and rotation modulation, on S4's two manoeuvres in the simulated laboratory."""

from copy import deepcopy

import chain
import numpy as np
import pyarrow as pa
import pytest

import laboratory
from inertial.campaign.records import Manoeuvre, Performed
from inertial.estimation.alignment import at_rest, integrated, separated
from inertial.tables.errors import Refusal
from stages.alignment.stage import groups

SOURCE = chain.ROOT / "data/simulated/modulation.yaml"
# As the description of the campaign has it, by the laws of motion in the level frame.
LATITUDE, HEADING, RATE = np.radians(39.98), np.radians(25), np.radians(6)
EARTH = 7.292115e-5
BIAS = np.array([1.0e-4, -1.5e-4, 5.0e-5])
CROSS, SCALE = np.array([0.0005, -0.0003]), 0.0004  # of x and y against z, of z
WALK = np.radians(0.05) / 60  # rad/√s
BESIDE = ("studies", "comparison", "compensation", "navigation")


@pytest.fixture(scope="module")
def made():
    document = laboratory.read(SOURCE).document
    return chain.in_memory_of(document, "alignment", BESIDE)


def of(made, method, quantity, readings="recorded"):
    table = made["alignment/alignments"].set_index(["readings", "method", "quantity"])
    return table.loc[readings, method, quantity]


def test_at_rest_a_bias_turns_the_azimuth_as_it_must(made):
    """North is where the level rate points, the earth's and the bias together."""
    mark = EARTH * np.cos(LATITUDE) * np.array([np.cos(HEADING), np.sin(HEADING)])  # along x, y
    read = mark + BIAS[:2]
    expected = np.arctan2(read[1], read[0])
    row = of(made, "static", "azimuth")
    assert row.value == pytest.approx(expected, abs=3 * row.sigma + 0.002)
    seconds = 13.5
    assert row.sigma == pytest.approx(WALK / np.sqrt(seconds) / np.linalg.norm(read), rel=0.1)
    assert row.known == pytest.approx(HEADING)
    assert abs(row.value - row.known) > 20 * row.sigma
    assert row.per_bias == pytest.approx(1 / np.linalg.norm(read), rel=0.1)


def test_a_turn_tells_the_azimuth_apart_from_the_bias(made):
    row = of(made, "rotation", "azimuth")
    level = EARTH * np.cos(LATITUDE)
    # Two level gyros over 128 s, one direction: squared sines and cosines add up to 1.
    assert row.sigma == pytest.approx(WALK / np.sqrt(128) / level, rel=0.1)
    assert row.value == pytest.approx(HEADING, abs=3.5 * row.sigma)
    rate = of(made, "rotation", "level_rate")
    assert rate.value == pytest.approx(level, abs=3.5 * rate.sigma)
    assert rate.known == pytest.approx(level, rel=1e-6)


def test_tilts_at_rest_hold_the_biases_of_the_accelerometers(made):
    """0.004 and −0.006 m/s² over 9.80 m/s², and 30 arcsec of the position."""
    for axis, bias in (("tilt_x", 0.006 / 9.80), ("tilt_y", 0.004 / 9.80)):
        row = of(made, "static", axis)
        assert row.value == pytest.approx(bias, abs=4 * np.radians(30 / 3600))
        turning = of(made, "rotation", axis)  # the axis of the turn is upright
        assert abs(turning.value) < 4 * turning.sigma


def test_with_rotation_the_levels_stay_bounded_and_without_they_diverge(made):
    table = made["alignment/attitude_errors"]
    still, turning = (table[table["manoeuvre"] == name] for name in ("still", "turning"))
    level = np.hypot(still["east"], still["north"]).to_numpy()
    drift = np.linalg.norm(BIAS[:2]) * still["seconds"].to_numpy()
    assert (np.abs(level - drift) < 4.5 * still["sigma"].to_numpy()).all()
    fixed = np.linalg.norm(BIAS[:2] + CROSS * RATE)
    circle = np.hypot(turning["east"], turning["north"]).to_numpy()
    ahead = turning["seconds"].to_numpy() - 3.5 - 0.5  # after the rest, and half a ramp of 1 s
    steady = (ahead > 1) & (ahead < 119)
    expected = 2 * fixed / RATE * np.abs(np.sin(RATE * ahead / 2))
    # What the rests and ramps before add is less than their bias times 4 s.
    sigma = turning["sigma"].to_numpy()
    assert (np.abs(circle - expected)[steady] < (4.5 * sigma + 4.5 * 1.8e-4)[steady]).all()
    predicted = np.hypot(turning["predicted_east"], turning["predicted_north"]).to_numpy()
    assert (np.abs(circle - predicted) < 5 * np.hypot(sigma, turning["predicted_sigma"])).all()
    up = turning["up"].to_numpy()[-1]
    assert up == pytest.approx(SCALE * 4 * np.pi + BIAS[2] * 128, abs=4 * sigma[-1])


def test_the_factor_gained_is_that_of_the_noiseless_motion(made):
    [row] = made["alignment/modulation_gains"].to_dict("records")
    fixed = np.linalg.norm(BIAS[:2] + CROSS * RATE)
    expected = np.linalg.norm(BIAS[:2]) * row["seconds"] / (2 * fixed / RATE)
    assert row["seconds"] == pytest.approx(68.5, abs=0.6)
    assert row["factor"] == pytest.approx(expected, abs=3 * row["factor_sigma"] + 0.05 * expected)
    assert 0.01 < row["factor_sigma"] / row["factor"] < 0.04
    assert row["predicted_factor"] == pytest.approx(row["factor"], abs=3 * row["factor_sigma"])


def test_compensated_readings_drift_by_what_the_calibration_left(made):
    """With the true parameters as the result only noise remains, and the azimuth is right."""
    result = made["diagnosis/result"].copy()
    true = {f"bias_{axis}": value for axis, value in zip("xyz", BIAS, strict=True)}
    truth = laboratory.read(SOURCE).document["truth"]
    for sensor, bias in (("accelerometer", "bias_m_s2"), ("gyro", "bias_rad_s")):
        matrix = np.array(truth[sensor]["matrix"]) - np.eye(3)
        own = {f"bias_{a}": truth[sensor][bias][i] for i, a in enumerate("xyz")}
        for i, row in enumerate("xyz"):
            for j, column in enumerate("xyz"):
                name = f"scale_{row}" if i == j else f"cross_{row}{column}"
                own[name] = matrix[i, j]
        chosen = result["sensor"] == {"accelerometer": "accel"}.get(sensor, sensor)
        result.loc[chosen, "value"] = result.loc[chosen, "parameter"].map(own)
    assert set(true) <= set(result["parameter"])
    result["sigma"] = 1e-7
    tables = made.copy()
    stage = chain.stage_of("alignment")
    inputs = {**chain._inputs(stage, tables, "alignment"), "result": result}
    again = stage.result(inputs)
    azimuth = again["alignments"].query("readings == 'compensated' and quantity == 'azimuth'")
    static = azimuth[azimuth["method"] == "static"].iloc[0]
    assert static["value"] == pytest.approx(HEADING, abs=3.5 * static["sigma"])
    assert static["sigma"] == pytest.approx(
        np.hypot(WALK / np.sqrt(13.5), 1e-7) / (EARTH * np.cos(LATITUDE)), rel=0.15
    )
    errors = again["attitude_errors"].query("readings == 'compensated'")
    # The stated azimuth stands for north; the mark is where it says, but for the position.
    for _, own in errors.groupby("manoeuvre"):
        assert (np.hypot(own["east"], own["north"]) < 5 * own["sigma"] + 3e-6).all()


def test_without_an_encoder_the_gyro_tells_the_course_of_the_table(made):
    samples = made.arrow["decode/samples"]
    place = samples.column_names.index("table_angle")
    none = pa.nulls(len(samples), pa.float64())
    tables = made.copy()
    tables.arrow["decode/samples"] = samples.set_column(place, "table_angle", none)
    stage = chain.stage_of("alignment")
    again = stage.result(chain._inputs(stage, tables, "alignment"))
    [row], [known] = (
        each.to_dict("records")
        for each in (again["modulation_gains"], made["alignment/modulation_gains"])
    )
    assert row["factor"] == pytest.approx(known["factor"], rel=0.01)
    turning = again["attitude_errors"].query("manoeuvre == 'turning'")
    # The whole angle is the one that is set, 720°.
    last = turning.iloc[-1]
    assert last["up"] == pytest.approx(SCALE * 4 * np.pi + BIAS[2] * 128, abs=4 * last["sigma"])


def test_an_alignment_needs_a_known_up():
    document = deepcopy(laboratory.read(SOURCE).document)
    recording = laboratory.perform(laboratory.specify(document))
    with pytest.raises(Refusal, match="add up"):
        chain.in_memory(
            recording,
            "plan",
            edit=lambda text: text.replace(
                "up: +z, mark: +x, position: level, seconds: 10", "position: level, seconds: 10"
            ),
        )


def test_a_plan_without_an_alignment_has_none():
    rest = Manoeuvre("up", "rest", "one.csv", "up", "as mounted", *[None] * 8, "whole", *[None] * 5)
    assert not list(groups([rest], {"up": Performed("up", "at rest")}, {}))
    [group] = groups([rest], {"up": Performed("up", "at rest")}, {"up": "alignment"})
    assert (group.alignment, list(group.followed)) == (rest, [])


def test_coarse_alignment_by_hand():
    """Body x to the south, y to the east, z up, at 30°: the azimuth of x is 180°."""
    found = at_rest(
        np.array([0, 0, 9.8]), EARTH * np.array([-np.cos(0.5), 0, np.sin(0.5)]), 1e-4, 1e-8, 0.0
    )
    assert abs(found.azimuth(np.array([1.0, 0, 0]))) == pytest.approx(np.pi)
    assert found.azimuth(np.array([0, 1.0, 0])) == pytest.approx(np.pi / 2)
    np.testing.assert_allclose(found.axes, [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-12)
    known = found.with_azimuth(np.array([0, 1.0, 0]), np.pi / 2, 1e-5)
    np.testing.assert_allclose(known.axes, found.axes, atol=1e-12)


def test_a_bias_goes_round_a_circle_of_twice_its_size_over_the_rate():
    seconds = np.full(6000, 0.01)
    angle = RATE * (np.cumsum(seconds) - 0.005)
    up = np.array([0, 0, 1.0])
    error = integrated(np.tile([2e-4, 0, 0], (6000, 1)), angle, seconds, up, np.eye(3), 0.0)
    assert error.level().max() == pytest.approx(2 * 2e-4 / RATE, rel=1e-5)
    assert error.level()[-1] == pytest.approx(0, abs=1e-9)
    turned = np.stack([np.cos(angle), -np.sin(angle), 0 * angle], axis=1)  # the laboratory's x
    both = separated(3e-5 * turned + [1e-4, 2e-4, 0.1], angle, 0 * angle + RATE, up, 0 * angle + 1)
    np.testing.assert_allclose(both.turning, [3e-5, 0, 0], atol=1e-12)
    np.testing.assert_allclose(both.fixed + RATE * both.growing, [1e-4, 2e-4, 0], atol=1e-12)
