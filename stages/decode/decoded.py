"""The logs as files, what a piece of a log gives, and its rows in the tables."""

import json
import math
from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from inertial.arrays import Array, Integers
from inertial.formats.account import Account, RefusedLine
from inertial.formats.arrow_arrays import (
    array_of_numbers,
    array_of_texts,
    batch_of_rows,
    repeated_text,
)
from inertial.formats.columns.column_reader import Encoder
from inertial.formats.gps_time import WEEK
from inertial.tables import ACCOUNTS, MEAN_SIGMAS, REFUSED, SAMPLES
from inertial.tables.errors import Refusal
from inertial.text.messages import _

# ---- Iteration with the next items made in a thread while the current one is used.

Item = TypeVar("Item")
_END = object()
_DEPTH = 2  # with one, producer and consumer wait for each other wherever items differ in size


def prefetched(items: Iterator[Item]) -> Iterator[Item]:
    """The same items; the next ones are made in a thread while the current one is used."""
    with ThreadPoolExecutor(1) as thread:
        pending = deque(thread.submit(next, items, _END) for _ in range(_DEPTH))
        while (item := pending.popleft().result()) is not _END:
            pending.append(thread.submit(next, items, _END))
            yield item  # type: ignore[misc]


# ---- The logs of a campaign as files: they are there, and finished.


def path_of(file: str, raw: list[Path]) -> Path:
    """The log of this name; refused where there is none."""
    paths = {path.name: path for path in raw if path.is_file()}
    if file not in paths:
        raise Refusal(
            file,
            "",
            "no such file",
            _(
                "the log of the campaign beside {value}",
                value=", ".join(sorted(paths)) or "its campaign.yaml",
            ),
            _("put it into the campaign's folder, or correct its name in campaign.yaml"),
        )
    return paths[file]


def refuse_grown(path: Path, size: int) -> None:
    """A log that is still written to would be another one in every run."""
    if (now := path.stat().st_size) != size:
        raise Refusal(
            path.name,
            "",
            _("{now} bytes, {now_2} more than when it was opened", now=now, now_2=now - size),
            _("a log that is finished"),
            _("copy it when the recording has ended, and run again"),
        )


# ---- A decoded piece of a log, and the clock of a log by its first pieces.

LOOK_AHEAD = 1000  # samples, where there are as many, by which the interval is known
MIN_SPANS = 8  # of the log, of fewer samples, so that most of them lie beside a gap
MAX_STILL = 50  # samples that stamps which are rounded stand still for; more repeat one record
MAX_OFF_SHARE = 0.5  # of the interval, by which a step is too short or too long
USUAL_PERCENT = (1, 99)  # of the other steps, which give their spread
MIN_GAP_SPREAD = 1.5  # of this, by which a gap is longer than an interval: what is less is jitter
MAX_OFF_SPREAD = 5.0  # of this, by which jitter is off; with more the clock jumps
MIN_SHORT, MIN_SHORT_SHARE = 0.01, 0.2  # of all steps, of those too long: more are scatter


@dataclass(frozen=True)
class Decoded:
    """What a piece of a log gives: n samples, the lines that were refused, and the account."""

    samples: dict[str, Any]  # columns of the table samples by name, (n,) each, SI
    refused: list[RefusedLine]
    account: Account
    imu_types: frozenset[int] = frozenset()  # in the messages, by NovAtel's list
    # Of means: the standard deviation of each by channel, (n,), NaN where none is stated; SI.
    mean_sigmas: Mapping[str, Array] = field(default_factory=dict)


def first_of(times: Iterable[Integers | Array]) -> NDArray[Any]:
    """The first times of a log, at least `LOOK_AHEAD` where there are as many."""
    so_far: list[NDArray[Any]] = []
    for some in times:
        so_far.append(some)
        if sum(len(part) for part in so_far) > LOOK_AHEAD:
            break
    return np.concatenate(so_far) if so_far else np.array([])


def interval_of(times: NDArray[Any]) -> float | None:
    """The interval from sample to sample by the first times of a log, without gaps and jumps.

    Single steps do not tell it: stamps of a millisecond make them jump, and jitter makes their
    median wrong. Nor does the span, which has the jitter of two stamps. So it is the mean over all
    stamps and those a number of samples later, with gaps of whole samples closed and jumps of the
    clock taken out. Where steps are too short as often as too long, stamps scatter by so much that
    no single gap is to see: there pairs that are off the others are left out instead.
    """
    if len(times) < 2:
        return None
    starts = np.flatnonzero(np.append(True, np.diff(times) != 0))
    lengths = np.diff(np.append(starts, len(times)))
    times = np.repeat(times[starts], np.where(lengths > MAX_STILL, 1, lengths))
    steps = np.diff(times)
    if not (steps > 0).any():
        return None
    apart = max(min(LOOK_AHEAD, len(times) // 2), 1)
    over = (times[apart:] - times[:-apart]) / apart
    few = max(min(LOOK_AHEAD, len(times) // MIN_SPANS), 1)
    about = float(np.median(times[few:] - times[:-few])) / few
    if about <= 0:
        about = float(np.median(steps[steps > 0]))
    short, long = steps < about - MAX_OFF_SHARE * about, steps > about + MAX_OFF_SHARE * about
    many = np.count_nonzero(short) > MIN_SHORT * len(steps)
    if many and np.count_nonzero(short) > MIN_SHORT_SHARE * np.count_nonzero(long):
        near = np.abs(over - about)
        return float(np.mean(over[near <= MAX_OFF_SPREAD * np.median(near)]))
    usual = steps[~(short | long)]
    if not len(usual):
        return about
    spread = float(np.ptp(np.percentile(usual, USUAL_PERCENT)))
    mean = float(np.mean(usual[np.abs(usual - np.median(usual)) <= MAX_OFF_SPREAD * spread]))
    gap = steps - mean > MIN_GAP_SPREAD * spread
    off = steps - mean * np.where(gap, np.maximum(np.rint(steps / mean), 1), 1)
    even = np.cumsum(mean + np.where(np.abs(off) <= MAX_OFF_SPREAD * spread, off, 0.0))
    even = np.append(0.0, even)
    return float(np.mean(even[apart:] - even[:-apart])) / apart


def on_axis(sensor: str, axis: str, values: Array) -> tuple[str, Array]:
    """The channel of a field, (n,), whose body axis and sign are such as -y."""
    return f"{sensor}_{axis[-1]}", -values if axis.startswith("-") else values


# ---- What was decoded as rows of the tables.

Pieces = Iterator[tuple[str, pa.RecordBatch]]


def account_of(log: str, account: Account, refused: list[RefusedLine]) -> Pieces:
    """What became of every byte, and the lines that were refused."""
    yield from refused_rows(log, refused)
    sums = [
        {"log": log, "kind": kind, "name": name, "lines": lines, "bytes": size}
        for kind, name, lines, size in account
    ]
    yield "accounts", batch_of_rows(sums, ACCOUNTS.schema)


def refused_rows(log: str, refused: list[RefusedLine]) -> Pieces:
    """The lines that were refused, if any."""
    if refused:
        lines = [{"log": log, **asdict(line)} for line in refused]
        yield "refused", batch_of_rows(lines, REFUSED.schema)


def mean_sigma_rows(log: str, decoded: Decoded) -> Pieces:
    """The standard deviations that the log states of its means, if any."""
    rows = [
        {"log": log, "record": record, "sensor": sensor, "axis": axis, "sigma": value}
        for channel, sigma in decoded.mean_sigmas.items()
        for sensor, axis in [channel.split("_")]
        for record, value in zip(decoded.samples["record"].tolist(), sigma.tolist(), strict=True)
        if np.isfinite(value)
    ]
    if rows:
        yield "mean_sigmas", batch_of_rows(rows, MEAN_SIGMAS.schema)


def sample_rows(log: str, samples: Mapping[str, Any]) -> pa.RecordBatch:
    """The samples in the columns of the table; what the log does not record is null."""
    rows = len(samples["record"])
    filled = {"log": repeated_text(log, rows)}
    for name, values in samples.items():
        if isinstance(values, list):
            filled[name] = array_of_texts(values).dictionary_encode()
        elif values is not None:
            filled[name] = array_of_numbers(values)
    arrays = [
        filled[column.name] if column.name in filled else _nulls(rows, column.type)
        for column in SAMPLES.schema
    ]
    return pa.RecordBatch.from_arrays(arrays, schema=SAMPLES.schema)


@lru_cache(4)  # most pieces have as many rows
def _nulls(rows: int, of: pa.DataType) -> pa.Array:
    """What is not recorded, (rows,)."""
    return pa.nulls(rows, of)


# ---- The angle of the table at the samples of the IMU, by the log of its encoder.

ANGLE_UNITS = {"deg": math.radians(1), "rad": 1.0}


class Continuous:
    """An angle without its jumps by whole turns, piece by piece; NaN where it is not known."""

    def __init__(self) -> None:
        self._last = math.nan

    def __call__(self, angle: Array) -> Array:
        """The next piece, (n,), rad."""
        result = np.array(angle, dtype=np.float64)
        known = np.flatnonzero(np.isfinite(result))
        if len(known):
            before = [] if math.isnan(self._last) else [self._last]
            whole = np.unwrap(np.concatenate([before, result[known]]), period=2 * math.pi)
            result[known] = whole[len(before) :]
            self._last = float(whole[-1])
        return result


@dataclass(frozen=True)
class TableAngle:
    """The encoder's log of a campaign: its file, GPS week or none, and what its time lacks, s."""

    file: str
    encoder: Encoder
    week: int | None
    offset: float
    unit: float  # rad

    @classmethod
    def of_logs(cls, rows: Sequence[Mapping[str, str]], raw: list[Path]) -> "TableAngle | None":
        """Of a campaign's logs; None where it has none."""
        stated = json.loads(rows[0]["layout"]).get("encoder") if rows else None
        if stated is None:
            return None
        layout = stated["layout"]
        unit = ANGLE_UNITS[layout["table_angle"]["unit"]]
        encoder = Encoder(path_of(stated["file"], raw), layout, 2 * math.pi / unit)
        return cls(stated["file"], encoder, stated["gps_week"], stated["offset"], unit)

    @property
    def absolute(self) -> bool:
        """Whether its clock is GPS time."""
        return self.week is not None

    def at(self, time: Array) -> Array:
        """The angle at times of the IMU's clock, (n,), rad; NaN where it is not known."""
        began = (self.week or 0) * WEEK + self.offset
        return self.encoder.angle_at(time - began) * self.unit
