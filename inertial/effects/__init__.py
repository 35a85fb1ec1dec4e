"""The catalogue: every physical effect that the pipeline can look for.

To add an effect, write its file beside this one and add it here; the tests, the criticism
and the report take it from the catalogue.
"""

from inertial.effects.accel_cross_products import AccelCrossProducts
from inertial.effects.accel_cubic import AccelCubic
from inertial.effects.accel_hysteresis import AccelHysteresis
from inertial.effects.accel_latency import AccelLatency
from inertial.effects.accel_quadratic import AccelQuadratic
from inertial.effects.accel_vibration_rectification import AccelVibrationRectification
from inertial.effects.bias_jump import BiasJump
from inertial.effects.bias_of_position import BiasOfPosition
from inertial.effects.bias_ramp import BiasRamp
from inertial.effects.bias_temperature import BiasTemperature
from inertial.effects.clock_scale import ClockScale
from inertial.effects.earth_rate_omitted import EarthRateOmitted
from inertial.effects.gravity_error import GravityError
from inertial.effects.gyro_accel_misalignment import GyroAccelMisalignment
from inertial.effects.gyro_bias_sense import GyroBiasSense
from inertial.effects.gyro_cross_axis_squares import GyroCrossAxisSquares
from inertial.effects.gyro_dead_band import GyroDeadBand
from inertial.effects.gyro_flicker import GyroFlicker
from inertial.effects.gyro_g2_sensitivity import GyroG2Sensitivity
from inertial.effects.gyro_g_sensitivity import GyroGSensitivity
from inertial.effects.gyro_hysteresis import GyroHysteresis
from inertial.effects.gyro_latency import GyroLatency
from inertial.effects.gyro_random_walk import GyroRandomWalk
from inertial.effects.gyro_rate_products import GyroRateProducts
from inertial.effects.gyro_relaxation import GyroRelaxation
from inertial.effects.gyro_relaxation_braking import GyroRelaxationBraking
from inertial.effects.gyro_relaxation_sense import GyroRelaxationSense
from inertial.effects.gyro_scale_cubic import GyroScaleCubic
from inertial.effects.gyro_scale_g_dependence import GyroScaleGDependence
from inertial.effects.gyro_scale_quadratic import GyroScaleQuadratic
from inertial.effects.gyro_vibration_rectification import GyroVibrationRectification
from inertial.effects.heading_error import HeadingError
from inertial.effects.latitude_error import LatitudeError
from inertial.effects.latitude_sign import LatitudeSign
from inertial.effects.law import Law, every_law
from inertial.effects.lever_arm import LeverArm
from inertial.effects.mounting_shift import MountingShift
from inertial.effects.mounting_slip import MountingSlip
from inertial.effects.oscillation import Oscillation
from inertial.effects.restarts import Restarts
from inertial.effects.saturation import Saturation
from inertial.effects.scale_asymmetry import ScaleAsymmetry
from inertial.effects.scale_jump import ScaleJump
from inertial.effects.scale_ramp import ScaleRamp
from inertial.effects.scale_temperature import ScaleTemperature
from inertial.effects.size_effect import SizeEffect
from inertial.effects.table_angle_scale import TableAngleScale
from inertial.effects.table_axis_error import TableAxisError
from inertial.effects.table_axis_non_orthogonality import TableAxisNonOrthogonality
from inertial.effects.table_backlash import TableBacklash
from inertial.effects.table_eccentricity import TableEccentricity
from inertial.effects.table_inner_axis import TableInnerAxis
from inertial.effects.table_position_error import TablePositionError
from inertial.effects.table_ripple import TableRipple
from inertial.effects.table_speed_error import TableSpeedError
from inertial.effects.table_tilt import TableTilt
from inertial.effects.table_tilt_jump import TableTiltJump
from inertial.effects.table_tilt_ramp import TableTiltRamp
from inertial.effects.table_wobble import TableWobble
from inertial.effects.table_zero_shift import TableZeroShift
from inertial.effects.table_zero_shift_outer import TableZeroShiftOuter
from inertial.effects.temperature_model import TemperatureModel
from inertial.effects.thermal_hysteresis import ThermalHysteresis
from inertial.effects.tumble_eccentricity import TumbleEccentricity
from inertial.effects.turn_angle_error import TurnAngleError
from inertial.effects.warm_up import WarmUp
from inertial.physics.effect import Effect

CATALOGUE: dict[str, Effect] = {
    effect.name: effect
    for effect in (
        # gyros
        GyroGSensitivity(),
        GyroG2Sensitivity(),
        GyroRateProducts(),
        GyroCrossAxisSquares(),
        GyroVibrationRectification(),
        ScaleAsymmetry("gyro"),
        GyroScaleQuadratic(),
        GyroScaleCubic(),
        GyroScaleGDependence(),
        BiasRamp("gyro"),
        ScaleRamp("gyro"),
        WarmUp("gyro"),
        BiasTemperature("gyro"),
        ScaleTemperature("gyro"),
        BiasJump("gyro"),
        ScaleJump("gyro"),
        BiasOfPosition("gyro"),
        GyroRandomWalk(),
        GyroFlicker(),
        *(GyroDeadBand(axis) for axis in "xyz"),
        GyroHysteresis(),
        GyroBiasSense(),
        GyroRelaxation(),
        GyroRelaxationSense(),
        GyroRelaxationBraking(),
        Saturation("gyro"),
        GyroLatency(),
        # accelerometers
        AccelQuadratic(),
        AccelCubic(),
        AccelCrossProducts(),
        ScaleAsymmetry("accel"),
        BiasRamp("accel"),
        ScaleRamp("accel"),
        WarmUp("accel"),
        BiasTemperature("accel"),
        ScaleTemperature("accel"),
        BiasJump("accel"),
        ScaleJump("accel"),
        BiasOfPosition("accel"),
        AccelVibrationRectification(),
        AccelHysteresis(),
        Saturation("accel"),
        AccelLatency(),
        # the case
        LeverArm(),
        SizeEffect(),
        GyroAccelMisalignment(),
        MountingShift(),
        MountingSlip(),
        # the table
        TableSpeedError(),
        TableTilt(),
        TableTiltRamp(),
        TableTiltJump(),
        TableAxisNonOrthogonality(),
        TableInnerAxis(),
        TableZeroShift(),
        TableZeroShiftOuter(),
        TablePositionError(),
        TableAxisError(),
        TableWobble(),
        TableEccentricity(),
        TumbleEccentricity(),
        TableRipple(),
        Oscillation(),
        TableAngleScale(),
        TurnAngleError(),
        TableBacklash(),
        # site and clock
        GravityError(),
        LatitudeError(),
        LatitudeSign(),
        HeadingError(),
        EarthRateOmitted(),
        ClockScale(),
    )
}

# Selected before the others, piece by piece, and so no candidates of the search.
TEMPERATURE_MODELS: dict[str, TemperatureModel] = {
    model.name: model for model in (TemperatureModel("gyro"), TemperatureModel("accel"))
}
# Searched beside the catalogue where the temperature changes by as much as these ask for.
OF_TEMPERATURE_CYCLES: dict[str, Effect] = {
    effect.name: effect for effect in (ThermalHysteresis("gyro"), ThermalHysteresis("accel"))
}
# Searched beside the catalogue where the recording has several gaps.
AT_GAPS: dict[str, Effect] = {
    effect.name: effect for effect in (Restarts("gyro"), Restarts("accel"))
}
# Searched only where no effect of the catalogue explains what remains.
LAWS: dict[str, Law] = every_law()
KNOWN: dict[str, Effect] = {
    **CATALOGUE,
    **TEMPERATURE_MODELS,
    **OF_TEMPERATURE_CYCLES,
    **AT_GAPS,
    **LAWS,
}
