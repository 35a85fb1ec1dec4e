"""A gyro that changes its sign in the course of a campaign, by what it reads at rest.

Turns about an axis that read the other way show its sign for as long as they last, and not for
the whole campaign. At rest a gyro reads its bias and the earth's rate, r = b + ω. Where its sign
changes between two rests, so does this as a whole: a bias would have to change by just −2 b.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from inertial.arrays import Array
from inertial.campaign.records import Manoeuvre
from inertial.physics.motion import horizontal
from inertial.physics.site import EARTH_RATE
from inertial.signal.axis_permutations import Permutation
from inertial.signal.plan_detector import SignChange
from stages.segment.located import Located
from stages.segment.steps import OWN_AXIS_SHARE

MIN_GAIN = 30.0  # of chi-squared, by one sign less in a part of the rests: over 5 sigma
MAX_BESIDE_A_JUMP = 16.0  # of chi-squared, by which a bias of its own on each side fits better
MAX_BESIDE_THE_BEST = 9.0  # of chi-squared, of places where the sign may have changed as well
MAX_OF_ROUND = 0.01  # rounds: a turn that ends where it began, so that north is where it was
MIN_RESTS = 3  # fewer do not tell a sign from a bias


@dataclass(frozen=True)
class Rest:
    """What a gyro reads at rest.

    order : window and stretch; heading : what has north in the same direction in the body; up :
    share of the axis that points up; mark : (3,), the zero mark of the table, level, where it is known;
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
    order = {m.name: k for k, m in enumerate(plan)}
    windows = sorted(located, key=lambda one: order[one.plan[0].name])
    stated = {m.name: m for m in plan}
    rests = [rest for k, one in enumerate(windows) for rest in rests_of(k, one, stated, level)]
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


def rests_of(
    window: int, located: Located, stated: Mapping[str, Manoeuvre], level: Array
) -> Iterator[Rest]:
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
        yield Rest(
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
    i: int, rests: Sequence[Rest], turns: Sequence[tuple[int, int]], earth_rate: float
) -> SignChange | None:
    """Where gyro i, whose turns are all read the other way, changes its sign; None: nowhere."""
    if len(rests) < MIN_RESTS or not turns:
        return None
    rate, up = (np.array([getattr(rest, key)[i] for rest in rests]) for key in ("rate", "up"))
    weights = cho_factor(covariance_of(i, rests, earth_rate))

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


def covariance_of(
    i: int, rests: Sequence[Rest], earth_rate: float, heading: float | None = None
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
