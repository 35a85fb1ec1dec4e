"""What the IMU should have read, by the forward model with the solved parameters."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts import tables
from stages.contracts.masks import inside
from stages.contracts.parquet import Stream
from stages.contracts.records import (
    Clock,
    Known,
    Manoeuvre,
    Performed,
    clocks_of,
    known_of,
    manoeuvres_of,
    performed_of,
    rows_of,
)
from stages.contracts.samples import pieces
from stages.contracts.stage import Pieces, Stage
from stages.estimation.estimates import by_mount
from stages.estimation.motions import at_rest, in_samples
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.solution import Solution, solution_of
from stages.estimation.stills import stills
from stages.estimation.turns import GYRO
from stages.model.effect import Reading
from stages.model.forward import Triad, predict
from stages.model.motion import Motion

Array = NDArray[np.float64]

NOTHING = Triad(np.full((3, 3), np.nan), np.full(3, np.nan))  # of a triad that is not determined


def simulation(
    samples: Stream,
    blocks: pd.DataFrame,
    segments: pd.DataFrame,
    manoeuvres: pd.DataFrame,
    performed: pd.DataFrame,
    noise: pd.DataFrame,
    known: pd.DataFrame,
    clocks: pd.DataFrame,
    accelerometer_parameters: pd.DataFrame,
    accelerometer_positions: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    gyroscope_positions: pd.DataFrame,
) -> Pieces:
    """Turns sample by sample, rests block by block, each with what is left of the reading."""
    given, done, clock = known_of(known), performed_of(performed), clocks_of(clocks)
    levels = NoiseLevels(noise)
    for suffix, plan in by_mount(manoeuvres_of(manoeuvres)):
        solution = solution_of(
            (accelerometer_parameters, gyroscope_parameters),
            (accelerometer_positions, gyroscope_positions),
            given,
            suffix,
        )
        rests = list(_rests(blocks, plan, done, levels, given, solution))
        fidelity = [_fidelity(frame, levels, "at rest", blocks) for frame in rests]
        if rests:
            yield "simulated", pd.concat(rests, ignore_index=True)
            yield "fidelity", pd.concat(fidelity, ignore_index=True)
        if solution.gyro is None:
            continue
        whole = [m for m in plan if _whole(m, done)]
        for m, parts in _samples_of(samples, segments, whole):
            heading = given["heading"].value
            used = blocks[blocks["manoeuvre"] == m.name]
            frame, how = _turn(m, parts, segments, used, clock[m.log], solution, heading)
            yield "simulated", frame
            yield "fidelity", _fidelity(frame, levels, how, None, clock[m.log].step)


def _whole(m: Manoeuvre, done: Mapping[str, Performed]) -> bool:
    known = m.up is not None and m.angle is not None
    recorded = done[m.name].complete or done[m.name].bridged
    return m.do == "turn" and m.recorded == "whole" and known and recorded


def _rests(
    blocks: pd.DataFrame,
    plan: list[Manoeuvre],
    done: Mapping[str, Performed],
    levels: NoiseLevels,
    known: Mapping[str, Known],
    solution: Solution,
) -> Iterator[pd.DataFrame]:
    """The blocks of every rest less what the model says of its attitude."""
    found = {
        still.label: still
        for sensor in ("gyro", "accel")
        for still in stills(blocks, plan, done, levels, sensor)[0]
    }
    groups = dict(list(blocks.groupby(["manoeuvre", "phase"])))
    for label, still in found.items():
        phase = "rest" if label == still.manoeuvre.name else label.rpartition("(")[2][:-1]
        part = groups[still.manoeuvre.name, phase]
        motion = at_rest(still, solution, known["heading"].value, 0.0)
        said = _predicted(motion, solution)
        read = part[list(tables.CHANNELS)].to_numpy(np.float64)
        row = np.concatenate([said.accel[0], said.gyro[0]])
        yield _frame(
            still.manoeuvre.name,
            part["phase"].to_numpy(),
            part["log"].iloc[0],
            part["from_record"].to_numpy(),
            part["time"].to_numpy(np.float64),
            np.tile(row, (len(part), 1)),
            read,
        )


def _predicted(motion: Motion, solution: Solution) -> Reading:
    gyro, accelerometer = solution.gyro or NOTHING, solution.accelerometer or NOTHING
    return predict(motion, solution.site, gyro, accelerometer)


def _samples_of(
    samples: Stream, segments: pd.DataFrame, whole: list[Manoeuvre]
) -> Iterator[tuple[Manoeuvre, dict[str, NDArray[Any]]]]:
    """The samples of each of these turns, from the rest before it to the rest after it."""
    spans = {
        str(name): (int(rows["from_record"].min()), int(rows["to_record"].max()))
        for name, rows in segments.groupby("manoeuvre")
    }
    columns = ["record", "time", *tables.CHANNELS]
    waiting = {m.name: [] for m in whole}  # type: dict[str, list[dict[str, NDArray[Any]]]]
    for log, piece in pieces(samples, columns):
        for m in whole:
            if m.log != log:
                continue
            first, after = spans[m.name]
            inside = (piece["record"] >= first) & (piece["record"] < after)
            if inside.any():
                waiting[m.name].append({c: piece[c][inside] for c in columns})
            if piece["record"][-1] >= after - 1 and waiting[m.name]:
                parts = waiting.pop(m.name)
                waiting[m.name] = []
                yield m, {c: np.concatenate([part[c] for part in parts]) for c in columns}


def _turn(
    m: Manoeuvre,
    parts: dict[str, NDArray[Any]],
    segments: pd.DataFrame,
    blocks: pd.DataFrame,
    clock: Clock,
    solution: Solution,
    heading: float | None,
) -> tuple[pd.DataFrame, str]:
    """A turn sample by sample; what is in none of its blocks is masked, and not compared."""
    record = parts["record"]
    own = [row for row in rows_of(segments) if row["manoeuvre"] == m.name]
    phase = np.full(len(record), "rest", dtype=object)
    for row in own:
        phase[(record >= row["from_record"]) & (record < row["to_record"])] = row["phase"]
    read = np.column_stack([parts[channel] for channel in tables.CHANNELS])
    edges = [blocks[name].to_numpy(np.int64) for name in ("from_record", "to_record")]
    read[~inside(record, *edges)] = np.nan
    increments = read[:, len(GYRO) :] * clock.step
    steady = phase == "steady"
    motion, how = in_samples(m, increments, clock.step, steady, parts["time"], solution, heading)
    said = _predicted(motion, solution)
    simulated = np.hstack([said.accel, said.gyro])
    return _frame(m.name, phase, m.log, record, parts["time"], simulated, read), how


def _frame(
    name: str,
    phase: NDArray[Any],
    log: str,
    record: NDArray[Any],
    time: Array,
    simulated: Array,
    read: Array,
) -> pd.DataFrame:
    residual = read - simulated
    return pd.DataFrame(
        {
            "manoeuvre": name,
            "phase": phase,
            "log": log,
            "record": record,
            "time": time,
            **{channel: simulated[:, i] for i, channel in enumerate(tables.CHANNELS)},
            **{f"residual_{c}": residual[:, i] for i, c in enumerate(tables.CHANNELS)},
        }
    )


def _fidelity(
    frame: pd.DataFrame,
    levels: NoiseLevels,
    how: str,
    blocks: pd.DataFrame | None,
    step: float = 1.0,
) -> pd.DataFrame:
    """How large the residuals are beside what white noise alone would leave."""
    name = str(frame["manoeuvre"].iloc[0])
    rows = []
    seconds = step
    if blocks is not None:
        own = blocks[(blocks["manoeuvre"] == name) & blocks["phase"].isin(frame["phase"])]
        seconds = float(own["seconds"].median())
    for channel in tables.CHANNELS:
        residual = frame[f"residual_{channel}"].to_numpy(np.float64)
        there = residual[np.isfinite(residual)]
        level = float(levels.of(name, "rest", [channel])[0])
        if len(there) and np.isfinite(level):
            rows.append(
                {
                    "manoeuvre": name,
                    "channel": channel,
                    "profile": how,
                    "residual_rms": float(np.sqrt(np.mean(there**2))),
                    "noise_rms": level / np.sqrt(seconds),
                    "samples": len(there),
                }
            )
    return pd.DataFrame(rows) if rows else tables.FIDELITY.empty()


STAGE = Stage(
    simulation,
    reads={
        "samples": tables.SAMPLES,
        "blocks": tables.BLOCKS,
        "segments": tables.SEGMENTS,
        "manoeuvres": tables.MANOEUVRES,
        "performed": tables.PERFORMED,
        "noise": tables.NOISE,
        "known": tables.KNOWN,
        "clocks": tables.CLOCKS,
        "accelerometer_parameters": tables.PARAMETERS,
        "accelerometer_positions": tables.POSITIONS,
        "gyroscope_parameters": tables.PARAMETERS,
        "gyroscope_positions": tables.POSITIONS,
    },
    streams=("samples",),
    writes={"simulated": tables.SIMULATED, "fidelity": tables.FIDELITY},
)

if __name__ == "__main__":
    STAGE.command_line()
