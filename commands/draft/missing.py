"""What a plan lacks for a calibration of accelerometers and gyros, and what would show it."""

from collections.abc import Iterator, Sequence

from commands.draft.manoeuvres import Manoeuvre
from inertial.text.messages import _, plural

AXES = "xyz"
MIN_ATTITUDES = 9  # of unknown attitude, for the nine parameters of accelerometers
FACES = [sign + axis for axis in AXES for sign in "+-"]


def missing(plan: Sequence[Manoeuvre]) -> Iterator[str]:
    """A sentence for each thing that no log shows."""
    positions = [m for m in plan if m.do == "positions"]
    with_gyros = [m for m in plan if len(m.part.series.gyro)]
    if not any(len(m.part.series.accel) for m in plan):
        yield _("accelerometers: none are recorded")
    elif positions:
        count = sum(m.count for m in positions)
        if count < MIN_ATTITUDES:
            yield plural(
                "static positions: {count} is there, of which at least {needed} are needed, as "
                "different as possible",
                "static positions: {count} are there, of which at least {needed} are needed, as "
                "different as possible",
                count,
                needed=MIN_ATTITUDES,
            )
    else:
        there = {m.up for m in plan if m.do == "rest" and len(m.part.series.accel)}
        there |= {m.up for m in plan if m.do == "turn" and m.up and len(m.part.series.accel)}
        if lacking := [face for face in FACES if face not in there]:
            yield _("static positions with {faces} up", faces=", ".join(lacking))
    if not with_gyros:
        yield _("gyros: none are recorded")
    elif not positions:
        turned = {m.about[1] for m in with_gyros if m.do == "turn" and m.about}
        if lacking := [axis for axis in AXES if axis not in turned]:
            yield _("a turn about {axes}", axes=", ".join(lacking))
