"""Where a log moves and where it rests, by short means of its channels."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.signal.scatter import MAD_TO_SIGMA

MIN_MOTION_SIGMA = 6.0  # scatters of the gyros at rest: what cannot be noise
# Counts that reading after reading toggles between two values, where the noise is below a count: a
# mean of them may be a count off, and its level half a count where attitude or bias moves it.
MAX_TOGGLING = 1.5
MIN_HAND_RATE = np.radians(2.0)  # rad/s: what counts as motion where no rate is planned
MIN_STRETCH_S = 0.3  # s, a motion or a rest shorter than this is none, or a tenth of the stretch
MAX_KNOCK_TILT = np.radians(5.0)  # rad: an IMU that is knocked stands again as it stood
BINS_BESIDE = 3  # whose mean is the direction of gravity before and after
MAX_SLOW_END_S = 3.0  # s, at most, in which a motion begins or ends below what counts as motion
MAX_SWING_S = 10.0  # s, the same of a table that swings on
MIN_BINS_OF_A_REST = 20  # whose own scatter tells what is off
MIN_TURN_SHARE = 0.05  # of the rate of a turn: what is less is no part of it
MAX_PAUSE_S = 0.3  # s, in which a table that swings on turns back
MAX_SETTLED = 5.0  # scatters of bins from the plateau of a turn, within which a rate has settled
SETTLED_BINS = 3  # one after another within it: what rings goes through it as well
MAX_SETTLING_SHARE = 0.25  # of the plateau, that is left out while the rate settles
REACHED_SHARE = 0.97  # of the steady rate, from which a ramp has reached it
MAX_RISE = 1.03  # of what reaches the middle rate of a turn: more is not at that rate, but rising
MIN_MIDDLE_SHARE = 2 / 3  # of its highest rates, less of which is the middle of a turn that pauses
PLATEAU_ROUNDS = 10  # in which the level of a short plateau is had from what reaches it
MIN_PLATEAU_BAND = 1e-3  # of a rate, within which it is kept where the bins scatter less
MIN_PLATEAU_CROSSINGS = 3.0  # of the time in which a ramp passes that band: a plateau is longer
MIN_SLOW_TURN = np.radians(0.05)  # rad, of a motion below what counts as motion
AT_ENDS = 1 / 6  # of a stretch at each end, in which a slow motion has not begun, or is over
LEVEL_ROUNDS = 3  # in which what the gyros read at rest is had from the bins that do not move
# In m/s², change of the specific force that counts as motion where no gyro is recorded
MIN_FORCE_CHANGE = 0.1


@dataclass(frozen=True)
class BinStretch:
    """Consecutive bins, [first, after), that all move or all rest."""

    moves: bool
    first: int
    after: int


def rest_level(rates: Array) -> tuple[Array, float]:
    """What the gyros read at rest, and the scatter of a bin about it, rad/s.

    The bins that hardly differ from their neighbours are steady; of these the third
    with the lowest rate is at rest.

    Parameters
    ----------
    rates : (k, 3), rad/s, means of short bins
    """
    change = np.linalg.norm(np.diff(rates, axis=0, append=rates[-1:]), axis=1)
    steady = rates[change <= 3 * np.median(change)]
    magnitude = np.linalg.norm(steady, axis=1)
    resting = steady[magnitude <= np.quantile(magnitude, 1 / 3)]
    level = np.median(resting, axis=0)
    scatter = MAD_TO_SIGMA * np.median(np.abs(resting - level), axis=0)
    return level, float(np.linalg.norm(scatter))


def moving(rates: Array, forces: Array, level: Array, threshold: float) -> Booleans:
    """Which bins move: by the gyros, or by the accelerometers where no gyro is recorded.

    Parameters
    ----------
    rates, forces : (k, 3), rad/s and m/s², NaN where not recorded
    level : (3,) or (k, 3), rad/s, the gyros at rest
    threshold : rad/s
    """
    recorded = ~np.isnan(rates).all(axis=0)
    if recorded.any():
        away = (bridged(rates) - level)[:, recorded]  # clipped, it moves on
        return np.asarray(np.linalg.norm(away, axis=1) > threshold)
    forces = np.nan_to_num(forces)
    k = len(forces)
    if not k:
        return np.zeros(0, bool)
    windows = [forces[np.clip(np.arange(k) + shift, 0, k - 1)] for shift in (-2, -1, 0, 1, 2)]
    spread = np.ptp(np.stack(windows), axis=0)
    usual = 6 * np.quantile(np.linalg.norm(spread, axis=1), 0.25)
    return np.asarray(np.linalg.norm(spread, axis=1) > max(usual, MIN_FORCE_CHANGE))


def bridged(values: Array) -> Array:
    """Values (n, m) with straight lines between neighbours where one is NaN, unless all are."""
    place, filled = np.arange(len(values)), values.copy()
    for i, there in enumerate(np.isfinite(values).T):
        if there.any():
            filled[:, i] = np.interp(place, place[there], values[there, i])
    return filled


def stretches(moves: Booleans, bin_seconds: float, forces: Array | None = None) -> list[BinStretch]:
    """The bins as stretches that move or rest, those shorter than a blip joined to their like.

    Where `forces`, (k, 3), show that the IMU stands otherwise after a short motion, it fell over.
    """
    shortest = min(MIN_STRETCH_S / bin_seconds, 0.1 * len(moves))
    moves = moves.copy()
    for kind in (False, True):  # a pause within a motion first, then a knock within a rest
        for stretch in stretches_of(moves):
            inner = stretch.first > 0 and stretch.after < len(moves)
            short = stretch.after - stretch.first < shortest
            if stretch.moves is kind and inner and short and not (kind and _fell(stretch, forces)):
                moves[stretch.first : stretch.after] = not kind
    return stretches_of(moves)


def _fell(stretch: BinStretch, forces: Array | None) -> bool:
    """Whether gravity has another direction after a motion than before."""
    if forces is None:
        return False
    before = forces[max(stretch.first - BINS_BESIDE, 0) : stretch.first].mean(axis=0)
    after = forces[stretch.after : stretch.after + BINS_BESIDE].mean(axis=0)
    cosine = before @ after / (np.linalg.norm(before) * np.linalg.norm(after))
    return bool(cosine < np.cos(MAX_KNOCK_TILT))  # not where they are not recorded


def level_of_each_rest(
    found: Sequence[BinStretch], rates: Array, level: Array, noise: float
) -> Array:
    """What the gyros read at rest in each bin, (k, 3): that of all rests, or of its own rest.

    A bias that warms up is another one in each rest. Beside the level of all, such a rest would be
    above the noise from end to end, as a motion that ends slowly is at its end. So it has the level
    of its middle third, if by that fewer of its bins are off.

    Parameters
    ----------
    rates : (k, 3), rad/s, NaN where not recorded
    level : (3,), rad/s, of all rests; noise : rad/s, beyond which a bin is off
    """
    levels = np.tile(level, (len(rates), 1))
    for stretch in found:
        third = (stretch.after - stretch.first) // 3
        if stretch.moves or 3 * third < MIN_BINS_OF_A_REST:
            continue
        still = bridged(rates[stretch.first : stretch.after])
        own = np.median(still[third:-third], axis=0)
        by_all, by_own = (
            np.sum(np.linalg.norm(np.nan_to_num(still - each), axis=1) > noise)
            for each in (level, own)
        )
        if by_own < by_all:
            levels[stretch.first : stretch.after] = own
    return levels


def toggling(quantum: Array) -> Array:
    """What the mean of a bin may differ by for the counts alone, of steps (k,); NaN: none is known.

    The scatter of bins does not show it: where the noise is below a count most of them are alike.
    """
    return np.asarray(MAX_TOGGLING * np.nan_to_num(quantum))


def shaken_bins(found: list[BinStretch], forces: Array, quantum: Array) -> Booleans:
    """Which bins of still stretches differ from one beside them by more than others do, (k,).

    A hand that takes the IMU shakes the accelerometers before the gyros show that it turns.

    Parameters
    ----------
    forces : (k, 3), m/s², NaN where not recorded; quantum : (3,), m/s², their step, NaN: not known
    """
    shakes = np.zeros(len(forces), bool)
    for stretch in found:
        own = forces[stretch.first : stretch.after]
        if stretch.moves or len(own) < MIN_BINS_OF_A_REST or not np.isfinite(own).all():
            continue
        change = np.abs(np.diff(own, axis=0))
        scatter = MAD_TO_SIGMA * np.median(change, axis=0)
        least = np.maximum(MIN_MOTION_SIGMA * scatter, toggling(quantum))
        far = (change > least).any(axis=1) & (scatter > 0).all()
        shakes[stretch.first : stretch.after] = np.append(far, False) | np.append(False, far)
    return shakes


def with_slow_ends(
    found: list[BinStretch], above_noise: Booleans, bin_seconds: float, *, swings: bool
) -> list[BinStretch]:
    """The stretches, every motion with the bins beside it in which it begins and ends slowly.

    What is moved smoothly stands nearly still for a second, and not yet quite: such bins are above
    the noise without a break. No rest gives more than a quarter of itself at each end; on a table,
    which `swings` on for some seconds and turns back in short breaks, a third.
    """
    moves = np.repeat([s.moves for s in found], [s.after - s.first for s in found])
    seconds, pause_s = (MAX_SWING_S, MAX_PAUSE_S) if swings else (MAX_SLOW_END_S, 0.0)
    most, pause = round(seconds / bin_seconds), round(pause_s / bin_seconds)
    for stretch in found:
        length = min(most, (stretch.after - stretch.first) // (3 if swings else 4))
        if stretch.moves or not length:
            continue
        if stretch.first > 0:
            ahead = above_noise[stretch.first : stretch.first + length]
            moves[stretch.first : stretch.first + _length(ahead, pause)] = True
        if stretch.after < len(moves):
            behind = above_noise[stretch.after - length : stretch.after]
            moves[stretch.after - _length(behind[::-1], pause) : stretch.after] = True
    return stretches_of(moves)


def _length(true: Booleans, pause: int) -> int:
    """How many are true from the first on, with as many beside them as a break may have."""
    places = np.flatnonzero(true)
    broken = np.flatnonzero(np.diff(places, prepend=-1) > pause + 1)
    kept = places[: broken[0]] if len(broken) else places
    return int(kept[-1]) + 1 if len(kept) else 0


def slow_motion(
    rates: Array, bin_seconds: float, quantum: Array | float = 0.0
) -> tuple[int, int] | None:
    """The bins of a still stretch from the first in which it turns slowly to that behind the last.

    A table that is set a degree further takes seconds, below what counts as motion. It begins and
    ends at rest, and stands otherwise then, as no vibration and no drift of a bias does.

    Parameters
    ----------
    rates : (k, 3), rad/s, NaN where not recorded
    quantum : rad/s, the step of the gyros, (3,) or of each, NaN where it is not known
    """
    recorded = bridged(rates[:, np.isfinite(rates).any(axis=0)])
    if len(recorded) < 3 or not recorded.size:
        return None
    # A smooth motion bends little, however fast; the bends of noise have √6 times its scatter.
    bends = np.abs(np.diff(recorded, 2, axis=0))
    noise = MAD_TO_SIGMA * np.median(bends, axis=0) / np.sqrt(6)
    by_counts = float(np.linalg.norm(toggling(np.broadcast_to(quantum, 3))))
    least = max(MIN_MOTION_SIGMA * float(np.linalg.norm(noise)), by_counts)
    place = np.arange(len(recorded)) / (len(recorded) - 1)
    rests = np.abs(place - 0.5) > 0.5 - AT_ENDS
    for _ in range(LEVEL_ROUNDS):  # it may last as long as the rest
        away = recorded - np.median(recorded[rests], axis=0)
        above = np.linalg.norm(away, axis=1) > least
        if above.all():
            return None
        rests = ~above
    turning = [
        run
        for run in stretches_of(above)
        if run.moves
        and run.first > 0
        and run.after < len(rates)
        and np.linalg.norm(away[run.first : run.after].sum(axis=0)) * bin_seconds > MIN_SLOW_TURN
    ]
    return (turning[0].first, turning[-1].after) if turning else None


def stretches_of(moves: Booleans) -> list[BinStretch]:
    """Bins, (k,), as stretches that move or rest."""
    edges = [0, *(np.flatnonzero(np.diff(moves)) + 1).tolist(), len(moves)]
    return [
        BinStretch(bool(moves[first]), first, after)
        for first, after in pairwise(edges)
        if after > first
    ]


def steady_part(rate: Array) -> tuple[int, int]:
    """The bins [first, after) of one turn in which the table keeps its rate, and the gyro shows it.

    A low pass of the gyro, or the drive, settles behind the ramp: rate = plateau (1 - c exp(-t/τ)).
    From the ramp to where that is within the scatter of the bins about the plateau it takes some
    time: in as much time again it becomes less by that factor once more. Where it is within it at
    once, or never, nothing settles. A low pass that rounds a corner has the other ramp begin as
    gently. Where the ramps meet there is no such part: it is empty.

    Parameters
    ----------
    rate : (k,), rad/s about the axis of the turn, from start to stop
    """
    k = len(rate)
    middle = rate[k // 4 : max(k - k // 4, k // 4 + 1)]
    plateau = float(np.median(middle))
    share = np.abs(rate / plateau) if plateau else np.zeros(k)
    reached = np.flatnonzero(share > REACHED_SHARE)
    if len(reached) < 3:
        return 0, k
    rises = float(np.median(share[reached[0] : reached[-1] + 1])) > MAX_RISE
    if rises and np.quantile(share, 0.9) < 1 / MIN_MIDDLE_SHARE:
        return _short_plateau(np.abs(rate), abs(plateau))
    # One bin at each end may hold a part of the ramp.
    first, after = int(reached[0]) + 1, int(reached[-1])
    scatter = MAD_TO_SIGMA * float(np.median(np.abs(middle - plateau)))
    longest = int((after - first) * MAX_SETTLING_SHARE)
    near = np.abs(rate[first:after] - plateau) <= MAX_SETTLED * scatter
    return first + _unsettled(near, longest), after - _unsettled(near[::-1], longest)


def _unsettled(near: Booleans, longest: int) -> int:
    """The bins from a ramp to where all are near the plateau, and as many again."""
    bins = longest + SETTLED_BINS
    settled = np.convolve(near[:bins], np.ones(SETTLED_BINS), "valid") == SETTLED_BINS
    first = int(np.argmax(settled)) if settled.any() else 0
    return min(2 * first + (first > 0), longest)


def _short_plateau(speed: Array, level: float) -> tuple[int, int]:
    """The bins [first, after) of the rate between two long ramps; none where they meet.

    It is kept for clearly longer than a ramp takes through the same band of rates.

    Parameters
    ----------
    speed : (k,), rad/s, without its sign
    level : rad/s, that it exceeds in a quarter of the turn
    """
    for _ in range(PLATEAU_ROUNDS):
        level = float(np.median(speed[speed > REACHED_SHARE * level]))
    reached = np.flatnonzero(speed > REACHED_SHARE * level)
    # A ramp is straight: its second differences are those of the noise.
    scatter = MAD_TO_SIGMA * float(np.median(np.abs(np.diff(speed, n=2)))) / np.sqrt(6)
    band = max(MAX_SETTLED * scatter, MIN_PLATEAU_BAND * level)
    kept = [run for run in stretches_of(np.abs(speed - level) <= band) if run.moves]
    longest = max(kept, key=lambda run: run.after - run.first, default=BinStretch(True, 0, 0))
    crossing = 2 * band / level * max(int(reached[0]), 1)  # bins of a ramp within it
    if longest.after - longest.first >= max(SETTLED_BINS, MIN_PLATEAU_CROSSINGS * crossing):
        return longest.first, longest.after
    top = int(reached[0] + reached[-1] + 1) // 2
    return top, top


def stopped(rate: Array) -> int:
    """The bin from which a turn about its axis is over, however long the table swings on.

    `rate`: (k,), as of `steady_part`.
    """
    moves = np.flatnonzero(np.abs(rate) > MIN_TURN_SHARE * np.abs(np.median(rate)))
    return int(moves[-1]) + 1 if len(moves) else len(rate)
