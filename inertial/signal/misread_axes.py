"""The description of exchanged or reversed axes of a sensor."""

import numpy as np

from inertial.sensors import PLURAL
from inertial.signal.axis_permutations import Permutation
from inertial.signal.detector import Description
from inertial.signal.plan_detector import (
    Deviation,
    Edge,
    Misread,
    Recorded,
    ReversedPart,
    SignChange,
    confirming,
    rivals_in_words,
)
from inertial.text.messages import _, first_of, listed
from inertial.text.numbers import counted, significant
from inertial.text.parameters import AXES

MAX_NAMES = 6  # in a sentence


def deviation(misread: Misread, recorded: Recorded) -> Deviation:
    """A misread sensor as a deviation: of its log, or of the campaign."""
    of_log = [i for i, log in enumerate(recorded.log) if log == misread.log]
    alone = of_log[0] if len(of_log) == 1 else None
    of_log = _inside(misread.part, recorded) if misread.part else of_log
    first = min((int(recorded.first[i]) for i in of_log), default=-1)
    after = max((int(recorded.after[i]) for i in of_log), default=-1)
    times = [float(t) for t in (*recorded.from_s[of_log], *recorded.to_s[of_log]) if np.isfinite(t)]
    return Deviation(
        alone,
        misread.log,
        float(len(of_log if misread.part else misread.explains)),
        misread.sensor,
        next((AXES[of.axis] for of in (misread.change, misread.part) if of is not None), None),
        first=first,
        after=after,
        from_s=min(times, default=None),
        to_s=max(times, default=None),
        facts=misread,
        repair=misread.repair,
    )


def _inside(part: ReversedPart, recorded: Recorded) -> list[int]:
    """The manoeuvres of which any may be in a part of the recording, in the order of the plan."""
    place = {name: i for i, name in enumerate(recorded.name)}
    first, last = 0, len(place) - 1
    if begins := part.begins:
        after = place.get(begins.after, last)
        first = min(place.get(begins.before, after - 1) + 1, after)
    if ends := part.ends:
        before = place.get(ends.before, first)
        last = max(place.get(ends.after, before + 1) - 1, before)
    return [i for i in range(first, last + 1) if recorded.log[i] in part.logs]


def describe_misread(misread: Misread, recorded: Recorded) -> Description:
    """A misread sensor in words."""
    if misread.log:
        consequence = _(
            "Used, its readings would be off by up to {significant} {value}, for the other "
            "logs are not so.",
            significant=significant(_off(misread, recorded), 3),
            value="m/s²" if misread.sensor == "accel" else "°",
        )
        action = _("It is left out. See how this log was written, and correct it.")
    else:
        consequence = _consequence_in_all_logs(misread)
        action = _(
            "The manoeuvres are found by the right axes; the data are not changed. Correct "
            "the axes of the instrument, or the columns, and run it again."
        )
    if misread.part is not None and not misread.undone:
        action = _(
            "The {axis} gyro is left out there, from the earliest to the latest moment that it may "
            "be reversed. See what changed where it begins and ends; turn the sign in the log, or "
            "give each part a log of its own, and run it again.",
            axis=AXES[misread.part.axis],
        )
    elif misread.change is not None and not misread.undone:
        action = _(
            "Nothing is set right, for within a log the moment is not known. See what changed "
            "between {before} and {after}; turn the sign in the log, or give each part a log of "
            "its own, and run it again.",
            before=misread.change.before,
            after=misread.change.after,
        )
    elif misread.undone:
        action = _(
            "The readings are set right before the estimation, on this condition. Correct the axes "
            "of the instrument, or the columns; or confirm it by accept: [{repair}].",
            repair=misread.repair,
        )
    return Description(
        _sentence(misread, recorded) + rivals_in_words(misread.rivals),
        consequence,
        action + confirming(misread.repair, misread.rivals),
    )


def _sentence(misread: Misread, recorded: Recorded) -> str:
    """Which axes are others, and what shows it."""
    if misread.change is not None:
        return _of_a_change(misread, misread.change)
    if misread.part is not None:
        return _of_a_part(misread, misread.part)
    sensor = PLURAL[misread.sensor]
    where = _("in {log}", log=misread.log) if misread.log else "in all logs"
    if misread.spans:
        return _(
            "Of the {sensor}, {where}, {axes}: only so do the gyros turn gravity as the "
            "accelerometers see it turn, in {spans} of half a second.{handed}",
            sensor=sensor,
            where=where,
            axes=reads_in_words(misread.axes),
            spans=counted(misread.spans, "span"),
            handed=""
            if _determinant_of_all(misread, recorded) > 0
            else _(" So their triad is left-handed, which no mounting does."),
        )
    number = len(misread.explains)
    names = first_of(misread.explains, MAX_NAMES)
    return _(
        "Of the {sensor}, {where}, {axes}: only so {agree} with the plan ({names}). {misread}",
        sensor=sensor,
        where=where,
        axes=reads_in_words(misread.axes),
        agree=counted(number, "manoeuvre") + (_(" agrees") if number == 1 else _(" agree")),
        names=names,
        misread=_handed(misread, recorded),
    )


def _of_a_change(misread: Misread, change: SignChange) -> str:
    """Where a sign changes, and what shows it."""
    return _(
        "The sign of the {axis} gyro changes between {before} and {after}: the turns ({names}) "
        "read the other way, and what it reads at rest, its bias and the earth's rate, is the "
        "negative on one side of what it is on the other.",
        axis=AXES[change.axis],
        before=change.before,
        after=change.after,
        names=", ".join(misread.explains[:MAX_NAMES]),
    )


def _of_a_part(misread: Misread, part: ReversedPart) -> str:
    """Where a gyro is reversed, and what shows it."""
    sentence = _(
        "The {axis} gyro reads its negative in a part of the recording, {begins} {ends}. While the "
        "case is turned over there, the rotation that the gyros read carries the direction of "
        "gravity where the accelerometers find it only if {axis} is negated ({spans} of 0.5 s); "
        "elsewhere it reads as it should.",
        axis=AXES[part.axis],
        begins=_begins(part.begins),
        ends=_ends(part.ends),
        spans=counted(misread.spans, "interval"),
    )
    if not part.turns:
        return sentence
    return _(
        "{sentence} In the turns about it ({names}) it reads as planned.",
        sentence=sentence,
        names=listed(part.turns[:MAX_NAMES]),
    )


def _begins(edge: Edge | None) -> str:
    if edge is None:
        return _("from its beginning")
    if not edge.before:
        return _("from {manoeuvre} on or longer before it", manoeuvre=edge.after)
    return _("from a moment {between} on", between=_between(edge))


def _ends(edge: Edge | None) -> str:
    if edge is None:
        return _("to its end")
    if not edge.after:
        return _("up to {manoeuvre} or longer after it", manoeuvre=edge.before)
    return _("until one {between}", between=_between(edge))


def _between(edge: Edge) -> str:
    """Two manoeuvres, and times where a log has them; in a search for rests, times alone."""
    times = edge.to_s > edge.from_s
    if edge.before == edge.after and times:
        return _(
            "between {from_s} and {to_s} s", from_s=f"{edge.from_s:.1f}", to_s=f"{edge.to_s:.1f}"
        )
    words = _("between {before} and {after}", before=edge.before, after=edge.after)
    if not times:
        return words
    return _(
        "{words} ({from_s} to {to_s} s)",
        words=words,
        from_s=f"{edge.from_s:.1f}",
        to_s=f"{edge.to_s:.1f}",
    )


def _consequence_in_all_logs(misread: Misread) -> str:
    sensor, axes = PLURAL[misread.sensor], _in_the_matrix(misread.axes)
    if misread.part is not None:
        return _(
            "Used unchanged, the {axis} scale factor would have the wrong sign there.",
            axis=AXES[misread.part.axis],
        )
    if misread.change is not None and not misread.undone:
        return _(
            "The turns give no parameters of the gyros: with the sign changed in the whole "
            "recording, the manoeuvres on the other side would be reversed instead."
        )
    if misread.undone:
        return _(
            "Taken as they are named, the {sensor} would give {axes}; the biases would be "
            "under wrong names.",
            sensor=sensor,
            axes=axes,
        )
    if misread.sensor == "gyro":
        return _(
            "The turns give no parameters of the gyros. Used, they would give {axes}; the "
            "biases are under wrong names.",
            axes=axes,
        )
    return _(
        "The parameters of the {sensor} come out under wrong names: {axes}; the biases likewise.",
        sensor=sensor,
        axes=axes,
    )


def determinant(axes: Permutation) -> int:
    """+1 where a triad stays right-handed, −1 where it does not."""
    matrix = np.zeros((3, 3))
    matrix[range(3), axes.sources] = axes.signs
    return round(float(np.linalg.det(matrix)))


def _determinant_of_all(misread: Misread, recorded: Recorded) -> int:
    """That of a triad with all that is misread of it: plan and gravity may show an axis each."""
    own = [m for m in recorded.misread if (m.sensor, m.log) == (misread.sensor, misread.log)]
    return int(np.prod([determinant(each.axes) for each in own]))


def reads_in_words(axes: Permutation) -> str:
    """Which axis reads what: x reads −y and y reads x."""
    back = axes.inverse
    parts = [
        _(
            "{axes} reads {value}{axes_2}",
            axes=AXES[i],
            value="−" if back.signs[i] < 0 else "",
            axes_2=AXES[back.sources[i]],
        )
        for i in range(3)
        if back.changed[i]
    ]
    return " and ".join([", ".join(parts[:-1]), parts[-1]] if len(parts) > 1 else parts)


# Messages of NovAtel receivers send the axes so.
RAWIMUS: dict[tuple[int, ...], str] = {
    (0, 1, 2): _(" RAWIMUS has −y."),
    (2, 1, 0): _(" RAWIMUS has z, −y, x."),
}


def _handed(misread: Misread, recorded: Recorded) -> str:
    flips = misread.axes.in_place
    usual = (
        _("A sign that a reader forgets, or takes twice, is the usual cause.")
        if flips
        else _("Another order of the fields in the log is the usual cause.")
    )
    if misread.axes.signs == (1, -1, 1):
        usual += RAWIMUS.get(misread.axes.sources, "")
    if determinant(misread.axes) < 0:
        return _(
            "So the triad is left-handed (determinant −1), which no mounting does. {usual}",
            usual=usual,
        )
    others = [other for other in recorded.misread if other.log == misread.log]
    if len(others) == 2 and others[0].axes == others[1].axes:
        return _(
            "The triads of both sensors stay right-handed (determinant +1): the IMU may be "
            "mounted turned against the plan, or two mistakes cancel."
        )
    return _(
        "The triad stays right-handed (determinant +1), so two mistakes cancel; it is "
        "no mounting, for the other sensor does not agree. {usual}",
        usual=usual,
    )


def _in_the_matrix(axes: Permutation) -> str:
    back = axes.inverse
    parts = []
    for i in range(3):
        if back.changed[i]:
            sign, source = back.signs[i], back.sources[i]
            if source == i:
                parts.append(_("scale error of {axes} −200 %", axes=AXES[i]))
            else:
                unit_term = "1" if sign > 0 else "−1"
                parts.append(
                    _(
                        "scale error of {axes} −100 %, its cross term {axes_2} {unit_term}",
                        axes=AXES[i],
                        axes_2=AXES[source],
                        unit_term=unit_term,
                    )
                )
    return "; ".join(parts)


def _off(misread: Misread, recorded: Recorded) -> float:
    own = [i for i, log in enumerate(recorded.log) if log == misread.log]
    readings = (
        recorded.force[own] if misread.sensor == "accel" else np.degrees(recorded.turned[own])
    )
    there = readings[np.isfinite(readings).all(axis=1)]
    return max((float(np.abs(misread.axes.of(r) - r).max()) for r in there), default=np.nan)
