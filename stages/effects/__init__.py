"""The catalogue: every physical effect that the pipeline can look for.

To add an effect, write its file beside this one and add it here; the tests, the criticism
and the report take it from the catalogue.
"""

from stages.effects.accel_bias_ramp import AccelBiasRamp
from stages.effects.accel_quadratic import AccelQuadratic
from stages.effects.gyro_bias_ramp import GyroBiasRamp
from stages.effects.gyro_g_sensitivity import GyroGSensitivity
from stages.effects.lever_arm import LeverArm
from stages.effects.oscillation import Oscillation
from stages.effects.table_tilt import TableTilt
from stages.model.effect import Effect

CATALOGUE: dict[str, Effect] = {
    effect.name: effect
    for effect in (
        # gyros
        GyroGSensitivity(),
        GyroBiasRamp(),
        # accelerometers
        AccelQuadratic(),
        AccelBiasRamp(),
        # table
        LeverArm(),
        TableTilt(),
        Oscillation(),
    )
}
