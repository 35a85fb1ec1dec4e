"""The catalogue: every physical effect that the pipeline can look for.

To add an effect, write its file beside this one and add it here; the tests, the criticism
and the report take it from the catalogue.
"""

from stages.effects.accel_bias_jump import AccelBiasJump
from stages.effects.accel_bias_ramp import AccelBiasRamp
from stages.effects.accel_bias_temperature import AccelBiasTemperature
from stages.effects.accel_cross_products import AccelCrossProducts
from stages.effects.accel_cubic import AccelCubic
from stages.effects.accel_hysteresis import AccelHysteresis
from stages.effects.accel_quadratic import AccelQuadratic
from stages.effects.accel_saturation import AccelSaturation
from stages.effects.accel_scale_asymmetry import AccelScaleAsymmetry
from stages.effects.accel_scale_temperature import AccelScaleTemperature
from stages.effects.accel_vibration_rectification import AccelVibrationRectification
from stages.effects.accel_warm_up import AccelWarmUp
from stages.effects.clock_scale import ClockScale
from stages.effects.earth_rate_omitted import EarthRateOmitted
from stages.effects.gravity_error import GravityError
from stages.effects.gyro_accel_misalignment import GyroAccelMisalignment
from stages.effects.gyro_bias_jump import GyroBiasJump
from stages.effects.gyro_bias_ramp import GyroBiasRamp
from stages.effects.gyro_bias_temperature import GyroBiasTemperature
from stages.effects.gyro_dead_band import GyroDeadBand
from stages.effects.gyro_flicker import GyroFlicker
from stages.effects.gyro_g2_sensitivity import GyroG2Sensitivity
from stages.effects.gyro_g_sensitivity import GyroGSensitivity
from stages.effects.gyro_latency import GyroLatency
from stages.effects.gyro_random_walk import GyroRandomWalk
from stages.effects.gyro_saturation import GyroSaturation
from stages.effects.gyro_scale_asymmetry import GyroScaleAsymmetry
from stages.effects.gyro_scale_cubic import GyroScaleCubic
from stages.effects.gyro_scale_g_dependence import GyroScaleGDependence
from stages.effects.gyro_scale_quadratic import GyroScaleQuadratic
from stages.effects.gyro_scale_temperature import GyroScaleTemperature
from stages.effects.gyro_warm_up import GyroWarmUp
from stages.effects.heading_error import HeadingError
from stages.effects.latitude_error import LatitudeError
from stages.effects.lever_arm import LeverArm
from stages.effects.oscillation import Oscillation
from stages.effects.size_effect import SizeEffect
from stages.effects.table_angle_scale import TableAngleScale
from stages.effects.table_axis_non_orthogonality import TableAxisNonOrthogonality
from stages.effects.table_eccentricity import TableEccentricity
from stages.effects.table_position_error import TablePositionError
from stages.effects.table_ripple import TableRipple
from stages.effects.table_speed_error import TableSpeedError
from stages.effects.table_tilt import TableTilt
from stages.effects.table_wobble import TableWobble
from stages.model.effect import Effect

CATALOGUE: dict[str, Effect] = {
    effect.name: effect
    for effect in (
        # gyros
        GyroGSensitivity(),
        GyroG2Sensitivity(),
        GyroScaleAsymmetry(),
        GyroScaleQuadratic(),
        GyroScaleCubic(),
        GyroScaleGDependence(),
        GyroBiasRamp(),
        GyroWarmUp(),
        GyroBiasTemperature(),
        GyroScaleTemperature(),
        GyroBiasJump(),
        GyroRandomWalk(),
        GyroFlicker(),
        GyroDeadBand(),
        GyroSaturation(),
        GyroLatency(),
        # accelerometers
        AccelQuadratic(),
        AccelCubic(),
        AccelCrossProducts(),
        AccelScaleAsymmetry(),
        AccelBiasRamp(),
        AccelWarmUp(),
        AccelBiasTemperature(),
        AccelScaleTemperature(),
        AccelBiasJump(),
        AccelVibrationRectification(),
        AccelHysteresis(),
        AccelSaturation(),
        # the case
        LeverArm(),
        SizeEffect(),
        GyroAccelMisalignment(),
        # the table
        TableSpeedError(),
        TableTilt(),
        TableAxisNonOrthogonality(),
        TablePositionError(),
        TableWobble(),
        TableEccentricity(),
        TableRipple(),
        Oscillation(),
        TableAngleScale(),
        # site and clock
        GravityError(),
        LatitudeError(),
        HeadingError(),
        EarthRateOmitted(),
        ClockScale(),
    )
}
