"""What the laboratory can hide in a campaign.

To add an effect, write its file beside this one, list it here, and describe its parameters under
`effects` in simulated.schema.yaml.
"""

from collections.abc import Callable, Mapping
from typing import Any, Final

from laboratory.effects.accel_bias_jump import AccelBiasJump
from laboratory.effects.accel_bias_ramp import AccelBiasRamp
from laboratory.effects.accel_bias_temperature import AccelBiasTemperature
from laboratory.effects.accel_cross_products import AccelCrossProducts
from laboratory.effects.accel_cubic import AccelCubic
from laboratory.effects.accel_hysteresis import AccelHysteresis
from laboratory.effects.accel_latency import AccelLatency
from laboratory.effects.accel_quadratic import AccelQuadratic
from laboratory.effects.accel_saturation import AccelSaturation
from laboratory.effects.accel_scale_asymmetry import AccelScaleAsymmetry
from laboratory.effects.accel_scale_jump import AccelScaleJump
from laboratory.effects.accel_scale_ramp import AccelScaleRamp
from laboratory.effects.accel_scale_temperature import AccelScaleTemperature
from laboratory.effects.accel_vibration_rectification import AccelVibrationRectification
from laboratory.effects.accel_warm_up import AccelWarmUp
from laboratory.effects.bias_flicker import AccelFlicker, GyroFlicker
from laboratory.effects.bias_random_walk import BiasRandomWalk
from laboratory.effects.clock_scale import ClockScale
from laboratory.effects.clock_step import ClockStep
from laboratory.effects.cyclic_drift import CyclicDrift
from laboratory.effects.earth_rate_omitted import EarthRateOmitted
from laboratory.effects.effect import Effect
from laboratory.effects.gravity_error import GravityError
from laboratory.effects.gyro_accel_misalignment import GyroAccelMisalignment
from laboratory.effects.gyro_angle_noise import GyroAngleNoise
from laboratory.effects.gyro_anisoelasticity import GyroAnisoelasticity
from laboratory.effects.gyro_bias_jump import GyroBiasJump
from laboratory.effects.gyro_bias_ramp import GyroBiasRamp
from laboratory.effects.gyro_bias_sense import GyroBiasSense
from laboratory.effects.gyro_bias_temperature import GyroBiasTemperature
from laboratory.effects.gyro_coefficient_drift import GyroCoefficientDrift
from laboratory.effects.gyro_cross_axis_squares import GyroCrossAxisSquares
from laboratory.effects.gyro_cubic_drift import GyroCubicDrift
from laboratory.effects.gyro_dead_band import GyroDeadBand
from laboratory.effects.gyro_disturbance import GyroDisturbance
from laboratory.effects.gyro_g2_sensitivity import GyroG2Sensitivity
from laboratory.effects.gyro_g_sensitivity import GyroGSensitivity
from laboratory.effects.gyro_hysteresis import GyroHysteresis
from laboratory.effects.gyro_late_drift import GyroLateDrift
from laboratory.effects.gyro_latency import GyroLatency
from laboratory.effects.gyro_low_pass import GyroLowPass
from laboratory.effects.gyro_rate_noise import GyroRateNoise
from laboratory.effects.gyro_rate_power import GyroRatePower
from laboratory.effects.gyro_rate_products import GyroRateProducts
from laboratory.effects.gyro_relaxation import (
    GyroRelaxation,
    GyroRelaxationBraking,
    GyroRelaxationSense,
)
from laboratory.effects.gyro_remanence import GyroRemanence
from laboratory.effects.gyro_saturation import GyroSaturation
from laboratory.effects.gyro_scale_asymmetry import GyroScaleAsymmetry
from laboratory.effects.gyro_scale_cubic import GyroScaleCubic
from laboratory.effects.gyro_scale_g_dependence import GyroScaleGDependence
from laboratory.effects.gyro_scale_jump import GyroScaleJump
from laboratory.effects.gyro_scale_quadratic import GyroScaleQuadratic
from laboratory.effects.gyro_scale_ramp import GyroScaleRamp
from laboratory.effects.gyro_scale_temperature import GyroScaleTemperature
from laboratory.effects.gyro_stray_field import GyroStrayField
from laboratory.effects.gyro_telegraph import GyroTelegraph
from laboratory.effects.gyro_temperature_rate import GyroTemperatureRate
from laboratory.effects.gyro_vibration_rectification import GyroVibrationRectification
from laboratory.effects.gyro_warm_up import GyroWarmUp
from laboratory.effects.heading_error import HeadingError
from laboratory.effects.latitude_error import LatitudeError
from laboratory.effects.lever_arm import LeverArm
from laboratory.effects.mounting_creep import MountingCreep
from laboratory.effects.mounting_shift import MountingShift
from laboratory.effects.mounting_slip import MountingSlip
from laboratory.effects.oscillation import Oscillation
from laboratory.effects.size_effect import SizeEffect
from laboratory.effects.table_angle_scale import TableAngleScale
from laboratory.effects.table_axis_error import TableAxisError
from laboratory.effects.table_axis_non_orthogonality import TableAxisNonOrthogonality
from laboratory.effects.table_backlash import TableBacklash
from laboratory.effects.table_creep import TableCreep
from laboratory.effects.table_eccentricity import TableEccentricity
from laboratory.effects.table_inner_axis import TableInnerAxis
from laboratory.effects.table_position_error import TablePositionError
from laboratory.effects.table_ripple import TableRipple
from laboratory.effects.table_speed_error import TableSpeedError
from laboratory.effects.table_sway import TableSway
from laboratory.effects.table_tilt import TableTilt
from laboratory.effects.table_tilt_jump import TableTiltJump
from laboratory.effects.table_tilt_ramp import TableTiltRamp
from laboratory.effects.table_wobble import TableWobble
from laboratory.effects.table_zero_shift import TableZeroShift
from laboratory.effects.temperature_curves import TemperatureCurves
from laboratory.effects.temperature_hysteresis import TemperatureHysteresis
from laboratory.effects.turn_angle_error import TurnAngleError
from laboratory.effects.turn_on_bias import TurnOnBias
from laboratory.effects.white_noise import WhiteNoise

# Effects that move the case act in the order of this list, not of the specification.
EFFECTS: Final[dict[str, Callable[[Mapping[str, Any]], Effect]]] = {
    # the site and the clock
    "gravity_error": GravityError.specified,
    "latitude_error": LatitudeError.specified,
    "heading_error": HeadingError.specified,
    "earth_rate_omitted": EarthRateOmitted.specified,
    "clock_scale": ClockScale.specified,
    "clock_step": ClockStep.specified,
    # the table and the mount
    "table_tilt": TableTilt.specified,
    "table_axis_non_orthogonality": TableAxisNonOrthogonality.specified,
    "table_inner_axis": TableInnerAxis.specified,
    "table_zero_shift": TableZeroShift.specified,
    "table_position_error": TablePositionError.specified,
    "table_axis_error": TableAxisError.specified,
    "table_speed_error": TableSpeedError.specified,
    "table_angle_scale": TableAngleScale.specified,
    "turn_angle_error": TurnAngleError.specified,
    "table_backlash": TableBacklash.specified,
    "table_eccentricity": TableEccentricity.specified,
    "table_ripple": TableRipple.specified,
    "table_wobble": TableWobble.specified,
    "table_creep": TableCreep.specified,
    "table_tilt_ramp": TableTiltRamp.specified,
    "table_tilt_jump": TableTiltJump.specified,
    "oscillation": Oscillation.specified,
    "lever_arm": LeverArm.specified,
    "size_effect": SizeEffect.specified,
    # the gyros
    "gyro_accel_misalignment": GyroAccelMisalignment.specified,
    "gyro_g_sensitivity": GyroGSensitivity.specified,
    "gyro_g2_sensitivity": GyroG2Sensitivity.specified,
    "gyro_rate_products": GyroRateProducts.specified,
    "gyro_cross_axis_squares": GyroCrossAxisSquares.specified,
    "gyro_vibration_rectification": GyroVibrationRectification.specified,
    "gyro_anisoelasticity": GyroAnisoelasticity.specified,
    "gyro_remanence": GyroRemanence.specified,
    "gyro_scale_asymmetry": GyroScaleAsymmetry.specified,
    "gyro_scale_quadratic": GyroScaleQuadratic.specified,
    "gyro_scale_cubic": GyroScaleCubic.specified,
    "gyro_scale_g_dependence": GyroScaleGDependence.specified,
    "gyro_scale_temperature": GyroScaleTemperature.specified,
    "gyro_scale_ramp": GyroScaleRamp.specified,
    "gyro_scale_jump": GyroScaleJump.specified,
    "gyro_rate_noise": GyroRateNoise.specified,
    "gyro_rate_power": GyroRatePower.specified,
    "gyro_stray_field": GyroStrayField.specified,
    "gyro_dead_band": GyroDeadBand.specified,
    "gyro_bias_ramp": GyroBiasRamp.specified,
    "gyro_cubic_drift": GyroCubicDrift.specified,
    "gyro_late_drift": GyroLateDrift.specified,
    "gyro_warm_up": GyroWarmUp.specified,
    "gyro_bias_temperature": GyroBiasTemperature.specified,
    "gyro_coefficient_drift": GyroCoefficientDrift.specified,
    "gyro_temperature_rate": GyroTemperatureRate.specified,
    "gyro_bias_jump": GyroBiasJump.specified,
    "gyro_disturbance": GyroDisturbance.specified,
    "gyro_telegraph": GyroTelegraph.specified,
    "gyro_hysteresis": GyroHysteresis.specified,
    "gyro_bias_sense": GyroBiasSense.specified,
    "gyro_relaxation": GyroRelaxation.specified,
    "gyro_relaxation_sense": GyroRelaxationSense.specified,
    "gyro_relaxation_braking": GyroRelaxationBraking.specified,
    "gyro_flicker": GyroFlicker.specified,
    "gyro_angle_noise": GyroAngleNoise.specified,
    "gyro_low_pass": GyroLowPass.specified,
    "gyro_saturation": GyroSaturation.specified,
    "gyro_latency": GyroLatency.specified,
    "accel_latency": AccelLatency.specified,
    # both
    "turn_on_bias": TurnOnBias.specified,
    "mounting_shift": MountingShift.specified,
    "mounting_slip": MountingSlip.specified,
    "mounting_creep": MountingCreep.specified,
    "cyclic_drift": CyclicDrift.specified,
    "temperature_curves": TemperatureCurves.specified,
    "temperature_hysteresis": TemperatureHysteresis.specified,
    # the accelerometers
    "accel_quadratic": AccelQuadratic.specified,
    "accel_cubic": AccelCubic.specified,
    "accel_cross_products": AccelCrossProducts.specified,
    "accel_scale_asymmetry": AccelScaleAsymmetry.specified,
    "accel_scale_ramp": AccelScaleRamp.specified,
    "accel_scale_jump": AccelScaleJump.specified,
    "accel_scale_temperature": AccelScaleTemperature.specified,
    "accel_bias_ramp": AccelBiasRamp.specified,
    "accel_warm_up": AccelWarmUp.specified,
    "accel_bias_temperature": AccelBiasTemperature.specified,
    "accel_bias_jump": AccelBiasJump.specified,
    "accel_flicker": AccelFlicker.specified,
    "accel_vibration_rectification": AccelVibrationRectification.specified,
    "accel_hysteresis": AccelHysteresis.specified,
    "accel_saturation": AccelSaturation.specified,
}

# The noise of every campaign: effects too, but specified in a section of their own.
NOISE: Final[dict[str, Callable[[Mapping[str, Any]], Effect]]] = {
    "white_noise": WhiteNoise.specified,
    "bias_random_walk": BiasRandomWalk.specified,
    "table_sway": TableSway.specified,
}
