"""What can be said of every log in one pass, before its records are looked at one by one."""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.masked_samples import extents, pieces, regular
from inertial.campaign.records import clocks_of, known_of, rows_of
from inertial.campaign.sums import sums_over
from inertial.physics.site import normal_gravity
from inertial.signal.detector import Array, Given, Log, Windows
from inertial.tables import CHANNELS
from inertial.tables.parquet import Stream

LOOKED_AT = 1 << 16  # readings of a piece from which its noise and smallest step are taken


WINDOW = 1.0  # s
COMMON = 3  # logs that can have an interval in common
SCATTER = 1.4826  # sigma of Gaussian values in units of the median of their absolute values


def given_by(
    campaign: pd.DataFrame, known: pd.DataFrame, count_sizes: pd.DataFrame, clocks: pd.DataFrame
) -> Given:
    """What the campaign says of all its logs, and which interval they have in common."""
    (facts,) = rows_of(campaign)
    taken = known_of(known)
    gravity = taken["gravity"]
    sizes: dict[str, dict[str, float]] = {}
    for row in rows_of(count_sizes):
        sizes.setdefault(row["instrument"], {})[row["sensor"]] = row["count_size"]
    latitude = facts["latitude"]
    return Given(
        gravity=gravity.number,
        gravity_sigma=gravity.scatter,
        normal_gravity=np.nan
        if latitude is None
        else normal_gravity(latitude, facts["height"] or 0.0),
        interval=1 / facts["rate"] if facts["rate"] else np.nan,
        instrument=facts["instrument"],
        date=facts["date"],
        must_be_set=facts["must_be_set"],
        must_be_clear=facts["must_be_clear"],
        count_sizes={
            name: (size["accel"], size["gyro"]) for name, size in sizes.items() if len(size) == 2
        },
        position_sigma=taken["position"].scatter,
        **_in_common([clock.duration for clock in clocks_of(clocks).values() if clock.duration]),
    )


def _in_common(intervals: list[float]) -> dict[str, float]:
    """The interval of most logs, and how far the others are from it, as a sigma."""
    if len(intervals) < COMMON:
        return {}
    usual = np.median(intervals)
    away = np.abs(np.array(intervals) / usual - 1)
    return {"usual_interval": float(usual), "unlike": SCATTER * float(np.median(away))}


def logs(
    samples: Stream, clocks: pd.DataFrame, ranges: pd.DataFrame, given: Given
) -> dict[str, Log]:
    """Every log that has records; `ranges`: what a count is and how far each channel reaches."""
    clock, ends = clocks_of(clocks), extents(samples)
    recorded_on = {row["log"]: row["recorded_on"] for row in rows_of(clocks)}
    imu = {row["log"]: row["imu_types"] or "" for row in rows_of(clocks)}
    cuts = {log: regular(end, round(WINDOW / clock[log].step)) for log, end in ends.items()}
    windows = sums_over(samples, cuts)
    totals: dict[str, _Total] = {}
    for name, piece in pieces(samples, list(CHANNELS)):
        values = np.column_stack([piece[channel] for channel in CHANNELS])
        totals.setdefault(name, _Total()).add(values)
    stated = {(row["log"], row["channel"]): row for row in rows_of(ranges)}

    def by_channel(log: str, key: str, step: float, missing: float) -> Array:
        rows = [stated.get((log, channel), {}) for channel in CHANNELS]
        sizes = [row.get(key) for row in rows]
        per = [step if key == "count" and row.get("increments") else 1.0 for row in rows]
        return np.array([missing if s is None else s / p for s, p in zip(sizes, per, strict=True)])

    return {
        name: Log(
            name=name,
            given=given,
            interval=clock[name].interval or np.nan,
            recorded_on=recorded_on[name],
            quantum=total.quantum,
            noise=_middle(total.noise),
            equal=total.equals / np.maximum(total.pairs, 1),
            least=total.least,
            most=total.most,
            limit=by_channel(name, "limit", clock[name].step, np.inf),
            count=by_channel(name, "count", clock[name].step, np.nan),
            windows=Windows(sums.mean, sums.variance, sums.time, sums.temperature),
            records=total.records,
            step=clock[name].duration or np.nan,
            increments=any(stated.get((name, c), {}).get("increments") for c in CHANNELS),
            imu=tuple(int(number) for number in imu[name].split()),
        )
        for name, total in totals.items()
        for sums in [windows[name]]
    }


class _Total:
    """What is gathered while a log streams by, (6,) each."""

    def __init__(self) -> None:
        self.records = 0
        self.pairs, self.equals = np.zeros(6), np.zeros(6)
        self.least, self.most = np.full(6, np.nan), np.full(6, np.nan)
        self.quantum = np.full(6, np.nan)
        self.noise: list[Array] = []

    def add(self, values: NDArray[np.float64]) -> None:
        self.records += len(values)
        noise = np.full(6, np.nan)
        for i in range(6):
            read = values[:, i]
            read = read[np.isfinite(read)]
            if len(read) < 2:
                continue
            self.least[i] = np.fmin(self.least[i], read.min())
            self.most[i] = np.fmax(self.most[i], read.max())
            change = np.abs(np.diff(read))
            self.pairs[i] += len(change)
            self.equals[i] += np.count_nonzero(change == 0)
            some = change[:LOOKED_AT]
            # 1.4826 / √2: from the median of |differences| to the sigma of one reading.
            noise[i] = 1.4826 / np.sqrt(2) * np.median(some)
            # Readings are counts times their size, so equal steps differ in their last digits.
            steps = some[some > 1e-9 * np.abs(read).max()]
            if len(steps):
                self.quantum[i] = np.fmin(self.quantum[i], steps.min())
        self.noise.append(noise)


def _middle(noises: list[Array]) -> Array:
    """The median of the pieces, NaN where a channel is recorded in none."""
    together = np.array(noises)
    there = np.isfinite(together).any(axis=0)
    return np.where(there, np.nanmedian(np.where(there, together, 0.0), axis=0), np.nan)
