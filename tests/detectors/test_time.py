"""Faults of records and their stamps, hidden in arrays; and silence where there is none."""

import numpy as np
import pytest
from recorded_by_hand import (
    COUNT,
    INTERVAL,
    NOISE,
    assert_told,
    given,
    log,
    piece,
    rest,
    seen,
    stamps,
)

from inertial.detectors.clock_jitter import ClockJitter
from inertial.detectors.clock_scale import ClockScale
from inertial.detectors.gap import Gap
from inertial.detectors.receiver_statements import StatusInvalid
from inertial.detectors.repeated_records import Duplicate, HeldRecord
from inertial.detectors.stamp_faults import (
    ClockStep,
    RateOff,
    TimeBackwards,
    TimeStandsStill,
    WrongDay,
    WrongTimeUnit,
)

OF_TIME = (
    Duplicate(),
    Gap(),
    TimeBackwards(),
    HeldRecord(),
    StatusInvalid(),
    TimeStandsStill(),
    ClockJitter(),
    ClockStep(),
    ClockScale(),
    RateOff(),
    WrongDay(),
    WrongTimeUnit(),
)
MEMS = np.array([0.04] * 3 + [1e-3] * 3)  # of a consumer MEMS: m/s², rad/s


def causes(one, campaign=None, **of_log):
    """What is named, each detector blind for what those before it mask."""
    found = {}
    whole = log(one, campaign, **of_log)
    for detector in OF_TIME:
        events = [*detector.detect(one, whole), *detector.detect_in_log(whole)]
        for event in events:
            assert_told(detector, event, "log")
        if events:
            found[detector.name] = events
        if detector.masks:
            one = one.without(events)
    return found


def alternating(n, seed=1):
    """Accelerometers and gyros in rows of their own, with one stamp: values and time."""
    values, time = rest(n, seed), stamps(n)
    rows = np.repeat(values, 2, axis=0)
    rows[0::2, 3:] = np.nan
    rows[1::2, :3] = np.nan
    return rows, np.repeat(time, 2)


# ---- silence


@pytest.mark.parametrize("seed", range(20))
def test_clean_logs_are_silent(seed):
    assert not causes(piece(rest(5000, seed), stamps(5000)))
    assert not causes(piece(rest(3000, seed, MEMS, NOISE * 8), stamps(3000)))


@pytest.mark.parametrize("seed", range(20))
def test_coarse_counts_repeat_by_chance(seed):
    """At rest a MEMS whose noise is a third of a count repeats whole records, by chance."""
    coarse = rest(20_000, seed, MEMS, 3 * MEMS)
    assert (coarse[1:] == coarse[:-1]).all(axis=1).sum() > 100
    assert not causes(piece(coarse, stamps(20_000)))


@pytest.mark.parametrize("seed", range(5))
def test_a_rest_with_coarse_counts_after_a_motion_is_silent(seed):
    values = rest(10_000, seed, MEMS, 2 * MEMS)
    swing = 5 * np.sin(np.arange(3000) / 20)[:, None] * np.array([1, 2, 3, 0.1, 0.2, 0.3])
    values[:3000] = np.round((values[:3000] + swing) / (2 * MEMS)) * 2 * MEMS
    assert not causes(piece(values, stamps(10_000)))


def test_rows_of_their_own_logs_without_time_and_dead_axes_are_silent():
    assert not causes(piece(*alternating(2000)))
    assert not causes(piece(rest(30)), recorded_on=None)
    values = rest(5000)
    values[:, 1], values[:, 4] = 0.0, 0.0
    assert not causes(piece(values, stamps(5000)))
    constant = np.tile([0.0, 0.0, 9.8, np.nan, np.nan, np.nan], (1000, 1))
    assert not causes(piece(constant, stamps(1000)))


def test_a_real_crystal_and_stamps_of_a_receiver_are_silent():
    n = 20_000
    for ppm in (-90, 30, 90):
        # A receiver's clock is steered by 1 ns at a time, as in the recordings of WHU.
        time = np.round(np.arange(n) * INTERVAL * (1 + ppm * 1e-6), 9) + np.arange(n) // 500 * 1e-9
        assert not causes(piece(rest(n), time))


# ---- records


@pytest.mark.parametrize("times", [1, 5, 50])
def test_a_repeated_record_is_masked_and_no_time_passes(times):
    values, time = rest(2000), stamps(2000)
    rows = np.insert(np.arange(2000), 700, [699] * times)
    found = causes(piece(values[rows], time[rows]))
    assert set(found) == {"duplicate"}
    (event,) = found["duplicate"]
    assert (event.first, event.after, event.size) == (700, 700 + times, times)
    assert Duplicate.masks and Duplicate.repeats


@pytest.mark.parametrize(("back", "length"), [(300, 300), (900, 900), (300, 100)])
def test_a_replay_is_masked(back, length):
    values, time = rest(2000), stamps(2000)
    rows = np.concatenate([np.arange(900), np.arange(length) + 900 - back, np.arange(900, 2000)])
    found = causes(piece(values[rows], time[rows]))
    assert set(found) == {"duplicate"}  # that time goes back is no second fault
    (event,) = found["duplicate"]
    assert (event.first, event.after) == (900, 900 + length)


@pytest.mark.parametrize(("back", "length"), [(40, 40), (300, 20), (40, 80)])
def test_records_that_are_copied_are_found_without_stamps_that_would_tell(back, length):
    values = rest(4000, 2, MEMS, MEMS)
    rows = np.concatenate([np.arange(900), 900 - back + np.arange(length) % back])
    rows = np.append(rows, np.arange(900, 4000))
    (event,) = causes(piece(values[rows], stamps(len(rows))))["held_record"]
    assert (event.first, event.after, event.facts.copied) == (900, 900 + length, 900 - back + 1)
    assert event.p_value < 1e-6 and HeldRecord.masks


def test_what_stands_still_or_swings_alike_is_no_copy():
    values = rest(4000, 2, MEMS, MEMS)
    values[1000:1400] = values[1000]  # as before the noise of a channel reaches a count
    values[2000:2100] = values[1300]
    events = seen(HeldRecord(), piece(values, stamps(4000)))
    assert all(event.facts.copied is None for event in events)
    swing = np.round(np.sin(2 * np.pi * np.arange(4000) / 100)[:, None] * np.arange(4, 10)) * MEMS
    assert not causes(piece(rest(4000, 3, MEMS, MEMS) + swing, stamps(4000)))


def test_repeated_rows_are_found_where_sensors_have_rows_of_their_own():
    rows, time = alternating(500)
    twice = np.insert(np.arange(1000), 402, [400, 401])  # both rows of one sample come again
    (event,) = seen(Duplicate(), piece(rows[twice], time[twice]))
    assert (event.first, event.after) == (402, 404)


@pytest.mark.parametrize("times", [1, 3, 200])
def test_a_held_record_is_masked_though_time_passes(times):
    values = rest(3000)
    values[901 : 901 + times] = values[900]
    found = causes(piece(values, stamps(3000)))
    assert set(found) == {"held_record"}
    (event,) = found["held_record"]
    assert (event.first, event.after, event.size) == (901, 901 + times, times)
    assert event.p_value < 1e-3
    assert HeldRecord.masks and not HeldRecord.repeats


def test_the_chance_of_a_held_record_is_that_of_all_logs():
    values = rest(3000)
    values[901] = values[900]
    one = piece(values, stamps(3000))
    (alone,) = causes(one)["held_record"]
    (of_two,) = causes(one, records_of_all=6000)["held_record"]
    assert of_two.p_value == pytest.approx(2 * alone.p_value)
    assert not causes(one, records_of_all=int(2e-3 / alone.p_value * 3000))


def test_a_held_record_is_found_beside_dead_axes_and_in_rows_of_its_own():
    values = rest(3000)
    values[:, 2] = 0.0
    values[901:903] = values[900]
    (event,) = seen(HeldRecord(), piece(values, stamps(3000)))
    assert (event.first, event.facts.channels) == (901, 5)
    rows, time = alternating(2000)
    rows[802] = rows[800]
    rows[804] = rows[800]
    events = seen(HeldRecord(), piece(rows, time))
    assert [(event.first, event.after) for event in events] == [(802, 803), (804, 805)]


def test_a_long_run_is_no_chance_with_coarse_counts_either():
    values = rest(20_000, 3, MEMS, 3 * MEMS)
    values[5000:5100] = values[5000]
    (event,) = seen(HeldRecord(), piece(values, stamps(20_000)))
    assert event.first == 5001
    assert event.after == pytest.approx(5100, abs=5)  # those after it may be equal by chance


def test_every_second_record_held_is_a_slower_sensor():
    values = rest(4000)
    values[1::2] = values[0::2]
    assert len(seen(HeldRecord(), piece(values, stamps(4000)))) > 1000


def test_what_the_instrument_calls_invalid_is_masked():
    one = piece(rest(1000), stamps(1000))
    one.status[300:310] = 0x76
    (event,) = seen(StatusInvalid(), one)
    assert (event.first, event.after, event.size) == (300, 310, 10)
    told = StatusInvalid().describe(event, "log").sentence
    assert "status 00000076, bit 0 is not set" in told
    one.status[:] = float(0x80000000)
    failed = given(must_be_set=0, must_be_clear=0xF8000000)
    (event,) = seen(StatusInvalid(), one, failed)
    assert "bit 31 is set" in StatusInvalid().describe(event, "log").sentence


# ---- the order of time


@pytest.mark.parametrize(("back", "records"), [(9.0, 800), (0.5, 49), (0.02, 1)])
def test_time_that_goes_back_is_named_until_it_has_passed_its_maximum(back, records):
    time = stamps(2000)
    time[1200:] -= back
    found = causes(piece(rest(2000), np.round(time, 9)))
    assert set(found) == {"time_backwards"}
    (event,) = found["time_backwards"]
    assert (event.first, event.after - event.first) == (1200, records)
    assert event.size == pytest.approx(back - INTERVAL)
    assert event.from_s == event.to_s == pytest.approx(12.0 - back)
    assert not TimeBackwards.masks


@pytest.mark.parametrize("length", [1, 5])
def test_stamps_that_are_ahead_are_told_from_the_others(length):
    time = stamps(2000)
    time[1200 : 1200 + length] += 888.0
    found = causes(piece(rest(2000), time))
    assert set(found) == {"time_backwards"}  # and no gap of 88,800 samples
    (event,) = found["time_backwards"]
    assert (event.first, event.after) == (1200, 1200 + length)
    assert event.size == pytest.approx(888.0)


def test_a_piece_knows_how_far_time_had_come_before_it():
    values, time = rest(2000), stamps(2000)
    time[500:] -= 12.0
    second = piece(values[1000:], time[1000:], record=np.arange(1000, 2000), reached=4.995)
    (event,) = seen(TimeBackwards(), second)
    assert (event.first, event.after) == (1000, 1700)


def test_a_stamp_that_stands_still_is_masked():
    time = stamps(2000)
    time[700:703] = time[699]
    found = causes(piece(rest(2000), time))
    (event,) = found["time_stands_still"]
    assert (event.first, event.after, event.size) == (700, 703, 3)


def test_a_gap_beside_other_faults_of_time_keeps_its_size():
    values, time = rest(3000), stamps(3000)
    kept = np.r_[0:1000, 1037:2000, 1900:2000, 2000:3000]
    found = causes(piece(values[kept], time[kept]))
    (event,) = found["gap"]
    assert event.size == 37


# ---- the clock


@pytest.mark.parametrize(("broken", "said"), [(3, "has 3 lines that cannot be read"), (0, "")])
def test_a_gap_tells_lines_that_cannot_be_read_from_samples_that_were_lost(broken, said):
    values, keep = rest(400), np.delete(np.arange(400), [200, 201, 202])
    lines = keep + 1 if broken else np.arange(397) + 1
    one = piece(values[keep], np.round(INTERVAL * keep, 9), line=lines)
    (event,) = seen(Gap(), one)
    described = Gap().describe(event, "a.csv")
    assert (said in described.sentence) and ("damages" in described.action) == bool(broken)


@pytest.mark.parametrize("sigma", [0.02, 0.1, 0.3])
def test_jitter_is_measured_and_makes_no_gap(sigma):
    generator = np.random.default_rng(5)
    time = stamps(6000) + sigma * INTERVAL * generator.standard_normal(6000)
    one = piece(rest(6000), np.round(time, 9))
    (event,) = seen(ClockJitter(), one)
    assert event.size == pytest.approx(sigma * INTERVAL, rel=0.15)
    assert event.after - event.first > 5900
    if sigma <= 0.1:
        assert set(causes(one)) == {"clock_jitter"}


def test_stamps_of_whole_milliseconds_are_told_as_rounded():
    time = np.round(np.arange(1000) * 11.88e-3, 3)
    one = piece(rest(1000), time)
    whole = given(interval=11.88e-3)
    (event,) = seen(ClockJitter(), one, whole, recorded_on=None, interval=11.88e-3)
    assert event.size == pytest.approx(1e-3 / np.sqrt(12), rel=0.1)
    told = ClockJitter().describe(event, "log").sentence
    assert "rounded to 1 ms: 11 ms and 12 ms take turns, where 11.88 ms pass" in told
    assert set(causes(one, whole, recorded_on=None, interval=11.88e-3)) == {"clock_jitter"}


def test_jitter_in_a_part_of_a_log_is_found_there():
    time = stamps(6000)
    time[2000:3000] += 3e-4 * np.random.default_rng(5).standard_normal(1000)
    (event,) = seen(ClockJitter(), piece(rest(6000), np.round(time, 9)))
    assert event.first == pytest.approx(2000, abs=32)
    assert event.after == pytest.approx(3000, abs=32)


def test_gaps_dropped_samples_and_jumps_are_no_jitter():
    time = stamps(6000)
    time[3000:] += 3.3e-3
    kept = np.flatnonzero(np.random.default_rng(2).random(6000) > 0.1)
    assert not seen(ClockJitter(), piece(rest(6000)[kept], time[kept]))


FAST = [(20e-6, 500, 1500), (-20e-6, 500, 1999), (1e-2, 300, 600), (5e-4, 100, 1999)]


@pytest.mark.parametrize(("excess", "start", "end"), FAST)
def test_stamps_that_run_fast_for_a_stretch(excess, start, end):
    values, time = rest(2000), stamps(2000)
    time = time + excess * (np.clip(time, time[start], time[end]) - time[start])
    one, usual = piece(values, np.round(time, 9)), given(usual_interval=INTERVAL, unlike=0.0)
    found = causes(one, usual)
    assert set(found) == {"clock_scale"}
    (event,) = found["clock_scale"]
    assert event.size == pytest.approx(excess * 1e6, abs=0.2)
    assert event.first == pytest.approx(start + 1, abs=2)
    assert event.after == pytest.approx(end + 1, abs=2)
    # In a single log it is not told which part is right, but that they differ.
    alone = seen(ClockScale(), one, given())
    assert {round(abs(event.size) / abs(excess) / 1e6, 1) for event in alone} == {1.0}


@pytest.mark.parametrize("back", [True, False])
def test_a_stretch_whose_stamps_jump_back_to_the_true_time(back):
    time = stamps(4000)
    fast = time.copy()
    fast[1000:2000] += 200e-6 * (time[1000:2000] - time[1000])
    found = seen(ClockScale(), piece(rest(4000), np.round(fast if back else time, 9)))
    assert [round(event.size) for event in found] == [200] * back
    jump = time + np.where(time > 20.0, 1e-3, 0.0)
    assert not seen(ClockScale(), piece(rest(4000), np.round(jump, 9)))


def test_increments_tell_whether_the_stamps_are_off_or_the_sampling():
    excess = 200e-6
    time = stamps(4000)
    slower = time + excess * (np.clip(time, 10.0, 20.0) - 10.0)
    values = rest(4000, noise=NOISE, count=COUNT * 1e-6)
    (event,) = seen(ClockScale(), piece(values, np.round(slower, 9)))
    assert event.facts.evidence.stamps is True
    assert "the stamps run fast by 200 ppm" in ClockScale().describe(event, "log").sentence
    values[1001:2001] *= 1 + excess  # the samples do take longer
    (event,) = seen(ClockScale(), piece(values, np.round(slower, 9)))
    assert event.facts.evidence.stamps is False
    assert "the sampling is off, not the stamps" in ClockScale().describe(event, "log").sentence
    (event,) = seen(ClockScale(), piece(values, np.round(slower, 9)), recorded_on=None)
    assert event.facts.evidence.stamps is None


@pytest.mark.parametrize("excess", [20e-6, -500e-6, 9e-3])
def test_a_whole_log_that_runs_fast_is_told_from_the_others(excess):
    one = piece(rest(2000), np.round(stamps(2000) * (1 + excess), 9))
    (event,) = seen(ClockScale(), one, given(usual_interval=INTERVAL, unlike=1e-9))
    assert event.size == pytest.approx(excess * 1e6, abs=0.2)
    assert (event.first, event.after) == (0, 2000)


def test_one_log_is_compared_with_the_stated_rate_as_far_as_a_crystal_keeps_it():
    for ppm, named in ((90, False), (150, True), (9000, True), (30_000, False)):
        one = piece(rest(2000), np.round(stamps(2000) * (1 + ppm * 1e-6), 9))
        assert bool(seen(ClockScale(), one)) == named
        assert bool(seen(RateOff(), one)) == (ppm > 10_000)
    one = piece(rest(2000), np.round(stamps(2000, 1 / 83.33), 9))
    assert not seen(ClockScale(), one, given(interval=1 / 83.3))  # stated to three digits


def test_a_whole_campaign_that_is_off_is_one_finding():
    one = piece(rest(2000), np.round(stamps(2000) * 1.005, 9))
    # Increments of samples of 10 ms, made rates with 10.05 ms.
    one.values[:] /= 1.005
    usual = given(usual_interval=INTERVAL * 1.005, unlike=0.0)
    logs = {name: log(one, usual) for name in ("a", "b", "c")}
    assert not any(list(ClockScale().detect(one, own)) for own in logs.values())
    (event,) = ClockScale().detect_between_logs(logs)
    assert_told(ClockScale(), event, "")
    assert event.size == pytest.approx(5000)
    assert event.facts.evidence.stamps is True
    assert not list(
        ClockScale().detect_between_logs({"a": log(one, given(usual_interval=INTERVAL))})
    )


def test_logs_that_are_unlike_anyway_are_not_compared():
    one = piece(rest(2000), np.round(stamps(2000) * 1.003, 9))
    assert not seen(ClockScale(), one, given(usual_interval=INTERVAL, unlike=4e-3))


@pytest.mark.parametrize(("stated", "said"), [(200, "÷2"), (50, "×2"), (103, "factor 0.9709")])
def test_another_rate_is_named_with_its_factor(stated, said):
    (event,) = seen(RateOff(), piece(rest(500), stamps(500)), given(interval=1 / stated))
    assert event.size == pytest.approx(100 / stated)
    assert said in RateOff().describe(event, "log").sentence


@pytest.mark.parametrize(
    ("factor", "likely", "stated"), [(1e3, "ms", "s"), (1.002e9, "ns", "s"), (1e-6, "s", "µs")]
)
def test_a_thousand_times_the_interval_is_another_unit_of_the_time(factor, likely, stated):
    one = piece(rest(500), np.arange(500) * INTERVAL * factor)
    (event,) = seen(WrongTimeUnit(), one)
    assert not seen(RateOff(), one)
    sentence = WrongTimeUnit().describe(event, "log").sentence
    assert sentence.endswith(f"as if the time were in {likely} where {stated} is stated.")


def test_a_rate_that_is_off_by_no_unit_is_none():
    for factor in (1.0, 1000 * 1.02, 250.0, 1e12):
        assert not seen(WrongTimeUnit(), piece(rest(500), np.arange(500) * INTERVAL * factor))


@pytest.mark.parametrize(
    ("recorded", "stated", "days"),
    [
        ("2023-10-08", "2023-10-18", 10),
        ("2023-10-08", "2023-10-09", None),
        ("2023-10-08", "2023-10-07", None),
        ("2023-10-08", "2023-10-06", 2),
        ("2004-02-22", "2023-10-08", 7168),
        (None, "2023-10-18", None),
        ("2023-10-08", "unknown", None),
    ],
)
def test_another_day_is_named(recorded, stated, days):
    """S0: GPS week 2283 gives 8 October where the report says 18 October."""
    one = piece(rest(500), stamps(500))
    events = seen(WrongDay(), one, given(date=stated), recorded_on=recorded)
    assert [event.size for event in events] == [days] * (days is not None)
    if days == 7168:
        assert "1024 weeks" in WrongDay().describe(events[0], "log").sentence


# ---- a clock that is set


@pytest.mark.parametrize("step", [2e-3, -2e-3, 4.4e-3, -9e-3, 0.3e-3])
def test_a_clock_that_is_set_is_named_with_its_step(step):
    time = stamps(2000)
    time[700:] += step
    found = causes(piece(rest(2000), time))
    assert set(found) == {"clock_step"}
    (event,) = found["clock_step"]
    assert event.size == pytest.approx(abs(step), abs=1e-7)
    assert event.facts == (step > 0)
    assert event.line == 701


def test_a_stamp_that_is_late_by_itself_sets_no_clock():
    time = stamps(2000)
    time[700] += 4e-3
    assert not causes(piece(rest(2000), time))


def test_scattered_and_rounded_stamps_set_no_clock():
    scatter = np.random.default_rng(5).normal(0, 1e-3, 2000)
    for time in (stamps(2000) + scatter, np.round(np.arange(2000) * 11.888e-3, 3)):
        assert "clock_step" not in causes(piece(rest(2000), np.sort(time)))


def test_an_interval_that_whole_milliseconds_do_not_divide_sets_no_clock():
    """9.999 ms, as of the Xsens MTi of imu_tk: every thousandth stamp is a millisecond early."""
    time = np.round(np.arange(6000) * 9.999e-3, 3)
    assert "clock_step" not in causes(piece(rest(6000), time))


def test_stamps_of_six_digits_set_no_clock_where_they_lose_one():
    """The same, written as 99.9927, 100.003: from 100 s on the last digit is a millisecond."""
    time = np.array([float(f"{9.999e-3 * n + 2.8e-3:.6g}") for n in range(40000)])
    assert "clock_step" not in causes(piece(rest(len(time)), time))


@pytest.mark.parametrize("first", [True, False], ids=["shorter part first", "longer part first"])
def test_the_interval_of_most_of_a_log_is_the_reference(first):
    """Neither part has the stated rate; the one with fewer records is the one that differs."""
    few, many = 800, 2400
    intervals = np.r_[np.full(few, 0.01172), np.full(many, 0.01167)]
    time = np.append(0.0, np.cumsum(intervals if first else intervals[::-1]))
    readings = rest(len(time))
    (event,) = seen(ClockScale(), piece(readings, time), given(interval=np.nan), recorded_on=None)
    assert abs(event.after - event.first - few) < 20
    assert event.size == pytest.approx((0.01172 / 0.01167 - 1) * 1e6, rel=0.02)
