"""The error of navigation after a minute that the named effects cause."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from inertial.arrays import Array
from inertial.campaign.equations import Campaign
from inertial.effects import KNOWN
from inertial.estimation.triad import UNKNOWNS, linear_names
from inertial.physics.effect import GOOD, POOR, USUAL, Effect
from inertial.physics.forward import Triad, signatures, truth_of
from inertial.physics.motion import Motion, cross, turned_all
from inertial.sensors import SENSORS
from stages.extension.estimates import Solved

# ---- How errors of the sensors grow in free inertial navigation over a minute.
#
# With the axes of the laboratory fixed and the attitude known at the start, a rate error δω and an
# error of specific force δf that stay as they are, in these axes, give after t
#
#     attitude  ψ = δω t             velocity  δv = δf t + ψ × (g u) t / 2
#
# u up. So a gyro error grows with t in attitude and with g t²/2 in velocity, an accelerometer
# error with t in velocity. What feedback by gravity (Schuler, a period of 84 min) and the turning
# earth add is of the order of (2π t / 84 min)² / 6 and ω_earth t, below 1 % in a minute. Sources:
# Titterton & Weston, Strapdown Inertial Navigation Technology, 2nd ed. 2004, on the growth of
# errors over short times; Groves, Principles of GNSS, Inertial, and Multisensor Integrated
# Navigation Systems, 2nd ed. 2013, on short-term straight-line error propagation.


SECONDS = 60.0


def grown(rate: Array, force: Array, lift: Array, seconds: float = SECONDS) -> tuple[Array, Array]:
    """Errors of attitude, rad, and of velocity, m/s, after some time, (…, 3) each.

    Parameters
    ----------
    rate, force : (…, 3), rad/s and m/s², errors of the corrected readings
    lift : (…, 3), m/s², the specific force that supports the case: g, upward
    """
    attitude = rate * seconds
    # The attitude as computed has turned too far by ψ, so the specific force is turned by ψ.
    velocity = force * seconds + cross(attitude, lift) * (seconds / 2)
    return attitude, velocity


# ---- The benefit of the extended model: errors of free inertial navigation after a minute.
#
# A user who corrects with M and b of the joint result, and knows nothing of the effects, is off by
#
#     δ = M⁻¹ ((M_e − M) truth + b_e − b + what the effects add to the reading)
#
# where M_e, b_e and the effects are those of the extended fit, taken as the truth. A user of the
# extended result, with the effects, has the errors by which that fit is uncertain. Both are given
# for every manoeuvre of the campaign, as if it lasted a minute: the mean error over it, in the
# axes of the case at its start, propagated by `grown`. Effects of the table and of the site are not
# of the IMU: only their influence on the parameters is included. Only the named effects and the
# motions of the campaign are considered.

Row = dict[str, Any]

MIN_TURN_RATE = 1e-3  # rad/s


@dataclass(frozen=True)
class Change:
    """Extended less joint result of one sensor, with covariance: (p,) and (p, p)."""

    triad: Triad
    values: Array
    covariance: Array
    effects: Sequence[tuple[str, str]]  # effect and parameter, after the twelve


def change_of(solution: Solved, triad: Triad) -> Change | None:
    """The difference of the extended and the joint fit; None where one is not determined."""
    values = [row["value"] for row in solution.rows]
    if any(value is None for value in values):
        return None
    old = np.append((triad.matrix - np.eye(3)).ravel(), triad.bias)
    difference = np.array(values, np.float64)
    difference[:UNKNOWNS] -= old
    assert [row["parameter"] for row in solution.of_sensor] == list(linear_names())
    names = [
        (effect, row["parameter"])
        for effect, row in zip(solution.effects, solution.of_effects, strict=True)
    ]
    return Change(triad, difference, solution.covariance, names)


def worth(
    campaign: Campaign, effects: Sequence[Effect], changes: dict[str, Change], mount: str
) -> Iterator[Row]:
    """One row for every manoeuvre; of a turn its motion counts, not the rests about it."""
    if not changes:
        return
    unit = Triad(np.eye(3), np.zeros(3))
    site, motion = campaign.solution.site, campaign.motion
    gyro, accel = campaign.solution.gyro or unit, campaign.solution.accelerometer or unit
    truth = truth_of(motion, site)
    traces = {
        f"{effect.name}.{parameter.name}": (trace.gyro[:, :, i], trace.accel[:, :, i])
        for effect, trace in zip(
            effects, signatures(motion, site, gyro, accel, effects), strict=True
        )
        for i, parameter in enumerate(effect.parameters)
    }
    known = {"gyro": truth.rate, "accel": truth.force}
    slopes = {
        sensor: _slopes(motion, known[sensor], change, traces, number)
        for number, sensor in enumerate(SENSORS)
        if (change := changes.get(sensor)) is not None
    }
    rotating = np.abs(motion.rate) > MIN_TURN_RATE
    for name, parts in _parts(campaign).items():
        turning = any(rotating[place] for places in parts.values() for place in places)
        own = {s: [place for place in p if rotating[place] == turning] for s, p in parts.items()}
        if all(own.get(sensor) for sensor in slopes):
            row = _row(own, slopes, changes, motion, site.gravity)
            yield {"manoeuvre": name, "mount": mount} | row


def _parts(campaign: Campaign) -> dict[str, dict[str, list[int]]]:
    """Manoeuvre → sensor → the places of its stretches among all stretches of the campaign."""
    whole = [turn.plan.name for turn in campaign.inputs.whole_turns]
    names = [("gyro", position.manoeuvre.name) for position in campaign.inputs.static_positions]
    names += [("gyro", name) for name in whole[: len(campaign.turn_motions)]]
    names += [("gyro", name) for name, _, _ in campaign.steady_rates]
    names += [("gyro", name) for name in (campaign.by_hand.moving if campaign.by_hand else ())]
    names += [("accel", name) for name, _, _ in campaign.static_forces]
    parts: dict[str, dict[str, list[int]]] = {}
    start = 0
    for (sensor, name), motion in zip(names, campaign.motions, strict=True):
        after = start + len(motion.rate)
        if campaign.by_hand and name in campaign.by_hand.moving:
            start = after
            continue
        parts.setdefault(name, {}).setdefault(sensor, []).extend(range(start, after))
        start = after
    return parts


def _slopes(
    motion: Motion,
    truth: Array,
    change: Change,
    traces: dict[str, tuple[Array, Array]],
    number: int,
) -> Array:
    """The corrected error per unit of each parameter, in the axes at the start, (n, p, 3)."""
    n = len(truth)
    slopes = np.zeros((n, len(change.values), 3))
    for i in range(3):
        slopes[:, 3 * i : 3 * i + 3, i] = truth
        slopes[:, 9 + i, i] = 1.0
    for column, (effect, name) in enumerate(change.effects, UNKNOWNS):
        if of_the_imu(effect):
            slopes[:, column] = traces[name][number]
    slopes = slopes @ np.linalg.inv(change.triad.matrix).T
    about = np.broadcast_to(motion.about, motion.up.shape)
    back = [turned_all(slopes[:, i], about, -motion.angle) for i in range(slopes.shape[1])]
    return np.stack(back, axis=1)


def of_the_imu(effect: str) -> bool:
    """Whether an effect is of the IMU, and not of the table or the site."""
    return not set(KNOWN[effect].sizes) <= {GOOD, POOR, USUAL}


def _row(
    own: dict[str, list[int]],
    slopes: dict[str, Array],
    changes: dict[str, Change],
    motion: Motion,
    gravity: float,
) -> Row:
    """The errors of one manoeuvre; `own`: its stretches by sensor."""
    every = [place for places in own.values() for place in places]
    seconds = motion.seconds
    lift = gravity * np.average(motion.up_at_start[every], axis=0, weights=seconds[every])
    errors, spreads = np.zeros((2, 3)), np.zeros((2, 3, 3))
    for sensor, slope in slopes.items():
        places = own[sensor]
        mean = np.average(slope[places], axis=0, weights=seconds[places])  # (p, 3)
        pair = (mean, 0 * mean) if sensor == "gyro" else (0 * mean, mean)
        change = changes[sensor]
        for i, grows in enumerate(grown(*pair, lift)):
            errors[i] += change.values @ grows
            spreads[i] += grows.T @ change.covariance @ grows
    rate = float(np.average(np.abs(motion.rate[every]), weights=seconds[every]))
    return {
        "motion": "turn" if rate > MIN_TURN_RATE else "rest",
        "rate": rate,
        "seconds": SECONDS,
    } | {
        f"{what}_{key}": value
        for what, error, spread in zip(("attitude", "velocity"), errors, spreads, strict=True)
        for key, value in _sizes(error, spread).items()
    }


def _sizes(error: Array, spread: Array) -> Row:
    """An error of the joint result with its sigma, and that of the extended one, rms."""
    size = float(np.linalg.norm(error))
    along = error / size if size else np.ones(3) / np.sqrt(3)
    return {
        "joint": size,
        "joint_sigma": float(np.sqrt(max(along @ spread @ along, 0.0))),
        "extended": float(np.sqrt(max(np.trace(spread), 0.0))),
    }
