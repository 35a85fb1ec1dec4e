"""Laws of the rate, or of the attitude, that have about as many terms as the plan has of these.

They fit whatever the law is. Manoeuvres that are held out confirm nothing then: others at the same
rate, or in the same attitude, stay in the training.
"""

import numpy as np

from inertial.campaign.equations import Campaign
from inertial.effects.law import Law
from stages.extension.candidates import Candidate

OF_RATE = ("gyro_scale_quadratic", "gyro_scale_cubic")
OF_ATTITUDE = (
    "accel_quadratic",
    "accel_cubic",
    "accel_cross_products",
    "accel_scale_asymmetry",
    "accel_hysteresis",
)
ONE_RATE = 0.02  # relative: rates that differ by less are one
ONE_ATTITUDE = 0.02  # of a component of the upward direction
PARAMETERS = 12


def form_is_open(sensor: str, candidate: Candidate, campaign: Campaign) -> bool:
    """Whether several laws of a sensor together have too many terms to be confirmed.

    Of the gyros: as many as there are rates but the one of the scale factor. Of the accelerometers:
    more than half of what the attitudes leave beside the twelve parameters.
    """
    if campaign.by_hand:
        return False
    own = OF_RATE if sensor == "gyro" else OF_ATTITUDE
    laws = [
        effect
        for effect in candidate.effects
        if effect.name in own or (isinstance(effect, Law) and sensor == "accel")
    ]
    if len(laws) < 2:
        return False
    motion, stretches = campaign.motion, campaign.stretches(sensor)
    if sensor == "gyro":
        rates = np.abs(motion.rate[stretches])
        changes = np.abs(motion.acceleration[stretches]) * motion.seconds[stretches]
        steady = rates[(rates > ONE_RATE * rates.max(initial=0.0)) & (changes < ONE_RATE * rates)]
        rates_held = 1 + np.count_nonzero(np.diff(np.sort(np.log(steady))) > ONE_RATE)
        return bool(rates_held <= len(laws) + 1)
    ups = np.unique(np.round(motion.up[stretches] / ONE_ATTITUDE), axis=0)
    terms = sum(column in candidate.columns for law in laws for column in law.columns)
    return 2 * terms > 3 * len(ups) - PARAMETERS
