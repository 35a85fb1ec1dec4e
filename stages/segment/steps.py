"""What a supposition about a recording would set right, each kind, and how it is said."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace

from inertial.arrays import nearest_axis
from inertial.campaign.records import Manoeuvre, Row
from inertial.physics.motion import turned
from inertial.sensors import PLURAL
from inertial.signal.axis_permutations import Permutation
from inertial.signal.misread_axes import reads_in_words
from inertial.signal.plan_detector import MarksOff, Misread, SpansOff, Swapped
from inertial.tables import AXES
from inertial.text.messages import _, listed, plural
from inertial.text.numbers import fixed
from inertial.text.typography import capital

BY_GRAVITY = "by-gravity"  # the end of a repair's id that gravity shows, whatever the plan says
ALL_REVERSED = Permutation((0, 1, 2), (-1, -1, -1))
OWN_AXIS_SHARE = 0.9  # share of a body axis in the axis of a turn that is counted as about it
NEGATIVE = "negative"  # turns about the negative body axes, counted about the positive ones


@dataclass(frozen=True)
class Exchanged:
    """Manoeuvres that are found in each other's place, and their logs."""

    names: tuple[str, ...]
    logs: tuple[str, ...]

    @property
    def id(self) -> str:
        """The name of the repair that exchanges them back."""
        half = len(self.names) // 2
        return "/".join(["exchanged_manoeuvres", *sorted([self.names[0], self.names[half]])])


@dataclass(frozen=True)
class OtherSense:
    """Turns that the plan counts the other way: all, about one axis, or about NEGATIVE axes.

    `upended`: they are as planned, but the IMU stood the other way up in them.
    """

    names: tuple[str, ...]
    about: str = ""
    upended: bool = False


@dataclass(frozen=True)
class Step:
    """What a supposition would set right: the id of its repair, its kind, and what it concerns.

    `axes`: of the sensor; `exchanged`: manoeuvres; `turns`: those that are counted the other way.
    """

    id: str
    repair: str
    sensor: str | None = None
    axes: Permutation | None = None
    exchanged: Exchanged | None = None
    turns: OtherSense | None = None


def axes_step(sensor: str, axes: Permutation, log: str = "") -> Step:
    """That the axes of a sensor are others, in a log or in all."""
    kind = "signs" if axes.in_place else "axes"
    return Step("/".join([kind, sensor, *([log] if log else [])]), kind, sensor, axes)


def count_size_step(sensor: str, log: str = "") -> Step:
    """That the counts of a sensor are of another size, in a log or in all."""
    kind = "count_size"
    return Step("/".join([kind, sensor, *([log] if log else [])]), kind, sensor)


def sense_step(turns: OtherSense) -> Step:
    """That the plan counts turns the other way, or has them the other way up."""
    kind = "other_way_up" if turns.upended else "sense_of_table"
    return Step("/".join([kind, *([turns.about] if turns.about else [])]), kind, turns=turns)


def exchange_step(exchanged: Exchanged) -> Step:
    """That manoeuvres are in each other's place."""
    return Step(exchanged.id, "exchanged_manoeuvres", exchanged=exchanged)


def spans_step(log: str) -> Step:
    """That the spans of a log are stated by another clock."""
    return Step(f"stated_spans/{log}", "stated_spans")


def senses_by_axis(turns: Sequence[Manoeuvre]) -> Iterator[OtherSense]:
    """The turns about each body axis, about the negative ones, and all: each group once."""
    groups: dict[str, list[str]] = {axis: [] for axis in (*AXES, NEGATIVE, "")}
    for m in turns:
        assert m.about is not None  # of a turn it is known
        groups[""].append(m.name)
        i = nearest_axis(m.about)
        if abs(m.about[i]) > OWN_AXIS_SHARE:
            groups[AXES[i]].append(m.name)
            if m.about[i] < 0:
                groups[NEGATIVE].append(m.name)
    last = {tuple(names): about for about, names in groups.items()}
    yield from (OtherSense(names, about) for names, about in last.items())


# ---- In words.


def where(log: str) -> str:
    """In a log, or in all."""
    return _("in {log}", log=log) if log else _("in all logs")


def axes_in_words(misread: Misread) -> str:
    """That a sensor reads other axes than those it is named by."""
    whole = misread.change is None and misread.part is None
    words = _(
        "of the {sensor}, {where}, {axes}",
        sensor=PLURAL[misread.sensor],
        where=where(misread.log) if whole else _("in a part of the logs"),
        axes=reads_in_words(misread.axes),
    )
    if misread.change is not None:
        words += (
            _(", from {manoeuvre} on", manoeuvre=misread.change.after)
            if misread.change.later
            else _(", up to {manoeuvre}", manoeuvre=misread.change.before)
        )
    if misread.part is not None:
        words += _(": {logs}", logs=listed(misread.part.logs))
    if misread.sensor == "accel" and misread.axes == ALL_REVERSED:
        words += _(", or the log tells gravity in place of specific force, which is the same")
    return words


def exchange_in_words(swapped: Swapped) -> str:
    """That manoeuvres are in each other's place."""
    half = len(swapped.names) // 2
    first, second = ", ".join(swapped.names[:half]), ", ".join(swapped.names[half:])
    if len(swapped.logs) > 2:
        return _(
            "the {count} logs from {first} to {first_last} and the {count} from {second} to "
            "{second_last} are in each other's place, one by one",
            count=len(swapped.logs) // 2,
            first=swapped.logs[0],
            first_last=swapped.logs[len(swapped.logs) // 2 - 1],
            second=swapped.logs[len(swapped.logs) // 2],
            second_last=swapped.logs[-1],
        )
    if len(swapped.logs) == 2:
        return _(
            "{one} contains {second}, and {other} contains {first}",
            one=swapped.logs[0],
            second=second,
            other=swapped.logs[1],
            first=first,
        )
    return _(
        "in {log}, {first} and {second} are in each other's place",
        log=swapped.logs[0],
        first=first,
        second=second,
    )


def spans_in_words(off: SpansOff) -> str:
    """That the spans of a log are late, or early, by one time."""
    words = (
        _("the spans stated in {log} are {time} s late by its clock")
        if off.late > 0
        else _("the spans stated in {log} are {time} s early by its clock")
    )
    return words.format(log=off.log, time=fixed(abs(off.late), 1))


def marks_in_words(off: MarksOff) -> str:
    """That marks are where the turns before have brought them."""
    return plural(
        "in {names} the mark is not where the plan states it, but where the turns leave it",
        "in {names} the marks are not where the plan states them, but where the turns leave them",
        len(off.names),
        names=", ".join(off.names),
    )


def sense_in_words(turns: OtherSense, own: Sequence[Manoeuvre]) -> str:
    """That the plan, or the table, counts its `own` turns the other way."""
    if turns.upended:
        names = ", ".join(turns.names)
        return _("in {names} the IMU stood the other way up than planned", names=names)
    if turns.about == NEGATIVE:
        return _("the plan counts the turns about the negative axes as if about the positive ones")
    if turns.about:
        words = _("the plan counts the turns about {axis} the other way", axis=turns.about)
        if len(own) == 2 and (own[0].angle or 0.0) + (own[1].angle or 0.0) == 0.0:
            words += _(", or they were done in the other order, which gives the same result")
        return words
    return _("the table counts all its turns the other way")


# ---- Repairs as rows of their tables.

APPLIED = ("applied", "confirmed")


def row_of(
    step: Step,
    state: str,
    condition: str,
    fitting: tuple[int, int, int] | None = None,
    log: str = "",
) -> Row:
    """A repair and what was done; `fitting`: observations that fit before, after, and all."""
    before, after, total = fitting or (None, None, None)
    if state == "rival" and after is not None and before is not None and after < before:
        done = _("It is not applied, for with it less of the recording agrees with the plan.")
    elif state == "rival":
        done = _("It is not applied, for others explain as much.")
    elif state == "refused":
        done = _("It is not applied, for the settings refuse repairs.")
    else:
        done = _("It is set right before the estimation.")
    return {
        "id": step.id,
        "repair": step.repair,
        "state": state,
        "sensor": step.sensor,
        "log": log or None,
        "unit": "1",
        "finding": step.id,
        "fitting_before": before,
        "fitting_after": after,
        "observations": total,
        "condition": condition,
        "sentence": f"{capital(condition)}. {done}",
    }


def channel_row(
    repair: str, log: str, sensor: str, axis: str, from_axis: str, factor: float
) -> Row:
    return {
        "repair": repair,
        "log": log,
        "sensor": sensor,
        "axis": axis,
        "from_axis": from_axis,
        "factor": factor,
    }


# ---- The plan as a repair makes it: manoeuvres in each other's place, turned back, at other rates.

PLACE = ("log", "from_s", "to_s", "from_row", "to_row", "label")  # a log, and a selection of it


def place_of(m: Manoeuvre) -> tuple[object, ...]:
    """Where the plan has it: its log, and what it selects of that."""
    return tuple(getattr(m, key) for key in PLACE)


def exchanged_back(plan: Sequence[Manoeuvre], exchanged: Exchanged) -> list[Manoeuvre]:
    """The plan with manoeuvres in each other's log or stretch, or in each other's turn."""
    half = len(exchanged.names) // 2
    number = {m.name: i for i, m in enumerate(plan)}
    made = list(plan)
    for one, two in zip(exchanged.names[:half], exchanged.names[half:], strict=True):
        i, k = number[one], number[two]
        if place_of(plan[i]) == place_of(plan[k]):
            made[i], made[k] = plan[k], plan[i]
        else:
            made[i], made[k] = _placed(plan[i], plan[k]), _placed(plan[k], plan[i])
    return made


def _placed(m: Manoeuvre, like: Manoeuvre) -> Manoeuvre:
    return replace(m, **{key: getattr(like, key) for key in PLACE})


def turned_back(plan: Sequence[Manoeuvre], turns: OtherSense) -> list[Manoeuvre]:
    """The plan with some of its turns the other way, or the other way up.

    Where the table counts all of them the other way, it counts the steps of tumbles so, too.
    """
    other = _other_way_up if turns.upended else _turned_back
    whole = not (turns.about or turns.upended)
    return [other(m) if m.name in turns.names else _tumbled_back(m) if whole else m for m in plan]


def _other_way_up(m: Manoeuvre) -> Manoeuvre:
    return replace(m, **{key: -getattr(m, key) for key in ("up", "about")})


def _turned_back(m: Manoeuvre) -> Manoeuvre:
    angle, rate = (None if value is None else -value for value in (m.angle, m.rate))
    on = -m.turned_on if m.mark is None else m.turned_on
    return replace(m, angle=angle, rate=rate, turned_on=on)


def _tumbled_back(m: Manoeuvre) -> Manoeuvre:
    """A rest of a tumble after as many steps the other way; any other manoeuvre as it is."""
    if m.tumbled is None or m.tumble_axis is None:
        return m
    axis, back = m.tumble_axis, -2 * float(m.tumbled @ m.tumble_axis)
    up, mark = (None if v is None else turned(v, axis, back) for v in (m.up, m.mark))
    return replace(m, up=up, mark=mark, tumbled=-m.tumbled)


def at_other_rate(
    plan: Sequence[Manoeuvre], ratio: float, names: Collection[str]
) -> list[Manoeuvre]:
    """The plan with some of its turns at the rate at which they were recorded."""
    return [replace(m, rate=m.rate * ratio) if m.rate and m.name in names else m for m in plan]
