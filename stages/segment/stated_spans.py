"""Marks of a plan that its own turns contradict, and spans that it states by another clock.

A turn about the vertical takes the mark, which stands still in the room, to another direction in
the body: turned by −θ about the axis, if θ is its angle. The manoeuvre after it begins where it
ends, so its mark follows, unless the table moved between the two; that the gyros show.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array
from inertial.campaign.records import Manoeuvre
from inertial.physics.motion import horizontal, north_of, turned
from inertial.physics.site import EARTH_RATE
from inertial.signal.plan_detector import MarksOff, SpansOff
from stages.segment.located import AS_PLANNED, Located
from stages.segment.recording_explanations import explained_of
from stages.segment.steps import OWN_AXIS_SHARE
from stages.segment.windows import Binned, Window

MIN_OFF = np.radians(5)  # by less a mark may be noted roughly
MAX_MOVED = np.radians(3)  # about the vertical in a rest: more is a motion of its own
MAX_TURN_DIFFERENCE = 0.02  # of the planned angle, by which a turn may be another one
MIN_GAIN = 25.0  # of chi-squared, by which the earth's rate at rest decides between two marks


@dataclass(frozen=True, eq=False)
class _Link:
    """A manoeuvre of a course: its mark turned back to the start of that, (3,).

    turns : since the start, each an axis and an angle, rad
    """

    m: Manoeuvre
    mark: Array
    turns: Sequence[tuple[Array, float]]


@dataclass(frozen=True)
class _Course:
    """Manoeuvres one after another between which nothing moved; rests: of all of them.

    Of each rest the mean rate and its sigma, (3,), rad/s, and the turns since the start.
    """

    links: Sequence[_Link]
    rests: Sequence[tuple[Array, Array, Sequence[tuple[Array, float]]]]

    @property
    def marks(self) -> list[tuple[Array, list[_Link]]]:
        """The marks that are stated, each with who states it: the most first, then the earliest."""
        groups: list[tuple[Array, list[_Link]]] = []
        for link in self.links:
            alike = [own for mark, own in groups if mark @ link.mark > np.cos(MIN_OFF)]
            if alike:
                alike[0].append(link)
            else:
                groups.append((link.mark, [link]))
        return sorted(groups, key=lambda group: -len(group[1]))

    def misfit(self, mark: Array, heading: float, level: float) -> float:
        """Chi-squared of what the gyros read at rest, with a bias of their own; rad, rad/s."""
        up = self.links[0].m.up
        assert up is not None
        north = north_of(up, mark, heading)
        left = np.array([rate - level * _forward(north, by) for rate, _sigma, by in self.rests])
        weights = 1 / np.array([sigma for _rate, sigma, _by in self.rests]) ** 2
        known = np.isfinite(left) & np.isfinite(weights)
        left, weights = np.where(known, left, 0.0), np.where(known, weights, 0.0)
        total = weights.sum(axis=0)
        bias = np.divide((weights * left).sum(axis=0), total, where=total > 0, out=np.zeros(3))
        return float((weights * (left - bias) ** 2).sum())


def marks_off(
    located: Sequence[Located],
    plan: Sequence[Manoeuvre],
    heading: float | None,
    earth_rate: float,
) -> tuple[MarksOff | None, Mapping[str, Array]]:
    """The marks that turns contradict, and by manoeuvre those that follow, (3,); none: None.

    Where the heading is known, the earth's rate at the rests decides which of the marks are right;
    else the most of each course do. `MarksOff.undecided` where neither does.

    Parameters
    ----------
    heading : rad, azimuth of the zero mark; earth_rate : rad/s, its part upwards
    """
    stated = {m.name: m for m in plan}
    courses = [course for one in located for course in _courses(one, stated)]
    courses = [course for course in courses if len(course.marks) > 1]
    if not courses:
        return None, {}
    gain = 0.0  # of chi-squared, by the marks of the most
    if heading is not None and earth_rate:
        level = float(np.sqrt(EARTH_RATE**2 - earth_rate**2))
        for course in courses:
            first, second = (course.misfit(mark, heading, level) for mark, _ in course.marks[:2])
            gain += second - first
    majority = all(len(c.marks[0][1]) > len(c.marks[1][1]) for c in courses)
    decided = abs(gain) > MIN_GAIN
    best = 1 if decided and gain < 0 else 0
    follow: dict[str, Array] = {}
    pairs: list[tuple[str, str]] = []
    for course in courses:
        mark, right = course.marks[best]
        for k, link in enumerate(course.links):
            if link not in right:
                follow[link.m.name] = _forward(mark, link.turns)
                beside = [n for n, one in enumerate(course.links) if one in right]
                near = min(beside, key=lambda n: (abs(n - k), n))
                pairs.append((course.links[near].m.name, link.m.name))
    off = max(_between(m.mark, follow[m.name]) for m in plan if m.name in follow)
    undecided = not (decided or majority)
    return MarksOff(list(follow), pairs[0], off, decided, undecided), follow


def with_marks(plan: Sequence[Manoeuvre], marks: Mapping[str, Array]) -> list[Manoeuvre]:
    """The plan with the marks, by manoeuvre, that its turns leave."""
    return [replace(m, mark=marks[m.name]) if m.name in marks else m for m in plan]


def _between(mark: Array | None, other: Array) -> float:
    assert mark is not None
    return float(np.arccos(np.clip(mark @ other, -1.0, 1.0)))


def _forward(direction: Array, turns: Sequence[tuple[Array, float]]) -> Array:
    """A direction of the room in body axes after some turns."""
    for about, angle in turns:
        direction = turned(direction, about, angle)
    return direction


def _courses(located: Located, stated: Mapping[str, Manoeuvre]) -> Iterator[_Course]:
    """The courses of a window, where all in it is by the axes as they are named."""
    if located.axes != AS_PLANNED:
        return
    found = [
        (place, stated[m.name]) for m in located.plan if (place := located.place(m)) is not None
    ]
    course: list[tuple[int, Manoeuvre]] = []
    for one in sorted(found, key=lambda each: each[0]):
        if course and not _joined(located, course[-1], one):
            yield _course(located, course)
            course = []
        course = [*course, one] if _is_marked(one[1]) else []
    if course:
        yield _course(located, course)


def _is_marked(m: Manoeuvre) -> bool:
    """Whether up and mark are known of a rest, or of a turn by an angle about the vertical."""
    if m.up is None or m.mark is None or m.do not in ("rest", "turn"):
        return False
    whole = m.recorded == "whole" and bool(m.angle)
    return m.do == "rest" or (whole and abs(float(m.axis @ m.up)) > OWN_AXIS_SHARE)


def _joined(located: Located, one: tuple[int, Manoeuvre], other: tuple[int, Manoeuvre]) -> bool:
    """Whether nothing moved from the end of a manoeuvre to the beginning of another."""
    (place, m), (after, behind) = one, other
    still = range(place + (m.do == "turn"), after + (behind.do == "rest"))
    if len(still) != 1 or not _is_marked(behind) or m.mount != behind.mount:
        return False
    seen = located.observed[still[0]]
    up, next_up = m.up, behind.up
    assert up is not None and next_up is not None  # both are marked
    moved = float(np.nan_to_num(seen.turned) @ up)
    as_planned = m.do == "rest" or abs(located.ratio(m, m) - 1) < MAX_TURN_DIFFERENCE
    same_up = up @ next_up > np.cos(MIN_OFF)
    quiet = not seen.moves and abs(moved) < MAX_MOVED
    return bool(quiet and as_planned and same_up)


def _course(located: Located, course: Sequence[tuple[int, Manoeuvre]]) -> _Course:
    links, turns = list[_Link](), list[tuple[Array, float]]()
    rests: dict[int, Sequence[tuple[Array, float]]] = {}
    for place, m in course:
        mark = _level(m)
        for about, angle in reversed(turns):
            mark = turned(mark, about, -angle)
        links.append(_Link(m, mark, list(turns)))
        if m.do == "rest":
            rests[place] = list(turns)
            continue
        rests[place - 1] = list(turns)
        turns.append((m.axis, m.angle or 0.0))
        rests[place + 1] = list(turns)
    seen = [
        (located.observed[place], by)
        for place, by in sorted(rests.items())
        if 0 <= place < len(located.observed) and not located.observed[place].moves
    ]
    return _Course(links, [(one.rate, one.unsure, by) for one, by in seen])


def _level(m: Manoeuvre) -> Array:
    """The horizontal direction of a mark, (3,), unit vector."""
    assert m.up is not None and m.mark is not None
    return horizontal(m.mark, m.up)


# ---- Spans that the plan states by another clock than that of the log: all off by one time.

MAX_PLACED_SHARE = 0.5  # of the turns, or rests, of a log: with more of them its spans hold

MIN_OFF_S = 1.0  # s; by less a span is noted by hand


@dataclass(frozen=True)
class _Interval:
    """Times by which a span may be moved, s, so that it holds its manoeuvre."""

    least: float
    most: float

    def within(self, other: "_Interval") -> "_Interval":
        """The times that both have."""
        return _Interval(max(self.least, other.least), min(self.most, other.most))

    @property
    def empty(self) -> bool:
        """Whether there is no such time."""
        return self.least > self.most


EVERYWHERE = _Interval(-np.inf, np.inf)


def logs_in_doubt(
    binned: Sequence[Binned], plan: Sequence[Manoeuvre], earth_rate: float
) -> list[str]:
    """The logs in whose stated spans hardly a turn, or hardly a rest, is as a whole.

    Parameters
    ----------
    binned : of all windows
    earth_rate : rad/s, its part upwards; 0 where it is not known
    """
    stated = {m.name: m for m in plan if m.from_s is not None and m.recorded != "steady"}
    if not stated:
        return []
    placed: dict[tuple[str, str], list[bool]] = {}
    for located in explained_of(binned, plan, earth_rate)[1].located:
        for m in located.plan:
            if m.name in stated and m.do in ("rest", "turn"):
                placed.setdefault((m.log, m.do), []).append(_whole(located, m))
    lost = (
        log
        for (log, _do), whole in placed.items()
        if len(whole) > 1 and sum(whole) <= MAX_PLACED_SHARE * len(whole)
    )
    return list(dict.fromkeys(lost))


def _whole(located: Located, m: Manoeuvre) -> bool:
    """Whether a manoeuvre is found in its window, which begins and ends at rest."""
    ends = located.stretches[:1], located.stretches[-1:]
    return located.place(m) is not None and not any(end.moves for (end,) in ends)


def whole_logs(
    plan: Sequence[Manoeuvre], ends: Mapping[str, int], logs: Collection[str]
) -> list[Window]:
    """A window for each of these logs, with the manoeuvres of stated spans in their order."""
    stated = sorted((m for m in plan if m.from_s is not None), key=lambda m: m.from_s or 0.0)
    return [
        Window(log, 0, ends[log], [m for m in stated if m.log == log])
        for log in sorted(logs)
        if ends.get(log)
    ]


def spans_off(binned: Sequence[Binned], earth_rate: float) -> Iterator[SpansOff]:
    """Logs that hold all manoeuvres in their order, by one time before or after their spans.

    Parameters
    ----------
    binned : whole logs, see `whole_logs`
    """
    for one in binned:
        manoeuvres = one.window.manoeuvres
        (located,) = explained_of([one], manoeuvres, earth_rate)[1].located
        if any(located.place(m) is None for m in manoeuvres):
            continue
        moved = EVERYWHERE
        for interval in (_around(located, m) for m in manoeuvres if m.do == "turn"):
            moved = moved.within(interval)
        for interval in (_inside(located, m) for m in manoeuvres if m.do == "rest"):
            nearer = moved.within(interval)
            moved = moved if nearer.empty else nearer
        if moved.empty or not np.isfinite([moved.least, moved.most]).all():
            continue
        if max(moved.least, -moved.most) > MIN_OFF_S:
            late = -(moved.least + moved.most) / 2
            names = [m.name for m in manoeuvres]
            yield SpansOff(one.window.log, late, (moved.most - moved.least) / 2, names)


def _around(located: Located, m: Manoeuvre) -> _Interval:
    """By what the span of a turn may be moved and hold all of its motion."""
    begin, end = _times(located, m)
    assert m.from_s is not None and m.to_s is not None  # a span is stated
    return _Interval(end - m.to_s, begin - m.from_s)


def _inside(located: Located, m: Manoeuvre) -> _Interval:
    """By what the span of a rest may be moved and lie within it."""
    begin, end = _times(located, m)
    assert m.from_s is not None and m.to_s is not None  # a span is stated
    return _Interval(begin - m.from_s, end - m.to_s)


def _times(located: Located, m: Manoeuvre) -> tuple[float, float]:
    place = located.place(m)
    assert place is not None  # it is found
    stretch, binned = located.stretches[place], located.binned
    return float(binned.first_s[stretch.first]), float(binned.last_s[stretch.after - 1])


def moved_back(plan: Sequence[Manoeuvre], off: Collection[SpansOff]) -> list[Manoeuvre]:
    """The plan with its spans by the clocks of the logs."""
    late = {each.log: each.late for each in off}
    return [
        replace(m, from_s=m.from_s - late[m.log], to_s=m.to_s - late[m.log])
        if m.from_s is not None and m.to_s is not None and m.log in late
        else m
        for m in plan
    ]
