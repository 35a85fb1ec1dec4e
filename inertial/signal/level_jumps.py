"""Channels that jump within a rest, and whether the IMU was moved then."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from inertial.signal.detector import CHANNELS, Booleans, Integers, Log, Piece
from inertial.signal.static_tilt import UNCONFIRMED, Agreement, Resting
from inertial.signal.steps import MAX_SIDE_S, Step, steps

FALSE_ALARM_LEVEL = 1e-4  # accepted for one false jump in a campaign
CAMPAIGN_RESTS = 50  # of a campaign that pays for the search in each; a rest has six channels
SHAKE_BLOCK_S = 0.1  # s of a block in which a knock is sought
# Sigmas by which two level axes must jump for a tilt, where no gyro confirms it
MIN_TILT_SIGMA = 5.0


@dataclass(frozen=True)
class Jump:
    """A step of one channel of a rest, and how far the other sensor confirms a motion."""

    channel: int
    step: Step
    agreement: Agreement
    moved: bool


@lru_cache(maxsize=1)  # two detectors use it, one rest after another
def jumps(piece: Piece, log: Log) -> tuple[Resting, list[Jump]]:
    """A rest, and all its jumps, channel by channel."""
    resting = Resting(piece, log)
    if not np.isfinite(log.interval):
        return resting, []
    all_steps: list[tuple[int, Step]] = []
    for i in range(len(CHANNELS)):
        there, read = piece.channel(i)
        if not np.isfinite(resting.noise[i]):
            continue
        interval = log.interval * len(piece) / len(there)
        level = FALSE_ALARM_LEVEL / (CAMPAIGN_RESTS * len(CHANNELS))
        for step in steps(read, interval, float(np.nan_to_num(log.quantum[i])), level):
            all_steps.append((i, _in_records(step, there)))
    knocked = np.repeat(shaken(resting), _length(resting))
    all_steps = [
        (i, step) for i, step in all_steps if not knocked[step.place - 1 : step.place + 1].any()
    ]
    return resting, [_judged(i, step, all_steps, resting) for i, step in all_steps]


def shaken(resting: Resting) -> Booleans:
    """Which blocks of 0.1 s jerk in both sensors, (k,)."""
    return resting.shaken(_length(resting))


def _length(resting: Resting) -> int:
    return max(round(SHAKE_BLOCK_S / resting.interval), 5)


def _in_records(step: Step, there: Integers) -> Step:
    p_value = min(step.p_value * CAMPAIGN_RESTS * len(CHANNELS), 1.0)
    place, earliest, latest = there[[step.place, step.earliest, step.latest]].tolist()
    return replace(step, place=place, earliest=earliest, latest=latest, p_value=p_value)


def _judged(i: int, step: Step, all_steps: list[tuple[int, Step]], resting: Resting) -> Jump:
    """A jump with the agreement of the other sensor, between the other jumps of the same sensor."""
    if not resting.recorded("accel"):
        return Jump(i, step, UNCONFIRMED, False)
    same = [other for j, other in all_steps if (j < 3) == (i < 3)]
    longest = round(MAX_SIDE_S / resting.interval)
    earlier = [other.latest for other in same if other.latest < step.earliest]
    later = [other.earliest for other in same if other.earliest > step.latest]
    start = max([0, step.place - longest, *earlier])
    stop = min([len(resting), step.place + longest, *later])
    if i >= 3:
        agreement = resting.speeded(start, step.place, stop)
        return Jump(i, step, agreement, agreement.moved)
    _, agreement = resting.shifted(start, step.earliest, step.latest, stop)
    if agreement.conclusive:
        return Jump(i, step, agreement, agreement.moved)
    # Without a gyro that confirms it: a jump of one axis is a bias, of both level axes a tilt.
    others = [
        other for j, other in all_steps if j < 3 and j != i and abs(other.place - step.place) <= 2
    ]
    level = [j for j in range(3) if abs(resting.up[j]) < 0.5]
    both = i in level and any(abs(other.size) > MIN_TILT_SIGMA * other.sigma for other in others)
    return Jump(i, step, agreement, both)
