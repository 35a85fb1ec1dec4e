"""The samples reduced to what later stages use: segments, blocks of means, traces for figures."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from inertial import tables
from inertial.arrays import Array, Booleans, Integers
from inertial.campaign.encoder import EdgesOver
from inertial.campaign.masked_samples import Batch, Masks, regular
from inertial.campaign.records import Clock, Manoeuvre, grouped
from inertial.campaign.static_positions import ENCODER
from inertial.campaign.sums import ExtremesOver, SumsOver, TimesOver
from inertial.tables import STATIC_PHASES
from stages.segment.matching import BETWEEN, SETTLING, Part

TRACE_POINTS = 1200  # per log, what a figure shows
MAX_EARLY = 50  # samples, by which a record comes too early in a log


class _Spans:
    """The spans of records of a table, and their places in the sums of each log, which ascend."""

    def __init__(self, spans: pd.DataFrame) -> None:
        first, after = (spans[name].to_numpy() for name in ("from_record", "to_record"))
        self.places = {
            str(log): place[np.argsort(first[place], kind="stable")]
            for log, place in spans.groupby("log", sort=False).indices.items()
        }
        self.stretches = {log: (first[place], after[place]) for log, place in self.places.items()}

    def in_order(self, by_log: Mapping[str, Array]) -> Array:
        """The sums of all logs, (k,) or (k, 6) each, in the order of the spans."""
        both = np.concatenate(list(by_log.values()))
        places = np.concatenate([self.places[log] for log in by_log])
        made = np.empty_like(both)
        made[places] = both
        return made


class Segments(TimesOver):
    """The phases of all manoeuvres with their records and times."""

    def __init__(self, parts: Sequence[Part]) -> None:
        self._table = _spans(parts, [(np.array([p.first]), np.array([p.after])) for p in parts])
        self._spans = _Spans(self._table)
        super().__init__(self._spans.stretches)

    def table(self) -> pd.DataFrame:
        """The table of segments, once every batch was added."""
        if self._table.empty:
            return tables.SEGMENTS.empty()
        times = self.result()
        first, last = (
            self._spans.in_order({log: both[end] for log, both in times.items()}) for end in (0, 1)
        )
        return self._table.assign(from_s=first, to_s=last)


class Blocks(SumsOver):
    """Every part in blocks of equal length; none reaches across a gap, or masked gyros in a turn.

    A turn has no blocks where its gyros are masked: what is missing stands in the block behind. A
    channel that is cut off at the end of its range anywhere in a static position, or in a turn
    from start to stop, has no mean in any block of it: half of its noise is left, or less.

    Parameters
    ----------
    in_samples : logs of means of which a sample stands for 1 s, for its noise is known so
    rest_block, turn_block : s, length of a block
    """

    def __init__(
        self,
        parts: Sequence[Part],
        gaps: pd.DataFrame,
        masks: Masks,
        clocks: Mapping[str, Clock],
        in_samples: set[str],
        rest_block: float,
        turn_block: float,
    ) -> None:
        self._gaps = {
            str(log): rows["record"].to_numpy(np.int64) for log, rows in gaps.groupby("log")
        }
        self._clocks = clocks
        self._seconds = {
            log: clock.step if log in in_samples else clock.interval or np.nan
            for log, clock in clocks.items()
        }
        hidden = _hidden(parts, masks)
        self._clipped = _clipped(parts, masks)
        edges: list[tuple[Integers, Integers]] = []
        for part in parts:
            seconds = rest_block if part.phase in STATIC_PHASES else turn_block
            length = max(1, round(seconds / clocks[part.log].step))
            if part.phase == SETTLING:  # what swings on adds up to nothing
                length = max(1, part.after - part.first)
            # A hand turns about ever other axes; records without a time are means.
            if part.phase == BETWEEN or clocks[part.log].interval is None:
                length = 1
            unseen = hidden.get(part.manoeuvre, np.array([], np.int64))
            edges.append(_edges(part, length, self._gaps_of(part.log), unseen))
        self._table = _spans(parts, edges)
        self._spans = _Spans(self._table)
        super().__init__(self._spans.stretches, masks)
        self._encoder = EdgesOver(self._spans.stretches)

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        super().add(batch)
        self._encoder.add(batch)

    def clipped(self, name: str) -> dict[str, Booleans]:
        """Which channels are cut off in a manoeuvre, (6,), by phase; that of motion is ""."""
        return {phase: cut for (of, phase), cut in self._clipped.items() if of == name}

    def _cut_off(self) -> Booleans:
        """Which channels have no mean in which blocks, (k, 6)."""
        cut = np.zeros((len(self._table), len(tables.CHANNELS)), bool)
        if self._clipped:
            phases = self._table["phase"].where(self._table["phase"].isin(STATIC_PHASES), "")
            keys = zip(self._table["manoeuvre"], phases, strict=True)
            for k, key in enumerate(keys):
                if key in self._clipped:
                    cut[k] = self._clipped[key]
        return cut

    def _gaps_of(self, log: str) -> Integers:
        return self._gaps.get(log, np.array([], np.int64))

    def table(self) -> pd.DataFrame:
        """The table of blocks, once every batch was added."""
        table = self._table
        if table.empty:
            return tables.BLOCKS.empty()
        sums = self.result()

        def column(name: str) -> Array:
            return self._spans.in_order({log: getattr(own, name) for log, own in sums.items()})

        encoder = self._encoder.result()
        edges = {
            name: self._spans.in_order({log: getattr(own, name) for log, own in encoder.items()})
            for name in ENCODER
        }
        count, records = column("count"), column("records")
        means = column("mean")
        means[self._cut_off()] = np.nan
        table = table.assign(
            time=column("time"),
            seconds=count * table["log"].map(self._seconds).to_numpy(np.float64),
            count=count,
            missing_s=0.0,
            **dict(zip(tables.CHANNELS, means.T, strict=True)),
            table_angle=column("table_angle"),
            **edges,
            temperature=column("temperature"),
            mask_share=column("masked") / np.maximum(records, 1),
            first=column("first"),
            last=column("last"),
        )
        rest = table["phase"].isin(STATIC_PHASES)
        table.loc[rest, ENCODER] = np.nan
        table = table[(records > 0) | rest].reset_index(drop=True)
        for _, turn in table[~table["phase"].isin(STATIC_PHASES)].groupby("manoeuvre"):
            log = turn["log"].iloc[0]
            after_gap = turn["from_record"].isin(self._gaps_of(log))
            table.loc[turn.index, "missing_s"] = _missing(turn, after_gap, self._clocks[log])
        return table.drop(columns=["first", "last"])


def with_temperatures(blocks: pd.DataFrame, plan: Sequence[Manoeuvre]) -> pd.DataFrame:
    """The table of blocks with a temperature where none is recorded, K.

    That which is stated, or else, in a log that records some, one between those before and after.
    """
    stated = {m.name: m.temperature for m in plan if m.temperature is not None}
    recorded = blocks["temperature"].to_numpy(np.float64)
    filled = recorded.copy()
    if stated:
        planned = blocks["manoeuvre"].map(stated).to_numpy(np.float64)
        filled = np.where(np.isnan(filled), planned, filled)
    for places in blocks.groupby("log").indices.values():
        own, record = recorded[places], blocks["from_record"].to_numpy()[places]
        known = np.isfinite(own)
        if known.any() and np.isnan(filled[places]).any():
            order = np.argsort(record[known])
            between = np.interp(record, record[known][order], own[known][order])
            filled[places] = np.where(np.isnan(filled[places]), between, filled[places])
    return blocks.assign(temperature=filled)


def _edges(part: Part, length: int, gaps: Integers, unseen: Integers) -> tuple[Integers, Integers]:
    """The first records of the blocks of a part, and those after their last.

    gaps : the first records after gaps
    unseen : records that are to be in no block
    """
    cuts = (
        np.arange(part.first, part.after, length),
        gaps,
        unseen[np.diff(unseen, prepend=-2) > 1],
        unseen[np.diff(unseen, append=np.iinfo(np.int64).max) > 1] + 1,
    )
    starts = np.unique(np.concatenate(cuts))
    starts = starts[(part.first <= starts) & (starts < part.after)]
    ends = np.append(starts[1:], part.after)
    seen = ~np.isin(starts, unseen)
    return starts[seen], ends[seen]


def _hidden(parts: Sequence[Part], masks: Masks) -> dict[str, Integers]:
    """For each turn the records in motion whose gyros are not to be used.

    A gyro that is masked in all of them is one that was not recorded, and hides no other; nor does
    one that is cut off at the end of its range, which is not used in the turn.
    """
    moving = (part for part in parts if part.phase not in STATIC_PHASES)
    turns = grouped(moving, lambda part: part.manoeuvre)
    hidden = {}
    for name, own in turns.items():
        records = np.concatenate([np.arange(part.first, part.after) for part in own])
        masked = masks.of(own[0].log, records)
        unread = masked.channels
        if own[0].phase != BETWEEN:
            unread = unread & ~masked.censored  # of these no block is used
        gyros = unread[:, len(tables.CHANNELS) // 2 :]
        unseen = masked.lost | gyros[:, ~gyros.all(axis=0)].any(axis=1)
        hidden[name] = records[unseen & ~masked.repeated]
    return hidden


def _clipped(parts: Sequence[Part], masks: Masks) -> dict[tuple[str, str], Booleans]:
    """The channels, (6,), that are cut off in a static phase, or in a turn, whose phase is ""."""
    clipped: dict[tuple[str, str], Booleans] = {}
    for part in parts:
        if part.phase == BETWEEN:
            continue  # it has only what is not masked
        masked = masks.of(part.log, np.arange(part.first, part.after))
        cut = np.asarray(masked.censored.any(axis=0), bool)
        if cut.any():
            key = (part.manoeuvre, part.phase if part.phase in STATIC_PHASES else "")
            clipped[key] = cut | clipped.get(key, cut)
    return clipped


def _missing(turn: pd.DataFrame, after_gap: pd.Series, clock: Clock) -> Array:
    """The time that is missing before each block of a turn, (k,), s; negative where time goes back.

    By the stamps; where they give a whole number of samples within their own scatter, that. Of
    records that came too early nothing is missing, though time leaps before them.
    """
    missing = np.zeros(len(turn))
    step = clock.interval
    if step is None:
        return missing
    pause = np.nan_to_num(turn["first"].to_numpy()[1:] - turn["last"].to_numpy()[:-1] - step)
    hole = after_gap.to_numpy()[1:]
    hole = hole | (turn["from_record"].to_numpy()[1:] != turn["to_record"].to_numpy()[:-1])
    scatter = np.sqrt(np.mean(pause[~hole] ** 2)) if (~hole).any() else 0.0
    whole = step * np.round(pause / step)
    near = np.abs(pause - whole) <= max(3 * scatter, 1e-3 * step)
    missing[1:] = np.where(hole, np.where(near, whole, pause), 0.0)
    spanned = (turn["last"] - turn["first"]).to_numpy() - step * (turn["count"].to_numpy() - 1)
    within = step * np.round(np.nan_to_num(spanned) / step)
    # A clock that goes back farther was set, or began again.
    leaps, within = (np.where(np.abs(t) < MAX_EARLY * step, t, 0.0) for t in (whole, within))
    if (leaps < -step).any() or (within < 0).any():
        missing[1:] = _in_order(np.where(hole, missing[1:], leaps) + within[1:])
    return missing


def _in_order(missing: Array) -> Array:
    """What is missing before blocks, (k,), s, of adjacent ones, some of them negative, together."""
    starts = np.flatnonzero((missing != 0) & (np.append(0.0, missing[:-1]) == 0))
    ordered = missing.copy()
    for start in starts:
        own = slice(start, start + int(np.argmin(np.append(missing[start:], 0.0) != 0)))
        if (missing[own] < 0).any():
            ordered[own] = 0.0
            ordered[start] = missing[own].sum()
    return ordered


class Traces(ExtremesOver):
    """The extremes of every channel in as many stretches of each log as a figure shows.

    Parameters
    ----------
    ends : of each log the number after its last record
    """

    def __init__(self, ends: Mapping[str, int]) -> None:
        self._edges = {log: regular(end, -(-end // TRACE_POINTS)) for log, end in ends.items()}
        super().__init__(self._edges)

    def table(self) -> pd.DataFrame:
        """The table of traces, once every batch was added."""
        frames = [
            pd.DataFrame(
                {
                    "log": log,
                    "from_record": self._edges[log][0],
                    "to_record": self._edges[log][1],
                    "from_s": extremes.first,
                    "to_s": extremes.last,
                    **{f"least_{c}": extremes.least[:, i] for i, c in enumerate(tables.CHANNELS)},
                    **{f"most_{c}": extremes.most[:, i] for i, c in enumerate(tables.CHANNELS)},
                }
            )
            for log, extremes in self.result().items()
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
