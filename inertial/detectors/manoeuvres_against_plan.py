"""Rests and spans of a log that are not as planned: short, shifted, missing, in others' places."""

from collections.abc import Iterator, Sequence

import numpy as np

from inertial.arrays import Array, nearest_axis
from inertial.signal.detector import Description
from inertial.signal.plan_detector import (
    Deviation,
    PlanDetector,
    Recorded,
    SpansOff,
    Swapped,
    confirming,
    rivals_in_words,
)
from inertial.text.messages import _, plural
from inertial.text.numbers import counted, fixed, significant
from inertial.text.parameters import AXES

# ---- Rests and spans of a log that are not as planned: short, divided by the plan, shifted.

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
        for each in recorded.undone.spans_off:
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


# ---- Manoeuvres of a plan of which a log has nothing, or has two rests as one.

SAME_REST_COSINE = float(np.cos(np.radians(1)))  # of two rests with no move between
MIN_SAME_COSINE = float(np.cos(np.radians(25)))  # directions that are the same


class ManoeuvreMissing(PlanDetector):
    """A planned rest or turn of which the log has nothing, and nothing explains why.

    Cause: it was not done, not recorded, or the plan has it in the wrong place. Nothing determines
    what it alone would determine. Where nothing need move between two rests they are one, and
    nothing is lost; where a tumble goes back that is as planned. A position of which nothing was
    recorded is told once, by the first manoeuvre of it.
    """

    name = "manoeuvre_missing"
    source = "S0: a log that was not written whole"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        told = set[int]()
        for i, name in enumerate(recorded.name):
            if not recorded.found[i] and name not in recorded.explained and i not in told:
                if _one_rest_with(recorded, i) is None:
                    not_done = _position_not_done(recorded, i)
                    told |= {*not_done}
                    own = {"count": len(not_done), "facts": not_done} if not_done else {}
                    yield self.of(recorded, i, None, sensor=None, **own)
                elif not _turning_point(recorded, i):
                    yield self.of(recorded, i, None, sensor=None, severity=1)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        assert i is not None  # it is a manoeuvre that is missing
        if deviation.facts:
            return Description(
                _(
                    "Nothing of the position {position} is in {log}: {names} were not found where "
                    "the plan has them.",
                    position=recorded.position[i],
                    log=recorded.log[i],
                    names=", ".join(recorded.name[k] for k in deviation.facts),
                ),
                _("They are left out; the others are used.")
                + "".join(
                    f" {left}"
                    for k in _unlike(recorded, deviation.facts)
                    if (left := _left(recorded, k))
                ),
                _("Correct the plan, or record it."),
            )
        return Description(
            recorded.said[i] + _instead(recorded, i),
            _("It is left out; the others are used. {recorded}", recorded=_left(recorded, i)),
            _("Correct the plan, or record it."),
        )


class TurningPointOnce(PlanDetector):
    """Where a tumble goes back, one rest is recorded of the two that the plan has there.

    Cause: nothing need move between the last rest of the way there and the first of the way back.
    It is no fault: what was recorded is used, as the rest of the way there.
    """

    name = "turning_point_once"
    source = "eight rests of a tumble and back, recorded as fifteen"
    unit = "rests"
    severity = 1

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        once = [name for i, name in enumerate(recorded.name) if _turning_point(recorded, i)]
        if once:
            yield Deviation(None, "", float(len(once)), count=len(once), facts=once)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        return Description(
            plural(
                "{names} is not missing: where a tumble goes back, the plan has two rests in one "
                "attitude, and the log has them as one.",
                "{names} are not missing: where a tumble goes back, the plan has two rests in one "
                "attitude, and the log has them as one.",
                deviation.count,
                names=", ".join(deviation.facts),
            ),
            _("Nothing is lost."),
            _("Nothing need be done."),
        )


def _position_not_done(recorded: Recorded, i: int) -> list[int]:
    """The manoeuvres of the position of one, if it has several in that log, and none was found."""
    own = [k for k, position in enumerate(recorded.position) if position == recorded.position[i]]
    lost = [
        not recorded.found[k]
        and recorded.name[k] not in recorded.explained
        and recorded.log[k] == recorded.log[i]
        and _one_rest_with(recorded, k) is None
        for k in own
    ]
    return own if len(own) > 1 and all(lost) else []


def _unlike(recorded: Recorded, own: Sequence[int]) -> list[int]:
    """The first rest and the first turn among manoeuvres."""
    return [
        next(k for k in own if recorded.do[k] == do)
        for do in dict.fromkeys(recorded.do[k] for k in own)
    ]


def _one_rest_with(recorded: Recorded, i: int) -> int | None:
    """The rest that was found beside a missing one, in the same direction and log, if any."""
    own = recorded.up[i]
    if recorded.do[i] != "rest" or not np.isfinite(own).all():
        return None
    for k in (i - 1, i + 1):
        there = 0 <= k < len(recorded.name) and recorded.found[k] and recorded.do[k] == "rest"
        alike = there and np.nan_to_num(recorded.up[k]) @ own > SAME_REST_COSINE
        if alike and recorded.log[k] == recorded.log[i]:
            return k
    return None


def _turning_point(recorded: Recorded, i: int) -> bool:
    """Whether it is not found since its tumble goes back there, and nothing moved between."""
    beside = None if recorded.found[i] else _one_rest_with(recorded, i)
    of_one = beside is not None and recorded.tumble[i] == recorded.tumble[beside]
    return of_one and recorded.tumble[i] is not None


def _instead(recorded: Recorded, i: int) -> str:
    """What the log has in its place."""
    if recorded.do[i] == "rest":
        force, up = recorded.force[i], recorded.up[i]
        if not (np.isfinite(force).all() and np.isfinite(up).all()):
            return ""
        direction = force / np.linalg.norm(force)
        away = np.degrees(np.arccos(np.clip(direction @ up, -1, 1)))
        alone = recorded.log.count(recorded.log[i]) == 1
        sentence = (
            _(" Its log rests {away:.0f}° from there, with {direction} up.")
            if alone
            else _(" In its place the log rests {away:.0f}° from there, with {direction} up.")
        ).format(away=away, direction=_axis(direction))
        if alone and float(np.abs(direction).max()) > MIN_SAME_COSINE:
            sentence += _(
                " Either the IMU had this attitude, or two axes or a sign of the accelerometers are"
            )
            sentence += _(" wrong; this log alone cannot decide.")
        return sentence
    turned = np.degrees(recorded.turned[i])
    about = recorded.about[i]
    blind = np.flatnonzero(~recorded.gyros[i] & (np.abs(about) > MIN_SAME_COSINE))
    if len(blind):
        return _(
            " The {axes} gyro, which would see it, has no reading to be used.",
            axes=AXES[int(blind[0])],
        )
    if recorded.first[i] >= 0 and np.isfinite(turned).any():
        angles = ", ".join(fixed(float(angle), 0) for angle in turned)
        return _(" What moves there turns by ({angles})° about x, y, z.", angles=angles)
    return ""


def _axis(direction: Array) -> str:
    k = nearest_axis(direction)
    if abs(direction[k]) > MIN_SAME_COSINE:
        return f"{'+' if direction[k] > 0 else '−'}{AXES[k]}"
    return "(" + ", ".join(fixed(float(part), 2) for part in direction) + ")"


def _left(recorded: Recorded, i: int) -> str:
    """Which other manoeuvres observe the same direction, the nearest first."""
    rest = recorded.do[i] == "rest"
    directions = recorded.up if rest else recorded.about
    own = directions[i]
    if not np.isfinite(own).all():
        return ""
    along = np.nan_to_num(directions) @ own
    along = along if rest else np.abs(along)
    along[~recorded.found | (np.arange(len(along)) == i)] = -1.0
    nearest = [int(k) for k in np.argsort(-along, kind="stable") if along[k] > MIN_SAME_COSINE]
    if nearest:
        sentence = _(
            "The same {value} is seen in {names}.",
            value=_("direction") if rest else _("axis"),
            names=", ".join(recorded.name[k] for k in nearest[:4]),
        )
        beside = _one_rest_with(recorded, i)
        if beside is not None:
            sentence += " " + _(
                "{name}, beside it in the plan, is one rest with it where nothing moved between.",
                name=recorded.name[beside],
            )
        return sentence
    axis = _axis(own)
    if not rest:
        return _(
            "No other turn is about {strip}: its scale factor is not determined.",
            strip=axis.strip("+−"),
        )
    if float(np.abs(own).max()) > MIN_SAME_COSINE:
        return _(
            "No other rest has {axis} up, which parts its bias from its scale factor.", axis=axis
        )
    return ""


# ---- Manoeuvres, or logs, that are in each other's place.


class ManoeuvreSwapped(PlanDetector):
    """Two logs under each other's names, or two manoeuvres of a log in each other's place.

    Each agrees with the plan of the other, and not with its own.

    Cause: two files were handed over under each other's names, or the order was another. Used as
    planned they would reverse the sign of a bias or scale factor.
    """

    name = "manoeuvre_swapped"
    source = "S0 took another group's log in place of a broken one: names are given by hand"
    unit = "manoeuvres"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for swapped in recorded.swapped:
            i = list(recorded.name).index(swapped.names[0])
            yield self.of(
                recorded, i, float(len(swapped.names)), facts=swapped, repair=swapped.repair
            )

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        swapped: Swapped = deviation.facts
        own = [i for i, name in enumerate(recorded.name) if name in swapped.names]
        half = len(swapped.names) // 2
        first, second = ", ".join(swapped.names[:half]), ", ".join(swapped.names[half:])
        if len(swapped.logs) > 2:
            many = len(swapped.logs) // 2
            sentence = _(
                "The {count} logs from {first} to {first_last} and the {count} from {second} to "
                "{second_last} are in each other's place, one by one: the names of two positions "
                "are exchanged, or the IMU stood in the other one.",
                count=many,
                first=swapped.logs[0],
                first_last=swapped.logs[many - 1],
                second=swapped.logs[many],
                second_last=swapped.logs[-1],
            )
        elif len(swapped.logs) == 2:
            one, other = swapped.logs
            sentence = _(
                "{value} contains {second}, and {other} contains {first}: their names are "
                "exchanged.",
                value=one,
                second=second,
                other=other,
                first=first,
            )
        else:
            sentence = _(
                "In {logs}, {first} and {second} are exchanged: each shows what the plan has of "
                "the other.",
                logs=swapped.logs[0],
                first=first,
                second=second,
            )
        if swapped.rivals:
            sentence += rivals_in_words(swapped.rivals)
        elif len(swapped.logs) == 2 and not swapped.undone:
            sentence += _or_a_sign(recorded, own)
        action = (
            _(
                "Each is evaluated by the attitude, or the turn, that its readings show, on this "
                "condition. Correct the names, or the plan; or confirm it by accept: [{repair}].",
                repair=swapped.repair,
            )
            if swapped.undone
            else _(
                "Both are left out, for only the laboratory knows which is which. Correct the "
                "names, or the plan, and run it again."
            )
        )
        action += confirming(swapped.repair, swapped.rivals)
        return Description(sentence, _if_used(recorded, own), action)


def _or_a_sign(recorded: Recorded, own: list[int]) -> str:
    """What explains the same: a wrong sign of the one axis that both see."""
    rests = all(recorded.do[i] == "rest" for i in own)
    directions = recorded.up[own] if rests else recorded.about[own] * recorded.angle[own, None]
    if len(own) != 2 or not np.isfinite(directions).all():
        return ""
    unit = directions / np.linalg.norm(directions, axis=1)[:, None]
    if float(unit[0] @ unit[1]) > -0.9:
        return ""
    axis = "xyz"[nearest_axis(unit[0])]
    if rests:
        return _(
            " A wrong sign of the {axis} accelerometer cannot be distinguished from it, if "
            "no other manoeuvre shows its sign.",
            axis=axis,
        )
    if recorded.gyro_signs["xyz".index(axis)] > 0:
        return _(
            " Planned angles of the wrong sign cannot be distinguished from it; the sign of "
            "the {axis} gyro is right, as the earth rate shows.",
            axis=axis,
        )
    return _(
        " A wrong sign of the {axis} gyro, or of the planned angles, cannot be "
        "distinguished from it.",
        axis=axis,
    )


def _if_used(recorded: Recorded, own: list[int]) -> str:
    if all(recorded.do[i] == "rest" for i in own):
        apart = np.linalg.norm(recorded.up[own][:, None] - recorded.up[own], axis=-1).max()
        return _(
            "Used as named, each mean would be wrong by up to {wrong:.3g} m/s².",
            wrong=recorded.given.gravity * (apart if np.isfinite(apart) else 2.0),
        )
    angles = np.degrees(np.abs(recorded.angle[own]))
    if np.isfinite(angles).all():
        wrong = f"{2 * angles.max():.0f}°"
        return _(
            "Used as named, each angle would be wrong by up to {wrong}, a scale error of −200 %.",
            wrong=wrong,
        )
    return _("Used as named, each would be evaluated as the other.")
