"""Where the manoeuvres of the plan are in the logs, and each reduced to short means."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.close_ups import close_ups
from inertial.campaign.findings import table_of
from inertial.campaign.log_properties import given_by, logs
from inertial.campaign.masked_samples import Masks, extents
from inertial.campaign.records import Manoeuvre, Performed, clocks_of, known_of, manoeuvres_of
from inertial.detectors import OF_PLAN, OF_RESTS
from inertial.signal.detector import Log
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from stages.segment import completeness, reduction
from stages.segment.declared import DECLARED
from stages.segment.detection_against_plan import compare
from stages.segment.detection_in_positions import rests_of, screen
from stages.segment.explanations import explain
from stages.segment.locating import AS_NAMED, Located, shown
from stages.segment.matching import Part, between_parts, position_parts, rest_part, turn_parts
from stages.segment.motion import rest_level
from stages.segment.recorded import recorded_of
from stages.segment.windows import Binned, binned, windows

SLOWEST = 0.05  # of the slowest planned rate: what counts as motion
UNLIKE_NOISE = 6.0  # times the scatter of the gyros at rest: what is no noise
BY_HAND = np.radians(2.0)  # rad/s: what counts as motion where no rate is planned

Array = NDArray[np.float64]


def segment(
    samples: Stream,
    campaign: pd.DataFrame,
    known: pd.DataFrame,
    ranges: pd.DataFrame,
    count_sizes: pd.DataFrame,
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
    """Segments, what was performed of each manoeuvre, blocks, traces, findings and close-ups."""
    plan, clock, ends = manoeuvres_of(manoeuvres), clocks_of(clocks), extents(samples)
    masked = Masks(masks)
    every = list(binned(samples, windows(samples, plan, ends), clock, masked))
    level, scatter = _rest_level(every)
    rates = [abs(m.rate) for m in plan if m.rate]
    noise = UNLIKE_NOISE * scatter
    threshold = max(SLOWEST * min(rates) if rates else BY_HAND, noise)
    earth = known_of(known)["earth_rate_up"].number
    explained = explain([shown(one, level, threshold, noise) for one in every], earth)

    parts: list[Part] = []
    turns: list[tuple[Located, int, Manoeuvre]] = []
    performed: dict[str, Performed] = {}
    left = dict(completeness.left_out(explained, plan))
    for located in explained.located:
        one, found, matched = located.one, located.found, located.matched
        first = len(parts)
        for m in located.plan:
            place = matched.get(m.name)
            if m.name in left:
                new = []
                performed[m.name] = left[m.name]
            elif m.do == "positions":
                new = list(position_parts(one, found, m, matched, margin))
                performed[m.name] = completeness.positions(m, len(new))
            elif place is None:
                new = []
                performed[m.name] = completeness.not_found(m)
            elif m.do == "rest":
                new = [rest_part(one, found[place], m.name, margin)]
                performed[m.name] = completeness.rest(one, m, found[place])
            else:
                new = list(turn_parts(one, found, m, matched, level, margin))
                turns.append((located, place, m))
            parts += new
        if any(m.do == "positions" for m in located.plan):
            parts += between_parts([p for p in parts[first:] if p.phase.startswith("rest")])
    blocks = reduction.blocks(samples, parts, gaps, masked, clock, rest_block, turn_block)
    in_motion = dict(list(blocks[~blocks["phase"].str.startswith("rest")].groupby("manoeuvre")))
    for located, place, m in turns:
        own = in_motion.get(m.name, blocks.iloc[:0])
        done = completeness.turn(
            located.one, located.found, place, m, own, gaps, level, angle_tolerance
        )
        as_named = located.axes.gyro == AS_NAMED
        performed[m.name] = done if as_named else completeness.by_other_axes(done)
    segments = reduction.segments(samples, parts)
    given = given_by(campaign, known, count_sizes, clocks)
    looked = logs(samples, clocks, ranges, given)
    recorded = recorded_of(
        plan, explained, performed, segments, gaps, _counts(looked), given, angle_tolerance
    )
    told = [
        *compare("segment", OF_PLAN, recorded),
        *screen("segment", OF_RESTS, samples, rests_of(segments), masked, looked),
    ]
    return {
        "segments": segments,
        "performed": pd.DataFrame([asdict(performed[m.name]) for m in plan]),
        "blocks": blocks,
        "traces": reduction.traces(samples, ends),
        "findings": table_of([one.finding for one in told]),
        "close_ups": close_ups(samples, told),
    }


def _counts(looked: Mapping[str, Log]) -> dict[str, float]:
    """What a count of the gyros is by the campaign, rad, where they write increments."""
    return {
        name: float(np.nanmedian(log.count[3:])) * log.step
        for name, log in looked.items()
        if log.increments and np.isfinite(log.count[3:]).any()
    }


def _rest_level(every: Sequence[Binned]) -> tuple[Array, float]:
    """The gyros at rest over the campaign: from the windows of rests alone, if there are any.

    An axis that none of them records does not count; one that some do not record is told by the
    others.
    """
    rests = [one for one in every if {m.do for m in one.window.manoeuvres} == {"rest"}]
    for group in (rests, every):
        rates = np.concatenate([np.empty((0, 3)), *(one.rates for one in group)])
        recorded = np.isfinite(rates).any(axis=0)
        whole = rates[np.isfinite(rates[:, recorded]).all(axis=1)] if recorded.any() else []
        if len(whole):
            return rest_level(np.where(recorded, whole, 0.0))
    return np.zeros(3), 0.0


STAGE = Stage(segment, DECLARED)
