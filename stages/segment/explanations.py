"""Explanations of a recording that differs from its plan: exchanged axes, signs or names."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.records import Manoeuvre
from inertial.signal.axis_permutations import PERMUTATIONS, Permutation, read_as_other_axes
from stages.segment.locating import AS_NAMED, AS_PLANNED, Axes, Division, Located, locate

Array = NDArray[np.float64]

MIN_GAIN = 2  # observations more that agree with the plan, in place of as many that do not
MIN_UPRIGHT_SHARE = 0.9  # share of the vertical in an axis that points up
MIN_EARTH_SIGMA = 4.0  # sigmas to which the earth's rate must be seen to half of itself
MAX_EXCHANGED = 4  # manoeuvres of a log for which an exchange with every other one is tried
MIN_GAIN_OF_BOTH = 3  # the same, for both sensors of one log: it may have had another attitude


@dataclass(frozen=True)
class Exchanged:
    """Manoeuvres that are found in each other's place, and their logs."""

    names: tuple[str, ...]
    logs: tuple[str, ...]


@dataclass(frozen=True)
class Explained:
    """The windows, each with where its manoeuvres are.

    `everywhere`: axes that are exchanged or reversed in all logs; `misread`: logs whose
    axes differ from those of the others; `exchanged`: exchanged manoeuvres; `gyro_signs`: by the
    earth rate.
    """

    located: Sequence[Located]
    gyro_signs: Sequence[int]
    everywhere: Axes
    misread: Mapping[str, Axes]
    exchanged: Sequence[Exchanged]


@dataclass(frozen=True)
class _Case:
    """A supposition: of each window its axes and its manoeuvres, and where they are then found."""

    located: tuple[Located, ...]
    earth_rate: float
    everywhere: Axes = AS_PLANNED
    exchanged: tuple[Exchanged, ...] = ()

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


def explain(windows: Sequence[Division], earth_rate: float) -> Explained:
    """Find every manoeuvre; where the plan is not found, by what explains clearly more of it.

    First what may have happened to the campaign as a whole: names or places of two manoeuvres
    exchanged, or one signed permutation of the axes of a sensor, or of both. Where exchanged names
    and a permutation explain as much, the names are taken: a permutation is seen by all
    manoeuvres that see its axes, and so mostly by more than two. Then log by log.

    earth_rate: rad/s, its part upwards; 0 where it is not known.
    """
    case = _Case(tuple(locate(window) for window in windows), earth_rate)
    while case.lacking:
        best = max(
            _suppositions(windows, case), key=lambda supposed: supposed.balance, default=case
        )
        gain = best.balance - case.balance
        # Two that changed places within a log cost one of them at most: the other one fits.
        whole = gain >= 2 and not best.lacking and best.exchanged != case.exchanged
        if gain < 2 * MIN_GAIN and not whole:
            break
        case = best
    misread = dict(_misread(windows, case))
    signs = earth_seen(case.located, case.everywhere, earth_rate)
    return Explained(case.located, signs, case.everywhere, misread, case.exchanged)


def _suppositions(windows: Sequence[Division], case: _Case) -> Iterator[_Case]:
    """All that may have happened to the campaign, the likelier first."""
    taken = {name for exchanged in case.exchanged for name in exchanged.names}
    lacking = [k for k in case.lacking if not taken & {m.name for m in _named(windows, k)}]
    for a, b in combinations(lacking, 2):
        yield _with_names_exchanged(windows, case, a, b)
    for k in lacking:
        lost = [m for m in case.located[k].plan if case.located[k].place(m) is None]
        for m in lost[:MAX_EXCHANGED]:
            for other in case.located[k].plan:
                if other.name != m.name and "positions" not in (m.do, other.do):
                    yield _with_places_exchanged(windows, case, k, (m.name, other.name))
    for permutation in PERMUTATIONS:
        for change in ({"accel": permutation}, {"gyro": permutation}):
            if getattr(case.everywhere, next(iter(change))) == AS_NAMED:
                yield _by_axes(windows, case, replace(case.everywhere, **change))
        if case.everywhere.as_named:
            yield _by_axes(windows, case, Axes(permutation, permutation))


def _named(windows: Sequence[Division], k: int) -> Sequence[Manoeuvre]:
    return windows[k].binned.window.manoeuvres


def _with_names_exchanged(windows: Sequence[Division], case: _Case, a: int, b: int) -> _Case:
    located = list(case.located)
    located[a] = locate(windows[a], case.everywhere, _named(windows, b))
    located[b] = locate(windows[b], case.everywhere, _named(windows, a))
    names = tuple(m.name for k in (a, b) for m in _named(windows, k))
    logs = tuple(dict.fromkeys(windows[k].binned.window.log for k in (a, b)))
    return replace(
        case, located=tuple(located), exchanged=(*case.exchanged, Exchanged(names, logs))
    )


def _with_places_exchanged(
    windows: Sequence[Division], case: _Case, k: int, pair: tuple[str, str]
) -> _Case:
    order = list(_named(windows, k))
    i, j = (next(n for n, m in enumerate(order) if m.name == name) for name in pair)
    order[i], order[j] = order[j], order[i]
    located = list(case.located)
    located[k] = locate(windows[k], case.everywhere, order)
    names = tuple(sorted(pair, key=[m.name for m in _named(windows, k)].index))
    exchanged = Exchanged(names, (windows[k].binned.window.log,))
    return replace(case, located=tuple(located), exchanged=(*case.exchanged, exchanged))


def _by_axes(windows: Sequence[Division], case: _Case, axes: Axes) -> _Case:
    located = tuple(locate(window, axes) for window in windows)
    # What two names had explained, they explain by these axes as well, or not at all.
    return replace(case, located=located, everywhere=axes, exchanged=())


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
            located = [locate(windows[k], axes) for k in own]
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
    others = [pair for other in case.located for pair in _forces(other)]
    if not others or not np.isfinite(force).all():
        return None
    forces, ups = (np.array(column) for column in zip(*others, strict=True))
    permutation = read_as_other_axes(force, m.up, forces, ups)
    return None if permutation is None else replace(case.everywhere, accel=permutation)


def earth_seen(located: Sequence[Located], axes: Axes, earth_rate: float) -> list[int]:
    """The signs of the gyros by the earth rate: +1 right, −1 wrong, 0 nothing, (3,).

    A gyro reads the upward part of the earth's rate with one sign while its axis points up, with
    the other while it points down, whatever its bias. Gyros that are too noisy give 0.
    """
    rests = [pair for window in located for pair in _rates(window, axes)]
    signs = [0, 0, 0]
    for i in range(3):
        ways = []
        for sign in (1, -1):
            same = [
                (r, u)
                for up, r, u in rests
                if sign * up[i] > MIN_UPRIGHT_SHARE and np.isfinite(u[i])
            ]
            if same:
                weight = np.array([1 / max(u[i], 1e-12) ** 2 for _, u in same])
                mean = float(weight @ np.array([r[i] for r, _ in same]) / weight.sum())
                ways.append((mean, float(1 / np.sqrt(weight.sum()))))
        if len(ways) == 2 and earth_rate:
            (above, sigma_above), (below, sigma_below) = ways
            ratio = (above - below) / 2 / earth_rate
            sigma = np.hypot(sigma_above, sigma_below) / 2 / earth_rate
            if MIN_EARTH_SIGMA * abs(sigma) < 0.5 and 0.5 < abs(ratio) < 1.5:
                signs[i] = int(np.sign(ratio))
    return signs


def _rates(located: Located, axes: Axes) -> Iterator[tuple[Array, Array, Array]]:
    """The rests of a window: what points up, rates, and their sigmas, along the plan's axes."""
    for m in located.plan:
        place = located.place(m) if m.do == "rest" else located.rest_before(m)
        if place is None or m.up is None or located.place(m) is None:
            continue
        observation = located.observed[place]
        unsigned = replace(axes.gyro, signs=(1, 1, 1))
        yield axes.accel.of(m.up), axes.gyro.of(observation.rate), unsigned.of(observation.unsure)


def _forces(located: Located) -> Iterator[tuple[Array, Array]]:
    """The specific forces at the rests of a window, each with the direction that was planned up."""
    for m in located.plan:
        place = located.place(m) if m.do == "rest" else located.rest_before(m)
        if place is None or m.up is None or located.place(m) is None:
            continue
        force = located.observed[place].force
        if np.isfinite(force).all():
            yield force, m.up


def unlike(axes: Axes, others: Axes) -> Iterator[tuple[str, Permutation]]:
    """The sensors whose axes are others than those: accel, gyro."""
    for sensor, own, other in (
        ("accel", axes.accel, others.accel),
        ("gyro", axes.gyro, others.gyro),
    ):
        if own != other:
            yield sensor, own
