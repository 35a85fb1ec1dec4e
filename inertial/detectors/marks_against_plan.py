"""Marks of a plan that the turns of the same plan contradict."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, MarksOff, PlanDetector, Recorded
from inertial.text.messages import _, plural
from inertial.text.numbers import fixed


class WrongMark(PlanDetector):
    """Two marks of the plan that contradict the angle turned between them.

    After a turn by 180° the mark is opposite, and with it north; after whole turns it is where it
    was. Between the two manoeuvres nothing moves, as the gyros show, so one of the marks is wrong.

    Cause: the mark of one manoeuvre was copied to the next one. The earth's rate is taken off in
    the wrong direction, by up to twice its horizontal part.
    """

    name = "wrong_mark"
    source = "rotation of a direction: what stands still in the room turns by −θ in the body"
    unit = "rad"
    severity = 3
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for off in recorded.marks_off:
            number, repair = len(off.names), off.repair
            yield Deviation(None, "", off.off, self.sensor, count=number, facts=off, repair=repair)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        off: MarksOff = deviation.facts
        right, wrong = off.pair
        if off.decided:
            why = _(
                "The earth's rate, as the gyros read it at rest, shows which of them are right."
            )
        elif off.undecided:
            why = _("Which of them are right neither the plan nor the gyros show.")
        else:
            why = _(
                "Where nothing moved between them, the marks that most of them agree on are taken "
                "for right."
            )
        sentence = plural(
            "The plan states the mark of {names} {off}° from where the turns leave it. Between "
            "{right} and {wrong}, for example, nothing moves but by the planned angles, so one of "
            "their marks is wrong. {why}",
            "The plan states the marks of {names} up to {off}° from where the turns leave them. "
            "Between {right} and {wrong}, for example, nothing moves but by the planned angles, so "
            "one of their marks is wrong. {why}",
            deviation.count,
            names=", ".join(off.names),
            off=fixed(float(np.degrees(off.off)), 0),
            right=right,
            wrong=wrong,
            why=why,
        )
        consequence = _(
            "Used as stated, the horizontal part of the earth's rate would be taken off in the "
            "wrong direction, in each sample of the turns."
        )
        action = (
            _(
                "The marks are taken from where the turns leave them, on this condition. Correct "
                "them in the plan, or confirm it by accept: [{repair}].",
                repair=off.repair,
            )
            if off.undone
            else _(
                "Nothing is set right. Correct the marks in the plan; or confirm those of the "
                "first manoeuvres by accept: [{repair}].",
                repair=off.repair,
            )
        )
        return Description(sentence, consequence, action)
