"""The unmodelled effects of a campaign, by name."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import pandas as pd

from inertial.campaign.campaign_data import MOUNTS, CampaignData
from inertial.campaign.equations import Campaign
from inertial.campaign.observations import campaign_of
from inertial.campaign.steady_residuals import steady_turns
from inertial.effects import CATALOGUE
from inertial.sensors import SENSORS
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from stages.criticism.angle_steps import step_rows
from stages.criticism.bias_drift import random_walks_with_sigmas
from stages.criticism.block_results import NAMED, BlockResults, unexplained_rows
from stages.criticism.class_splitting import ExtendedCampaigns, ExtendedPlan, extended_plans
from stages.criticism.declared import DECLARED
from stages.criticism.drift_at_rest import select_beside_drift, unsteady_rests
from stages.criticism.finding_rows import Row, TableRow
from stages.criticism.laws import with_laws, without_law
from stages.criticism.oscillation_removal import (
    shifts,
    shifts_by_steps,
    with_rests,
    without_lines,
)
from stages.criticism.oscillation_results import OscillationResults
from stages.criticism.oscillation_search import find_oscillations
from stages.criticism.position_scatter import (
    PositionScatter,
    rest_scatter_rows,
    select_beside_scatter,
)
from stages.criticism.random_walk_results import other_scores, random_walk_rows, walk_at_rest_rows
from stages.criticism.residual_structure import Tested, structure_rows, structure_tests
from stages.criticism.restarts import (
    at_changes,
    beginning_again,
    is_better,
    named_at_gap,
    restarts_at,
    times_of_gaps,
)
from stages.criticism.rivals import off_rows, select_beside_one_manoeuvre
from stages.criticism.selection import Selection, pooled_evidence_rows
from stages.criticism.temperature_findings import temperature_rows
from stages.criticism.temperature_functions import select_with_temperature

# Of the accepted probability of any false finding: what names effects, tests the residuals for
# structure, compares them with the noise, searches the spectrum, and functions of temperature.
BLOCKS_SHARE, STRUCTURE_SHARE, UNEXPLAINED_SHARE = 0.5, 0.2, 0.1
SPECTRUM_SHARE, TEMPERATURE_SHARE = 0.1, 0.1

# The named effects, the tests of what they leave, the campaign of both; a scatter of positions.
Selected = tuple[tuple[Selection, Tested, Campaign], PositionScatter | None]


def criticism(
    mounts: Sequence[CampaignData],
    simulated: Stream,
    gaps: pd.DataFrame,
    allan: pd.DataFrame,
    *,
    level: float,
    lowest_hz: float,
) -> Tables:
    """Scores and parameters of every effect of the catalogue, detection limits, and findings.

    `level` is the accepted probability of any finding where the model is complete.
    """
    rows: dict[str, list[Row]] = {name: [] for name in DECLARED.writes}
    for data in mounts:
        for table, row in _of_mount(data, simulated, gaps, allan, level, lowest_hz):
            rows[table].append(row)
    return rows


def _of_mount(
    data: CampaignData,
    simulated: Stream,
    gaps: pd.DataFrame,
    allan: pd.DataFrame,
    level: float,
    lowest_hz: float,
) -> Iterator[TableRow]:
    """Oscillations are removed first: in block means they would be taken for other effects."""
    mount, degrees = data.mount, data.noise.degrees
    recorded = steady_turns(data, simulated)
    spectrum = find_oscillations(recorded, level * SPECTRUM_SHARE, lowest_hz)
    turns = spectrum.turns
    spectrum = replace(spectrum, oscillations=with_rests(turns, spectrum.oscillations))
    quiet = without_lines(data.blocks, data.plan, turns, spectrum.oscillations)
    measured = campaign_of(replace(data, blocks=quiet))
    without = partial(_without, data=replace(data, blocks=quiet))
    select = partial(_selected, measured, without, level, degrees)
    at_gaps = times_of_gaps(measured, gaps, data.clocks)
    (selection, tested, campaign), scatter = _with_restarts(select, at_gaps, level * BLOCKS_SHARE)
    selection = named_at_gap(selection)
    selection = selection.without_certain_names([sensor for sensor in SENSORS if tested.of(sensor)])
    selection = selection.consistent_with_rounding({s: data.noise.rounded(s) for s in SENSORS})
    for sensor, drift in measured.drifts.items():
        if drift:
            kept = campaign.drifts[sensor] is drift
            yield "drifts_at_rest", {"mount": mount, "sensor": sensor, "kept": kept}
    if scatter is not None:
        yield from scatter.rows(mount)
    random_walks = random_walks_with_sigmas(selection.campaign, selection.fitted)
    plans = {} if data.by_hand else extended_plans(data.plan, data.performed, quiet)
    extended = {name: partial(_with, plan, data) for name, plan in plans.items()}
    lawful = {selection.sensor(cause) for cause in selection.named.causes if cause.verdict in NAMED}
    drifts = measured.drifts.items()
    walks = {s: drift.walk for s, drift in drifts if drift.walk.any()}
    shown = {s: walks.get(s, np.zeros(3)) for s in {**walks, **random_walks}}
    unsteady = {s: unsteady_rests(data, s, walk, allan) for s, walk in shown.items()}
    at_rest = {s: walk for s, walk in walks.items() if unsteady[s] or s not in lawful}
    lawless = without_law(selection, {*random_walks, *at_rest}, tested)
    for sensor, sizes in at_rest.items():
        if sensor not in random_walks:
            yield from walk_at_rest_rows(sensor, sizes, unsteady[sensor], lawless, mount)
    for sensor, walk in random_walks.items():
        yield from random_walk_rows(
            sensor, walk, unsteady[sensor], selection.alternatives, lawless, mount
        )
    yield from BlockResults(
        campaign, selection, ExtendedCampaigns(selection, extended), lawless, mount
    ).rows()
    moves = shifts(data, turns, spectrum.oscillations, campaign)
    yield from OscillationResults(spectrum, mount, moves).rows()
    moved = shifts_by_steps(data, spectrum.steps, campaign, quiet)
    logs = {m.name: m.log for m in data.plan}
    yield from step_rows(spectrum.steps, len(spectrum.turns), moved, logs, mount)
    at_rest_of_gyros = measured.drifts["gyro"]
    yield from other_scores(
        random_walks.get("gyro"),
        at_rest_of_gyros,
        campaign.drifts["gyro"] is at_rest_of_gyros,
        "gyro" in lawful,
        mount,
    )
    yield from off_rows(selection, tested, mount)
    yield from structure_rows(tested, lawless.reported_structures, mount)
    yield from unexplained_rows(selection, lawless, level * UNEXPLAINED_SHARE, mount)
    yield from rest_scatter_rows(selection.campaign, mount)
    yield from temperature_rows(data.blocks, data.plan, level, mount)
    yield from pooled_evidence_rows(selection, mount)


def _with_restarts(select: Callable[..., Selected], at_gaps: list[float], level: float) -> Selected:
    """What is selected with restarts at those gaps alone at which the biases change.

    And with a warm-up that begins again there, where that is likelier. `level`: of a change.
    """
    found = select(at_gaps)
    if (times := at_changes(found[0][0], level)) is not None:
        at_gaps = times
        found = select(at_gaps)
    if at_gaps and found[0][0].named.causes:
        again = select(at_gaps, warm_up_at=at_gaps)
        if is_better(again[0][0], found[0][0]):
            return again
    return found


def _selected(
    measured: Campaign,
    without: Callable[[Campaign, str], Campaign],
    level: float,
    degrees: float,
    at_gaps: Sequence[float],
    warm_up_at: Sequence[float] = (),
) -> Selected:
    """The named effects, tests, their campaign, scatter.

    at_gaps, warm_up_at : s since the first sample, where the biases may be others, and where a
        warm-up begins again besides the stated switch-ons
    """
    in_blocks = [effect for effect in CATALOGUE.values() if effect.sought_in == "blocks"]
    if warm_up_at:
        in_blocks = beginning_again(in_blocks, measured.motion, warm_up_at)
    in_blocks += restarts_at(at_gaps)
    levels = (level * BLOCKS_SHARE, level * STRUCTURE_SHARE)

    def selected(campaign: Campaign) -> tuple[Selection, Tested]:
        temperature_level = level * TEMPERATURE_SHARE
        effects = select_with_temperature(
            campaign, in_blocks, levels[0], temperature_level, degrees
        )
        tested = structure_tests(effects.campaign, effects.fitted, degrees, levels[1])
        return with_laws(effects, tested, campaign, in_blocks, *levels, degrees)

    def beside_one_manoeuvre(campaign: Campaign) -> tuple[Selection, Tested]:
        return select_beside_one_manoeuvre(
            selected(campaign),
            campaign,
            selected,
            without,
            lambda one: structure_tests(one, [], degrees, levels[1]),
        )

    return select_beside_scatter(
        measured, lambda one: select_beside_drift(one, beside_one_manoeuvre, levels[0]), levels[0]
    )


def _without(campaign: Campaign, manoeuvre: str, data: CampaignData) -> Campaign:
    """The campaign without a manoeuvre, all else equal."""
    other = campaign_of(replace(data, blocks=data.blocks[data.blocks["manoeuvre"] != manoeuvre]))
    return replace(
        other,
        solution=campaign.solution,
        position_sigma=campaign.position_sigma,
        axis_sigma=campaign.axis_sigma,
        drifts=campaign.drifts,
    )


def _with(plan: Callable[[], ExtendedPlan], data: CampaignData) -> Campaign:
    """The campaign with an additional manoeuvre, all else equal."""
    extended = plan()
    return campaign_of(
        replace(data, blocks=extended.blocks, plan=extended.plan, performed=extended.performed)
    )


STAGE = Stage(criticism, DECLARED, gathers=MOUNTS)
