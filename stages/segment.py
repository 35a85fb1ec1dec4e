"""Where the manoeuvres of the plan are in the logs, and each reduced to short means."""

from collections.abc import Sequence
from dataclasses import asdict

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts import tables
from stages.contracts.findings import table_of
from stages.contracts.parquet import Stream
from stages.contracts.records import Performed, clocks_of, manoeuvres_of
from stages.contracts.samples import extents
from stages.contracts.stage import Stage, Tables
from stages.segmentation import judging, reduction
from stages.segmentation.matching import Part, match, position_parts, rest_part, turn_parts
from stages.segmentation.motion import moving, rest_level, stretches
from stages.segmentation.windows import Binned, binned, windows

SLOWEST = 0.05  # of the slowest planned rate: what counts as motion
UNLIKE_NOISE = 6.0  # times the scatter of the gyros at rest: what is no noise
BY_HAND = np.radians(2.0)  # rad/s: what counts as motion where no rate is planned

Array = NDArray[np.float64]


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
    plan, clock, ends = manoeuvres_of(manoeuvres), clocks_of(clocks), extents(samples)
    every = list(binned(samples, windows(samples, plan, ends), clock))
    level, scatter = _rest_level(every)
    rates = [abs(m.rate) for m in plan if m.rate]
    noise = UNLIKE_NOISE * scatter
    threshold = max(SLOWEST * min(rates) if rates else BY_HAND, noise)

    parts: list[Part] = []
    performed: dict[str, Performed] = {}
    for one in every:
        found = stretches(moving(one.rates, one.forces, level, threshold), one.bin_seconds)
        matched = match(one, found, level)
        if any(matched.get(m.name, 0) is None for m in one.window.manoeuvres if m.do == "turn"):
            # A wrong unit makes a turn too slow to count as motion; then all above the noise does.
            slower = stretches(moving(one.rates, one.forces, level, noise), one.bin_seconds)
            again = match(one, slower, level)
            if sum(place is None for place in again.values()) < list(matched.values()).count(None):
                found, matched = slower, again
        for m in one.window.manoeuvres:
            place = matched.get(m.name)
            if m.do == "positions":
                new = list(position_parts(one, found, m, matched, margin))
                performed[m.name] = judging.positions(m, len(new))
            elif place is None:
                new = []
                performed[m.name] = judging.not_found(m)
            elif m.do == "rest":
                new = [rest_part(one, found[place], m.name, margin)]
                performed[m.name] = judging.rest(one, m, found[place])
            else:
                new = list(turn_parts(one, found, m, matched, level, margin))
                step = clock[m.log].step
                performed[m.name] = judging.turn(
                    one, found, place, m, new, gaps, level, step, angle_tolerance
                )
            parts += new
    findings = [f for m in plan for f in judging.findings(m, performed[m.name], angle_tolerance)]
    return {
        "segments": reduction.segments(samples, parts),
        "performed": pd.DataFrame([asdict(performed[m.name]) for m in plan]),
        "blocks": reduction.blocks(samples, parts, gaps, masks, clock, rest_block, turn_block),
        "traces": reduction.traces(samples, ends),
        "findings": table_of(findings),
    }


def _rest_level(every: Sequence[Binned]) -> tuple[Array, float]:
    """The gyros at rest over the campaign: from the windows of rests alone, if there are any."""
    rests = [one for one in every if {m.do for m in one.window.manoeuvres} == {"rest"}]
    for group in (rests, every):
        rates = [one.rates[np.isfinite(one.rates).all(axis=1)] for one in group]
        together = np.concatenate(rates) if rates else np.empty((0, 3))
        if len(together):
            return rest_level(together)
    return np.zeros(3), 0.0


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
