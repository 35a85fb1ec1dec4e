"""Where a cause acts: in which sensor, axis, manoeuvre and log, and whether two are one event."""

from collections.abc import Callable
from math import hypot, inf, nan

from inertial.campaign.hypotheses import (
    CLOCK,
    FOUND,
    MOUNTINGS,
    OF_ATTITUDES,
    PLAN,
    TABLE_MOVING,
    Hypothesis,
)

JUMPS = frozenset({"gyro_bias_jump", "accel_bias_jump"})
JUMP_IN_REST = "bias_jump"  # as the readings of one rest show it
RESTARTS = frozenset({"gyro_restarts", "accel_restarts"})
MAX_APART_SIGMAS = 3.0  # of two times of one event
MAX_VAGUE_S = 30.0  # sigma of a time: one that is known no better agrees with any other
MAX_PAUSE_SHARE = 0.1  # of the sigma of a time in a pause, by which those of one pause differ
NOT_KNOWN = nan, nan
MAX_ANGLE_RATIO = 2.0  # of one rotation as two stages have it: a rest shows two components of three
MAX_SHARE_OFF = 0.3  # of a share by which all turns are off, as two stages have it
MAX_OF_READINGS = 10.0  # °, of a turn, that single readings lack: a tenth of a second at 100 °/s
MAX_RATIO_OF_TIMES = 2.0  # of what a clock is off by, as two stages have it

Where = Callable[[Hypothesis, Hypothesis], bool]


def anywhere(cause: Hypothesis, other: Hypothesis) -> bool:
    """In the whole campaign."""
    return True


def same_sensor(cause: Hypothesis, other: Hypothesis) -> bool:
    """In the sensor that the other finding concerns, or either is not about one alone."""
    return None in (cause.sensor, other.sensor) or cause.sensor == other.sensor


def as_large(cause: Hypothesis, other: Hypothesis) -> bool:
    """In the whole campaign, where a time is off by as much as the other finding shows it."""
    shown, own = _share_of_time(other), _share_of_time(cause)
    return not own or shown <= MAX_RATIO_OF_TIMES * own


def shows_wrong_stamps(clock: Hypothesis, turns: Hypothesis) -> bool:
    """Whether turns at the table's rates are off in the time of stamps by what these are off.

    Two clocks, that of the samples and that of the table, then agree against the stamps.
    """
    if clock.cause != CLOCK or (turns.cause, turns.stage) != ("rate_off", PLAN):
        return False
    return bool(abs(1e-6 * clock.row["size"] / (turns.row["size"] - 1) - 1) < MAX_SHARE_OFF)


def _share_of_time(finding: Hypothesis) -> float:
    """By which share times are off, by a ratio or by ppm; 0 where that is not known."""
    if not finding.size:
        return 0.0
    return 1e-6 * finding.size if finding.cause == CLOCK else abs(finding.size - 1)


def where_unresolved(cause: Hypothesis, other: Hypothesis) -> bool:
    """In the whole campaign, where the cause is neither masked nor set right."""
    return cause.unresolved


def same_axis(cause: Hypothesis, other: Hypothesis) -> bool:
    """In the axis that the other finding concerns, or either is not about one alone."""
    one_axis = None in (cause.axis, other.axis) or cause.axis == other.axis
    return same_sensor(cause, other) and one_axis


def same_manoeuvre(cause: Hypothesis, other: Hypothesis) -> bool:
    """In a manoeuvre that the other finding is about."""
    return bool(cause.manoeuvres & other.manoeuvres)


def same_readings(cause: Hypothesis, other: Hypothesis) -> bool:
    """In the axis and in a manoeuvre that the other finding is about."""
    return same_axis(cause, other) and same_manoeuvre(cause, other)


def same_log(cause: Hypothesis, other: Hypothesis) -> bool:
    """In the log that the other finding is about, or in one of its manoeuvres."""
    log = cause.row["log"]
    return (log is not None and log == other.row["log"]) or same_manoeuvre(cause, other)


def by_single_readings(cause: Hypothesis, other: Hypothesis) -> bool:
    """In a manoeuvre, of whose turn readings here and there lack little."""
    whole = other.cause in ("incomplete_turn", "wrong_angle") and other.size > MAX_OF_READINGS
    return same_manoeuvre(cause, other) and not whole


def by_as_much(cause: Hypothesis, other: Hypothesis) -> bool:
    """In all turns, which both say go further by about the same share."""
    if not cause.share or other.share is None:
        return False
    return abs(other.share / cause.share - 1) < MAX_SHARE_OFF


# ---- One event.


def same_time(cause: Hypothesis, other: Hypothesis) -> bool:
    """At the same moment, within the sigmas of both."""
    if cause.time is None or other.time is None:
        return False
    apart = abs(cause.time[0] - other.time[0])
    return apart < MAX_APART_SIGMAS * hypot(cause.time[1], other.time[1])


def at_the_gaps(cause: Hypothesis, gaps: Hypothesis) -> bool:
    """At gaps of a log, none of which cuts a manoeuvre; of a jump: at the only one."""
    if not cause.named or gaps.manoeuvres:
        return False
    if cause.cause in RESTARTS:
        return bool(gaps.row["count"] >= cause.row["count"])
    vague = cause.time is not None and cause.time[1] > MAX_VAGUE_S
    return gaps.row["count"] == 1 and not vague and same_time(cause, gaps)


def is_same_event(cause: Hypothesis, other: Hypothesis) -> bool:
    """Whether one event is both: what tilts in a rest and stays, or biases that one knock changes.

    A shift of the IMU in its fixture stands for the rest in which it tilts, and any tilt for the
    level accelerometer that jumps; of two sensors the one whose time is known better stands for
    both, of restarts the one that shows them without a rival.
    """
    if {cause.cause, other.cause} == RESTARTS and cause.named and other.named:
        return (cause.verdict != FOUND, cause.id) < (other.verdict != FOUND, other.id)
    if not same_time(cause, other) or not cause.named:
        return False
    if cause.cause in MOUNTINGS and other.cause == TABLE_MOVING:
        return _same_angle(cause, other)
    if other.cause == JUMP_IN_REST and not cause.causes.isdisjoint(OF_ATTITUDES):
        return other.sensor == "accel" and cause.time is not None and cause.time[1] < MAX_VAGUE_S
    if {cause.cause, other.cause} != JUMPS or {cause.verdict, other.verdict} != {FOUND}:
        return False
    vague = [one.time[1] for one in (cause, other) if one.time]
    known = max(vague) < MAX_VAGUE_S or _in_one_pause(cause, other)
    return known and (vague[0], cause.id) < (vague[1], other.id)


def _in_one_pause(cause: Hypothesis, other: Hypothesis) -> bool:
    """Whether both are somewhere between the same two manoeuvres, which is what their sigma is."""
    (first, of_first), (second, of_second) = cause.time or NOT_KNOWN, other.time or NOT_KNOWN
    longest = MAX_PAUSE_SHARE * of_first
    return abs(first - second) < longest and abs(of_first - of_second) < longest


def _same_angle(cause: Hypothesis, other: Hypothesis) -> bool:
    """Whether both turn the case by about as much."""
    ratio = (other.angle or 0.0) / (cause.angle or inf)
    return 1 / MAX_ANGLE_RATIO < ratio < MAX_ANGLE_RATIO


def is_of_step(cause: Hypothesis, step: Hypothesis) -> bool:
    """Whether an effect that is named says what the step of one turn means."""
    if not cause.named or cause.causes.isdisjoint((*MOUNTINGS, "turn_angle_error")):
        return False
    return same_manoeuvre(cause, step) or (same_time(cause, step) and _same_angle(cause, step))
