"""The rate table closes: what was put in comes back within its sigma, what was not is refused."""

import numpy as np
import pytest

from inertial.estimation.gyroscope_observations import Earth, Position, SteadyRate
from inertial.estimation.rate_table import nonlinearities, own_axis, rate_table
from inertial.physics.motion import turned_all
from inertial.physics.site import earth_rate

UP, LEVEL = earth_rate(np.radians(39.98))
BEIJING = Earth(UP, 1e-9, LEVEL)
RATES = np.radians([10, 20, 40, 60, 80, -10, -20, -40, -60, -80])
NOISE, RATE_SIGMA, TILT = 1e-5, 1e-4, 1e-4  # rad/s; relative; rad
TABLE_RATE_SIGMA = 2e-4  # relative, of all rates alike


def runs(
    random: np.random.Generator,
    M: np.ndarray,
    bias: np.ndarray,
    axes: str = "xyz",
    turns: float = 1,
) -> list[SteadyRate]:
    """Runs about each axis at ten rates, with the errors of table, mounting and gyros."""
    result = []
    off = 1 + random.normal(0, TABLE_RATE_SIGMA)  # all rates of the table
    for gyro in ("xyz".index(axis) for axis in axes):
        up = np.eye(3)[gyro]
        lean = np.cross(random.normal(0, TILT, 3) * (1 - up), up)
        north = np.roll(up, 1)
        azimuth = random.uniform(0, 2 * np.pi)
        north = np.cos(azimuth) * north + np.sin(azimuth) * np.cross(up, north)
        for rate in RATES:
            seconds = np.full(100, turns * 2 * np.pi / abs(rate) / 100)
            elapsed = np.cumsum(seconds) - seconds / 2
            seen = turned_all(north, up, rate * elapsed).mean(axis=0)
            real = rate * off * (1 + random.normal(0, RATE_SIGMA))
            truth = real * (up + lean) + UP * up + LEVEL * seen
            mean = M @ truth + bias + random.normal(0, NOISE, 3)
            result.append(
                SteadyRate(
                    Position("xyz"[gyro], up),
                    up,
                    rate,
                    abs(rate) * RATE_SIGMA,
                    seconds=seconds,
                    elapsed=elapsed,
                    mean=mean,
                    sigma=np.full(3, NOISE),
                    table_rate_sigma=abs(rate) * TABLE_RATE_SIGMA,
                )
            )
    return result


def drawn(random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    return np.eye(3) + random.normal(0, 5e-3, (3, 3)), random.normal(0, 1e-3, 3)


@pytest.mark.parametrize("turns", [1.0, 2.3])
def test_what_was_put_in_comes_back_with_true_sigmas(turns):
    pulls = []
    for seed in range(30):
        random = np.random.default_rng(seed)
        M, bias = drawn(random)
        table = rate_table(runs(random, M, bias, turns=turns), BEIJING, TILT)
        assert table.solution.determined.all() and not table.refusals()
        error = table.solution.values - np.append(M, bias)
        pulls.append(error / table.solution.sigma)
    assert np.std(pulls) == pytest.approx(1, abs=0.14)
    assert np.abs(pulls).max() < 4.5
    together = np.array(pulls)[:, [0, 4, 8]].mean(axis=1)  # of the scale factors of a table
    assert np.std(together) == pytest.approx(1, abs=0.3)


def test_without_errors_it_is_exact():
    random = np.random.default_rng(1)
    M, bias = drawn(random)
    exact = runs(random, M, bias)
    exact = [
        SteadyRate(
            Position(r.position.name, r.about, north=np.roll(r.about, 1)),
            r.about,
            r.rate,
            0.0,
            r.seconds,
            r.elapsed,
            M @ (r.rate * r.about + UP * r.about) + bias,
            r.sigma,
        )
        for r in exact
    ]
    table = rate_table(exact, BEIJING, 0.0)
    np.testing.assert_allclose(table.solution.values, np.append(M, bias), atol=1e-12)
    np.testing.assert_array_equal(table.ranks, 4)
    np.testing.assert_allclose(table.residuals, 0, atol=1e-12)


def test_an_axis_that_nobody_turned_about_is_refused():
    random = np.random.default_rng(2)
    M, bias = drawn(random)
    table = rate_table(runs(random, M, bias, "xy"), BEIJING, TILT)
    np.testing.assert_array_equal(table.ranks, 3)
    assert set(table.refusals()) == {"cross_xz", "cross_yz", "scale_z"}
    there = table.solution.determined
    error = (table.solution.values - np.append(M, bias))[there] / table.solution.sigma[there]
    assert np.abs(error).max() < 4


def test_a_gyro_that_is_not_recorded_and_a_single_rate():
    random = np.random.default_rng(3)
    M, bias = drawn(random)
    all_runs = runs(random, M, bias)
    for one in all_runs:
        one.mean[2] = np.nan
    refusals = rate_table(all_runs, BEIJING, TILT).refusals()
    assert set(refusals) == {"cross_zx", "cross_zy", "scale_z", "bias_z"}
    assert "not recorded" in refusals["bias_z"]
    alone = rate_table(runs(random, M, bias, "x")[:1], BEIJING, TILT)
    np.testing.assert_array_equal(alone.ranks, 1)
    assert alone.refusals()["bias_x"].endswith("add a run of another rate")
    assert not alone.solution.determined.any()
    assert rate_table([], BEIJING, TILT) is None


def test_straight_gyros_are_not_called_bent():
    false = dict.fromkeys(("cubic", "cubic of each", "bent", "asymmetry", "table"), 0)
    for seed in range(60):
        random = np.random.default_rng(seed)
        found = nonlinearities(own_axis(runs(random, *drawn(random)), BEIJING))
        for name, test in found.items():
            false[name] += test.p_value < 0.05
    # 5 % of 60 are 3 ± 1.7.
    assert max(false.values()) <= 9 and sum(false.values()) >= 5, false


@pytest.mark.parametrize("hidden", ["cubic", "asymmetry", "table"])
def test_what_is_hidden_in_the_rates_comes_back(hidden):
    random = np.random.default_rng(4)
    M, bias = drawn(random)
    all_runs = runs(random, M, bias)
    size = {"cubic": -1e-3, "asymmetry": 1e-3, "table": 3e-3}[hidden]
    for one in all_runs:
        shape = {
            "cubic": one.rate**3,
            "asymmetry": abs(one.rate),
            "table": one.rate * (abs(one.rate) == RATES[2]),
        }[hidden]
        one.mean[np.argmax(one.about)] += size * shape
    found = nonlinearities(own_axis(all_runs, BEIJING))
    assert found[hidden].p_value < 1e-6
    if hidden != "table":
        assert abs(found[hidden].values[0] - size) < 4 * found[hidden].sigma[0]


def test_two_rates_show_no_nonlinearity():
    random = np.random.default_rng(5)
    few = [r for r in runs(random, *drawn(random)) if abs(r.rate) == RATES[0]]
    assert nonlinearities(own_axis(few, BEIJING)) == {}
    assert nonlinearities(own_axis([], BEIJING)) == {}
