"""What a border of pieces cuts is told once, with its ends; what is everywhere, once for a log."""

import numpy as np
import pytest
from on_a_table import recorded, rest, turn
from recorded_by_hand import COUNT, INTERVAL, NOISE

from inertial.campaign.detection import Examination
from inertial.campaign.findings import detections_of
from inertial.detectors import OF_RECORDS

LENGTH, BESIDE = 6000, 2000
ROWS = ("record", "line", "time", "values", "status", "temperature")
OF_READINGS = tuple(
    detector
    for detector in OF_RECORDS
    if detector.name
    in {"spike", "saturation", "dead_axis", "quantisation", "oscillation", "axis_swap", "sign_flip"}
)


def cut(one):
    """A piece in pieces of 6000 records, each with 2000 on either side."""
    for first in range(0, len(one), LENGTH):
        after = min(first + LENGTH, len(one))
        start, end = max(first - BESIDE, 0), min(after + BESIDE, len(one))
        rows = {name: getattr(one, name)[start:end] for name in ROWS}
        yield "log", one.__class__(**rows, first=first - start, after=after - start)


def told(values):
    one, log = recorded(values)
    examination = Examination(OF_READINGS, {"log": log}, log.given)
    for name, part in cut(one):
        examination.examine(name, part)
    return detections_of("quality", examination.events(), {"log": log})


def spoiled(first, after):
    """Each with its cause, the channel concerned, and the readings from `first` to `after`."""
    time = np.arange(after - first) * INTERVAL
    values = rest(18_000)
    values[first:after, 4] += 0.001 * np.sin(2 * np.pi * 20.3 * time)
    yield "oscillation", values
    values = rest(18_000)
    values[first:after, 3] = values[first, 3] + 2e-4
    yield "dead_axis", values
    values = rest(18_000)
    values[first:after, [0, 2]] = values[first:after, [2, 0]]
    yield "axis_swap", values
    values = rest(18_000)
    values[first:after, 2] *= -1
    yield "sign_flip", values


@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize(("first", "after"), [(4500, 7000), (5990, 6900), (11_000, 12_003)])
def test_a_stretch_over_a_border_is_one_finding(number, first, after):
    cause, values = list(spoiled(first, after))[number]
    (one,) = told(values)
    assert one.finding.cause == cause
    ((_, event),) = one.events
    assert abs(event.first - first) <= 2
    assert abs(event.after - after) <= 2


@pytest.mark.parametrize("record", [5999, 6000, 11_999])
def test_a_spike_at_a_border_is_one_finding(record):
    values = rest(18_000)
    values[record, 1] += 100 * NOISE[1]
    (one,) = told(values)
    assert (one.finding.cause, one.finding.axis) == ("spike", "y")
    assert [(event.first, event.after) for _, event in one.events] == [(record, record + 1)]
    assert one.finding.severity == 1


def test_steps_of_a_log_of_several_pieces_are_one_finding():
    values = rest(18_000)
    values[:, :3] = np.rint(values[:, :3] / (4 * 1.52587890625e-4)) * 4 * 1.52587890625e-4
    (one,) = told(values)
    assert (one.finding.cause, one.finding.count) == ("quantisation", 1)


def test_an_oscillation_of_several_turns_is_one_finding_of_the_log():
    values = np.vstack([turn(seed) for seed in range(3)])
    time = np.arange(3400) * INTERVAL
    for start in (1200, 6998, 12_796):
        values[start : start + 3400, 3] += 0.01 * np.sin(2 * np.pi * 20 * time)
    (one,) = told(values)
    assert (one.finding.cause, one.finding.count, len(one.events)) == ("oscillation", 3, 3)
    assert "This occurs 3 times in this log" in one.finding.sentence


def test_both_sensors_exchanged_at_once_are_one_finding_that_names_both():
    values = turn()
    values[2000:3000] = values[2000:3000][:, [1, 0, 2, 3, 5, 4]]
    (one,) = told(values)
    assert (one.finding.cause, one.finding.sensor) == ("axis_swap", "accel")
    assert "x reads y and y reads x" in one.finding.sentence
    assert "So do those of the gyros: y reads z and z reads y" in one.finding.sentence


def test_both_sensors_exchanged_one_after_the_other_are_two_findings():
    values = turn()
    values[2000:2500] = values[2000:2500][:, [1, 0, 2, 3, 4, 5]]
    values[3000:3500] = values[3000:3500][:, [0, 1, 2, 3, 5, 4]]
    found = [one.finding for one in told(values)]
    assert {(one.cause, one.sensor) for one in found} == {
        ("axis_swap", "accel"),
        ("axis_swap", "gyro"),
    }
    assert len({one.id for one in found}) == 2


def test_readings_that_one_detector_masks_mislead_none_after_it():
    values = turn()
    values[:, 5] = np.minimum(values[:, 5], np.rint(0.12 / COUNT[5]) * COUNT[5])  # at its limit
    values[500:700, 4] = values[500, 4]  # frozen
    values[800:803, 0] += 5.0  # spikes
    causes = sorted({one.finding.cause for one in told(values)})
    assert causes == ["dead_axis", "saturation", "spike"]
