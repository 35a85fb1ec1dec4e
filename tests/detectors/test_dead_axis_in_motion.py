"""A gyro with coarse counts that stands still: dead where it is turned freely, else by right."""

from itertools import pairwise

import numpy as np
import pytest
from moved_by_hand import CORNERS, EDGES, FACES, FINE, RATE, attitudes, by_hand
from on_a_table import recorded
from recorded_by_hand import assert_told

from inertial.detectors.dead_axis import DeadAxis, FreeRotation

GRAVITY = 9.80665
DRAWS = range(12)


def stretches(values):
    """The stretches in which an axis is called dead: channel, first record, the one after."""
    events = list(DeadAxis().detect(*recorded(values)))
    for event in events:
        assert_told(DeadAxis(), event, "log")
    return [(event.channel, event.first, event.after) for event in events]


def rates_by_hand(rng, moves):
    """Rests of 2 s to 5 s and what lies between, by hand, rad/s, (n, 3); where each move begins."""
    ups = np.vstack([FACES, EDGES, CORNERS])
    ways = pairwise(attitudes(rng, ups[rng.integers(len(ups), size=moves + 1)], 0.1))
    parts, begins = [], []
    for here, there in ways:
        parts.append(np.zeros((rng.integers(2 * RATE, 5 * RATE), 3)))
        begins.append(sum(map(len, parts)))
        way = by_hand(rng, here, there)
        rates = (way[:-1].inv() * way[1:]).as_rotvec() * RATE * FINE
        parts.append(rates.reshape(-1, FINE, 3).mean(axis=1))
    return np.vstack([*parts, np.zeros((3 * RATE, 3))]), begins


def turns(rng, axes, rate=100.0):
    """Rests, and one turn after another about unit vectors, at a rate of readings, Hz, (n, 3)."""
    parts = []
    for axis in axes:
        speed = np.radians(rng.uniform(5, 200)) * rng.choice([-1, 1])
        ramp = np.linspace(0, speed, max(int(rng.uniform(0.2, 2) * rate), 2))
        steady = np.full(int(rng.uniform(2, 20) * rate), speed)
        parts += [np.zeros(int(rng.uniform(0, 10) * rate)), ramp, steady, ramp[::-1]]
        parts[-4:] = [np.outer(part, axis) for part in parts[-4:]]
    return np.vstack(parts)


def swings(rng, axis, seconds=120):
    """To and fro about one axis, at 0.2 Hz to 3 Hz, rad/s, (n, 3)."""
    time = np.arange(seconds * RATE) / RATE
    swing = np.radians(rng.uniform(5, 200)) * np.sin(2 * np.pi * rng.uniform(0.2, 3) * time)
    return np.outer(swing, axis)


def read(rng, rates, noise, carry=False):
    """What a gyro of so many counts of noise reads, beside accelerometers at rest, (n, 6); a count.

    A carry hands what a count leaves over to the next reading.
    """
    count = np.radians(rng.uniform(0.02, 0.12))
    values = np.zeros((len(rates), 6))
    values[:, 2] = GRAVITY
    values[:, :3] += 0.02 * rng.standard_normal((len(rates), 3))
    bias = rng.uniform(-40, 40, 3) + rng.uniform(-0.5, 0.5, 3)
    counts = rates / count + bias + noise * rng.standard_normal(rates.shape)
    if carry:
        values[:, 3:] = np.diff(np.rint(np.cumsum(counts, 0)), axis=0, prepend=0.0) * count
    else:
        values[:, 3:] = np.rint(counts) * count
    return values


def noise_of(rng):
    """Counts, less than those by which a run of equal readings is told."""
    return float(rng.choice([0.02, 0.1, 0.3, 0.5]))


@pytest.mark.parametrize("carry", [False, True])
@pytest.mark.parametrize("seed", DRAWS)
def test_a_gyro_that_dies_as_it_is_handled_is_found(seed, carry):
    rng = np.random.default_rng([1, seed])
    rates, begins = rates_by_hand(rng, 14)
    values, axis = read(rng, rates, noise_of(rng), carry), int(rng.integers(3, 6))
    dies = begins[3] + int(rng.integers(20, RATE))
    lives = int(rng.choice([begins[10] - 1, len(values)]))
    values[dies:lives, axis] = values[dies, axis]
    ((channel, first, after),) = stretches(values)
    assert channel == axis
    # What rests by right beside it may read the same.
    assert begins[2] < first <= dies
    assert lives <= after <= (begins[10] + 20 if lives < len(values) else lives)


@pytest.mark.parametrize("carry", [False, True])
@pytest.mark.parametrize("seed", DRAWS)
def test_what_is_handled_is_no_dead_axis(seed, carry):
    rng = np.random.default_rng([2, seed])
    assert stretches(read(rng, rates_by_hand(rng, 14)[0], noise_of(rng), carry)) == []


@pytest.mark.parametrize("carry", [False, True])
@pytest.mark.parametrize("seed", DRAWS)
def test_gyros_that_a_table_does_not_turn_are_not_dead(seed, carry):
    """Turns about the axes of the sensor, one or one after another; about axes between two."""
    rng = np.random.default_rng([3, seed])
    about = rng.integers(3, size=10)
    between = np.eye(3)[about] + np.eye(3)[(about + 1) % 3]
    for axes in (np.tile(np.eye(3)[about[:1]], (10, 1)), np.eye(3)[about], between / np.sqrt(2)):
        noise = noise_of(rng)
        assert stretches(read(rng, turns(rng, axes), noise, carry)) == []
        assert stretches(read(rng, turns(rng, axes, rate=20.0), noise, carry)) == []
        assert stretches(read(rng, swings(rng, axes[-1]), noise, carry)) == []


def test_what_a_mechanism_never_turns_is_not_dead_when_it_stands_still_again():
    """A cone about x: y and z change one without the other, and x has nothing to read."""
    rng = np.random.default_rng(4)
    phase = 2 * np.pi * np.arange(60 * RATE) / RATE
    cone = np.radians(30) * np.column_stack([0 * phase, np.cos(phase), np.sin(phase)])
    knocks = np.zeros_like(cone)
    knocks[1000::1500, 0] = np.radians(5)
    values = read(rng, cone + knocks, 0.02)
    assert stretches(values) == []
    cone[:, 0] = np.radians(20) * np.sin(phase / 3)  # as of an axis that is turned there, too
    cone[1000:4000, 0] = 0
    assert stretches(read(rng, cone, 0.02)) != []


def test_the_chance_to_stand_still_is_that_of_drawn_rates():
    """That a drawn rate is in the middle count, where two others change sideways by 108 counts."""
    rng = np.random.default_rng(5)
    phase = 2 * np.pi * np.arange(6400) / 64
    rates = np.column_stack([0 * phase, 200 * np.cos(phase), 200 * np.sin(phase)])
    one = FreeRotation.beside(0, rates, np.zeros(3), 1.0)
    across = 200 * 2 * np.sin(np.pi * 8 / 64) * np.sin(2 * np.pi * 8 / 64)
    drawn = np.mean(np.abs(rng.normal(0, across, 10**6)) < 0.5)
    assert one.chance == pytest.approx(drawn, rel=0.05)
    assert one.chance_of(0, 6400) == pytest.approx(float(one.chance[0]) ** 99, rel=0.2)
