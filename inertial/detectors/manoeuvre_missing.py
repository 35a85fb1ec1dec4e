"""Manoeuvres of a plan of which a log has nothing, or has two rests as one."""

from collections.abc import Iterator

import numpy as np

from inertial.arrays import Array
from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _, plural
from inertial.text.numbers import fixed
from inertial.text.parameters import AXES

SAME_REST_COSINE = float(np.cos(np.radians(1)))  # of two rests with no move between
MIN_SAME_COSINE = float(np.cos(np.radians(25)))  # directions that are the same


class ManoeuvreMissing(PlanDetector):
    """A planned rest or turn of which the log has nothing, and nothing explains why.

    Cause: it was not done, not recorded, or the plan has it in the wrong place. Nothing determines
    what it alone would determine. Where nothing need move between two rests they are one, and
    nothing is lost; where a tumble goes back that is as planned.
    """

    name = "manoeuvre_missing"
    source = "S0: a log that was not written whole"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for i, name in enumerate(recorded.name):
            if not recorded.found[i] and name not in recorded.explained:
                if _one_rest_with(recorded, i) is None:
                    yield self.of(recorded, i, None, sensor=None)
                elif not _turning_point(recorded, i):
                    yield self.of(recorded, i, None, sensor=None, severity=1)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        assert i is not None  # it is a manoeuvre that is missing
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
    k = int(np.argmax(np.abs(direction)))
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
