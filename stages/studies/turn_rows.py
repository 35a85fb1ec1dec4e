"""How a turn was performed, by time, angle and encoder: rows of the study."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.recorded_turns import Rotation
from inertial.campaign.records import Row, grouped
from inertial.campaign.sample_stretches import Samples
from inertial.estimation.consistency import weighted_mean
from inertial.estimation.encoder_angle import Ripple, against_encoder, low_pass, ripple
from inertial.estimation.probability import chi2_sf
from inertial.estimation.time_angle import Ramp, Valued, plateau, spin_down, spin_up
from inertial.physics.motion import Profile
from inertial.tables import GYRO
from stages.studies.table_motion import WholeMotion

# ---- How the table performed a turn, by time and angle: rows of the study.

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


# ---- The encoder of the table against the gyros, turn by turn: rows of the study.

MIN_SPREAD_SIGMAS = 3.0  # of the variance of a delay that tells a low pass
MAX_RIPPLE_P = 1e-4  # chance of a ripple, or of a harmonic, that counts
MIN_SCATTER_P = 0.01  # below which turns differ by more than their sigmas
COMMON = ("delay", "spread", "sine", "cosine")  # what is the same in all turns


def with_rests(m: str) -> str:
    """The name of the stretch of a turn with its rests; no manoeuvre has a blank in its name."""
    return f"{m} with rests"


def of_turn(
    data: CampaignData, rotation: Rotation, samples: Samples, steady: tuple[float, float]
) -> list[Row]:
    """What one turn says; nothing where the encoder has gaps in it, or samples are missing."""
    m, step = rotation.plan, data.clocks[rotation.plan.log].step
    about = m.axis != 0
    rates = samples.values[:, 3:][:, about] @ m.axis[about]
    angle = samples.table_angle
    even = np.abs(np.diff(samples.time) / step - 1) < 0.5
    if not (np.isfinite(rates).all() and np.isfinite(angle).all() and even.all()):
        return []
    rates = rates * np.sign((rates[1:] @ np.diff(angle)) or 1.0)  # in the sense of the encoder
    density = float(np.linalg.norm(m.axis[about] * data.noise.of(m.name, "steady", GYRO)[about]))
    found = against_encoder(rates, angle, step, density)

    def row(quantity: str, value: Valued, unit: str, **more: Any) -> Row:
        return _row(data.mount, m.name, quantity, value, unit) | more

    rows = [row("scale", found.scale, "1"), row("delay", found.delay, "s")]
    rows.append(row("spread", found.spread, "s²"))
    for order, (sine, cosine) in found.harmonics.items():
        rows += [row("sine", sine, "rad", order=order), row("cosine", cosine, "rad", order=order)]
    inside = (samples.time >= steady[0]) & (samples.time <= steady[1])
    drive: Ripple | None = ripple(angle[inside]) if inside.sum() > 8 else None
    if drive is not None and drive.p_value < MAX_RIPPLE_P:
        more = {"order": drive.order, "p_value": drive.p_value}
        rows.append(row("ripple", drive.amplitude, "rad", **more))
    return rows


def together(data: CampaignData, rows: Sequence[Row]) -> Iterator[Row]:
    """What all turns have in common: the delay, its parts where they are told apart, harmonics."""
    among = (row for row in rows if row["quantity"] in COMMON)
    alike = grouped(among, lambda row: (row["quantity"], row["order"]))
    common: dict[tuple[str, int | None], Valued] = {}
    for (quantity, order), own in alike.items():
        value, chance = mean_of([Valued(row["value"], row["sigma"]) for row in own])
        yield _row(data.mount, None, quantity, value, own[0]["unit"]) | {
            "order": order,
            "p_value": chance,
        }
        common[quantity, order] = value
    if ("spread", None) not in common:
        return
    constant = low_pass(common["spread", None], MIN_SPREAD_SIGMAS)
    if constant is not None:
        delay = common["delay", None]
        rest = Valued(delay.value - constant.value, float(np.hypot(delay.sigma, constant.sigma)))
        yield _row(data.mount, None, "low_pass", constant, "s")
        yield _row(data.mount, None, "dead_time", rest, "s")


def mean_of(every: Sequence[Valued]) -> tuple[Valued, float | None]:
    """Weighted mean, its sigma by the scatter where that is more, and the chance of the scatter."""
    values, sigmas = np.array([[each.value, each.sigma] for each in every]).T
    mean, sigma, chi_squared = weighted_mean(values, sigmas)
    if len(every) == 1:
        return Valued(mean, sigma), None
    chance = float(chi2_sf(chi_squared, len(every) - 1))
    if chance < MIN_SCATTER_P:
        sigma *= float(np.sqrt(chi_squared / (len(every) - 1)))
    return Valued(mean, sigma), chance


def harmonics_of(common: Sequence[Row]) -> dict[int, tuple[float, float]]:
    """The harmonics of the encoder's error that are certain: sine and cosine, rad, by order."""
    waves = {(row["quantity"], row["order"]): row for row in common if row["order"]}
    result = {}
    for order in {order for _quantity, order in waves}:
        sine, cosine = waves["sine", order], waves["cosine", order]
        size = sum((row["value"] / row["sigma"]) ** 2 for row in (sine, cosine))
        if float(chi2_sf(size, 2)) < MAX_RIPPLE_P:
            result[order] = (sine["value"], cosine["value"])
    return result


def _row(mount: str, manoeuvre: str | None, quantity: str, value: Valued, unit: str) -> Row:
    return {
        "mount": mount,
        "manoeuvre": manoeuvre,
        "quantity": quantity,
        "order": None,
        "value": value.value,
        "sigma": value.sigma,
        "unit": unit,
        "p_value": None,
    }
