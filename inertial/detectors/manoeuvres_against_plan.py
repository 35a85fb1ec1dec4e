"""Rests and spans of a log that are not as planned: short, divided by the plan, shifted."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded, SpansOff
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, significant

MIN_DURATION_SHARE = 1 / 3  # of the planned time


class WrongSpans(PlanDetector):
    """Manoeuvres that a log holds one after another, all by one time beside their stated spans.

    Cause: the spans were noted by another clock, or from another beginning, than the time of the
    log. Cut by them, turns would be found in part or not at all, and rests would hold motion.
    """

    name = "wrong_spans"
    source = "a table's protocol and a log have a clock each, unless one was set by the other"
    unit = "s"
    severity = 3

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for each in recorded.spans_off:
            number = len(each.names)
            yield Deviation(None, each.log, each.late, count=number, facts=each, repair=each.repair)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        off: SpansOff = deviation.facts
        late = _("late") if off.late > 0 else _("early")
        time = fixed(abs(off.late), 1)
        return Description(
            _(
                "{log}: the stated spans of all {count} manoeuvres are {time} s {late}, ± {open} "
                "s; moved by that they hold what the plan has, in its order.",
                log=off.log,
                count=deviation.count,
                time=time,
                late=late,
                open=fixed(off.open, 1),
            ),
            _("Cut as stated, turns would be there in part or not at all."),
            _(
                "The spans are moved, on this condition. Correct them by {change} s; or confirm it "
                "by accept: [{repair}].",
                change=fixed(-off.late, 1),
                repair=off.repair,
            ),
        )


class ShortRest(PlanDetector):
    """A rest that lasts less than a third of what was planned.

    Cause: the log was cut off, or is an excerpt. The sigma of the mean of the rest is larger.
    """

    name = "short_rest"
    source = "S0: white noise averages out with the root of the time at rest"
    unit = "s"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for i, what in enumerate(recorded.do):
            short = recorded.duration[i] < MIN_DURATION_SHARE * recorded.seconds[i]
            if what == "rest" and recorded.found[i] and recorded.duration[i] > 0 and short:
                yield self.of(recorded, i, float(recorded.duration[i]))

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        assert i is not None and deviation.size is not None
        planned = float(recorded.seconds[i])
        times = significant(float(np.sqrt(planned / deviation.size)), 2)
        return Description(
            _(
                "{name} rests for {size} s of the {planned} s planned.",
                name=recorded.name[i],
                size=significant(deviation.size, 3),
                planned=fixed(planned, 0),
            ),
            _(
                "What white noise leaves in its mean is {times} times what was planned.",
                times=times,
            ),
            _("It is used with the sigma that it has. Record it whole."),
        )


class RestsDivided(PlanDetector):
    """Rests of one direction in one still stretch, which the plan alone divides.

    Cause: accelerometers do not see a turn about the vertical, and no gyro is recorded. It is no
    fault: each rest has its planned time; a part of a turn that is taken for rest adds nothing but
    what a lever arm makes of its rate, and of another tilt, and none that the readings show.
    """

    name = "rests_divided"
    source = "four azimuths on each of six faces, accelerometers alone: 24 positions in 6 stretches"
    unit = "positions"
    sensor = "accel"
    severity = 1

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        if recorded.divided:
            number = sum(len(names) for names in recorded.divided)
            yield Deviation(None, "", float(number), self.sensor, count=len(recorded.divided))

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        assert deviation.size is not None
        return Description(
            _(
                "{rests} of the plan lie in stretches in which nothing is seen to move, "
                "{stretches} in all, of which the first has {names}: no gyro is recorded, and "
                "accelerometers do not see a turn about the vertical.",
                rests=counted(round(deviation.size), "rest"),
                stretches=deviation.count,
                names=", ".join(recorded.divided[0]),
            ),
            _(
                "Each stretch is divided by the planned times, at equal distances or where its "
                "readings vary clearly less. A part of the turns between may be within a rest."
            ),
            _("Nothing need be done. Where the times are known, state the span of each rest."),
        )
