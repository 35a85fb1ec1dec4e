"""What the laboratory can hide in a campaign.

To add an effect, write its file beside this one, list it here, and describe its parameters under
`effects` in simulated.schema.yaml.
"""

from collections.abc import Callable, Mapping
from typing import Any, Final

from laboratory.effects.accel_bias_ramp import AccelBiasRamp
from laboratory.effects.accel_quadratic import AccelQuadratic
from laboratory.effects.bias_random_walk import BiasRandomWalk
from laboratory.effects.effect import Effect
from laboratory.effects.gyro_bias_ramp import GyroBiasRamp
from laboratory.effects.gyro_g_sensitivity import GyroGSensitivity
from laboratory.effects.lever_arm import LeverArm
from laboratory.effects.oscillation import Oscillation
from laboratory.effects.table_creep import TableCreep
from laboratory.effects.table_sway import TableSway
from laboratory.effects.table_tilt import TableTilt
from laboratory.effects.white_noise import WhiteNoise

# Those that move the case go by the order of this list, not by that of the campaign's file.
EFFECTS: Final[dict[str, Callable[[Mapping[str, Any]], Effect]]] = {
    # the table and the mount
    "table_tilt": TableTilt.specified,
    "table_creep": TableCreep.specified,
    "oscillation": Oscillation.specified,
    "lever_arm": LeverArm.specified,
    # the gyros
    "gyro_g_sensitivity": GyroGSensitivity.specified,
    "gyro_bias_ramp": GyroBiasRamp.specified,
    # the accelerometers
    "accel_quadratic": AccelQuadratic.specified,
    "accel_bias_ramp": AccelBiasRamp.specified,
}

# The noise of every campaign: effects too, but with a section of their own.
NOISE: Final[dict[str, Callable[[Mapping[str, Any]], Effect]]] = {
    "white_noise": WhiteNoise.specified,
    "bias_random_walk": BiasRandomWalk.specified,
    "table_sway": TableSway.specified,
}
