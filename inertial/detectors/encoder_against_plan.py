"""An encoder that jumps, or by which turns go farther, or less far, than planned."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.special import stdtr

from inertial.arrays import Array, Integers
from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, significant
from inertial.text.units import ARC_SECOND

MIN_TURNS = 3  # that agree; two may stop alike
MAX_CHANCE = 5e-3  # that turns which stop anywhere differ from the plan so nearly alike
LEAST_RANGE = 2.0  # sigma of a difference of two angles: no agreement is taken as closer
MIN_SIGMAS = 5.0  # of a difference of two angles, from which a turn differs from its plan
MIN_LOG_ODDS = 5.3  # by which the gyros contradict an encoder: 200 to 1, as MAX_CHANCE
MAX_CHANCE_OF_MEAN = 1e-3  # that turns which stop anywhere differ from the plan on the mean
MAX_APART = np.radians(5.0)  # of jumps that are at one place of the encoder
MAX_ECCENTRICITY = np.radians(0.1)  # of an encoder on the axis of a table


class EncoderJump(PlanDetector):
    """The encoder's angle jumps within a turn, and no gyro feels it.

    Cause: an index mark that sets the count anew, counts that are lost or gained, or a damaged
    line of the scale. The jump is known in size and place, by the gyros over a tenth of a second,
    and the angles of the encoder are taken without it; used as they are, they would put its share
    of the turn into the scale factor of the gyro.
    """

    name = "encoder_jump"
    source = "IEEE Std 1554-2005: the accuracy of angles is that of the encoder"
    severity = 2
    unit = "rad"
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        if not len(recorded.jump_turn):
            return
        size = float(np.median(np.abs(recorded.jump_size)))
        if len(turns := np.unique(recorded.jump_turn)) == 1:
            first = float(recorded.jump_size[0]) if len(recorded.jump_size) == 1 else size
            yield self.of(recorded, int(turns[0]), first, count=len(recorded.jump_turn))
        else:
            yield Deviation(None, "", size, self.sensor, count=len(recorded.jump_turn))

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        assert deviation.size is not None
        turns = np.unique(recorded.jump_turn)
        size = significant(float(np.degrees(deviation.size)), 2)
        if deviation.at is None:
            sentence = _(
                "In {turns} the encoder's angle jumps by {size}° within 0.1 s{at}, which no gyro "
                "feels: by so much it is the encoder that is off.",
                turns=counted(len(turns), "turn"),
                size=size,
                at=_place_of_jumps(recorded),
            )
        else:
            sentence = _(
                "In {turn} the encoder's angle jumps by {size}° within 0.1 s{at}, which no gyro "
                "feels: by so much it is the encoder that is off.",
                turn=recorded.name[deviation.at],
                size=size,
                at=_place_of_jumps(recorded),
            )
        shares = np.abs(recorded.jump_size / recorded.stated_angle[recorded.jump_turn])
        return Description(
            sentence,
            _(
                "The angles are taken without the jumps, each known to {sigma}″, which the σ of "
                "these turns' angles contain. With them a scale factor would be off by up to {ppm} "
                "ppm.",
                sigma=significant(float(np.max(recorded.jump_sigma)) / ARC_SECOND, 2),
                ppm=significant(1e6 * float(np.max(shares)), 2),
            ),
            _(
                "Have scale, index mark, reading head and counter of the encoder examined there; "
                "its other angles count as before."
            ),
        )


def _place_of_jumps(recorded: Recorded) -> str:
    """Where an encoder jumps, as a part of a sentence; empty where it does so here and there."""
    places = np.exp(1j * recorded.jump_at)
    middle = complex(np.mean(places))
    if not (np.abs(np.angle(places / middle)) < MAX_APART).all():
        return ""
    where = fixed(float(np.degrees(np.angle(middle))) % 360, 0)
    return _(", where it reads {angle}° or whole turns more", angle=where)


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
        read, off = _read(recorded)
        alike = _of_one_ratio(recorded, read, off)
        if alike is None or self.may_be_eccentric(recorded, read[alike], off[alike]):
            return
        yield self.of_turns(recorded, read[alike], off[alike])

    def may_be_eccentric(self, recorded: Recorded, turns: Integers, off: Array) -> bool:
        """Whether an encoder off its axis may read these turns so, too."""
        return least_eccentricity(recorded, turns, off) < float(MAX_ECCENTRICITY)

    def of_turns(self, recorded: Recorded, turns: Integers, off: Array) -> Deviation:
        """The deviation of turns that are off by one ratio."""
        names = [recorded.name[int(i)] for i in turns]
        ratio = float(np.mean(off))
        return Deviation(None, "", ratio, self.sensor, count=len(names), facts=names)

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
            _if_planned(deviation.size),
            _(
                "Turn the table by a whole revolution against a mark, an autocollimator or a "
                "polygon. If it turns as planned, correct the scale of the encoder, or leave it "
                "out of the campaign; if the encoder is right, state the angles of the plan by it."
            ),
        )


def _if_planned(size: float) -> str:
    """What an encoder that reads 1 + `size` of the planned angles does if these are right."""
    return _(
        "The encoder's angles are used. If the plan's are right, the scale factors of all gyros "
        "are off by {ppm} ppm.",
        ppm=significant(-1e6 * size, 3),
    )


class EncoderScaleOrEccentricity(EncoderScale):
    """The same in turns that are not whole, which an encoder off its axis reads alike, too.

    Cause: as of the scale; or the encoder's disc sits off the axis of the table, and reads
    ε sin(a + φ) more at its angle a. A turn by θ from a is then off by
    2 ε sin(θ/2) cos(a + θ/2 + φ), by as much there as back; a whole revolution is not.
    """

    name = "encoder_scale_or_eccentricity"
    source = "IEEE Std 1554-2005: the accuracy of angles is that of the encoder"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        read, off = _read(recorded)
        alike = _of_one_ratio(recorded, read, off)
        if alike is not None and self.may_be_eccentric(recorded, read[alike], off[alike]):
            yield self.of_turns(recorded, read[alike], off[alike])

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        assert deviation.size is not None
        places = [list(recorded.name).index(name) for name in deviation.facts]
        read, planned = np.degrees(
            [recorded.angle[places[0]], recorded.stated_angle[places[0]]]
        ).tolist()
        turns = np.array(places, np.int64)
        off = np.full(len(turns), deviation.size)
        return Description(
            _(
                "By the encoder {turns} go {size} times as far as planned ({name}: {read}° in "
                "place of {planned}°): its scale is off, or it sits off the axis, by an error of "
                "its angle of {eccentricity}″ or more, or the table does turn so far.",
                turns=counted(deviation.count, "turn"),
                size=fixed(1 + deviation.size, 6),
                name=deviation.facts[0],
                read=fixed(read, 4),
                planned=fixed(planned, 4),
                eccentricity=significant(least_eccentricity(recorded, turns, off) / ARC_SECOND, 2),
            ),
            _if_planned(deviation.size),
            _(
                "Turn by whole revolutions, in which an encoder off its axis is right: if it "
                "agrees with the plan then, it is eccentric; if it is off by the same ratio, "
                "correct its scale, or the angles of the plan, by a mark, an autocollimator or a "
                "polygon. Or leave it out of the campaign."
            ),
        )


def least_eccentricity(recorded: Recorded, turns: Integers, off: Array) -> float:
    """The least amplitude, rad, of a sine of the encoder's angle by which turns read so.

    `off`: relative, of each of the turns.
    """
    angle = recorded.stated_angle[turns]
    half = np.abs(np.sin(angle / 2))
    with np.errstate(divide="ignore"):
        return float(np.max(np.abs(off * angle) / (2 * half)))


@dataclass(frozen=True)
class Unlike:
    """Turns that an encoder has otherwise than the plan; log_odds: of the plan, by the gyros."""

    turns: Integers
    log_odds: float


class EncoderAngles(PlanDetector):
    """Encoder and plan differ in turns by no one ratio, and the gyros do not say that it is right.

    Each direction has its own difference, or each turn. Where turns stop now here, now there, the
    gyros go as far as the encoder says, and nothing is wrong. Where they go as the plan says, or
    do not tell, but the turns differ from the plan on the mean, the scale factors rest on what
    may be wrong.

    Cause: the encoder loses or gains counts, jumps at one place, or reads its zero anew; or the
    table stops elsewhere in one direction than in the other.
    """

    name = "encoder_angles"
    source = "IEEE Std 1554-2005: the accuracy of angles is that of the encoder"
    severity = 3
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        read, off = _read(recorded)
        if _of_one_ratio(recorded, read, off) is not None:
            return
        sigma = np.sqrt(2) * recorded.angle_sigma
        far = np.abs(off * recorded.stated_angle[read]) > MIN_SIGMAS * sigma
        if not far.any():
            return
        least = float(sigma / np.median(np.abs(recorded.stated_angle[read])))
        odds = _odds_of_plan(recorded, read)
        on_the_mean = abs(odds) < MIN_LOG_ODDS and far.sum() >= MIN_TURNS and _biased(off, least)
        if odds >= MIN_LOG_ODDS or on_the_mean:
            size = _largest_mean(recorded, read, off)
            turns = read[far]
            facts = Unlike(turns, odds)
            yield Deviation(None, "", size, self.sensor, count=len(turns), facts=facts)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        assert deviation.size is not None
        unlike: Unlike = deviation.facts
        beyond = np.sign(recorded.stated_angle) * (recorded.angle - recorded.stated_angle)
        least, most = (int(unlike.turns[f(beyond[unlike.turns])]) for f in (np.argmin, np.argmax))
        by_gyros = (
            _(
                " By the gyros the turns differ among themselves as the plan has it, and not as "
                "the encoder has it."
            )
            if unlike.log_odds >= MIN_LOG_ODDS
            else ""
        )
        if len(unlike.turns) == 1:
            sentence = _(
                "By the encoder {name} differs from the plan by {angle}″ in its sense. Either the "
                "encoder is off, or the table does stop elsewhere than planned.",
                name=recorded.name[least],
                angle=_arc(beyond[least]),
            )
        else:
            sentence = _(
                "By the encoder {turns} differ from the plan, by no one ratio: {name} by {angle}″ "
                "in its sense, {other} by {other_angle}″. Either the encoder is off, or the table "
                "does stop elsewhere than planned.",
                turns=counted(deviation.count, "turn"),
                name=recorded.name[least],
                angle=_arc(beyond[least]),
                other=recorded.name[most],
                other_angle=_arc(beyond[most]),
            )
        return Description(
            sentence + by_gyros,
            _(
                "The encoder's angles are used. If the plan's are right, the scale factors of the "
                "gyros are off by up to {ppm} ppm.",
                ppm=significant(1e6 * abs(deviation.size), 3),
            ),
            _(
                "Turn the table by a whole revolution, in both senses, against a mark, an "
                "autocollimator or a polygon. If it turns as planned, correct the encoder, or "
                "leave it out of the campaign; if the encoder is right, state the angles of the "
                "plan by it."
            ),
        )


def _read(recorded: Recorded) -> tuple[Integers, Array]:
    """The turns of which an encoder is used, (k,), and by which share they go beyond the plan."""
    off = recorded.angle / recorded.stated_angle - 1
    read = np.flatnonzero(recorded.found & ~recorded.steady & (np.abs(off) > 0))
    return read, off[read]


def _of_one_ratio(recorded: Recorded, read: Integers, off: Array) -> Array | None:
    """Which of the turns differ from the plan by one ratio; None where they do not."""
    if len(read) < MIN_TURNS:
        return None
    sigma = np.sqrt(2) * recorded.angle_sigma / np.median(np.abs(recorded.angle[read]))
    return _alike(off, LEAST_RANGE * sigma)


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


def _odds_of_plan(recorded: Recorded, read: Integers) -> float:
    """The logarithm of the odds of the plan's angles against the encoder's, by the gyros.

    Each gyro has one scale factor in all its turns, about an axis of the table or its reverse, and
    what is left is noise of unknown variance: (left by the encoder / left by the plan)^(ν/2), of
    ν degrees of freedom. What all turns have in common is in the scale factor, and tells nothing.
    0 where no axis has two turns.
    """
    left, degrees = np.zeros(2), 0
    known = read[np.isfinite(recorded.turned_farther[read])]
    for same in _by_axis(recorded, known):
        gyro = recorded.turned_farther[same]
        for i, angle in enumerate((recorded.angle[same], recorded.stated_angle[same])):
            left[i] += float(np.sum((gyro - angle * (angle @ gyro) / (angle @ angle)) ** 2))
        degrees += len(same) - 1
    if not degrees or not (left > 0).all():
        return 0.0
    return float(degrees / 2 * np.log(left[0] / left[1]))


def _by_axis(recorded: Recorded, turns: Integers) -> Iterator[Integers]:
    """Turns about one axis of the case, in either sense of it."""
    axes = np.round(np.abs(recorded.about[turns]), 3)
    known = np.isfinite(axes).all(axis=1)
    for axis in np.unique(axes[known], axis=0):
        yield turns[(axes == axis).all(axis=1)]


def _biased(off: Array, least: float) -> bool:
    """Whether turns differ from the plan on the mean by more than turns that stop anywhere.

    `least`: the sigma of a difference, relative: they scatter by no less.
    """
    scatter = max(float(np.std(off, ddof=1)), least) / np.sqrt(len(off))
    chance = 2 * float(stdtr(len(off) - 1, -abs(float(np.mean(off))) / scatter))
    return chance < MAX_CHANCE_OF_MEAN


def _largest_mean(recorded: Recorded, read: Integers, off: Array) -> float:
    """The largest of the means about each axis, relative: by so much a scale factor may be off."""
    share = dict(zip(read.tolist(), off.tolist(), strict=True))
    means = [float(np.mean([share[int(i)] for i in own])) for own in _by_axis(recorded, read)]
    return max(means, key=abs, default=float(np.mean(off)))


def _arc(angle: float) -> str:
    """An angle, rad, in arc seconds, with its sign."""
    return fixed(angle / ARC_SECOND, 0)
