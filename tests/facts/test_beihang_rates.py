"""S4: thirty mean rates, what its program made of them, and what they say (T17 to T20)."""

import numpy as np
import pytest
import s4
from scipy.stats import f as f_distribution

from inertial.estimation.consistency import largest_outlier, outliers
from inertial.estimation.gyroscope_observations import Earth, Position, SteadyRate
from inertial.estimation.rate_table import columns_of, nonlinearities, own_axis, rate_table

NO_EARTH = Earth(0.0, 0.0, 0.0)  # the program knows of none; 15 °/h are 0.004 °/s
DEGREE = np.radians(1)
OFF_DIAGONAL = ~np.eye(3, dtype=bool)


def run(gyro: int, number: int, sigma: float = 1.0) -> SteadyRate:
    """One of the thirty runs; only the gyro that turns was used."""
    up = np.eye(3)[gyro]
    rate = s4.RATES[number]
    mean = np.where(up > 0, s4.MEANS[gyro, number], np.nan) * DEGREE
    name = f"{'xyz'[gyro]}{rate:+.0f}"
    about = {"position": Position(name, up), "about": up, "rate": rate * DEGREE, "rate_sigma": 0.0}
    once = 360 / abs(rate) / 200
    time = {"seconds": np.full(200, once), "elapsed": once * (np.arange(200) + 0.5)}
    return SteadyRate(**about, **time, mean=mean, sigma=np.full(3, sigma * DEGREE))


RUNS = [run(gyro, number) for gyro in range(3) for number in range(10)]
NAMES = [run.position.name for run in RUNS]


def program(outputs: np.ndarray) -> np.ndarray:
    """[K | b] as the program of S4 has it: the inputs of the other axes are permuted."""
    W = np.vstack([s4.PERMUTED, np.ones(10)])
    return outputs @ W.T @ np.linalg.inv(W @ W.T)


def as_permuted(values: np.ndarray) -> np.ndarray:
    """Values of the runs, (3, 10), in the order in which the program has their rates."""
    order = [[list(s4.RATES).index(rate) for rate in row] for row in s4.PERMUTED]
    return np.take_along_axis(values, np.array(order), axis=1)


def test_t17_what_the_program_gives():
    found = program(as_permuted(s4.MEANS))
    printed = [
        [0.993327, 0.001268, -0.002003, 0.02012],
        [0.003274, 0.995009, -0.002617, -0.05367],
        [-0.001018, 0.002165, 0.991241, 0.08097],
    ]
    np.testing.assert_allclose(found[:, :3], np.array(printed)[:, :3], atol=6e-7)
    np.testing.assert_allclose(found[:, 3], np.array(printed)[:, 3], atol=6e-6)
    W = np.vstack([s4.PERMUTED, np.ones(10)])
    assert np.linalg.cond(W) == pytest.approx(80.19, abs=0.005)
    left = as_permuted(s4.MEANS) - found @ W
    rms = np.sqrt((left**2).sum(axis=1) / 6)
    np.testing.assert_allclose(rms, [0.1373, 0.3832, 0.1773], atol=5e-5)
    sigma = rms[:, None] * np.sqrt(np.diag(np.linalg.inv(W @ W.T)))
    t = (found / sigma)[:, :3][OFF_DIAGONAL]
    np.testing.assert_allclose(t, [0.70, -0.76, 0.62, -0.36, -0.42, 0.92], atol=0.006)


@pytest.fixture(scope="module")
def honest() -> list[tuple[float, float, float, float]]:
    """K, its sigma, b and the rms of each gyro, by our own rate table."""
    result = []
    for gyro in range(3):
        own = [run(gyro, number) for number in range(10)]
        rms = rate_table(own, NO_EARTH, 0.0).rms[gyro] / DEGREE
        table = rate_table([run(gyro, number, rms) for number in range(10)], NO_EARTH, 0.0)
        values, sigma = table.solution.values, table.solution.sigma
        result.append((values[4 * gyro], sigma[4 * gyro], values[9 + gyro] / DEGREE, rms))
    return result


def test_t17_the_straight_lines_of_each_gyro(honest):
    K, sigma, bias, rms = np.transpose(honest)
    np.testing.assert_allclose(K, [0.992491, 0.995121, 0.992232], atol=6e-7)
    np.testing.assert_allclose(sigma, [0.000804, 0.002205, 0.001079], atol=6e-7)
    np.testing.assert_allclose(bias, [0.02012, -0.05367, 0.08097], atol=6e-6)
    np.testing.assert_allclose(rms, [0.1250, 0.3430, 0.1678], atol=6e-5)
    # By the permuted inputs, with the same noise, the sigma of K is this many times larger:
    W = np.vstack([s4.PERMUTED, np.ones(10)])
    permuted = np.sqrt(np.diag(np.linalg.inv(W @ W.T))[:3])
    np.testing.assert_allclose(permuted * rms / sigma, [2.13, 2.07, 2.97], atol=0.006)


def test_t19_the_cross_terms_are_refused_with_the_rank():
    table = rate_table(RUNS, NO_EARTH, 0.0)
    np.testing.assert_array_equal(table.ranks, 2)
    refusals = table.refusals()
    assert sorted(refusals) == [
        "cross_xy",
        "cross_xz",
        "cross_yx",
        "cross_yz",
        "cross_zx",
        "cross_zy",
    ]
    assert refusals["cross_xy"] == (
        "the inputs of the x gyro have rank 2 of 4:"
        " record all three gyros while the table turns about y"
    )
    assert np.isnan(table.solution.values[[1, 2, 3, 5, 6, 7]]).all()
    assert np.isfinite(table.solution.sigma[[0, 4, 8, 9, 10, 11]]).all()
    # The program's own inputs without the permutation: the same rank.
    assert np.linalg.matrix_rank(np.vstack([s4.RATES] * 3 + [np.ones(10)])) == 2


def test_t18_the_scale_factors_fall_with_the_rate():
    data = own_axis(RUNS, NO_EARTH)
    found = nonlinearities(data)
    per_degree = DEGREE**2  # of a coefficient in s²/rad²: per (°/s)²
    cubic = found["cubic"]
    assert (cubic.columns, cubic.degrees) == (1, 23)
    assert cubic.statistic == pytest.approx(39.26, abs=0.005)
    assert cubic.p_value == pytest.approx(2.2e-6, rel=0.02)
    assert cubic.values[0] * per_degree == pytest.approx(-1.686e-6, abs=6e-10)
    assert cubic.sigma[0] * per_degree == pytest.approx(2.7e-7, abs=2e-9)
    bent = found["bent"]
    assert bent.statistic == pytest.approx(33.99, abs=0.005)
    assert bent.values[0] * DEGREE == pytest.approx(-1.88e-4, abs=2e-7)
    each, asymmetry, table = found["cubic of each"], found["asymmetry"], found["table"]
    assert (each.columns, each.degrees) == (3, 21)
    assert each.statistic == pytest.approx(20.75, abs=0.005)
    assert asymmetry.statistic == pytest.approx(1.37, abs=0.005)
    assert asymmetry.p_value == pytest.approx(0.25, abs=0.005)
    assert (table.columns, table.degrees) == (4, 20)
    assert table.statistic == pytest.approx(10.49, abs=0.005)
    assert table.p_value == pytest.approx(9.5e-5, rel=0.005)
    straight = f_distribution.isf(1e-3, 1, 23)
    assert asymmetry.statistic < straight < min(cubic.statistic, bent.statistic)


def test_t18_two_runs_of_y_do_not_belong_there():
    data = own_axis(RUNS, NO_EARTH)
    design = np.hstack([data.straight, columns_of(data)["cubic"]])
    found = outliers(design, data.mean, data.sigma, level=0.05)
    assert [NAMES[data.run[one.row]] for one in found] == ["y-40", "y-10"]
    np.testing.assert_allclose([one.in_sigmas for one in found], [-4.19, -4.12], atol=0.006)
    np.testing.assert_allclose([one.p_value for one in found], [0.0115, 0.0141], atol=6e-5)

    rows = [one.row for one in found]
    rest = data.less(rows)
    last = largest_outlier(np.delete(design, rows, axis=0), rest.mean, rest.sigma)
    assert NAMES[rest.run[last.row]] == "y+60" and last.p_value == pytest.approx(0.42, abs=0.005)

    after = nonlinearities(rest)
    cubic, table = after["cubic"], after["table"]
    assert (cubic.columns, cubic.degrees) == (1, 21)
    assert cubic.statistic == pytest.approx(71.3, abs=0.05)
    assert cubic.p_value == pytest.approx(3.4e-8, rel=0.02)
    assert cubic.values[0] * DEGREE**2 == pytest.approx(-1.375e-6, abs=6e-10)
    assert cubic.values[0] / cubic.sigma[0] == pytest.approx(-8.4, abs=0.05)
    assert cubic.scatter == pytest.approx(0.0836, abs=5e-5)  # °/s, for sigma is 1 °/s
    assert (table.columns, table.degrees) == (4, 18)
    assert table.statistic == pytest.approx(18.8, abs=0.05)
    # 0.88 % at 80 °/s, and at small rates within 0.15 % of 1.
    assert cubic.values[0] * (80 * DEGREE) ** 2 == pytest.approx(-0.0088, abs=5e-5)
    bent = rest.mean - columns_of(rest)["cubic"][:, 0] * cubic.values[0]
    small = np.linalg.lstsq(rest.straight, bent, rcond=None)[0][:3]
    np.testing.assert_allclose(small, [0.99893, 1.00044, 0.99867], atol=6e-6)


def test_t20_the_cross_terms_of_the_program_are_the_bend_of_the_rates():
    data = own_axis(RUNS, NO_EARTH)
    each = nonlinearities(data)["cubic of each"].values * DEGREE**2
    found = program(as_permuted(s4.MEANS))[:, :3][OFF_DIAGONAL]
    leaked = program(each[:, None] * s4.PERMUTED**3)[:, :3][OFF_DIAGONAL]
    np.testing.assert_allclose(
        leaked, [0.002714, -0.003061, 0.006226, -0.005675, 0.000162, 0.003689], atol=6e-7
    )
    assert np.corrcoef(leaked, found)[0, 1] == pytest.approx(0.9754, abs=5e-5)
    common = program(-1.33e-6 * s4.PERMUTED**3)[:, :3][OFF_DIAGONAL]
    np.testing.assert_allclose(
        common, [0.003613, -0.004075, 0.003076, -0.002804, 0.000157, 0.003589], atol=6e-7
    )
