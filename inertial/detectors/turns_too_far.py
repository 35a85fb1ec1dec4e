"""Turns that go farther than planned."""

from collections.abc import Iterator, Sequence

import numpy as np

from inertial.detectors.turns_against_plan import by_another_angle, if_taken, too_far
from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.signal.scale_factor import turn_ratios
from inertial.text.enumeration import listed
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, significant

USUAL_ANGLE = 45.0  # °, of whose multiples the angle of a turn usually is
MAX_OF_USUAL = 0.01  # relative, up to which it is one of these: at 360° they are 0.12 apart
MAX_RATIO_DIFFERENCE = 0.01  # relative, of turns that are off by one factor


class TurnTooFar(PlanDetector):
    """Turns at the planned rate, if it was recorded, that go farther than planned.

    Cause: the plan states another angle than the table was set to, or the table ran on. If the
    planned angle is taken, a scale factor is wrong.
    """

    name = "wrong_angle"
    source = "degrees: 90 in the plan of two turns of 180°: called incomplete, 90° too far"
    unit = "°"
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        left = [i for i in by_another_angle(recorded) if too_far(recorded, i)]
        _rate, angle = turn_ratios(recorded)
        while left:
            first, *others = left
            alike = np.abs(angle[others] / angle[first] - 1) <= MAX_RATIO_DIFFERENCE
            same = [first, *(i for i, near in zip(others, alike, strict=True) if near)]
            size = float(np.degrees(recorded.lacking[first]))
            yield self.of(recorded, first, size, count=len(same), facts=same)
            left = [i for i in others if i not in same]

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        same = deviation.facts
        if len(same) == 1:
            return Description(
                f"{recorded.name[same[0]]}: {recorded.said[same[0]]}",
                if_taken(recorded, same[0]),
                _(
                    "It is left out of the joint estimate and of the angle method. {cure}",
                    cure=_cure(recorded, same),
                ),
            )
        angles = [
            _(
                "{name} ({far}° of {planned}°)",
                name=recorded.name[i],
                far=fixed(float(np.degrees(recorded.moved[i])), 2),
                planned=fixed(float(np.degrees(recorded.angle[i])), 0),
            )
            for i in same
        ]
        _rate, angle = turn_ratios(recorded)
        return Description(
            _(
                "{turns} go {ratio} times as far as planned: {listed}.",
                turns=counted(len(same), "turn"),
                ratio=significant(float(np.median(angle[same])), 3),
                listed=listed(angles),
            ),
            if_taken(recorded, same[0]),
            _(
                "They are left out of the joint estimate and of the angle method. {cure}",
                cure=_cure(recorded, same),
            ),
        )


def _cure(recorded: Recorded, same: Sequence[int]) -> str:
    """What to state of turns that are all too far by one factor."""
    rate, _angle = turn_ratios(recorded)
    as_planned = np.abs(rate[same] - 1) <= recorded.tolerance
    moved = np.degrees(recorded.moved[same])
    likely = USUAL_ANGLE * np.round(moved / USUAL_ANGLE)
    usual = likely.all() and (np.abs(moved / np.where(likely, likely, 1) - 1) < MAX_OF_USUAL).all()
    if not usual or not (as_planned | np.isnan(rate[same])).all():
        return _("State the degrees through which the table turned, or record again.")
    return _(
        "If the table was set so, state degrees: {degrees} in the plan; or else record again.",
        degrees=listed(
            [
                _("{degrees} for {name}", degrees=fixed(degrees, 0), name=recorded.name[i])
                for degrees, i in zip(likely.tolist(), same, strict=True)
            ]
        ),
    )
