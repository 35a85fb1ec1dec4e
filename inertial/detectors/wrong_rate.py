"""A turn that is faster or slower than planned."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.signal.scale_factor import common_turn_ratio, turn_ratios
from inertial.text.numbers import fixed, significant


class WrongRate(PlanDetector):
    """A turn whose rate is not the planned one, where no ratio explains all of them."""

    name = "wrong_rate"
    cause = "the rate of the plan, or of the table"
    source = "S0, table 5-6: the rate in the steady part"
    costs = "a scale factor, where the rate is the reference"
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        if common_turn_ratio(recorded) is not None:
            return
        rate, angle = turn_ratios(recorded)
        for i, ratio in enumerate(rate):
            if ratio > 0 and abs(ratio - 1) > recorded.tolerance:
                as_planned = abs(angle[i] - 1) <= recorded.tolerance
                yield self.of(recorded, i, float(ratio), severity=1 if as_planned else 3)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i, ratio = deviation.at, deviation.size
        assert i is not None and ratio is not None
        read, planned = np.degrees([recorded.speed[i], recorded.rate[i]]).tolist()
        _, angle = turn_ratios(recorded)
        if deviation.severity == 1:
            consequence = (
                f"Its angle is as planned ({fixed(float(np.degrees(recorded.moved[i])), 2)}°), so"
                " its scale factor holds; the rate is not used."
            )
        elif np.isfinite(angle[i]):
            consequence = (
                f"Its angle is {significant(float(angle[i]), 4)} times the planned one, so it is"
                " left out."
            )
        else:
            consequence = (
                f"Taken as planned, its scale error would be {fixed((ratio - 1) * 100, 1)} %."
            )
        return Description(
            f"{recorded.name[i]} turns at {significant(read)} °/s, {significant(ratio, 5)} times"
            f" the planned {significant(planned)} °/s; the other turns are not off by this ratio.",
            consequence,
            "Correct the rate of the plan, or see what the table did.",
        )
