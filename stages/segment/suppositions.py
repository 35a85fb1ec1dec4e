"""What may have happened to a campaign as a whole: each supposition with what is then found."""

from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass, replace
from itertools import combinations, groupby
from typing import Any

import numpy as np

from inertial.arrays import Array
from inertial.campaign.records import Manoeuvre
from inertial.signal.axis_permutations import AS_NAMED, PERMUTATIONS, Permutation
from inertial.signal.misread_axes import determinant
from inertial.tables import AXES
from stages.segment.located import AS_PLANNED, Axes, Division, Located, earth_seen, locate
from stages.segment.matching import MAX_WHOLE_DIFFERENCE, MIN_SCALE_RATIO, points
from stages.segment.steps import (
    ALL_REVERSED,
    OWN_AXIS_SHARE,
    Exchanged,
    OtherSense,
    Step,
    axes_step,
    exchange_step,
    sense_step,
    senses_by_axis,
    turned_back,
)

MAX_EXCHANGED = 4  # manoeuvres of a log for which an exchange with every other one is tried

Plans = tuple[Sequence[Manoeuvre], ...]
Fitting = frozenset[tuple[str, int]]


@dataclass(frozen=True)
class Case:
    """A supposition: of each window its axes and its manoeuvres, and where they are then found.

    `step`: what it adds to another case.
    """

    windows: Sequence[Division]
    located: tuple[Located, ...]
    plans: Plans
    earth_rate: float
    everywhere: Axes = AS_PLANNED
    exchanged: tuple[Exchanged, ...] = ()
    other_sense: tuple[OtherSense, ...] = ()
    step: Step | None = None

    @property
    def axes(self) -> Permutation | None:
        """The axes that it supposes."""
        return self.step.axes if self.step else None

    @property
    def of_sense(self) -> bool:
        """Whether it adds to another case that turns are counted the other way."""
        return self.step is not None and self.step.turns is not None

    @property
    def balance(self) -> int:
        """Observations that agree with the plan, less those that do not."""
        counts = [located.agreeing for located in self.located]
        earth = earth_seen(self.located, self.everywhere, self.earth_rate)
        return sum(2 * right - total for right, total in counts) + sum(earth)

    @property
    def of_exchange(self) -> bool:
        """Whether it adds to another case that manoeuvres are exchanged."""
        return self.step is not None and self.step.exchanged is not None

    @property
    def of_planned_size(self) -> int:
        """Turns that have the size of their plan, in one sense or the other."""
        ratios = [located.ratio(m, m) for located in self.located for m in located.plan]
        return sum(abs(abs(ratio) - 1) <= MAX_WHOLE_DIFFERENCE for ratio in ratios)

    @property
    def found_whole(self) -> int:
        """Manoeuvres that are found, and of which no small part alone is."""
        return sum(
            located.place(m) is not None and not located.in_part(m)
            for located in self.located
            for m in located.plan
        )

    @property
    def lacking(self) -> list[int]:
        """The windows in which something does not agree with the plan."""
        counts = [located.agreeing for located in self.located]
        return [k for k, (right, total) in enumerate(counts) if right < total]

    @property
    def fitting(self) -> Fitting:
        """The observations that agree with the plan, by manoeuvre and number."""
        return frozenset(one for located in self.located for one in located.fitting)


def suppositions(case: Case, with_sense: bool, gyros_confirmed: bool) -> Iterator[Case]:
    """All that may have happened to the campaign, the likelier first."""
    yield from of_names_and_turns(case, with_sense, gyros_confirmed)
    for permutation in PERMUTATIONS:
        for change in ({"accel": permutation}, {"gyro": permutation}):
            # Accelerometers that all read their negative turn as they are named.
            if gyros_confirmed and change != {"accel": ALL_REVERSED}:
                continue
            if getattr(case.everywhere, next(iter(change))) == AS_NAMED:
                yield _by_axes(case, replace(case.everywhere, **change))
        # Gravity would show both triads to be left-handed, for the gyros' readings are axial.
        left_handed = determinant(permutation) < 0
        if case.everywhere.as_named and not (gyros_confirmed and left_handed):
            yield _by_axes(case, Axes(permutation, permutation))


def of_names_and_turns(case: Case, with_sense: bool, gyros_confirmed: bool) -> Iterator[Case]:
    """The same as far as the plan is concerned: the sense of turns, and what is exchanged."""
    if with_sense:
        for turns in _senses(case, by_axis=gyros_confirmed):
            yield _with_other_sense(case, turns)
        for turns in _upended(case):
            yield _with_other_sense(case, turns)
    yield from _exchanges(case)


def _exchanges(case: Case) -> Iterator[Case]:
    """Two positions, or windows, of as many manoeuvres, or what is in one window exchanged.

    None that is exchanged already.
    """
    taken = {name for exchanged in case.exchanged for name in exchanged.names}
    yield from _with_positions_exchanged(case, taken)
    whole = [k for k in case.lacking if taken.isdisjoint(m.name for m in case.plans[k])]
    for a, b in combinations(whole, 2):
        if len(case.plans[a]) == len(case.plans[b]):
            yield _with_names_exchanged(case, a, b)
    for k in case.lacking:
        free = [m for m in case.located[k].plan if m.name not in taken]
        lost = [m for m in free if case.located[k].place(m) is None]
        for m in lost[:MAX_EXCHANGED]:
            for other in free:
                if other.name != m.name and "positions" not in (m.do, other.do):
                    exchanged = _with_places_exchanged(case, k, [m.name], [other.name])
                    # A pause between two turns is no rest, and a change of position no turn.
                    if not any(map(exchanged.located[k].in_part, (m, other))):
                        yield exchanged
        not_found = {m.name for m in lost}
        for one, two in combinations(_visits(case.plans[k]), 2):
            both = {*one, *two}
            if len(one) == len(two) > 1 and both & not_found and not both & taken:
                yield _with_places_exchanged(case, k, one, two)


def exchanged_by_size(case: Case) -> Iterator[Case]:
    """Two turns exchanged, each of which has the size of the other's plan and not of its own."""
    taken = {name for exchanged in case.exchanged for name in exchanged.names}
    turns = [
        (k, m)
        for k, located in enumerate(case.located)
        for m in located.plan
        if m.do == "turn" and m.name not in taken and located.place(m) is not None
    ]
    for (a, one), (b, other) in combinations(turns, 2):
        crossed = [case.located[a].ratio(one, other), case.located[b].ratio(other, one)]
        own = [case.located[a].ratio(one, one), case.located[b].ratio(other, other)]
        if any(abs(ratio - 1) > MAX_WHOLE_DIFFERENCE for ratio in crossed):
            continue
        if any(1 / MIN_SCALE_RATIO < ratio < MIN_SCALE_RATIO for ratio in own):
            continue
        if a == b:
            yield _with_places_exchanged(case, a, [one.name], [other.name])
        elif len(case.plans[a]) == len(case.plans[b]):
            yield _with_names_exchanged(case, a, b)


def _visits(plan: Sequence[Manoeuvre]) -> list[list[str]]:
    """The names of the manoeuvres of each position, from one change of it to the next."""
    return [[m.name for m in visit] for _, visit in groupby(plan, key=lambda m: m.position)]


def _senses(case: Case, *, by_axis: bool) -> Iterator[OtherSense]:
    """The turns that the plan may count the other way: groups of those not counted so yet."""
    turns = [m for plan in case.plans for m in plan if m.do == "turn" and m.about is not None]
    taken = {name for each in case.other_sense for name in each.names}
    groups = senses_by_axis(turns) if by_axis else [OtherSense(tuple(m.name for m in turns))]
    yield from (group for group in groups if group.names and not taken & {*group.names})


def _upended(case: Case) -> Iterator[OtherSense]:
    """The turns about each axis before which gravity points the other way than planned.

    With those of the same direction up that are not found: one the other way may be where the plan
    has its opposite.
    """
    taken = {name for each in case.other_sense for name in each.names}
    turns, shown = list[tuple[Manoeuvre, Array]](), list[Array]()
    for located in case.located:
        for m in located.plan:
            if m.do != "turn" or m.up is None or m.name in taken:
                continue
            before = located.rest_before(m)
            if located.place(m) is None:
                turns.append((m, m.up))
            elif before is not None and points(located.observed[before].force, -m.up):
                turns.append((m, m.up))
                shown.append(m.up)
    upended = [m for m, up in turns if any(np.allclose(up, other) for other in shown)]
    for i, axis in enumerate(AXES):
        names = tuple(m.name for m in upended if abs(m.axis[i]) > OWN_AXIS_SHARE)
        if names:
            yield OtherSense(names, axis, upended=True)


def _with_other_sense(case: Case, turns: OtherSense) -> Case:
    plans = tuple(turned_back(plan, turns) for plan in case.plans)
    other_sense = (*case.other_sense, turns)
    return _supposing(case, sense_step(turns), plans, other_sense=other_sense)


def _with_names_exchanged(case: Case, a: int, b: int) -> Case:
    plans = list(case.plans)
    names = tuple(m.name for k in (a, b) for m in plans[k])
    plans[a], plans[b] = plans[b], plans[a]
    logs = tuple(dict.fromkeys(case.windows[k].log for k in (a, b)))
    return _exchanging(case, plans, Exchanged(names, logs))


def _with_positions_exchanged(case: Case, taken: Set[str]) -> Iterator[Case]:
    """All logs of two positions, as many of each: the IMU stood in the other one each time."""
    windows = dict[str, list[int]]()
    for k, plan in enumerate(case.plans):
        stood = {m.position for m in plan}
        if len(stood) == 1 and taken.isdisjoint(m.name for m in plan):
            windows.setdefault(stood.pop(), []).append(k)
    lacking = {*case.lacking}
    for one, two in combinations(windows.values(), 2):
        if len(one) == len(two) > 1 and lacking.issuperset([*one, *two]):
            plans = list(case.plans)
            for a, b in zip(one, two, strict=True):
                plans[a], plans[b] = plans[b], plans[a]
            both = [case.plans[k] for k in (*one, *two)]
            if all(
                len(a) == len(b) for a, b in zip(both[: len(one)], both[len(one) :], strict=True)
            ):
                names = tuple(m.name for plan in both for m in plan)
                logs = tuple(dict.fromkeys(case.windows[k].log for k in (*one, *two)))
                yield _exchanging(case, plans, Exchanged(names, logs))


def _with_places_exchanged(case: Case, k: int, one: Sequence[str], two: Sequence[str]) -> Case:
    """`one`, `two`: as many manoeuvres, each list in the order of the plan."""
    order = list(case.plans[k])
    place = {m.name: n for n, m in enumerate(order)}
    first, second = sorted([one, two], key=lambda names: place[names[0]])
    for a, b in zip(first, second, strict=True):
        order[place[a]], order[place[b]] = order[place[b]], order[place[a]]
    plans = [*case.plans[:k], order, *case.plans[k + 1 :]]
    return _exchanging(case, plans, Exchanged((*first, *second), (case.windows[k].log,)))


def _exchanging(case: Case, plans: Sequence[Sequence[Manoeuvre]], exchanged: Exchanged) -> Case:
    both = (*case.exchanged, exchanged)
    return _supposing(case, exchange_step(exchanged), tuple(plans), exchanged=both)


def _by_axes(case: Case, axes: Axes) -> Case:
    # What two names had explained, they explain by these axes as well, or not at all.
    plans: Plans = tuple(window.binned.window.manoeuvres for window in case.windows)
    for turns in case.other_sense:
        plans = tuple(turned_back(plan, turns) for plan in plans)
    sensor = "accel" if axes.accel != case.everywhere.accel else "gyro"
    step = axes_step(sensor, getattr(axes, sensor))
    return _supposing(case, step, plans, everywhere=axes, exchanged=())


def _supposing(case: Case, step: Step, plans: Plans, **supposed: Any) -> Case:
    """A case with a step more; the windows whose plan or axes are others by it are sought anew."""
    axes = supposed.get("everywhere", case.everywhere)
    located = tuple(
        here if plan is before and axes == case.everywhere else locate(window, axes, plan)
        for window, here, before, plan in zip(
            case.windows, case.located, case.plans, plans, strict=True
        )
    )
    return replace(case, located=located, plans=plans, step=step, **supposed)
