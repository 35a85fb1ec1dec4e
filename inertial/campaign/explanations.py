"""What each cause explains: the findings that it removes once it is corrected or modelled.

One table, read from top to bottom: a cause, what it makes other stages report, and where it does.
"""

from dataclasses import dataclass

from inertial.campaign.hypotheses import (
    JUMP_NOT_TESTABLE,
    LAW,
    MIN_SPOILING,
    MODEL,
    MOUNTINGS,
    ONE_OF_CLASS,
    POSITIONS,
    RECORDING,
    STEP_IN_TURN,
    ZERO_SHIFTS,
    Hypothesis,
)
from inertial.campaign.where_causes_act import (
    JUMPS,
    RESTARTS,
    Where,
    anywhere,
    as_large,
    at_the_gaps,
    by_as_much,
    by_single_readings,
    is_of_step,
    is_same_event,
    same_axis,
    same_log,
    same_manoeuvre,
    same_readings,
    same_sensor,
    where_unresolved,
)
from inertial.sensors import SENSORS

# ---- Which findings.


def _same_cause(cause: Hypothesis, other: Hypothesis) -> bool:
    """Another stage has the same cause, or the same physics by its own name for it."""
    kind = {_KIND.get(name, name) for name in cause.causes}
    return not kind.isdisjoint(_KIND.get(name, name) for name in other.causes)


# What the recording shows as one thing and the model by several names.
PERIODIC = ("oscillation", "table_ripple", "table_eccentricity")
_KIND = {
    name: kind
    for kind, names in {
        "bias jump": ("bias_jump", "gyro_bias_jump", "accel_bias_jump", *MOUNTINGS),
        "periodic": PERIODIC,
        "temperature": (
            "temperature_drift",
            *(f"{s}_{what}" for s in SENSORS for what in ("warm_up", "bias_ramp", "scale_ramp")),
            *(f"{s}_temperature" for s in SENSORS),
            *(f"{s}_{what}_temperature" for s in SENSORS for what in ("bias", "scale")),
        ),
        "saturation": ("saturation", "gyro_saturation", "accel_saturation"),
        "scale of counts": ("wrong_scale_factor", "wrong_scale_of_turns", "wrong_imu_type"),
        "axes": ("axis_swap", "sign_flip"),
    }.items()
    for name in names
}
ANOTHER_IMU = "another_imu"
PER_RUN = ("accel_bias_per_log", "gyro_bias_per_log")
MISFITS = ("unexplained", "unknown_structure", "rest_scatter")
PERFORMANCE = (
    "incomplete_turn",
    "wrong_angle",
    "wrong_rate",
    "wrong_direction",
    "wrong_scale_of_turns",
    "manoeuvre_missing",
    "short_rest",
    "table_moving",
)
SET_RIGHT = ("applied", "confirmed")  # states of a repair
# Faults that change all that a sensor reads: from what they spoil no effect is named. A wrong clock
# changes it in proportion, so only effects in proportion to a rate, a force, or the earth's rate.
SPOILING = (
    "clock_scale",
    "wrong_time_unit",
    "wrong_scale_factor",
    "wrong_imu_type",
    "wrong_direction",
    "axis_swap",
    "sign_flip",
    "samples_lost",
    "normalised_force",
)
OF_ANGLES = ("clock_scale", "samples_lost")  # of these what is in proportion, and one turn's angle
# What a gyro seems to have where the angles of turns are off, each by another amount.
BY_ANGLES_OF_TURNS = (
    "turn_angle_error",
    "table_angle_scale",
    "gyro_scale_asymmetry",
    "gyro_scale_quadratic",
    "sense_of_turns",
)
OF_TRIADS = ("axis_swap", "sign_flip", "wrong_scale_factor", "manoeuvre_swapped")
IN_PROPORTION = frozenset(
    {
        "gyro_scale_asymmetry",
        "gyro_scale_quadratic",
        "gyro_scale_cubic",
        "gyro_scale_g_dependence",
        "gyro_cross_axis_squares",
        "gyro_rate_products",
        "gyro_scale_ramp",
        "gyro_scale_jump",
        "gyro_scale_temperature",
        "accel_scale_asymmetry",
        "accel_scale_ramp",
        "accel_scale_jump",
        "accel_scale_temperature",
        "gyro_bias_of_position",  # of a log that is one position
        "accel_bias_of_position",
        "table_speed_error",
        "table_tilt",
        "table_tilt_ramp",
        "table_tilt_jump",
        "table_axis_non_orthogonality",
        "table_inner_axis",
        *ZERO_SHIFTS,
        "table_position_error",
        "table_axis_error",
        "table_wobble",
        "table_eccentricity",
        "tumble_eccentricity",
        "table_ripple",
        "table_angle_scale",
        "gravity_error",
        "latitude_error",
        "latitude_sign",
        "earth_rate_omitted",
        "clock_scale",
    }
)
POSITION_OFF = ("table_position_error", "table_axis_error")
MAX_TILT_S = 4.0  # s: what turns for longer in a rest creeps
OF_A_PULSE = ("impact", "spike", "saturation", "dead_axis", "clock_step", "samples_lost", "gap")
LOST_RECORDS = ("gap", "duplicate", "held_record", "time_backwards", "time_stands_still")


@dataclass(frozen=True)
class Explanation:
    """What these causes explain, and where they do."""

    causes: tuple[str, ...]
    findings: tuple[str, ...]
    where: Where


RELAXATIONS = ("gyro_relaxation", "gyro_relaxation_sense", "gyro_relaxation_braking")
EXPLANATIONS = (
    # Readings that are no readings of this motion: the manoeuvre looks other than planned.
    Explanation(
        ("saturation", "impact", *LOST_RECORDS, "status_invalid", "clock_step"),
        PERFORMANCE,
        same_manoeuvre,
    ),
    Explanation(("spike", "periodic_glitch"), PERFORMANCE, by_single_readings),
    Explanation(
        ("dead_axis", "saturation", "zero_below_threshold"),
        (*PERFORMANCE, "oscillation", "quantisation", *MISFITS),
        same_axis,
    ),
    Explanation(("dead_axis", "zero_below_threshold"), ("bias_jump",), same_axis),
    # Of two axes the specific force at rest is no gravity.
    Explanation(("dead_axis",), ("wrong_scale_factor",), same_sensor),
    # A motion beyond the range does not explain findings of a rest before or after it.
    Explanation(("saturation",), ("bias_jump",), same_readings),
    # Once in every period a reading is off: those that were not masked look like spikes.
    Explanation(("periodic_glitch",), ("spike",), same_axis),
    # Columns that do not hold what they should.
    Explanation(
        ("copied_channel", "gravity_removed", "normalised_force", "bias_removed"),
        (*PERFORMANCE, *MISFITS, *OF_TRIADS),
        same_sensor,
    ),
    Explanation(("copied_log",), (*PERFORMANCE, *OF_TRIADS, "gap", "time_backwards"), same_log),
    # Where the IMU was switched off and on, nothing is recorded meanwhile.
    Explanation(tuple(JUMPS | RESTARTS), ("gap",), at_the_gaps),
    # Axes, signs, units: they change everything that their sensor reads.
    Explanation(
        ("axis_swap", "sign_flip", "wrong_scale_factor", "wrong_imu_type", "wrong_direction"),
        (*PERFORMANCE, "wrong_scale_factor", "manoeuvre_swapped", "gravity_error"),
        same_sensor,
    ),
    # North, and with it the earth's rate, is taken in another direction than it is.
    Explanation(
        ("wrong_mark",), (*MISFITS, "gyro_drift", "gyro_random_walk", "heading_error"), same_sensor
    ),
    # Gyros that turn gravity otherwise than the accelerometers see it turn: by hand the angles
    # between rests, and with them a count size, are by axes of which nobody knows which are right.
    Explanation(
        ("axis_swap", "sign_flip"), ("gyro_count_size", "gyro_scale_of_axes"), where_unresolved
    ),
    Explanation(("wrong_scale_factor", "wrong_imu_type"), ("noise_above_data_sheet",), same_sensor),
    Explanation(("manoeuvre_swapped",), PERFORMANCE, same_log),
    # A clock that is set, or runs wrong, by what its stamps then look like.
    Explanation(
        ("clock_step", "time_backwards", "time_stands_still"),
        ("gap", "clock_jitter", "rate_off", "time_backwards", "duplicate"),
        same_log,
    ),
    # Whenever a counter begins again, what it counts is cut.
    Explanation(("time_backwards",), ("short_rest",), same_log),
    Explanation(("clock_scale", "rate_off"), ("clock_scale", "rate_off", "wrong_rate"), as_large),
    # Level turns show by gravity that it is the angle, neither the samples nor the speed.
    Explanation(("table_angle_scale",), ("rate_off",), by_as_much),
    Explanation(("table_eccentricity",), ("tumble_eccentricity",), anywhere),
    Explanation(("encoder_scale", "encoder_scale_or_eccentricity"), ("rate_off",), anywhere),
    Explanation(("encoder_angles",), (*BY_ANGLES_OF_TURNS, *MISFITS), same_sensor),
    Explanation(("clock_scale", "rate_off"), ("table_rate_off",), as_large),
    Explanation(("table_rate_off",), ("wrong_rate",), anywhere),
    Explanation(
        ("wrong_time_unit",),
        (*PERFORMANCE, *MISFITS, "wrong_scale_factor", "clock_scale", "bias_jump"),
        anywhere,
    ),
    Explanation(("gravity_error",), ("wrong_scale_factor", "gravity_error", *MISFITS), same_sensor),
    Explanation(("latitude_error",), ("gravity_error",), anywhere),
    Explanation(
        ("fixture_creep",),
        (*MISFITS, "accel_random_walk", "bias_jump", "table_moving", "position_not_kept"),
        anywhere,
    ),
    # Behind it a rest after a motion begins with what is left of that.
    Explanation(
        ("slow_low_pass",),
        (*MISFITS, "position_not_kept", "table_moving", "accel_random_walk"),
        where_unresolved,
    ),
    Explanation(("samples_lost",), MISFITS, same_sensor),
    Explanation(
        ("position_not_kept",),
        (*MISFITS, "accel_random_walk", "bias_jump"),
        anywhere,
    ),
    # A rate that is another after each turn looks like a bias that wanders, or that remembers.
    Explanation(
        ("motion_after_turns",),
        (*MISFITS, "gyro_random_walk", "gyro_hysteresis", "gyro_bias_sense", *RELAXATIONS),
        same_sensor,
    ),
    # What was recorded is no turn as planned, at whatever rate it is.
    Explanation(("incomplete_turn", "wrong_angle"), ("wrong_rate",), same_manoeuvre),
    # By hand a position whose specific force is not gravity is left out, with what it shows.
    Explanation(("moved_while_read",), ("bias_jump",), same_manoeuvre),
    # A table that moves: the readings are right, the position is not the planned one.
    Explanation(
        ("table_moving", "impact"),
        ("bias_jump", "oscillation", *POSITION_OFF, *PERFORMANCE),
        same_manoeuvre,
    ),
)


def explains(cause: Hypothesis, other: Hypothesis) -> bool:
    """Whether the other finding vanishes where this cause is true."""
    if cause is other or not _same_mount(cause, other) or _set_right_by_another(cause, other):
        return False
    if _represents(cause, other) and _same_cause(cause, other) and same_sensor(cause, other):
        return True
    if ANOTHER_IMU in (cause.cause, other.cause):  # whatever the model says is of two instruments
        return cause.cause == ANOTHER_IMU and other.stage == MODEL
    if STEP_IN_TURN in (cause.cause, other.cause) or is_same_event(cause, other):
        return _explains_event(cause, other)
    return _explains(cause, other)


def _explains(cause: Hypothesis, other: Hypothesis) -> bool:
    """The same of what is no event by itself."""
    if other.stage == POSITIONS:
        return _explains_position(cause, other)
    if other.cause == "bias_jump" and _without_law(cause):
        return cause.sensor == other.sensor
    if other.cause == "bias_jump" and cause.verdict == LAW:  # beside which no structure is left
        return same_axis(cause, other)
    # Each log lacks a mean of its own: no biases changed, so none of the other sensor may have.
    if cause.cause == "bias_removed" and other.cause in (*PER_RUN, JUMP_NOT_TESTABLE):
        return same_sensor(cause, other) == (other.cause in PER_RUN)
    if _uncertain(other):
        return _explains_uncertain(cause, other)
    if other.cause in PERIODIC and _without_law(cause):  # a spectrum of what is there, as of a step
        return bool(cause.manoeuvres) and cause.manoeuvres == other.manoeuvres
    if other.named:
        return _explains_named(cause, other)
    return any(
        cause.cause in rule.causes and other.cause in rule.findings and rule.where(cause, other)
        for rule in EXPLANATIONS
    )


def _explains_event(cause: Hypothesis, other: Hypothesis) -> bool:
    """Whether an event is what an effect says of it, or leaves what no effect explains."""
    if other.cause == STEP_IN_TURN and cause.cause == "quantisation":  # a count for less than 1 s
        return same_sensor(cause, other) and other.size < cause.size
    if other.cause == STEP_IN_TURN and cause.cause in OF_A_PULSE:
        return cause.unresolved and same_manoeuvre(cause, other)
    if other.cause == STEP_IN_TURN:
        return is_of_step(cause, other)
    if cause.cause == STEP_IN_TURN:
        return other.cause in MISFITS and same_readings(cause, other)
    return True


def _explains_named(cause: Hypothesis, other: Hypothesis) -> bool:
    """The same of an effect that was named."""
    if not same_sensor(cause, other):
        return False
    if cause.cause == "quantisation":  # a steady rate in coarse counts goes in regular steps
        beats = other.cause == "oscillation" and other.size < cause.size
        return beats and (cause.unresolved or other.verdict == ONE_OF_CLASS)
    if not cause.unresolved or cause.alike:  # that clock is in the scale factors, and nowhere else
        return False
    if cause.cause == "bias_removed":  # at rest, and with it the earth's rate
        return "earth_rate_omitted" in other.causes
    if cause.cause == "encoder_angles":
        return not other.causes.isdisjoint(BY_ANGLES_OF_TURNS)
    if cause.cause in ("position_not_kept", "fixture_creep"):
        return other.cause in ("position_scatter", *MOUNTINGS, *POSITION_OFF)
    if cause.cause not in OF_ANGLES:
        return cause.cause in SPOILING
    of_one_turn = cause.cause == "samples_lost" and "turn_angle_error" in other.causes
    return of_one_turn or _in_proportion(other)


def is_of_wrong_place(cause: Hypothesis, other: Hypothesis) -> bool:
    """Whether gravity was replaced by that of a latitude which the gyros contradict."""
    wrong = cause.named and cause.cause == "latitude_error"
    return wrong and other.cause == "gravity_error" and other.repair is not None


def has_own_error(cause: Hypothesis) -> bool:
    """Whether it is a position off by degrees, whose attitude is an unknown of the result."""
    return cause.stage == POSITIONS and int(cause.row["severity"]) < MIN_SPOILING


def _set_right_by_another(cause: Hypothesis, other: Hypothesis) -> bool:
    """Whether a repair of its own sets the other right, so that the cause alone does not."""
    if other.repair is None or other.repair["state"] not in SET_RIGHT:
        return False
    if is_of_wrong_place(cause, other):  # so it was not right
        return False
    return cause.repair is None or cause.repair["id"] != other.repair["id"]


def _in_proportion(effect: Hypothesis) -> bool:
    """Whether it changes readings in proportion, or by a law that may be any change of one log."""
    return effect.verdict == LAW or not IN_PROPORTION.isdisjoint(effect.causes)


def _represents(cause: Hypothesis, other: Hypothesis) -> bool:
    """Whether it stands for another finding of the same thing: of two alike the one of the logs."""
    by_logs = cause.stage == RECORDING != other.stage
    return rank(cause) > rank(other) or (by_logs and rank(cause) == rank(other))


def rank(hypothesis: Hypothesis) -> int:
    """Which of two findings of the same thing represents it: the repaired, then the named one."""
    return (
        8 * (hypothesis.repair is not None)
        + 4 * hypothesis.named
        + 2 * (hypothesis.stage == MODEL)
        + (hypothesis.stage != POSITIONS)
    )


def _same_mount(cause: Hypothesis, other: Hypothesis) -> bool:
    return not cause.mount or not other.mount or cause.mount == other.mount


def _explains_position(cause: Hypothesis, other: Hypothesis) -> bool:
    """A static position off the others: any effect of the accelerometers may look so.

    Where it is off by degrees only what disturbs them in that position does.
    """
    if has_own_error(other):
        return cause.cause == "accel_bias_of_position" and same_manoeuvre(cause, other)
    if cause.stage == MODEL:
        off = not set(POSITION_OFF).isdisjoint(cause.causes)
        return cause.sensor in (None, other.sensor) or off
    return cause.stage != POSITIONS and same_manoeuvre(cause, other)


# Findings of the model whose law is not known, the least specific first: each explains those after
# it.
UNSPECIFIC = ("unknown_structure", "random walk", "rest_scatter", "consistent", "unexplained")


def _generality(finding: Hypothesis) -> int:
    """The place of a finding of the model in UNSPECIFIC."""
    if finding.cause in MISFITS:
        return UNSPECIFIC.index(finding.cause)
    walk = finding.cause.endswith("_random_walk")
    return UNSPECIFIC.index("random walk" if walk else "consistent")


def _uncertain(finding: Hypothesis) -> bool:
    """Whether it is a finding of the model without a certain name."""
    return finding.stage == MODEL and not finding.named


def _without_law(cause: Hypothesis) -> bool:
    """Whether it is a change of a bias of which no law is known, or a random walk."""
    return _uncertain(cause) or (cause.stage == MODEL and cause.cause.endswith("_random_walk"))


def _explains_uncertain(cause: Hypothesis, other: Hypothesis) -> bool:
    """Residuals without a certain name, in the same sensor.

    An effect that is named does not explain them, for it is in the model whose residuals these
    are; a fault of the recording does, where it spoils what is not masked or repaired.
    """
    if _without_law(cause):
        return cause.sensor == other.sensor and _generality(cause) < _generality(other)
    if cause.stage in (MODEL, POSITIONS):
        return False
    # What a jump leaves in its manoeuvre alone is that jump, with what the model makes of it.
    if cause.cause == "bias_jump" and cause.manoeuvres == other.manoeuvres:
        return False
    if other.cause == "gyro_random_walk" and _is_short_tilt(cause):
        return False
    return cause.unresolved and not cause.alike and same_axis(cause, other)


def _is_short_tilt(fault: Hypothesis) -> bool:
    """Whether gravity turns for seconds in a rest: no bias of a gyro wanders by that.

    A creep adds its rate to all of the rest, so that biases seem to differ from rest to rest.
    """
    first, last = fault.row.get("from_s"), fault.row.get("to_s")
    if fault.cause != "table_moving" or first is None or last is None:
        return False
    return float(last) - float(first) < MAX_TILT_S
