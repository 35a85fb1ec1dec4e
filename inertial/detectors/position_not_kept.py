"""Positions that are not kept: from one rest to the next, or by a creep of the fixture."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.special import fdtrc

from inertial.arrays import Array, Integers, nearest_axis
from inertial.physics.motion import cross
from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _
from inertial.text.numbers import counted, plus_minus, significant
from inertial.text.units import ARC_SECOND

MIN_PAIRS = 3  # one alone may be a shift of the IMU in its fixture
MIN_SHARE = 2 / 3  # of the pairs, which turn gravity
MIN_RATIO = 5.0  # of what changes across gravity, over what changes along it in any pair
MIN_SIGMAS = 3.0  # of what changes across gravity, over that by the scatter of the rests
MAX_CHANCE = 1e-5  # of noise as large across gravity as along it, or as the rests scatter there
MAX_OF_ROUND = 0.01  # by which a whole number of rounds between two rests may be off
MIN_VERTICAL = 0.9  # share of the vertical in an axis that points up


class PositionNotKept(PlanDetector):
    """From one rest to the next of the same position the direction of gravity is another.

    Its magnitude is not: a tilt changes the specific force across gravity, and the biases of
    accelerometers along it as well, once each axis has been vertical.

    Cause: the IMU was taken out and set anew, or its fixture or the table gives way in each turn.
    The model has one tilt for all rests of a position.
    """

    name = "position_not_kept"
    source = "IEEE Std 1293-2018: a position is set once, and held for all readings in it"
    unit = "rad"
    severity = 3

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        pairs = list(_pairs(recorded))
        vertical = {nearest_axis(recorded.up[i]) for i, _after in pairs}
        if len(pairs) < MIN_PAIRS or len(vertical) < 3:
            return
        along, across = np.array([_change(recorded, *pair) for pair in pairs]).T
        sigma = np.array([_noise_across(recorded, *pair) for pair in pairs])
        turned = across > np.maximum(MIN_RATIO * np.abs(along).max(), MIN_SIGMAS * sigma)
        noise = max(2 * float(np.sum(along**2)), float(np.sum(sigma**2)))
        ratio = float(np.sum(across**2)) / noise if noise > 0 else 0.0
        chance = float(fdtrc(2 * len(pairs), len(pairs), ratio))
        if turned.mean() >= MIN_SHARE and chance < MAX_CHANCE:
            angle = float(np.sqrt(np.mean(across[turned] ** 2) / 2)) / recorded.given.gravity
            yield Deviation(None, "", angle, count=int(turned.sum()), facts=len(pairs))

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        assert deviation.size is not None
        return Description(
            _(
                "In {count} of {pairs} pairs of rests that the plan has in one position gravity "
                "has turned in the case from one to the other, by {angle} arcsec about each axis "
                "(rms), and is as large as before: the position was not kept.",
                count=deviation.count,
                pairs=deviation.facts,
                angle=significant(deviation.size / ARC_SECOND, 2),
            ),
            _(
                "One tilt is estimated for all rests of a position, so what these differ by goes "
                "into biases and cross terms, and their sigmas do not include it."
            ),
            _(
                "If the IMU was set anew, leave position out of these manoeuvres, so that each has "
                "a tilt of its own; else look for what gives way in the fixture or in the table."
            ),
        )


def _pairs(recorded: Recorded) -> Iterator[tuple[int, int]]:
    """Manoeuvres one after the other in one position, after whole rounds between their rests."""
    read = np.isfinite(recorded.force).all(axis=1) & recorded.found
    upright = np.abs(recorded.up).max(axis=1) > MIN_VERTICAL
    for i, after in pairwise(range(len(recorded.name))):
        rounds = 0.0 if np.isnan(recorded.angle[i]) else recorded.angle[i] / (2 * np.pi)
        same = recorded.position[i] == recorded.position[after]
        if same and is_closed(rounds) and read[[i, after]].all() and upright[i]:
            yield i, after


def is_closed(rounds: float) -> bool:
    """Whether a turn by so many rounds ends where it began."""
    return abs(rounds - round(rounds)) < MAX_OF_ROUND


def _change(recorded: Recorded, i: int, after: int) -> Array:
    """By what the specific force changes along gravity, and across it, m/s²."""
    change, up = recorded.force[after] - recorded.force[i], recorded.up[i]
    along = float(change @ up)
    return np.array([along, np.linalg.norm(change - along * up)])


def _noise_across(recorded: Recorded, i: int, after: int) -> float:
    """Sigma of the change across gravity by what the rests of the position scatter, m/s².

    A table that shakes sideways does so more across gravity than along it; 0 where not known.
    """
    rests = recorded.static_means
    position = np.array(recorded.position)[rests.manoeuvre]
    density = rests.scatter[position == recorded.position[i]] ** 2
    density = density[np.isfinite(density).all(axis=1)]
    if not len(density):
        return 0.0
    across = np.median(density, axis=0) @ (1 - recorded.up[i] ** 2)
    own = ~rests.after_turn & np.isin(rests.manoeuvre, (i, after))
    return float(np.sqrt(across * np.sum(1 / rests.seconds[own])))


# ---- An IMU that creeps in its fixture while positions are held.


MIN_CHANGES = 6  # from rest to rest of one position: three equations each
MAX_CHANCE_OF_CREEP = 1e-6  # of white noise, that looks like a creep
MAX_CHANCE_OF_DRIFT = 1e-3  # of biases that wander, with which positions differ at random
MAX_CHANCE_WITHOUT_ONE = 1e-3  # of white noise, that looks like it where a position is left out
MIN_SHARE_OF_CREEP = 0.7  # of what a drift of the biases leaves: else there is something else
SETTLING = (np.inf, 1.0, 0.5, 0.25)  # time constants that are tried, of the whole time
MIN_ANGLE = 10 * ARC_SECOND  # over the campaign: less is what positions are set to


class FixtureCreep(PlanDetector):
    """Between the rests of each position gravity turns in the case, about one axis of the case.

    f = f₀ + t (f × ω + ḃ), with f₀ of each position: a creep of the case at a rate ω changes the
    specific force across gravity, the other way in the opposite position; biases that drift change
    it alike in all positions.

    Cause: an adhesive or a screw gives way, or what holds the IMU warms up.
    """

    name = "fixture_creep"
    source = "IEEE Std 1293-2018: stability of the mounting fixture"
    unit = "rad"
    severity = 3

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        rests, held = recorded.static_means, _held(recorded)
        several = np.bincount(held, minlength=1)[held] > 1
        if np.count_nonzero(several) - len(np.unique(held[several])) < MIN_CHANGES:
            return
        force, time, seconds = (own[several] for own in (rests.force, rests.time, rests.seconds))
        held = held[several]
        creep = _likeliest(force, time, seconds, held)
        angle = float(np.linalg.norm(creep.turned))
        clear = creep.chance < MAX_CHANCE_OF_CREEP and creep.chance_of_drift < MAX_CHANCE_OF_DRIFT
        if clear and angle > MIN_ANGLE and not _of_one_position(force, time, seconds, held):
            yield Deviation(None, "", angle, count=len(np.unique(held)), facts=creep)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        assert deviation.size is not None
        creep = deviation.facts
        turned = ", ".join(
            plus_minus(angle / ARC_SECOND, sigma / ARC_SECOND)
            for angle, sigma in zip(creep.turned.tolist(), creep.sigma.tolist(), strict=True)
        )
        return Description(
            _(
                "While {positions} are held gravity turns in the case, the other way in opposite "
                "ones: by ({turned}) arcsec about x, y, z from the first rest to the last. The IMU "
                "creeps in its fixture.",
                positions=counted(deviation.count, "position"),
                turned=turned,
            ),
            _(
                "The cross terms of both sensors are those of no one attitude in the fixture, and "
                "their sigmas do not include it; at rest it looks like a bias that wanders."
            ),
            _(
                "Fasten the IMU anew, let the adhesive cure and the fixture take its temperature, "
                "and record again."
            ),
        )


@dataclass(frozen=True)
class _Creep:
    """By what the case turns from the first rest to the last, and its sigma, (3,), rad.

    `chance`: that white noise, `chance_of_drift`: that biases that wander look as much like it.
    """

    turned: Array
    sigma: Array
    chance: float
    chance_of_drift: float


def _held(recorded: Recorded) -> Integers:
    """Of each rest in which position it is, from 0; a turn that does not close begins another."""
    rests, number = recorded.static_means, -1
    held, last = [], None
    for i, after_turn in zip(rests.manoeuvre.tolist(), rests.after_turn.tolist(), strict=True):
        place = recorded.position[i], recorded.log[i]
        rounds = float(np.nan_to_num(recorded.angle[i])) / (2 * np.pi)
        number += place != last or (after_turn and not is_closed(rounds))
        held.append(number)
        last = place
    return np.array(held, np.int64)


def _likeliest(force: Array, time: Array, seconds: Array, held: Integers) -> _Creep:
    """The creep, evenly or settling, that the rests show most clearly.

    Parameters
    ----------
    force, time, seconds : (n, 3), m/s², and (n,), s, of the rests, and how long they are
    held : (n,), in which position each is
    """
    _names, held = np.unique(held, return_inverse=True)
    since = (time - time.min()) / np.ptp(time)
    tried = []
    for constant in SETTLING:
        course = since if np.isinf(constant) else -np.expm1(-since / constant)
        tried.append(_creep(force, since, course / course.max(), seconds, held))
    found = min(tried, key=lambda one: one.chance)
    return replace(found, chance=len(tried) * found.chance)


def _of_one_position(force: Array, time: Array, seconds: Array, held: Integers) -> bool:
    """Whether one position alone looks like a creep, as by a bias that jumps there; see above."""
    for position in np.unique(held):
        others = held != position
        left = _likeliest(force[others], time[others], seconds[others], held[others])
        if left.chance > MAX_CHANCE_WITHOUT_ONE:
            return True
    return False


def _creep(force: Array, since: Array, course: Array, seconds: Array, held: Integers) -> _Creep:
    """The creep that goes as a course, (n,), from 0 to 1, beside a drift of the biases."""
    count = int(held[-1]) + 1
    weights = (held == np.arange(count)[:, None]) * seconds
    member = weights / weights.sum(axis=1, keepdims=True)

    def about_means(values: Array) -> Array:
        return np.asarray(values - np.tensordot(member, values, 1)[held])

    unit = np.eye(3)
    turning = np.stack([cross(force, axis) for axis in unit], axis=2)
    columns = [one[:, None, None] * unit for one in (since, course)]
    design = np.concatenate([*columns, course[:, None, None] * turning], axis=2)
    design, rows = about_means(design), about_means(force)
    root = np.sqrt(seconds)[:, None]  # the noise of a mean falls with its length
    turned, sigma, chance = _tested(root[..., None] * design, root * rows, 3 * count)
    # As biases wander the rests of one position go one way: its slope is then one reading.
    slopes = weights * about_means(since)
    slopes /= np.maximum(slopes @ since, np.finfo(float).tiny)[:, None]
    _turned, _sigma, chance_of_drift = _tested(
        np.tensordot(slopes, design, 1), np.tensordot(slopes, rows, 1), 0
    )
    return _Creep(turned, sigma, chance, chance_of_drift)


def _tested(design: Array, rows: Array, fitted: int) -> tuple[Array, Array, float]:
    """The last three of the unknowns, their sigma, and the probability of so large ones by chance.

    `design`: (n, 3, p), `rows`: (n, 3); `fitted`: unknowns that are eliminated. By what is left.
    """
    matrix, read = design.reshape(-1, design.shape[2]), rows.ravel()
    squares, ranks, values = [], [], np.empty(0)
    for columns in (matrix[:, :-3], matrix):
        found, _squares, rank, _singular = np.linalg.lstsq(columns, read, rcond=1e-6)
        squares.append(float(np.sum((read - columns @ found) ** 2)))
        ranks.append(int(rank))
        values = np.asarray(found[-3:])
    more, left = ranks[1] - ranks[0], len(read) - fitted - ranks[1]
    if not more or left <= 0 or not 0 < squares[1] < (1 - MIN_SHARE_OF_CREEP) * squares[0]:
        return values, np.full(3, np.nan), 1.0
    inverse = np.linalg.pinv(matrix.T @ matrix, rcond=1e-12, hermitian=True)
    sigma = np.sqrt(squares[1] / left * np.diag(inverse)[-3:])
    ratio = (squares[0] - squares[1]) / more / (squares[1] / left)
    return values, sigma, float(fdtrc(more, left, ratio))
