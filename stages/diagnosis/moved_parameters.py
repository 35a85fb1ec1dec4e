"""By how many of its sigma a cause moves a parameter, where no model of the readings says it."""

from collections.abc import Sequence

from inertial.campaign.hypotheses import MOUNTINGS, PLAN, Hypothesis
from inertial.campaign.records import Row
from inertial.text.units import STANDARD_GRAVITY
from stages.diagnosis.sensor_results import SensorResult

CLOCK = "clock_scale"
OF_ENCODER = ("encoder_scale", "encoder_scale_or_eccentricity", "encoder_angles")
RATE_OFF, TABLE_RATE_OFF = "rate_off", "table_rate_off"


def moved_by(repair: Row, own: Sequence[SensorResult]) -> float | None:
    """By how many sigma a stated value would have moved the scale factors."""
    if repair["value"] is None or repair["stated"] is None or not repair["value"]:
        return None
    relative = abs(repair["stated"] / repair["value"] - 1)
    sigmas = [sigma for result in own if (sigma := result.scale_sigma) is not None]
    return relative / min(sigmas) if sigmas else None


def moved_by_turning(
    showing: Sequence[SensorResult], others: Sequence[SensorResult]
) -> list[float]:
    """Upper bound, in sigma, of the change of cross-axis terms of the other sensor.

    All its rotations may be before or all after the shift: then its terms hold for one of the two
    mountings, and its residuals show nothing.
    """
    angles = (result.angle(effect) for result in showing for effect in MOUNTINGS)
    angle = max(angles, default=0.0)
    sigmas = [result.cross_sigma for result in others]
    return [angle / sigma for sigma in sigmas if sigma and angle]


def moved_by_runs(difference: float, own: Sequence[SensorResult]) -> float | None:
    """By how many sigma the bias is that of no run, where that of two runs differs."""
    sigmas = [sigma for result in own if (sigma := result.bias_sigma) is not None]
    return difference / 2 / min(sigmas) if sigmas else None


def moved_by_measure(cause: Hypothesis, own: Sequence[SensorResult]) -> float | None:
    """By how many sigma a clock or an encoder that is off by a share moves the parameters.

    Angles move the scale factors of the gyros. Of a clock by which increments are specific forces,
    one of two opposite rests reads g (1 + error): half of that goes into the scale factor, half of
    g times it into the bias. This is the difference between the results for wrong stamps and
    for a wrong sampling interval.
    """
    size = abs(cause.row["size"] or 0.0)
    if cause.cause in (RATE_OFF, TABLE_RATE_OFF) and cause.stage == PLAN:
        shares = [(abs(size - 1), result.scale_sigma) for result in own]
    elif cause.cause in OF_ENCODER:
        shares = [(size, result.scale_sigma) for result in own]
    elif cause.cause == CLOCK and cause.sensor == "gyro":
        shares = [(1e-6 * size, result.scale_sigma) for result in own]
    elif cause.cause == CLOCK and cause.sensor == "accel":
        shares = [
            (1e-6 * size / 2 * unit, sigma)
            for result in own
            for unit, sigma in ((1.0, result.scale_sigma), (STANDARD_GRAVITY, result.bias_sigma))
        ]
    else:
        return None
    return max((share / sigma for share, sigma in shares if sigma), default=None)
