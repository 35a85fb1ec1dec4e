"""An encoder by which all turns go farther than planned, by one ratio."""

from collections.abc import Iterator

import numpy as np

from inertial.arrays import Array
from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, significant

MIN_TURNS = 3  # that agree; two may stop alike
MAX_CHANCE = 5e-3  # that turns which stop anywhere differ from the plan so nearly alike
LEAST_RANGE = 2.0  # sigma of a difference of two angles: no agreement is taken as closer


class EncoderScale(PlanDetector):
    """Encoder and plan differ by one ratio in all turns, far beyond the sigma of their angles.

    Cause: the counts per revolution, a gear or the unit of the encoder are other than stated, or
    the table, driven by another measure, turns so much farther. Both make the gyros differ from
    the plan in the same way, and nothing on the table tells one from the other: the scale factors
    of all gyros rest on it. Where turns stop now here, now there, the encoder is there to tell.
    """

    name = "encoder_scale"
    source = "IEEE Std 1554-2005: the accuracy of angles is that of the encoder's scale"
    severity = 3
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        off = recorded.angle / recorded.stated_angle - 1
        read = np.flatnonzero(recorded.found & ~recorded.steady & (np.abs(off) > 0))
        if len(read) < MIN_TURNS:
            return
        sigma = np.sqrt(2) * recorded.angle_sigma / np.median(np.abs(recorded.angle[read]))
        alike = _alike(off[read], LEAST_RANGE * sigma)
        if alike is not None:
            ratio = float(np.mean(off[read][alike]))
            names = [recorded.name[int(i)] for i in read[alike]]
            yield Deviation(None, "", ratio, self.sensor, count=len(names), facts=names)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        assert deviation.size is not None
        i = list(recorded.name).index(deviation.facts[0])
        read, planned = np.degrees([recorded.angle[i], recorded.stated_angle[i]]).tolist()
        return Description(
            _(
                "By the encoder {turns} go {size} times as far as planned ({name}: {read}° in "
                "place of {planned}°): either its scale is off, or the table does turn so far.",
                turns=counted(deviation.count, "turn"),
                size=fixed(1 + deviation.size, 6),
                name=deviation.facts[0],
                read=fixed(read, 4),
                planned=fixed(planned, 4),
            ),
            _(
                "The encoder's angles are used. If the plan's are right, the scale factors of all "
                "gyros are off by {ppm} ppm.",
                ppm=significant(-1e6 * deviation.size, 3),
            ),
            _(
                "Turn the table by a whole revolution against a mark, an autocollimator or a "
                "polygon. If it turns as planned, correct the scale of the encoder, or leave it "
                "out of the campaign; if the encoder is right, state the angles of the plan by it."
            ),
        )


def _alike(off: Array, least: float) -> Array | None:
    """The turns of one ratio, all but at most one, (k,) by number; None where chance makes them so.

    If turns stop anywhere within their median distance from the plan, all others follow the first
    into a range r with the chance (r / distance)^(k − 1). `off`: relative; `least`: of the range.
    """
    median = float(np.median(off))
    order = np.argsort(np.abs(off - median))
    for alike, ways in ((order, 1), (order[:-1], len(off))):
        share = max(float(np.ptp(off[alike])), least) / abs(median)
        chance = ways * min(share, 1.0) ** (len(alike) - 1)
        if len(alike) >= MIN_TURNS and chance < MAX_CHANCE:
            return np.sort(alike)
    return None
