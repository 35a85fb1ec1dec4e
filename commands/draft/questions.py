"""What a draft has to ask: what no log says, and where logs contradict themselves."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence

from commands.draft.manoeuvres import Manoeuvre
from commands.draft.sensors import Kind
from commands.draft.timing import Timing
from commands.draft.triads import Triad
from inertial.text.messages import _, plural

NEGATIVE = ("neg", "negative", "minus", "down", "-")
SIGN = r"(?P<sign>positive|negative|plus|minus|pos|neg|up|down|[+-])"
UP_IN_NAME = (
    re.compile(rf"(?<![a-z0-9]){SIGN}[ _-]?(?P<axis>[xyz])(?![a-z])", re.IGNORECASE),
    re.compile(rf"(?<![a-z])(?P<axis>[xyz])[ _-]?{SIGN}(?![a-z0-9])", re.IGNORECASE),
)  # what the name of a log says points up
MIN_MEANS = 15  # whose residuals show their noise: twelve parameters, and three for the scatter
GRAVITY, GRAVITY_SIGMA = 9.80665, 0.03  # m/s², anywhere on earth


def questions(kinds: Sequence[Kind], plan: Sequence[Manoeuvre], by_hand: bool) -> Iterator[str]:
    """A sentence for each."""
    yield _("instrument, serial, date: which IMU is it, and when was it recorded?")
    yield (
        _("table: no turn has the steady rate of a table, so it was moved by hand; is that so?")
        if by_hand
        else _("table: which one, and how well are its positions, angles and rates known?")
    )
    yield _(
        "site: at which latitude and height, or with which gravity? Until then scale factors of "
        "accelerometers are known to {percent:.1f} % only.",
        percent=100 * GRAVITY_SIGMA / GRAVITY,
    )
    for kind in kinds:
        yield from _of_kind(kind)
    yield from _named_otherwise(plan)
    if any(m.do == "turn" for m in plan):
        yield _("degrees: were the turns as large as the round angles in the plan?")
    if any(m.up for m in plan):
        yield _(
            "up: is the axis named in the plan the one that pointed up? A log that reads −g there "
            "has the other sign."
        )


def _named_otherwise(plan: Sequence[Manoeuvre]) -> Iterator[str]:
    """Each log of one static position whose name says another axis than the one it reads."""
    logs = Counter(m.part.logs[0].path.name for m in plan)
    named = {
        name: (said, m.up)
        for m in plan
        for name in [m.part.logs[0].path.name]
        if m.do == "rest" and m.up and logs[name] == 1
        if (said := _up_in_name(m.part.logs[0].path.stem)) is not None
    }
    if len(named) > 2 and all(said[0] != up[0] and said[1] == up[1] for said, up in named.values()):
        yield _(
            "each log reads −g on the axis that its name says is up; do the accelerometers read "
            "gravity, `{key}`, or is it the axis that pointed down?",
            key="accelerometer: {reads: gravity}",
        )
        return
    for name, (said, up) in named.items():
        if said != up:
            yield _(
                "{log}: its name says {named} up, and it reads {read}; was the IMU stood otherwise "
                "than planned, or the log misnamed?",
                log=name,
                named=said,
                read=up,
            )


def _up_in_name(stem: str) -> str | None:
    """The signed axis that the name of a log says: posX, x_up, -z; None where it says none."""
    for pattern in UP_IN_NAME:
        if found := pattern.search(stem):
            sign = "-" if found["sign"].lower() in NEGATIVE else "+"
            return sign + found["axis"].lower()
    return None


def _of_kind(kind: Kind) -> Iterator[str]:
    """What logs of one kind leave open."""
    means = sum(len(part.series.accel) for part in kind.parts)
    if kind.means and means < MIN_MEANS and kind.columns.mean_of is None:
        yield _(
            "sigma: {log} has {means} means, and fewer than {needed} do not show their noise; what "
            "is the standard deviation of a mean? Without `sigma: …` beside its columns the "
            "accelerometers get no result",
            log=names_of_logs(kind),
            means=means,
            needed=MIN_MEANS,
        )
    for accel, gyro in kind.columns.other_imus:
        yield _(
            "columns: {log} holds other accelerometers and gyros, {columns}; the draft takes "
            "{taken}. Which are those of the IMU to be calibrated?",
            log=names_of_logs(kind),
            columns=_columns(accel, gyro),
            taken=_columns(kind.columns.accel, kind.columns.gyro),
        )
    if kind.columns.constant:
        yield plural(
            "{columns} of {log} reads the same in all rows; is this axis dead, or was it not "
            "recorded?",
            "{columns} of {log} read the same in all rows; are these axes dead, or were they not "
            "recorded?",
            len(kind.columns.constant),
            columns=", ".join(map(str, kind.columns.constant)),
            log=names_of_logs(kind),
        )
    if without_clock(kind.timing):
        yield _(
            "rate_hz: {log} has no clock; how many samples a second are there? Count sizes of "
            "gyros go with the rate: draft it again with RATE=, or --rate",
            log=names_of_logs(kind),
        )
    if kind.timing.doubt:
        yield _(
            "time: {column} of {log}: {doubt}",
            column=kind.timing.column,
            log=names_of_logs(kind),
            doubt=kind.timing.doubt,
        )
    if kind.gyro is not None and kind.gyro.axes.moved:
        yield _(
            "gyro.axes: in {log} the gyros turn gravity's direction as if {axes}; which sensor "
            "is wired otherwise than the axes are named?",
            log=names_of_logs(kind),
            axes=kind.gyro.axes.in_words,
        )
    for word, scale in ((_("accelerometers"), kind.accel), (_("gyros"), kind.gyro)):
        if scale is not None and scale.doubt:
            yield _(
                "{sensor} of {log}: {doubt}",
                sensor=word,
                log=names_of_logs(kind),
                doubt=scale.doubt,
            )


def _columns(*triads: Triad | None) -> str:
    return ", ".join(str(name) for triad in triads if triad for name in triad.columns)


def without_clock(timing: Timing) -> bool:
    """Whether samples are counted at a rate that nothing states."""
    return timing.guessed and timing.unit in (None, "sample")


def names_of_logs(kind: Kind) -> str:
    """The names of its files, of many the first."""
    names = list(dict.fromkeys(log.path.name for part in kind.parts for log in part.logs))
    return ", ".join(names[:4]) + (_(" and {more} more", more=len(names) - 4) if names[4:] else "")
