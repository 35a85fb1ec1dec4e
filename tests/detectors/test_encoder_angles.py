"""Encoders that read turns otherwise than planned, by no one ratio."""

from types import SimpleNamespace

import numpy as np
import pytest

from inertial.campaign.encoder import largest_jump
from inertial.detectors.encoder_against_plan import EncoderAngles, EncoderScale

ARC_SECOND = np.pi / 648_000
ROUND = 1_296_000  # arcsec
SENSES = np.array([1, -1] * 6)
ABOUT = np.repeat(np.eye(3), 4, axis=0)


def turns(beside, gyros, jumps=np.nan):
    """12 turns of 360° there and back, four about each axis; arcsec in the sense of each turn.

    beside: of the encoder beyond the plan; gyros: of the true turn, NaN where they do not tell.
    """
    scales = np.repeat([6e-4, -2.5e-3, 1.6e-3], 4)
    stated = 2 * np.pi * SENSES
    return SimpleNamespace(
        about=ABOUT,
        angle=stated + SENSES * beside * ARC_SECOND,
        stated_angle=stated,
        angle_sigma=2 * ARC_SECOND,
        turned_farther=SENSES * (2 * np.pi + np.asarray(gyros) * ARC_SECOND) * (1 + scales),
        encoder_jump=np.full(12, jumps),
        encoder_jump_at=np.radians(140.0 + 360.0 * (np.arange(12) % 2)),
        found=np.ones(12, bool),
        steady=np.zeros(12, bool),
        name=[f"turn-{i}" for i in range(12)],
    )


def test_an_encoder_with_another_offset_in_each_sense_is_contradicted_by_the_gyros():
    """It reads 360.10° there and 360.05° back, where the table turns 360°: 208 ppm on the mean."""
    random = np.random.default_rng(2)
    beside = np.where(SENSES > 0, 360, 180) + 2 * random.standard_normal(12)
    recorded = turns(beside, 33 * random.standard_normal(12), np.radians(0.05))
    assert not list(EncoderScale().detect(recorded))
    [found] = EncoderAngles().detect(recorded)
    assert (found.count, found.sensor, EncoderAngles.severity) == (12, "gyro", 3)
    assert found.size == pytest.approx(270 / ROUND, rel=0.02)
    said = EncoderAngles().describe(found, recorded)
    assert "as the plan has it" in said.sentence
    assert "jumps by 0.050°" in said.sentence and "reads 140°" in said.sentence
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
        assert "By the gyros" not in said.sentence and "jumps" not in said.sentence
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


@pytest.mark.parametrize("step", [180.0, -60.0])
@pytest.mark.parametrize("counts", [1.0, -1.0])
def test_a_jump_of_the_encoder_that_no_gyro_feels(step, counts):
    time, angle, gyro = read_at(step)
    jump = largest_jump(time, counts * angle, gyro)
    assert jump.size / ARC_SECOND == pytest.approx(counts * step, abs=10)
    assert np.degrees(jump.at) == pytest.approx(counts * 140, abs=1)


def test_what_is_no_jump():
    time, angle, gyro = read_at(0.0)
    assert np.isnan(largest_jump(time, angle, gyro).size)
    # The table itself stumbles by 0.3°, or 5 s of the log are missing: the gyros feel as much.
    stumble = np.where(np.abs(time - 5) < 0.03, 5.0, 0.0)
    together = angle + np.radians(np.cumsum(stumble) * 0.01)
    assert np.isnan(largest_jump(time, together, gyro + np.radians(stumble)).size)
    there = (time < 3) | (time > 8)
    assert np.isnan(largest_jump(time[there], angle[there], gyro[there]).size)
    # A ripple of the encoder is none either.
    ripple = angle + 100 * ARC_SECOND * np.sin(12 * angle)
    assert np.isnan(largest_jump(time, ripple, gyro).size)
