"""What the smallest faults leave in the residuals: by theory, not by what was drawn.

A set position that is off and a turn by a wrong angle are each one unknown of one manoeuvre, which
the 24 parameters and the stated sigmas of the table take up for the larger part. The squared
signal-to-noise ratio that is left is the noncentrality of the test, so no test has more power.
"""

from collections.abc import Iterator

import numpy as np
from diagnosis_draws import SIGMAS, places, ratio_without, sigmas
from diagnosis_faults import GRAVITY
from hidden_plans import PLANS
from hidden_sizes import reference

from inertial.effects import CATALOGUE

POSITION, ANGLE = "table_position_error", "turn_angle_error"
IN_PLANS = (("position off", POSITION, ("positions",)), ("angle of a turn off", ANGLE, (*PLANS,)))


def left() -> Iterator[tuple[str, ...]]:
    """Fault, plan, sigma by which it moves a result, the ratio it leaves, the power of the test.

    The medians over the manoeuvres at which it may be.
    """
    for fault, effect, plans in IN_PLANS:
        for plan in plans:
            each = np.array(list(_ratios(plan, effect)))
            for sigma in SIGMAS:
                ratio = float(np.median(each)) * sigma
                power = reference(plan).limits(effect, ratio)["limit"]
                yield fault, plan, f"{sigma:g}", f"{ratio:.1f}", f"{power:.2f}"


def _ratios(plan: str, name: str) -> Iterator[float]:
    """The ratio that is left at each place, per sigma by which it moves a result."""
    campaign = reference(plan).campaign
    family = campaign.candidates([CATALOGUE[name]])[name]
    there = {one.manoeuvre for one in places(plan) if one.turns is (name == ANGLE)}
    for effect in family:
        if campaign.places(effect)[int(effect.at or 0)] in there:
            yield ratio_without(plan, name, effect.at, np.array(_size(plan, name)), ())


def _size(plan: str, name: str) -> tuple[float, ...]:
    """What moves a result by one sigma: of a tilt, or of the angle of a whole turn, rad."""
    known = sigmas(plan)
    rests = sum(not place.turns for place in places(plan))
    if name == POSITION:
        return rests * known["accel"]["bias_x"] / GRAVITY, 0.0
    turns = sum(place.turns for place in places(plan)) / 3  # about each axis
    scale = float(np.mean([known["gyro"][f"scale_{axis}"] for axis in "xyz"]))
    return (turns * scale * 2 * np.pi,)
