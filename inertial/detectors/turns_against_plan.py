"""Turns that are not as planned: in part, the other way, faster, slower; marks beside them."""

from collections.abc import Iterator, Sequence

import numpy as np

from inertial.arrays import finite_or_none
from inertial.detectors.time_of_turns import angles_in_words, thousands_longer, time_ratio
from inertial.signal.detector import Description
from inertial.signal.plan_detector import (
    Deviation,
    MarksOff,
    PlanDetector,
    Recorded,
    Rescaled,
    Reversed,
)
from inertial.signal.scale_factor import MAX_RATIO_SPREAD, common_turn_ratio, turn_ratios
from inertial.text.messages import _, listed, plural
from inertial.text.numbers import counted, fixed, significant, whole


class IncompleteTurn(PlanDetector):
    """A turn that was not recorded from rest to rest, or not to the planned angle.

    What a gap or masked records lack of it is told with these: they are the cause.

    Cause: the log begins or ends while the table turns, or it turned by another angle. If the
    planned angle or a rounded one is taken, a scale factor is wrong.
    """

    name = "incomplete_turn"
    source = "S0, figure 5-9: 11.98 s are missing of a turn, so 240° of 360° are recorded"
    unit = "°"
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for i in by_another_angle(recorded):
            if not too_far(recorded, i):
                yield self.of(recorded, i, finite_or_none(np.degrees(recorded.lacking[i])))

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        assert i is not None  # it is a turn that is not complete
        return Description(
            f"{recorded.name[i]}: {recorded.said[i]}",
            if_taken(recorded, i),
            _("It is left out of the joint fit and of the angle method. Record it again."),
        )


def by_another_angle(recorded: Recorded) -> Iterator[int]:
    """Which turns are not whole, or by another angle than planned, and nothing else explains it."""
    if thousands_longer(recorded) or time_ratio(recorded) is not None:
        return
    common = common_turn_ratio(recorded)
    _, angle = turn_ratios(recorded)
    # By other axes no turn is used, though it may be whole.
    misread = any(
        each.sensor == "gyro" and not each.log and not each.undone for each in recorded.misread
    )
    for i, name in enumerate(recorded.name):
        whole_planned = recorded.do[i] == "turn" and not recorded.steady[i]
        if not whole_planned or not recorded.found[i]:
            continue
        if recorded.complete[i] or recorded.lost[i]:
            continue
        # Where all turns have another angle, that of one with a gap is not known at all.
        scaled = common is not None and (
            abs(angle[i] / common[0] - 1) <= MAX_RATIO_SPREAD or recorded.lacking_s[i] > 0
        )
        reversed_ = angle[i] < 0
        refused = misread and recorded.lacking_s[i] == 0
        if not (scaled or reversed_ or refused or name in recorded.explained):
            yield i


def too_far(recorded: Recorded, i: int) -> bool:
    """Whether a turn, of which no sample is missing, goes beyond its planned angle."""
    return bool(recorded.lacking_s[i] == 0 and abs(recorded.moved[i]) > abs(recorded.angle[i]))


def if_taken(recorded: Recorded, i: int) -> str:
    """What the scale factor would be wrong by if one took another angle than the recorded one."""
    common = common_turn_ratio(recorded)
    scale = common[0] if common else 1.0
    planned, read = np.degrees([recorded.angle[i], recorded.moved[i] / scale]).tolist()
    if not np.isfinite(planned * read) or not planned * read:
        return _("Its angle is not known, so it gives no scale factor.")
    said = [
        _(
            "Taken for {planned}°, {wrong_by}",
            planned=fixed(planned, 0),
            wrong_by=_wrong_by(read / planned - 1),
        )
    ]
    if common:
        said[0] = _(
            "Without the common ratio it is {read}°. {said}", read=fixed(read, 2), said=said[0]
        )
    # The formula of two turns takes the time of a whole one, whatever the log holds of it.
    whole_turn = abs(recorded.angle[i] / recorded.rate[i]) if recorded.rate[i] else 0.0
    seconds = float(np.fmax(recorded.duration[i], whole_turn))
    if seconds > 0 and abs(planned - read) > 0:
        said[0] += _(", bias by {fixed} °/s", fixed=fixed(abs(planned - read) / (2 * seconds), 4))
    rounded = round(read)
    too_far = abs(read) > abs(planned)  # no part of the planned angle, which one might round
    if rounded and abs(read / rounded - 1) < 0.5 and not too_far:
        said.append(
            _(
                "rounded to {rounded}°, {wrong_by}",
                rounded=fixed(rounded, 0),
                wrong_by=_wrong_by(read / rounded - 1),
            )
        )
    return "; ".join(said) + "."


def _wrong_by(error: float) -> str:
    """A scale error of one turn, and of a pair with one that is right the other way."""
    return _(
        "its scale error is wrong by {whole} ppm ({whole_2} ppm in a pair with a turn "
        "that is right)",
        whole=whole(error * 1000000.0),
        whole_2=whole(error / 2 * 1000000.0),
    )


class WrongDirection(PlanDetector):
    """A turn that is opposite to the planned direction by its gyro.

    Cause: the sign of the planned angle, or the table turned the other way. A scale factor would
    have the wrong sign.
    """

    name = "wrong_direction"
    source = "S0: shun and ni; judge a turn by the sign on the gyro, not by the word"
    severity = 3
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for each in recorded.undone.reversed:
            axis = each.about if len(each.about) == 1 else None
            yield Deviation(
                None,
                "",
                -1.0,
                self.sensor,
                axis,
                count=len(each.names),
                facts=each,
                repair=each.repair,
            )
        for i, name in enumerate(recorded.name):
            ratio = ratio_of(recorded, i)
            if recorded.found[i] and ratio < 0 and name not in recorded.explained:
                yield self.of(recorded, i, ratio)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        if i is None:
            return _the_other_way(deviation.facts, recorded)
        assert deviation.size is not None
        name, turned, planned = recorded.name[i], recorded.moved[i], recorded.angle[i]
        unit = "°"
        if not np.isfinite(turned * planned):
            turned, planned, unit = recorded.speed[i], recorded.rate[i], " °/s"
        far = [fixed(float(np.degrees(turned)), 2), fixed(float(np.degrees(planned)), 0)]
        return Description(
            _(
                "{name} turns against the planned direction: by {far}{unit} in place of "
                "{far_2}{unit}.",
                name=name,
                far=far[0],
                unit=unit,
                far_2=far[1],
            ),
            _(
                "Taken as planned, its scale error would be {fixed} %; it is left out of all "
                "methods.",
                fixed=fixed((deviation.size - 1) * 100, 0),
            ),
            _what_to_state(deviation.size, recorded, i),
        )


def _what_to_state(ratio: float, recorded: Recorded, i: int) -> str:
    """What the plan should have of a turn against it; `ratio`: recorded over planned."""
    if abs(ratio + 1) > recorded.tolerance or not np.isfinite(recorded.angle[i]):
        return _("Correct the sign of degrees or rate, or the axes of the gyros.")
    return _(
        "If the table was turned so, state degrees: {degrees} for {name}; otherwise correct the "
        "axes of the gyros.",
        degrees=f"{-float(np.degrees(recorded.angle[i])):.10g}",
        name=recorded.name[i],
    )


def ratio_of(recorded: Recorded, i: int) -> float:
    """Recorded over planned, of the rate or else of the angle; NaN where either is not known."""
    by_rate = float(recorded.speed[i] / recorded.rate[i]) if recorded.rate[i] else np.nan
    if np.isfinite(by_rate) or not recorded.angle[i]:
        return by_rate
    return float(recorded.moved[i] / recorded.angle[i])


def _the_other_way(turns: Reversed, recorded: Recorded) -> Description:
    """Turns against the plan, while earth and gravity show that the gyros' signs are right."""
    seen = ""
    if turns.by_gravity:
        seen = _(", while the gyros turn gravity as the accelerometers see it turn")
    elif any(sign > 0 for sign in recorded.gyro_signs):
        seen = _(", while the gyros see the earth turn as it does")
    sentence = (
        _(
            "{turns} of {count} are against the planned direction{seen}: {why}.",
            turns=counted(len(turns.names), "turn"),
            count=sum(do == "turn" for do in recorded.do),
            seen=seen,
            why=turns.why,
        )
        if turns.about
        else _(
            "All {count} turns are against the planned direction{seen}: the table counts its angle "
            "the other way.",
            count=len(turns.names),
            seen=seen,
        )
    )
    wrong = (
        _("the directions of `up` of these turns")
        if turns.upended
        else _("the signs of degrees or rate")
    )
    return Description(
        sentence,
        _("Taken as planned, the scale errors of their gyros would be −200 %."),
        _(
            "They are taken the other way, on this condition. Correct {wrong} in the plan; or "
            "confirm it by accept: [{repair}].",
            wrong=wrong,
            repair=turns.repair,
        ),
    )


class WrongRate(PlanDetector):
    """A turn whose rate is not the planned one, where no ratio explains all of them.

    Cause: the rate of the plan, or of the table. Where the rate is the reference, a scale factor is
    wrong.
    """

    name = "wrong_rate"
    source = "S0, table 5-6: the rate in the steady part"
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for each in recorded.undone.restated:
            yield Deviation(
                None,
                "",
                each.ratio,
                self.sensor,
                count=len(each.names),
                facts=each,
                severity=1,
                repair=each.repair,
            )
        if common_turn_ratio(recorded) is not None:
            return
        rate, angle = turn_ratios(recorded)
        for i, ratio in enumerate(rate):
            if ratio > 0 and abs(ratio - 1) > recorded.tolerance:
                as_planned = abs(angle[i] - 1) <= recorded.tolerance
                yield self.of(recorded, i, float(ratio), severity=1 if as_planned else 3)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        if isinstance(deviation.facts, Rescaled):
            return _restated(deviation.facts)
        i, ratio = deviation.at, deviation.size
        assert i is not None and ratio is not None
        read, planned = np.degrees([recorded.speed[i], recorded.rate[i]]).tolist()
        _unused, angle = turn_ratios(recorded)
        if deviation.severity == 1:
            consequence = _(
                "Its angle is as planned ({fixed}°), so its scale factor holds; the rate is not "
                "used.",
                fixed=fixed(float(np.degrees(recorded.moved[i])), 2),
            )
        elif np.isfinite(angle[i]):
            consequence = _(
                "Its angle is {significant} times the planned one, so it is left out.",
                significant=significant(float(angle[i]), 4),
            )
        else:
            consequence = _(
                "Taken as planned, its scale error would be {fixed} %.",
                fixed=fixed((ratio - 1) * 100, 1),
            )
        return Description(
            _(
                "{name} turns at {read} °/s, {ratio} times the planned {planned} °/s; the other "
                "turns are not off by this ratio.",
                name=recorded.name[i],
                read=significant(read),
                ratio=significant(ratio, 5),
                planned=significant(planned),
            ),
            consequence,
            _("Correct the rate of the plan, or see what the table did."),
        )


def _restated(restated: Rescaled) -> Description:
    """Turns through their planned angles, all at one multiple of the planned rate."""
    return Description(
        _(
            "{turns} go through the planned angles at {ratio} times the planned rate: {why}.",
            turns=counted(len(restated.names), "turn"),
            ratio=significant(restated.ratio, 5),
            why=restated.why,
        ),
        _("The angles are as planned, so the scale factors hold."),
        _("The rates are taken as recorded. Correct the rate of the plan."),
    )


# ---- Turns that go farther than planned.

USUAL_ANGLE = 45.0  # °, of whose multiples the angle of a turn usually is
MAX_OF_USUAL = 0.01  # relative, of no more than a whole turn, up to which it is one of these
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
                    "It is left out of the joint fit and of the angle method. {cure}",
                    cure=_cure(recorded, same),
                ),
            )
        _rate, angle = turn_ratios(recorded)
        return Description(
            _(
                "{turns} go {ratio} times as far as planned: {listed}.",
                turns=counted(len(same), "turn"),
                ratio=significant(float(np.median(angle[same])), 3),
                listed=listed(angles_in_words(recorded, same)),
            ),
            if_taken(recorded, same[0]),
            _(
                "They are left out of the joint fit and of the angle method. {cure}",
                cure=_cure(recorded, same),
            ),
        )


def _cure(recorded: Recorded, same: Sequence[int]) -> str:
    """What to state of turns that are all too far by one factor."""
    rate, _angle = turn_ratios(recorded)
    as_planned = np.abs(rate[same] - 1) <= recorded.tolerance
    moved = np.degrees(recorded.moved[same])
    likely = USUAL_ANGLE * np.round(moved / USUAL_ANGLE)
    within = MAX_OF_USUAL * np.minimum(np.abs(moved), 360)
    usual = likely.all() and (np.abs(moved - likely) < within).all()
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


# ---- Marks of the plan that its own turns contradict.


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
        for off in recorded.undone.marks_off:
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
