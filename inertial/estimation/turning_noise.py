"""Whose the noise in motion is: of the gyros, whose angles scatter by it, or of the table.

A table that jitters has turned by the stated angle all the same, and its noise cancels in the sum
over a turn. Noise of the gyros that grows with the rate, of a scale factor that fluctuates, adds up
in it. Turns about the same axis of the IMU, in the same sense, by the same angle and in the same
time, tell: whatever the scale factor is, and however it goes with the rate, is alike in them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.estimation.gyroscope_observations import RateSegment, StaticRate

MIN_LOG_ODDS = 3.0  # that it is of the gyros: 20 to 1


def with_turning_noise(
    turns: Sequence[RateSegment], rests: Sequence[StaticRate]
) -> list[RateSegment]:
    """The turns; where the noise in motion is of the gyros, with it in their angles.

    Then it is that of all turns that are alike: of one, some seconds of a steady part tell little.
    `rests`: the biases, with the vertical component of the earth's rate, at the same positions.
    """
    best: dict[str, StaticRate] = {}
    for rest in rests:
        name = rest.position.name
        if name not in best or rest.sigma.max() < best[name].sigma.max():
            best[name] = rest
    alike: dict[tuple[int, ...], list[RateSegment]] = {}
    for turn in turns:
        alike.setdefault(_motion(turn), []).append(turn)
    odds = sum(_log_odds(group, best) for group in alike.values())
    if not odds > MIN_LOG_ODDS:
        return list(turns)
    found = []
    for turn in turns:
        density = np.sqrt(np.mean([one.density**2 for one in alike[_motion(turn)]], axis=0))
        quiet = np.fmax(density, turn.quiet_density)
        found.append(replace(turn, density=density, quiet_density=quiet))
    return found


def _motion(turn: RateSegment) -> tuple[int, ...]:
    """By what turns are alike: the turn as a vector, °, and its duration, s."""
    angle = 0.0 if np.isnan(turn.angle) else turn.angle
    turned = np.rint(np.degrees(angle * turn.about)).astype(int).tolist()
    return (*turned, round(float(turn.seconds.sum())))


def _log_odds(turns: Sequence[RateSegment], rests: Mapping[str, StaticRate]) -> float:
    """That the angles of turns that are alike scatter by the noise in motion, and not at rest's."""
    values, variances = [], []
    for turn in turns:
        rest, about = rests.get(turn.position.name), turn.about
        if rest is None or turn.by_hand or np.isnan(turn.angle):
            continue
        if not np.isfinite(rest.sigma[about != 0]).all():  # a gyro that was not recorded
            continue
        seconds = float(turn.weights @ turn.seconds)
        along = np.sign(turn.angle) * about  # alike in all of them
        summed = float(np.nan_to_num(turn.weights @ turn.sums - rest.mean * seconds) @ along)
        white = np.array([turn.quiet_density, np.fmax(turn.density, turn.quiet_density)])
        of_rest = rest.sigma[about != 0] ** 2 @ about[about != 0] ** 2 * seconds**2
        ends = 2 * turn.quantisation**2 @ about**2
        known = turn.angle_sigma**2 + turn.gap_sigma**2 + of_rest + ends
        values.append(summed)
        variances.append(np.nan_to_num(white**2) @ about**2 * seconds + known)
    if len(values) < 2:
        return 0.0
    quiet, moving = (_log_likelihood(np.array(values), own) for own in np.array(variances).T)
    return moving - quiet


def _log_likelihood(values: Array, variances: Array) -> float:
    """Of normal values of a common unknown mean, restricted, without constants."""
    weights = 1 / variances
    off = values - weights @ values / weights.sum()
    return float(-(np.log(variances).sum() + np.log(weights.sum()) + weights @ off**2) / 2)
