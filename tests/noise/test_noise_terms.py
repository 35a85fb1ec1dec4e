"""The terms of simulated noise: found with sigma, limited where absent, told apart if possible."""

from types import SimpleNamespace

import numpy as np
import pytest
from noise_draws import INTERVAL, outcome
from noise_simulation import Array, noise
from scipy.fft import dct
from scipy.linalg import toeplitz
from scipy.signal import butter, lfilter
from scipy.stats import binom

from inertial.campaign.noise_levels import drift_of
from inertial.estimation.multiresolution import Powers, coefficient_variances, lowest_shapes
from inertial.estimation.noise_model import TERMS, rate_autocovariance
from inertial.estimation.noise_terms import NoiseTerms, noise_terms

SAMPLES = 1 << 16
COVERAGE = (0.93, 0.97)
DRAWS = range(5000, 5012)  # none that the page is made of


def found(*stretches: Array, interval: float = INTERVAL) -> NoiseTerms:
    powers = Powers(1, interval)
    for stretch in stretches:
        powers.add(stretch[:, None])
        powers.end()
    (terms,) = noise_terms(powers)
    assert terms is not None
    return terms


@pytest.fixture(scope="module")
def draws():
    return [outcome("all", number) for number in DRAWS]


@pytest.mark.parametrize("name", TERMS)
def test_intervals_cover_the_truth_in_their_share(draws, name):
    """With five terms; a share in the bar would fall below this bound once in 10⁴ runs."""
    terms = [draw["terms"][name] for draw in draws]
    assert all(term["detected"] for term in terms)
    covered = sum(term["low"] <= term["true"] <= term["high"] for term in terms)
    assert covered >= binom.ppf(1e-4, len(terms), COVERAGE[0])
    pulls = np.array([(term["value"] - term["true"]) / term["sigma"] for term in terms])
    # Neither biased nor over-confident nor too cautious: mean and variance at 4 sigma.
    assert abs(pulls.mean()) < 4 / np.sqrt(len(pulls))
    assert abs(pulls.var() - 1) < 4 * np.sqrt(2 / len(pulls))


@pytest.mark.parametrize("interval", [1.0, 0.005])
def test_published_units_at_any_interval(interval):
    """White noise alone: N is the sigma of a sample times √Δ, and Q, B, K, R have limits."""
    sigma = 0.02
    rates = sigma * np.random.default_rng(1).standard_normal(SAMPLES)
    terms = found(rates, interval=interval).terms
    expected = rates.std() * np.sqrt(interval)
    assert terms["white_noise"].value == pytest.approx(expected, rel=0.004)
    assert terms["white_noise"].sigma == pytest.approx(
        sigma * np.sqrt(interval / 2 / SAMPLES), rel=0.35
    )
    for name in TERMS:
        if name != "white_noise":
            assert not terms[name].detected
            assert np.isnan(terms[name].value) and terms[name].upper > 0
            assert terms[name].p_value > 0.01


@pytest.mark.parametrize(
    ("name", "size"),
    [
        ("quantisation", 0.004),
        ("bias_instability", 1.0),
        ("random_walk", 0.5),
        ("ramp", 0.01),
    ],
)
def test_one_term_beside_white_noise(name, size):
    rates = noise(
        SAMPLES,
        INTERVAL,
        np.random.default_rng(2),
        white_noise=0.1,
        **{name: size},
    )
    terms = found(rates).terms
    assert [one for one in TERMS if terms[one].detected] == sorted(
        ["white_noise", name], key=TERMS.index
    )
    assert abs(terms[name].value - size) < 4 * terms[name].sigma < 0.5 * size
    assert terms[name].interval[0] < terms[name].value < terms[name].interval[1]


def test_several_stretches_tell_as_much_as_one():
    """Sigma of white noise goes with the root of the samples, wherever they are."""
    rates = noise(SAMPLES, INTERVAL, np.random.default_rng(3), white_noise=1.0)
    whole, parts = found(rates), found(*np.array_split(rates + 1.0, 11))
    ratio = parts.terms["white_noise"].sigma / whole.terms["white_noise"].sigma
    assert ratio == pytest.approx(1.0, abs=0.25)
    assert parts.terms["white_noise"].value == pytest.approx(
        whole.terms["white_noise"].value, abs=2 * whole.terms["white_noise"].sigma
    )
    # A drift that lasts longer than a stretch is known worse.
    assert parts.terms["random_walk"].upper > 2 * whole.terms["random_walk"].upper


def test_pieces_of_a_stretch_give_the_same():
    rates = noise(20_000, INTERVAL, np.random.default_rng(4), white_noise=1.0)[:, None]
    one, many = Powers(1, INTERVAL), Powers(1, INTERVAL)
    one.add(rates)
    for piece in np.split(rates, [1, 17, 9000, 9001]):
        many.add(piece)
    one.end()
    many.end()
    first, second = one.bins(), many.bins()
    np.testing.assert_allclose(first.density, second.density, rtol=1e-9)
    np.testing.assert_array_equal(first.degrees, second.degrees)


def test_a_class_where_the_data_cannot_tell():
    """A weak random walk over five minutes may be a ramp or flicker: then none is a number."""
    classes, below = 0, 0
    for seed in range(6):
        chance = np.random.default_rng(seed)
        result = found(noise(30_000, INTERVAL, chance, white_noise=1.0, random_walk=0.08))
        drifts = [result.terms[name] for name in ("bias_instability", "random_walk", "ramp")]
        alike = [term for term in drifts if term.alternatives]
        classes += bool(alike)
        assert len(alike) != 1 and not any(term.detected for term in alike)
        assert all(np.isnan(term.value) and term.upper > 0 for term in alike)
        if alike:
            assert min(term.p_value for term in alike) < 0.01
            # The model for a filter has the likeliest of them.
            assert any(getattr(result.model, term.name) for term in alike)
        below += drifts[1].upper < 0.08
    assert classes >= 1
    # Limits hold in 95 %: more than 2 of 6 are below the truth once in 450 such tests.
    assert below <= 2


@pytest.mark.parametrize(("amplitude", "frequency"), [(1.0, 7.77), (50.0, 20.3)])
def test_an_oscillation_is_marked_and_changes_no_term(amplitude, frequency):
    """Of a tenth of the noise of a sample, and of five times that."""
    chance = np.random.default_rng(6)
    quiet = noise(SAMPLES, INTERVAL, chance, white_noise=1.0, bias_instability=1.0)
    time = np.arange(SAMPLES) * INTERVAL
    alone = found(quiet)
    result = found(quiet + amplitude * np.sin(2 * np.pi * frequency * time))
    assert not len(alone.lines)
    inside = (result.lines[:, 0] * 0.97 < frequency) & (frequency < result.lines[:, 1] * 1.03)
    assert inside.any()
    for name in ("white_noise", "bias_instability"):
        change = result.terms[name].value - alone.terms[name].value
        assert abs(change) < 2 * result.terms[name].sigma
    assert not result.terms["quantisation"].detected


def test_a_line_that_leaks_into_every_bin_leaves_a_fit():
    """A hum of 1,000 times the noise of a sample: what it leaks exceeds the noise everywhere."""
    chance = np.random.default_rng(6)
    quiet = noise(SAMPLES, INTERVAL, chance, white_noise=1.0)
    time = np.arange(SAMPLES) * INTERVAL
    hum = 1e3 / np.sqrt(INTERVAL) * np.sin(2 * np.pi * 0.3 * time)
    result = found(quiet + hum)
    assert (result.lines[:, 0] < 0.3).any() and (result.lines[:, 1] > 0.3).any()
    white = result.terms["white_noise"]
    assert np.isfinite(white.value if white.detected else white.upper)


def test_what_a_low_pass_filter_takes_is_not_fitted():
    chance = np.random.default_rng(7)
    rates = noise(2 * SAMPLES, INTERVAL, chance, white_noise=1.0, bias_instability=1.0)
    result = found(lfilter(*butter(2, 10.0, fs=1 / INTERVAL), rates))
    assert result.highest < 10.0
    for name, true in (("white_noise", 1.0), ("bias_instability", 1.0)):
        assert abs(result.terms[name].value - true) < 3.5 * result.terms[name].sigma
    assert not result.terms["quantisation"].detected


def test_nothing_of_nothing():
    powers = Powers(2, INTERVAL)
    assert noise_terms(powers) == [None, None]
    powers.add(np.full((1000, 2), 9.8))
    powers.end()
    assert noise_terms(powers) == [None, None]


@pytest.mark.parametrize("still", [(5000,), (700, 3000, 900)])
def test_a_channel_that_stood_still_in_the_longest_stretches_has_no_terms(still):
    """Of the other, noisy in all of them, they are what they are."""
    random, powers = np.random.default_rng(4), Powers(2, 0.02)
    for count, dead in [*((n, False) for n in (560, 340, 120)), *((n, True) for n in still)]:
        readings = np.rint(4 * random.standard_normal((count, 2))) * 1e-3
        readings[:, 1] = 0.0224 if dead else readings[:, 1]
        powers.add(readings)
        powers.end()
    noisy, dead = noise_terms(powers)
    assert dead is None and noisy is not None
    white = noisy.terms["white_noise"]
    assert abs(white.value - 4e-3 * np.sqrt(1 + 1 / 12 / 16) * np.sqrt(0.02)) < 4 * white.sigma


@pytest.mark.parametrize("count", [64, 301])
def test_the_covariance_of_cosine_coefficients(count):
    """By its definition, transforming the covariance of the samples, term by term."""
    gammas = rate_autocovariance(count, 0.1)
    shapes, ramp = lowest_shapes(count, 0.1, 24)
    for gamma, shape, variance in zip(
        gammas, shapes, coefficient_variances(count, 0.1), strict=True
    ):
        full = dct(dct(toeplitz(gamma), axis=0, norm="ortho"), axis=1, norm="ortho")
        np.testing.assert_allclose(variance[1:], np.diag(full)[1:], rtol=1e-7)
        np.testing.assert_allclose(shape, full[1:25, 1:25], atol=1e-7 * np.abs(shape).max())
    np.testing.assert_allclose(ramp, dct(0.1 * np.arange(count), norm="ortho")[1:25], atol=1e-9)


def test_the_covariance_of_a_random_walk_of_the_rate():
    """Means of Brownian motion over neighbouring intervals: K²Δ (|h| − …), IEEE 952 annex C.

    E[(ȳ₁ − ȳ₀)²] = 2/3 K²Δ, and over h intervals K²Δ (h − 1/3).
    """
    interval, walk = 0.2, 3.0
    gamma = walk**2 * rate_autocovariance(5, interval)[3]
    for lag in range(1, 5):
        variance = 2 * (gamma[0] - gamma[lag])
        assert variance == pytest.approx(walk**2 * interval * (lag - 1 / 3))


def test_the_data_sheet_stands_for_what_short_stretches_leave_open_of_the_bias_instability():
    """Of a flicker that is there the limit is above it, and of one that is not below the stated."""
    random = np.random.default_rng(41)
    shown = found(noise(SAMPLES, INTERVAL, random, white_noise=1e-4, bias_instability=1e-3))
    white = found(noise(SAMPLES, INTERVAL, random, white_noise=1e-4))
    own, none = (terms.terms["bias_instability"] for terms in (shown, white))
    assert own.detected and not none.detected
    for terms, stated, size in (
        (shown, None, own.value),
        (shown, 5e-4, own.value),
        (shown, 1.0, own.interval[1]),
        (white, None, None),
        (white, 1.0, none.upper),
        (white, none.upper / 2, none.upper / 2),
        (None, 2.0, 2.0),
        (None, None, None),
    ):
        assert drift_of(terms, stated) == ({} if size is None else {"bias_instability": size})


@pytest.mark.parametrize(
    ("alternatives", "seconds", "stated", "entering"),
    [
        (("bias_instability",), 60.0, 4.4e-4, {"bias_instability": 4.4e-4}),
        (("bias_instability",), 60.0, 0.5e-4, {"random_walk": 5.4e-5}),  # it is larger
        (("bias_instability",), 6000.0, 4.4e-4, {"random_walk": 5.4e-5}),  # and over so long
        ((), 60.0, 4.4e-4, {"random_walk": 5.4e-5}),  # the data tell it
        (("bias_instability",), 60.0, None, {"random_walk": 5.4e-5}),
    ],
)
def test_a_walk_that_may_as_well_be_the_data_sheets_bias_instability_is_that(
    alternatives, seconds, stated, entering
):
    """K √(τ/3) over half a stretch of 60 s is 1.7e-4 m/s², and 0.664 B is 2.9e-4 m/s²."""
    absent = SimpleNamespace(p_value=0.4, detected=False, upper=2e-4)
    walk = SimpleNamespace(p_value=1e-4, detected=False, alternatives=alternatives)
    terms = SimpleNamespace(
        model=SimpleNamespace(bias_instability=0.0, random_walk=5.4e-5),
        terms={"bias_instability": absent, "random_walk": walk},
    )
    assert drift_of(terms, stated, seconds) == entering
