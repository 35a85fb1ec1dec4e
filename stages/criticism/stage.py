"""Which physical effects the simulation lacks, by name."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import pandas as pd

from inertial.campaign.campaign_data import CampaignData, campaigns_of
from inertial.campaign.equations import Campaign, campaign_of
from inertial.campaign.steady_residuals import steady_turns
from inertial.effects import CATALOGUE
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from stages.criticism import block_results, residual_structure, temperature_findings
from stages.criticism.bias_drift import walks_with_sigmas
from stages.criticism.block_results import Rows, unexplained
from stages.criticism.class_splitting import Foreseen, Further, further
from stages.criticism.declared import DECLARED
from stages.criticism.oscillation_results import LinesOfTurns
from stages.criticism.oscillation_search import heard, without_lines
from stages.criticism.residual_structure import tested
from stages.criticism.selection import SENSORS, judge

Row = dict[str, Any]

PLACES = ("blocks", "spectrum", "noise", "quality")
BLOCKS_SHARE = 0.9  # of the accepted chance of a false name; the rest is that of the spectrum


def criticism(
    mounts: Sequence[CampaignData],
    simulated: Stream,
    *,
    level: float,
    lowest_hz: float,
) -> Tables:
    """Scores of every effect of the catalogue, its estimates, the lines, and the findings.

    `level` is the accepted chance of naming anything where nothing is missing.
    """
    sought = {place: [e for e in CATALOGUE.values() if e.sought_in == place] for place in PLACES}
    in_blocks = sought["blocks"]
    others = [*sought["noise"], *sought["quality"]]
    made: dict[str, list[Row]] = {name: [] for name in DECLARED.writes}
    for data in mounts:
        suffix, degrees = data.named(""), data.noise.degrees
        turns = steady_turns(data, simulated)
        found = heard(turns, level * (1 - BLOCKS_SHARE), lowest_hz)
        quiet = without_lines(data.blocks, turns, found.lines)
        campaign = campaign_of(replace(data, blocks=quiet))
        judged = judge(campaign, in_blocks, level * BLOCKS_SHARE, degrees)
        left = tested(judged.campaign, judged.effects, degrees)
        judged = judged.demoted([sensor for sensor in SENSORS if left.of(sensor)])
        walks = walks_with_sigmas(judged.campaign, judged.effects)
        more = {
            name: partial(_with, make, data)
            for name, make in further(data.plan, data.performed, quiet).items()
        }
        rows = Rows(campaign, judged, Foreseen(judged, more), suffix)
        lines = LinesOfTurns(found, suffix)
        made["scores"] += [*rows.scores(), *lines.scores()]
        made["scores"] += block_results.noise_scores(others, walks.get("gyro"))
        for sensor, walk in walks.items():
            structured = bool(left.of(sensor))
            made["findings"] += block_results.walk_findings(
                sensor, walk, judged.instead, suffix, structured=structured
            )
            made["walks"].append(block_results.walk_row(f"joint{suffix}", sensor, walk))
        made["structures"] += residual_structure.test_rows(left, f"joint{suffix}")
        made["structure_points"] += residual_structure.point_rows(left, f"joint{suffix}")
        made["effects"] += [*rows.effects(), *lines.effects()]
        made["blind_spots"] += [*rows.blind_spots(), *lines.blind_spots()]
        made["lines"] += lines.lines()
        made["findings"] += rows.findings()
        made["findings"] += lines.findings()
        made["findings"] += residual_structure.findings(left, judged.consistent(), suffix)
        made["findings"] += unexplained(judged, suffix)
        made["findings"] += temperature_findings.findings(data.blocks, data.plan, level, suffix)
    return {
        name: pd.DataFrame(rows, columns=[column.name for column in table.columns])
        if rows
        else table.empty()
        for (name, table), rows in zip(DECLARED.writes.items(), made.values(), strict=True)
    }


def _with(make: Callable[[], Further], data: CampaignData) -> Campaign:
    """The campaign with a further manoeuvre, all else equal."""
    one = make()
    return campaign_of(replace(data, blocks=one.blocks, plan=one.plan, performed=one.performed))


STAGE = Stage(criticism, DECLARED, gathers={"mounts": campaigns_of})
