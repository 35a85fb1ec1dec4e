"""A channel at the end of its range: stated, a full count, or told by the pile of its readings."""

import numpy as np
import pytest
from on_a_table import BIAS, RATE, carried, profile, recorded, rest, tumble, turn
from recorded_by_hand import COUNT, GRAVITY, INTERVAL, NOISE, assert_told

from inertial.detectors.saturation import Saturation, _by_the_other_side, pile_at_top
from inertial.signal.runs import MAX_LOST_RUN


def found(values, **of_log):
    one, log = recorded(values, **of_log)
    events = list(Saturation().detect(one, log))
    for event in events:
        assert_told(Saturation(), event, "log")
    return events


def clipped(values, channel, limit):
    """The readings cut off at ±limit, and the records that this changed."""
    limit = np.rint(limit / COUNT[channel]) * COUNT[channel]
    after = values.copy()
    after[:, channel] = np.clip(values[:, channel], -limit, limit)
    return after, np.flatnonzero(after[:, channel] != values[:, channel])


def limits(channel, limit):
    return np.where(np.arange(6) == channel, limit, np.inf)


def test_readings_at_the_stated_limit_are_found_one_by_one():
    values = rest(3000)
    values[1000:1012, 3] = [1, 2, 3, 4, 4.5, 4.8, 5, 5, 4, 3, 2, 1]
    values[2000:2003, 3] = [-4, -5, -4]
    values, touched = clipped(values, 3, 4.3656)
    events = found(values, limit=limits(3, 4.3656))
    assert [(event.first, event.after, event.size) for event in events] == [
        (1004, 1008, 4),
        (2001, 2002, 1),
    ]
    assert touched.tolist() == [1004, 1005, 1006, 1007, 2001]


def test_what_is_lost_of_a_smooth_crest_is_told():
    time = (np.arange(60) - 30) * INTERVAL
    values = rest(3000)
    crest = 5.0 * (1 - (time / 0.25) ** 2)
    values[1000:1060, 4] += np.maximum(crest, 0)
    after, _ = clipped(values, 4, 4.5)
    (event,) = found(after, limit=limits(4, 4.5))
    lost = float(np.sum(values[:, 4] - after[:, 4])) * INTERVAL
    assert event.facts.lost == pytest.approx(lost, rel=0.15)
    words = Saturation().describe(event, "log")
    assert "the end of the range" in words.sentence
    assert f"up to {MAX_LOST_RUN} in a row in a motion between positions" in words.action
    assert f"about {np.degrees(event.facts.lost):.1f} °" in words.consequence


def test_the_full_count_of_a_converter_needs_no_statement():
    values = rest(3000)
    values[1000:1010, 0] = 32767 * COUNT[0]
    (event,) = found(values)
    assert (event.first, event.after) == (1000, 1010)


@pytest.mark.parametrize("sigma", [-300, -3, 0, 1, 1.5])
def test_a_turn_cut_off_without_a_stated_limit_is_found(sigma):
    values, touched = clipped(turn(), 5, RATE + sigma * NOISE[5])
    events = found(values)
    assert {event.channel for event in events} == {5}
    assert events[0].p_value < 1e-6
    # Readings that lay at the limit by themselves count as well.
    assert touched[0] - 30 <= events[0].first <= touched[0]
    assert touched[-1] < events[-1].after <= touched[-1] + 31
    assert sum(event.size for event in events) >= len(touched)


@pytest.mark.parametrize("sigma", [-5, -10])
def test_a_position_beyond_the_limit_that_is_come_to_slowly_is_found(sigma):
    """Set upright from 30° at 5 °/s²: in 0.08 s beside a limit of 5 sigma less it gains 2 sigma."""
    away = np.radians(5) / 2 * np.clip(np.abs(np.arange(6000) - 3000) - 2000, 0, 346) ** 2
    truth = np.tile(BIAS, (6000, 1))
    truth[:, 1] += GRAVITY * np.sin(away * INTERVAL**2)
    truth[:, 2] += GRAVITY * np.cos(away * INTERVAL**2)
    values = carried(truth, 5)
    after, touched = clipped(values, 2, BIAS[2] + GRAVITY + sigma * NOISE[2])
    (event,) = found(after)
    assert event.channel == 2 and event.p_value < 1e-6
    assert (event.first, event.after - 1) == pytest.approx((touched[0], touched[-1]), abs=30)
    # A reading that stays the same while it stands was come to by none of that.
    values[2000:4000, 2] = values[:, 2].max()
    assert found(values) == []


@pytest.mark.parametrize("sigma", [-5, -1, 0.5, 1.5])
@pytest.mark.parametrize("part", [0.1, 0.5, 0.8])
def test_increments_at_a_limit_between_two_counts_alternate_and_are_found(sigma, part):
    """Cut off before they are counted: what a count leaves over goes into the next."""
    rate = profile()
    truth = np.tile(BIAS, (len(rate), 1))
    truth[:, 2] += 9.79
    truth[:, 5] += rate
    limit = (np.floor((RATE + sigma * NOISE[5]) / COUNT[5]) + part) * COUNT[5]
    noisy = truth + NOISE * np.random.default_rng(4).standard_normal(truth.shape)
    touched = np.flatnonzero(noisy[:, 5] > limit)
    noisy[touched, 5] = limit
    values = np.diff(np.rint(np.cumsum(noisy, 0) / COUNT), axis=0, prepend=0.0) * COUNT
    events = found(values)
    assert {event.channel for event in events} == {5}
    assert events[0].first <= touched[0] + 50 and events[-1].after > touched[-1] - 50
    # Of few the lower count is not told from the noise of 3 counts.
    assert sum(event.size for event in events) >= (0.95 if sigma < 1 else 0.6) * len(touched)


def test_a_log_that_stands_at_the_limit_throughout_is_found_by_the_others():
    """Two counts by turns, where the other logs have seven counts of noise and go no farther."""
    values = rest(3000)
    limit = (np.floor(9.7 / COUNT[2]) + 0.3) * COUNT[2]
    values[:, 2] = np.diff(np.rint(limit * np.arange(3001) / COUNT[2])) * COUNT[2]
    noise, reach = NOISE.copy(), np.abs(values).max(axis=0)
    (event,) = found(values, usual_noise=noise, reach=reach)
    assert (event.channel, event.size) == (2, 3000)
    farther = np.where(np.arange(6) == 2, 9.8, reach)
    assert found(values, usual_noise=noise, reach=farther) == []
    assert found(values, usual_noise=0.3 * COUNT, reach=reach) == []


@pytest.mark.parametrize("share", [0.1, 0.5])
def test_so_is_one_where_the_deepest_noise_comes_back(share):
    """A limit that two to three sigma of the noise lie beyond, between two counts.

    Noise of a count or less stands there too, but what its counts leave over goes nowhere.
    """
    values = rest(30_000)
    limit = values[:, 2].mean() - 2.5 * NOISE[2]
    limit = (np.floor(limit / COUNT[2]) + share) * COUNT[2]
    read = np.minimum(values[:, 2], limit)
    values[:, 2] = np.diff(np.rint(np.append(0.0, np.cumsum(read)) / COUNT[2])) * COUNT[2]
    least = int(np.sum(read < limit))
    assert 50 < least < 500
    reach = np.abs(values).max(axis=0)
    events = found(values, usual_noise=NOISE, reach=reach)
    assert {event.channel for event in events} == {2}
    assert sum(event.size for event in events) == pytest.approx(30_000 - least, abs=least)
    random = np.random.default_rng(5)
    for quiet in (0.3, 0.6, 1.0):
        values[:, 2] = np.rint(limit / COUNT[2] + quiet * random.normal(size=30_000)) * COUNT[2]
        assert found(values, usual_noise=NOISE, reach=np.abs(values).max(axis=0)) == []


def test_both_ends_are_seen():
    values, _ = clipped(np.vstack([turn(), -turn(2)]), 5, RATE - 0.01)
    first, second = found(values)
    assert first.facts.limit == -second.facts.limit > 0


def test_a_dead_axis_a_frozen_one_and_a_leap_are_none():
    values = turn()
    values[2000:2500, 2] = 0.0
    values[2000:2500, 5] = 0.0
    values[100:400, 0] = values[100, 0]
    values[3000:3300, 4] = 20 * NOISE[4]
    assert found(values) == []


@pytest.mark.parametrize("noise", [0.02, 0.1, 0.3, 0.5, 0.7, 1.0, 3.0])
def test_coarse_counts_are_none(noise):
    # Noise in counts, for plain rounding and for carry: then a steady turn has few values.
    scatter = noise * COUNT
    for seed in range(3):
        values = turn(seed, noise=scatter)
        assert found(values) == []
        plain = np.rint((turn(seed) + 0.37 * COUNT) / (NOISE / noise)) * (NOISE / noise)
        assert found(plain, quantum=NOISE / noise) == []


def test_the_crests_of_an_oscillation_are_none():
    time = np.arange(12_000) * INTERVAL
    values = rest(12_000)
    for channel, frequency in ((3, 20.0), (4, 1.7), (0, 37.0)):
        crests = 500 * COUNT[channel] * np.sin(2 * np.pi * frequency * time)
        values[:, channel] += np.rint(crests / COUNT[channel]) * COUNT[channel]
    assert found(values) == []


@pytest.mark.parametrize("seed", range(3))
def test_clean_readings_are_silent(seed):
    assert [found(values) for values in (rest(200_000, seed), turn(seed), tumble(seed))] == [[]] * 3


def test_the_chance_of_a_pile_is_no_smaller_than_it_happens():
    """The largest of a steady reading's few counts often come twice or ten times, by chance."""
    rng = np.random.default_rng(3)
    chances = []
    for _ in range(600):
        scatter = rng.choice([1, 1.5, 2, 3, 5])
        values = np.rint(scatter * rng.standard_normal(3000) + rng.uniform())
        chances.append(_by_the_other_side(values, values.max(), 1.0))
    for level in (0.1, 0.01, 0.001):
        assert np.mean(np.array(chances) < level) <= level + 3 * np.sqrt(level / 600)


def test_the_ramp_beside_a_steady_turn_is_no_noise_of_it():
    """At 50 Hz few readings lie on a ramp; with them the noise looked wider below than above."""
    rng = np.random.default_rng(1)
    piles = 0
    for _ in range(4000):
        top = rng.uniform(1500, 2500)
        ramp = np.arange(0, top, top / rng.uniform(30, 90))
        steady, still = np.full(rng.integers(300, 900), top), np.zeros(300)
        scatter = rng.uniform(0.9, 2.5)
        rate = np.concatenate([still, ramp, steady, ramp[::-1], still])
        values = np.rint(rate + scatter * rng.standard_normal(len(rate)))
        piles += len(pile_at_top(values, values.max(), 1.0, scatter)[0]) > 0
    assert not piles
