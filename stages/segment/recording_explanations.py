"""Explanations of a recording that differs from its plan: axes, signs, names, sense of turns."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

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
from inertial.signal.misread_axes import determinant
from inertial.signal.plan_detector import Misread, Swapped
from inertial.signal.rests_and_motions import MIN_HAND_RATE, MIN_MOTION_SIGMA, toggling
from stages.segment.located import (
    AS_PLANNED,
    Axes,
    Division,
    Located,
    divide,
    earth_seen,
    forces_at_rest,
    level_of,
    locate,
)
from stages.segment.steps import Exchanged, OtherSense, Step, axes_step, exchange_step
from stages.segment.suppositions import (
    Case,
    exchanged_by_size,
    of_names_and_turns,
    suppositions,
)
from stages.segment.windows import Binned

MIN_RATE_SHARE = 0.05  # of the slowest planned rate: what counts as motion
MIN_GAIN_OF_ALL = 2  # of the balance, by each of those that explain all of the plan together
MAX_RIVAL_AXES = 2  # axes of a permutation that is a rival of exchanged names


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
    plain = Case(windows, tuple(map(locate, windows)), plans, earth_rate)
    case, rivals = plain, dict[str, list[Step]]()
    while case.lacking:
        supposed = list(suppositions(case, with_sense, gyros_confirmed))
        best = max(supposed, key=lambda one: one.balance, default=case)
        if best.of_exchange:  # turns of one axis and sense differ by their sizes
            exchanges = [one for one in supposed if one.of_exchange]
            best = max(exchanges, key=_worth)
        gain = best.balance - case.balance
        # Two turns the other way, or in each other's place, of one log cost one of them at most:
        # the other one fits.
        of_turns = gain >= MIN_GAIN_OF_ALL and _of_turns(best) != _of_turns(case)
        enough = gain >= 2 * MIN_GAIN
        if not (enough or (of_turns and _leads_to_whole(best, with_sense, gyros_confirmed))):
            break
        alike = [best, *(one for one in supposed if _rivals(case, best, one))]
        # The sense of the table says nothing of where a turn is: its rivals show what is found.
        confirmed = [one for one in alike if one.step and one.step.id in accepted]
        case = (confirmed or [one for one in alike if not one.of_sense] or alike)[0]
        assert case.step is not None
        if len(alike) > 1 and not confirmed:
            rivals[case.step.id] = [one.step for one in alike if one.step and one is not case]
    while (by_size := next(exchanged_by_size(case), None)) is not None:
        case = by_size
    misread = dict(misread_logs(case))
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
    planned = MIN_RATE_SHARE * min(rates) if rates else MIN_HAND_RATE
    ways = []
    for window in binned:
        by_counts = float(np.linalg.norm(toggling(window.quantum[3:])))
        noise = max(MIN_MOTION_SIGMA * scatter, min(by_counts, planned))
        ways.append(divide(window, level, max(planned, noise), noise, swings=bool(rates)))
    explained = explain(
        ways, earth_rate, accepted, with_sense=with_sense, gyros_confirmed=gyros_confirmed
    )
    return level, explained


def _leads_to_whole(case: Case, with_sense: bool, gyros_confirmed: bool) -> bool:
    """Whether nothing is lacking, after more of the same kind where that explains more each."""
    while case.lacking:
        supposed = of_names_and_turns(case, with_sense, gyros_confirmed)
        best = max(supposed, key=lambda one: one.balance, default=case)
        if best.balance - case.balance < MIN_GAIN_OF_ALL:
            return False
        case = best
    return True


def _of_turns(case: Case) -> tuple[object, object]:
    """What it supposes of names, places and the sense of turns."""
    return case.exchanged, case.other_sense


def _worth(case: Case) -> tuple[int, int, int]:
    """What an exchange explains, the more the better; what it loses no other agreement makes up.

    A rest that is not found in its place leaves that to be the rest before a turn, which agrees.
    """
    return case.balance, case.found_whole, case.of_planned_size


def _rivals(case: Case, best: Case, other: Case) -> bool:
    """Whether another supposition explains the same observations as the best one, and as many."""
    if other.step == best.step or other.balance < best.balance:
        return False
    if not (best.fitting - case.fitting) & (other.fitting - case.fitting):
        return False  # they explain different things, and both may be
    if best.of_exchange and other.of_exchange and _worth(other) < _worth(best):
        return False
    if (best.of_sense or other.of_sense) and _turns_each_other(best, other):
        return False
    if other.axes is None or best.axes is None:
        few = other.axes is None or other.axes.moved <= MAX_RIVAL_AXES
        return few or best.of_sense
    return simplicity(other.axes) <= simplicity(best.axes)


def _turns_each_other(best: Case, other: Case) -> bool:
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


# ---- What was explained, as the detectors of the plan take it.


def in_order(exchanged: Exchanged, plan: Sequence[Manoeuvre]) -> Swapped:
    """Exchanged manoeuvres, that first which the plan has earlier."""
    names = [m.name for m in plan]
    half, repair = len(exchanged.names) // 2, exchange_step(exchanged).id
    if names.index(exchanged.names[0]) <= names.index(exchanged.names[half]):
        return Swapped(exchanged.names, exchanged.logs, repair)
    later_first = exchanged.names[half:] + exchanged.names[:half]
    logs = len(exchanged.logs) // 2
    return Swapped(later_first, exchanged.logs[logs:] + exchanged.logs[:logs], repair)


def misread_in(plan: Sequence[Manoeuvre], explained: ExplainedRecording) -> list[Misread]:
    """The sensors whose axes are others than those of the plan, and the logs where they are."""
    found = []
    for sensor, axes in unlike(explained.everywhere, AS_PLANNED):
        seen_by = [m.name for m in plan if _differs(m, sensor, axes)]
        found.append(Misread(sensor, axes, "", seen_by, axes_step(sensor, axes).id))
    for log, own in explained.misread.items():
        for sensor, axes in unlike(own, explained.everywhere):
            seen_by = [m.name for m in plan if m.log == log]
            found.append(Misread(sensor, axes, log, seen_by, axes_step(sensor, axes, log).id))
    return found


def unlike(axes: Axes, others: Axes) -> Iterator[tuple[str, Permutation]]:
    """The sensors whose axes are others than those: accel, gyro."""
    both = {"accel": (axes.accel, others.accel), "gyro": (axes.gyro, others.gyro)}
    return ((sensor, own) for sensor, (own, other) in both.items() if own != other)


def _differs(m: Manoeuvre, sensor: str, axes: Permutation) -> bool:
    """Whether a sensor reads a manoeuvre otherwise by these axes."""
    of_gyro = m.about if m.do == "turn" else None
    direction = m.up if sensor == "accel" else of_gyro
    return direction is not None and not np.allclose(axes.of(direction), direction)


def by_mounting(explained: ExplainedRecording) -> bool:
    """Whether the axes of both sensors may be right, and the IMU is mounted otherwise.

    Both triads are then turned alike; where only one is seen, the other one may be.
    """
    axes = explained.everywhere
    turned = axes.accel if axes.accel != AS_NAMED else axes.gyro
    if turned == AS_NAMED or determinant(turned) < 0:
        return False
    if axes.accel == axes.gyro:
        return True
    turns = any(
        located.place(m) is not None
        for located in explained.located
        for m in located.plan
        if m.do == "turn"
    )
    ups = any(m.up is not None for located in explained.located for m in located.plan)
    if axes.gyro == AS_NAMED:
        return not turns and not any(explained.gyro_signs)
    return axes.accel == AS_NAMED and not ups


# ---- Logs whose sensors have other axes than those of the rest of the campaign.

MIN_GAIN = 2  # observations more that agree with the plan, in place of as many that do not
MIN_GAIN_OF_BOTH = 3  # the same, for both sensors of one log: it may have had another attitude


def misread_logs(case: Case) -> Iterator[tuple[str, Axes]]:
    """Logs with other axes than the rest of the campaign."""
    of_window = [window.log for window in case.windows]
    if len(set(of_window)) < 2:
        return
    taken = {log for exchanged in case.exchanged for log in exchanged.logs}
    for log in dict.fromkeys(of_window[k] for k in case.lacking if of_window[k] not in taken):
        axes = _axes_of(case, [k for k, own in enumerate(of_window) if own == log])
        if axes is not None:
            yield log, axes


def _axes_of(case: Case, own: list[int]) -> Axes | None:
    """The axes by which all of a log agrees with the plan, if the data decide for them."""
    now, said = np.sum([case.located[k].agreeing for k in own], axis=0)
    for sensors in (("accel",), ("gyro",), ("accel", "gyro")):
        for permutation in PERMUTATIONS:
            axes = replace(case.everywhere, **dict.fromkeys(sensors, permutation))
            located = [locate(case.windows[k], axes, case.plans[k]) for k in own]
            right, all_of_it = np.sum([each.agreeing for each in located], axis=0)
            if right < all_of_it or right <= now:
                continue
            if right - now >= (MIN_GAIN if len(sensors) == 1 else MIN_GAIN_OF_BOTH):
                return axes
            if len(sensors) == 1 and _confirmed_by_other_sensor(case, axes, int(said)):
                return axes
            break  # if the simplest is not significant, the others are not
    return _axes_by_force(case, own, int(now), int(said))


def _confirmed_by_other_sensor(case: Case, axes: Axes, said: int) -> bool:
    """Whether the other sensor confirms that the IMU moved as planned, and only axes differ.

    A turn against the plan may be just that; so one turn cannot show the sign of a gyro alone.
    """
    if said < 2:
        return False
    return axes.gyro == case.everywhere.gyro or not axes.gyro.in_place


def _axes_by_force(case: Case, own: list[int], now: int, said: int) -> Axes | None:
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
