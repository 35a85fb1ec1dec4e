"""Interval, resolution and noise of every log, known before its records are examined singly."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from inertial.arrays import Array, Booleans
from inertial.campaign.masked_samples import Batch, regular
from inertial.campaign.records import Row, clocks_of, known_of, rows_of
from inertial.campaign.sums import SumsOver
from inertial.physics.site import normal_gravity
from inertial.signal.detector import Given, Log, Windows
from inertial.signal.scatter import MAD_TO_SIGMA, MIN_RELATIVE_STEP, median
from inertial.tables import CHANNEL_PARTS, CHANNEL_STATISTICS, CHANNELS

MAX_READINGS = 1 << 16  # of a batch, from which its noise and smallest step are taken
WINDOW = 1.0  # s
MIN_COMMON_LOGS = 3  # logs that can have an interval in common
HELD_WINDOW = 256  # records
MIN_HELD_SHARE = 0.1  # of the records of nine in ten windows
MAX_HELD_TIMES = 20.0  # the median of how long a reading is held: what stands still is longer
MAX_EQUAL_ALONE = 0.3  # share of an axis of other records: its counts are not coarse
# Readings that are less than twice a threshold while none is below it but 0: of a density that
# does not change about zero they would have the chance 2^-32
MIN_BESIDE_THRESHOLD = 32
MIN_THRESHOLD_STEPS = 20.0  # smallest steps of the channel; of one that is coarse 0 is a count
MIN_BEYOND_THRESHOLD = 10.0  # times the threshold, that the channel reads elsewhere


@dataclass(frozen=True, eq=False)
class Stated:
    """What the campaign states of all its logs, and what is known of each before it is read.

    given : of all logs
    earth_rate_up : the upward component of the earth's rate at the site, rad/s
    clocks, ranges, imu_types : tables; of each log the type of IMU in its messages
    angle_sigma, rate_sigma : of the angle of a turn, rad, and of its rate, relative; the latter
        NaN where it is not stated
    heading : rad, azimuth of the table's zero mark, None where it is not known
    """

    given: Given
    earth_rate_up: float
    clocks: pd.DataFrame
    ranges: pd.DataFrame
    imu_types: pd.DataFrame
    angle_sigma: float
    rate_sigma: float
    heading: float | None = None

    def logs(
        self, statistics: pd.DataFrame, windows: Mapping[str, Windows] | None = None
    ) -> dict[str, Log]:
        """Every log that has records, by name; `windows`: means over 1 s, by log."""
        tables = self.clocks, self.ranges, self.imu_types
        return logs(statistics, *tables, self.given, windows or {})

    @property
    def means_of_known_noise(self) -> set[str]:
        """The logs of means without time of which the noise is stated, or seen in residuals."""
        return set(self.ranges.loc[self.ranges["sigma"].notna(), "log"])


def stated_by(
    campaign: pd.DataFrame,
    known: pd.DataFrame,
    count_sizes: pd.DataFrame,
    clocks: pd.DataFrame,
    ranges: pd.DataFrame,
    imu_types: pd.DataFrame,
    gravity_repairs: pd.DataFrame,
) -> Stated:
    """From the tables of plan and decode."""
    given = given_by(campaign, known, count_sizes, clocks, gravity_repairs)
    quantities = known_of(known)
    up, sigma = quantities["earth_rate_up"].number, quantities["turn_angle"].scatter
    assumed = known.set_index("quantity")["assumed"]["turn_rate"]
    rate_sigma = np.nan if assumed else quantities["turn_rate"].scatter
    heading = quantities["heading"].value
    return Stated(given, up, clocks, ranges, imu_types, sigma, rate_sigma, heading)


def given_by(
    campaign: pd.DataFrame,
    known: pd.DataFrame,
    count_sizes: pd.DataFrame,
    clocks: pd.DataFrame,
    gravity_repairs: pd.DataFrame,
) -> Given:
    """What the campaign states of all its logs, and which interval they have in common."""
    (facts,) = rows_of(campaign)
    quantities = known_of(known)
    sizes: dict[str, dict[str, float]] = {}
    for row in rows_of(count_sizes):
        sizes.setdefault(row["instrument"], {})[row["sensor"]] = row["count_size"]
    latitude = facts["latitude"]
    return Given(
        gravity=quantities["gravity"].number,
        normal_gravity=np.nan
        if latitude is None
        else normal_gravity(latitude, facts["height"] or 0.0),
        refuted_gravity=float(gravity_repairs["stated"].iloc[0])
        if len(gravity_repairs)
        else np.nan,
        interval=1 / facts["rate"] if facts["rate"] else np.nan,
        instrument=facts["instrument"],
        date=facts["date"],
        must_be_set=facts["must_be_set"],
        must_be_clear=facts["must_be_clear"],
        count_sizes={
            name: (size["accel"], size["gyro"]) for name, size in sizes.items() if len(size) == 2
        },
        position_sigma=quantities["position"].scatter,
        **_in_common([clock.interval for clock in clocks_of(clocks).values() if clock.interval]),
    )


def _in_common(intervals: list[float]) -> dict[str, Any]:
    """The interval of most logs, and the scatter of the others about it, as a sigma."""
    if len(intervals) < MIN_COMMON_LOGS:
        return {}
    usual = np.median(intervals)
    distance = np.abs(np.array(intervals) / usual - 1)
    return {"usual_interval": float(usual), "unlike": MAD_TO_SIGMA * float(np.median(distance))}


class ChannelStatistics:
    """Resolution, noise and extremes of the channels of each log."""

    columns = CHANNELS

    def __init__(self) -> None:
        self._by_log: dict[str, _Channels] = {}

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        self._by_log.setdefault(batch.log, _Channels()).add(batch.readings)

    @property
    def still(self) -> bool:
        """Whether a log has long stretches in which no channel changes."""
        return any(channels.still for channels in self._by_log.values())

    def table(self) -> pd.DataFrame:
        """The table of these statistics, a row for each channel of each log."""
        thresholds = _thresholds([*self._by_log.values()])
        frames = [
            pd.DataFrame(
                {
                    "log": log,
                    "sensor": [sensor for sensor, _axis in CHANNEL_PARTS.values()],
                    "axis": [axis for _sensor, axis in CHANNEL_PARTS.values()],
                    "resolution": channels.resolution,
                    "noise": channels.median_noise(),
                    "unchanged_share": channels.unchanged / np.maximum(channels.pairs, 1),
                    "held_share": np.repeat(channels.held_share(), 3),
                    "smallest": channels.smallest,
                    "largest": channels.largest,
                    "threshold": thresholds,
                }
            )
            for log, channels in self._by_log.items()
        ]
        return pd.concat(frames) if frames else CHANNEL_STATISTICS.empty()


class _Channels:
    """What is summed up of the channels of one log, (6,) each."""

    def __init__(self) -> None:
        self.pairs, self.unchanged = np.zeros(6), np.zeros(6)
        self.smallest, self.largest = np.full(6, np.nan), np.full(6, np.nan)
        self.resolution = np.full(6, np.nan)
        self.zeros = np.zeros(6)
        # Of either sign, the magnitudes nearest to zero beside 0, ascending
        self.nearest = [[np.empty(0), np.empty(0)] for _ in range(6)]
        self.noise: list[Array] = []
        self.noise_of_new: list[Array] = []  # without the records that hold a sensor's readings
        self.held = np.zeros(2)  # records, by sensor
        self.stood = np.zeros(2)  # those that hold a reading for too long to be a slower sensor's
        self.windows: tuple[list[Array], list[Array]] = [], []  # shares that repeat a reading
        self.windows_in_use: tuple[list[Array], list[Array]] = [], []  # without those that stood

    @property
    def still(self) -> bool:
        """Whether no channel changes in some window, though channels do elsewhere."""
        if not (self.smallest < self.largest).any():
            return False
        shares = [np.concatenate(own) for own in self.windows if own]
        if len({len(own) for own in shares}) != 1:
            return False  # the sensors come in rows of their own
        return bool((np.minimum.reduce(shares) == 1).any())

    def add(self, readings: Array) -> None:
        """Take in the next readings, (n, 6)."""
        noise, of_new = np.full(6, np.nan), np.full(6, np.nan)
        for sensor in range(2):
            steps: dict[int, Array] = {}
            at_zero: list[Booleans] = []
            for i in range(3 * sensor, 3 * sensor + 3):
                channel = np.ascontiguousarray(readings[:, i])
                read = channel[np.isfinite(channel)]
                if len(read) >= 2:
                    steps[i] = np.abs(np.diff(read))
                    at_zero.append(read[1:] == 0)
                    self._add(i, read, steps[i])
                    noise[i] = _noise(steps[i])
            new = self._add_held(sensor, [*steps.values()], at_zero)
            for i, step in steps.items():
                of_new[i] = noise[i] if new is None else _noise(step[new])
        self.noise.append(noise)
        self.noise_of_new.append(of_new)

    def _add(self, i: int, read: Array, change: Array) -> None:
        smallest, largest = read.min(), read.max()
        self.smallest[i] = np.fmin(self.smallest[i], smallest)
        self.largest[i] = np.fmax(self.largest[i], largest)
        self.pairs[i] += len(change)
        self.unchanged[i] += len(change) - np.count_nonzero(change)
        self._add_near_zero(i, read)
        change = change[:MAX_READINGS]
        # Equal steps of counts times their size differ in their last digits.
        steps = change[change > MIN_RELATIVE_STEP * max(abs(smallest), abs(largest))]
        if len(steps):
            self.resolution[i] = np.fmin(self.resolution[i], steps.min())

    def _add_near_zero(self, i: int, read: Array) -> None:
        zeros = len(read) - np.count_nonzero(read)
        self.zeros[i] += zeros
        for k, own in enumerate((read[read > 0], -read[read < 0])):
            kept = MIN_BESIDE_THRESHOLD if zeros else 1
            least = np.partition(own, kept)[:kept] if len(own) > kept else own
            nearest = np.sort(np.append(self.nearest[i][k], least))
            self.nearest[i][k] = nearest[:MIN_BESIDE_THRESHOLD]

    def _add_held(
        self, sensor: int, steps: Sequence[Array], at_zero: Sequence[Booleans]
    ) -> Booleans | None:
        """The records in which a sensor's readings are new; None where they are all the time.

        What a firmware sets to 0 below a threshold is held for no time: see `ZeroBelowThreshold`.
        """
        if len({len(step) for step in steps}) != 1:
            return None
        new = np.logical_or.reduce([step > 0 for step in steps])
        own = new[~(_standing_still(new) | (~new & np.logical_and.reduce(at_zero)))]
        self.stood[sensor] += len(new) - len(own)
        self.held[sensor] += len(own) - np.count_nonzero(own)
        self.windows[sensor].append(_held_in_windows(new))
        self.windows_in_use[sensor].append(_held_in_windows(own))
        repeated = len(new) - np.count_nonzero(new)
        return new if repeated > MIN_HELD_SHARE * len(new) and new.any() else None

    def held_share(self) -> Array:
        """The share of records that hold the readings of each sensor throughout, (2,); else 0.

        Where only one of several axes changes at all, the counts are coarse.
        """
        share = np.zeros(2)
        for sensor, windows in enumerate(self.windows_in_use):
            own = slice(3 * sensor, 3 * sensor + 3)
            moving = self.smallest[own] < self.largest[own]
            recorded = np.isfinite(self.smallest[own])
            if moving.sum() < min(2, recorded.sum()) or not sum(map(len, windows)):
                continue
            held, pairs = self.held[sensor], self.pairs[own][moving] - self.stood[sensor]
            unchanged = self.unchanged[own][moving] - self.stood[sensor]
            alone = (unchanged - held) / np.maximum(pairs - held, 1)
            usual = float(np.quantile(np.concatenate(windows), 0.1))
            if usual >= MIN_HELD_SHARE and (alone <= MAX_EQUAL_ALONE).all():
                share[sensor] = held / float(pairs.max() + 1)
        return share

    def median_noise(self) -> Array:
        """The median over the batches, (6,), NaN where a channel is not recorded."""
        held = np.repeat(self.held_share() > 0, 3)
        noise = np.where(held, self.noise_of_new, self.noise)
        recorded = np.isfinite(noise).any(axis=0)
        return np.where(recorded, np.nanmedian(np.where(recorded, noise, 0.0), axis=0), np.nan)


def _thresholds(logs: Sequence[_Channels]) -> Array:
    """Below which each channel reads 0 in all logs, (6,), NaN where it reads what is small.

    A channel that goes through zero either way, for which 0 is no value of a lost reading.
    """
    found = np.full(6, np.nan)
    for i in range(6):
        above, below = (
            np.sort(np.concatenate([log.nearest[i][k] for log in logs])) for k in (0, 1)
        )
        zeros = sum(log.zeros[i] for log in logs)
        if zeros < MIN_BESIDE_THRESHOLD or not len(above) or not len(below):
            continue
        least = min(above[0], below[0])
        beside = sum(np.count_nonzero(own < 2 * least) for own in (above, below))
        either = max(above[0], below[0]) < 2 * least
        beyond = np.nanmax([[-log.smallest[i], log.largest[i]] for log in logs])
        step = np.fmin.reduce([log.resolution[i] for log in logs])  # NaN where none changes
        far = beyond > MIN_BEYOND_THRESHOLD * least and least > MIN_THRESHOLD_STEPS * step
        if beside >= MIN_BESIDE_THRESHOLD and either and far:
            found[i] = least
    return found


def _held_in_windows(new: Booleans) -> Array:
    """The share of records in each window that repeat a reading; `new`: those that do not."""
    whole = len(new) // HELD_WINDOW * HELD_WINDOW
    return np.asarray(1 - new[:whole].reshape(-1, HELD_WINDOW).mean(axis=1))


def _standing_still(new: Booleans) -> Booleans:
    """Which records, (n,), hold a reading for so long that no slower sensor does.

    `new`: which records have a reading of their own.
    """
    first = np.flatnonzero(np.append(new, True))
    length = np.diff(first)
    still = np.zeros(len(new), bool)
    if len(length):
        for k in np.flatnonzero(length > MAX_HELD_TIMES * np.median(length)):
            still[first[k] + 1 : first[k + 1]] = True
    return still


def _noise(change: Array) -> float:
    """√2: from the scatter of differences to that of one reading."""
    return float(MAD_TO_SIGMA / np.sqrt(2) * median(change[:MAX_READINGS]))


def windows_of(clocks: pd.DataFrame) -> SumsOver:
    """The sums of every log over windows of 1 s."""
    step = {log: clock.step for log, clock in clocks_of(clocks).items()}
    ends = records_of(clocks)
    return SumsOver({log: regular(end, round(WINDOW / step[log])) for log, end in ends.items()})


def records_of(clocks: pd.DataFrame) -> dict[str, int]:
    """For each log that has records the number after the last."""
    return {row["log"]: row["to_record"] for row in rows_of(clocks) if row["to_record"]}


def logs(
    statistics: pd.DataFrame,
    clocks: pd.DataFrame,
    ranges: pd.DataFrame,
    imu_types: pd.DataFrame,
    given: Given,
    windows: Mapping[str, Windows],
) -> dict[str, Log]:
    """Every log that has records, by name.

    Parameters
    ----------
    statistics, clocks, ranges, imu_types : tables; of each log the type of IMU in its messages
    windows : means over windows of 1 s by log; a log may have none
    """
    stated = {(row["log"], row["sensor"], row["axis"]): row for row in rows_of(ranges)}
    types: dict[str, list[int]] = {}
    for row in rows_of(imu_types):
        types.setdefault(row["log"], []).append(row["imu_type"])
    rows = {row["log"]: row for row in rows_of(clocks)}
    clock = clocks_of(clocks)
    in_all = statistics.assign(reach=statistics[["smallest", "largest"]].abs().max(axis=1))
    in_all = in_all.groupby(["sensor", "axis"]).agg({"reach": "max", "noise": "median"})
    in_all = in_all.loc[[*CHANNEL_PARTS.values()]]
    made = {}
    for name, own in statistics.groupby("log", sort=False):
        log = str(name)
        channels = [stated.get((log, sensor, axis), {}) for sensor, axis in CHANNEL_PARTS.values()]
        made[log] = Log(
            name=log,
            given=given,
            interval=clock[log].interval or np.nan,
            recorded_on=rows[log]["recorded_on"],
            quantum=own["resolution"].to_numpy(np.float64),
            noise=own["noise"].to_numpy(np.float64),
            equal=own["unchanged_share"].to_numpy(np.float64),
            held=own["held_share"].to_numpy(np.float64)[::3],
            least=own["smallest"].to_numpy(np.float64),
            most=own["largest"].to_numpy(np.float64),
            limit=np.array([_number(row.get("limit"), np.inf) for row in channels]),
            threshold=own["threshold"].to_numpy(np.float64),
            count=np.array([_count(row, clock[log].step) for row in channels]),
            windows=windows.get(log, Windows.none()),
            records=rows[log]["records"],
            records_of_all=int(clocks["records"].sum()),
            reach=in_all["reach"].to_numpy(np.float64),
            usual_noise=in_all["noise"].to_numpy(np.float64),
            increments=any(row.get("increments") for row in channels),
            imu=tuple(types.get(log, ())),
            stamp_scatter=_number(rows[log].get("stamp_scatter"), np.nan),
            interval_sigma=_number(rows[log].get("interval_sigma"), np.nan),
            shortest_gap=_number(rows[log].get("shortest_gap"), np.nan),
        )
    return made


def _count(row: Row | dict[str, Any], step: float) -> float:
    """What one count of a channel is, as a rate where it is an increment over `step`, s."""
    return _number(row.get("count"), np.nan) / (step if row.get("increments") else 1.0)


def _number(value: float | None, unknown: float) -> float:
    return unknown if value is None else value
