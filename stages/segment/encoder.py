"""The angle of the table's encoder in place of the stated angles and rates of turns."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import degrees

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.records import Manoeuvre
from inertial.tables import GYRO, STATIC_PHASES
from inertial.text.messages import _
from inertial.text.numbers import fixed, significant

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ByEncoder:
    """A turn as its encoder has it, and what the report says of that, empty without an encoder."""

    manoeuvre: Manoeuvre
    remark: str = ""


def by_encoder(
    m: Manoeuvre, blocks: pd.DataFrame, angle_sigma: float, tolerance: float
) -> ByEncoder:
    """A turn with the angle, or of a steady part the rate, that the encoder reads.

    From the mean angle at rest before it to the one after, or by the straight line through the
    blocks of the steady part. The sigma of an angle stays the stated one of the table, which is
    that of its encoder. Readings that differ from the gyros' by more than `tolerance`, relative,
    belong to another axis or have another unit, and are not used. `blocks`: all of the turn;
    `angle_sigma`: of the table, rad.
    """
    steady = m.recorded == "steady"
    found = _rate(blocks, angle_sigma) if steady else _angle(blocks)
    moving = blocks[~blocks["phase"].isin(STATIC_PHASES)]
    seconds = moving["seconds"].to_numpy(np.float64)
    about = moving[GYRO].to_numpy(np.float64)[:, m.axis != 0] @ m.axis[m.axis != 0]
    read = float(np.nansum(about * seconds))
    if found is None or not np.isfinite(found[0]) or read == 0:
        return ByEncoder(m)
    value, sigma = found
    value = float(np.copysign(value, read))
    by_gyro = read / float(np.nansum(seconds)) if steady else read
    if (blocks["missing_s"] > 0).any() and m.angle is not None and not steady:
        by_gyro = m.angle  # what the gyros lack lies in a gap
    if abs(value - by_gyro) > tolerance * abs(by_gyro):
        return ByEncoder(
            m,
            _(
                "The encoder's {value}° contradict the gyros' {by_gyro}° and are not used.",
                value=significant(degrees(value), 4),
                by_gyro=significant(degrees(by_gyro), 4),
            ),
        )
    if steady:
        return ByEncoder(
            replace(m, rate=value, rate_sigma=sigma),
            _("The rate is the encoder's, {rate} °/s.", rate=fixed(degrees(value), 5)),
        )
    return ByEncoder(
        replace(m, angle=value),
        _("The angle is the encoder's, {angle}°.", angle=fixed(degrees(value), 4)),
    )


def _angle(blocks: pd.DataFrame) -> tuple[float, float] | None:
    """The angle from rest to rest, rad."""
    ends = [_mean(blocks[blocks["phase"] == phase]) for phase in ("rest-before", "rest-after")]
    return (ends[1] - ends[0], 0.0) if np.isfinite(ends).all() else None


def _mean(blocks: pd.DataFrame) -> float:
    angle, count = (blocks[name].to_numpy(np.float64) for name in ("table_angle", "count"))
    known = np.isfinite(angle) & (count > 0)
    return float(np.average(angle[known], weights=count[known])) if known.any() else np.nan


def _rate(blocks: pd.DataFrame, angle_sigma: float) -> tuple[float, float] | None:
    """The rate of the steady part and its sigma, rad/s, by that of the angle at both ends."""
    own = blocks[blocks["phase"] == "steady"]
    angle, time = (own[name].to_numpy(np.float64) for name in ("table_angle", "time"))
    if len(own) < 2 or not (np.isfinite(angle) & np.isfinite(time)).all():
        return None
    lasts = float(time[-1] - time[0])
    return float(np.polyfit(time - time[0], angle, 1)[0]), np.sqrt(2) * angle_sigma / lasts


def plan_by_encoder(
    plan: Sequence[Manoeuvre], blocks: pd.DataFrame, angle_sigma: float, tolerance: float
) -> dict[str, ByEncoder]:
    """The turns of a plan of which the encoder was recorded, by name."""
    recorded = blocks[np.isfinite(blocks["table_angle"].to_numpy(np.float64))]["manoeuvre"]
    named = set(recorded)
    own = dict(list(blocks[blocks["manoeuvre"].isin(named)].groupby("manoeuvre")))
    turns = (m for m in plan if m.do == "turn" and m.name in own)
    return {m.name: by_encoder(m, own[m.name], angle_sigma, tolerance) for m in turns}
