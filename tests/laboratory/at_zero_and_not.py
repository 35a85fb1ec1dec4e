"""Every effect with parameters that make it absent, and with others; a campaign that shows all."""

from typing import Any

ZERO, ONE = [0, 0, 0], [1, 1, 1]
IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
Parameters = dict[str, Any]

AT_ZERO_AND_NOT: dict[str, tuple[Parameters, Parameters]] = {
    "gravity_error": ({"error_mgal": 0}, {"error_mgal": 50}),
    "latitude_error": ({"error_deg": 0}, {"error_deg": 5}),
    "heading_error": ({"error_deg": 0}, {"error_deg": 30}),
    "earth_rate_omitted": ({"share": 0}, {"share": 1}),
    "clock_scale": ({"fast_ppm": 0}, {"fast_ppm": 100}),
    "clock_step": ({"at_s": 5, "step_ms": 0}, {"at_s": 5, "step_ms": 4}),
    "table_tilt": (
        {"north_arcsec": 0, "east_arcsec": 0},
        {"north_arcsec": 60, "east_arcsec": 0},
    ),
    "table_axis_non_orthogonality": ({"lean_arcsec": 0}, {"lean_arcsec": 30}),
    "table_inner_axis": ({"lean_arcsec": 0}, {"lean_arcsec": 30}),
    "table_zero_shift": (
        {"shift_arcsec": 0, "at_s": 5},
        {"shift_arcsec": 30, "at_s": 5},
    ),
    "table_position_error": (
        {"sigma_arcsec": 0, "backlash_arcsec": 0},
        {"sigma_arcsec": 0, "backlash_arcsec": 30},
    ),
    "table_axis_error": (
        {"position": "of turn", "north_arcsec": 0, "east_arcsec": 0},
        {"position": "of turn", "north_arcsec": 60, "east_arcsec": 0},
    ),
    "table_speed_error": ({"rate_ppm": 0, "ramp_ppm": 0}, {"rate_ppm": 0, "ramp_ppm": 100}),
    "table_angle_scale": ({"scale_ppm": 0}, {"scale_ppm": 100}),
    "turn_angle_error": (
        {"turn": "turn", "further_arcsec": 0},
        {"turn": "turn", "further_arcsec": 100},
    ),
    "table_backlash": ({"play_arcsec": 0}, {"play_arcsec": 100}),
    "table_eccentricity": (
        {"sin_arcsec": 0, "cos_arcsec": 0},
        {"sin_arcsec": 0, "cos_arcsec": 30},
    ),
    "table_ripple": (
        {"order": 36, "amplitude_arcsec": 0},
        {"order": 36, "amplitude_arcsec": 5},
    ),
    "table_wobble": (
        {"east_arcsec": 0, "north_arcsec": 0},
        {"east_arcsec": 0, "north_arcsec": 10},
    ),
    "table_tilt_ramp": (
        {"north_arcsec_h": 0, "east_arcsec_h": 0},
        {"north_arcsec_h": 600, "east_arcsec_h": 300},
    ),
    "table_tilt_jump": (
        {"north_arcsec": 0, "east_arcsec": 0, "at_s": 5},
        {"north_arcsec": 10, "east_arcsec": 20, "at_s": 5},
    ),
    "table_creep": (
        {"about": "east", "rate_deg_h": 0, "from_s": 5, "to_s": 15},
        {"about": "east", "rate_deg_h": 10, "from_s": 5, "to_s": 15},
    ),
    "oscillation": (
        {"frequency_hz": 20, "amplitude_rad_s": 0, "axis": "+y"},
        {"frequency_hz": 20, "amplitude_rad_s": 0.01, "axis": "+y"},
    ),
    "lever_arm": ({"arm_m": ZERO}, {"arm_m": [0.05, 0, 0]}),
    "size_effect": ({"arms_mm": [ZERO] * 3}, {"arms_mm": [[50, 0, 0], ZERO, ZERO]}),
    "gyro_accel_misalignment": ({"rotation_mrad": ZERO}, {"rotation_mrad": ONE}),
    "gyro_g_sensitivity": ({"matrix_deg_h_g": [ZERO] * 3}, {"matrix_deg_h_g": [ONE] * 3}),
    "gyro_rate_products": ({"matrix_us": [ZERO] * 3}, {"matrix_us": [ONE] * 3}),
    "gyro_cross_axis_squares": ({"matrix_us": [ZERO] * 3}, {"matrix_us": [ONE] * 3}),
    "gyro_vibration_rectification": (
        {"k_deg_h_g2": ONE, "vibration_g": 0, "from_s": 3, "to_s": 9},
        {"k_deg_h_g2": ONE, "vibration_g": 0.1, "from_s": 3, "to_s": 9},
    ),
    "gyro_g2_sensitivity": ({"k_deg_h_g2": ZERO}, {"k_deg_h_g2": ONE}),
    "gyro_scale_asymmetry": ({"asymmetry_ppm": ZERO}, {"asymmetry_ppm": ONE}),
    "gyro_scale_quadratic": ({"k2_ppm_per_deg_s": ZERO}, {"k2_ppm_per_deg_s": ONE}),
    "gyro_scale_cubic": ({"k3_ppm_per_deg_s_2": ZERO}, {"k3_ppm_per_deg_s_2": ONE}),
    "gyro_scale_g_dependence": ({"k_ppm_g": ZERO}, {"k_ppm_g": ONE}),
    "gyro_scale_temperature": ({"k_ppm_k": ZERO}, {"k_ppm_k": ONE}),
    "gyro_dead_band": ({"width_deg_h": ZERO}, {"width_deg_h": [10] * 3}),
    "gyro_bias_ramp": ({"ramp_deg_h_h": ZERO}, {"ramp_deg_h_h": [100] * 3}),
    "gyro_cubic_drift": ({"k_deg_h_h3": ZERO}, {"k_deg_h_h3": [1e5] * 3}),
    "gyro_late_drift": (
        {"ramp_deg_h_h": ZERO, "from_s": 9},
        {"ramp_deg_h_h": [1e3] * 3, "from_s": 9},
    ),
    "gyro_disturbance": (
        {"size_deg_h": ZERO, "from_s": 5, "to_s": 9},
        {"size_deg_h": ONE, "from_s": 5, "to_s": 9},
    ),
    "gyro_anisoelasticity": ({"k_deg_h_g2": ZERO}, {"k_deg_h_g2": [100] * 3}),
    "gyro_remanence": ({"offset_deg_h": ZERO}, {"offset_deg_h": ONE}),
    "gyro_scale_ramp": ({"k_ppm_h": ZERO}, {"k_ppm_h": [1e4] * 3}),
    "gyro_scale_jump": ({"k_ppm": ZERO, "at_s": 9}, {"k_ppm": [1e4] * 3, "at_s": 9}),
    "gyro_rate_noise": ({"relative_ppm_sqrt_s": ZERO}, {"relative_ppm_sqrt_s": ONE}),
    "gyro_rate_power": (
        {"at_10_deg_s_deg_h": ZERO, "power": 1.5},
        {"at_10_deg_s_deg_h": ONE, "power": 1.5},
    ),
    "gyro_stray_field": (
        {"size_deg_h": ZERO, "order": 2.4, "phase_deg": 40},
        {"size_deg_h": ONE, "order": 2.4, "phase_deg": 40},
    ),
    "gyro_coefficient_drift": ({"k_deg_h_k_h": ZERO}, {"k_deg_h_k_h": [1e4] * 3}),
    "gyro_temperature_rate": ({"k_deg_h_k_min": ZERO}, {"k_deg_h_k_min": [100] * 3}),
    "cyclic_drift": (
        {"gyro_deg_h": ZERO, "period_s": 20, "phase_deg": 40},
        {"gyro_deg_h": ONE, "accelerometer_micro_g": ONE, "period_s": 20, "phase_deg": 40},
    ),
    "gyro_warm_up": (
        {"start_deg_h": ZERO, "time_constant_s": 50},
        {"start_deg_h": ONE, "time_constant_s": 50},
    ),
    "gyro_bias_temperature": ({"k_deg_h_k": ZERO}, {"k_deg_h_k": ONE}),
    "gyro_bias_jump": ({"size_deg_h": ZERO, "at_s": 9}, {"size_deg_h": ONE, "at_s": 9}),
    "gyro_telegraph": (
        {"height_deg_h": ZERO, "dwell_s": 3},
        {"height_deg_h": ONE, "dwell_s": 3},
    ),
    "gyro_hysteresis": ({"offset_deg_h": ZERO}, {"offset_deg_h": ONE}),
    "gyro_bias_sense": ({"offset_deg_h": ZERO}, {"offset_deg_h": ONE}),
    "gyro_relaxation": (
        {"in_turn_deg_h": ZERO, "after_deg_h": ZERO, "time_constant_s": 10},
        {"in_turn_deg_h": ONE, "after_deg_h": ONE, "time_constant_s": 10},
    ),
    "gyro_relaxation_sense": (
        {"offset_deg_h": ZERO, "time_constant_s": 10},
        {"offset_deg_h": ONE, "time_constant_s": 10},
    ),
    "gyro_relaxation_braking": (
        {"offset_deg_h": ZERO, "time_constant_s": 10},
        {"offset_deg_h": ONE, "time_constant_s": 10},
    ),
    "accel_flicker": ({"instability_micro_g": 0}, {"instability_micro_g": 10}),
    "gyro_flicker": ({"instability_deg_h": 0}, {"instability_deg_h": 1}),
    "gyro_angle_noise": ({"q_arcsec": 0}, {"q_arcsec": 1}),
    "gyro_saturation": ({"limit_deg_s": [300] * 3}, {"limit_deg_s": [30] * 3}),
    "gyro_low_pass": ({"time_constant_ms": ZERO}, {"time_constant_ms": [20, 0, 0]}),
    "gyro_latency": ({"lag_ms": 0}, {"lag_ms": 2}),
    "accel_latency": ({"lag_ms": 0}, {"lag_ms": 2}),
    "turn_on_bias": ({"gyro_deg_h": 0}, {"gyro_deg_h": 1, "accelerometer_micro_g": 1}),
    "temperature_curves": (
        {"gyro": {"bias_deg_h": {"x": {"powers": [0, 0]}}}},
        {"gyro": {"bias_deg_h": {"x": {"powers": [0, 9]}}}},
    ),
    "temperature_hysteresis": (
        {"gyro_deg_h": ZERO, "half_width_k": 1},
        {"gyro_deg_h": ONE, "half_width_k": 1},
    ),
    "accel_quadratic": ({"k2_micro_g_g2": ZERO}, {"k2_micro_g_g2": ONE}),
    "accel_cubic": ({"k3_micro_g_g3": ZERO}, {"k3_micro_g_g3": ONE}),
    "accel_cross_products": (
        {"matrix_micro_g_g2": [ZERO] * 3},
        {"matrix_micro_g_g2": [[50] * 3] * 3},
    ),
    "accel_scale_asymmetry": ({"asymmetry_micro_g_g": ZERO}, {"asymmetry_micro_g_g": ONE}),
    "accel_scale_ramp": ({"k_ppm_h": ZERO}, {"k_ppm_h": [1e4] * 3}),
    "accel_scale_jump": ({"k_ppm": ZERO, "at_s": 9}, {"k_ppm": [1e4] * 3, "at_s": 9}),
    "accel_scale_temperature": ({"k_ppm_k": ZERO}, {"k_ppm_k": ONE}),
    "accel_bias_ramp": ({"ramp_m_s2_h": ZERO}, {"ramp_m_s2_h": ONE}),
    "accel_warm_up": (
        {"start_micro_g": ZERO, "time_constant_s": 50},
        {"start_micro_g": ONE, "time_constant_s": 50},
    ),
    "accel_bias_temperature": ({"k_micro_g_k": ZERO}, {"k_micro_g_k": ONE}),
    "accel_bias_jump": ({"size_micro_g": ZERO, "at_s": 9}, {"size_micro_g": ONE, "at_s": 9}),
    "mounting_shift": (
        {"rotation_arcsec": ZERO, "at_s": 9},
        {"rotation_arcsec": [100] * 3, "at_s": 9},
    ),
    "mounting_slip": (
        {"rotation_arcsec": ZERO, "at_s": 9, "lasting_s": 1},
        {"rotation_arcsec": [100] * 3, "at_s": 9, "lasting_s": 1},
    ),
    "mounting_creep": (
        {"rotation_arcsec": ZERO, "time_constant_s": 50},
        {"rotation_arcsec": [100] * 3, "time_constant_s": 50},
    ),
    "accel_vibration_rectification": (
        {"k_micro_g_g2": ONE, "vibration_g": 0, "from_s": 3, "to_s": 9},
        {"k_micro_g_g2": [1e4] * 3, "vibration_g": 0.1, "from_s": 3, "to_s": 9},
    ),
    "accel_hysteresis": ({"offset_micro_g": ZERO}, {"offset_micro_g": [20] * 3}),
    "accel_saturation": ({"limit_g": [2] * 3}, {"limit_g": [0.9] * 3}),
}

PLAN: list[Parameters] = [
    {"id": "still", "do": "rest", "up": "+z", "mark": "+x", "seconds": 20, "log": "rest.asc"},
    {"id": "turn", "do": "turn", "up": "+z", "mark": "+x", "degrees": 360, "log": "turn.asc"}
    | {"rate_deg_s": 40, "accel_deg_s2": 40},
    {"id": "back", "do": "turn", "up": "+z", "mark": "+x", "degrees": -360, "log": "back.asc"}
    | {"rate_deg_s": 40, "accel_deg_s2": 40},
    {"id": "tumble", "do": "tumble", "up": "+z", "about": "+x", "step_degrees": 45, "steps": 8}
    | {"and_back": True, "seconds": 2, "log": "tumble.asc"},
]
ALSO: Parameters = {
    "handling": {"still_s": 10, "step": {"rate_deg_s": 40, "accel_deg_s2": 40}},
    "temperature": {"start_deg_c": 20, "slope_k_h": 600},
}
