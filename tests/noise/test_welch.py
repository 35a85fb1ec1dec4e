"""Welch's spectrum: density of white noise and of a sine, degrees of freedom, gaps."""

import numpy as np
from noise_simulation import noise
from scipy.signal import welch

from inertial.estimation.multiresolution import WelchSums, segment_for
from inertial.estimation.noise_model import NoiseModel
from inertial.estimation.spectrum import square_of_integral

INTERVAL = 0.02


def spectrum(*stretches, segment=256):
    sums = WelchSums(stretches[0].shape[1], INTERVAL, segment)
    for stretch in stretches:
        for piece in np.array_split(stretch, 7):
            sums.add(piece)
        sums.end()
    return sums.spectrum()


def test_density_and_degrees_of_freedom_of_white_noise():
    """Both-sided density N², and a scatter of √(2/degrees) in each bin, over 150 channels."""
    white = 0.3
    rates = white / np.sqrt(INTERVAL) * np.random.default_rng(1).standard_normal((16384, 150))
    found = spectrum(rates)
    relative = found.density / white**2
    assert abs(relative.mean() - 1) < 0.004
    excess = relative.var(axis=1) * found.degrees / 2
    assert abs(np.median(excess) - 1) < 0.08
    assert (np.abs(excess - 1) < 0.46).all()
    assert found.frequency.min() < 0.05 and found.frequency.max() < 25.0


def test_it_is_scipys_in_the_first_level():
    """One-sided there; the sum over the first level is the power of a sine, A²/2."""
    time = INTERVAL * np.arange(4096)
    rates = 3.0 * np.sin(2 * np.pi * 10.3 * time)[:, None]
    frequency, density = welch(rates[:, 0], 1 / INTERVAL, "hann", 256, 128, detrend="constant")
    found = spectrum(rates)
    for low, high, value in zip(*found.edges.T, found.density[:, 0], strict=True):
        inside = (frequency > low) & (frequency < high)
        if low > 1.0:
            np.testing.assert_allclose(2 * value, density[inside].mean(), rtol=1e-9, atol=1e-12)
    power = 2 * found.density[:, 0] @ np.diff(found.edges, axis=1)[:, 0]
    np.testing.assert_allclose(power, 4.5, rtol=0.01)
    marked = found.in_ranges(np.array([[10.2, 10.4]]))
    assert marked.sum() in (1, 2) and marked[np.argmax(found.density[:, 0])]


def test_a_level_of_means_continues_the_one_below():
    """A random walk is the model's everywhere; a jump between stretches is in no segment."""
    chance = np.random.default_rng(2)
    stretches = [
        np.array([noise(20_000, INTERVAL, chance, random_walk=1.0) for _ in range(30)]).T + jump
        for jump in (0.0, 1e6)
    ]
    found = spectrum(*stretches)
    model = NoiseModel(random_walk=1.0).density(found.frequency, INTERVAL)
    middle = (found.frequency > 0.05) & (found.frequency < 5.0)
    pulls = (found.density.mean(axis=1) / model - 1) / np.sqrt(2 / found.degrees / 30)
    assert middle.sum() > 25
    assert np.abs((found.density.mean(axis=1) / model - 1)[middle]).max() < 0.2
    assert abs(pulls[middle].mean()) < 2.0


def test_segments_fit_into_the_stretches():
    assert segment_for([]) == 64
    assert segment_for([3000]) == 512
    assert segment_for([10**7, 300]) == 1024


def test_a_line_makes_means_of_any_length_as_uncertain_by_its_two_ends():
    """√2 Q/T is the scatter of the means over T of a sine of 23.4 Hz; noise alone has no Q."""
    rng, step, amplitude = np.random.default_rng(5), 0.01, 0.3
    noise = 0.005 * rng.standard_normal((900, 200))
    assert not square_of_integral(noise, 1 / step, 5.0).any()
    time = step * np.arange(900)[:, None]
    waves = amplitude * np.sin(2 * np.pi * (23.4 * time + rng.uniform(size=200)))
    found = np.sqrt(square_of_integral(waves + noise, 1 / step, 5.0))
    assert np.ptp(found) < 0.05 * np.median(found)
    lengths = np.arange(200, 900)
    scatter = [np.std(waves[:n].mean(axis=0)) * n * step for n in lengths]
    assert abs(np.sqrt(np.mean(np.square(scatter))) / (np.sqrt(2) * np.median(found)) - 1) < 0.05
