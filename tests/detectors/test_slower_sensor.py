"""A sensor that measures less often than its log has records, which repeat its readings."""

from dataclasses import replace
from types import SimpleNamespace

import chain
import numpy as np
import pytest
from on_a_table import tumble
from recorded_by_hand import INTERVAL, NOISE, piece, rest, seen, stamps

import laboratory
from inertial.campaign.log_properties import ChannelStatistics
from inertial.detectors.dead_axis import DeadAxis
from inertial.detectors.disturbances import PeriodicGlitch
from inertial.detectors.oscillation import Oscillation
from inertial.detectors.repeated_records import HeldRecord, SlowerSensor
from inertial.detectors.table_moving import TableMoving
from inertial.signal.phase_folding import Folded, glitches

RECORDS = 20_000
MEMS = np.array([0.04] * 3 + [1e-3] * 3)  # one count of a consumer MEMS: m/s², rad/s


def held(values: np.ndarray, readings: float, columns: slice = slice(None)) -> np.ndarray:
    """Values of which so many of a hundred are read, the others hold the reading before."""
    last = np.floor(np.arange(len(values)) * readings / 100) * 100 / readings
    found = values.copy()
    found[:, columns] = values[np.ceil(last - 1e-9).astype(int)][:, columns]
    return found


def statistics(*batches: np.ndarray):
    """The table of the channels of one log."""
    of_log = ChannelStatistics()
    for batch in batches:
        of_log.add(SimpleNamespace(log="log", readings=batch))
    return of_log.table()


@pytest.mark.parametrize("readings", [25, 50, 80])
@pytest.mark.parametrize("columns", [slice(None), slice(3, 6)])
def test_it_is_known_by_the_records_that_repeat_it_all_the_time(readings, columns):
    values = held(rest(RECORDS), readings, columns)
    table = statistics(values[:7000], values[7000:])
    share = np.zeros(6)
    share[columns] = 1 - readings / 100
    np.testing.assert_allclose(table["held_share"], share, atol=1e-3)
    np.testing.assert_allclose(table["noise"], NOISE, rtol=0.05)  # of a reading, not of a record


def test_a_sensor_that_stands_still_for_long_is_no_slower_one():
    """Zeros in rests of three seconds, two thirds of the records, and readings of its own else."""
    values = rest(RECORDS)
    values[np.arange(RECORDS) % 300 < 200, 3:] = 0.0
    assert (statistics(values)["held_share"] == 0).all()


@pytest.mark.parametrize("bias", [0.0, 1.0, 2.0])  # in standard deviations of a reading
def test_a_sensor_set_to_zero_below_a_threshold_is_no_slower_one(bias):
    """Of three of these: of a gyro at rest now and then a reading of one axis is above it."""
    values = rest(RECORDS)
    values[:, 3:] += bias * NOISE[3:]
    moves = np.arange(RECORDS) % 700 < 200
    values[moves, 3:] += (
        100 * NOISE[3:] * np.random.default_rng(5).standard_normal((moves.sum(), 3))
    )
    values[:, 3:][np.abs(values[:, 3:]) < 3 * NOISE[3:]] = 0.0
    assert (statistics(values[:9000], values[9000:])["held_share"] == 0).all()


def coarse_rest_in_motion() -> np.ndarray:
    """Coarse counts: at rest all axes repeat themselves by chance, in motion none does."""
    values = rest(RECORDS, 3, 0.2 * MEMS, MEMS)
    time = np.arange(RECORDS)[: RECORDS // 2, None]
    values[: RECORDS // 2] += np.round(40 * np.sin(time * np.arange(5, 11) / 40)) * MEMS
    return values


def half_of_the_log() -> np.ndarray:
    values = rest(RECORDS)
    return np.concatenate([values[: RECORDS // 2], held(values[RECORDS // 2 :], 25)])


def now_and_then() -> np.ndarray:
    values, random = rest(RECORDS), np.random.default_rng(4)
    for i in np.flatnonzero(random.uniform(size=RECORDS) < 0.05):
        values[i] = values[i - 1]
    return values


@pytest.mark.parametrize(
    "values",
    [
        rest(RECORDS),
        rest(RECORDS, 3, 0.2 * MEMS, MEMS),
        coarse_rest_in_motion(),
        half_of_the_log(),
        now_and_then(),
        np.zeros((RECORDS, 6)),
    ],
    ids=["fine", "coarse", "coarse-in-motion", "half", "now-and-then", "nothing"],
)
def test_other_repetitions_are_none_of_it(values):
    assert (statistics(values)["held_share"] == 0).all()


def test_what_it_repeats_is_neither_held_nor_dead_but_a_longer_run_is():
    values = held(rest(RECORDS), 25)
    one, shares = piece(values, stamps(RECORDS)), np.array([0.75, 0.75])
    assert not seen(HeldRecord(), one, held=shares) and not seen(DeadAxis(), one, held=shares)
    (event,) = seen(SlowerSensor(), one, held=shares)
    assert event.size == 4 and event.sensor is None
    words = SlowerSensor().describe(event, "log")
    assert "4.00 times: 25.0 readings a second in 100 records" in words.sentence
    values[4000:4080] = values[4000]
    (event,) = seen(HeldRecord(), piece(values, stamps(RECORDS)), held=shares)
    assert (event.first, event.after) == (4001, 4080)


# 25 to 80 of a hundred records are new.
SHARES = [25, 50, 80]


@pytest.mark.parametrize("readings", SHARES)
def test_its_images_of_a_motion_are_no_oscillation_but_a_tone_is_one(readings):
    """A tumble at 10 °/s, held, is in step beside the sensor's own frequency, as no noise is."""
    shares = np.full(2, 1 - readings / 100)
    tumbling = np.vstack([tumble(seed) for seed in range(3)])
    of_record = np.floor(np.arange(len(tumbling)) * readings / 100).astype(int)
    one = piece(tumbling[of_record], stamps(len(tumbling)))
    assert not seen(Oscillation(), one, held=shares)
    if readings == 50:
        assert seen(Oscillation(), one)  # as if each record were a reading
    time = np.arange(len(tumbling))[:, None] / readings
    tone = np.sin(2 * np.pi * 7.3 * time) * 20 * NOISE * (np.arange(6) == 4)
    one = piece((tumbling + tone)[of_record], stamps(len(tumbling)))
    events = seen(Oscillation(), one, held=shares)
    assert {event.channel for event in events} == {4}
    for event in events:
        assert event.facts.tone.frequency == pytest.approx(7.3, abs=0.01)
        assert event.size == pytest.approx(20 * NOISE[4], rel=0.05)
        assert event.facts.tone.rate == pytest.approx(readings)


def folded(values: np.ndarray, time: np.ndarray, shares: np.ndarray):
    sums = Folded(INTERVAL)
    sums.add(time, values, shares)
    return glitches({"clock": sums})["clock"]


def test_its_steps_are_no_glitch_but_a_reading_that_is_off_is_masked_in_both_records():
    shares, tumbling = np.array([0.5, 0.5]), np.vstack([tumble(seed) for seed in range(12)])
    n = len(tumbling)
    time = stamps(n)
    values = held(tumbling, 50)
    assert folded(values, time, shares) == ()
    at = np.mod(np.arange(n) - 24, 500) == 0  # every 5 s, from 0.24 s on
    tumbling[at, 3] += 40 * NOISE[3]
    values = held(tumbling, 50)
    (glitch,) = folded(values, time, shares)
    assert (glitch.channel, glitch.period) == (3, 5.0)
    assert glitch.phase == pytest.approx(0.24)
    assert glitch.size == pytest.approx(40 * NOISE[3], rel=0.05)
    events = seen(PeriodicGlitch(), piece(values, time), held=shares, glitches=(glitch,))
    assert [event.first for event in events] == np.flatnonzero(at).tolist()
    assert {event.after - event.first for event in events} == {2}


@pytest.mark.parametrize("readings", SHARES)
def test_a_rest_with_it_is_still_and_a_knock_in_it_is_one(readings):
    """The changes from record to record are zero where a reading is held, and no noise."""
    shares, values = np.full(2, 1 - readings / 100), rest(6000)
    assert not seen(TableMoving(), piece(held(values, readings), stamps(6000)), held=shares)
    random = np.random.default_rng(8)
    values[3000:3050] += 30 * NOISE * random.standard_normal((50, 6))
    one = piece(held(values, readings), stamps(6000))
    (event,) = seen(TableMoving(), one, held=shares)
    assert event.facts.motion.kind == "knock"
    assert abs(event.first - 3000) <= 20 and abs(event.after - 3050) <= 20


@pytest.mark.slow
def test_a_campaign_with_it_is_calibrated_as_well_as_its_readings_allow():
    """Three of four records were "held" and masked, and the gyros were not usable."""
    recording = laboratory.perform(laboratory.specify(chain.short(seed=5)))
    slow = {
        log: replace(records, counts=held(records.counts, 25))
        for log, records in recording.records.items()
    }
    every, fourth = (
        chain.in_memory(one, "diagnosis", chain.BESIDE)
        for one in (recording, replace(recording, records=slow))
    )
    assert set(fourth["diagnosis/causes"]["cause"]) == {"slower_sensor"}
    assert set(fourth["diagnosis/verdict"]["verdict"]) == {"usable_within_limits"}
    true, found = (one["diagnosis/result"] for one in (every, fourth))
    # The readings of three of four records are lost: √3 sigma of the mean of all apart.
    apart = (found["value"] - true["value"]) / np.sqrt(found["sigma"] ** 2 - true["sigma"] ** 2)
    assert np.sqrt(np.nanmean(apart**2)) == pytest.approx(1.0, abs=0.35)
    biases = found["parameter"].str.startswith("bias") & (found["sensor"] == "gyro")
    assert np.median((found["sigma"] / true["sigma"])[biases]) == pytest.approx(2.0, rel=0.15)
