"""Manoeuvres, or logs, that are in each other's place."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description
from inertial.signal.plan_detector import (
    Deviation,
    PlanDetector,
    Recorded,
    Swapped,
    confirming,
    rivals_in_words,
)
from inertial.text.messages import _


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
        if len(swapped.logs) == 2:
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
                "In {logs}, {first} and {second} are exchanged.",
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
                "Each is taken for what it holds, on this condition. Correct the names, or the "
                "plan; or confirm it by accept: [{repair}].",
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
    axis = "xyz"[int(np.argmax(np.abs(unit[0])))]
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
        gravity = 2 * recorded.given.gravity
        return _(
            "Used, each mean would be wrong by up to {gravity:.3g} m/s², twice gravity.",
            gravity=gravity,
        )
    angles = np.degrees(np.abs(recorded.angle[own]))
    if np.isfinite(angles).all():
        wrong = f"{2 * angles.max():.0f}°"
        return _(
            "Used, each angle would be wrong by up to {wrong}, a scale error of −200 %.",
            wrong=wrong,
        )
    return _("Used, each would be evaluated as the other.")
