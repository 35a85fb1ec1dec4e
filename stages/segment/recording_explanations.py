"""Explanations of a recording that differs from its plan: axes, signs, names, sense of turns."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, groupby

import numpy as np

from inertial.arrays import Array
from inertial.campaign.records import Manoeuvre
from inertial.signal.axis_permutations import (
    AS_NAMED,
    PERMUTATIONS,
    Permutation,
    read_as_other_axes,
    simplicity,
)
from inertial.signal.rests_and_motions import MIN_HAND_RATE, MIN_MOTION_SIGMA
from stages.segment.located import AS_PLANNED, Axes, Division, Located, divide, locate
from stages.segment.matching import MAX_WHOLE_DIFFERENCE, MIN_SCALE_RATIO
from stages.segment.rest_readings import earth_seen, forces_at_rest, level_of
from stages.segment.steps import (
    ALL_REVERSED,
    Exchanged,
    OtherSense,
    Step,
    axes_step,
    exchange_step,
    sense_step,
    senses_by_axis,
)
from stages.segment.windows import Binned

MIN_RATE_SHARE = 0.05  # of the slowest planned rate: what counts as motion
MIN_GAIN = 2  # observations more that agree with the plan, in place of as many that do not
MAX_EXCHANGED = 4  # manoeuvres of a log for which an exchange with every other one is tried
MAX_RIVAL_AXES = 2  # axes of a permutation that is a rival of exchanged names
MIN_GAIN_OF_BOTH = 3  # the same, for both sensors of one log: it may have had another attitude


@dataclass(frozen=True)
class ExplainedRecording:
    """The windows, each with where its manoeuvres are.

    `everywhere`: axes that are exchanged or reversed in all logs; `misread`: logs whose
    axes differ from those of the others; `exchanged`: exchanged manoeuvres; `gyro_signs`: by the
    earth rate; `other_sense`: turns that the plan counts the other way. `rivals`: for the
    name of a repair those of others that explain as much. `fitting`: how many observations agree
    with the plan as it is, with all of these, and how many there are.
    """

    located: Sequence[Located]
    gyro_signs: Sequence[int]
    everywhere: Axes
    misread: Mapping[str, Axes]
    exchanged: Sequence[Exchanged]
    other_sense: Sequence[OtherSense]
    rivals: Mapping[str, Sequence[Step]]
    fitting: tuple[int, int, int]


Plans = tuple[Sequence[Manoeuvre], ...]
Fitting = frozenset[tuple[str, int]]


@dataclass(frozen=True)
class _Case:
    """A supposition: of each window its axes and its manoeuvres, and where they are then found.

    `step`: what it adds to another case; `axes`: those that it supposes.
    """

    located: tuple[Located, ...]
    plans: Plans
    earth_rate: float
    everywhere: Axes = AS_PLANNED
    exchanged: tuple[Exchanged, ...] = ()
    other_sense: tuple[OtherSense, ...] = ()
    step: Step | None = None
    axes: Permutation | None = None

    @property
    def balance(self) -> int:
        """Observations that agree with the plan, less those that do not."""
        counts = [located.agreeing for located in self.located]
        earth = earth_seen(self.located, self.everywhere, self.earth_rate)
        return sum(2 * right - total for right, total in counts) + sum(earth)

    @property
    def lacking(self) -> list[int]:
        """The windows in which something does not agree with the plan."""
        counts = [located.agreeing for located in self.located]
        return [k for k, (right, total) in enumerate(counts) if right < total]

    @property
    def fitting(self) -> Fitting:
        """The observations that agree with the plan, by manoeuvre and number."""
        return frozenset(one for located in self.located for one in located.fitting)


def explain(
    windows: Sequence[Division],
    earth_rate: float,
    accepted: Collection[str],
    *,
    with_sense: bool,
    gyros_confirmed: bool,
) -> ExplainedRecording:
    """Find every manoeuvre; where the plan is not found, by what explains clearly more of it.

    First what may have happened to the campaign as a whole: names or places of two manoeuvres
    exchanged, one signed permutation of the axes of a sensor, or of both, or turns that are
    counted the other way. Then turns that differ by their size alone, then log by log.

    Parameters
    ----------
    earth_rate : rad/s, its part upwards; 0 where it is not known
    accepted : repairs that the laboratory confirms: taken where others explain as much
    with_sense : whether turns may be counted the other way
    gyros_confirmed : whether gravity shows that the gyros' axes are those of the accelerometers: a
        turn against the plan is then none of a gyro with another sign, and may be so by its axis
    """
    plans = tuple(window.binned.window.manoeuvres for window in windows)
    plain = _Case(tuple(locate(window) for window in windows), plans, earth_rate)
    case, rivals = plain, dict[str, list[Step]]()
    while case.lacking:
        supposed = list(_suppositions(windows, case, with_sense, gyros_confirmed))
        best = max(supposed, key=lambda one: one.balance, default=case)
        gain = best.balance - case.balance
        # Two turns the other way, or in each other's place, of one log cost one of them at most:
        # the other one fits.
        whole = gain >= 2 and not best.lacking and _of_turns(best) != _of_turns(case)
        if gain < 2 * MIN_GAIN and not whole:
            break
        alike = [best, *(one for one in supposed if _rivals(case, best, one))]
        # The sense of the table says nothing of where a turn is: its rivals show what is found.
        confirmed = [one for one in alike if one.step and one.step.id in accepted]
        case = (confirmed or [one for one in alike if not _of_sense(one)] or alike)[0]
        assert case.step is not None
        if len(alike) > 1 and not confirmed:
            rivals[case.step.id] = [one.step for one in alike if one.step and one is not case]
    while (by_size := next(_exchanged_by_size(windows, case), None)) is not None:
        case = by_size
    misread = dict(_misread(windows, case))
    signs = earth_seen(case.located, case.everywhere, earth_rate)
    right = sum(located.agreeing[0] for located in plain.located)
    after, total = np.sum([(0, 0), *(located.agreeing for located in case.located)], axis=0)
    return ExplainedRecording(
        case.located,
        signs,
        case.everywhere,
        misread,
        case.exchanged,
        case.other_sense,
        rivals,
        (int(right), int(after), int(total)),
    )


def explained_of(
    binned: Sequence[Binned],
    plan: Sequence[Manoeuvre],
    earth_rate: float,
    accepted: Collection[str] = (),
    *,
    with_sense: bool = False,
    gyros_confirmed: bool = False,
) -> tuple[Array, ExplainedRecording]:
    """What the gyros read at rest, (3,), rad/s, and where the manoeuvres are; as `explain`."""
    level, scatter = level_of(binned)
    rates = [abs(m.rate) for m in plan if m.rate]
    noise = MIN_MOTION_SIGMA * scatter
    threshold = max(MIN_RATE_SHARE * min(rates) if rates else MIN_HAND_RATE, noise)
    ways = [divide(window, level, threshold, noise, swings=bool(rates)) for window in binned]
    explained = explain(
        ways, earth_rate, accepted, with_sense=with_sense, gyros_confirmed=gyros_confirmed
    )
    return level, explained


def _of_turns(case: _Case) -> tuple[object, object]:
    """What it supposes of names, places and the sense of turns."""
    return case.exchanged, case.other_sense


def _rivals(case: _Case, best: _Case, other: _Case) -> bool:
    """Whether another supposition explains the same observations as the best one, and as many."""
    if other.step == best.step or other.balance < best.balance:
        return False
    if not (best.fitting - case.fitting) & (other.fitting - case.fitting):
        return False  # they explain different things, and both may be
    if (_of_sense(best) or _of_sense(other)) and _turns_each_other(best, other):
        return False
    if other.axes is None or best.axes is None:
        few = other.axes is None or other.axes.moved <= MAX_RIVAL_AXES
        return few or _of_sense(best)
    return simplicity(other.axes) <= simplicity(best.axes)


def _of_sense(case: _Case) -> bool:
    """Whether it adds to another case that turns are counted the other way."""
    return case.step is not None and case.step.turns is not None


def _turns_each_other(best: _Case, other: _Case) -> bool:
    """Whether one exchanges a turn with its opposite: the angles are then as by the other sense.

    Each log holds the turn that the other's plan has, so the same readings go with the same angle.
    """
    exchanged = [*best.exchanged, *other.exchanged][-1:]
    plans = {m.name: m for plan in best.plans for m in plan}
    for each in exchanged:
        half = len(each.names) // 2
        for one, two in zip(each.names[:half], each.names[half:], strict=True):
            a, b = plans[one], plans[two]
            if a.about is None or b.about is None or not a.angle or not b.angle:
                return False
            turns = np.linalg.norm(a.angle * a.about + b.angle * b.about)
            ups = a.up is None or b.up is None or np.allclose(a.up, b.up)
            if turns > 1e-6 * abs(a.angle) or not ups or a.mount != b.mount:
                return False
    return bool(exchanged)


def _suppositions(
    windows: Sequence[Division], case: _Case, with_sense: bool, gyros_confirmed: bool
) -> Iterator[_Case]:
    """All that may have happened to the campaign, the likelier first."""
    taken = {name for exchanged in case.exchanged for name in exchanged.names}
    lacking = [k for k in case.lacking if not taken & {m.name for m in case.plans[k]}]
    if with_sense:
        for turns in _senses(case, by_axis=gyros_confirmed):
            yield _with_other_sense(windows, case, turns)
    yield from _exchanges(windows, case, lacking)
    for permutation in PERMUTATIONS:
        for change in ({"accel": permutation}, {"gyro": permutation}):
            # Accelerometers that all read their negative turn as they are named.
            if gyros_confirmed and change != {"accel": ALL_REVERSED}:
                continue
            if getattr(case.everywhere, next(iter(change))) == AS_NAMED:
                yield _by_axes(windows, case, replace(case.everywhere, **change), permutation)
        if case.everywhere.as_named:
            yield _by_axes(windows, case, Axes(permutation, permutation), permutation)


def _exchanges(windows: Sequence[Division], case: _Case, lacking: Sequence[int]) -> Iterator[_Case]:
    """Two windows of as many manoeuvres exchanged, or two manoeuvres or positions of one window."""
    for a, b in combinations(lacking, 2):
        if len(case.plans[a]) == len(case.plans[b]):
            yield _with_names_exchanged(windows, case, a, b)
    for k in lacking:
        lost = [m for m in case.located[k].plan if case.located[k].place(m) is None]
        for m in lost[:MAX_EXCHANGED]:
            for other in case.located[k].plan:
                if other.name != m.name and "positions" not in (m.do, other.do):
                    yield _with_places_exchanged(windows, case, k, [m.name], [other.name])
        for one, two in combinations(_visits(case.plans[k]), 2):
            if len(one) == len(two) > 1 and not {m.name for m in lost}.isdisjoint([*one, *two]):
                yield _with_places_exchanged(windows, case, k, one, two)


def _exchanged_by_size(windows: Sequence[Division], case: _Case) -> Iterator[_Case]:
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
            yield _with_places_exchanged(windows, case, a, [one.name], [other.name])
        elif len(case.plans[a]) == len(case.plans[b]):
            yield _with_names_exchanged(windows, case, a, b)


def _visits(plan: Sequence[Manoeuvre]) -> list[list[str]]:
    """The names of the manoeuvres of each position, from one change of it to the next."""
    return [[m.name for m in visit] for _, visit in groupby(plan, key=lambda m: m.position)]


def _senses(case: _Case, *, by_axis: bool) -> Iterator[OtherSense]:
    """The turns that the plan may count the other way: groups of those not counted so yet."""
    turns = [m for plan in case.plans for m in plan if m.do == "turn" and m.about is not None]
    taken = {name for each in case.other_sense for name in each.names}
    groups = senses_by_axis(turns) if by_axis else [OtherSense(tuple(m.name for m in turns))]
    yield from (group for group in groups if group.names and not taken & {*group.names})


def _with_other_sense(windows: Sequence[Division], case: _Case, turns: OtherSense) -> _Case:
    plans = tuple(
        [turned_back(m) if m.name in turns.names else m for m in plan] for plan in case.plans
    )
    located = tuple(
        locate(window, case.everywhere, plan) for window, plan in zip(windows, plans, strict=True)
    )
    return replace(
        case,
        located=located,
        plans=plans,
        other_sense=(*case.other_sense, turns),
        step=sense_step(turns),
        axes=None,
    )


def turned_back(m: Manoeuvre) -> Manoeuvre:
    """A manoeuvre with its turn the other way."""
    angle = None if m.angle is None else -m.angle
    return replace(m, angle=angle, rate=None if m.rate is None else -m.rate)


def _with_names_exchanged(windows: Sequence[Division], case: _Case, a: int, b: int) -> _Case:
    located, plans = list(case.located), list(case.plans)
    names = tuple(m.name for k in (a, b) for m in plans[k])
    plans[a], plans[b] = plans[b], plans[a]
    for k in (a, b):
        located[k] = locate(windows[k], case.everywhere, plans[k])
    logs = tuple(dict.fromkeys(windows[k].binned.window.log for k in (a, b)))
    return _exchanging(case, located, plans, Exchanged(names, logs))


def _with_places_exchanged(
    windows: Sequence[Division], case: _Case, k: int, one: Sequence[str], two: Sequence[str]
) -> _Case:
    """`one`, `two`: as many manoeuvres, each list in the order of the plan."""
    order = list(case.plans[k])
    place = {m.name: n for n, m in enumerate(order)}
    first, second = sorted([one, two], key=lambda names: place[names[0]])
    for a, b in zip(first, second, strict=True):
        order[place[a]], order[place[b]] = order[place[b]], order[place[a]]
    names = (*first, *second)
    located, plans = list(case.located), list(case.plans)
    plans[k] = order
    located[k] = locate(windows[k], case.everywhere, order)
    return _exchanging(case, located, plans, Exchanged(names, (windows[k].binned.window.log,)))


def _exchanging(
    case: _Case,
    located: Sequence[Located],
    plans: Sequence[Sequence[Manoeuvre]],
    exchanged: Exchanged,
) -> _Case:
    return replace(
        case,
        located=tuple(located),
        plans=tuple(plans),
        exchanged=(*case.exchanged, exchanged),
        step=exchange_step(exchanged),
        axes=None,
    )


def _by_axes(
    windows: Sequence[Division], case: _Case, axes: Axes, permutation: Permutation
) -> _Case:
    # What two names had explained, they explain by these axes as well, or not at all.
    plans = tuple(window.binned.window.manoeuvres for window in windows)
    back = {name for turns in case.other_sense for name in turns.names}
    plans = tuple([turned_back(m) if m.name in back else m for m in plan] for plan in plans)
    located = tuple(locate(window, axes, plan) for window, plan in zip(windows, plans, strict=True))
    sensor = "accel" if axes.accel != case.everywhere.accel else "gyro"
    return replace(
        case,
        located=located,
        plans=plans,
        everywhere=axes,
        exchanged=(),
        step=axes_step(sensor, permutation),
        axes=permutation,
    )


def _misread(windows: Sequence[Division], case: _Case) -> Iterator[tuple[str, Axes]]:
    """Logs with other axes than the rest of the campaign."""
    taken = {log for exchanged in case.exchanged for log in exchanged.logs}
    logs = dict.fromkeys(windows[k].binned.window.log for k in case.lacking)
    if len({window.binned.window.log for window in windows}) < 2:
        return
    for log in logs:
        if log in taken:
            continue
        own = [k for k, window in enumerate(windows) if window.binned.window.log == log]
        axes = _axes_of(windows, case, own)
        if axes is not None:
            yield log, axes


def _axes_of(windows: Sequence[Division], case: _Case, own: list[int]) -> Axes | None:
    """The axes by which all of a log agrees with the plan, if the data decide for them."""
    now, said = np.sum([case.located[k].agreeing for k in own], axis=0)
    for sensors in (("accel",), ("gyro",), ("accel", "gyro")):
        for permutation in PERMUTATIONS:
            axes = replace(case.everywhere, **dict.fromkeys(sensors, permutation))
            located = [locate(windows[k], axes, case.plans[k]) for k in own]
            right, all_of_it = np.sum([each.agreeing for each in located], axis=0)
            if right < all_of_it or right <= now:
                continue
            if right - now >= (MIN_GAIN if len(sensors) == 1 else MIN_GAIN_OF_BOTH):
                return axes
            if len(sensors) == 1 and _confirmed_by_other_sensor(case, axes, int(said)):
                return axes
            break  # if the simplest is not significant, the others are not
    return _axes_by_force(case, own, int(now), int(said))


def _confirmed_by_other_sensor(case: _Case, axes: Axes, said: int) -> bool:
    """Whether the other sensor confirms that the IMU moved as planned, and only axes differ.

    A turn against the plan may be just that; so one turn cannot show the sign of a gyro alone.
    """
    if said < 2:
        return False
    return axes.gyro == case.everywhere.gyro or not axes.gyro.in_place


def _axes_by_force(case: _Case, own: list[int], now: int, said: int) -> Axes | None:
    """The axes of the accelerometers in a log with one rest, from the readings of the others.

    Gravity along another axis may be an IMU in another attitude. But every accelerometer
    has a bias and a scale factor of its own, by which the other rests identify it.
    """
    if (now, said) != (0, 1) or case.everywhere != AS_PLANNED:
        return None
    (k,) = own
    rests = [place for place, what in enumerate(case.located[k].observed) if not what.moves]
    m = case.located[k].plan[0]
    if m.do != "rest" or m.up is None or not rests:
        return None
    longest = max(rests, key=lambda place: case.located[k].observed[place].seconds)
    force = case.located[k].observed[longest].force
    others = [pair for other in case.located for pair in forces_at_rest(other)]
    if not others or not np.isfinite(force).all():
        return None
    forces, ups = (np.array(column) for column in zip(*others, strict=True))
    permutation = read_as_other_axes(force, m.up, forces, ups)
    return None if permutation is None else replace(case.everywhere, accel=permutation)


def unlike(axes: Axes, others: Axes) -> Iterator[tuple[str, Permutation]]:
    """The sensors whose axes are others than those: accel, gyro."""
    for sensor, own, other in (
        ("accel", axes.accel, others.accel),
        ("gyro", axes.gyro, others.gyro),
    ):
        if own != other:
            yield sensor, own
