"""What a rest that tilts while it is recorded moves, where no attitude of it is stated."""

from __future__ import annotations

from dataclasses import replace

from inertial.text.parameters import FREE
from inertial.text.units import ARC_SECOND, STANDARD_GRAVITY
from stages.diagnosis.causes import MAX_HARMLESS_MOVE, NONE, Cause
from stages.diagnosis.sensor_results import SensorResult

TILTS = "table_moving"


def bounded(cause: Cause, result: SensorResult) -> Cause:
    """The cause with what it moves of the accelerometers at most, where that is hardly anything.

    By |f| = g a rest counts by the length of its mean force alone, which a tilt by θ shortens by no
    more than g θ²/2; as if all of it went into the least uncertain bias.
    """
    if cause.main.cause != TILTS or cause.cure != NONE or cause.moves is not None:
        return cause
    if result.sensor != "accel" or result.chosen.method != FREE or not result.bias_sigma:
        return cause
    tilts = [abs(each.cause.row["size"] or 0.0) * ARC_SECOND for each in cause.members]
    moves = sum(STANDARD_GRAVITY * tilt**2 / 2 for tilt in tilts) / result.bias_sigma
    return replace(cause, moves=moves) if moves < MAX_HARMLESS_MOVE else cause
