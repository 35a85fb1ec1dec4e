"""A manoeuvre that is not in its log."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.axis_permutations import AXES
from inertial.signal.detector import Array, Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _
from inertial.text.numbers import fixed

MIN_SAME_COSINE = float(np.cos(np.radians(25)))  # directions that are the same


class ManoeuvreMissing(PlanDetector):
    """A planned rest or turn of which the log has nothing, and nothing explains why."""

    name = "manoeuvre_missing"
    cause = _("it was not done, not recorded, or the plan has it in the wrong place")
    source = "S0: a log that was not written whole"
    costs = _("what it alone would determine")

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for i, name in enumerate(recorded.name):
            if not recorded.found[i] and name not in recorded.explained:
                yield self.of(recorded, i, None, sensor=None)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        assert i is not None  # it is a manoeuvre that is missing
        return Description(
            recorded.said[i] + _instead(recorded, i),
            _("It is left out; the others are used. {recorded}", recorded=_left(recorded, i)),
            _("Correct the plan, or record it."),
        )


def _instead(recorded: Recorded, i: int) -> str:
    """What the log has in its place."""
    if recorded.do[i] == "rest":
        force, up = recorded.force[i], recorded.up[i]
        if not (np.isfinite(force).all() and np.isfinite(up).all()):
            return ""
        direction = force / np.linalg.norm(force)
        away = np.degrees(np.arccos(np.clip(direction @ up, -1, 1)))
        sentence = _(
            " Its log rests {away:.0f}° from there, with {direction} up.",
            away=away,
            direction=_axis(direction),
        )
        if float(np.abs(direction).max()) > MIN_SAME_COSINE:
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
    """Which other manoeuvres observe the same direction."""
    rest = recorded.do[i] == "rest"
    directions = recorded.up if rest else recorded.about
    own = directions[i]
    if not np.isfinite(own).all():
        return ""
    along = np.nan_to_num(directions) @ own
    same = (along > MIN_SAME_COSINE) if rest else (np.abs(along) > MIN_SAME_COSINE)
    others = same & recorded.found & (np.arange(len(along)) != i)
    others &= np.isfinite(directions).all(axis=1)
    if others.any():
        names = [recorded.name[k] for k in np.flatnonzero(others)[:4]]
        return _(
            "The same {value} is seen in {names}.",
            value="direction" if rest else "axis",
            names=", ".join(names),
        )
    axis = _axis(own)
    if rest:
        return _(
            "No other rest has {axis} up, which parts its bias from its scale factor.", axis=axis
        )
    return _(
        "No other turn is about {strip}: its scale factor is not determined.",
        strip=axis.strip("+−"),
    )
