"""The comments at the top of a campaign file: questions, what the logs are, what is missing."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import product

import numpy as np

from commands.draft.columns import Columns
from commands.draft.groups import MIN_SHARED_TIME
from commands.draft.manoeuvres import Manoeuvre
from commands.draft.raw_log import RawLog
from commands.draft.sensors import Kind
from commands.draft.series import Divided
from commands.draft.timing import Timing, first_date, tick_in_words
from commands.draft.triads import Triad, directions_named
from commands.new import comment
from inertial.arrays import Array
from inertial.campaign.unknown_attitude import in_words
from inertial.estimation.multi_position import (
    SCATTER_RANGE,
    FreeRest,
    free_positions,
    off_lengths,
    unobservable,
)
from inertial.estimation.scatter_and_random_walk import with_scatter
from inertial.signal.axis_permutations import Permutation
from inertial.text.messages import _, first_of, plural
from inertial.text.numbers import significant, whole
from inertial.text.parameters import AXES

MAX_LEFT_OUT = 0.25  # of a log, that is in no manoeuvre without a word
MAX_INCOMPLETE = 0.01  # of the rows, that are left out without a word
MIN_ATTITUDES = 9  # of unknown attitude, for the nine parameters of accelerometers
ALL_REVERSED = Permutation((0, 1, 2), (-1, -1, -1))
FACES = [sign + axis for axis in AXES for sign in "+-"]


def header(
    kinds: Sequence[Kind], plan: Sequence[Manoeuvre], name: str, by_hand: bool
) -> Iterator[str]:
    """Questions, what the logs are, and what is missing, line by line."""
    yield from comment(
        _(
            "{name}, drafted from its logs. What is marked `guessed:` is a guess with a sigma that "
            "fits one; whoever knows better writes it here. Then: make check CAMPAIGN={name}, "
            "make report CAMPAIGN={name}",
            name=name,
        )
    )
    yield "#"
    yield from comment(_("Questions that only a person can answer:"))
    for number, question in enumerate(questions(kinds, plan, by_hand), 1):
        yield from comment(question, f"#   {number}. ")
    yield "#"
    yield from comment(_("What the logs are:"))
    for kind in kinds:
        for text in _evidence(kind):
            yield from comment(text, "#   - ")
    for text in _left_out(kinds, plan):
        yield from comment(text, "#   - ")
    yield "#"
    lacking = list(_missing(kinds, plan))
    yield from comment(
        _("What is missing for a calibration of both sensors:")
        if lacking
        else _nothing_missing(plan)
    )
    for text in lacking:
        yield from comment(text, "#   - ")


def _nothing_missing(plan: Sequence[Manoeuvre]) -> str:
    """No more than is known before an estimation: of gyros by hand the motions decide."""
    count = sum(m.count for m in plan if m.do == "positions")
    if not count:
        return _("Nothing is missing for a calibration of both sensors.")
    return plural(
        "The attitude of {count} position determines all parameters of the accelerometers. Whether "
        "the motions between positions determine those of the gyros, the check tells.",
        "The attitudes of {count} positions determine all parameters of the accelerometers. "
        "Whether the motions between them determine those of the gyros, the check tells.",
        count,
    )


def _evidence(kind: Kind) -> Iterator[str]:
    """What logs of one kind are taken for, and what says so."""
    columns, timing = kind.columns, kind.timing
    rows = sum(together[0].rows for together in kind.recordings)
    if kind.means:
        yield _(
            "{logs}: {rows} rows; {why}",
            logs=names_of_logs(kind),
            rows=whole(rows),
            why=timing.evidence,
        )
    else:
        seconds = sum(part.series.seconds for part in kind.parts)
        yield _(
            "{logs}: {rows} rows, {seconds:.0f} s at {rate} Hz{assumed}; {why}",
            logs=names_of_logs(kind),
            rows=whole(rows),
            seconds=seconds,
            rate=significant(timing.rate),
            assumed=_(", a rate that is assumed") if without_clock(timing) else "",
            why=timing.evidence,
        )
    if kind.incomplete > MAX_INCOMPLETE * rows:
        yield _(
            "{logs}: {count} of its rows lack a reading and are left out; the rate is that of the "
            "others",
            logs=names_of_logs(kind),
            count=whole(kind.incomplete),
        )
    which = []
    for word, triad in ((_("accelerometers"), columns.accel), (_("gyros"), columns.gyro)):
        if triad is not None:
            which.append(f"{word} {', '.join(map(str, triad.columns))}")
    yield _("{which}: {why}", which="; ".join(which), why=columns.evidence)
    yield from _directions(columns)
    for word, scale in ((_("accelerometers"), kind.accel), (_("gyros"), kind.gyro)):
        if scale is not None:
            yield f"{word}: {scale.evidence}"
    for log in {log.path: log for part in kind.parts for log in part.logs if log.left_out}.values():
        yield _(
            "{log}: its last {count} rows hold no samples, for nothing changes in them; they are "
            "not used",
            log=log.path.name,
            count=whole(log.left_out),
        )
    yield from _not_used(kind)


def _directions(columns: Columns) -> Iterator[str]:
    """Which way the axes of sensors point whose names say directions in place of x, y, z."""
    for triad in filter(None, (columns.accel, columns.gyro)):
        names = _columns(triad)
        if directions := directions_named(triad.columns):
            yield (
                _(
                    "{columns}: taken for x forward, y right and z down by their names",
                    columns=names,
                )
                if "down" in directions
                else _(
                    "{columns}: taken for x forward, y left and z up by their names", columns=names
                )
            )


def _not_used(kind: Kind) -> Iterator[str]:
    """The columns that are not read, with the reason, and those that are not needed."""
    if unread := [name for log in kind.recordings[0] for name in log.unread]:
        yield _(
            "without a number in one row of ten or more, and not read: {columns}; a sensor that is "
            "recorded more rarely than the other has a log of its own, which may be the same file: "
            "`{key}`",
            columns=", ".join(map(str, unread)),
            key="gyro: {log: …, format: …}",
        )
    if texts := [name for log in kind.recordings[0] for name in log.texts]:
        yield _("text, and not read: {columns}", columns=", ".join(map(str, texts)))
    if kind.columns.unused:
        yield _("not used: {columns}", columns=", ".join(map(str, kind.columns.unused)))


def _left_out(kinds: Sequence[Kind], plan: Sequence[Manoeuvre]) -> Iterator[str]:
    """Long stretches of a log that are in no manoeuvre, such as a journey after a calibration."""
    for part in (part for kind in kinds for part in kind.parts):
        taken = sorted(m.rows or part.rows for m in plan if m.part is part)
        edges = [part.rows[0], *(edge for rows in taken for edge in rows), part.rows[1]]
        stretches = zip(edges[::2], edges[1::2], strict=True)
        first, after = max(stretches, key=lambda rows: rows[1] - rows[0])
        share = (after - first) / (part.rows[1] - part.rows[0])
        if taken and share > MAX_LEFT_OUT:
            yield _(
                "{log}: its rows from {first} to {after}, {share:.0f} % of it, are in no manoeuvre "
                "of the plan",
                log=part.logs[0].path.name,
                first=whole(first),
                after=whole(after),
                share=100 * share,
            )


def _missing(kinds: Sequence[Kind], plan: Sequence[Manoeuvre]) -> Iterator[str]:
    """A sentence for each thing that no log shows."""
    used = {id(m.part.logs) for m in plan}
    for part in (part for kind in kinds for part in kind.parts):
        if id(part.logs) not in used:
            yield _(
                "{log} is not in the plan: in its {seconds:.1f} s nothing rests for a second or "
                "turns about one axis",
                log=part.logs[0].path.name,
                seconds=part.series.seconds,
            )
    positions = [m for m in plan if m.do == "positions"]
    with_gyros = [m for m in plan if len(m.part.series.gyro)]
    if not any(kind.columns.accel for kind in kinds):
        yield _("accelerometers: none are recorded")
    elif positions:
        yield from _missing_positions(kinds, plan)
    else:
        there = {m.up for m in plan if len(m.part.series.accel)}
        if lacking := [face for face in FACES if face not in there]:
            yield _("static positions with {faces} up", faces=", ".join(lacking))
    if not with_gyros:
        yield (
            _("gyros: none are among the columns that are read")
            if any(
                [*log.unread, *log.texts]
                for kind in kinds
                for logs in kind.recordings
                for log in logs
            )
            else _("gyros: none are recorded")
        )
    elif not positions:
        turned = {m.about[1] for m in with_gyros if m.do == "turn" and m.about}
        if lacking := [axis for axis in AXES if axis not in turned]:
            yield _("a turn about {axes}", axes=", ".join(lacking))


def _missing_positions(kinds: Sequence[Kind], plan: Sequence[Manoeuvre]) -> Iterator[str]:
    """What positions of unknown attitude do not determine of the accelerometers."""
    count = sum(m.count for m in plan if m.do == "positions")
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
        for reason in not_determined(kinds, plan):
            yield _("static positions: {reason}", reason=reason)


# ---- Whether static positions of unknown attitude determine every parameter of the accelerometers.

MIN_SIGMA = 1e-3  # m/s², of a mean: what its samples, or a row of means, do not show
MIN_BINS = 3  # short means of a rest, to show its noise


def not_determined(kinds: Sequence[Kind], plan: Sequence[Manoeuvre]) -> list[str]:
    """What the positions of the plan leave open, each with the rest that would determine it.

    By the fit of the pipeline, |f| = g with a scatter between the positions, on the means that the
    draft has; noise is that of the short means of each rest.
    """
    parts = {id(m.part) for m in plan if m.do == "positions"}
    every = [
        each
        for kind in kinds
        for part, own in zip(kind.parts, kind.divided, strict=True)
        if id(part) in parts
        for each in _rests(own)
    ]
    means, sigma = (np.array(values) for values in zip(*every, strict=True))
    off = {each.number for each in off_lengths(means, sigma, GRAVITY)}
    rests = [FreeRest("", *each) for i, each in enumerate(every) if i not in off]
    fit = partial(free_positions, rests, GRAVITY, GRAVITY_SIGMA)
    found = with_scatter(fit, between=SCATTER_RANGE, noise_degrees=np.inf).estimate
    return list(dict.fromkeys(map(in_words, unobservable(found))))


def _rests(own: Divided) -> Iterator[tuple[Array, Array]]:
    """The mean of each rest, m/s², and its sigma, (3,) each."""
    for rest in own.rests:
        first, after = own.inside(rest)
        noise = np.zeros(3)
        if after - first >= MIN_BINS:
            noise = own.forces[first:after].std(axis=0, ddof=1) / np.sqrt(after - first)
        yield rest.accel, np.maximum(noise, MIN_SIGMA)


# ---- What a draft has to ask: what no log says, and where logs contradict themselves.

NEGATIVE = ("neg", "negative", "minus", "down", "-")
SIGN = r"(?P<sign>positive|negative|plus|minus|pos|neg|up|down|[+-])"
UP_IN_NAME = (
    re.compile(rf"(?<![a-z0-9]){SIGN}[ _-]?(?P<axis>[xyz])(?![a-z])", re.IGNORECASE),
    re.compile(rf"(?<![a-z])(?P<axis>[xyz])[ _-]?{SIGN}(?![a-z0-9])", re.IGNORECASE),
)  # what the name of a log says points up
READS_GRAVITY = "accelerometer: {reads: gravity}"  # the key of a campaign
MIN_MEANS = 15  # whose residuals show their noise: twelve parameters, and three for the scatter
GRAVITY, GRAVITY_SIGMA = 9.80665, 0.03  # m/s², anywhere on earth


def questions(kinds: Sequence[Kind], plan: Sequence[Manoeuvre], by_hand: bool) -> Iterator[str]:
    """A sentence for each."""
    if (found := recorded_on(kinds)) is None:
        yield _("instrument, serial, date: which IMU is it, and when was it recorded?")
    else:
        yield _(
            "instrument, serial: which IMU is it? The date, {day}, is that of the first stamp of "
            "{log}; was the clock of the recorder right?",
            day=found[0],
            log=found[1].path.name,
        )
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
    yield from _of_clocks_apart(kinds)
    yield from _named_otherwise(plan)
    if any(m.do == "turn" for m in plan):
        yield _("degrees: were the turns as large as the round angles in the plan?")
    if any(m.up for m in plan):
        yield _(
            "up: is the axis named in the plan the one that pointed up? Where it pointed down, the "
            "log tells gravity: then state `{key}`, and change the sign of `up` and of the degrees "
            "of turns.",
            key=READS_GRAVITY,
        )


def _of_clocks_apart(kinds: Sequence[Kind]) -> Iterator[str]:
    """Whether two logs of a sensor each, as long as each other, are one recording by two clocks."""
    alone = [kind for kind in kinds if len(kind.recordings) == 1 and kind.timing.column is not None]
    accels = [kind for kind in alone if kind.columns.gyro is None]
    gyros = [kind for kind in alone if kind.columns.accel is None]
    for one, other in product(accels, gyros):
        seconds = sorted(kind.parts[0].series.seconds for kind in (one, other))
        if seconds[0] > MIN_SHARED_TIME * seconds[1]:
            yield _(
                "log: {first} and {second} last as long as each other, and their clocks have no "
                "time in common. Are they one recording? Then correct the stamps of one by what "
                "the clocks differ, and draft both again",
                first=names_of_logs(one),
                second=names_of_logs(other),
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
            key=READS_GRAVITY,
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
    yield from _of_clock(kind)
    if kind.gyro is not None and kind.gyro.axes == ALL_REVERSED:
        yield _(
            "gyro.axes: in {log} all three gyros turn gravity's direction backwards. Are the axes "
            "left-handed, such as `{axes}` of the instrument, or is clockwise positive? The first "
            "replaces gyro.axes; then `up` of the reversed axis in the plan has the other sign, "
            "and so have the degrees of all turns.",
            log=names_of_logs(kind),
            axes="axes: [x, -y, z]",
        )
    elif kind.gyro is not None and kind.gyro.axes.moved:
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


def _of_clock(kind: Kind) -> Iterator[str]:
    """What its clock leaves open."""
    if without_clock(kind.timing):
        yield _(
            "rate_hz: {log} has no clock; how many samples a second are there? Count sizes of "
            "gyros go with the rate: draft it again with RATE=, or --rate, which replaces this "
            "file while nobody has edited it",
            log=names_of_logs(kind),
        )
    if kind.timing.doubt:
        yield _(
            "time: {column} of {log}: {doubt}",
            column=kind.timing.column,
            log=names_of_logs(kind),
            doubt=kind.timing.doubt,
        )
    elif kind.timing.guessed and not without_clock(kind.timing) and _in_guessed_counts(kind):
        yield _(
            "time: {column} of {log} is taken for {unit}, which makes {rate} samples a second; is "
            "that so? Count sizes of gyros go with it",
            column=kind.timing.column,
            log=names_of_logs(kind),
            unit=tick_in_words(kind.timing.clock_ticks),
            rate=significant(kind.timing.rate),
        )


def _in_guessed_counts(kind: Kind) -> bool:
    """Whether nothing but the clock shows the count size of the gyros."""
    return kind.gyro is not None and kind.gyro.guessed and kind.gyro.counts is not None


def _columns(*triads: Triad | None) -> str:
    return ", ".join(str(name) for triad in triads if triad for name in triad.columns)


def without_clock(timing: Timing) -> bool:
    """Whether samples are counted at a rate that nothing states."""
    return timing.guessed and timing.unit in (None, "sample")


def recorded_on(kinds: Sequence[Kind]) -> tuple[str, RawLog] | None:
    """The date of the first stamp of all logs, and its log; None where no stamps are dates."""
    return first_date([log for kind in kinds for logs in kind.recordings for log in logs])


def names_of_logs(kind: Kind) -> str:
    """The names of its files, of many the first."""
    names = list(dict.fromkeys(log.path.name for part in kind.parts for log in part.logs))
    return first_of(names, 4)
