"""The samples reduced to what later stages use: segments, blocks of means, traces for figures."""

from collections.abc import Mapping, Sequence
from dataclasses import fields

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial import tables
from inertial.campaign.masked_samples import Integers, Masks, pieces, regular
from inertial.campaign.records import Clock
from inertial.campaign.sums import Sums, sums_over
from inertial.tables.parquet import Stream
from stages.segment.matching import BETWEEN, Part

Floats = NDArray[np.float64]

TRACE_POINTS = 1200  # per log, what a figure shows


def segments(samples: Stream, parts: Sequence[Part]) -> pd.DataFrame:
    """The phases of all manoeuvres with their records and times."""
    if not parts:
        return tables.SEGMENTS.empty()
    table = _spans(parts, [(np.array([p.first]), np.array([p.after])) for p in parts])
    total = _over(samples, table)
    return table.assign(from_s=total["first"], to_s=total["last"])


def blocks(
    samples: Stream,
    parts: Sequence[Part],
    gaps: pd.DataFrame,
    masks: Masks,
    clocks: Mapping[str, Clock],
    rest_block: float,
    turn_block: float,
) -> pd.DataFrame:
    """Every part in blocks of equal length; none reaches across a gap, or masked gyros in a turn.

    A turn has no blocks where its gyros are masked: what is missing stands in the block behind.
    """
    hidden = _hidden(parts, masks)
    of_means = _of_means(samples, clocks)
    edges: list[tuple[Integers, Integers]] = []
    for part in parts:
        seconds = rest_block if part.phase.startswith("rest") else turn_block
        length = max(1, round(seconds / clocks[part.log].step))
        # A hand turns about ever other axes; of records that are means already, each is a block.
        if part.phase == BETWEEN or part.log in of_means:
            length = 1
        unseen = hidden.get(part.manoeuvre, np.array([], np.int64))
        cuts = (
            np.arange(part.first, part.after, length),
            gaps.loc[gaps["log"] == part.log, "record"].to_numpy(np.int64),
            unseen[np.diff(unseen, prepend=-2) > 1],
            unseen[np.diff(unseen, append=np.iinfo(np.int64).max) > 1] + 1,
        )
        starts = np.unique(np.concatenate(cuts))
        starts = starts[(part.first <= starts) & (starts < part.after)]
        ends = np.append(starts[1:], part.after)
        seen = ~np.isin(starts, unseen)
        edges.append((starts[seen], ends[seen]))
    table = _spans(parts, edges)
    if table.empty:
        return tables.BLOCKS.empty()
    total = _over(samples, table, masks)
    duration = table["log"].map({log: clock.duration or np.nan for log, clock in clocks.items()})
    table = table.assign(
        time=total["time"],
        seconds=total["count"] * duration.to_numpy(np.float64),
        count=total["count"],
        missing_s=0.0,
        **dict(zip(tables.CHANNELS, total["mean"].T, strict=True)),
        table_angle=total["table_angle"],
        temperature=total["temperature"],
        mask_share=total["masked"] / np.maximum(total["records"], 1),
        first=total["first"],
        last=total["last"],
    )
    table = table[(total["records"] > 0) | table["phase"].str.startswith("rest")]
    table = table.reset_index(drop=True)
    for _, turn in table[~table["phase"].str.startswith("rest")].groupby("manoeuvre"):
        log = turn["log"].iloc[0]
        after_gap = turn["from_record"].isin(gaps.loc[gaps["log"] == log, "record"])
        table.loc[turn.index, "missing_s"] = _missing(turn, after_gap, clocks[log])
    return table.drop(columns=["first", "last"])


def _of_means(samples: Stream, clocks: Mapping[str, Clock]) -> set[str]:
    """The logs without time whose records are means of many samples."""
    if all(clock.duration for clock in clocks.values()):
        return set()
    return {
        log
        for log, piece in pieces(samples, ["mean_of"])
        if clocks[log].duration is None and bool((np.nan_to_num(piece["mean_of"]) > 1).any())
    }


def _hidden(parts: Sequence[Part], masks: Masks) -> dict[str, Integers]:
    """For each turn the records in motion whose gyros are not to be used.

    A gyro that is masked in all of them is one that was not recorded, and hides no other.
    """
    turns: dict[str, list[Part]] = {}
    for part in parts:
        if not part.phase.startswith("rest"):
            turns.setdefault(part.manoeuvre, []).append(part)
    hidden = {}
    for name, own in turns.items():
        records = np.concatenate([np.arange(part.first, part.after) for part in own])
        masked = masks.of(own[0].log, records)
        gyros = masked.channels[:, len(tables.CHANNELS) // 2 :]
        unseen = masked.lost | gyros[:, ~gyros.all(axis=0)].any(axis=1)
        hidden[name] = records[unseen & ~masked.repeated]
    return hidden


def _missing(turn: pd.DataFrame, after_gap: pd.Series, clock: Clock) -> Floats:
    """The time that is missing before each block of a turn, (k,), s; negative where time goes back.

    By the stamps; where they tell a whole number of samples within their own scatter, that.
    """
    missing = np.zeros(len(turn))
    step = clock.duration
    if step is None:
        return missing
    pause = np.nan_to_num(turn["first"].to_numpy()[1:] - turn["last"].to_numpy()[:-1] - step)
    hole = after_gap.to_numpy()[1:]
    hole = hole | (turn["from_record"].to_numpy()[1:] != turn["to_record"].to_numpy()[:-1])
    scatter = np.sqrt(np.mean(pause[~hole] ** 2)) if (~hole).any() else 0.0
    whole = step * np.round(pause / step)
    near = np.abs(pause - whole) <= max(3 * scatter, 1e-3 * step)
    missing[1:] = np.where(hole, np.where(near, whole, pause), 0.0)
    return missing


def traces(samples: Stream, ends: Mapping[str, int]) -> pd.DataFrame:
    """The extremes of every channel in so many stretches of each log."""
    edges = {log: regular(n, -(-n // TRACE_POINTS)) for log, n in ends.items()}
    frames = [
        pd.DataFrame(
            {
                "log": log,
                "from_record": edges[log][0],
                "to_record": edges[log][1],
                "from_s": total.first,
                "to_s": total.last,
                **{f"least_{c}": total.least[:, i] for i, c in enumerate(tables.CHANNELS)},
                **{f"most_{c}": total.most[:, i] for i, c in enumerate(tables.CHANNELS)},
            }
        )
        for log, total in sums_over(samples, edges).items()
    ]
    return pd.concat(frames) if frames else tables.TRACES.empty()


def _spans(parts: Sequence[Part], edges: Sequence[tuple[Integers, Integers]]) -> pd.DataFrame:
    """The spans of each part, from their first records up to those after the last."""
    lengths = [len(starts) for starts, _ in edges]
    names = {
        name: np.repeat(np.array([getattr(part, name) for part in parts], object), lengths)
        for name in ("manoeuvre", "phase", "log")
    }
    none = np.empty(0, np.int64)
    first = np.concatenate([none, *(starts for starts, _ in edges)])
    after = np.concatenate([none, *(ends for _, ends in edges)])
    return pd.DataFrame({**names, "from_record": first, "to_record": after})


def _over(samples: Stream, spans: pd.DataFrame, masks: Masks | None = None) -> dict[str, Floats]:
    """What `Sums` tells of each of n spans, (n,) or (n, 6)."""
    first, after = (spans[name].to_numpy() for name in ("from_record", "to_record"))
    places = {
        str(log): place[np.argsort(first[place], kind="stable")]
        for log, place in spans.groupby("log", sort=False).indices.items()
    }
    stretches = {log: (first[place], after[place]) for log, place in places.items()}
    told: dict[str, Floats] = {}
    for log, sums in sums_over(samples, stretches, masks).items():
        for field in fields(Sums):
            values = getattr(sums, field.name)
            whole = told.setdefault(field.name, np.empty((len(spans), *values.shape[1:])))
            whole[places[log]] = values
    return told
