"""What the IMU should have read, by the forward model with the solved parameters."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial import tables
from inertial.arrays import Array
from inertial.campaign.campaign_data import MOUNTS, CampaignData
from inertial.campaign.masked_samples import Columns, Repairs, inside
from inertial.campaign.motions import at_rest, in_samples
from inertial.campaign.records import Manoeuvre, Performed, Row, rows_of
from inertial.campaign.sample_stretches import columns_in, records_of
from inertial.campaign.solution import Solution
from inertial.estimation.noise_model import sigma_of_mean
from inertial.physics.effect import Reading
from inertial.physics.forward import UNKNOWN_TRIAD, predict
from inertial.physics.motion import Motion
from inertial.sensors import COLUMNS
from inertial.tables import GYRO
from inertial.tables.parquet import Stream
from inertial.tables.stage import Pieces, Stage
from stages.simulation.declared import DECLARED

OF_CHANNELS = ("predicted", "residual")


def simulation(
    mounts: Sequence[CampaignData],
    samples: Stream,
    channel_repairs: pd.DataFrame,
    segments: pd.DataFrame,
) -> Pieces:
    """Rotations sample by sample, static positions block by block, with their residuals.

    Those beside a rotation that is there sample by sample are in its samples.
    """
    repairs = Repairs(channel_repairs)
    for data in mounts:
        known = data.result.gyro is not None
        whole = {m.name: m for m in data.plan if known and _whole(m, data.performed[m.name])}
        rests = list(_rests(data))
        alone = [part for part, _ in rests if part.manoeuvre not in whole]
        if alone:
            yield "simulated", _frame(alone)
        if rests:
            rows = [row for part, s in rests for row in _fidelity(part, data, "at rest", s)]
            yield "fidelity", rows
        stretches = {name: records_of(m, segments) for name, m in whole.items()}
        for name, read in columns_in(samples, stretches, ["time", *tables.CHANNELS], repairs):
            m = whole[name]
            part, how = _turn(data, m, read, segments)
            yield "simulated", _frame([part])
            yield "fidelity", list(_fidelity(part, data, how, data.clocks[m.log].step))


def _whole(m: Manoeuvre, done: Performed) -> bool:
    known = m.up is not None and m.angle is not None
    # Of one whose gyros are cut off at the end of their range no angle is measured.
    recorded = (done.complete or done.bridged) and done.angle is not None
    return m.do == "turn" and m.recorded == "whole" and known and recorded


@dataclass(frozen=True)
class Simulated:
    """n samples of a rotation or blocks of a static position: predicted and measured readings.

    `phase`, `record`, `time`, s: (n,); `predicted`, `readings`: m/s² and rad/s, (n, 6).
    """

    manoeuvre: str
    log: str
    phase: NDArray[Any]
    record: NDArray[Any]
    time: Array
    predicted: Array
    readings: Array

    @cached_property
    def residual(self) -> Array:
        """Readings less predictions, (n, 6)."""
        return self.readings - self.predicted


def _rests(data: CampaignData) -> Iterator[tuple[Simulated, float]]:
    """Every static position in its blocks, with the median duration of a block, s.

    Their times are those of its log, as the samples of a rotation have them.
    """
    gyros = data.gyro_inputs.of_known_attitude.static_positions
    both = [*gyros, *data.accelerometer_positions[0]]
    positions = {static.part: static for static in both}
    blocks = data.blocks
    rows = blocks.groupby(["manoeuvre", "phase"]).indices
    log, phase, record = (blocks[name].to_numpy() for name in ("log", "phase", "from_record"))
    time, seconds = (blocks[name].to_numpy(np.float64) for name in ("time", "seconds"))
    readings = blocks[list(tables.CHANNELS)].to_numpy(np.float64)
    for position, static in positions.items():
        name = position.manoeuvre
        indices = rows[name, position.phase]
        solution = data.result.since(static.manoeuvre.switch_on)
        predicted = _predicted(at_rest(data, static, 0.0), solution)
        row = np.concatenate([predicted.accel[0], predicted.gyro[0]])
        repeated = np.tile(row, (len(indices), 1))
        part = Simulated(
            name,
            log[indices[0]],
            phase[indices],
            record[indices],
            time[indices] - data.clocks[static.manoeuvre.log].offset,
            repeated,
            readings[indices],
        )
        yield part, float(np.median(seconds[indices]))


def _predicted(motion: Motion, solution: Solution) -> Reading:
    gyro, accelerometer = solution.gyro or UNKNOWN_TRIAD, solution.accelerometer or UNKNOWN_TRIAD
    return predict(motion, solution.site, gyro, accelerometer)


def _turn(
    data: CampaignData, m: Manoeuvre, read: Columns, segments: pd.DataFrame
) -> tuple[Simulated, str]:
    """A turn sample by sample; what is in none of its blocks is masked, and not compared."""
    record, step = read["record"], data.clocks[m.log].step
    blocks = data.blocks[data.blocks["manoeuvre"] == m.name]
    phase = np.full(len(record), "rest", dtype=object)
    for row in rows_of(segments[segments["manoeuvre"] == m.name]):
        phase[(record >= row["from_record"]) & (record < row["to_record"])] = row["phase"]
    readings = np.column_stack([read[channel] for channel in tables.CHANNELS])
    edges = blocks[["from_record", "to_record"]].to_numpy(np.int64)
    for i, channel in enumerate(tables.CHANNELS):
        known = np.isfinite(blocks[channel].to_numpy(np.float64))
        readings[~inside(record, *edges[known].T), i] = np.nan
    increments = readings[:, len(GYRO) :] * step
    steady = phase == "steady"
    motion, how = in_samples(data, m, increments, step, steady, read["time"])
    predicted = _predicted(motion, data.result.since(m.switch_on))
    both = np.hstack([predicted.accel, predicted.gyro])
    return Simulated(m.name, m.log, phase, record, read["time"], both, readings), how


def _frame(parts: Sequence[Simulated]) -> pd.DataFrame:
    counts = [len(part.record) for part in parts]
    predicted, residual = (
        np.concatenate([getattr(p, name) for p in parts]) for name in OF_CHANNELS
    )
    return pd.DataFrame(
        {
            "manoeuvre": np.repeat([part.manoeuvre for part in parts], counts),
            "phase": np.concatenate([part.phase for part in parts]),
            "log": np.repeat([part.log for part in parts], counts),
            "record": np.concatenate([part.record for part in parts]),
            "time": np.concatenate([part.time for part in parts]),
            **dict(zip(tables.CHANNELS, predicted.T, strict=True)),
            **{
                f"residual_{c}": values
                for c, values in zip(tables.CHANNELS, residual.T, strict=True)
            },
        }
    )


def _fidelity(part: Simulated, data: CampaignData, how: str, seconds: float) -> Iterator[Row]:
    """Rms of the residuals, and that of noise alone in means of this length."""
    white = data.noise.of(part.manoeuvre, "rest", tables.CHANNELS)
    quantisation = np.concatenate([data.noise.quantisation(sensor) for sensor in COLUMNS])
    levels = sigma_of_mean(white, quantisation, seconds)
    for channel, residual, level in zip(tables.CHANNELS, part.residual.T, levels, strict=True):
        there = residual[np.isfinite(residual)]
        if len(there) and np.isfinite(level):
            yield {
                "mount": data.mount,
                "manoeuvre": part.manoeuvre,
                "channel": channel,
                "profile": how,
                "residual_rms": float(np.sqrt(np.mean(there**2))),
                "noise_rms": float(level),
                "samples": len(there),
            }


STAGE = Stage(simulation, DECLARED, gathers=MOUNTS)
