"""Rotations about one body axis in a recording, and the angle and rate that were meant."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from commands.draft.series import MIN_REST_S, Divided
from inertial.arrays import Array

MAX_FACE_ANGLE = np.radians(15)  # of gravity to an axis, that is meant to be a face
MAX_AXIS_ANGLE = np.radians(25)  # of a turn to an axis, that is meant to be about it
MIN_TURN = np.radians(60)  # of an angle, to be a turn
MIN_STRAIGHT = 0.85  # share of all rotation that is about one axis
MAX_OFF_ROUND = 0.12  # of an angle by hand to the quarter turns that are meant
MAX_RIPPLE = 0.02  # of the rate of a table at its steady rate, and of its angle to the round one


def face(vector: Array, most: float = MAX_FACE_ANGLE) -> str | None:
    """The signed axis along a vector, (3,), such as a specific force; None where there is none."""
    if not np.isfinite(vector).all() or not np.linalg.norm(vector):
        return None
    i = int(np.argmax(np.abs(vector)))
    if abs(vector[i]) < np.cos(most) * np.linalg.norm(vector):
        return None
    return f"{'+' if vector[i] > 0 else '-'}{'xyz'[i]}"


@dataclass(frozen=True)
class Turn:
    """A rotation about one body axis, bins [first, after): net angle, (3,), rad, and its rate.

    straight: share of all rotation that is about this axis; rate: rad/s, in its middle half, and
    ripple, the scatter of it, relative.
    """

    first: int
    after: int
    net: Array
    straight: float
    rate: float
    ripple: float

    @property
    def angle(self) -> float:
        """Without its sign, rad."""
        return float(np.linalg.norm(self.net))

    @property
    def axis(self) -> str:
        """The signed axis nearest to it."""
        return face(self.net, np.pi) or "+z"


def turns_in(own: Divided) -> Iterator[Turn]:
    """Rotations about one axis; what follows about the same one after a pause belongs to it."""
    moves = [stretch for stretch in own.stretches if stretch.moves]
    pause = MIN_REST_S / own.series.bin_seconds()
    while moves and len(own.series.gyro):
        first, after = moves[0].first, moves[0].after
        turn = _rotation(own, first, after)
        used = 1
        for stretch in moves[1:]:
            if stretch.first - after >= pause:
                break
            further = _rotation(own, stretch.first, stretch.after)
            if further.net @ turn.net < np.cos(MAX_AXIS_ANGLE) * further.angle * turn.angle:
                break
            after, used = stretch.after, used + 1
            turn = _rotation(own, first, after)
        moves = moves[used:]
        large = turn.angle > MIN_TURN or (first == 0 and after == own.series.bins)
        if turn.straight > MIN_STRAIGHT and large and face(turn.net, MAX_AXIS_ANGLE):
            yield turn


def _rotation(own: Divided, first: int, after: int) -> Turn:
    """What the gyros have between two bins, and what is slow just before and after."""
    step = own.series.bin_seconds()
    rates = (own.rates - own.level)[max(first - 2, 0) : after + 2]
    net = rates.sum(axis=0) * step
    axis = net / (np.linalg.norm(net) or 1.0)
    path = float(np.linalg.norm(rates, axis=1).sum() * step)
    k = len(rates)
    middle = (rates @ axis)[k // 4 : max(k - k // 4, k // 4 + 1)]
    rate = float(middle.mean())
    ripple = float(middle.std() / abs(rate)) if rate and len(middle) > 3 else 1.0
    return Turn(first, after, net, float(np.linalg.norm(net)) / (path or 1.0), rate, ripple)


def about_vertical(own: Divided) -> dict[int, Turn]:
    """The turns about the vertical, by the number of the rest before each."""
    rests = own.rests
    turns = {}
    for turn in turns_in(own):
        before = sum(rest.after <= turn.first + 1 for rest in rests) - 1
        behind = sum(rest.first < turn.after - 1 for rest in rests)
        if before >= 0 and behind == before + 1 < len(rests):
            up = face(rests[before].accel)
            if up and up == face(rests[behind].accel) and up[1] == turn.axis[1]:
                turns[before] = turn
    return turns


def round_angle(seen: float, by_table: bool) -> float:
    """The angle that was meant: a multiple of 90°, or of 5° where none is near."""
    quarters = np.round(seen / 90) or np.sign(seen)
    off = abs(seen / (90 * quarters) - 1)
    if off < (MAX_RIPPLE if by_table else MAX_OFF_ROUND):
        return float(90 * quarters)
    return float(5 * np.round(seen / 5))


def rounded_rate(rate: float) -> float:
    """A rate as one sets it, to one or two digits where that is near, °/s."""
    for digits in (1, 2):
        plain = float(f"{rate:.{digits}g}")
        if abs(plain / rate - 1) < MAX_RIPPLE / 2:
            return plain
    return float(f"{rate:.3g}")
