"""Formulas of effects and of motions against what they stand for, written down a second time."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from inertial.effects import CATALOGUE
from inertial.effects.gyro_hysteresis import course
from inertial.effects.table_axis_non_orthogonality import _middle
from inertial.effects.thermal_hysteresis import turned_over
from inertial.physics.effect import Reading, Truth
from inertial.physics.forward import Site, Triad, predict
from inertial.physics.motion import level_axes, stretches

UP = np.array([0.2, -0.3, 0.9]) / np.linalg.norm([0.2, -0.3, 0.9])
ABOUT = np.array([1.0, 2.0, -0.5]) / np.linalg.norm([1.0, 2.0, -0.5])


def turning(rate):
    """One stretch of a turn about an axis between all others."""
    still = stretches(np.array([5.0]), np.array([1.0]), np.array([np.nan]))
    return replace(still, about=ABOUT, rate=np.array([rate]), up=UP[None])


def test_a_set_position_that_leans_turns_force_and_rate_alike():
    """Both are turned by the small angles about the level axes, as tilts of positions are."""
    effect, motion = CATALOGUE["table_position_error"].fixed(0.0), turning(0.7)
    truth = Truth(rate=motion.omega, force=9.8 * motion.up)
    angles = np.array([2e-5, -3e-5])
    moved = effect.moves(truth, motion, angles)
    lean = Rotation.from_rotvec(angles @ np.array(level_axes(UP)))
    np.testing.assert_allclose(moved.force, lean.apply(truth.force), atol=1e-7)
    np.testing.assert_allclose(moved.rate, lean.apply(truth.rate), atol=1e-8)
    assert np.abs(moved.force - truth.force).max() > 1e-4


def test_a_turn_that_goes_too_far_leaves_the_case_there_until_it_is_set_anew():
    """Backward about y by 90° and δ: behind it, and in all of that position, δ is still there."""
    stages = stretches(np.arange(6.0), np.ones(6), np.full(6, np.nan))
    motion = replace(
        stages,
        about=np.tile([0.0, 1.0, 0.0], (6, 1)),
        rate=np.array([0, -0.5, 0, 0.5, 0, 0]),
        angle=np.array([0, -np.pi / 4, 0, 0, 0, 0]),
        seconds=np.array([1, np.pi, 1, 1, 1, 1]),
        visit=np.array([0, 1 + 1 / 3, 1 + 2 / 3, 2 + 1 / 3, 3, 4]),
        position=np.array([0.0, 0, 0, 0, 1, 0]),
    )
    delta, force, rate = 3e-5, np.array([4.0, 1.0, 9.0]), np.array([3e-5, 4e-5, 5e-5])
    truth = Truth(rate=np.tile(rate, (6, 1)), force=np.tile(force, (6, 1)))
    moved = CATALOGUE["turn_angle_error"].fixed(1.0).moves(truth, motion, np.array([delta]))
    over = delta * np.array([0, -0.5, -1, -1, 0, 0])  # of the case, about y, at the middle of each
    back = Rotation.from_rotvec(np.outer(-over, [0, 1.0, 0]))
    faster = -delta / np.pi * np.array([0, 1, 0, 0, 0, 0])  # δ more in the π seconds it takes
    np.testing.assert_allclose(moved.force, back.apply(truth.force), atol=1e-8)
    expected = back.apply(truth.rate) + np.outer(faster, [0, 1.0, 0])
    np.testing.assert_allclose(moved.rate, expected, atol=1e-12)


@pytest.mark.parametrize("off", [0.001, 0.1])
def test_a_wrong_latitude_changes_the_size_of_the_horizontal_rate(off):
    """ω_e cos(φ + Δφ), which a small angle has to its square, and a large one about itself."""
    rate, latitude = 7.292115e-5, 0.8
    up, level = rate * np.sin(latitude), rate * np.cos(latitude)
    effect = CATALOGUE["latitude_error"].about(off)
    (change,) = effect.level_rate_changes(up, level)
    exact = rate * np.cos(latitude + off) - level
    assert change * off == pytest.approx(exact, rel=1e-9 if off > 0.02 else off)
    assert CATALOGUE["earth_rate_omitted"].level_rate_changes(up, level) == pytest.approx(-level)
    assert not CATALOGUE["heading_error"].level_rate_changes(up, level).any()


def test_readings_are_the_truth_through_m_and_the_bias():
    matrix = np.eye(3) + np.arange(9).reshape(3, 3) / 100
    gyro, accel = (
        Triad(matrix, np.array([1e-3, -2e-3, 3e-3])),
        Triad(matrix.T, np.array([3, 2, 1.0])),
    )
    north = np.cross([0, 0, 1.0], UP)
    motion = replace(turning(0.7), north=north[None])
    reading = predict(motion, Site(9.8, 5e-5, 6e-5), gyro, accel)
    rate = 0.7 * ABOUT + 5e-5 * UP + 6e-5 * north
    for found, triad, truth in ((reading.gyro, gyro, rate), (reading.accel, accel, 9.8 * UP)):
        by_row = [sum(m * t for m, t in zip(row, truth, strict=True)) for row in triad.matrix]
        np.testing.assert_allclose(found[0], np.array(by_row) + triad.bias, rtol=1e-12)


def test_friction_follows_the_rate_up_and_down():
    """Coulomb: after a fall to zero from positive rates −1, at zero again after half the break-away
    up, 1 after all of it; and the other way round."""  # in units of the largest friction
    degree = np.radians(1.0)  # the change of the rate from which all of it gives way
    rates = np.outer([0.0, degree / 2, degree, 5 * degree, 4.5 * degree, 0.0], [1.0, -1.0, 1.0])
    senses = np.tile([1.0, -1.0, np.nan], (len(rates), 1))
    friction = course(rates, np.linspace(0, 0.5, len(rates)), senses)
    np.testing.assert_allclose(friction[:, 0], [-1, 0, 1, 1, 0, -1], atol=1e-12)
    np.testing.assert_allclose(friction[:, 1], [1, 0, -1, -1, 0, 1], atol=1e-12)
    np.testing.assert_allclose(friction[:, 2], [0, 1, 1, 1, 0, -1], atol=1e-12)


def test_orders_of_a_ripple_end_where_the_last_one_is():
    orders = CATALOGUE["table_ripple"].grid(turning(0.7))
    assert (orders[0], orders[-1]) == pytest.approx((1.5, 60.0))
    np.testing.assert_allclose(np.diff(orders), 0.25)


def test_time_since_the_middle_of_a_visit():
    time = np.array([0.0, 1.0, 2.0, 10.0, 14.0])
    motion = stretches(time, np.ones(5), np.full(5, np.nan))
    motion = replace(motion, visit=np.array([0.0, 0.0, 0.0, 1.0, 1.0]))
    np.testing.assert_allclose(motion.since_middle, [-1.0, 0.0, 1.0, -2.0, 2.0])
    # Logs that share no clock have no time, but a turn is one: else the speed of the table is a
    # scale factor of the gyros.
    unknown = replace(motion, time=np.full(5, np.nan), seconds=np.array([1.0, 1.0, 1.0, 4.0, 4.0]))
    np.testing.assert_allclose(unknown.since_middle, [-1.0, 0.0, 1.0, -2.0, 2.0])


def test_gyros_mounted_askew_show_the_rate_of_the_earth_as_well():
    effect, angles = CATALOGUE["gyro_accel_misalignment"].fixed(0.0), np.array([1e-3, -2e-3, 3e-3])
    for rate in (0.0, 0.7):
        motion = turning(rate)
        truth = Truth(rate=motion.omega + 5e-5 * UP, force=9.8 * motion.up)
        moved = effect.moves(truth, motion, angles)
        np.testing.assert_allclose(moved.rate - truth.rate, np.cross(truth.rate, angles))


def test_a_dead_band_takes_from_the_rate_along_the_axis_and_not_from_the_bias():
    """At rest with z up and down, 10 °/h of the earth, in a band of 12 °/h that loses a half."""
    earth = np.radians(10.0) / 3600
    still = stretches(np.array([5.0, 15.0]), np.ones(2), np.full(2, np.nan))
    motion = replace(still, up=np.array([[0, 0, 1.0], [0, 0, -1.0]]))
    truth = Truth(rate=earth * motion.up, force=9.8 * motion.up)
    reading = Reading(truth.rate + 3e-4, truth.force)
    effect = CATALOGUE["gyro_dead_band_z"].fixed(1.2 * earth)
    lost = reading.gyro - effect.reads(reading, truth, motion, np.array([0.5])).gyro
    np.testing.assert_allclose(lost, truth.rate / 2, atol=1e-15)


def test_the_middle_axis_of_a_table_is_one_line_whichever_way_the_case_leans():
    """Leaning by 0.3 rad east and west about an axis that points north: the same axis, and as
    far backwards as forwards."""
    lean = np.array([0.3, -0.3, 0.3])
    up = np.column_stack([np.sin(lean), 0 * lean, np.cos(lean)])
    line, sine = _middle(up, np.tile([0.0, 1.0, 0.0], (3, 1)))
    np.testing.assert_allclose(line, np.tile(line[0], (3, 1)), atol=1e-12)
    np.testing.assert_allclose(np.abs(line[0]), [0, 1, 0], atol=1e-12)
    np.testing.assert_allclose(sine, np.sin(0.3) * np.array([1, -1, 1]), atol=1e-12)


def test_hysteresis_of_temperature_begins_where_the_temperature_does():
    course = np.array([290.0, 300.0, 310.0, 296.0])
    motion = stretches(np.arange(4.0), np.ones(4), course)
    np.testing.assert_allclose(turned_over(motion, 5.0), [0.0, 1.0, 1.0, -1.0])
