"""Unsigned counts are recognised by their zero, and signed ones are not taken for them."""

import numpy as np
import pytest

from inertial.tables.errors import Refusal
from stages.decode.column_log import refuse_unsigned

G = 9.80665


def counts(means: list[float], noise: float = 5.0) -> np.ndarray:
    return np.rint(np.random.default_rng(1).normal(means, noise, (1000, 3)))


@pytest.mark.parametrize(("zero", "per_g"), [(32768, 4060), (2048, 350), (1 << 23, 400_000)])
@pytest.mark.parametrize("up", [[0, 0, 1], [-0.6, 0.8, 0], [0.577, 0.577, 0.577]])
@pytest.mark.parametrize("told", [True, False])
def test_unsigned_accelerometers_are_refused_with_their_zero(zero, per_g, up, told):
    triad = {"unit": "g"} | ({"counts_per_unit": per_g} if told else {})
    values = counts((zero + per_g * np.array(up)).tolist())
    with pytest.raises(Refusal, match=rf"zero_counts: {zero} to accelerometer"):
        refuse_unsigned("log.txt", "accelerometer", triad, values)
    refuse_unsigned("log.txt", "accelerometer", triad | {"zero_counts": 0}, values)


@pytest.mark.parametrize("up", [[0, 0, 1], [-0.6, 0.8, 0], [0.577, 0.577, 0.577]])
@pytest.mark.parametrize("per_g", [1000, 4096, 16384, 32768, 65536])
def test_signed_accelerometers_are_not(up, per_g):
    """Not even those of an IMU that stands on its corner, whose three channels read alike."""
    values = counts((per_g * np.array(up)).tolist())
    refuse_unsigned("log.txt", "accelerometer", {"unit": "g", "counts_per_unit": per_g}, values)


@pytest.mark.parametrize("bias", [[0, 0, 0], [-427, 148, -81], [900, 300, 2000]])
def test_signed_gyros_are_not(bias):
    refuse_unsigned("log.txt", "gyro", {"unit": "deg/s", "counts_per_unit": 131}, counts(bias))


def test_unsigned_gyros_are():
    values = counts([32790, 32600, 33000], 20)
    with pytest.raises(Refusal, match="zero_counts: 32768 to gyro"):
        refuse_unsigned("log.txt", "gyro", {"unit": "deg/s", "counts_per_unit": 131}, values)


def test_a_single_channel_tells_nothing():
    """A steady turn at one rate reads so too."""
    values = counts([20_000, np.nan, np.nan])
    refuse_unsigned("log.txt", "gyro", {"unit": "deg/s"}, values)
