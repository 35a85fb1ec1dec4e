"""A gyro that reads its negative in a part of a recording: by what it reads at rest, by gravity.

At rest a gyro reads its bias and the earth's rate, r = b + ω. Where its sign changes between two
rests, so does this as a whole: a bias would have to change by just −2 b. Turns about an axis that
read the other way show its sign for as long as they last, and not for the whole campaign.

Every motion from rest to rest that turns gravity tells the sign of a gyro by itself, and so does a
turn about its axis as planned. Where some motions show it as named and others reversed, and all of
the reversed ones follow one another, it is reversed in the part that holds them. Of the rests
between, what the gyro reads shows on which side of the change each is, where heading and latitude
are known; without them the part is as long as it may be. Turns on one side alone show nothing
without gravity: the plan may count them the other way.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from inertial.arrays import Array
from inertial.campaign.records import Manoeuvre, Row
from inertial.physics.motion import horizontal, north_of
from inertial.physics.site import EARTH_RATE
from inertial.signal.axis_permutations import Permutation
from inertial.signal.gravity_turned import Turned, signs_of_motions
from inertial.signal.plan_detector import Edge, ReversedPart, SignChange
from inertial.tables import AXES
from stages.segment.located import AS_PLANNED, Located
from stages.segment.steps import OWN_AXIS_SHARE

MIN_GAIN = 30.0  # of chi-squared, by one sign less in a part of the rests: over 5 sigma
MAX_BESIDE_A_JUMP = 16.0  # of chi-squared, by which a bias of its own on each side fits better
MAX_BESIDE_THE_BEST = 9.0  # of chi-squared, of places where the sign may have changed as well
MAX_OF_ROUND = 0.01  # rounds: a turn that ends where it began, so that north is where it was
MIN_RESTS = 3  # fewer do not tell a sign from a bias


@dataclass(frozen=True)
class _Rest:
    """What a gyro reads at rest.

    order : window and stretch; heading : what has north in the same direction in the body
    up : share of the axis that points up; mark : (3,), level, that of the table where it is known
    rate, sigma : rad/s, mean; before, after : the last manoeuvre up to it, and the first from it on
    """

    order: tuple[int, int]
    log: str
    heading: tuple[str, int]
    up: Array
    mark: Array | None
    rate: Array
    sigma: Array
    before: str
    after: str


def sign_changes(
    located: Sequence[Located],
    plan: Sequence[Manoeuvre],
    level: Array,
    axes: Permutation,
    earth_rate: float,
) -> list[SignChange]:
    """The gyros that a permutation takes for reversed all along, and that change their sign.

    Parameters
    ----------
    level : (3,), rad/s, what the rates of the observations are less by
    axes : takes the readings of the gyros to the axes of the plan, in place
    earth_rate : rad/s, its part upwards; 0 where it is not known
    """
    if not axes.in_place or len({m.switch_on for m in plan}) > 1:
        return []
    windows, rests = _in_order(located, plan, level)
    found = []
    for i in np.flatnonzero(np.array(axes.signs) < 0):
        turns = [
            (k, place)
            for k, one in enumerate(windows)
            for m in one.plan
            if m.about is not None
            and abs(m.about[i]) > OWN_AXIS_SHARE
            and (place := one.place(m)) is not None
        ]
        own = [rest for rest in rests if np.isfinite(rest.rate[i])]
        change = _change(int(i), own, turns, earth_rate)
        found += [] if change is None else [change]
    return found


def _in_order(
    located: Sequence[Located], plan: Sequence[Manoeuvre], level: Array
) -> tuple[list[Located], list[_Rest]]:
    """The windows in the order of the plan, and all rests in them."""
    order = {m.name: k for k, m in enumerate(plan)}
    windows = sorted(located, key=lambda one: order[one.plan[0].name])
    stated = {m.name: m for m in plan}
    return windows, [r for k, one in enumerate(windows) for r in _rests_of(k, one, stated, level)]


def _rests_of(
    window: int, located: Located, stated: Mapping[str, Manoeuvre], level: Array
) -> Iterator[_Rest]:
    """The rests of a window with a known direction up, those beside turns too.

    `stated`: the manoeuvres by name, with their directions as the plan has them.
    """
    ups: dict[int, tuple[Manoeuvre, int, bool]] = {}  # and whether the mark is where it states
    rounds = 0  # turns so far after which north is elsewhere
    for m in (stated[one.name] for one in located.plan):
        place = located.place(m)
        if place is None or m.up is None:
            continue
        if m.do == "rest":
            ups[place] = (m, rounds, True)
        if m.do == "turn":
            ups.setdefault(place - 1, (m, rounds, True))
            angle = 0.5 if m.angle is None else m.angle / (2 * np.pi)
            whole = abs(angle - round(angle)) <= MAX_OF_ROUND
            rounds += not whole
            if abs(m.axis @ m.up) > OWN_AXIS_SHARE:
                ups[place + 1] = (m, rounds, whole)
    places = [(place, m.name) for m in located.plan if (place := located.place(m)) is not None]
    for place in sorted(ups):
        if not 0 <= place < len(located.observed) or located.observed[place].moves:
            continue
        m, turned, as_stated = ups[place]
        assert m.up is not None
        seen, stretch = located.observed[place], located.stretches[place]
        read = np.isfinite(located.binned.read_rates[stretch.first : stretch.after]).any(axis=0)
        yield _Rest(
            (window, place),
            located.binned.window.log,
            (m.position, turned),
            m.up,
            horizontal(m.mark, m.up) if as_stated and m.mark is not None else None,
            np.where(read, seen.rate + level, np.nan),
            _sigma_at_rest(seen.unsure, located.binned.quantum[3:]),
            max(one for one in places if one[0] <= place)[1] if places[0][0] <= place else m.name,
            min((one for one in places if one[0] >= place), default=(0, m.name))[1],
        )


def _sigma_at_rest(unsure: Array, quantum: Array) -> Array:
    """Of the mean rates, (3,), rad/s; of coarse counts that never toggle that of rounding.

    Where the count is not known either, the rest tells nothing of the size of the earth's rate.
    """
    of_counts = np.nan_to_num(quantum / np.sqrt(12), nan=EARTH_RATE)
    return np.where(unsure > 0, unsure, of_counts)


def _change(
    i: int, rests: Sequence[_Rest], turns: Sequence[tuple[int, int]], earth_rate: float
) -> SignChange | None:
    """Where gyro i, whose turns are all read the other way, changes its sign; None: nowhere."""
    if len(rests) < MIN_RESTS or not turns:
        return None
    rate, up = (np.array([getattr(rest, key)[i] for rest in rests]) for key in ("rate", "up"))
    weights = cho_factor(_covariance(i, rests, earth_rate))

    def misfit(signs: Array, parts: Array) -> float:
        """Chi-squared with one bias, or with one on each side; signs, (n,), of the readings."""
        left = signs * rate - earth_rate * up
        unknown = np.asarray(cho_solve(weights, parts))
        bias = np.linalg.solve(parts.T @ unknown, unknown.T @ left)
        return float(left @ cho_solve(weights, left) - bias @ (unknown.T @ left))

    one = np.ones((len(rests), 1))
    always = misfit(-one[:, 0], one)
    tried: dict[int, tuple[float, bool]] = {}
    for k in range(1, len(rests)):
        behind = np.arange(len(rests)) >= k
        if min(turns) > rests[k - 1].order:  # the turns are in the part after it
            signs = np.where(behind, -1.0, 1.0)
        elif max(turns) < rests[k].order:
            signs = np.where(behind, 1.0, -1.0)
        else:
            continue
        sides = np.column_stack([behind, ~behind]).astype(float)
        jump, flip = misfit(-one[:, 0], sides), misfit(signs, one)
        scale = max(1.0, jump / max(len(rests) - 2, 1))
        if always - flip > MIN_GAIN * scale and flip - jump < MAX_BESIDE_A_JUMP * scale:
            tried[k] = (flip, bool(signs[-1] < 0))
    if not tried:
        return None
    least, later = min(tried.values())
    near = [k for k, (flip, _later) in tried.items() if flip < least + MAX_BESIDE_THE_BEST]
    first, after = min(near) - 1, max(near)
    wrong, others = (rests[after:], rests[:after]) if later else (rests[:after], rests[after:])
    logs = list(dict.fromkeys(rest.log for rest in wrong))
    parted = after > first + 1 or any(rest.log in logs for rest in others)
    return SignChange(i, rests[first].before, rests[after].after, later, logs, parted)


def _covariance(
    i: int, rests: Sequence[_Rest], earth_rate: float, heading: float | None = None
) -> Array:
    """That of the readings of gyro i, (n, n), rad²/s²: noise, and what is not known of the earth.

    The horizontal part of its rate has a direction of its own for each heading, unless `heading`
    and mark tell it, and the upward one is not known without a latitude.
    """
    up, sigma = (np.array([getattr(rest, key)[i] for rest in rests]) for key in ("up", "sigma"))
    told = [bool(earth_rate) and heading is not None and rest.mark is not None for rest in rests]
    headings = [rest.heading for rest in rests]
    same = np.array([[one == other for other in headings] for one in headings])
    same &= ~np.logical_or.outer(told, told)
    level = (EARTH_RATE**2 - earth_rate**2) * np.sqrt(np.outer(1 - up**2, 1 - up**2)) / 2
    unknown = 0.0 if earth_rate else EARTH_RATE**2 / 2
    return np.asarray(np.diag(sigma**2) + level * same + unknown * np.outer(up, up))


# ---- By gravity: the part in which a gyro is reversed.


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
    windows, rests = _in_order(located, plan, level)
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

    def __init__(self, i: int, rests: Sequence[_Rest], earth: tuple[float, float | None]) -> None:
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
            self._weights = cho_factor(_covariance(i, rests, upward, heading))
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
