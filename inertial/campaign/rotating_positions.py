"""The accelerometers while the table turns steadily: as good as a rest, with a known pull.

A whole turn shows every accelerometer its part of gravity for as long as a rest. It also pulls at
the case: f += ω × (ω × r), with an unknown lever arm r from the table's axis, for each of the three
its own. At a steady rate only the component of r along the accelerometer counts, so three unknowns
are enough; ramps, where the others count too, are left out.
"""

from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.recorded_turns import gaps_of, refusal_of, weights_of
from inertial.campaign.records import Manoeuvre, Part
from inertial.campaign.static_positions import (
    Blocks,
    by_manoeuvre,
    case_axes,
    level_axes_of,
    of_faster_waves,
    stretch_of,
    turn_errors,
)
from inertial.estimation.accelerometers import StaticForce
from inertial.estimation.effect_information import Sensitivities
from inertial.estimation.noise_model import sigma_of_mean
from inertial.physics.motion import is_vertical, mean_turned
from inertial.tables import ACCEL, AXES, GYRO, STATIC_PHASES

LEVER_ARM = {f"lever_arm.{axis}": 0.1 for axis in AXES}  # m, sigma: no IMU is mounted farther off
# How far the vertical, or in an upright turn a level axis, may turn in the case within one mean.
MAX_TURN_IN_MEAN, MAX_UPRIGHT = np.radians(10), np.radians(60)


def turning_rests(data: CampaignData) -> list[tuple[Part, StaticForce]]:
    """The steady parts of all whole turns, each with its manoeuvre, in means of like attitude.

    The `sensitivities` of each are those of LEVER_ARM.
    """
    blocks, performed = data.blocks, data.performed
    moving = by_manoeuvre(blocks[~blocks["phase"].isin(STATIC_PHASES)])
    quiet = by_manoeuvre(blocks[blocks["phase"].isin(["rest-before", "rest-after"])])
    forces: list[tuple[Part, StaticForce]] = []
    for m in data.plan:
        if m.do != "turn" or m.recorded != "whole" or m.up is None or m.name not in moving:
            continue
        part = moving[m.name]
        usable = performed[m.name].complete and not refusal_of(m, performed[m.name], part)
        if usable and m.name in quiet and bool(part.steady.any()):
            density, of_gyros = (data.noise.of(m.name, "steady", own) for own in (ACCEL, GYRO))
            walk = float(np.linalg.norm(np.nan_to_num(of_gyros) * m.axis))
            walk *= float(np.sqrt(part.seconds.sum()))
            swing = data.noise.of_integral(m.name, "steady", "accel")
            stretch = stretch_of(m, part.those(part.steady), data.shared_clock)
            forces += [
                (Part(m.name, "steady"), replace(rest, stretch=stretch))
                for rest in _steady(m, part, quiet[m.name], density, swing, walk)
            ]
    return forces


def _steady(
    m: Manoeuvre, part: Blocks, quiet: Blocks, density: Array, swing: Array, walk: float
) -> list[StaticForce]:
    """Means of blocks of the steady part, over which the attitude is nearly constant.

    `density`: white noise; `swing`: of the integral, as `of_integral`; `walk`: as in `turn_errors`.
    """
    assert m.up is not None and m.angle is not None  # else it is left out
    readings, seconds = part.accel, part.seconds
    angle = _angles(m, part, quiet)
    steady = np.flatnonzero(part.steady)
    middle = np.cumsum(angle) - angle / 2
    for gap in gaps_of(part):
        middle[gap.before :] += gap.shares @ angle
    ups = mean_turned(m.up, m.axis, middle, angle)
    axes = np.stack([mean_turned(own, m.axis, middle, angle) for own in level_axes_of(m)], axis=1)
    level = np.linalg.norm(m.up - (m.up @ m.axis) * m.axis)
    rate = angle / seconds
    upright = is_vertical(m.up, m.axis)
    turned = abs(float(angle[steady].sum()))
    means = turned / MAX_UPRIGHT if upright else turned * float(level) / MAX_TURN_IN_MEAN
    pieces = np.array_split(steady, max(1, int(np.ceil(means))))
    rests = []
    for indices in (piece for piece in pieces if len(piece)):
        share = seconds[indices] / seconds[indices].sum()
        square = float(share @ rate[indices] ** 2)
        up = share @ ups[indices]
        noise = sigma_of_mean(density, swing, seconds[indices].sum())
        pull = square * (np.outer(m.axis, m.axis) - np.eye(3))  # ω × (ω × r) of r
        rests.append(
            StaticForce(
                m.position,
                up,
                share @ readings[indices],
                np.hypot(noise, of_faster_waves(m, up, walk)),
                sensitivities=Sensitivities(tuple(LEVER_ARM), pull),
                felt=True,
                turning=True,
                level=np.tensordot(share, axes[indices], 1),
                case=case_axes(m.up, m.axis),
                turn_errors=turn_errors(m, float(share @ middle[indices]) / m.angle, walk),
            )
        )
    return rests


def _angles(m: Manoeuvre, part: Blocks, quiet: Blocks) -> Array:
    """The angle of each block, (k,), rad: the known whole in proportion to the gyro readings."""
    assert m.angle is not None  # else it is left out
    along = np.nan_to_num(part.gyro) @ m.axis
    offset = float(np.nan_to_num(quiet.gyro @ m.axis).mean())
    increments = (along - offset) * part.seconds
    return np.asarray(increments * (m.angle / (weights_of(part) @ increments)))
