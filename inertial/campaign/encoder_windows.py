"""Windows of the angle of a turn, by the table's encoder."""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from inertial.arrays import Array
from inertial.campaign.static_positions import Blocks
from inertial.estimation.gyroscope_observations import EncoderWindow, RateSegment

MAX_WINDOWS = 24  # of a turn: enough for what repeats with each turn of the encoder


def windows_of(part: Blocks, about: Array) -> list[EncoderWindow]:
    """The windows of a turn by its k blocks, none where the encoder is not used in all of them.

    They meet in the steady part alone, where the rate of the table is the same on both sides, so
    that a delay does not matter there; or they end at a gap.
    """
    encoder = part.encoder
    if not len(part) or not np.isfinite(encoder).all() or (part.phase == "turning").any():
        return []
    read = np.nan_to_num(part.gyro) @ about * part.seconds
    sense = float(np.sign(read @ (encoder[:, 1] - encoder[:, 0])))
    steady, apart = part.steady, part.missing != 0
    least = max(1, -(-len(part) // MAX_WINDOWS))
    edges = [0]
    for i in range(1, len(part)):
        if apart[i] or (steady[i - 1] and steady[i] and i - edges[-1] >= least):
            edges.append(i)
    angles = sense * encoder[:, :2]
    windows: list[EncoderWindow] = []
    for first, after in pairwise([*edges, len(part)]):
        joins = windows and not apart[first]
        start = windows[-1].end if joins else float(angles[first, 0])
        change = sense * float(encoder[after - 1, 3] - encoder[first, 2])
        windows.append(
            EncoderWindow(first, after, start, float(angles[after - 1, 1]), change, sense)
        )
    return windows


def by_windows(segment: RateSegment, part: Blocks, angle_sigma: float) -> RateSegment:
    """A turn, or a part of one, by the angle of the encoder; as it is where that is not used.

    What the gyros scatter by in motion beyond their noise at rest is an oscillation, of which a
    window may hold any phase at either end.
    """
    windows = windows_of(part, segment.about)
    if not windows:
        return segment
    excess = np.nan_to_num(segment.density**2 - segment.quiet_density**2) @ segment.about**2
    swing = max(float(excess), 0.0) * float(np.median(part.seconds))
    angle_sigma = float(np.sqrt(angle_sigma**2 + swing))
    middle = windows[0].sense * part.encoder[:, :2].mean(axis=1)
    course = np.asarray(middle - windows[0].start)
    return replace(segment, windows=windows, course=course, angle_sigma=angle_sigma)
