"""By what ratio the turns of a campaign differ from their plan, if it is the same for all."""

import numpy as np

from inertial.detectors.wrong_scale_factor import explanations
from inertial.signal.detector import Array
from inertial.signal.plan_detector import Recorded

ALIKE = 0.05  # by which the ratios of turns may differ: a gyro of a phone is off by 3 %
UNEXPLAINED = "no known"  # how an explanation begins that is none


def ratios(recorded: Recorded) -> tuple[Array, Array]:
    """Recorded over planned rate and angle of each turn, (m,), NaN where not known."""
    with np.errstate(divide="ignore", invalid="ignore"):
        rate = np.where(recorded.found, recorded.speed / recorded.rate, np.nan)
        whole = recorded.found & ~recorded.steady & (recorded.lacking_s == 0)
        angle = np.where(whole, recorded.moved / recorded.angle, np.nan)
    return rate, angle


def common_ratio(recorded: Recorded) -> tuple[float, str] | None:
    """The one ratio by which all turns are off, in rate and in angle, and what explains it.

    None where they are not off, or not alike. A single turn may have been planned wrongly: its
    ratio counts only if a unit, a full scale or an instrument explains it.
    """
    rate, angle = ratios(recorded)
    known = np.isfinite(rate)
    if not known.any():
        return None
    ratio = float(np.median(rate[known]))
    both = np.concatenate([rate[known], angle[known & np.isfinite(angle)]]) / ratio
    if abs(ratio - 1) <= recorded.tolerance or ratio <= 0 or np.abs(both - 1).max() > ALIKE:
        return None
    count = recorded.count[known]
    count = count[np.isfinite(count)]
    size = float(np.median(count)) if len(count) else np.nan
    why = explanations(ratio, "gyro", recorded.given, size)
    if known.sum() == 1 and why.startswith(UNEXPLAINED):
        return None
    return ratio, why
