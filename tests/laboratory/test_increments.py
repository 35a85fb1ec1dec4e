"""Counts, noise and lost samples: what the receiver makes of the sensors."""

import zlib
from collections.abc import Callable
from math import radians, sqrt
from typing import Any

import numpy as np
import pytest

from laboratory import Recording, perform, specify
from laboratory.counts import count

Performed = Callable[..., Recording]


def test_no_sum_of_counts_is_off_by_more_than_one_count(demo_recording: Recording) -> None:
    truth = demo_recording.truth["y-forward.asc"]
    for counts, running, size in (
        (truth.gyro, truth.noisy.gyro, 0.1 / (3600 * 256)),
        (truth.accelerometer, truth.noisy.accelerometer, 0.05 / 2**15),
    ):
        off = np.cumsum(counts, axis=0) - running / size
        assert np.abs(off).max() <= 0.5 + 1e-6
        # of any stretch from one sample to another: the difference of two such
        assert np.ptp(off, axis=0).max() <= 1 + 1e-6


def test_a_rate_below_one_count_is_carried_until_it_makes_one() -> None:
    counts = count(np.outer(np.arange(1, 1001), [0.1, -0.25, 0.0]), 1.0)
    assert counts.sum(axis=0).tolist() == [100, -250, 0]
    assert np.abs(counts).max() == 1


def test_white_noise_has_the_variance_of_its_random_walk(performed: Performed) -> None:
    """Sums over 1 s scatter by N²·1 s; 1200 of them agree within 5 sigma, √(2/1200) each."""
    truth = performed(
        {"id": "still", "do": "rest", "up": "+z", "seconds": 400},
        angle_random_walk_deg_sqrt_h=0.12,
        velocity_random_walk_m_s_sqrt_h=0.0064,
    ).truth["all.asc"]
    for noisy, noiseless, expected in (
        (truth.noisy.gyro, truth.noiseless.gyro, radians(0.12) / 60),
        (truth.noisy.accelerometer, truth.noiseless.accelerometer, 0.0064 / 60),
    ):
        sums = np.diff((noisy - noiseless)[::100], axis=0)
        assert np.mean(sums**2) / expected**2 == pytest.approx(1, abs=5 * sqrt(2 / sums.size))
        between = np.asarray(np.corrcoef(sums.T))[np.triu_indices(3, 1)]
        assert between == pytest.approx(0, abs=5 / sqrt(400))
        # white: neighbouring samples know nothing of each other
        single = np.diff(noisy - noiseless, axis=0)
        follow = np.mean(single[1:] * single[:-1]) / np.mean(single**2)
        assert follow == pytest.approx(0, abs=5 / sqrt(single.size))


def test_the_bias_wanders_on_through_the_pauses(ideal: Callable[..., dict[str, Any]]) -> None:
    """Twelve logs of 1 s, pauses of 59 s: the steps of the bias have the variance K² 60 s."""
    plan = [
        {"id": f"p{k}", "do": "rest", "up": "+z", "seconds": 1, "log": f"p{k}.asc"}
        for k in range(120)
    ]
    document = ideal(*plan, gyro_rate_random_walk_deg_h_sqrt_h=3)
    document["start"]["pause_s"] = 59.01
    logs = perform(specify(document)).truth.values()
    bias = np.array([(log.noisy.gyro - log.noiseless.gyro)[-1] / 1.0 for log in logs])
    steps = np.diff(bias, axis=0)
    expected = (radians(3) / 3600) ** 2 / 3600 * 60
    assert np.mean(steps**2) / expected == pytest.approx(1, abs=5 * sqrt(2 / steps.size))


def test_the_same_seed_gives_the_same_bytes_and_another_seed_others(
    ideal: Callable[..., dict[str, Any]],
) -> None:
    rest = {"id": "still", "do": "rest", "up": "+z", "seconds": 5}
    document = ideal(rest, velocity_random_walk_m_s_sqrt_h=0.01)
    once, again = perform(specify(document)), perform(specify(document))
    other = perform(specify(document | {"seed": 2}))
    assert once.logs == again.logs
    assert once.logs != other.logs


def test_an_effect_does_not_change_the_noise_of_the_others(
    ideal: Callable[..., dict[str, Any]],
) -> None:
    rest = {"id": "still", "do": "rest", "up": "+z", "seconds": 5}
    document = ideal(rest, velocity_random_walk_m_s_sqrt_h=0.01)
    ramp = {"accel_bias_ramp": {"ramp_m_s2_h": [1, 1, 1]}}
    noises = [
        truth.noisy.accelerometer - truth.noiseless.accelerometer
        for changed in (document, document | {"effects": ramp})
        for truth in perform(specify(changed)).truth.values()
    ]
    assert noises[0] == pytest.approx(noises[1], abs=1e-12)


def test_the_demo_loses_what_s0_lost(demo_recording: Recording) -> None:
    """1197 samples after line 2192, 21.91 s into the log: 11.98 s from line to line, 119.8°."""
    lines = demo_recording.logs["z-backward.asc"].splitlines()
    seconds = np.array([float(line.split(b",")[3]) for line in lines])
    gaps = np.diff(seconds)
    assert len(lines) == 5800 - 1197
    assert int(np.argmax(gaps)) == 2191
    assert gaps[2191] == pytest.approx(11.98, abs=1e-6)
    assert np.delete(gaps, 2191) == pytest.approx(0.01, abs=1e-6)
    assert seconds[2191] - seconds[0] == pytest.approx(21.91, abs=1e-6)
    lost = demo_recording.truth["z-backward.asc"].gyro[2192 : 2192 + 1197, 2].sum()
    assert np.degrees(lost * 0.1 / (3600 * 256)) == pytest.approx(-119.8, abs=0.1)


def test_the_demo_is_a_campaign_of_s0(demo_recording: Recording) -> None:
    """Twelve logs in turn, every line with its checksum, a minute's pause between the logs."""
    assert sum(log.count(b"\r\n") for log in demo_recording.logs.values()) == 214_800 - 1197
    stamps = []
    for log in demo_recording.logs.values():
        lines = log.splitlines()
        for line in (lines[0], lines[len(lines) // 2], lines[-1]):
            text, _, checksum = line[1:].partition(b"*")
            assert int(checksum, 16) == zlib.crc32(text, 0xFFFFFFFF) ^ 0xFFFFFFFF
        stamps.append((float(lines[0].split(b",")[3]), float(lines[-1].split(b",")[3])))
    first, last = np.array(stamps).T
    assert first[1:] - last[:-1] == pytest.approx(60, abs=1e-6)
    assert demo_recording.campaign["simulated"] is True
    # S0's z backward turn at its gap reads 64188, −64, 465 and −16100; ours stands as askew.
    counts = demo_recording.truth["z-backward.asc"]
    assert counts.accelerometer[1500:4000].mean(axis=0) == pytest.approx([453, -17, 64187], abs=5)
