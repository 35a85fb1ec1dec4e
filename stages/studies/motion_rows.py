"""How the table performed a turn, by time and angle: rows of the study."""

import numpy as np

from inertial.arrays import Array
from inertial.campaign.records import Row
from inertial.estimation.time_angle import Ramp, plateau, spin_down, spin_up
from inertial.physics.motion import Profile
from stages.studies.table_motion import WholeMotion

MAX_ROWS = 400  # rows of a turn


def angles(motion: WholeMotion) -> list[Row]:
    """Angle, sigma, and the angle of the trapezoid that was set, at some hundred times.

    Each is the mean over a stretch of samples, with the swing in it, so that an oscillation that
    is faster shows neither as a slower one nor not at all; the first and the last are the ends.
    """
    table = motion.table
    length = max(-(-len(table.time) // (MAX_ROWS - 2)), 3)
    set_angle = _set_angle(motion)
    off = table.angle - np.nan_to_num(set_angle)
    # What bends like a parabola within a stretch is a ramp, and no swing.
    place = np.arange(length) - (length - 1) / 2
    columns = np.column_stack([np.ones(length), place, place**2])
    residual = np.eye(length) - columns @ np.linalg.pinv(columns)
    k = len(table.time) // length
    time, angle, was_set, away, sigma = (
        values[: k * length].reshape(k, length)
        for values in (table.time, table.angle, set_angle, off, table.sigma)
    )
    swing = np.ptp(away @ residual, axis=1) / 2
    means = [part.mean(axis=1) for part in (time, angle, was_set)]
    inside = np.column_stack([*means, sigma[:, length // 2], swing])
    ends = np.column_stack(
        [table.time, table.angle, set_angle, table.sigma, np.zeros(len(table.time))]
    )[[0, -1]]
    names = ("seconds", "angle", "set_angle", "sigma", "swing")
    return [
        {"manoeuvre": motion.plan.name} | dict(zip(names, row, strict=True))
        for row in np.vstack([ends[:1], inside, ends[1:]]).tolist()
    ]


def _set_angle(motion: WholeMotion) -> Array:
    """The trapezoid that was set, (n + 1,), its middle that of the steady part; else NaN.

    When it began is not known.
    """
    table, rate, acceleration = motion.table, motion.plan.rate, motion.plan.acceleration
    if rate is None or acceleration is None:
        return np.full(len(table.time), np.nan)
    profile = Profile(table.whole, abs(rate), acceleration)
    steady = slice(motion.first, motion.after + 1)
    middle = table.time[steady] - (table.angle[steady] - table.whole / 2) / abs(rate)
    angle, _ = profile.at(table.time - (float(middle.mean()) - profile.seconds / 2))
    return angle


def numbers(motion: WholeMotion) -> list[Row]:
    """Speed and ramps, each with what was set."""
    rate, acceleration = motion.plan.rate, motion.plan.acceleration
    speed = plateau(motion.table, motion.first, motion.after)
    set_rate = None if rate is None else abs(rate)
    lasts = None if set_rate is None or acceleration is None else set_rate / acceleration
    ramps: dict[str, Ramp] = {}
    if motion.first > 0 and motion.after < len(motion.increments):
        ramps["spin-up"] = spin_up(motion.table, motion.first, speed)
        ramps["spin-down"] = spin_down(motion.table, motion.after, speed)
    estimates = [("speed", speed, set_rate, "rad/s")]
    for name, ramp in ramps.items():
        estimates.append((f"{name} start", ramp.start, None, "s"))
        estimates.append((f"{name} seconds", ramp.seconds, lasts, "s"))
        estimates.append((f"{name} acceleration", ramp.acceleration, acceleration, "rad/s²"))
    return [
        {
            "manoeuvre": motion.plan.name,
            "quantity": quantity,
            "value": estimate.value,
            "sigma": estimate.sigma,
            "set_value": was_set,
            "unit": unit,
        }
        for quantity, estimate, was_set, unit in estimates
        if np.isfinite(estimate.value) and np.isfinite(estimate.sigma)
    ]
