"""The bandwidth of each sensor: by ramps of the rate, and that of its noise at rest."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from inertial.arrays import nearest_axis
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.recorded_turns import Rotation
from inertial.campaign.records import Row, with_mount
from inertial.campaign.sample_stretches import Samples
from inertial.estimation.bandwidth import Bandwidth, by_noise, first_order, spread_by_ramps
from inertial.estimation.time_angle import Valued
from inertial.tables import AXES, CHANNELS, GYRO
from inertial.text.messages import _
from stages.studies.table_motion import MAX_DELAY_STEPS
from stages.studies.turn_rows import mean_of

MIN_COSINE = 1 - 1e-9  # between the axis of a turn and that of a gyro
MIN_SPREAD_SIGMAS = -3.0  # of a variance: below, the drive overshoots, and there is no limit
MAX_UNLIKE = 1e-3  # relative, of the sampling intervals of logs with one spectrum

NO_CHANGE = _("no manoeuvre changes the specific force fast by a known amount")
NO_RAMPS = _(
    "no turn about the axis has ramps of a set acceleration that hold enough samples, with the "
    "rests before and after them"
)
OVERSHOOT = _("the drive of the table does not accelerate evenly, and has no encoder in the log")
NO_SPECTRUM = _("the rests are too short for the spectrum of the noise")


def of_ramps(data: CampaignData, rotation: Rotation, samples: Samples) -> Valued | None:
    """Variance of the delay, s², of gyro and drive, by one turn with its rests."""
    m, step = rotation.plan, data.clocks[rotation.plan.log].step
    axis = axis_of(m.axis)
    if axis is None or m.acceleration is None or m.angle is None:
        return None
    rates = samples.values[:, 3 + axis] * float(np.sign(m.angle * m.axis[axis]))
    even = np.abs(np.diff(samples.time) / step - 1) < MAX_DELAY_STEPS
    density = float(data.noise.of(m.name, "steady", GYRO)[axis])
    if not (np.isfinite(rates).all() and even.all() and np.isfinite(density)):
        return None
    return spread_by_ramps(rates, step, density)


def axis_of(about: Any) -> int | None:
    """The gyro along an axis of rotation; none where there is none."""
    axis = nearest_axis(about)
    return axis if abs(float(about[axis])) > MIN_COSINE else None


def bandwidths(
    data: CampaignData,
    encoder: Sequence[Row],
    ramps: Mapping[str, Valued | None],
    spectra: pd.DataFrame,
) -> Iterator[Row]:
    """Of every channel.

    `encoder`: rows of the study of the encoder; `ramps`: of each turn the variance of the delay.
    """
    turns = {r.plan.name: axis_of(r.plan.axis) for r in data.gyro_inputs.recorded}
    known = {
        row["manoeuvre"]: Valued(row["value"], row["sigma"])
        for row in encoder
        if row["quantity"] == "spread" and row["manoeuvre"]
    }
    for axis in range(len(AXES)):
        yield _row(data.mount, "accel", axis, "ramps", None, reason=NO_CHANGE)
        for by, spreads in (("encoder", known), ("ramps", ramps)):
            own = [each for name, each in spreads.items() if each and turns.get(name) == axis]
            if own:
                yield _by_ramps(data.mount, axis, by, own)
            elif by == "ramps" and axis not in {turns.get(name) for name in known}:
                yield _row(data.mount, "gyro", axis, by, None, reason=NO_RAMPS)
    for channel in CHANNELS:
        sensor, axis = channel[:-2], AXES.index(channel[-1])
        found = _of_noise(spectra[spectra["channel"] == channel], data)
        reason = NO_SPECTRUM if found is None else ""
        yield _row(data.mount, sensor, axis, "noise", found, reason=reason)


def _by_ramps(mount: str, axis: int, by: str, own: Sequence[Valued]) -> Row:
    spread, _chance = mean_of(own)
    if by == "ramps" and spread.value < MIN_SPREAD_SIGMAS * spread.sigma:
        return _row(mount, "gyro", axis, by, None, len(own), OVERSHOOT)
    return _row(mount, "gyro", axis, by, first_order(spread), len(own))


def _of_noise(rows: pd.DataFrame, data: CampaignData) -> Bandwidth | None:
    steps = np.array([clock.step for clock in data.clocks.values() if clock.step])
    if not len(steps) or np.ptp(steps) > MAX_UNLIKE * steps.max():
        return None
    rows = rows[~rows["line"].astype(bool)]
    frequency, density, degrees = rows[["frequency", "density", "degrees"]].to_numpy(np.float64).T
    return by_noise(frequency, density, degrees, float(np.median(steps)))


def _row(
    mount: str,
    sensor: str,
    axis: int,
    by: str,
    found: Bandwidth | None,
    turns: int = 0,
    reason: str = "",
) -> Row:
    value, sigma, lower = (found.value, found.sigma, found.lower) if found else (None,) * 3
    return {
        "id": f"{with_mount('studies', mount)}/{sensor}/bandwidth_{AXES[axis]}/{by}",
        "mount": mount,
        "sensor": sensor,
        "axis": AXES[axis],
        "by": by,
        "value": value,
        "sigma": sigma,
        "lower": lower,
        "turns": turns,
        "reason": reason,
    }
