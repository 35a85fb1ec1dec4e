"""What a rest shows of an IMU that does not quite stand still: tilts and jumps, by both sensors."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from inertial.arrays import Array, Booleans, Integers
from inertial.physics.motion import cross
from inertial.sensors import CHANNELS, COLUMNS
from inertial.signal.detector import Log, Piece
from inertial.signal.runs import readings_of, records_of_a_reading
from inertial.signal.scatter import MAD_TO_SIGMA, median
from inertial.signal.steps import MAX_SIDE_S, Step, steps

MIN_RECORDED_SHARE = 0.2  # of the records of a rest that a channel must be in
MAX_MASKED_SHARE = 0.01  # of the records of a rest: single readings that were left out
SIDE_S = 2.0  # s on each side of a place whose means are compared
MOTION_S = 0.15  # s on each side of a place that a sudden motion may take
# Times the usual change of readings: 10⁻¹⁶ a block of 10 in both sensors by chance
MIN_JERK_RATIO = 4.0
MAX_SHARE_SIGMA = 0.25  # largest sigma of the share of a motion that the other sensor confirms


@dataclass(frozen=True)
class Agreement:
    """How much of a motion that one sensor shows the other one shows too: share and its sigma.

    `knocked`: that cannot be said, for a gyro's readings were masked as a spike at the very place.
    """

    share: float
    sigma: float
    knocked: bool = False

    @property
    def conclusive(self) -> bool:
        """Whether the other sensor is precise enough to decide."""
        return self.sigma < MAX_SHARE_SIGMA

    @property
    def moved(self) -> bool:
        """Whether both sensors agree that the IMU moved, or one was knocked when it did."""
        return self.knocked or (self.conclusive and 0.5 < self.share < 1.5)


UNCONFIRMED = Agreement(0.0, np.inf)
KNOCKED = Agreement(0.0, np.inf, knocked=True)


class Resting:
    """The n records of a rest; where a channel has no reading of its own, it is interpolated.

    noise: (6,), of a reading; mean_noise: (6,), √n times that of the mean over n records, which
    is more where a reading is held over several; masked: (n,), where a gyro's reading is left out.

    When the case turns by a small angle φ, the force in its axes changes by f × φ. So the
    accelerometers show the two level components: φ = δf × u / g with u = f / g. About the
    vertical they are blind.
    """

    def __init__(self, piece: Piece, log: Log) -> None:
        n = len(piece)
        self.interval = log.interval
        self.values = np.full((n, 6), np.nan)
        self.noise = np.full(6, np.nan)
        self.records = np.repeat([records_of_a_reading(share) for share in log.held], 3)
        for i in range(6):
            there, read = readings_of(piece, log, i)
            if len(there) * self.records[i] > max(MIN_RECORDED_SHARE * n, 2):
                self.values[:, i] = np.interp(np.arange(n), there, read)
                scatter = MAD_TO_SIGMA / np.sqrt(2) * float(np.median(np.abs(np.diff(read))))
                self.noise[i] = max(scatter, float(np.nan_to_num(log.quantum[i])) / np.sqrt(12))
        self.mean_noise = self.noise * np.sqrt(self.records)
        gaps = np.isnan(piece.values[:, COLUMNS["gyro"]])
        self.masked: Booleans = np.asarray(
            gaps[:, gaps.mean(axis=0) < MAX_MASKED_SHARE].any(axis=1)
        )

    def __len__(self) -> int:
        return len(self.values)

    def recorded(self, sensor: str) -> bool:
        """Whether all three axes of a sensor are there."""
        return bool(np.isfinite(self.noise[COLUMNS[sensor]]).all())

    @cached_property
    def force(self) -> Array:
        """Specific force, (n, 3), m/s²."""
        return self.values[:, COLUMNS["accel"]]

    @cached_property
    def rate(self) -> Array:
        """Angular rate, (n, 3), rad/s."""
        return self.values[:, COLUMNS["gyro"]]

    @cached_property
    def up(self) -> Array:
        """The direction that points up, (3,)."""
        return np.asarray(self._mean_force / np.linalg.norm(self._mean_force))

    @cached_property
    def _mean_force(self) -> Array:
        return np.asarray(self.force.mean(axis=0))

    def tilt(self, change: Array) -> Array:
        """The level part of the turn, (…, 3), rad, that changes the force by `change`, m/s²."""
        return np.asarray(cross(change, self.up) / np.linalg.norm(self._mean_force))

    def level(self, turn: Array) -> Array:
        """A turn, (…, 3), without its part about the vertical."""
        return np.asarray(turn - np.multiply.outer(turn @ self.up, self.up))

    def tilt_noise(self, records: float) -> float:
        """Sigma of a tilt from means over so many records, rad."""
        level = np.sqrt(np.sum(self.mean_noise[:3] ** 2 * (1 - self.up**2)) / 2)
        return float(level / np.linalg.norm(self._mean_force) / np.sqrt(records))

    def shifted(self, start: int, first: int, after: int, stop: int) -> tuple[Array, Agreement]:
        """The tilt by which the force changes between the records `first` and `after`.

        With it, how much of it the gyros turned meanwhile. Nothing else happens from `start` to
        `stop`. A gyro whose bias changes, too, turned by an angle that depends on when it did.
        """
        side, beside = round(SIDE_S / self.interval), round(MOTION_S / self.interval)
        first, after = max(first - beside, start + 1), min(after + beside, stop - 1)
        earlier, later = (
            slice(max(first - side, start), first),
            slice(after, min(after + side, stop)),
        )
        tilt = self.tilt(self.force[later].mean(axis=0) - self.force[earlier].mean(axis=0))
        size = float(np.linalg.norm(tilt))
        if not (self.recorded("gyro") and size > 0):
            return tilt, UNCONFIRMED
        if self.masked[first:after].any():
            return tilt, KNOCKED
        rates = [self.rate[own].mean(axis=0) for own in (earlier, later)]
        turned = (self.rate[first:after] - np.mean(rates, axis=0)).sum(axis=0) * self.interval
        by_rate = float(np.max(self.mean_noise[3:])) * self.interval * np.sqrt(after - first)
        seconds = (after - first) * self.interval
        by_change = float(np.linalg.norm(rates[1] - rates[0])) * seconds / np.sqrt(12)
        shortest = min(first - earlier.start, later.stop - after)
        sigma = float(np.linalg.norm([by_rate, by_change, self.tilt_noise(shortest / 2)]))
        return tilt, Agreement(float(turned @ tilt) / size**2, sigma / size)

    def speeded(self, start: int, place: int, stop: int) -> Agreement:
        """How much of a change of rate at a place the accelerometers show as a tilt that grows.

        Nothing else happens from `start` to `stop`.
        """
        if not self.recorded("accel"):
            return UNCONFIRMED
        jump = self.rate[place:stop].mean(axis=0) - self.rate[start:place].mean(axis=0)
        level = self.level(jump)
        size = float(np.linalg.norm(level))
        # A turn about an axis near the vertical hardly tilts.
        if size < 0.5 * float(np.linalg.norm(jump)):
            return UNCONFIRMED
        time = (np.arange(start, stop) - place) * self.interval
        design = np.column_stack([np.ones(len(time)), time, np.maximum(time, 0.0)])
        inverse = np.linalg.pinv(design)
        kink = self.tilt(inverse[2] @ self.force[start:stop])
        sigma = self.tilt_noise(1) * float(np.linalg.norm(inverse[2]))
        return Agreement(float(kink @ level) / size**2, sigma / size)

    def shaken(self, length: int, sensors: Sequence[str] = ("accel", "gyro")) -> Booleans:
        """Which blocks of so many records jerk in all these sensors: k = n // length, (k,).

        By the median of the changes from reading to reading, which no spike moves.
        """
        k = len(self) // length
        both = np.ones(k, bool)
        for sensor in sensors:
            own = np.flatnonzero(np.isfinite(self.noise[COLUMNS[sensor]])) + COLUMNS[sensor].start
            # Between two readings a part of their change is in each record.
            change = np.abs(np.diff(self.values[: k * length, own], axis=0)) * self.records[own]
            change = np.concatenate([change, change[-1:]]).reshape(k, length, len(own))
            usual = self.noise[own] * np.sqrt(2) / MAD_TO_SIGMA
            both &= (median(change, axis=1) > MIN_JERK_RATIO * usual).any(axis=1)
        return both


# ---- Channels that jump within a rest, and whether the IMU was moved then.

FALSE_ALARM_LEVEL = 1e-4  # accepted for one false jump in a campaign
CAMPAIGN_RESTS = 50  # of a campaign that pays for the search in each; a rest has six channels
SHAKE_BLOCK_S = 0.1  # s of a block in which a knock is sought
MIN_BLOCK_READINGS = 5  # of a sensor, in such a block
# Sigmas by which two level axes must jump for a tilt, where no gyro confirms it
MIN_TILT_SIGMA = 5.0


@dataclass(frozen=True)
class Jump:
    """A step of one channel of a rest, and how far the other sensor confirms a motion."""

    channel: int
    step: Step
    agreement: Agreement
    moved: bool


@lru_cache(maxsize=1)  # two detectors use it, one rest after another
def jumps(piece: Piece, log: Log) -> tuple[Resting, list[Jump]]:
    """A rest, and all its jumps, channel by channel."""
    resting = Resting(piece, log)
    if not np.isfinite(log.interval):
        return resting, []
    all_steps: list[tuple[int, Step]] = []
    for i in range(len(CHANNELS)):
        there, read = readings_of(piece, log, i)
        if not np.isfinite(resting.noise[i]):
            continue
        interval = log.interval * len(piece) / len(there)
        level = FALSE_ALARM_LEVEL / (CAMPAIGN_RESTS * len(CHANNELS))
        for step in steps(read, interval, float(np.nan_to_num(log.quantum[i])), level):
            all_steps.append((i, _in_records(step, there)))
    knocked = np.repeat(shaken(resting), _length(resting))
    all_steps = [
        (i, step) for i, step in all_steps if not knocked[step.place - 1 : step.place + 1].any()
    ]
    return resting, [_judged(i, step, all_steps, resting) for i, step in all_steps]


def shaken(resting: Resting) -> Booleans:
    """Which blocks of 0.1 s, or longer ones of five readings, jerk in both sensors, (k,)."""
    return resting.shaken(_length(resting))


def quiet_force(resting: Resting) -> Array:
    """The specific force, (n, 3), NaN in the blocks in which it jerks, and in those beside them."""
    length, force = _length(resting), resting.force.copy()
    jerks = resting.shaken(length, ("accel",))
    jerks = jerks | np.append(jerks[1:], False) | np.append(False, jerks[:-1])
    force[: len(jerks) * length][np.repeat(jerks, length)] = np.nan
    return force


def _length(resting: Resting) -> int:
    readings = MIN_BLOCK_READINGS * float(resting.records.max())
    return max(round(SHAKE_BLOCK_S / resting.interval), round(readings))


def _in_records(step: Step, there: Integers) -> Step:
    p_value = min(step.p_value * CAMPAIGN_RESTS * len(CHANNELS), 1.0)
    place, earliest, latest = there[[step.place, step.earliest, step.latest]].tolist()
    return replace(step, place=place, earliest=earliest, latest=latest, p_value=p_value)


def _judged(i: int, step: Step, all_steps: list[tuple[int, Step]], resting: Resting) -> Jump:
    """A jump with the agreement of the other sensor, between the other jumps of the same sensor."""
    if not resting.recorded("accel"):
        return Jump(i, step, UNCONFIRMED, False)
    same = [other for j, other in all_steps if (j < 3) == (i < 3)]
    longest = round(MAX_SIDE_S / resting.interval)
    earlier = [other.latest for other in same if other.latest < step.earliest]
    later = [other.earliest for other in same if other.earliest > step.latest]
    start = max([0, step.place - longest, *earlier])
    stop = min([len(resting), step.place + longest, *later])
    if i >= 3:
        agreement = resting.speeded(start, step.place, stop)
        return Jump(i, step, agreement, agreement.moved)
    _, agreement = resting.shifted(start, step.earliest, step.latest, stop)
    if agreement.conclusive or agreement.knocked:
        return Jump(i, step, agreement, agreement.moved)
    # Without a gyro that confirms it: a jump of one axis is a bias, of both level axes a tilt.
    others = [
        other for j, other in all_steps if j < 3 and j != i and abs(other.place - step.place) <= 2
    ]
    level = [j for j in range(3) if abs(resting.up[j]) < 0.5]
    both = i in level and any(abs(other.size) > MIN_TILT_SIGMA * other.sigma for other in others)
    return Jump(i, step, agreement, both)
