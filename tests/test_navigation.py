"""Free inertial navigation: textbook solutions, closure with the laboratory, and its corridor."""

from dataclasses import replace

import chain
import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from inertial.campaign.masked_samples import Repairs
from inertial.campaign.measurement import measurements_of
from inertial.campaign.records import rows_of
from inertial.physics.forward import Site
from inertial.physics.strapdown import Growth, Start, aligned, navigated, of_alignment
from inertial.text.parameters import PARTS
from stages.navigation.corridor import uncertain
from stages.navigation.navigator import Navigator
from stages.navigation.stage import published_triads, why_not
from stages.navigation.windows import readings, windows

G = 9.80665
STILL = Start(np.eye(3), np.zeros(3))
EARTH = 7.292115e-5 * np.array([0.0, np.cos(0.5), np.sin(0.5)])
SCHULER = 2 * np.pi * np.sqrt(6371e3 / G)  # s, 84.4 min


def constant(vector, n):
    return np.tile(np.asarray(vector, float), (n, 1))


# ---- the mechanisation against textbook solutions


def test_a_level_accelerometer_error_oscillates_with_the_period_of_schuler():
    """Titterton & Weston 2004, 12.2: δv = b/ω_s sin ω_s t, δr = b/ω_s² (1 − cos ω_s t)."""
    error, n = 1e-3, round(SCHULER)
    after = np.arange(0, n + 1, n // 8)
    course = navigated(constant([0, 0, 0], n), constant([error, 0, G], n), 1.0, STILL, G, after)
    phase = 2 * np.pi * after / SCHULER
    speed = error * SCHULER / (2 * np.pi)
    np.testing.assert_allclose(course.velocity[:, 0], speed * np.sin(phase), atol=2e-3 * speed)
    distance = speed * SCHULER / (2 * np.pi)
    expected = distance * (1 - np.cos(phase))
    np.testing.assert_allclose(course.position[:, 0], expected, atol=2e-3 * distance)


def test_an_upright_error_grows_as_cosh():
    """Gravity falls by 2g/R per metre: δr = b/κ² (cosh κt − 1), κ = √(2g/R)."""
    course = navigated(
        constant([0, 0, 0], 6000), constant([0, 0, G + 1e-3], 6000), 0.1, STILL, G, np.array([6000])
    )
    kappa = np.sqrt(2 * G / 6371e3)
    assert course.position[0, 2] == pytest.approx(
        1e-3 / kappa**2 * (np.cosh(600 * kappa) - 1), rel=1e-4
    )


def test_a_gyro_bias_tilts_and_the_tilt_accelerates():
    """Over a short time ψ = ω t and δv = g ω t²/2: about north to the west."""
    course = navigated(
        constant([0, 1e-5, 0], 6000), constant([0, 0, G], 6000), 0.01, STILL, G, np.array([6000])
    )
    drift = Rotation.from_matrix(course.attitude[0]).as_rotvec()
    np.testing.assert_allclose(drift, [0, 6e-4, 0], atol=1e-9)
    assert course.velocity[0, 0] == pytest.approx(G * 1e-5 * 60**2 / 2, rel=1e-3)


def test_at_rest_on_the_turning_earth_nothing_moves():
    rotation = Rotation.from_rotvec([0.3, -0.8, 0.5]).as_matrix()
    force, rate = rotation.T @ [0, 0, G], rotation.T @ EARTH
    start = aligned(force, rate, Site(G, EARTH[2], EARTH[1]), None, compass=True)
    np.testing.assert_allclose(start.attitude, rotation, atol=1e-12)
    course = navigated(constant(rate, 6000), constant(force, 6000), 0.1, start, G, np.array([6000]))
    np.testing.assert_allclose(course.attitude[0], rotation, atol=1e-9)
    assert np.abs(course.position).max() < 1e-3


@pytest.mark.parametrize("axis", range(3))
def test_the_earth_turns_what_moves(axis):
    """Coriolis: under a constant acceleration a along e, δv = −ω × e a t² across it."""
    acceleration, seconds, n = 10.0, 10.0, 10_000
    along = np.eye(3)[axis]
    force = constant(acceleration * along + [0, 0, G], n)
    start, after = Start(np.eye(3), EARTH), np.array([n])
    course = navigated(constant(EARTH, n), force, seconds / n, start, G, after)
    deflected = -np.cross(EARTH, along) * acceleration * seconds**2
    across = np.arange(3) != axis
    np.testing.assert_allclose(course.velocity[0][across], deflected[across], rtol=2e-3, atol=1e-4)


def test_many_small_steps_are_as_exact_as_few_large_ones():
    """Five radians about an axis between all others, 5·10⁻⁵ rad or 0.5 rad at a time."""
    whole = 5.0 * np.array([2.0, -1.0, 2.0]) / 3
    for n in (100_000, 10):
        course = navigated(constant(whole, n), np.zeros((n, 3)), 1 / n, STILL, G, np.array([n]))
        exact = Rotation.from_rotvec(whole).as_matrix()
        np.testing.assert_allclose(course.attitude[0], exact, atol=1e-9)


def test_coning_is_integrated():
    """An axis that describes a cone of half angle θ at ω: ω_b = −ω(sinθ cosωt, sinθ sinωt, 1−cosθ).

    Its attitude is the rotation vector θ (−sin ωt, cos ωt, 0) (Savage, J. Guidance 21 (1998) 19):
    the mean of the rates alone would turn the case by 2π (1 − cos θ) in each round.
    """
    cone, turn, step, n = 0.05, 2 * np.pi, 1e-4, 50_000
    middle = (np.arange(n) + 0.5) * step
    first = Rotation.from_rotvec([0, cone, 0]).as_matrix()
    rate = turn * np.column_stack(
        [
            -np.sin(cone) * np.cos(turn * middle),
            -np.sin(cone) * np.sin(turn * middle),
            np.full(n, np.cos(cone) - 1),
        ]
    )
    still = replace(STILL, attitude=first)
    course = navigated(rate, np.zeros((n, 3)), step, still, G, np.array([n // 4, n // 2, n]))
    for attitude, time in zip(course.attitude, middle[[n // 4 - 1, n // 2 - 1, -1]], strict=True):
        at = turn * (time + step / 2)
        exact = Rotation.from_rotvec(cone * np.array([-np.sin(at), np.cos(at), 0])).as_matrix()
        np.testing.assert_allclose(attitude, exact, atol=1e-6)


# ---- the growth of errors against the mechanisation


def test_errors_grow_as_the_mechanisation_has_them():
    rotation = Rotation.from_rotvec([0.2, 0.4, -1.0]).as_matrix()
    site, n = Site(G, EARTH[2], EARTH[1]), 6000
    force, rate = rotation.T @ [0, 0, G], rotation.T @ EARTH
    after = np.array([n // 10, n])
    for axis in range(6):
        error = (1e-8 if axis < 3 else 1e-5) * np.eye(6)[axis]
        off = rate + error[:3], force + error[3:]
        start = aligned(off[1], off[0], site, None, compass=True)
        course = navigated(constant(off[0], n), constant(off[1], n), 0.1, start, G, after)
        turned = (rotation @ error.reshape(2, 3).T).T
        tilt = of_alignment(turned[1][:, None], turned[0][:, None], G, EARTH, compass=True)
        own = Rotation.from_matrix(start.attitude @ rotation.T).as_rotvec()
        np.testing.assert_allclose(tilt[:, 0], own, rtol=1e-3, atol=1e-12)
        initial = np.vstack([tilt, np.zeros((6, 1))])
        grown = Growth(G, EARTH, 60.0).of(turned.reshape(1, 6, 1), initial, [1, 10])[..., 0]
        for found, exact in ((grown[:, 3:6], course.velocity), (grown[:, 6:], course.position)):
            sizes = np.linalg.norm(exact, axis=1)
            assert (np.linalg.norm(found - exact, axis=1) < 3e-3 * sizes).all()


def test_noise_grows_as_the_mechanisation_has_it():
    """White noise and a random walk of the biases, drawn and navigated 400 times."""
    generator, n, draws = np.random.default_rng(5), 120, 400
    white = np.array([3e-6, 5e-6, 4e-6, 2e-3, 1e-3, 3e-3])
    walk = np.array([1e-7, 2e-7, 1e-7, 1e-4, 3e-4, 1e-4])
    ends = np.empty((draws, 9))
    for draw in range(draws):
        noise = white * generator.normal(size=(n, 6))
        noise += np.cumsum(walk * generator.normal(size=(n, 6)), axis=0)
        course = navigated(noise[:, :3], [0, 0, G] + noise[:, 3:], 1.0, STILL, G, np.array([n]))
        drift = Rotation.from_matrix(course.attitude[0]).as_rotvec()
        ends[draw] = np.concatenate([drift, course.velocity[0], course.position[0]])
    growth = Growth(G, np.zeros(3), 60.0)
    (covariance,) = growth.of_noise(np.eye(3)[None], np.diag(white**2), np.diag(walk**2), [2])
    ratio = ends.std(axis=0) / np.sqrt(np.diagonal(covariance))
    np.testing.assert_allclose(ratio, 1, atol=0.12)  # 3.4 sigma of √(1/800)


# ---- closure with the laboratory


def errors_of(made, quantity, motion="rest"):
    table = made["navigation_errors"]
    own = table[(table["quantity"] == quantity) & (table["motion"] == motion)]
    return own.set_index(["manoeuvre", "seconds"])


@pytest.fixture(scope="module")
def navigated_clean(clean):
    return chain.again(clean[0], "navigation")


def test_before_calibration_the_errors_are_those_that_were_hidden(navigated_clean):
    """Upright the velocity error at rest is 60 s × (|M g u + b| − g); about a turn's axis the
    attitude is off by 2π (|M e| − 1) + b t."""
    truth, gravity = chain.demo()["truth"], 9.7936174
    matrix, bias = (np.array(truth["accelerometer"][key]) for key in ("matrix", "bias_m_s2"))
    table = errors_of(navigated_clean, "velocity")
    for axis, name in enumerate("xyz"):
        for sign, way in ((1, "up"), (-1, "down")):
            reading = matrix[:, axis] * gravity * sign + bias
            upright = abs(np.linalg.norm(reading) - gravity) * 60
            level = gravity * np.linalg.norm(truth["gyro"]["bias_rad_s"]) * 60**2 / 2
            found = table.loc[(f"{name}-{way}", 60.0), "nominal"]
            assert 0.95 * upright - 0.02 < found < np.hypot(upright, level) + 0.02
    gyro, drift = (np.array(truth["gyro"][key]) for key in ("matrix", "bias_rad_s"))
    turns = errors_of(navigated_clean, "attitude", "turn")
    for name, sign in (("x-forward", 1), ("x-backward", -1)):
        row = turns.loc[name].iloc[0]
        excess = 2 * np.pi * (np.linalg.norm(gyro[:, 0]) - 1)
        expected = excess + sign * drift[0] * turns.loc[name].index[0]
        assert row["nominal"] == pytest.approx(expected, rel=0.04)


@pytest.mark.slow
def test_calibration_is_worth_it_and_the_error_stays_in_its_corridor(clean, navigated_clean):
    """The result of one recording corrects another one of the same IMU: noise of its own."""
    made = [navigated_clean]
    for own, other in ((0, 1), (1, 2)):
        result = clean[own]["diagnosis/result"]
        folder = clean[other]
        corrected = chain.again(folder, "compensation", result=result)["compensated"]
        made.append(
            chain.again(
                folder,
                "navigation",
                result=result,
                covariance=clean[own]["diagnosis/covariance"],
                compensated=chain.MemoryStream(chain.pa.Table.from_pandas(corrected)),
            )
        )
    for each in made:
        for quantity in ("attitude", "velocity", "position"):
            table = errors_of(each, quantity).query("calibrated.notna()")
            rms = np.sqrt((table[["nominal", "calibrated"]] ** 2).mean())
            assert rms["calibrated"] < 0.4 * rms["nominal"]
            long = errors_of(each, quantity).xs(600.0, level="seconds")
            assert long["calibrated"].isna().all() and long["predicted"].gt(0).all()
            assert set(long["reason"]) == {
                "it is not recorded for so long",
                "it is recorded for less than 70 s",  # beside turns
            }
    squares = pd.concat([each["navigation_errors"] for each in made[1:]]).dropna(
        subset="normalised"
    )
    for _quantity, own in squares.groupby("quantity"):
        # χ² of 3 axes of 12 rests and about 11 turns: 66 degrees, 0.17 sigma of its mean.
        assert len(own) >= 22
        assert 0.55 < own["normalised"].mean() < 1.6


def test_shares_add_up_and_name_what_limits(clean, navigated_clean):
    shares = navigated_clean["navigation_shares"]
    sums = shares.groupby(["motion", "seconds", "quantity"], dropna=False)["share"].sum()
    np.testing.assert_allclose(sums, 1)
    # They are of the manoeuvres that were navigated, whose predictions stand beside the errors.
    errors = navigated_clean["navigation_errors"].query("calibrated.notna() and seconds == 60")
    for quantity, own in errors.groupby("quantity"):
        of_parameters = (own["by_parameters"] ** 2).sum() / (own["predicted"] ** 2).sum()
        by = shares[(shares["quantity"] == quantity) & (shares["seconds"] == 60)]
        known = by["family"].str.startswith(("gyro ", "accelerometer ", "accel "))
        assert by.loc[known, "share"].sum() == pytest.approx(of_parameters, rel=1e-6)
    # A z accelerometer that is known to 1 mm/s² only moves z up by 60 mm/s, and so z down.
    covariance = clean[0]["diagnosis/covariance"]
    name = next(i for i in covariance["first"] if "accel" in i and i.endswith("bias_z"))
    own = (covariance["first"] == name) & (covariance["second"] == name)
    covariance.loc[own, "covariance"] = 1e-6
    made = chain.again(clean[0], "navigation", covariance=covariance)
    table = errors_of(made, "velocity")
    assert table.loc[("z-up", 60.0), "by_parameters"] == pytest.approx(0.06, rel=0.02)
    level = table.loc[("x-up", 60.0), "by_parameters"]
    assert level < 0.01  # what is level the alignment absorbs
    of_velocity = made["navigation_shares"].query("quantity == 'velocity' and seconds == 60")
    assert of_velocity.loc[of_velocity["share"].idxmax(), "source"] == "bias_z"


def test_parameters_drawn_from_their_covariance_fill_the_corridor(clean):
    """In every window another calibration, off from the truth by a draw of its covariance, made a
    hundred times as large: noise is small beside it, but where the alignment absorbs the draw."""
    truth, generator = chain.demo()["truth"], np.random.default_rng(3)
    tables = []
    for results in clean:
        (data,) = chain.mounts(results)
        result, covariance = results["diagnosis/result"], results["diagnosis/covariance"]
        covariance["covariance"] *= 1e4
        result["sigma"] *= 100
        for sensor, name in (("accel", "accelerometer"), ("gyro", "gyro")):
            own = result["sensor"] == sensor
            result.loc[own, "value"] = result.loc[own, "parameter"].map(true_values(truth[name]))
        rows = [row for row in rows_of(result) if row["effect"] is None]
        known = uncertain(rows, covariance, lambda measurement: measurement, {})
        navigator = Navigator(data, known, {})
        wanted, _ = windows(data, results["segment/segments"])
        for one in readings(*streams(results), wanted, Repairs(results["segment/channel_repairs"])):
            offset = generator.multivariate_normal(
                np.zeros(len(rows)), known.covariance, method="svd"
            )
            drawn = pd.DataFrame(rows).assign(value=[row["value"] for row in rows] + offset)
            measurement = measurements_of(drawn)[""]
            corrected = np.hstack(
                [
                    (values - triad.bias) @ np.linalg.inv(triad.matrix).T
                    for values, triad in (
                        (one.recorded[:, :3], measurement.accelerometer.triad),
                        (one.recorded[:, 3:], measurement.gyro.triad),
                    )
                ]
            )
            navigator.add(replace(one, corrected=corrected))
        tables += navigator.error_rows
    squares = pd.DataFrame(tables).groupby(["motion", "quantity"])["normalised"]
    # Three degrees each of 18 rests and 17 turns: 0.2 sigma.
    assert (squares.count() >= 15).all()
    assert squares.mean().between(0.5, 1.6).all(), squares.mean()


def test_a_rest_that_is_predicted_does_not_reach_back_before_the_switch_on(clean):
    """Of a warm-up known to b, 600 s of turning bring b τ at the most, ∫ b exp(−t/τ) dt."""
    result, size, tau = clean[0]["diagnosis/result"], 1e-4, 40.0
    one = result[result["sensor"] == "gyro"].iloc[[0]].assign(effect="gyro_warm_up")

    def row(name, value, sigma, unit):
        name = f"gyro_warm_up.{name}"
        own = {"id": f"diagnosis/gyroscope/{name}", "parameter": name, "unit": unit}
        return one.assign(**own, value=value, sigma=sigma)

    rows = [row(f"b_{axis}", 1e-3, size, "rad/s") for axis in "xyz"]
    rows.append(row("tau", tau, np.nan, "s"))
    made = chain.again(clean[0], "navigation", result=pd.concat([result, *rows]))
    own = errors_of(made, "attitude").xs(600.0, level="seconds")["by_parameters"]
    without = errors_of(chain.again(clean[0], "navigation"), "attitude")
    before = without.xs(600.0, level="seconds")["by_parameters"]
    added = np.sqrt(np.fmax(own**2 - before**2, 0.0))
    assert (added < np.sqrt(3) * size * tau).all()
    assert added.max() > 0.3 * size * tau  # of the rest that begins the recording
    first = errors_of(made, "attitude").xs(60.0, level="seconds")["by_parameters"]
    assert (first < np.hypot(before.max(), np.sqrt(3) * size * tau)).all()


def true_values(known):
    """The twelve parameters of the laboratory's truth, by name."""
    bias = known.get("bias_m_s2", known.get("bias_rad_s"))
    values = {f"bias_{axis}": bias[i] for i, axis in enumerate("xyz")}
    for i, first in enumerate("xyz"):
        for j, second in enumerate("xyz"):
            name = f"scale_{first}" if i == j else f"cross_{first}{second}"
            values[name] = known["matrix"][i][j] - (i == j)
    return values


def streams(results):
    """Samples as recorded and as compensated."""
    stage = chain.stage_of("navigation")
    paths = stage.paths(results.folder)
    return [stage.reads[name].stream(paths[name]) for name in ("samples", "compensated")]


# ---- what cannot be navigated


def test_published_values_are_a_calibration_of_their_own(clean):
    rows = [
        {"sensor": "accel", "quantity": f"bias_{axis}", "value": value, "sigma": np.nan}
        | {"unit": "m/s²", "source": "a report", "window": np.nan, "samples": np.nan}
        for axis, value in zip("xyz", (-0.0052949, 0.0050641, -0.0018790), strict=True)
    ]
    triads = published_triads(rows)
    np.testing.assert_array_equal(triads["gyro"].matrix, np.eye(3))
    made = chain.again(clean[0], "navigation", published=pd.DataFrame(rows))
    table = errors_of(made, "velocity").query("calibrated.notna()")
    # Of x down the biases are most of the error, and the scale factor the rest.
    down = table.loc[("x-down", 60.0)]
    assert down["calibrated"] < down["published"] < 0.6 * down["nominal"]


def test_without_a_result_it_says_so(clean):
    result = clean[0]["diagnosis/result"]
    lost = (result["sensor"] == "gyro") & (result["parameter"] == "scale_y")
    result.loc[lost, ["value", "sigma"]] = np.nan
    made = chain.again(clean[0], "navigation", result=result)
    (row,) = rows_of(made["navigation_errors"])
    assert row["predicted"] is None and "not determined" in row["reason"]
    assert made["navigation_shares"].empty


def test_what_is_not_determined_is_named_and_the_biases_bound_what_they_can():
    """b t = 1e-6 · 60 rad = 12.4″, g b t³/6 = 0.353 m, b t²/2 = 0.18 m."""

    def row(sensor, name, value, sigma, reason=""):
        own = {"sensor": sensor, "parameter": name, "value": value, "sigma": sigma}
        return own | {"reason": reason}

    names = [name for name in PARTS if PARTS[name].kind in ("bias", "scale", "cross")]
    rows = [row("accel", name, 0.0, 1e-4) for name in names]
    open_ = "no whole turn about x"
    rows += [
        row("gyro", name, *((None, None, open_) if name == "scale_x" else (0.0, 1e-6)))
        for name in names
    ]
    sentence = why_not(rows, G)
    assert "of the gyros s_x are not determined (no whole turn about x)" in sentence
    assert "12″" in sentence and "0.35 m" in sentence and "0.18 m" in sentence
    assert "accelerometers" not in sentence
