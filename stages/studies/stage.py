"""S0's studies: parameters by epochs, running means and windows, and the table's time and angle."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from inertial.campaign.estimates import by_mount
from inertial.campaign.masked_samples import Masks
from inertial.campaign.noise_levels import NoiseLevels
from inertial.campaign.rate_segments import GyroInputs, Recorded, gyro_inputs
from inertial.campaign.records import clocks_of, known_of, manoeuvres_of, performed_of, rows_of
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from stages.studies import motion_rows
from stages.studies.declared import DECLARED
from stages.studies.epochs import rests_of, studied
from stages.studies.stretches import samples_in
from stages.studies.table_motion import (
    Gyros,
    WholeMotion,
    gyros_of,
    motion_of,
    pairs_of,
    steady_times,
    stretch_of,
    why_not,
)
from stages.studies.window_rows import growing, middle, pair_of, sliding

Row = dict[str, Any]


def studies(
    samples: Stream,
    masks: pd.DataFrame,
    clocks: pd.DataFrame,
    segments: pd.DataFrame,
    blocks: pd.DataFrame,
    manoeuvres: pd.DataFrame,
    performed: pd.DataFrame,
    noise: pd.DataFrame,
    known: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    gyroscope_fit: pd.DataFrame,
) -> Tables:
    """Every study of every mount; what cannot be studied, with the reason."""
    given, done, levels = known_of(known), performed_of(performed), NoiseLevels(noise)
    steps = {log: one.step for log, one in clocks_of(clocks).items()}
    scatter = {row["method"]: row["scatter"] or 0.0 for row in rows_of(gyroscope_fit)}
    rate_sigma = given["turn_rate"].scatter
    plans = dict(by_mount(manoeuvres_of(manoeuvres)))
    inputs = {suffix: gyro_inputs(blocks, m, done, levels, given) for suffix, m in plans.items()}
    rests = {suffix: rests_of(m, done, segments) for suffix, m in plans.items()}
    turns = {suffix: [r for r in inputs[suffix].recorded if not why_not(r)] for suffix in plans}

    wanted = {name: stretch for found in rests.values() for name, (_, stretch) in found.items()}
    wanted |= {r.plan.name: stretch_of(r, segments) for found in turns.values() for r in found}
    read = samples_in(samples, wanted, Masks(masks))

    rows: dict[str, list[Row]] = {name: [] for name in DECLARED.writes}
    for suffix in plans:
        _add(rows, studied(rests[suffix], read, steps, levels, given, suffix))
        _add(rows, _refused(inputs[suffix].recorded))
        gyros = gyros_of(gyroscope_parameters, f"joint{suffix}")
        between = scatter.get(f"joint{suffix}", 0.0)
        motions: dict[str, WholeMotion] = {}
        for r in turns[suffix]:
            name, times = r.plan.name, steady_times(r, segments)
            step = steps[r.plan.log]
            found = motion_of(r, read[name], times, step, inputs[suffix], gyros, levels, between)
            if isinstance(found, WholeMotion):
                motions[name] = found
            else:
                _add(rows, {"not_studied": [_not_studied(name, found)]})
        _add(rows, _of_turns(motions, inputs[suffix], levels, gyros, rate_sigma))
    return {
        name: pd.DataFrame(rows[name]) if rows[name] else table.empty()
        for name, table in DECLARED.writes.items()
    }


def _add(rows: dict[str, list[Row]], found: Mapping[str, list[Row]]) -> None:
    for name, more in found.items():
        rows[name] += more


def _refused(turns: list[Recorded]) -> dict[str, list[Row]]:
    left = [_not_studied(r.plan.name, why_not(r)) for r in turns if why_not(r)]
    return {"not_studied": left}


def _not_studied(turn: str, reason: str) -> Row:
    return {"study": "turns", "subject": turn, "reason": reason}


def _of_turns(
    motions: Mapping[str, WholeMotion],
    inputs: GyroInputs,
    levels: NoiseLevels,
    gyros: Gyros,
    rate_sigma: float,
) -> dict[str, list[Row]]:
    """Time and angle of each turn, and the windows of each pair."""
    rows: dict[str, list[Row]] = {name: [] for name in DECLARED.writes}
    for motion in motions.values():
        rows["time_angle"] += motion_rows.angles(motion)
        rows["motions"] += motion_rows.numbers(motion)
    for found in pairs_of(motions):
        pair = pair_of(found, list(motions.values()), inputs, levels, gyros, rate_sigma)
        whole = pair.whole(inputs, levels)
        windows = sliding(pair, whole)
        rows["windows"] += windows
        rows["growing"] += growing(pair, whole)
        rows["middles"] += middle(pair, whole)
        if not windows:
            names = f"{pair.forward.plan.name}, {pair.backward.plan.name}"
            rows["not_studied"].append(_not_studied(names, "the steady part is less than 180°"))
    return rows


STAGE = Stage(studies, DECLARED)
