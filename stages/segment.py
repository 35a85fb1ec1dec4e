"""Where the manoeuvres of the plan are in the logs, and each reduced to short means."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import degrees, pi
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts import tables
from stages.contracts.findings import Finding, table_of
from stages.contracts.parquet import Stream
from stages.contracts.samples import Integers, Sums, extents, pieces, regular, sums_over
from stages.contracts.stage import Stage, Tables
from stages.segmentation.alignment import align, rest_score, turn_score
from stages.segmentation.motion import Stretch, moving, rest_level, steady_part, stretches

BIN = 0.1  # s, of the short means in which motion is looked for
SLOWEST = 0.05  # of the slowest planned rate: what counts as motion
BY_HAND = np.radians(2.0)  # rad/s: what counts as motion where no rate is planned
TRACE_POINTS = 1200  # per log, what a figure shows

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Window:
    """A part of a log in which manoeuvres are looked for in the order of the plan."""

    log: str
    first: int  # record
    after: int
    manoeuvres: pd.DataFrame


@dataclass(frozen=True)
class Binned:
    """The short means of a window."""

    window: Window
    edges: Integers  # (k + 1,), records
    rates: Array  # (k, 3), rad/s
    forces: Array  # (k, 3), m/s²
    seconds: float  # length of a bin
    first_s: Array  # (k,), times
    last_s: Array


@dataclass(frozen=True)
class Part:
    """One phase of one manoeuvre: records [first, after) of its log."""

    manoeuvre: str
    phase: str
    log: str
    first: int
    after: int


def segment(
    samples: Stream,
    manoeuvres: pd.DataFrame,
    clocks: pd.DataFrame,
    gaps: pd.DataFrame,
    masks: pd.DataFrame,
    *,
    rest_block: float,
    turn_block: float,
    margin: float,
    angle_tolerance: float,
) -> Tables:
    """Segments, what was performed of each manoeuvre, blocks, traces and findings."""
    clock = clocks.set_index("log")
    intervals = {str(log): float(dt) if dt > 0 else 1.0 for log, dt in clock["interval"].items()}
    ends = extents(samples)
    windows = list(_windows(samples, manoeuvres, ends))
    binned = _binned(samples, windows, intervals)
    level, scatter = _rest_level(binned)
    planned = manoeuvres["rate"].abs().min()
    slowest = SLOWEST * planned if planned > 0 else BY_HAND
    threshold = max(slowest, 6 * scatter)

    parts: list[Part] = []
    performed: list[dict[str, Any]] = []
    findings: list[Finding] = []
    for one in binned:
        found = stretches(moving(one.rates, one.forces, level, threshold), one.seconds)
        matched = _match(one, found, level)
        taken = {j for j in matched.values() if j is not None}
        for row in one.window.manoeuvres.to_dict("records"):
            if row["do"] == "positions":
                new = list(_positions(one, found, row, taken, margin))
                parts += new
                performed.append(_performed_positions(row, len(new)))
                continue
            index = matched[row["manoeuvre"]]
            if index is None:
                performed.append(_not_found(row))
            elif row["do"] == "rest":
                part = _rest(one, found[index], row["manoeuvre"], "rest", margin)
                parts.append(part)
                performed.append(_performed_rest(one, row, found[index]))
            else:
                new = list(_turn(one, found, index, row, taken, margin, level))
                parts += new
                performed.append(
                    _performed_turn(one, found, index, row, new, gaps, level, angle_tolerance)
                )
    findings += _findings(performed, manoeuvres, angle_tolerance)
    blocks = _blocks(samples, parts, gaps, masks, intervals, rest_block, turn_block)
    return {
        "segments": _segments(samples, parts),
        "performed": _in_order(performed, manoeuvres),
        "blocks": blocks,
        "traces": _traces(samples, ends),
        "findings": table_of(findings),
    }


# ---- windows and bins


def _windows(samples: Stream, manoeuvres: pd.DataFrame, ends: dict[str, int]) -> Iterator[Window]:
    """A window for each manoeuvre that the plan selects, and one for all others of a log."""
    selected = manoeuvres[["from_s", "from_row", "label"]].notna().any(axis=1)
    for log, rows in manoeuvres[~selected].groupby("log", sort=False):
        yield Window(str(log), 0, ends.get(str(log), 0), rows)
    chosen = manoeuvres[selected]
    spans = _selected_records(samples, chosen)
    for number in range(len(chosen)):
        row = chosen.iloc[[number]]
        first, after = spans[str(row["manoeuvre"].iloc[0])]
        yield Window(str(row["log"].iloc[0]), first, after, row)


def _selected_records(samples: Stream, chosen: pd.DataFrame) -> dict[str, tuple[int, int]]:
    """For each manoeuvre the records that its span, rows or label select."""
    found: dict[str, tuple[int, int]] = {name: (0, 0) for name in chosen["manoeuvre"]}
    if chosen.empty:
        return found
    for log, piece in pieces(samples, ["record", "time", "label"]):
        for row in chosen[chosen["log"] == log].itertuples():
            if pd.notna(row.from_row):
                inside = (piece["record"] >= row.from_row) & (piece["record"] < row.to_row)
            elif pd.notna(row.from_s):
                inside = (piece["time"] >= row.from_s) & (piece["time"] < row.to_s)
            else:
                inside = piece["label"] == row.label
            records = piece["record"][inside]
            if len(records):
                first, after = found[str(row.manoeuvre)]
                first = first if after else int(records[0])
                found[str(row.manoeuvre)] = (first, int(records[-1]) + 1)
    return found


def _binned(samples: Stream, windows: list[Window], intervals: dict[str, float]) -> list[Binned]:
    windows = sorted((w for w in windows), key=lambda w: (w.log, w.first))
    edges = []
    for window in windows:
        length = max(1, round(BIN / intervals.get(window.log, 1.0)))
        first, after = regular(window.after - window.first, length)
        edges.append((window.first + first, window.first + after))
    by_log: dict[str, tuple[Integers, Integers]] = {}
    for window, (first, after) in zip(windows, edges, strict=True):
        before = by_log.get(window.log, (np.array([], np.int64),) * 2)
        by_log[window.log] = (np.append(before[0], first), np.append(before[1], after))
    sums = sums_over(samples, by_log)
    used: dict[str, int] = {}
    result = []
    for window, (first, after) in zip(windows, edges, strict=True):
        start = used.get(window.log, 0)
        used[window.log] = start + len(first)
        part = slice(start, start + len(first))
        total = sums[window.log]
        result.append(
            Binned(
                window,
                np.append(first, after[-1:]),
                total.mean[part, 3:],
                total.mean[part, :3],
                max(1, round(BIN / intervals[window.log])) * intervals[window.log]
                if window.log in intervals
                else 1.0,
                total.first[part],
                total.last[part],
            )
        )
    return result


def _rest_level(binned: list[Binned]) -> tuple[Array, float]:
    """The gyros at rest over the campaign: from the logs of rests alone, if there are any."""
    rests = [b for b in binned if set(b.window.manoeuvres["do"]) == {"rest"}]
    for group in (rests, binned):
        rates = [b.rates[np.isfinite(b.rates).all(axis=1)] for b in group]
        every = np.concatenate(rates) if rates else np.empty((0, 3))
        if len(every):
            return rest_level(every)
    return np.zeros(3), 0.0


# ---- which stretch is which manoeuvre


def _vector(row: dict[str, Any], stem: str) -> Array | None:
    vector = np.array([row[f"{stem}_{axis}"] for axis in tables.AXES], dtype=np.float64)
    return None if np.isnan(vector).any() else vector


def _match(one: Binned, found: list[Stretch], level: Array) -> dict[str, int | None]:
    rows = [r for r in one.window.manoeuvres.to_dict("records") if r["do"] != "positions"]
    scores = np.zeros((len(rows), len(found)))
    for i, row in enumerate(rows):
        for j, stretch in enumerate(found):
            scores[i, j] = _score(one, stretch, row, level)
    matches = align(scores)
    # Where a log holds one turn alone, it is all that moves, pauses included.
    return {row["manoeuvre"]: match for row, match in zip(rows, matches, strict=True)}


def _score(one: Binned, stretch: Stretch, row: dict[str, Any], level: Array) -> float:
    inside = slice(stretch.first, stretch.after)
    if row["do"] == "rest":
        if stretch.moves:
            return 0.0
        seconds = (stretch.after - stretch.first) * one.seconds
        force = _mean(one.forces[inside])
        return rest_score(seconds, _some(row["seconds"]), force, _vector(row, "up"))
    if not stretch.moves:
        return 0.0
    if row["recorded"] == "steady":
        rate = float(np.nanmean(_about(one, row, level)[inside]))
        return turn_score(rate, _some(row["rate"]))
    return turn_score(
        float(np.nansum(_about(one, row, level)[inside]) * one.seconds), _some(row["angle"])
    )


def _mean(values: Array) -> Array:
    there = np.isfinite(values).all(axis=1)
    return values[there].mean(axis=0) if there.any() else np.full(3, np.nan)


def _some(value: float | None) -> float | None:
    return None if value is None or pd.isna(value) else float(value)


def _about(one: Binned, row: dict[str, Any], level: Array) -> Array:
    """Rate about the axis of the turn in each bin, rad/s."""
    about = _vector(row, "about")
    assert about is not None  # the plan refuses a turn without an axis
    rates = one.rates - level
    recorded = np.isfinite(rates).any(axis=1)
    return np.where(recorded, np.nan_to_num(rates) @ about, np.nan)


# ---- the parts of each manoeuvre


def _rest(one: Binned, stretch: Stretch, name: str, phase: str, margin: float) -> Part:
    """A rest without the margin beside a motion."""
    bins = len(one.edges) - 1
    room = round(margin / one.seconds)
    first = stretch.first + (room if stretch.first > 0 else 0)
    after = stretch.after - (room if stretch.after < bins else 0)
    first, after = (first, after) if after > first else (stretch.first, stretch.after)
    return Part(name, phase, one.window.log, int(one.edges[first]), int(one.edges[after]))


def _positions(
    one: Binned, found: list[Stretch], row: dict[str, Any], taken: set[int], margin: float
) -> Iterator[Part]:
    number = 0
    for j, stretch in enumerate(found):
        seconds = (stretch.after - stretch.first) * one.seconds
        if not stretch.moves and j not in taken and seconds >= row["seconds"]:
            number += 1
            yield _rest(one, stretch, f"{row['manoeuvre']}-{number:02d}", "rest", margin)


def _turn(
    one: Binned,
    found: list[Stretch],
    index: int,
    row: dict[str, Any],
    taken: set[int],
    margin: float,
    level: Array,
) -> Iterator[Part]:
    """The phases of a turn; the rests beside it where no other manoeuvre has them."""
    first, after = _motion(one, found, index)
    room = round(margin / one.seconds)
    bins = len(one.edges) - 1
    start, stop = max(first - room, 0), min(after + room, bins)
    log, name = one.window.log, row["manoeuvre"]

    def part(phase: str, a: int, b: int) -> Iterator[Part]:
        if b > a:
            yield Part(name, phase, log, int(one.edges[a]), int(one.edges[b]))

    before, behind = index - 1, index + 1
    alone = len(one.window.manoeuvres) == 1
    if first > 0 and before not in taken:
        yield from part("rest-before", 0 if alone else found[before].first, start)
    if row["recorded"] == "steady" or _some(row["rate"]) is not None:
        a, b = steady_part(_about(one, row, level)[first:after])
        yield from part("spin-up", start, first + a)
        yield from part("steady", first + a, first + b)
        yield from part("spin-down", first + b, stop)
    else:
        yield from part("turning", start, stop)
    if after < bins and behind not in taken:
        yield from part("rest-after", stop, bins if alone else found[behind].after)


def _motion(one: Binned, found: list[Stretch], index: int) -> tuple[int, int]:
    """The bins of a turn; in a window of its own all that moves, pauses included."""
    if len(one.window.manoeuvres) == 1:
        moves = [stretch for stretch in found if stretch.moves]
        return moves[0].first, moves[-1].after
    return found[index].first, found[index].after


# ---- what was performed


def _in_order(performed: list[dict[str, Any]], manoeuvres: pd.DataFrame) -> pd.DataFrame:
    """What was performed, in the order of the plan."""
    order = {name: number for number, name in enumerate(manoeuvres["manoeuvre"])}
    return pd.DataFrame(sorted(performed, key=lambda row: order[row["manoeuvre"]]))


def _row(row: dict[str, Any], **values: Any) -> dict[str, Any]:
    empty = {
        "found": True,
        "complete": True,
        "angle": None,
        "missing_angle": None,
        "missing_s": 0.0,
    }
    return {"manoeuvre": row["manoeuvre"], **empty, "rate": None, "seconds": 0.0, **values}


def _not_found(row: dict[str, Any]) -> dict[str, Any]:
    what = "no rest in the planned direction" if row["do"] == "rest" else "no turn about its axis"
    return _row(
        row,
        found=False,
        complete=False,
        sentence=f"{row['manoeuvre']} is not in {row['log']}: {what} was found where the plan has it.",
    )


def _performed_positions(row: dict[str, Any], number: int) -> dict[str, Any]:
    return _row(
        row,
        found=number > 0,
        complete=number > 0,
        sentence=f"{number} rests of at least {row['seconds']:g} s were found; their attitudes are unknown.",
    )


def _performed_rest(one: Binned, row: dict[str, Any], stretch: Stretch) -> dict[str, Any]:
    seconds = float(one.last_s[stretch.after - 1] - one.first_s[stretch.first])
    if not np.isfinite(seconds):
        records = int(one.edges[stretch.after] - one.edges[stretch.first])
        return _row(row, sentence=f"{records} records at rest, without time.")
    planned = _some(row["seconds"])
    of = f" of the {planned:g} s planned" if planned else ""
    return _row(row, seconds=seconds, sentence=f"{seconds:.2f} s at rest{of}.")


def _performed_turn(
    one: Binned,
    found: list[Stretch],
    index: int,
    row: dict[str, Any],
    parts: list[Part],
    gaps: pd.DataFrame,
    level: Array,
    tolerance: float,
) -> dict[str, Any]:
    first, after = _motion(one, found, index)
    about = _about(one, row, level)
    angle = float(np.nansum(about[first:after] * _bin_seconds(one)[first:after]))
    moves = [p for p in parts if p.phase not in ("rest-before", "rest-after")]
    lost = gaps[
        (gaps["log"] == one.window.log)
        & (gaps["record"] > moves[0].first)
        & (gaps["record"] < moves[-1].after)
    ]
    interval = one.seconds / max(1, one.edges[1] - one.edges[0])
    missing_s = float(lost["missing"].sum() * interval)
    steady = [p for p in parts if p.phase == "steady"]
    rate = None
    if steady:
        inside = (one.edges[:-1] >= steady[0].first) & (one.edges[1:] <= steady[0].after)
        rate = float(np.nanmean(about[inside] if inside.any() else about[first:after]))
    bins = len(one.edges) - 1
    rest_before, rest_after = first > 0, after < bins
    planned = _some(row["angle"])
    seconds = float(one.last_s[after - 1] - one.first_s[first])
    values = {
        "angle": angle,
        "missing_s": missing_s,
        "rate": rate,
        "seconds": seconds if np.isfinite(seconds) else 0.0,
    }
    if row["recorded"] == "steady":
        said = f"steady at {degrees(rate or 0):.4f} °/s" if rate is not None else "no steady rate"
        return _row(row, **values, complete=missing_s == 0, sentence=f"{said}.")
    of = (
        f"{degrees(angle):.2f}° of {degrees(planned):.0f}°" if planned else f"{degrees(angle):.2f}°"
    )
    reasons, remark = [], ""
    if missing_s:
        reasons.append(f"{missing_s:.2f} s are missing while it turns")
    # A hand stops within a bin: what is cut off then is less than the sigma of the angle.
    edges = [] if rest_before else [("begins", about[0])]
    edges += [] if rest_after else [("ends", about[-1])]
    for what, edge in edges:
        if not abs(edge) * BIN / 2 < (_some(row["angle_sigma"]) or 0.0):
            reasons.append(f"the log {what} while it turns")
        else:
            at = degrees(abs(edge))
            remark += f"; it {what} at {at:.0f} °/s, which its sigma covers"
    off = planned is not None and abs(angle / planned - 1) > tolerance
    if off and not reasons:
        reasons.append("the angle is not the planned one")
    if not reasons:
        return _row(row, **values, missing_angle=0.0, sentence=f"{of} from rest to rest{remark}.")
    missing = None
    if missing_s and rate is not None:
        missing = rate * missing_s
    if planned is not None and not (missing_s and rest_before and rest_after and missing):
        missing = planned - angle
    told = f"{of} recorded: {', and '.join(reasons)}"
    if missing is not None:
        told += f"; {degrees(missing):.2f}° are missing"
    return _row(row, **values, complete=False, missing_angle=missing, sentence=f"{told}.")


def _bin_seconds(one: Binned) -> Array:
    per_record = one.seconds / max(1, int(one.edges[1] - one.edges[0]))
    return np.asarray(np.diff(one.edges) * per_record)


def _findings(
    performed: list[dict[str, Any]], manoeuvres: pd.DataFrame, tolerance: float
) -> Iterator[Finding]:
    plan = manoeuvres.set_index("manoeuvre")
    for done in performed:
        name, row = done["manoeuvre"], plan.loc[done["manoeuvre"]]

        def finding(cause: str, **values: Any) -> Finding:
            return Finding(
                id=f"segment/{cause}/{name}",  # noqa: B023 (used within this turn of the loop)
                cause=cause,
                manoeuvre=str(name),  # noqa: B023
                log=str(row["log"]),  # noqa: B023
                **values,
            )

        if not done["found"]:
            yield finding(
                "manoeuvre_missing",
                sentence=done["sentence"],
                consequence="It is left out; the others are used.",
                action="Correct the plan, or record it.",
            )
            continue
        if row["do"] != "turn":
            continue
        if not done["complete"] and row["recorded"] == "whole":
            missing = done["missing_angle"]
            yield finding(
                "incomplete_turn",
                sensor="gyro",
                size=None if missing is None else degrees(missing),
                unit="°",
                sentence=f"{name}: {done['sentence']}",
                consequence="Its angle is not known, so it gives no scale factor.",
                action="It is left out of the angle method. Record it again.",
            )
        planned = _some(row["rate"])
        turned = done["rate"] if planned is not None else done["angle"]
        wanted = planned if planned is not None else _some(row["angle"])
        if wanted is None or turned is None:
            continue
        ratio = turned / wanted
        if ratio < 0:
            yield finding(
                "wrong_direction",
                sensor="gyro",
                size=ratio,
                sentence=f"{name} turns against the planned direction.",
                consequence="The sign of its scale factor would be wrong; it is left out.",
                action="Correct the sign of degrees, or the axes of the gyros.",
            )
        elif planned is not None and abs(ratio - 1) > tolerance:
            unit = abs(ratio * pi / 180 - 1) < tolerance or abs(ratio * 180 / pi - 1) < tolerance
            cause = ": degrees are taken for radians or the other way round" if unit else ""
            yield finding(
                "wrong_rate",
                sensor="gyro",
                size=ratio,
                sentence=f"{name} turns at {degrees(turned):.4g} °/s, {ratio:.6g} times the planned"
                f" {degrees(wanted):.4g} °/s{cause}.",
                consequence="Its angle does not agree with the plan either.",
                action="Correct the rate of the plan, or the unit or count size of the gyros.",
            )


# ---- tables of sums


def _segments(samples: Stream, parts: list[Part]) -> pd.DataFrame:
    sums = _over(samples, [(p.log, p.first, p.after) for p in parts])
    rows = [
        {
            "manoeuvre": part.manoeuvre,
            "phase": part.phase,
            "log": part.log,
            "from_record": part.first,
            "to_record": part.after,
            "from_s": float(total.first[k]),
            "to_s": float(total.last[k]),
        }
        for part, (total, k) in zip(parts, sums, strict=True)
    ]
    return pd.DataFrame(rows) if rows else tables.SEGMENTS.empty()


def _over(
    samples: Stream,
    spans: list[tuple[str, int, int]],
    masks: dict[str, tuple[Integers, Integers]] | None = None,
) -> list[tuple[Sums, int]]:
    """For each span (log, first, after) the sums of its log and its place in them."""
    order: dict[str, list[int]] = {}
    for number, (log, _, _) in enumerate(spans):
        order.setdefault(log, []).append(number)
    for numbers in order.values():
        numbers.sort(key=lambda n: spans[n][1])
    stretches_of = {
        log: (
            np.array([spans[n][1] for n in numbers], np.int64),
            np.array([spans[n][2] for n in numbers], np.int64),
        )
        for log, numbers in order.items()
    }
    sums = sums_over(samples, stretches_of, masks)
    places = {n: (sums[log], k) for log, numbers in order.items() for k, n in enumerate(numbers)}
    return [places[n] for n in range(len(spans))]


def _blocks(
    samples: Stream,
    parts: list[Part],
    gaps: pd.DataFrame,
    masks: pd.DataFrame,
    intervals: dict[str, float],
    rest_block: float,
    turn_block: float,
) -> pd.DataFrame:
    """Every part in blocks of equal length; none reaches across a gap."""
    spans: list[tuple[str, int, int]] = []
    owners: list[Part] = []
    for part in parts:
        seconds = rest_block if part.phase.startswith("rest") else turn_block
        length = max(1, round(seconds / intervals[part.log]))
        cuts = set(range(part.first, part.after, length))
        cuts |= set(gaps.loc[gaps["log"] == part.log, "record"])
        edges = [*sorted(c for c in cuts if part.first <= c < part.after), part.after]
        spans += [(part.log, a, b) for a, b in zip(edges[:-1], edges[1:], strict=True)]
        owners += [part] * (len(edges) - 1)
    masked = {
        str(log): (rows["from_record"].to_numpy(), rows["to_record"].to_numpy())
        for log, rows in masks.groupby("log")
    }
    rows = []
    for owner, (log, a, b), (total, k) in zip(
        owners, spans, _over(samples, spans, masked), strict=True
    ):
        count = float(total.count[k])
        rows.append(
            {
                "manoeuvre": owner.manoeuvre,
                "phase": owner.phase,
                "log": log,
                "from_record": a,
                "to_record": b,
                "time": total.time[k],
                "seconds": count * intervals[log],
                "count": count,
                **dict(zip(tables.CHANNELS, total.mean[k], strict=True)),
                "table_angle": total.table_angle[k],
                "temperature": total.temperature[k],
                "mask_share": total.masked[k] / max(total.records[k], 1),
            }
        )
    return pd.DataFrame(rows) if rows else tables.BLOCKS.empty()


def _traces(samples: Stream, ends: dict[str, int]) -> pd.DataFrame:
    """The extremes of every channel in so many stretches of each log, for figures."""
    edges = {log: regular(n, -(-n // TRACE_POINTS)) for log, n in ends.items()}
    frames = []
    for log, total in sums_over(samples, edges).items():
        first, after = edges[log]
        frames.append(
            pd.DataFrame(
                {
                    "log": log,
                    "from_record": first,
                    "to_record": after,
                    "from_s": total.first,
                    "to_s": total.last,
                    **{f"least_{c}": total.least[:, i] for i, c in enumerate(tables.CHANNELS)},
                    **{f"most_{c}": total.most[:, i] for i, c in enumerate(tables.CHANNELS)},
                }
            )
        )
    return pd.concat(frames) if frames else tables.TRACES.empty()


STAGE = Stage(
    segment,
    reads={
        "samples": tables.SAMPLES,
        "manoeuvres": tables.MANOEUVRES,
        "clocks": tables.CLOCKS,
        "gaps": tables.GAPS,
        "masks": tables.MASKS,
    },
    streams=("samples",),
    writes={
        "segments": tables.SEGMENTS,
        "performed": tables.PERFORMED,
        "blocks": tables.BLOCKS,
        "traces": tables.TRACES,
        "findings": tables.FINDINGS,
    },
)

if __name__ == "__main__":
    STAGE.command_line()
