"""Where the manoeuvres of the plan are in the logs, and each reduced to short means."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.close_ups import close_ups
from inertial.campaign.findings import table_of
from inertial.campaign.log_properties import Stated, records_of, stated_by
from inertial.campaign.masked_samples import Masks, RecordIndex, read_once
from inertial.campaign.records import Manoeuvre, Performed, clocks_of, manoeuvres_of
from inertial.detectors import OF_PLAN, OF_RESTS
from inertial.signal.detector import Log
from inertial.tables import STATIC_PHASES
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from stages.segment import completeness, reduction
from stages.segment.declared import DECLARED
from stages.segment.detection import ExaminationOfRests, compare
from stages.segment.explanations import Explained, explain
from stages.segment.locating import AS_NAMED, Located, divide
from stages.segment.matching import Part, between_parts, position_parts, rest_part, turn_parts
from stages.segment.motion import rest_level
from stages.segment.recorded import recorded_of
from stages.segment.windows import Binned, Bins, Selection, Window, windows

MIN_RATE_SHARE = 0.05  # of the slowest planned rate: what counts as motion
MIN_MOTION_SIGMA = 6.0  # scatters of the gyros at rest: what cannot be noise
MIN_HAND_RATE = np.radians(2.0)  # rad/s: what counts as motion where no rate is planned

Array = NDArray[np.float64]


def segment(
    samples: Stream,
    stated: Stated,
    manoeuvres: pd.DataFrame,
    clocks: pd.DataFrame,
    gaps: pd.DataFrame,
    masks: pd.DataFrame,
    channel_statistics: pd.DataFrame,
    gravity_repairs: pd.DataFrame,
    accepted: pd.DataFrame,
    *,
    repairs: str = "apply",
    rest_block: float,
    turn_block: float,
    margin: float,
    angle_tolerance: float,
) -> Tables:
    """Segments, what was performed of each manoeuvre, blocks, traces, findings and close-ups.

    Two passes over the samples: blocks and the records of a rest are known only after manoeuvres
    were found in short means. Where the plan selects records by time or label, one of these two
    columns before.
    """
    plan, clock, masked = manoeuvres_of(manoeuvres), clocks_of(clocks), Masks(masks)
    by_name = stated.logs(channel_statistics)
    ends = records_of(clocks)

    bins = Bins(_windows(samples, plan, ends), clock, masked)
    traces, of_means = reduction.Traces(ends), reduction.LogsOfMeans(clock)
    read_once(samples, [bins, traces, of_means])
    binned = list(bins.binned())
    level, explained = _explained(binned, plan, stated.earth_rate_up)
    parts, performed, turns = _parts(explained, plan, level, margin)

    block_sums = reduction.Blocks(
        parts, gaps, masked, clock, of_means.names, rest_block, turn_block
    )
    segment_times = reduction.Segments(parts)
    rests, index = ExaminationOfRests(OF_RESTS, parts, by_name, masked), RecordIndex()
    read_once(samples, [block_sums, segment_times, rests, index])
    blocks, segments = block_sums.table(), segment_times.table()
    in_motion = dict(list(blocks[~blocks["phase"].isin(STATIC_PHASES)].groupby("manoeuvre")))
    for located, place, m in turns:
        own = in_motion.get(m.name, blocks.iloc[:0])
        done = completeness.turn(
            located.binned,
            located.stretches,
            place,
            m,
            own,
            gaps,
            level,
            angle_tolerance,
            block_sums.clipped(m.name).get("", np.zeros(6, bool))[3:],
        )
        as_named = located.axes.gyro == AS_NAMED
        performed[m.name] = done if as_named else completeness.by_other_axes(done)
    for m in plan:
        performed[m.name] = completeness.with_clipped(performed[m.name], block_sums.clipped(m.name))
    recorded = recorded_of(
        plan, explained, performed, segments, gaps, _counts(by_name), stated.given, angle_tolerance
    )
    detections = [*compare("segment", OF_PLAN, recorded), *rests.detections("segment")]
    return {
        "manoeuvres": manoeuvres,
        "repairs": [],
        "channel_repairs": [],
        "segments": segments,
        "performed": pd.DataFrame([asdict(performed[m.name]) for m in plan]),
        "blocks": blocks,
        "traces": traces.table(),
        "findings": table_of([each.finding for each in detections]),
        "close_ups": close_ups(samples, index, detections),
    }


def _windows(samples: Stream, plan: Sequence[Manoeuvre], ends: Mapping[str, int]) -> list[Window]:
    """The parts of logs in which manoeuvres are sought."""
    selection = Selection(plan)
    if selection.manoeuvres:
        read_once(samples, [selection])
    return windows(plan, ends, selection)


def _explained(
    binned: Sequence[Binned], plan: Sequence[Manoeuvre], earth_rate_up: float
) -> tuple[Array, Explained]:
    """What the gyros read at rest, (3,), rad/s, and where the manoeuvres are."""
    level, scatter = _rest_level(binned)
    rates = [abs(m.rate) for m in plan if m.rate]
    noise = MIN_MOTION_SIGMA * scatter
    threshold = max(MIN_RATE_SHARE * min(rates) if rates else MIN_HAND_RATE, noise)
    ways = [divide(window, level, threshold, noise) for window in binned]
    return level, explain(ways, earth_rate_up)


def _parts(
    explained: Explained, plan: Sequence[Manoeuvre], level: Array, margin: float
) -> tuple[list[Part], dict[str, Performed], list[tuple[Located, int, Manoeuvre]]]:
    """The phases of all manoeuvres; what was performed of those that do not turn; the turns."""
    parts: list[Part] = []
    turns: list[tuple[Located, int, Manoeuvre]] = []
    performed: dict[str, Performed] = dict(completeness.left_out(explained, plan))
    for located in explained.located:
        binned, stretches, matched = located.binned, located.stretches, located.matched
        first = len(parts)
        for m in located.plan:
            place = matched.get(m.name)
            if m.name in performed:
                continue
            if m.do == "positions":
                own = list(position_parts(binned, stretches, m, matched, margin))
                parts += own
                performed[m.name] = completeness.positions(m, len(own))
            elif place is None:
                performed[m.name] = completeness.not_found(m)
            elif m.do == "rest":
                parts.append(rest_part(binned, stretches[place], m.name, margin))
                performed[m.name] = completeness.rest(binned, m, stretches[place])
            else:
                parts += turn_parts(binned, stretches, m, matched, level, margin)
                turns.append((located, place, m))
        if any(m.do == "positions" for m in located.plan):
            parts += between_parts([p for p in parts[first:] if p.phase in STATIC_PHASES])
    return parts, performed, turns


def _counts(logs_by_name: Mapping[str, Log]) -> dict[str, float]:
    """What a count of the gyros is by the campaign, rad, where they write increments."""
    return {
        name: float(np.nanmedian(log.count[3:])) * log.step
        for name, log in logs_by_name.items()
        if log.increments and np.isfinite(log.count[3:]).any()
    }


def _rest_level(every: Sequence[Binned]) -> tuple[Array, float]:
    """The gyros at rest over the campaign: from the windows of rests alone, if there are any.

    An axis that none of them records does not count; one that some do not record is taken from the
    others.
    """
    rests = [binned for binned in every if {m.do for m in binned.window.manoeuvres} == {"rest"}]
    for group in (rests, every):
        rates = np.concatenate([np.empty((0, 3)), *(binned.rates for binned in group)])
        recorded = np.isfinite(rates).any(axis=0)
        whole = rates[np.isfinite(rates[:, recorded]).all(axis=1)] if recorded.any() else []
        if len(whole):
            return rest_level(np.where(recorded, whole, 0.0))
    return np.zeros(3), 0.0


STAGE = Stage(segment, DECLARED, gathers={"stated": stated_by})
