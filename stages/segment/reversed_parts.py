"""A gyro that reads its negative in a part of a recording, by gravity.

Every motion from rest to rest that turns gravity tells the sign of a gyro by itself, and so does a
turn about its axis as planned. Where some motions show it as named and others reversed, and all of
the reversed ones follow one another, it is reversed in the part that holds them. Of the rests
between, what the gyro reads, its bias and the earth's rate, shows on which side of the change each
is, where heading and latitude are known; without them the part is as long as it may be. Turns on
one side alone show nothing without gravity: the plan may count them the other way.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from inertial.arrays import Array
from inertial.campaign.records import Manoeuvre, Row
from inertial.physics.motion import north_of
from inertial.physics.site import EARTH_RATE
from inertial.signal.axis_permutations import Permutation
from inertial.signal.gravity_turned import Turned, signs_of_motions
from inertial.signal.plan_detector import Edge, ReversedPart
from inertial.tables import AXES
from stages.segment.located import AS_PLANNED, Located
from stages.segment.sign_changes import MAX_BESIDE_THE_BEST, Rest, covariance_of, rests_of
from stages.segment.steps import OWN_AXIS_SHARE


@dataclass(frozen=True)
class _Seen:
    """A motion, a turn or a rest: bins [first, after) of a window, and what it shows of a gyro.

    sign : +1 as named, −1 reversed, 0 where it does not tell alone; spans : of gravity turned;
    rest : of the rests, −1 where it is none; turn : its name where it is one
    """

    window: int
    first: int
    after: int
    sign: int
    spans: int = 0
    rest: int = -1
    turn: str = ""


@dataclass(frozen=True)
class Reversal:
    """A part, how many spans show it, and the readings that may be reversed: rows of masks."""

    part: ReversedPart
    spans: int
    masks: Sequence[Row]

    @property
    def axes(self) -> Permutation:
        """What takes the readings in the part to the axes of the accelerometers."""
        signs = [1, 1, 1]
        signs[self.part.axis] = -1
        return Permutation((0, 1, 2), tuple(signs))


def reversals(
    located: Sequence[Located],
    plan: Sequence[Manoeuvre],
    level: Array,
    seen: Turned,
    earth: tuple[float, float | None],
) -> Iterator[Reversal]:
    """The gyros that are reversed in a part of the recording.

    Parameters
    ----------
    level : (3,), rad/s, what the rates are less by; seen : how the gyros turn gravity
    earth : rad/s, the upward part of its rate, 0 where it is not known; rad, the heading
    """
    order = {m.name: k for k, m in enumerate(plan)}
    windows = sorted(located, key=lambda one: order[one.plan[0].name])
    stated = {m.name: m for m in plan}
    rests = [rest for k, one in enumerate(windows) for rest in rests_of(k, one, stated, level)]
    means = [one.binned for one in windows]
    stretches = [(one.forces, one.read_rates - level, one.bin_seconds) for one in means]
    alike, signs = signs_of_motions(stretches, seen)
    axes = alike.axes_of_most
    if axes is None or not axes.in_place:
        return
    moved = [(k, motion) for k, own in enumerate(signs) for motion in own]
    for i in range(3):
        own = [rest for rest in rests if np.isfinite(rest.rate[i])]
        told = [
            _Seen(k, one.first, one.after, axes.signs[i] * int(one.reversed[i]), one.spans)
            for k, one in moved
            if one.reversed[i]
        ]
        told += _turns(i, windows)
        for n, rest in enumerate(own):
            k, place = rest.order
            stretch = windows[k].stretches[place]
            told.append(_Seen(k, stretch.first, stretch.after, 0, rest=n))
        told.sort(key=lambda one: (one.window, one.first))
        found = _reversal(i, windows, told, _Misfit(i, own, earth))
        if found is not None:
            yield found


def _turns(i: int, windows: Sequence[Located]) -> Iterator[_Seen]:
    """The turns about axis i that read as planned; of others the plan may be wrong."""
    for k, one in enumerate(windows):
        for m in one.plan:
            place = one.place(m)
            about = m.do == "turn" and m.about is not None and abs(m.about[i]) > OWN_AXIS_SHARE
            if about and place is not None and one.axes == AS_PLANNED and one.ratio(m, m) > 0:
                stretch = one.stretches[place]
                yield _Seen(k, stretch.first, stretch.after, 1, turn=m.name)


class _Misfit:
    """Chi-squared of what gyro i reads at rest, with one bias, by its sign at each rest, (n,)."""

    def __init__(self, i: int, rests: Sequence[Rest], earth: tuple[float, float | None]) -> None:
        upward, heading = earth
        level = np.sqrt(max(EARTH_RATE**2 - upward**2, 0.0))
        self.number = len(rests)
        self._rate = np.array([rest.rate[i] for rest in rests])
        self._earth = np.array([upward * rest.up[i] for rest in rests])
        if upward and heading is not None:
            self._earth += [
                0.0 if rest.mark is None else level * north_of(rest.up, rest.mark, heading)[i]
                for rest in rests
            ]
        if self.number:
            self._weights = cho_factor(covariance_of(i, rests, upward, heading))
            self._ones = np.asarray(cho_solve(self._weights, np.ones(self.number)))

    def of(self, signs: Array) -> float:
        """0 where there are no rests."""
        if not self.number:
            return 0.0
        left = signs * self._rate - self._earth
        left -= (self._ones @ left) / self._ones.sum()
        return float(left @ cho_solve(self._weights, left))


def _reversal(
    i: int, windows: Sequence[Located], told: Sequence[_Seen], misfit: _Misfit
) -> Reversal | None:
    """The part of what is told, in order, in which gyro i is reversed; None where there is none."""
    signs = np.array([one.sign for one in told])
    wrong, right = np.flatnonzero(signs < 0), np.flatnonzero(signs > 0)
    if not len(wrong) or not len(right) or ((right > wrong[0]) & (right < wrong[-1])).any():
        return None
    before, behind = right[right < wrong[0]], right[right > wrong[-1]]
    by_gravity = any(one.sign > 0 and one.spans for one in told)
    if not by_gravity and not (len(before) and len(behind)):
        return None  # the plan may count these turns the other way
    firsts = range(before[-1] + 1 if len(before) else 0, wrong[0] + 1)
    afters = range(wrong[-1] + 1, (behind[0] if len(behind) else len(told)) + 1)
    at_rest = np.array([one.rest for one in told])
    tried: dict[tuple[int, int], float] = {}
    for first, after in product(firsts, afters):
        inside = (np.arange(len(told)) >= first) & (np.arange(len(told)) < after)
        of_rests = np.ones(misfit.number)
        of_rests[at_rest[inside & (at_rest >= 0)]] = -1
        tried[first, after] = misfit.of(of_rests)
    least = min(tried.values())
    most = least + MAX_BESIDE_THE_BEST * max(1.0, least / max(misfit.number - 1, 1))
    near = np.array([both for both, chi in tried.items() if chi < most or chi == least])
    (first, after), (last_first, first_after) = (
        (near[:, 0].min(), near[:, 1].max()),
        (near[:, 0].max(), near[:, 1].min()),
    )
    begins = _edge(windows, told, first - 1, last_first)
    ends = _edge(windows, told, first_after - 1, after)
    outside = [*told[:first], *told[after:]]
    logs = list(
        dict.fromkeys(windows[one.window].binned.window.log for one in told[last_first:first_after])
    )
    parted = (first, after) != (last_first, first_after) or any(
        windows[one.window].binned.window.log in logs for one in outside
    )
    part = ReversedPart(i, begins, ends, [one.turn for one in told if one.turn], logs, parted)
    bounds = (told[first - 1] if first else None, told[after] if after < len(told) else None)
    spans = sum(one.spans for one in told if one.sign < 0)
    return Reversal(part, spans, list(_masks(AXES[i], windows, *bounds)))


def _edge(windows: Sequence[Located], told: Sequence[_Seen], last: int, first: int) -> Edge | None:
    """Between what is told last on one side and first on the other.

    None at an end; where it may be there or nearer, a name of one side alone.
    """
    if first == 0 or last == len(told) - 1:
        return None
    one, other = told[max(last, 0)], told[min(first, len(told) - 1)]
    of_one, of_other = windows[one.window], windows[other.window]
    times = (np.nan, np.nan)
    if of_one.binned.window.log == of_other.binned.window.log:
        end, begin = of_one.binned.last_s[one.after - 1], of_other.binned.first_s[other.first]
        times = (float(end), float(begin))
    names, firsts = _starts(of_one)
    before = names[max(int(np.searchsorted(firsts, one.first, side="right")) - 1, 0)]
    names, firsts = _starts(of_other)
    after = names[min(int(np.searchsorted(firsts, other.first)), len(names) - 1)]
    if last < 0 or first == len(told):
        return Edge("" if last < 0 else before, after if last < 0 else "", np.nan, np.nan)
    return Edge(before, after, *times)


def _starts(located: Located) -> tuple[list[str], list[int]]:
    """The manoeuvres that are found in a window, in order, and their first bins; or all, at 0."""
    found = [
        (located.stretches[place].first, m.name)
        for m in located.plan
        if (place := located.place(m)) is not None
    ]
    found = sorted(found) or [(0, m.name) for m in located.plan]
    return [name for _first, name in found], [first for first, _name in found]


def _masks(
    axis: str, windows: Sequence[Located], before: _Seen | None, behind: _Seen | None
) -> Iterator[Row]:
    """The records of a gyro between what is right before and behind, as rows of masks."""
    for k, one in enumerate(windows):
        first, after = 0, one.binned.bins
        if before is not None:
            first = after if k < before.window else before.after if k == before.window else first
        if behind is not None:
            after = 0 if k > behind.window else behind.first if k == behind.window else after
        if first < after:
            edges = one.binned.edges
            yield {
                "log": one.binned.window.log,
                "from_record": int(edges[first]),
                "to_record": int(edges[after]),
                "sensor": "gyro",
                "axis": axis,
                "repeated": False,
                "censored": False,
                "finding": "",
            }
