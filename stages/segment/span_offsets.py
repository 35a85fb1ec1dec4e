"""Spans that the plan states by another clock than that of the log: all off by one time."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.campaign.records import Manoeuvre
from inertial.signal.plan_detector import SpansOff
from stages.segment.located import Located
from stages.segment.recording_explanations import explained_of
from stages.segment.windows import Binned, Window

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
    return [
        Window(log, 0, ends[log], sorted(_stated(plan, log), key=lambda m: m.from_s or 0.0))
        for log in sorted(logs)
        if ends.get(log)
    ]


def _stated(plan: Sequence[Manoeuvre], log: str) -> list[Manoeuvre]:
    return [m for m in plan if m.log == log and m.from_s is not None]


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
