"""What can be said of a recording without the plan: its time, its status, its unit."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts import tables
from stages.contracts.findings import Finding, table_of
from stages.contracts.parquet import Stream
from stages.contracts.records import Clock, clocks_of, known_of, rows_of
from stages.contracts.samples import Columns, extents, pieces, regular, sums_over
from stages.contracts.stage import Stage, Tables
from stages.model.site import STANDARD_GRAVITY

STORM = 8  # more equal findings in one log are one with a count
# Ratios of |f| at rest to gravity that a wrong unit or setting makes.
WRONG_UNITS = {
    STANDARD_GRAVITY: "the values are in m/s² but are read as g",
    1 / STANDARD_GRAVITY: "the values are in g but are read as m/s²",
    **{
        float(factor): f"counts_per_unit is {factor} times too small, as of another full scale"
        for factor in (2, 4, 8, 16)
    },
    **{
        1 / factor: f"counts_per_unit is {factor} times too large, as of another full scale"
        for factor in (2, 4, 8, 16)
    },
}
WINDOW = 1.0  # s, of the means in which |f| is looked at
COUNTS = 50.0  # times gravity: what no accelerometer at rest reads in any unit


def quality(
    samples: Stream,
    clocks: pd.DataFrame,
    campaign: pd.DataFrame,
    known: pd.DataFrame,
    *,
    gap: float,
    rate_tolerance: float,
    gravity_tolerance: float,
) -> Tables:
    """Findings about time, status and |f| at rest, and the records that they mask."""
    stated, clock = rows_of(campaign)[0], clocks_of(clocks)
    bits = (stated["must_be_set"], stated["must_be_clear"])
    scans = _scan(samples, clock, gap, *bits)
    findings: list[Finding] = []
    masks: list[dict[str, Any]] = []
    gaps: list[dict[str, Any]] = []
    for log, scan in scans.items():
        for cause, events in scan.events.items():
            told = list(_tell(log, cause, events))
            findings += told
            if cause == "gap":
                gaps += [
                    {
                        "log": log,
                        "record": event.record,
                        "from_s": event.from_s,
                        "to_s": event.to_s,
                        "missing": round(event.size),
                    }
                    for event in events
                ]
            else:
                # one finding may stand for many events; the mask refers to the one that does
                masks += [
                    {
                        "log": log,
                        "from_record": event.record,
                        "to_record": event.record + event.records,
                        "finding": told[min(number, len(told) - 1)].id,
                    }
                    for number, event in enumerate(events)
                ]
    findings += _rates(clock, stated["rate"], rate_tolerance)
    findings += _gravity(samples, clock, known_of(known)["gravity"].number, gravity_tolerance)
    return {
        "findings": table_of(findings),
        "masks": pd.DataFrame(masks) if masks else tables.MASKS.empty(),
        "gaps": pd.DataFrame(gaps) if gaps else tables.GAPS.empty(),
    }


# ---- time and status, record by record


@dataclass
class Event:
    """Something at one place of a log: time before and after, lines, records concerned."""

    record: int
    line: int
    from_s: float
    to_s: float
    size: float
    records: int = 1


@dataclass
class _Scan:
    """What a log showed so far, and its last record, to which the next one is compared."""

    events: dict[str, list[Event]] = field(default_factory=dict)
    last: Columns | None = None

    def note(self, cause: str, event: Event) -> None:
        self.events.setdefault(cause, []).append(event)


def _scan(
    samples: Stream, clocks: dict[str, Clock], gap: float, must_be_set: int, must_be_clear: int
) -> dict[str, _Scan]:
    scans: dict[str, _Scan] = {}
    columns = ["record", "line", "time", "status", "label", *tables.CHANNELS]
    for log, piece in pieces(samples, columns):
        scan = scans.setdefault(log, _Scan())
        joined = piece
        if scan.last is not None:
            joined = {name: np.append(scan.last[name], piece[name]) for name in columns}
        scan.last = {name: values[-1:] for name, values in piece.items()}
        _scan_time(scan, joined, clocks[log].interval or np.nan, gap)
        _scan_status(scan, piece, must_be_set, must_be_clear)
    return scans


def _scan_time(scan: _Scan, piece: Columns, interval: float, gap: float) -> None:
    time, record, line = piece["time"], piece["record"], piece["line"]
    step = np.diff(time)
    # Another label is another stretch of recording; nothing is compared across.
    same = piece["label"][1:] == piece["label"][:-1]

    def note(cause: str, where: NDArray[np.bool_], records: int = 1) -> None:
        for i in np.flatnonzero(where & same):
            missing = round(step[i] / interval) - 1 if interval > 0 else 0
            size = float(missing) if cause == "gap" else float(step[i])
            place = (int(record[i + 1]), int(line[i + 1]), float(time[i]), float(time[i + 1]))
            scan.note(cause, Event(*place, size, records))

    channels = np.column_stack([piece[channel] for channel in tables.CHANNELS])
    repeated = np.all((channels[1:] == channels[:-1]) | np.isnan(channels[1:]), axis=1)
    # Accelerometers and gyros may come in rows of their own, with the same time.
    alike = np.all(np.isnan(channels[1:]) == np.isnan(channels[:-1]), axis=1)
    note("gap", step > gap * interval)
    note("time_backwards", step < 0)
    note("duplicate", (step == 0) & alike & repeated)
    note("time_stands_still", (step == 0) & alike & ~repeated)


def _scan_status(scan: _Scan, piece: Columns, must_be_set: int, must_be_clear: int) -> None:
    status = piece["status"].astype(np.float64)
    there = ~np.isnan(status)
    bits = np.where(there, status, 0).astype(np.int64)
    wrong = there & (((bits & must_be_set) != must_be_set) | ((bits & must_be_clear) != 0))
    edges = np.flatnonzero(np.diff(wrong, prepend=False, append=False))
    for start, end in zip(edges[::2], edges[1::2], strict=True):
        record, time = piece["record"], piece["time"]
        place = (int(record[start]), int(piece["line"][start]))
        span = (float(time[start]), float(time[end - 1]))
        count = int(record[end - 1] - record[start] + 1)
        scan.note("status_invalid", Event(*place, *span, float(count), count))


_TOLD = {
    # cause: (severity, unit of size, sentence for one, consequence, action)
    "gap": (
        1,
        "samples",
        "{log}: {size:.0f} samples are missing between {from_s:.3f} s and {to_s:.3f} s; line"
        " {line} is the first after them.",
        "A sum over this stretch lacks what was not recorded; means of a rest hardly change.",
        "A turn with this gap is not used for the angle method; record it again.",
    ),
    "time_backwards": (
        2,
        "s",
        "{log}: time goes back by {back:.6f} s at line {line}, {to_s:.3f} s.",
        "It is not known when this record was taken.",
        "The record is masked; look for two logs that were joined.",
    ),
    "duplicate": (
        1,
        "s",
        "{log}: the record of line {line} repeats the one before, at {to_s:.3f} s.",
        "A sum would count it twice.",
        "The repetition is masked.",
    ),
    "time_stands_still": (
        2,
        "s",
        "{log}: the record of line {line} has the time of the one before, {to_s:.3f} s, but other"
        " values.",
        "It is not known when this record was taken.",
        "The record is masked; look at the clock of the logger.",
    ),
    "status_invalid": (
        2,
        "records",
        "{log}: the instrument marks {size:.0f} records from line {line}, {from_s:.3f} s, as"
        " invalid.",
        "Their values are not to be trusted.",
        "They are masked; see the status word in the instrument's manual.",
    ),
}


def _tell(log: str, cause: str, events: list[Event]) -> Iterator[Finding]:
    severity, unit, sentence, consequence, action = _TOLD[cause]
    storm = len(events) > STORM
    for number, event in enumerate(events[:1] if storm else events):
        told = sentence.format(log=log, back=-event.size, **vars(event))
        if storm:
            told += f" This happens {len(events)} times in this log; the first place is given."
        yield Finding(
            id=f"quality/{cause}/{log}/{number}",
            cause=cause,
            log=log,
            from_s=event.from_s,
            to_s=events[-1].to_s if storm else event.to_s,
            count=len(events) if storm else 1,
            size=event.size,
            unit=unit,
            sentence=told,
            consequence=consequence,
            action=action,
            severity=severity,
        )


# ---- rate and unit


def _rates(clocks: dict[str, Clock], stated: float | None, tolerance: float) -> Iterator[Finding]:
    for log, clock in clocks.items():
        if stated is None or not clock.interval:
            continue
        rate = 1 / clock.interval
        if abs(rate / stated - 1) > tolerance:
            yield Finding(
                id=f"quality/rate_off/{log}",
                cause="rate_off",
                log=log,
                size=rate / stated,
                sentence=f"{log}: {rate:.4g} samples per second, but {stated:.4g} are stated"
                f" (factor {rate / stated:.4g}).",
                consequence="None: rates are made with the log's own sample interval.",
                action="Correct rate_hz of the instrument, or look whether samples are lost.",
                severity=1,
            )


def _gravity(
    samples: Stream, clocks: dict[str, Clock], gravity: float, tolerance: float
) -> Iterator[Finding]:
    """Compare |f|, where it is quiet, with gravity, and name a unit that explains a difference."""
    windows = {
        log: regular(end, round(WINDOW / clocks[log].step)) for log, end in extents(samples).items()
    }
    for log, sums in sums_over(samples, windows).items():
        force = np.linalg.norm(sums.mean[:, :3], axis=1)
        there = np.isfinite(force)
        if not there.any():
            continue
        restless = np.nansum(sums.variance[there], axis=1)
        quiet = restless <= 4 * np.quantile(restless, 0.25)
        ratio = float(np.median(force[there][quiet]) / gravity)
        if abs(ratio - 1) <= tolerance:
            continue
        cause = _named(ratio, tolerance)
        yield Finding(
            id=f"quality/wrong_unit/{log}",
            cause="wrong_unit",
            sensor="accel",
            log=log,
            size=ratio,
            sentence=f"{log}: at rest the specific force is {ratio * gravity:.4g} m/s²,"
            f" {ratio:.4g} times gravity: {cause}.",
            consequence="Every parameter of the accelerometers is wrong by this factor.",
            action="Correct the unit, counts_per_unit or count size in the campaign.",
            severity=3,
        )


def _named(ratio: float, tolerance: float) -> str:
    for wrong, name in WRONG_UNITS.items():
        if abs(ratio / wrong - 1) <= tolerance:
            return name
    if ratio > COUNTS:
        return "the values are counts, and counts_per_unit is missing"
    return "no known unit explains it; the bias may be large, or the IMU was not at rest"


STAGE = Stage(
    quality,
    reads={
        "samples": tables.SAMPLES,
        "clocks": tables.CLOCKS,
        "campaign": tables.CAMPAIGN,
        "known": tables.KNOWN,
    },
    streams=("samples",),
    writes={"findings": tables.FINDINGS, "masks": tables.MASKS, "gaps": tables.GAPS},
)

if __name__ == "__main__":
    STAGE.command_line()
