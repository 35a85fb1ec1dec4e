"""Axes that change places within a log are found to the record; motion is none."""

import numpy as np
import pytest
from on_a_table import askew, recorded, rest, tumble, turn
from recorded_by_hand import NOISE, assert_told

from inertial.detectors.misread_axes_and_signs import (
    AxisSwap,
    AxisSwapOfGyros,
    SignFlip,
    SignFlipOfGyros,
)
from inertial.signal.axis_permutations import PERMUTATIONS

EACH = (AxisSwap(), AxisSwapOfGyros(), SignFlip(), SignFlipOfGyros())


def found(values, **of_log):
    """What all four see, each blind for what those before it mask."""
    one, log = recorded(values, **of_log)
    seen = []
    for detector in EACH:
        events = list(detector.detect(one, log))
        for event in events:
            assert_told(detector, event, "log")
        seen += [(detector.name, detector.sensor, event.first, event.after) for event in events]
        one = one.without(events)
    return seen


def swapped(values, sensor, axes, first, after):
    columns = [axis + (3 if sensor == "gyro" else 0) for axis in axes]
    values = values.copy()
    values[first:after, columns] = values[first:after, columns[::-1]]
    return values


@pytest.mark.parametrize("samples", [5, 10, 1000])
@pytest.mark.parametrize("axes", [(0, 1), (0, 2), (1, 2)])
@pytest.mark.parametrize("up", [0, 1, 2])
def test_exchanged_accelerometers_are_found_in_any_attitude(up, axes, samples):
    values = swapped(rest(3000, up=up), "accel", axes, 1500, 1500 + samples)
    assert found(values) == [("axis_swap", "accel", 1500, 1500 + samples)]


@pytest.mark.parametrize("samples", [5, 10, 1000])
@pytest.mark.parametrize("about", [0, 1, 2])
def test_exchanged_gyros_are_found_while_the_table_turns(about, samples):
    axes = (about, (about + 1) % 3)
    values = swapped(turn(about=about), "gyro", axes, 2500, 2500 + samples)
    assert found(values) == [("axis_swap", "gyro", 2500, 2500 + samples)]


def test_at_rest_exchanged_gyros_cannot_be_seen():
    assert found(swapped(rest(3000), "gyro", (0, 1), 1500, 2500)) == []
    # But those of a consumer MEMS, whose biases are clear of the noise.
    values = rest(3000)
    values[:, 3:] += [0.02, -0.05, 0.01]
    values = swapped(values, "gyro", (0, 1), 1500, 2500)
    assert found(values) == [("axis_swap", "gyro", 1500, 2500)]


def test_what_stays_exchanged_lasts_to_the_end():
    values = swapped(rest(3000), "accel", (1, 2), 1500, 3000)
    assert found(values) == [("axis_swap", "accel", 1500, 3000)]
    one, log = recorded(values)
    (event,) = AxisSwap().detect(one, log)
    words = AxisSwap().describe(event, "up.asc")
    assert "from line 1501 on, to the end, for 1\u202f500 records" in words.sentence
    assert "y reads z and z reads y" in words.sentence
    assert "would be 9.75" in words.consequence


def test_in_a_log_of_several_pieces_all_to_its_end_is_masked():
    values = swapped(rest(9000), "accel", (0, 2), 4000, 9000)
    whole, log = recorded(values)
    fields = {name: getattr(whole, name)[:6000] for name in ("record", "line", "time", "values")}
    fields |= {name: getattr(whole, name)[:6000] for name in ("status", "temperature")}
    first = whole.__class__(**fields, first=0, after=5000)
    (event,) = AxisSwap().detect(first, log)
    assert (event.first, event.after) == (4000, 9000)


def test_two_stretches_are_two():
    values = swapped(rest(5000), "accel", (0, 2), 1000, 1200)
    values = swapped(values, "accel", (0, 2), 3000, 3010)
    assert found(values) == [
        ("axis_swap", "accel", 1000, 1200),
        ("axis_swap", "accel", 3000, 3010),
    ]


def test_exchanged_while_gravity_goes_round():
    values = swapped(tumble(), "accel", (0, 2), 1700, 2300)  # by 60° and by 120°
    assert found(values) == [("axis_swap", "accel", 1700, 2300)]


def test_after_a_gap_the_imu_may_stand_otherwise():
    values = np.vstack([rest(2000, up=2), rest(2000, up=0)])
    values[2000:, :3] = values[:2000, [2, 1, 0]]  # exactly exchanged
    one, log = recorded(values)
    time = one.time.copy()
    time[2000:] += 60.0
    moved = one.__class__(**{**vars(one), "time": time})
    assert list(AxisSwap().detect(one, log)) != []
    assert list(AxisSwap().detect(moved, log)) == []


def test_of_all_signed_permutations_each_has_its_inverse():
    vector = np.array([1.0, 2.0, 3.0])
    assert len(PERMUTATIONS) == 47
    for one in PERMUTATIONS:
        assert one.inverse.of(one.of(vector)).tolist() == vector.tolist()
    assert [one.moved for one in PERMUTATIONS] == sorted(one.moved for one in PERMUTATIONS)


def test_steps_of_a_bias_are_none():
    values = rest(3000)
    for channel, size in ((0, 0.5), (1, -0.02), (2, 0.05), (3, 1e-3)):
        values[1500:, channel] += size
    assert found(values) == []


def test_quarter_turns_by_hand_are_none():
    generator = np.random.default_rng(3)
    # From one attitude to another in 0.3 s, with all the jerks of a hand.
    values = rest(6000, noise=40 * NOISE)
    way = np.clip((np.arange(6000) - 3000) / 30, 0, 1)
    shape = np.sin(way * np.pi / 2)
    turned = values.copy()
    turned[:, 0] = values[:, 0] * np.cos(way * np.pi / 2) + values[:, 2] * shape
    turned[:, 2] = values[:, 2] * np.cos(way * np.pi / 2) - values[:, 0] * shape
    turned[3000:3030, 4] += np.pi / 2 / 0.3
    turned[3000:3030, :3] += generator.normal(size=(30, 3)) * 3
    assert found(turned) == []


@pytest.mark.parametrize("seed", range(3))
def test_clean_readings_are_silent(seed):
    readings = [rest(200_000, seed), turn(seed), tumble(seed), askew(tumble(seed))]
    assert [found(values) for values in readings] == [[]] * 4
