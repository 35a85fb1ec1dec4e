"""The names of causes and effects as they are read."""

from __future__ import annotations

from inertial.text.messages import _
from inertial.text.numbers import shortened

# By the identifier in tables; another one is read with spaces between its words.
NAMES = {
    "gyro_scale_asymmetry": _("gyro scale asymmetry"),
    "gyro_bias_ramp": _("gyro bias ramp"),
    "gyro_bias_jump": _("gyro bias jump"),
    "gyro_flicker": _("gyro flicker"),
    "gyro_saturation": _("gyro saturation"),
    "gyro_latency": _("gyro latency"),
    "lever_arm": _("lever arm"),
    "table_tilt": _("table tilt"),
    "table_wobble": _("table wobble"),
    "table_eccentricity": _("table eccentricity"),
    "table_ripple": _("table ripple"),
    "oscillation": _("oscillation"),
    "bias_jump": _("bias jump"),
    "samples_lost": _("lost samples that the stamps do not show"),
    "bias_removed": _("mean subtracted from the readings"),
    "copied_channel": _("axis that is a copy of another"),
    "copied_log": _("log that is a copy of another"),
    "dead_axis": _("dead axis"),
    "gap": _("gap"),
    "gravity_removed": _("gravity subtracted from the readings"),
    "normalised_force": _("accelerometers of constant magnitude"),
    "held_record": _("held record"),
    "incomplete_turn": _("incomplete turn"),
    "periodic_glitch": _("periodic glitch"),
    "motion_after_turns": _("motion after the stop of turns"),
    "quantisation": _("quantisation"),
    "saturation": _("saturation"),
    "short_rest": _("short rest"),
    "slower_sensor": _("sensor slower than its log"),
    "spike": _("spike"),
    "table_moving": _("table moving"),
    "moved_while_read": _("position that was moved while it was read"),
    "temperature_drift": _("temperature drift"),
    "wrong_temperature_unit": _("temperature in another unit than is stated"),
    "temperature_misstated": _("temperature misstated"),
    "time_stands_still": _("time stands still"),
    "wrong_direction": _("wrong direction"),
    "wrong_spans": _("spans by another clock"),
    "wrong_rate": _("wrong rate"),
    "unexplained": _("unexplained"),
    "position_not_kept": _("position that was not kept"),
    "fixture_creep": _("creep of the IMU in its fixture"),
    "position_scatter": _("positions that scatter by more than is stated of the table"),
    "wrong_scale_of_turns": _("wrong scale of turns"),
    "mounting_shift": _("shift of the IMU in its fixture"),
    "accel_bias_per_log": _("bias of the accelerometers after each switch-on"),
    "accel_bias_jump": _("accelerometer bias jump"),
    "accel_bias_ramp": _("accelerometer bias ramp"),
    "accel_bias_temperature": _("accelerometer bias with temperature"),
    "accel_cross_products": _("accelerometer cross products"),
    "accel_cubic": _("accelerometer cubic term"),
    "accel_hysteresis": _("accelerometer hysteresis"),
    "accel_random_walk": _("random walk of the accelerometer biases"),
    "accel_saturation": _("accelerometer saturation"),
    "accel_scale_asymmetry": _("accelerometer scale asymmetry"),
    "accel_scale_jump": _("accelerometer scale factor jump"),
    "accel_scale_ramp": _("accelerometer scale factor ramp"),
    "accel_scale_temperature": _("accelerometer scale factor with temperature"),
    "accel_temperature": _("accelerometer parameters with temperature"),
    "accel_thermal_hysteresis": _("thermal hysteresis of the accelerometers"),
    "accel_vibration_rectification": _("vibration rectification of the accelerometers"),
    "accel_warm_up": _("accelerometer warm-up"),
    "accel_drift": _("drift of the accelerometers without a law"),
    "accel_quadratic": _("accelerometer quadratic term"),
    "already_compensated": _("compensated already"),
    "axis_swap": _("exchanged axes"),
    "arrival_stamps": _("stamps of arrival"),
    "clock_jitter": _("jitter of the clock"),
    "clock_step": _("clock that was set"),
    "clock_scale": _("clock too fast or too slow"),
    "duplicate": _("repeated record"),
    "encoder_scale": _("scale of the encoder, or angles of the table"),
    "earth_rate_omitted": _("earth rate left out"),
    "gravity_error": _("wrong gravity"),
    "gyro_count_size": _("count size of the gyros"),
    "gyro_accel_misalignment": _("gyros rotated against accelerometers"),
    "gyro_bias_temperature": _("gyro bias with temperature"),
    "gyro_bias_per_log": _("bias of the gyros after each switch-on"),
    "gyro_dead_band_x": _("dead band of the x gyro"),
    "gyro_dead_band_y": _("dead band of the y gyro"),
    "gyro_dead_band_z": _("dead band of the z gyro"),
    "gyro_drift": _("drift of the gyros without a law"),
    "gyro_g2_sensitivity": _("gyro g²-sensitivity"),
    "gyro_g_sensitivity": _("gyro g-sensitivity"),
    "gyro_hysteresis": _("gyro hysteresis"),
    "gyro_random_walk": _("random walk of the gyro biases"),
    "gyro_scale_cubic": _("gyro scale factor with the square of the rate"),
    "gyro_scale_g_dependence": _("gyro scale factor with acceleration"),
    "gyro_scale_quadratic": _("gyro scale factor with the rate"),
    "gyro_scale_jump": _("gyro scale factor jump"),
    "gyro_scale_ramp": _("gyro scale factor ramp"),
    "gyro_scale_temperature": _("gyro scale factor with temperature"),
    "gyro_temperature": _("gyro parameters with temperature"),
    "gyro_thermal_hysteresis": _("thermal hysteresis of the gyros"),
    "gyro_warm_up": _("gyro warm-up"),
    "heading_error": _("wrong heading"),
    "impact": _("impact on the IMU"),
    "latitude_error": _("wrong latitude"),
    "latitude_sign": _("latitude of the other hemisphere"),
    "manoeuvre_missing": _("missing manoeuvre"),
    "manoeuvre_swapped": _("exchanged manoeuvres"),
    "rate_off": _("another sample rate"),
    "rests_divided": _("rests that only the plan divides"),
    "turning_point_once": _("turning point of a tumble recorded once"),
    "sign_flip": _("reversed sign"),
    "size_effect": _("size effect of the accelerometers"),
    "status_invalid": _("invalid status"),
    "table_angle_scale": _("scale of the table's angle"),
    "table_axis_non_orthogonality": _("table axis non-orthogonality"),
    "turn_angle_error": _("turn whose angle is off"),
    "table_position_error": _("set position that is off"),
    "table_axis_error": _("set position that is off, with the axis of its turns"),
    "table_speed_error": _("wrong speed of the table"),
    "time_backwards": _("time goes backwards"),
    "unknown_structure": _("structure without a name"),
    "wrong_day": _("another day"),
    "sense_of_turns": _("asymmetry of the gyros or of the table"),
    "jump_not_testable": _("change of the bias that the plan cannot show"),
    "another_imu": _("another IMU in a part of the logs"),
    "wrong_imu_type": _("another type of IMU"),
    "wrong_time_unit": _("wrong unit of the time"),
    "wrong_scale_factor": _("wrong count size or unit"),
}

# The names of laws: <sensor>_<axis>_<family>_of_<state>, or of two states with _and_ between.
STATES = {
    "time": _("time"),
    "run_time": _("time since switch-on"),
    "angle": _("the angle of the table"),
    "rate": _("the rate"),
    "force_x": _("the x force"),
    "force_y": _("the y force"),
    "force_z": _("the z force"),
    "own_force": _("the force along each axis"),
    "other_forces": _("the product of the forces along the two other axes"),
    "temperature": _("the temperature"),
    "temperature_rate": _("the rate of the temperature"),
}
FAMILIES = {
    "polynomial": _("polynomial of {state}"),
    "power": _("power of {state}"),
    "odd_power": _("power of {state} with its sign"),
    "harmonic": _("sine of {state}"),
    "exponential": _("exponential of {state}"),
    "ramp": _("ramp that begins later"),
    "telegraph": _("two levels in turn"),
    "hysteresis": _("hysteresis of {state}"),
    "product": _("proportion to {state}"),
}
IN_ONE_AXIS = {
    "gyro": _("{law} in the {axis} gyro"),
    "accel": _("{law} in the {axis} accelerometer"),
}
IN_ALL_AXES = {"gyro": _("{law} in the gyros"), "accel": _("{law} in the accelerometers")}


def in_words(cause: str) -> str:
    """The name of a cause or an effect as it is read."""
    return NAMES.get(cause) or _law(cause) or shortened(cause.replace("_", " "), 60)


def _law(cause: str) -> str:
    """The name of a law; empty for others."""
    place, of, named = cause.partition("_of_")
    sensor, axis, family = (*place.split("_", 2), "", "")[:3]
    states = [STATES[state] for state in named.split("_and_") if state in STATES]
    if not of or sensor not in IN_ONE_AXIS or family not in FAMILIES or not states:
        return ""
    law = FAMILIES[family].format(state=_(" times ").join(states))
    return (IN_ALL_AXES if axis == "all" else IN_ONE_AXIS)[sensor].format(law=law, axis=axis)
