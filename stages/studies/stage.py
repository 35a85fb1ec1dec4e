"""S0's studies: parameters by epochs, running means and windows, and the table's time and angle."""

from collections.abc import Mapping, Sequence

import pandas as pd

from inertial.campaign.campaign_data import MOUNTS, CampaignData
from inertial.campaign.masked_samples import Repairs
from inertial.campaign.records import Row
from inertial.campaign.sample_stretches import records_of, samples_in
from inertial.campaign.solution import scatter_by_mount
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from inertial.text.messages import _
from stages.studies import turn_rows
from stages.studies.bandwidths import bandwidths, of_ramps
from stages.studies.declared import DECLARED
from stages.studies.epochs import rests_of, studied
from stages.studies.table_motion import (
    Gyros,
    WholeMotion,
    exclusion_reason,
    gyros_of,
    motion_of,
    pairs_of,
    steady_times,
)
from stages.studies.window_rows import growing, middle, pair_of, sliding


def studies(
    mounts: Sequence[CampaignData],
    samples: Stream,
    masks: pd.DataFrame,
    channel_repairs: pd.DataFrame,
    segments: pd.DataFrame,
    spectra: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    gyroscope_fit: pd.DataFrame,
) -> Tables:
    """Every study of every mount; what cannot be studied, with the reason."""
    scatter = scatter_by_mount(gyroscope_fit)
    rests = {data.mount: rests_of(data.plan, data.performed, segments) for data in mounts}
    turns = {
        data.mount: [r for r in data.gyro_inputs.recorded if not exclusion_reason(r)]
        for data in mounts
    }

    wanted = {name: stretch for found in rests.values() for name, (_, stretch) in found.items()}
    blocks = mounts[0].blocks if mounts else pd.DataFrame()
    encoded = set(blocks.loc[blocks["table_angle"].notna(), "manoeuvre"]) if len(blocks) else set()
    for r in (r for found in turns.values() for r in found):
        wanted[r.plan.name] = records_of(r.plan, segments, moving=True)
        wanted[turn_rows.with_rests(r.plan.name)] = records_of(r.plan, segments)
    read = samples_in(samples, wanted, masks, Repairs(channel_repairs))

    rows: dict[str, list[Row]] = {name: [] for name in DECLARED.writes}
    for data in mounts:
        _add(rows, studied(data, rests[data.mount], read))
        _add(rows, _refused(data))
        gyros = gyros_of(gyroscope_parameters, data.mount)
        between = scatter.get(data.mount, 0.0)
        motions: dict[str, WholeMotion] = {}
        times = {r.plan.name: steady_times(r, segments) for r in turns[data.mount]}
        whole = [
            (r, read[name])
            for r in turns[data.mount]
            if (name := turn_rows.with_rests(r.plan.name)) in read
        ]
        encoder = [
            row
            for r, stretch in whole
            if r.plan.name in encoded
            for row in turn_rows.of_turn(data, r, stretch, times[r.plan.name])
        ]
        common = list(turn_rows.together(data, encoder))
        _add(rows, {"encoder": [*common, *encoder]})
        ramps = {r.plan.name: of_ramps(data, r, stretch) for r, stretch in whole}
        _add(rows, {"bandwidths": list(bandwidths(data, encoder, ramps, spectra))})
        harmonics = turn_rows.harmonics_of(common)
        for r in turns[data.mount]:
            name = r.plan.name
            found = motion_of(data, r, read[name], times[name], gyros, between, harmonics)
            if isinstance(found, WholeMotion):
                motions[name] = found
            else:
                _add(rows, {"not_studied": [_not_studied(data, name, found)]})
        _add(rows, _of_turns(data, motions, gyros))
    return rows


def _add(rows: dict[str, list[Row]], found: Mapping[str, list[Row]]) -> None:
    for name, more in found.items():
        rows[name] += more


def _refused(data: CampaignData) -> dict[str, list[Row]]:
    turns = data.gyro_inputs.recorded
    refused = [
        _not_studied(data, r.plan.name, exclusion_reason(r)) for r in turns if exclusion_reason(r)
    ]
    return {"not_studied": refused}


def _not_studied(data: CampaignData, turn: str, reason: str) -> Row:
    return {"study": "turns", "mount": data.mount, "subject": turn, "reason": reason}


def _of_turns(
    data: CampaignData, motions: Mapping[str, WholeMotion], gyros: Gyros
) -> dict[str, list[Row]]:
    """Time and angle of each turn, and the windows of each pair."""
    rows: dict[str, list[Row]] = {name: [] for name in DECLARED.writes}
    for motion in motions.values():
        rows["time_angle"] += turn_rows.angles(motion)
        rows["motions"] += turn_rows.numbers(motion)
    for found in pairs_of(motions):
        pair = pair_of(data, found, list(motions.values()), gyros)
        whole = pair.whole(data)
        windows = sliding(pair, whole)
        rows["windows"] += windows
        rows["growing"] += growing(pair, whole)
        rows["middles"] += middle(pair, whole)
        if not windows:
            names = f"{pair.forward.plan.name}, {pair.backward.plan.name}"
            rows["not_studied"].append(
                _not_studied(data, names, _("the steady part is less than 180°"))
            )
    return rows


STAGE = Stage(studies, DECLARED, gathers=MOUNTS)
