"""Readings of a triad that are a signed permutation of themselves."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import permutations, product

import numpy as np
from scipy.spatial.transform import Rotation

from inertial.arrays import Array, Integers, nearest_axis
from inertial.physics.motion import cross
from inertial.sensors import COLUMNS, SINGULAR
from inertial.signal.detector import Description, Event, Log, Piece, Windows, read_in
from inertial.signal.scatter import MAD_TO_SIGMA
from inertial.text.messages import _
from inertial.text.numbers import significant, whole
from inertial.text.parameters import AXES

SIDE_READINGS = 5  # readings on each side that are compared: the shortest exchange
SCATTER_READINGS = 32  # readings on each side by which their scatter is had
# Times the largest change among those: what no motion does from reading to reading
MIN_CHANGE_RATIO = 5.0
MAX_OTHER_JUMPS = 3  # in a piece of a log, beside an exchange
MIN_JUMP_SIGMA = 12.0  # sigma of the jump, by which it must be more than noise
MAX_FIT_SIGMA = 5.0  # sigma by which the readings after it may differ from the permuted ones before
MAX_INTERVALS = 1.5  # median intervals: readings farther apart are not compared
MAX_TURNED_SHARE = 0.25  # of the jump: what the IMU may have turned meanwhile, by its gyros


@dataclass(frozen=True)
class Permutation:
    """After it axis i reads signs[i] × what axis sources[i] read before."""

    sources: tuple[int, ...]
    signs: tuple[int, ...]

    @property
    def moved(self) -> int:
        """How many axes read something else than before."""
        return int(sum(self.changed))

    @property
    def changed(self) -> list[bool]:
        """Which axes these are, (3,)."""
        both = zip(self.sources, self.signs, strict=True)
        return [pair != (i, 1) for i, pair in enumerate(both)]

    @property
    def in_words(self) -> str:
        """In words: x reads z and z reads −x."""
        both = zip(self.sources, self.signs, strict=True)
        reads = [f"{'' if sign > 0 else '−'}{AXES[source]}" for source, sign in both]
        return _(" and ").join(
            _("{axes} reads {reads}", axes=AXES[i], reads=reads[i])
            for i in range(3)
            if self.changed[i]
        )

    @property
    def in_place(self) -> bool:
        """Whether only signs are turned."""
        return self.sources == (0, 1, 2)

    @property
    def inverse(self) -> "Permutation":
        """What takes it back."""
        back = tuple(self.sources.index(i) for i in range(3))
        return Permutation(back, tuple(self.signs[i] for i in back))

    def of(self, vector: Array) -> Array:
        """The vector (3,) as it reads afterwards."""
        return np.array(self.signs) * vector[list(self.sources)]


AS_NAMED = Permutation((0, 1, 2), (1, 1, 1))


def composed(second: Permutation, first: Permutation) -> Permutation:
    """One permutation after another."""
    sources = tuple(first.sources[i] for i in second.sources)
    signs = (sign * first.signs[i] for sign, i in zip(second.signs, second.sources, strict=True))
    return Permutation(sources, tuple(signs))


def simplicity(permutation: Permutation) -> tuple[int, int]:
    """How many axes it moves, and how many signs it turns: the fewer, the likelier."""
    return permutation.moved, permutation.signs.count(-1)


# The simplest first: one sign, two axes, then what is left.
PERMUTATIONS = sorted(
    (
        Permutation(sources, signs)
        for sources in permutations(range(3))
        for signs in product((1, -1), repeat=3)
        if (sources, signs) != ((0, 1, 2), (1, 1, 1))
    ),
    key=simplicity,
)


@dataclass(frozen=True)
class Exchange:
    """Places [start, end) of a piece, exchanged; before, after: (3,), readings beside its start.

    lasting: to the end of what is seen; with_it: the same of the other sensor, at the same time.
    earlier: gravity shows that what was read before it is wrong, and not what is read from it on.
    """

    start: int
    end: int
    permutation: Permutation
    before: Array
    after: Array
    lasting: bool
    with_it: Permutation | None = None
    earlier: bool = False

    def event(self, piece: Piece, log: Log, sensor: str) -> Event:
        """It as an event, to the end of the log if its end is not seen in this piece.

        It concerns the axis, or the sensor, alone unless the other one changes with it.
        """
        event = piece.event(self.start, self.end, float(self.end - self.start), facts=self)
        if self.with_it is None and self.permutation.moved == 1:
            axis = self.permutation.changed.index(True)
            event = replace(event, channel=COLUMNS[sensor].start + axis)
        elif self.with_it is None:
            event = replace(event, sensor=sensor)
        if self.earlier:
            begin, end = float(log.windows.time[0]), float(piece.time[self.start - 1])
            number = float(event.first)
            return replace(event, first=0, after=event.first, from_s=begin, to_s=end, size=number)
        if not self.lasting or piece.after == len(piece):
            return event
        number = float(log.records - event.first)
        return replace(event, after=log.records, to_s=float(log.windows.time[-1]), size=number)


def describe_exchange(event: Event, name: str, sensor: str) -> Description:
    """An exchange in words."""
    exchange: Exchange = event.facts
    what = SINGULAR[sensor]
    scale, unit = read_in(COLUMNS[sensor].start)
    other = (
        _(" So do those of the gyros: {in_words}.", in_words=exchange.with_it.in_words)
        if exchange.with_it
        else ""
    )
    worst = int(np.argmax(np.abs(exchange.after - exchange.before)))
    before, after = (
        significant(scale * float(part[worst]), 5) for part in (exchange.before, exchange.after)
    )
    if exchange.earlier:
        return Description(
            _(
                "{name}: before line {line}, for {size} records, the axes of the {what}s differ "
                "from those of the records from there on: {in_words}. No motion does that from "
                "one record to the next; and only from there on do the gyros turn gravity as the "
                "accelerometers see it turn.",
                name=name,
                line=event.line,
                size=whole(event.size),
                what=what,
                in_words=exchange.permutation.in_words,
            ),
            _(
                "Used, their mean on {axes} would be {before} in place of {after} {unit}: bias, "
                "scale factor and cross terms would be wrong.",
                axes=AXES[worst],
                after=after,
                before=before,
                unit=unit,
            ),
            _("These records are masked. Turn the sign in the log, and run it again."),
        )
    return Description(
        _(
            "{name}: from line {line} on, {value}for {size} records, the axes of the "
            "{what}s differ from those of the records before: {in_words}.{other} No motion "
            "does that from one record to the next.",
            name=name,
            line=event.line,
            value=_("to the end, ") if exchange.lasting else "",
            size=whole(event.size),
            what=what,
            in_words=exchange.permutation.in_words,
            other=other,
        ),
        _(
            "Used, their mean on {axes} would be {after} in place of {before} {unit}: bias, "
            "scale factor and cross terms would be wrong.",
            axes=AXES[worst],
            after=after,
            before=before,
            unit=unit,
        ),
        _(
            "These records are masked. Find out which order and signs of the axes are "
            "right, and whether the records before are."
        ),
    )


@lru_cache(maxsize=2)  # of both sensors, for the detectors of swaps and of signs
def exchanges_of(piece: Piece, log: Log, sensor: str) -> list[Exchange]:
    """The exchanges of a sensor; with those of the accelerometers what the gyros do with them.

    Where both change the records are masked as a whole, so that no later detector finds it again.
    """
    own = _exchanges(piece, log, sensor)
    others = _exchanges(piece, log, "gyro") if own and sensor == "accel" else []
    made = []
    for exchange in own:
        alike = [o for o in others if o.start < exchange.end and exchange.start < o.end]
        if alike:
            exchange = replace(exchange, with_it=alike[0].permutation)
        elif exchange.lasting and exchange.permutation.in_place:
            signs = np.ones(6)
            signs[COLUMNS[sensor]] = exchange.permutation.signs
            change_s = float(piece.time[exchange.start])
            earlier = reversed_before(log.windows, change_s, signs)
            exchange = replace(exchange, earlier=earlier)
        made.append(exchange)
    return made


def _exchanges(piece: Piece, log: Log, sensor: str) -> Sequence[Exchange]:
    """The exchanges in a piece of a log, in their order.

    None where readings jump so at other places too, as by hand, or where rests were joined without
    what lay between them: one that fits is then by chance.
    """
    found: list[Exchange] = []
    others = 0  # jumps that no exchange explains, nor its end
    triad = piece.values[:, COLUMNS[sensor]]
    places = np.flatnonzero(np.isfinite(triad).all(axis=1))
    values = triad[places]
    if len(values) < 2 * SIDE_READINGS:
        return found
    smallest = np.nan_to_num(log.quantum[COLUMNS[sensor]])
    open_: tuple[int, Array, Array, list[Permutation]] | None = None
    for k in _sudden(values, smallest):
        if _broken(piece, log, places, k):
            continue
        before, after, sigma = _beside(values, k, smallest)
        fitting = [p for p in PERMUTATIONS if _fits(p, before, after, sigma)]
        others += not fitting
        if not fitting or (sensor == "accel" and _moved(piece, log, places, k, before, after)):
            continue
        if _struck(piece, log, int(places[k]), "gyro" if sensor == "accel" else "accel"):
            continue
        if open_ is None:
            open_ = k, before, after, fitting
            continue
        start, earlier, later, possible = open_
        back = [p for p in possible if p.inverse in fitting]
        if back:
            until = int(places[k])
            found.append(Exchange(int(places[start]), until, back[0], earlier, later, False))
            open_ = None
        others += not back
    if open_ is not None:
        start, earlier, later, possible = open_
        end = len(piece)
        found.append(Exchange(int(places[start]), end, possible[0], earlier, later, True))
    return found if others <= MAX_OTHER_JUMPS else []


def _sudden(values: Array, smallest: Array) -> list[int]:
    """Places whose reading is misfit from the one before by more than others beside them are."""
    change = np.abs(np.diff(values, axis=0))
    side = SIDE_READINGS - 1
    largest = change[: len(change) - side + 1].copy()  # of each change and those that follow
    for shift in range(1, side):
        np.maximum(largest, change[shift : len(change) - side + 1 + shift], out=largest)
    inside = len(change) - 2 * side
    beside = np.maximum(largest[:inside], largest[side + 1 : side + 1 + inside])
    sudden = change[side : side + inside] > MIN_CHANGE_RATIO * np.maximum(beside, smallest)
    places: list[int] = (np.flatnonzero(sudden.any(axis=1)) + side + 1).tolist()
    return places


def _broken(piece: Piece, log: Log, places: Integers, k: int) -> bool:
    """Whether something is missing between these readings, so that the IMU may have been moved."""
    between = piece.time[places[k]] - piece.time[places[k - 1]]
    return bool(between > MAX_INTERVALS * log.interval)


def _beside(values: Array, k: int, smallest: Array) -> tuple[Array, Array, Array]:
    """The readings before and after, at the instant between them, and the sigma of each, (3,).

    Two straight lines through 5 readings each, continued by half an interval. The scatter is that
    about the lines, but at least that from reading to reading around, and half a count.
    """
    time = np.arange(SIDE_READINGS) - (SIDE_READINGS - 1) / 2
    parts = values[k - SIDE_READINGS : k], values[k : k + SIDE_READINGS]
    slopes = [time @ part / (time @ time) for part in parts]
    left = [
        part - part.mean(axis=0) - np.outer(time, slope)
        for part, slope in zip(parts, slopes, strict=True)
    ]
    about = np.sqrt(sum((part**2).sum(axis=0) for part in left) / (2 * SIDE_READINGS - 4))
    changes = np.abs(np.diff(values[max(k - SCATTER_READINGS, 0) : k + SCATTER_READINGS], axis=0))
    scatter = np.maximum(about, MAD_TO_SIGMA / np.sqrt(2) * np.median(changes, axis=0))
    before = parts[0].mean(axis=0) + slopes[0] * SIDE_READINGS / 2
    after = parts[1].mean(axis=0) - slopes[1] * SIDE_READINGS / 2
    share = np.sqrt(1 / SIDE_READINGS + (SIDE_READINGS / 2) ** 2 / (time @ time))
    return before, after, share * np.maximum(scatter, smallest / 2)


def _fits(permutation: Permutation, before: Array, after: Array, sigma: Array) -> bool:
    """Whether it makes the readings before to those after, and makes a difference."""
    both = np.hypot(sigma, sigma[list(permutation.sources)])
    alike = np.abs(after - permutation.of(before)) <= MAX_FIT_SIGMA * both
    apart = np.abs(permutation.of(before) - before) > MIN_JUMP_SIGMA * both
    return bool(alike.all() and apart[permutation.changed].all())


def _struck(piece: Piece, log: Log, place: int, other: str) -> bool:
    """Whether the other sensor jumps beside this place as well: a blow moves both, a driver none.

    Where its axes are exchanged at the same record, that jump is none.
    """
    first = max(place - SCATTER_READINGS, 0)
    values = piece.values[first : place + SCATTER_READINGS, COLUMNS[other]]
    there = np.flatnonzero(np.isfinite(values).all(axis=1))
    values, at = values[there], int(np.searchsorted(there, place - first))
    if min(at, len(values) - at) < SIDE_READINGS:
        return False
    smallest = np.nan_to_num(log.quantum[COLUMNS[other]])
    changes = np.abs(np.diff(values, axis=0))
    scatter = np.maximum(MAD_TO_SIGMA * np.median(changes, axis=0), smallest)
    jumps = np.asarray((changes > MIN_JUMP_SIGMA * scatter).any(axis=1))
    before, after, sigma = _beside(values, at, smallest)
    jumps[at - 1] &= not any(_fits(p, before, after, sigma) for p in PERMUTATIONS)
    return bool(jumps[at - SIDE_READINGS : at + SIDE_READINGS - 1].any())


def _moved(piece: Piece, log: Log, places: Integers, k: int, before: Array, after: Array) -> bool:
    """Whether a motion of the IMU explains part of the change, by the gyros.

    A turn does, df/dt = −ω × f; or a ramp that begins or ends here, by the lever arm.
    """
    rates = piece.values[
        places[k - SIDE_READINGS] : places[k + SIDE_READINGS - 1] + 1, COLUMNS["gyro"]
    ]
    known = rates[np.isfinite(rates).all(axis=1)]
    if not len(known) or not np.isfinite(log.interval):
        return False
    turned = cross(known.mean(axis=0), before) * log.interval
    if np.linalg.norm(turned) > MAX_TURNED_SHARE * np.abs(after - before).max():
        return True
    return _accelerated(piece, places, k, np.nan_to_num(log.quantum[COLUMNS["gyro"]]))


def _accelerated(piece: Piece, places: Integers, k: int, smallest: Array) -> bool:
    """Whether the slope of any gyro's readings changes between two of them."""
    slopes, variances = [], []
    for part in (places[max(k - SCATTER_READINGS, 0) : k], places[k : k + SCATTER_READINGS]):
        rates = piece.values[part, COLUMNS["gyro"]]
        rates = rates[np.isfinite(rates).all(axis=1)]
        if len(rates) < SIDE_READINGS:
            return False
        time = np.arange(len(rates)) - (len(rates) - 1) / 2
        slope = time @ rates / (time @ time)
        off = rates - rates.mean(axis=0) - np.outer(time, slope)
        scatter = np.maximum((off**2).sum(axis=0) / (len(rates) - 2), smallest**2 / 12)
        slopes.append(slope)
        variances.append(scatter / (time @ time))
    change = np.abs(slopes[1] - slopes[0])
    return bool((change > MAX_FIT_SIGMA * np.sqrt(variances[0] + variances[1])).any())


# How far an IMU may be mounted from the planned direction
MIN_MOUNTING_COSINE = float(np.cos(np.radians(25)))
MIN_MISFIT_RATIO = 3.0  # times as far from what was expected, for the other explanation to be wrong


def read_as_other_axes(force: Array, up: Array, forces: Array, ups: Array) -> Permutation | None:
    """The permutation that a rest was read with, if that and no other attitude explains it.

    Every accelerometer has its own bias and scale factor, and the triad its own mounting: what
    the other rests read, forces = A [ups; 1], predicts the three readings of this one, either in
    the planned attitude with the axes exchanged, or as read with another axis up. None where the
    two differ too little, as by hand, or where the other rests are too few.

    Parameters
    ----------
    force : (3,), m/s², mean of the rest in question
    up : (3,), what was planned to point up in it
    forces, ups : (k, 3), the same of rests that agree with the plan
    """
    design = np.column_stack([ups, np.ones(len(ups))])
    if np.linalg.matrix_rank(design, tol=0.1) < 4:
        return None
    response = np.linalg.lstsq(design, forces, rcond=None)[0].T
    predicted = response @ np.append(up, 1.0)
    misfit: dict[Permutation, float] = {}
    for permutation in PERMUTATIONS:
        straight = permutation.of(force)
        if float(straight @ up) > MIN_MOUNTING_COSINE * float(np.linalg.norm(force)):
            misfit[permutation] = float(np.linalg.norm(straight - predicted))
    if not misfit:
        return None
    axis = nearest_axis(force)
    actual_up = np.sign(force[axis]) * np.eye(3)[axis]
    attitude_misfit = float(np.linalg.norm(force - response @ np.append(actual_up, 1.0)))
    best = min(misfit, key=lambda permutation: misfit[permutation])
    return best if MIN_MISFIT_RATIO * misfit[best] < attitude_misfit else None


# ---- On which side of a lasting change of sign the readings are reversed, by gravity.
#
# From one mean over 1 s to the next the force turns as the gyros say, f' = R(ω T)ᵀ f; with the sign
# of an axis turned, of either sensor, a turn of gravity comes out elsewhere. So the windows before
# and after the change tell, by which of both fits, which side is as named. A turn about the
# vertical, and a rest, tell nothing. Biases and the earth's rate are small beside the turns of a
# table.


MIN_APART = 0.1  # of the force, by which one reading of a turn must miss it: some 6°
MIN_TELLING = 3  # windows
MIN_AGREEING = 0.9  # of those that tell: else the readings change more than once


def reversed_before(windows: Windows, change_s: float, signs: Array) -> bool:
    """Whether gravity shows the readings before the change, and not those after it, as reversed.

    Parameters
    ----------
    change_s : s, its time; signs : (6,), of the readings on one side of it, if the other's are +1
    """
    time = windows.time
    if len(time) < 2 or not np.isfinite(change_s):
        return False
    interval = np.diff(time)
    near = interval < MAX_INTERVALS * np.median(interval)
    named, turned = (_misfit(windows.mean * by, interval) for by in (np.ones(6), signs))
    size = np.linalg.norm(windows.mean[1:, :3], axis=1)
    with np.errstate(invalid="ignore"):  # not recorded: tells nothing
        as_named = near & (turned > MIN_APART * size) & (turned > MIN_MISFIT_RATIO * named)
        as_turned = near & (named > MIN_APART * size) & (named > MIN_MISFIT_RATIO * turned)
    before, after = time[1:] < change_s, time[:-1] > change_s
    agreeing = np.sum(before & as_turned) + np.sum(after & as_named)
    telling = agreeing + np.sum(before & as_named) + np.sum(after & as_turned)
    return bool(telling >= MIN_TELLING and agreeing >= MIN_AGREEING * telling)


def _misfit(means: Array, interval: Array) -> Array:
    """How far each mean force is from where the gyros turn the one before, m/s², (k − 1,)."""
    forces, rates = means[:, :3], (means[1:, 3:] + means[:-1, 3:]) / 2
    misfit = np.full(len(interval), np.nan)
    there = np.asarray(np.isfinite(means).all(axis=1))
    both = there[1:] & there[:-1]
    turned = Rotation.from_rotvec(-rates[both] * interval[both, None]).apply(forces[:-1][both])
    misfit[both] = np.linalg.norm(forces[1:][both] - turned, axis=1)
    return misfit
