"""Encoders that jump, and that read turns otherwise than planned."""

from types import SimpleNamespace

import numpy as np
import pytest

from inertial.campaign.encoder import jumps_of
from inertial.detectors.encoder_against_plan import (
    EncoderAngles,
    EncoderJump,
    EncoderScale,
    EncoderScaleOrEccentricity,
)

ARC_SECOND = np.pi / 648_000
ROUND = 1_296_000  # arcsec
SENSES = np.array([1, -1] * 6)
ABOUT = np.repeat(np.eye(3), 4, axis=0)


def turns(beside, gyros, jumps=(), degrees=360.0):
    """12 turns there and back, four about each axis; arcsec in the sense of each turn.

    beside: of the encoder beyond the plan; gyros: of the true turn, NaN where they do not tell.
    jumps: of the encoder, of each turn from the first on.
    """
    scales = np.repeat([6e-4, -2.5e-3, 1.6e-3], 4)
    stated = np.radians(degrees) * SENSES
    return SimpleNamespace(
        about=ABOUT,
        angle=stated + SENSES * beside * ARC_SECOND,
        stated_angle=stated,
        angle_sigma=2 * ARC_SECOND,
        turned_farther=SENSES
        * (np.radians(degrees) + np.asarray(gyros) * ARC_SECOND)
        * (1 + scales),
        jump_turn=np.arange(len(jumps)),
        jump_size=np.array(jumps) * ARC_SECOND,
        jump_sigma=np.full(len(jumps), 2 * ARC_SECOND),
        jump_at=np.radians(140.0 + 360.0 * (np.arange(len(jumps)) % 2)),
        log=["session.csv"] * 12,
        first=np.arange(12),
        after=np.arange(1, 13),
        from_s=np.arange(12.0),
        to_s=np.arange(1.0, 13),
        found=np.ones(12, bool),
        steady=np.zeros(12, bool),
        name=[f"turn-{i}" for i in range(12)],
    )


def test_an_encoder_with_another_offset_in_each_sense_is_contradicted_by_the_gyros():
    """It reads 360.10° there and 360.05° back, where the table turns 360°: 208 ppm on the mean."""
    random = np.random.default_rng(2)
    beside = np.where(SENSES > 0, 360, 180) + 2 * random.standard_normal(12)
    recorded = turns(beside, 33 * random.standard_normal(12))
    assert not list(EncoderScale().detect(recorded))
    [found] = EncoderAngles().detect(recorded)
    assert (found.count, found.sensor, EncoderAngles.severity) == (12, "gyro", 3)
    assert found.size == pytest.approx(270 / ROUND, rel=0.02)
    said = EncoderAngles().describe(found, recorded)
    assert "as the plan has it" in said.sentence
    assert f"{1e6 * found.size:.0f} ppm" in said.consequence


def test_turns_that_stop_elsewhere_in_each_sense_are_believed_where_the_gyros_say_so():
    for seed in range(100):
        random = np.random.default_rng(seed)
        stops = np.where(SENSES > 0, 360, 180)
        gyros = stops + 33 * random.standard_normal(12)
        recorded = turns(stops + 2 * random.standard_normal(12), gyros)
        assert not list(EncoderAngles().detect(recorded))


def test_where_the_gyros_do_not_tell_both_are_named_only_if_the_mean_is_off():
    found = 0
    for seed in range(200):
        random = np.random.default_rng(seed)
        read = 2 * random.standard_normal(12)
        offset = turns(np.where(SENSES > 0, 360, 180) + read, np.full(12, np.nan))
        [one] = EncoderAngles().detect(offset)
        said = EncoderAngles().describe(one, offset)
        assert "Either the encoder is off, or the table" in said.sentence
        assert "By the gyros" not in said.sentence
        anywhere = turns(300 * random.standard_normal(12) + read, np.full(12, np.nan))
        found += len(list(EncoderAngles().detect(anywhere)))
        assert not list(EncoderAngles().detect(turns(read, np.full(12, np.nan))))
    assert found <= 2  # by chance 0.2


def test_turns_that_are_off_alike_or_about_unknown_axes_end_no_run():
    alike = turns(np.full(12, 15.0), np.full(12, np.nan))
    assert len([*EncoderScale().detect(alike), *EncoderAngles().detect(alike)]) == 1
    unknown = turns(np.where(SENSES > 0, 360.0, 180.0), np.zeros(12))
    unknown.about = np.full((12, 3), np.nan)
    [found] = EncoderAngles().detect(unknown)
    assert found.size == pytest.approx(270 / ROUND, rel=1e-6)


def test_one_turn_that_the_encoder_has_otherwise_is_named_once():
    random = np.random.default_rng(3)
    beside = np.where(np.arange(12) == 6, -287.0, 0) + 2 * random.standard_normal(12)
    recorded = turns(beside, 2 * random.standard_normal(12))
    [found] = EncoderAngles().detect(recorded)
    said = EncoderAngles().describe(found, recorded).sentence
    assert said.count("turn-6") == 1 and f"by −{-beside[6]:.0f}″ in its sense" in said


def test_jumps_are_a_cause_of_their_own_with_size_and_place():
    recorded = turns(np.zeros(12), np.zeros(12), [180.0] * 12)
    [found] = EncoderJump().detect(recorded)
    assert found.count == 12 and found.size == pytest.approx(180 * ARC_SECOND)
    said = EncoderJump().describe(found, recorded)
    assert "In 12 turns" in said.sentence and "jumps by 0.050°" in said.sentence
    assert "reads 140°" in said.sentence
    assert "140 ppm" in said.consequence and "2.0″" in said.consequence  # 180″ of 360°
    one = turns(np.zeros(12), np.zeros(12), [-288.0])
    [found] = EncoderJump().detect(one)
    assert (found.at, found.count) == (0, 1)
    assert "In turn-0 the encoder's angle jumps by −0.080°" in (
        EncoderJump().describe(found, one).sentence
    )
    assert not list(EncoderJump().detect(turns(np.zeros(12), np.zeros(12))))


@pytest.mark.parametrize("phase", [0.7, -2.0])
def test_an_encoder_off_its_axis_reads_half_turns_alike_and_whole_ones_right(phase):
    """By ε sin(a + φ) at its angle a; half turns go from 0 to 180° and back."""
    random = np.random.default_rng(5)
    beside = 72 * (np.sin(np.pi + phase) - np.sin(phase)) + random.standard_normal(12)
    half = turns(beside, np.full(12, np.nan), degrees=180.0)
    assert not list(EncoderScale().detect(half))
    [found] = EncoderScaleOrEccentricity().detect(half)
    said = EncoderScaleOrEccentricity().describe(found, half)
    # What they go too far by is 2 ε sin φ, of an ε that is 72″ or less.
    assert f"{72 * abs(np.sin(phase)):.0f}″ or more" in said.sentence
    assert "whole revolutions" in said.action
    whole = turns(np.full(12, -93.0), np.full(12, np.nan))
    assert not list(EncoderScaleOrEccentricity().detect(whole))
    assert len(list(EncoderScale().detect(whole))) == 1


def read_at(step_arcsec, seconds=11.0, rate=30.0):
    """A gyro at 100 Hz, an encoder at 50 Hz that counts 0.36″, interpolated; it is 4 ms late."""
    random = np.random.default_rng(7)
    time = 0.01 * np.arange(round(100 * seconds) + 1)
    gyro = np.radians(rate) * (1 - 3e-3) + 1e-4 + 4.4e-4 * random.standard_normal(len(time))
    of_encoder = time[::2]
    true = rate * (of_encoder - 0.004) + 20.0
    read = true + step_arcsec / 3600 * (true > 140.0)
    read = np.interp(time, of_encoder, 1e-4 * np.round(read / 1e-4))
    return time, np.radians(read), gyro


def jumps_at(time, angle, gyro):
    return jumps_of(np.arange(len(time)), time, angle, gyro)


@pytest.mark.parametrize("step", [180.0, -60.0])
@pytest.mark.parametrize("counts", [1.0, -1.0])
def test_a_jump_of_the_encoder_that_no_gyro_feels(step, counts):
    time, angle, gyro = read_at(step)
    [jump] = jumps_at(time, counts * angle, gyro)
    off = jump.size / ARC_SECOND - counts * step
    assert abs(off) < 4 * jump.sigma / ARC_SECOND and jump.sigma < 10 * ARC_SECOND
    assert np.degrees(jump.at) == pytest.approx(counts * 140, abs=1)
    assert time[jump.before] <= 4.0 + 0.01 <= time[jump.after] + 0.02  # 120° at 30 °/s


def test_every_jump_of_a_turn_is_found():
    time, angle, gyro = read_at(0.0)
    both = angle + 120 * ARC_SECOND * ((time > 3.0) + 0.5 * (time > 7.0))
    sizes = [jump.size / ARC_SECOND for jump in jumps_at(time, both, gyro)]
    assert sizes == pytest.approx([120, 60], abs=12)


@pytest.mark.parametrize("late", [0.0, 0.06, 0.12, 0.15, -0.12, -0.15])
@pytest.mark.parametrize("step", [0.0, 120.0])
def test_an_encoder_that_is_late_still_accelerates_at_the_edge_and_jumps_elsewhere(late, step):
    """At 60 °/s² to 72 °/s: 22 ms into the steady part by the gyros it lacks 0.015°, 52″."""
    random = np.random.default_rng(11)
    margin, duration, rate, acceleration = 0.098, 4.0, 72.0, 60.0
    time = 0.01 * np.arange(round(100 * duration) + 1)
    # The table is steady from −margin to duration + margin; its angle, of ramps at either side.
    beyond = np.maximum(0, -margin - (time - late)), np.maximum(0, time - late - duration - margin)
    true = rate * (time - late) + 0.5 * acceleration * (beyond[0] ** 2 - beyond[1] ** 2)
    read = true + step / 3600 * (true > 140)
    counts = np.radians(5e-4 * np.round(read / 5e-4))
    gyro = np.radians(rate) + 8.7e-5 * random.standard_normal(len(time))
    sizes = [jump.size / ARC_SECOND for jump in jumps_at(time, counts, gyro)]
    assert sizes == pytest.approx([step] * (step > 0), abs=12)


def test_what_is_no_jump():
    time, angle, gyro = read_at(0.0)
    assert not jumps_at(time, angle, gyro)
    # The table itself stumbles by 0.3°, or 5 s of the log are missing: the gyros feel as much.
    stumble = np.where(np.abs(time - 5) < 0.03, 5.0, 0.0)
    together = angle + np.radians(np.cumsum(stumble) * 0.01)
    assert not jumps_at(time, together, gyro + np.radians(stumble))
    there = (time < 3) | (time > 8)
    assert not jumps_at(time[there], angle[there], gyro[there])
    # A ripple of the encoder is none either.
    assert not jumps_at(time, angle + 100 * ARC_SECOND * np.sin(12 * angle), gyro)
    # Nor is one reading of the encoder that is off, or of the gyro.
    once = np.where(np.arange(len(time)) == 500, 1.0, 0.0)
    assert not jumps_at(time, angle + 200 * ARC_SECOND * once, gyro)
    assert not jumps_at(time, angle, gyro + 0.6 * once)
