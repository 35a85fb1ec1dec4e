"""Readings less what the final result predicts: static positions and steady rotation.

A static position is predicted in its blocks, by the forward model with all effects of the result,
about the tilt that these give, and the azimuth where the heading is not known.
The rate in a rotation is that of `simulated`, of which M and bias of the joint fit are undone. What
effects of the table change of it is predicted; the others follow from the reading.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, replace

import numpy as np
import pandas as pd

from inertial import tables
from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.measurement import Measurement, SensorResult
from inertial.campaign.motions import CampaignMotions
from inertial.campaign.observations import campaign_of
from inertial.campaign.rate_segments import position_of
from inertial.campaign.static_positions import StaticPosition
from inertial.estimation.gyroscope_equations import horizontal_axes, horizontal_names
from inertial.estimation.horizontal_earth_rate import MAX_AZIMUTH_SIGMA
from inertial.estimation.noise_model import sigma_of_mean
from inertial.physics.forward import UNKNOWN_TRIAD, Site, predict, truth_of
from inertial.physics.motion import Motion, cross, joined, level_axes, stretches, turned
from inertial.tables import ACCEL, CHANNELS, GYRO
from inertial.tables.parquet import Stream

SECONDS = 1.0  # of a mean in a rotation
MIN_SHARE = 0.98  # of it that is recorded, so that a vibration averages out as in the others
BLOCKS = "blocks"  # effects that are sought elsewhere have no columns in the equations
MIN_COSINE = 0.5  # to an axis from which its sensor shows an error along a direction
LEFT = [f"residual_{channel}" for channel in GYRO]


def residuals(
    mounts: Sequence[CampaignData], measurements: Mapping[str, Measurement], simulated: Stream
) -> Iterator[pd.DataFrame]:
    """The table of residuals in pieces; nothing of a mount without a result."""
    turns = _turns(mounts, simulated)
    for data in mounts:
        if (measurement := measurements.get(data.mount)) is None:
            continue
        sensors = [(ACCEL, measurement.accelerometer, data.accelerometer_positions[0])]
        if not data.by_hand:  # which way the earth turns is not known there
            known = data.gyro_inputs.of_known_attitude.static_positions
            sensors.append((GYRO, measurement.gyro, known))
        motions = CampaignMotions(data)
        for channels, result, positions in sensors:
            yield from _static(data, positions, motions, channels, result)
        changes = _changes_of_rate(data, measurement.gyro)
        yield from (
            _in_rotation(data, name, turn, measurement, changes.get(name))
            for name, turn in turns.items()
            if name in {m.name for m in data.plan}
        )


def _static(
    data: CampaignData,
    positions: Sequence[StaticPosition],
    motions: CampaignMotions,
    channels: Sequence[str],
    result: SensorResult,
) -> Iterator[pd.DataFrame]:
    """The static positions in their blocks; by hand they tell of |f| alone, along the vertical."""
    rests = [_in_blocks(position, motions.at_rest(position)) for position in positions]

    def residuals_at(motions: Sequence[Motion]) -> list[Array]:
        if not motions:
            return []
        predicted = _predicted(joined(motions), data.result.site, channels, result)
        counts = np.cumsum([len(position.seconds) for position in positions])
        every = np.split(predicted, counts[:-1])
        return [p.means - values for p, values in zip(positions, every, strict=True)]

    if channels is GYRO and result.triad is not None:
        rests = with_azimuths(data, positions, rests, result.triad.matrix, residuals_at)
    if channels is ACCEL and result.triad is not None and result.effects and not data.by_hand:
        rests = with_tilts(data, positions, rests, result.triad.matrix, residuals_at)
    for position, values in zip(positions, residuals_at(rests), strict=True):
        if data.by_hand:
            values[:, np.abs(position.up_now) < MIN_COSINE] = np.nan
        noise = position.density[:, None], position.quantisation[:, None]
        sigma = sigma_of_mean(*noise, position.seconds)
        yield _frame(
            data,
            (position.manoeuvre.name, position.part.phase),
            (position.time, position.seconds),
            dict(zip(channels, values.T, strict=True)),
            dict(zip(channels, sigma, strict=True)),
        )


def _in_blocks(position: StaticPosition, rest: Motion) -> Motion:
    """The motion of a static position, one stretch, in its blocks."""
    count = len(position.seconds)
    same = {f.name: getattr(rest, f.name).repeat(count, axis=0) for f in fields(rest)[2:]}
    own = {"time": position.time, "seconds": position.seconds, "temperature": position.temperature}
    return replace(rest, **(same | own))


def _predicted(motion: Motion, site: Site, channels: Sequence[str], result: SensorResult) -> Array:
    """The readings of one sensor by its result, (n, 3)."""
    triad = result.triad or UNKNOWN_TRIAD
    values = {one.effect.label: one.values for one in result.effects}
    effects = [one.effect for one in result.effects]
    reading = predict(motion, site, triad, triad, effects, values)
    return reading.accel if channels is ACCEL else reading.gyro


def _turns(mounts: Sequence[CampaignData], simulated: Stream) -> dict[str, pd.DataFrame]:
    """Means over a second each of the gyros in steady rotations: predicted, residuals, and time.

    `rows`: the number of samples in each.
    """
    step = {m.name: data.clocks[m.log].step for data in mounts for m in data.plan if m.do == "turn"}
    parts: dict[str, list[pd.DataFrame]] = {}
    columns = [*CHANNELS, *LEFT]
    for batch in simulated.columns(["manoeuvre", "phase", "record", "time", *columns]):
        rows = batch.to_pandas()
        rows = rows[(rows["phase"] == "steady") & rows[LEFT].notna().all(axis=1)]
        for name, own in rows.groupby("manoeuvre", sort=False):
            second = own["time"].fillna(own["record"] * step[str(name)]) // SECONDS
            sums = own[["time", *columns]].assign(rows=1.0).groupby(second).sum(min_count=1)
            parts.setdefault(str(name), []).append(sums)
    means = {}
    for name, own in parts.items():
        sums = pd.concat(own).groupby(level=0).sum(min_count=1)
        whole = sums[sums["rows"] * step[name] >= MIN_SHARE * SECONDS]
        means[name] = whole.div(whole["rows"], axis=0).assign(rows=whole["rows"])
    return means


def _changes_of_rate(data: CampaignData, result: SensorResult) -> dict[str, tuple[Array, Array]]:
    """By rotation, time, (k,), s, and what effects of the table change of the rate, (k, 3), rad/s.

    All manoeuvres are seen together: some tell how the table stands in others.
    """
    staying = [one for one in result.staying if one.effect.sought_in == BLOCKS]
    if not staying:
        return {}
    motion = campaign_of(data).motion
    before = truth = truth_of(motion, data.result.site)
    for one in staying:
        truth = one.effect.moves(truth, motion, one.values)
    change, place = truth.rate - before.rate, np.floor(motion.visit)
    turning = (motion.rate != 0) & np.isfinite(motion.time) & np.isfinite(change).all(axis=1)
    own = {m.name: turning & (place == number) for number, m in enumerate(data.plan)}
    return {name: (motion.time[rows], change[rows]) for name, rows in own.items() if rows.any()}


def _in_rotation(
    data: CampaignData,
    name: str,
    means: pd.DataFrame,
    measurement: Measurement,
    changes: tuple[Array, Array] | None,
) -> pd.DataFrame:
    """The gyros in a steady rotation, in means of a second; `changes`: of `_changes_of_rate`."""
    (m,) = (m for m in data.plan if m.name == name)
    predicted, left, time = (means[n].to_numpy(np.float64) for n in (GYRO, LEFT, "time"))
    time = time + data.clocks[m.log].offset  # as that of the blocks and of the effects
    seconds = means["rows"].to_numpy(np.float64) * data.clocks[m.log].step
    blocks = data.blocks[data.blocks["manoeuvre"] == name]
    temperature = np.interp(time, *blocks[["time", "temperature"]].to_numpy(np.float64).T)
    joint, gyro = data.result.gyro, measurement.gyro.triad
    rates = np.full((len(means), 3), np.nan)
    if joint is not None and gyro is not None:
        known = (predicted - joint.bias) @ np.linalg.inv(joint.matrix).T
        if changes is not None:
            known += np.stack([np.interp(time, changes[0], axis) for axis in changes[1].T], axis=1)
        motion = stretches(time, seconds, temperature)
        read = measurement.rate(predicted + left, motion, _force(data, means))
        rates = (read - known) @ gyro.matrix.T
    if m.rate is None or m.acceleration is None:  # then the rate is what the gyros read
        rates[:, np.abs(m.axis) > MIN_COSINE] = np.nan
    own = data.noise.of(name, "rest", GYRO), data.noise.quantisation("gyro")
    sigma = sigma_of_mean(*own, seconds[:, None])
    return _frame(
        data,
        (name, "steady"),
        (time, seconds),
        dict(zip(GYRO, rates.T, strict=True)),
        dict(zip(GYRO, sigma.T, strict=True)),
    )


def _force(data: CampaignData, means: pd.DataFrame) -> Array:
    """The specific force that the simulation had, (n, 3); NaN without accelerometers."""
    joint = data.result.accelerometer or UNKNOWN_TRIAD
    return (means[ACCEL].to_numpy(np.float64) - joint.bias) @ np.linalg.inv(joint.matrix).T


def _frame(
    data: CampaignData,
    place: tuple[str, str | None],
    times: tuple[Array, Array],
    left: Mapping[str, Array],
    sigma: Mapping[str, Array],
) -> pd.DataFrame:
    (manoeuvre, phase), (time, seconds) = place, times
    shared = {"mount": data.mount, "manoeuvre": manoeuvre, "phase": phase}
    frame = pd.DataFrame({"time": time, "seconds": seconds}).assign(**shared)
    for prefix, values in (("residual_", left), ("sigma_", sigma)):
        for channel in CHANNELS:
            frame[prefix + channel] = values.get(channel, np.nan)
    return frame[[column.name for column in tables.RESIDUALS.columns]]


# ---- The tilts of static positions by the final result
#
# Those of the joint fit have taken up a part of the effects that it lacks.


def with_tilts(
    data: CampaignData,
    positions: Sequence[StaticPosition],
    motions: Sequence[Motion],
    matrix: Array,
    residuals_at: "Residuals",
) -> list[Motion]:
    """The motions with the tilts that fit the accelerometers, of the sigma of a set position.

    `matrix`: M of the accelerometers, (3, 3); `residuals_at`: as in `with_azimuths`, m/s².
    """
    places: dict[str, list[int]] = {}
    for number, position in enumerate(positions):
        if position.manoeuvre.up is not None:
            places.setdefault(position.manoeuvre.position, []).append(number)
    known, found = data.result.position_parameters, list(motions)
    left, off = residuals_at(motions), data.reference.free
    for name, numbers in places.items():
        free = name in off
        if not data.position_sigma and not free:
            continue
        prior = 0.0 if free else data.position_sigma**-2
        before = np.array([known.get((name, "tilt", i), 0.0) for i in (0, 1)])
        information, right = prior * np.eye(2), -prior * before
        leans = {n: _leans(positions[n]) for n in numbers}
        for n in numbers:
            columns = data.gravity.number * matrix @ leans[n]
            noise = positions[n].density[:, None], positions[n].quantisation[:, None]
            sigma = sigma_of_mean(*noise, positions[n].seconds).T
            weights = np.nan_to_num(np.where(np.isfinite(left[n]), sigma**-2, 0.0))
            information = information + (columns.T * weights.sum(axis=0)) @ columns
            right = right + columns.T @ np.sum(weights * np.nan_to_num(left[n]), axis=0)
        further = np.linalg.lstsq(information, right)[0]  # 0 where nothing is recorded
        for n in numbers:
            found[n] = replace(found[n], up=found[n].up + leans[n] @ further)
    return found


def _leans(position: StaticPosition) -> Array:
    """What the upward direction changes by per tilt about either level axis, (3, 2)."""
    up = position.manoeuvre.up
    assert up is not None  # else it is by hand
    at_start = [cross(axis, up) for axis in level_axes(up)]
    return np.stack([turned(own, position.about, position.angle) for own in at_start], axis=1)


# ---- The azimuths of static positions by the final result, where the heading is not known
#
# The joint fit has azimuths of its own, but without the effects of the result: a g-sensitivity
# that it lacks turns them, by degrees for a good gyro. Here the horizontal component of the earth's
# rate is fitted to what the result leaves of the readings at rest; its size is that of the site
# where they determine the azimuth, see `inertial/estimation/horizontal_earth_rate.py`.

Residuals = Callable[[Sequence[Motion]], Sequence[Array]]

PRIOR_INFORMATION = 2.0  # of each component: its variance is half the square of the known size
ITERATIONS = 4  # linearisations of the known size about the last azimuth


def with_azimuths(
    data: CampaignData,
    positions: Sequence[StaticPosition],
    motions: Sequence[Motion],
    matrix: Array,
    residuals_at: Residuals,
) -> list[Motion]:
    """The motions with the azimuths that fit the gyros.

    `matrix`: M of the gyros, (3, 3); `residuals_at`: the gyros at rest less those predicted for
    these motions, (k, 3) for each, rad/s.
    """
    places: dict[str, list[int]] = {}
    found = list(motions)
    for number, position in enumerate(positions):
        if names := horizontal_names(position_of(position.manoeuvre, data.heading)):
            places.setdefault(names[0][1], []).append(number)
            found[number] = replace(motions[number], north=np.zeros_like(motions[number].north))
    left = residuals_at(found)
    level = data.result.site.earth_level
    for numbers in places.values():
        axes = {n: _horizontal_axes(positions[n], data.heading) for n in numbers}
        size = _horizontal([(positions[n], axes[n], left[n]) for n in numbers], level * matrix)
        for n in numbers:
            found[n] = replace(found[n], north=found[n].north + axes[n] @ size)
    return found


def _horizontal_axes(position: StaticPosition, heading: float | None) -> Array:
    """Those of the set position as the table now stands, (3, 2), in body axes."""
    first = horizontal_axes(position_of(position.manoeuvre, heading))[0]
    first = turned(first, position.about, position.angle)
    return np.column_stack([first, cross(position.up_now, first)])


def _horizontal(rests: Sequence[tuple[StaticPosition, Array, Array]], gain: Array) -> Array:
    """The horizontal earth rate along both axes, (2,), relative to its known size.

    `rests`: with the axes, (3, 2), and the residuals; `gain`: of M and the known size, rad/s.
    """
    information, right = np.zeros((2, 2)), np.zeros(2)
    for position, axes, left in rests:
        columns = gain @ axes
        each = np.where(np.isfinite(left), position.seconds[:, None], 0) / position.density**2
        weights = np.nan_to_num(each)
        information = information + (columns.T * weights.sum(axis=0)) @ columns
        right = right + columns.T @ (weights * np.nan_to_num(left)).sum(axis=0)
    if not information.any():  # at a pole, or without readings
        return np.zeros(2)
    prior = PRIOR_INFORMATION * np.eye(2)
    found: Array = np.asarray(np.linalg.solve(information + prior, right), np.float64)
    for _ in range(ITERATIONS):
        along = found / float(np.linalg.norm(found))
        across = np.array([-along[1], along[0]])
        determined = float(across @ information @ across)
        if determined < MAX_AZIMUTH_SIGMA**-2:
            return found
        step = float(across @ (right - information @ along)) / determined
        found = along + step * across
    return found / float(np.linalg.norm(found))
