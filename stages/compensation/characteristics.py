"""Figures of each sensor as the standards define them, from what was applied and what was read.

Readings have bias, M and the effects of the result taken out, but for those effects that are a
function of the sensor's own input: they are what the figures describe. The composite error is that
of the whole result. After each switch-on the bias is that of it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from inertial import tables
from inertial.arrays import Array, nearest_axis
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.measurement import Measurement, SensorResult
from inertial.campaign.rate_segments import position_of
from inertial.campaign.recorded_turns import Rotation
from inertial.campaign.records import Manoeuvre, Row, rows_of, with_mount
from inertial.campaign.static_positions import StaticPosition
from inertial.estimation.gyroscope_observations import Position
from inertial.estimation.input_output import (
    SAME,
    Limits,
    asymmetry,
    at_no_force,
    composite_error,
    least_by_counts,
    linearity_error,
    resolution,
    threshold,
)
from inertial.physics.motion import stretches, turned
from inertial.sensors import UNITS
from inertial.signal.scatter import noise_before_rounding
from inertial.tables import AXES
from inertial.text.messages import _
from stages.compensation.checks import (
    angle_check,
    earth_along,
    force_at,
    motion_of,
    noise_along,
    rate_check,
)
from stages.compensation.correction import UNKNOWN

ByCounts = dict[tuple[str, str], float]

MIN_COSINE = 1 - 1e-9  # between an axis of the case and that of the input
MAX_THRESHOLD = 0.1  # of the largest input; a larger one is no upper limit of the threshold
OF_INPUT = {
    *("accel_scale_asymmetry", "accel_quadratic", "accel_cubic", "accel_hysteresis"),
    *("gyro_scale_asymmetry", "gyro_scale_quadratic", "gyro_scale_cubic"),
    *("gyro_dead_band_x", "gyro_dead_band_y", "gyro_dead_band_z", "gyro_hysteresis"),
    "gyro_bias_sense",
    *("gyro_relaxation", "gyro_relaxation_sense", "gyro_relaxation_braking"),
}
OF_FORCE = {"gyro_g_sensitivity", "gyro_g2_sensitivity"}
FIGURES = {  # of input and output, and their unit where it is not that of the sensor
    "composite_error": "1",
    "linearity_error": "1",
    "asymmetry": "1",
    "threshold": "",
    "resolution": "",
}

NO_RESULT = _("there is no result, so no readings without cross terms")
NO_ATTITUDE = _("the attitudes are not known, so neither is the input along the axis")
NO_INPUT = _("no known input was applied along the axis")
ONE_LINE = _("fewer than three different inputs were applied along the axis")
NOT_SENSED = _("no input along the axis is so large that noise shows it to be sensed")
NO_SMALL_INPUT = _("no small input along the axis was applied")
NO_CHANGE = _("no small change of the input along the axis was applied that noise does not hide")
BOTH = _(
    "the same input is sensed in one place and lost in another, by errors that are none of a "
    "threshold or a resolution"
)
NOT_BOTH = _("the inputs along the axis do not tell the bias from an asymmetry")
NO_FORCES = _("the static positions do not tell it from the sensitivity to force")


@dataclass(frozen=True)
class Point:
    """An input along an axis of the case, 0, 1, 2, the output, and the sigma of their difference.

    `whole`: the output with all effects of the result taken out. `stated`: the input that the plan
    states; the mean rate of a whole turn is less, by the rests that are in it.
    """

    axis: int
    applied: float
    read: float
    whole: float
    sigma: float
    stated: float


def characteristics(
    data: CampaignData, measurement: Measurement, by_counts: ByCounts
) -> Iterator[Row]:
    """The figures of both sensors on one mount, each with the reason where there is none.

    `by_counts`: by sensor and axis the least change of input that counts let through.
    """
    accel, gyro = measurement.accelerometer, measurement.gyro
    own = Measurement(_without(accel, OF_INPUT), _without(gyro, OF_INPUT))
    for sensor, result, points in (("accel", accel, _accelerometers), ("gyro", gyro, _gyros)):
        reason = NO_RESULT if result.triad is None else NO_ATTITUDE if data.by_hand else ""
        there = [] if reason else list(points(data, measurement, own))
        for axis in range(3):
            along = [p for p in there if p.axis == axis and np.isfinite(p.read + p.sigma)]
            least = by_counts.get((sensor, AXES[axis]))
            yield from of_axis(sensor, axis, along, reason, data.mount, least)
    yield from _drifts(data, measurement, reason)


def _without(result: SensorResult, names: set[str]) -> SensorResult:
    return replace(result, effects=[one for one in result.effects if one.effect.name not in names])


def of_axis(
    sensor: str,
    axis: int,
    points: Sequence[Point],
    reason: str,
    mount: str,
    by_counts: float | None,
) -> Iterator[Row]:
    """The figures of input and output along one axis."""
    applied, read, whole, sigma, stated = (
        np.array([getattr(point, name) for point in points])
        for name in ("applied", "read", "whole", "sigma", "stated")
    )
    largest = float(np.abs(applied).max(initial=0.0))
    figures: dict[str, dict[str, Any]]
    if not largest:
        figures = {quantity: {"reason": reason or NO_INPUT} for quantity in FIGURES}
        for quantity in ("threshold", "resolution"):
            figures[quantity]["lower"] = by_counts
    else:
        line, both = linearity_error(applied, read, sigma), asymmetry(applied, read, sigma)
        figures = {
            "composite_error": asdict(composite_error(applied, whole, sigma)),
            "linearity_error": asdict(line) if line else {"reason": ONE_LINE},
            "asymmetry": {"value": both[0], "sigma": both[1]} if both else {"reason": NOT_BOTH},
            "threshold": _threshold(threshold(applied, read, sigma), largest, by_counts),
            "resolution": _limit(resolution(applied, read, sigma, stated), by_counts, NO_CHANGE),
        }
    shared: dict[str, Any] = {
        "largest_input": largest or None,
        "input_unit": UNITS[sensor],
        "points": len(points),
    }
    for quantity, figure in figures.items():
        yield (
            _row(sensor, axis, quantity, FIGURES[quantity] or UNITS[sensor], mount)
            | shared
            | figure
        )


def _threshold(limits: Limits, largest: float, by_counts: float | None) -> dict[str, Any]:
    """The limits; an input that is sensed gives an upper one only where it is small."""
    if limits.upper is not None and limits.upper > MAX_THRESHOLD * largest:
        return _limit(replace(limits, upper=None), by_counts, NO_SMALL_INPUT)
    return _limit(limits, by_counts, NOT_SENSED)


def _limit(limits: Limits, by_counts: float | None, reason: str) -> dict[str, Any]:
    """Limits by the inputs; where these show less than the counts, what was sensed counts."""
    upper = limits.upper
    if limits.lower is not None and upper is not None and limits.lower >= upper * (1 - SAME):
        return {"value": None, "lower": by_counts, "reason": BOTH}
    lower = max(filter(None, (limits.lower, by_counts)), default=None)
    if lower is not None and upper is not None and lower > upper:
        lower = limits.lower
    return {"value": upper, "lower": lower, "reason": reason if upper is None else ""}


def least_changes(
    channel_statistics: pd.DataFrame, ranges: pd.DataFrame, levels: pd.DataFrame
) -> ByCounts:
    """By sensor and axis the least change of input that the coarsest counts of a log let through.

    None where counts are increments, which carry over what they leave, or noise is above them.
    """
    counts = channel_statistics.merge(ranges[["log", "sensor", "axis", "increments"]], how="left")
    whole = counts[counts["increments"].eq(False) & (counts["resolution"] > 0)]
    steps = whole.groupby(["sensor", "axis"])["resolution"].max().reset_index()
    at_rest = levels[levels["phase"].eq("rest")].dropna(subset="per_sample")
    squares = (at_rest["per_sample"] ** 2).groupby(at_rest["channel"]).mean()
    found: ByCounts = {}
    for row in rows_of(steps):
        channel, step = f"{row['sensor']}_{row['axis']}", float(row["resolution"])
        if channel in squares.index:
            noise = float(noise_before_rounding(float(squares[channel]) / step**2))
            if least := step * least_by_counts(noise):
                found[row["sensor"], row["axis"]] = least
    return found


def _row(sensor: str, axis: int, quantity: str, unit: str, mount: str) -> dict[str, Any]:
    return {
        "id": f"{with_mount('compensation', mount)}/{sensor}/{quantity}_{AXES[axis]}",
        "mount": mount,
        "sensor": sensor,
        "axis": AXES[axis],
        "quantity": quantity,
        **dict.fromkeys(("value", "sigma", "lower", "by_noise", "largest_input")),
        "unit": unit,
        "input_unit": "",
        "points": 0,
        "reason": "",
    }


# --- Inputs along the axes: gravity in static positions, the earth's rate, the table's rate ---


def _accelerometers(data: CampaignData, whole: Measurement, own: Measurement) -> Iterator[Point]:
    """A tilt changes the components across the vertical, and that along it by its square."""
    gravity, triad = data.gravity.number, whole.accelerometer.triad
    assert triad is not None  # else there is no result
    for position in data.accelerometer_positions[0]:
        now = position.manoeuvre
        read, all_out = (force_at(position, _since(each, now, data)) for each in (own, whole))
        noise, up = position.over()[1], position.up_now
        for axis, unit in enumerate(np.eye(3)):
            level = np.sqrt(max(1 - up[axis] ** 2, 0.0))
            tilted = gravity * max(data.position_sigma * level, data.position_sigma**2)
            sigma = float(np.hypot(noise_along(unit, triad, noise), tilted))
            applied = gravity * up[axis]
            yield Point(axis, applied, read[axis], all_out[axis], sigma, applied)


def _gyros(data: CampaignData, whole: Measurement, own: Measurement) -> Iterator[Point]:
    """Only inputs along an axis of the case: across it the earth's rate may be unknown."""
    triad = whole.gyro.triad
    assert triad is not None  # else there is no result
    forces = [_forces(data, measurement) for measurement in (own, whole)]
    for position in data.gyro_inputs.of_known_attitude.static_positions:
        if (along := _axis(position.up_now)) is None:
            continue
        checked = [
            check
            for measurement, force in zip((own, whole), forces, strict=True)
            for check in rate_check(
                position,
                _since(measurement, position.manoeuvre, data),
                triad,
                force.get(position.label, UNKNOWN),
                data,
                np.zeros(3),
            )
        ]
        if len(checked) == 2:
            axis, sign = along
            read, all_out = (sign * check.after for check in checked)
            applied = sign * checked[0].expected
            yield Point(axis, applied, read, all_out, checked[0].sigma, applied)
    for rotation in data.gyro_inputs.usable:
        if (along := _axis(rotation.plan.axis)) is not None:
            axis, sign = along
            rate = rotation.plan.rate
            stated = np.nan if rate is None else sign * rate
            turn = _whole_turn if rotation.plan.recorded == "whole" else _steady_turn
            for applied, read, all_out, sigma in turn(rotation, data, whole, own):
                yield Point(axis, sign * applied, sign * read, sign * all_out, sigma, stated)


def _forces(data: CampaignData, measurement: Measurement) -> dict[str, Array]:
    """The specific force in each static position of the accelerometers, (3,), by its label."""
    return {
        p.label: force_at(p, _since(measurement, p.manoeuvre, data))
        for p in data.accelerometer_positions[0]
    }


def _since(measurement: Measurement, m: Manoeuvre, data: CampaignData) -> Measurement:
    """The measurement equation with the biases of a manoeuvre's switch-on: they are no error."""
    deviations = {} if data.solution is None else data.solution.deviations
    return measurement.since(m.switch_on, deviations)


def _axis(direction: Array) -> tuple[int, float] | None:
    """The axis of the case along a direction and its sign."""
    axis = nearest_axis(direction)
    along = float(direction[axis])
    return (axis, float(np.sign(along))) if abs(along) > MIN_COSINE else None


Turned = tuple[float, float, float, float]


def _whole_turn(
    rotation: Rotation, data: CampaignData, whole: Measurement, own: Measurement
) -> Iterator[Turned]:
    """The mean rate of a turn from rest to rest, by its angle."""
    triad = whole.gyro.triad
    assert triad is not None
    checked = [
        check
        for measurement in (own, whole)
        for check in angle_check(
            rotation, _since(measurement, rotation.plan, data), triad, data, np.zeros(3)
        )
    ]
    seconds = float(rotation.weights @ rotation.blocks.seconds)
    if len(checked) == 2 and rotation.done.complete:
        read, all_out = (check.after / seconds for check in checked)
        yield checked[0].expected / seconds, read, all_out, checked[0].sigma / seconds


def _steady_turn(
    rotation: Rotation, data: CampaignData, whole: Measurement, own: Measurement
) -> Iterator[Turned]:
    """The steady rate of a turn, by what the plan states of it."""
    m, blocks, triad = rotation.plan, rotation.steady, whole.gyro.triad
    assert m.rate is not None and triad is not None
    motion = stretches(blocks.time, blocks.seconds, blocks.temperature)
    earth, earth_sigma = earth_along(m.axis, position_of(m, data.heading), data.earth)
    means = []
    for measurement in (_since(own, m, data), _since(whole, m, data)):
        rates = measurement.rate(blocks.gyro, motion, measurement.force(blocks.accel, motion))
        means.append(float(np.average(rates @ m.axis, weights=blocks.counts)) - earth)
    noise = data.noise.of(m.name, "steady", tables.GYRO) / np.sqrt(blocks.seconds.sum())
    sigma = (noise_along(m.axis, triad, noise), abs(m.rate) * data.rate_sigma, earth_sigma)
    yield m.rate, means[0], means[1], float(np.linalg.norm(sigma))


def _position_now(position: StaticPosition, data: CampaignData) -> Position:
    """The set position of a manoeuvre as it has turned since its start."""
    start, about, angle = (
        position_of(position.manoeuvre, data.heading),
        position.about,
        position.angle,
    )
    north = None if start.north is None else turned(start.north, about, angle)
    return replace(start, up=position.up_now, north=north)


# --- The drift that does not depend on specific force ---


def _drifts(data: CampaignData, measurement: Measurement, reason: str) -> Iterator[Row]:
    """The acceleration-insensitive drift rates: by static positions, whatever the force adds."""
    own = replace(measurement, gyro=_without(measurement.gyro, OF_FORCE))
    triad = measurement.gyro.triad
    positions = [] if reason else data.gyro_inputs.of_known_attitude.static_positions
    up = np.array([position.up_now for position in positions]).reshape(-1, 3)
    forces = _forces(data, own)
    for axis, unit in enumerate(np.eye(3)):
        rates, sigmas = np.empty(len(positions)), np.empty(len(positions))
        for i, position in enumerate(positions):
            assert triad is not None  # else there is a reason
            reading, noise = position.over()
            earth, spread = earth_along(unit, _position_now(position, data), data.earth)
            force = forces.get(position.label, UNKNOWN)
            after = _since(own, position.manoeuvre, data)
            (rate,) = after.rate(reading[None], motion_of(position), force[None])
            rates[i] = rate[axis] + triad.bias[axis] - earth
            sigmas[i] = np.hypot(noise_along(unit, triad, noise), spread)
        known = np.isfinite(rates + sigmas)
        found = at_no_force(rates[known], sigmas[known], data.gravity.number * up[known])
        yield _row("gyro", axis, "acceleration_insensitive_drift", "rad/s", data.mount) | {
            "points": int(known.sum()),
            **(
                {"value": found[0], "sigma": found[1]} if found else {"reason": reason or NO_FORCES}
            ),
        }
