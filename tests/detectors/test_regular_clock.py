"""The clock of samples that a host stamps late, in bursts, or coarsely; gaps in them."""

import numpy as np
import pytest

from inertial.signal.regular_clock import RegularClock, are_regular, regular_clock

INTERVAL = 0.01  # s


def clock_of(time: np.ndarray) -> RegularClock:
    found = regular_clock(time)
    assert found is not None
    return found


def packets(
    taken: np.ndarray, seed: int, period: float = 0.04, stall: tuple[float, float] | None = None
) -> np.ndarray:
    """Stamps of samples taken at these times: a host fetches all that wait, 1 ms for each.

    It looks about every `period`, s; not at all during `stall`, from and to, s.
    """
    generator = np.random.default_rng(seed)
    looks = np.cumsum(period * generator.uniform(0.5, 1.5, int(2 * taken[-1] / period) + 10))
    if stall:
        looks = looks[(looks < stall[0]) | (looks > stall[1])]
    stamps, free = np.empty(len(taken)), 0.0
    for k, look in enumerate(looks[np.searchsorted(looks, taken)].tolist()):
        free = max(free, look) + 1e-3
        stamps[k] = free
    return stamps


def taken(count: int, lost: tuple[int, ...] = ()) -> np.ndarray:
    return np.delete(np.arange(count), lost) * INTERVAL


# ---- regular or not


@pytest.mark.parametrize(
    "time",
    [
        np.arange(5000) * INTERVAL,
        np.round(np.arange(5000) * 11.88e-3, 3),  # 84 Hz in whole ms
        np.flatnonzero(np.random.default_rng(1).random(5000) > 0.3) * INTERVAL,  # 30 % are lost
        np.arange(5000) * INTERVAL + 10 * (np.arange(5000) > 2000),  # a pause of 10 s
        np.r_[np.arange(3000), np.arange(2000, 5000)] * INTERVAL,  # 1000 come again
        np.maximum.accumulate(np.where(np.arange(5000) % 700 < 8, 0, np.arange(5000))) * INTERVAL,
        np.arange(4000) * INTERVAL + 3e-4 * np.random.default_rng(1).standard_normal(4000),
        np.ones(100),
        np.array([0.0, 1.0, 5.0]),
        np.array([]),
    ],
    ids=["even", "ms", "lost", "pause", "replay", "hangs", "jitter 3 %", "no clock", "few", "none"],
)
def test_stamps_that_are_used_as_they_are(time):
    assert are_regular(time)


@pytest.mark.parametrize(
    "time",
    [
        packets(taken(5000), 1),
        np.floor(taken(5000)),  # whole seconds
        np.repeat(np.arange(2500) * 0.02, 2),  # two samples share a stamp
        np.round(np.arange(5000) / 400, 3),  # 400 Hz in whole ms
        taken(5000) + 1e-3 * np.random.default_rng(1).standard_normal(5000),
    ],
    ids=["packets", "seconds", "pairs", "400 Hz in ms", "jitter 10 %"],
)
def test_stamps_that_are_not(time):
    assert not are_regular(time)


def test_pauses_of_a_recording_are_no_delays():
    """Five pieces of six minutes with 40 minutes between them, at 50 Hz."""
    piece = np.arange(18_000) / 50
    time = np.concatenate([piece + k * (360 + 2400) for k in range(5)])
    assert are_regular(time)


# ---- the clock


@pytest.mark.parametrize("seed", range(20))
def test_packets_are_a_regular_clock_without_gaps(seed):
    clock = clock_of(packets(taken(6000), seed))
    assert clock.interval == pytest.approx(INTERVAL, rel=1e-4)
    np.testing.assert_array_equal(clock.number, np.arange(6000))
    assert 0.01 < clock.scatter < 0.03  # of a packet's 0 to 60 ms


@pytest.mark.parametrize("size", [3, 7, 8, 13, 16, 32])
def test_packets_need_not_divide_a_second(size):
    """Samples of a packet arrive 0.1 ms apart; 5000 of them, of which one packet is lost."""
    number = np.arange(5000) + size * (np.arange(5000) >= 2000 // size * size)
    waits = np.random.default_rng(size).uniform(0, 2e-3, number[-1] // size + 1)
    sent = (number // size + 1) * size * INTERVAL
    found = clock_of(sent + number % size * 1e-4 + waits[number // size])
    assert found.interval == pytest.approx(INTERVAL, rel=5e-5)
    np.testing.assert_array_equal(found.number - found.number[0], number)


@pytest.mark.parametrize("seconds", [0.1, 0.3, 0.7])
def test_a_host_that_is_busy_makes_no_gap(seconds):
    clock = clock_of(packets(taken(6000), 1, stall=(20, 20 + seconds)))
    np.testing.assert_array_equal(clock.number, np.arange(6000))


@pytest.mark.parametrize("missing", [4, 20, 300])
@pytest.mark.parametrize("seed", range(5))
def test_a_gap_is_as_many_as_are_missing(missing, seed):
    lost = tuple(range(2000, 2000 + missing))
    clock = clock_of(packets(taken(6000, lost), seed))
    jumps = np.flatnonzero(np.diff(clock.number) > 1)
    assert len(jumps) == 1
    # Two packets; where the gap is no longer than the packets, a second.
    assert jumps[0] + 1 == pytest.approx(2000, abs=10 if missing > 6 else 100)
    assert clock.number[-1] == pytest.approx(5999, abs=1)
    assert clock.interval == pytest.approx(INTERVAL, rel=2e-4)


def test_gaps_are_found_though_there_are_many():
    lost = [place + k for place in range(1000, 59_000, 1000) for k in range(30)]
    clock = clock_of(packets(taken(60_000, tuple(lost)), 3))
    missing = np.diff(clock.number) - 1
    assert np.count_nonzero(missing) == 58
    np.testing.assert_allclose(missing[missing > 0], 30, atol=1)
    assert clock.interval == pytest.approx(INTERVAL, rel=1e-4)


def test_single_stamps_that_are_late_still_show_a_single_lost_sample():
    """As by a driver that polls: stamps are up to 5 ms late, and never early."""
    time = taken(6000, (3000,)) + np.random.default_rng(1).uniform(0, 5e-3, 5999)
    clock = clock_of(time)
    assert np.flatnonzero(np.diff(clock.number) > 1).tolist() == [2999]
    assert clock.number[-1] == 5999
    assert clock.scatter == pytest.approx(5e-3 / np.sqrt(12), rel=0.03)


def test_whole_seconds():
    clock = clock_of(np.floor(taken(6000, tuple(range(1234, 1534)))))
    assert clock.interval == pytest.approx(INTERVAL, rel=1e-4)
    assert clock.number[-1] == pytest.approx(5999, abs=1)
    np.testing.assert_array_equal(clock.number[:1200], np.arange(1200))
    np.testing.assert_allclose(np.diff(clock.number[1400:]), 1)


def test_whole_seconds_of_a_clock_that_is_too_slow_lack_no_sample():
    """Of 100 Hz less 300 ppm a second has 100 samples, and 99 eighteen times in ten minutes."""
    time = np.arange(60_000) * INTERVAL * (1 + 3e-4)
    clock = clock_of(np.floor(time))
    np.testing.assert_array_equal(clock.number, np.arange(60_000))
    assert abs(clock.interval / INTERVAL - 1 - 3e-4) < 2 * clock.interval_sigma / INTERVAL
    assert clock.interval_sigma / INTERVAL < 2e-5  # a sample in ten minutes is 17 ppm


def fetched(time: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """A host stamps alike what it finds waiting every 20 to 60 ms."""
    looks = np.cumsum(random.uniform(0.02, 0.06, len(time)))
    return looks[np.searchsorted(looks, time)]


STAMPS = {
    "delays": lambda time, random: time + random.exponential(5e-3, len(time)),
    "jitter": lambda time, random: time + 5e-3 * random.standard_normal(len(time)),
    "packets": lambda time, random: packets(time, int(random.integers(1 << 30))),
    "fetched together": lambda time, random: fetched(time, random),
    "slow host": lambda time, random: (
        time
        + 1e-3 * np.sin(2 * np.pi * (time / 20 + random.uniform()))
        + random.exponential(5e-3, len(time))
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", STAMPS)
@pytest.mark.parametrize("seconds", [60, 200])
def test_the_interval_has_an_honest_sigma(kind, seconds):
    """Clocks that are off by up to 1000 ppm, a hundred of each kind of stamps."""
    pulls = []
    for seed in range(100):
        random = np.random.default_rng(seed)
        interval = INTERVAL * (1 + random.uniform(-1e-3, 1e-3))
        found = clock_of(STAMPS[kind](interval * np.arange(100 * seconds), random))
        assert found.interval_sigma < 30e-6 * interval
        pulls.append((found.interval - interval) / found.interval_sigma)
    # √(2 · 100)/100: an rms of 1 scatters by 7 %; what is correlated may only be overestimated.
    assert (0.3 if kind == "slow host" else 0.75) < np.sqrt(np.mean(np.square(pulls))) < 1.25
    assert np.abs(pulls).max() < 4.5


def test_whole_milliseconds_of_10_ms_hide_a_clock_that_is_off_by_less():
    """Stamps in whole ms, each late: 60 s show no change of less than 1 ms, 17 ppm."""
    random = np.random.default_rng(1)
    errors, sigmas = [], []
    for error in np.linspace(-2e-5, 2e-5, 41):
        time = np.arange(6000) * INTERVAL * (1 + error) + random.uniform()
        clock = clock_of(np.floor((time + random.exponential(5e-3, 6000)) * 1e3) / 1e3)
        errors.append(clock.interval / INTERVAL - 1 - error)
        sigmas.append(clock.interval_sigma / INTERVAL)
    assert 5e-6 < np.median(sigmas) < 15e-6
    assert np.sqrt(np.mean(np.square(np.divide(errors, sigmas)))) < 1.3


def test_a_clock_that_is_set_back_stays_so():
    time = packets(taken(6000), 1)
    time[3000:] -= 20
    clock = clock_of(time)
    assert np.diff(clock.number)[2999] == pytest.approx(1 - 20 / INTERVAL, abs=1)
    assert np.count_nonzero(np.diff(clock.number) != 1) == 1


def test_one_absurd_stamp_does_not_matter():
    time = packets(taken(6000), 1)
    time[3000] = 1e6
    np.testing.assert_array_equal(clock_of(time).number, np.arange(6000))


def test_stamps_that_do_not_advance_are_no_clock():
    assert regular_clock(np.ones(100)) is None
    assert regular_clock(-np.arange(100.0)) is None


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(("jitter", "lost"), [(0.0015, 0.003), (0.0015, 0.01), (0.002, 0.02)])
def test_samples_that_are_lost_one_by_one_are_counted_in_stamps_that_scatter(seed, jitter, lost):
    """Of 10 ms: with one lost in every second the clock was 0.2 to 2 % slow, 40 ms of scatter."""
    random = np.random.default_rng(seed)
    number = np.flatnonzero(random.random(20_000) > lost)
    interval = 0.01 * (1 + 30e-6)
    stamps = np.sort(number * interval + jitter * random.standard_normal(len(number)))
    found = regular_clock(stamps - stamps[0])
    assert found is not None
    assert found.interval == pytest.approx(interval, abs=4 * found.interval_sigma)
    assert found.interval_sigma < 3e-6 * interval
    assert found.scatter == pytest.approx(jitter, rel=0.05)
    off = found.number - found.number[0] - (number - number[0])
    assert np.mean(off == np.median(off)) > 0.998
