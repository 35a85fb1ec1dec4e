"""Samples corrected for the errors, and their envelope."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from operator import itemgetter

import numpy as np
import pandas as pd
import pyarrow as pa

from inertial import tables
from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.masked_samples import Masks, Repairs
from inertial.campaign.measurement import NOTHING, Measurement
from inertial.campaign.records import rows_of
from inertial.campaign.sums import extremes_over
from inertial.physics.motion import Motion, stretches
from inertial.tables import CHANNELS
from inertial.tables.parquet import Stream

# ---- Which result applies to which records, and how the errors are taken out of a reading.


ALL = np.iinfo(np.int64).max  # a record number that no log reaches
UNKNOWN = np.full(3, np.nan)


@dataclass(frozen=True)
class Mounted:
    """Records [first, after) of a log in which the IMU sat on one mount; `step`: of a sample, s."""

    first: int
    after: int
    measurement: Measurement
    step: float

    def motion(self, time: Array, temperature: Array) -> Motion:
        """What is known of n samples; the effects of the result need no more."""
        return stretches(time, np.full(len(time), self.step), temperature)


def mounted(
    mounts: Sequence[CampaignData],
    measurements: Mapping[str, Measurement],
    segments: pd.DataFrame,
) -> dict[str, list[Mounted]]:
    """For each log the stretches of one mount, with its result.

    A log of a single mount is one stretch. In another one, what lies between manoeuvres of
    different mounts belongs to neither: there the IMU is taken off.
    """
    mount = {m.name: place for place, data in enumerate(mounts) for m in data.plan}
    own = [measurements.get(data.mount, NOTHING) for data in mounts]
    result: dict[str, list[Mounted]] = {}
    for log in dict.fromkeys(m.log for data in mounts for m in data.plan):
        step = mounts[0].clocks[log].step
        selected = [i for i, data in enumerate(mounts) if any(m.log == log for m in data.plan)]
        if len(selected) == 1:
            result[log] = [Mounted(0, ALL, own[selected[0]], step)]
            continue
        runs: list[tuple[int, int, int]] = []
        for row in sorted(rows_of(segments[segments["log"] == log]), key=itemgetter("from_record")):
            on = mount[row["manoeuvre"]]
            if runs and runs[-1][0] == on:
                runs[-1] = (on, runs[-1][1], max(runs[-1][2], row["to_record"]))
            else:
                runs.append((on, row["from_record"], row["to_record"]))
        result[log] = [Mounted(first, after, own[on], step) for on, first, after in runs]
    return result


def held(force: Array, before: Array) -> Array:
    """The specific force at each of n records: where there is none, the last one, (n, 3).

    `before`: the last one before these, (3,). A g-sensitivity turns an error of the force into one
    of the rate that is smaller by far than the noise of a sample, so a force that is a little
    older will do where the two sensors are in records of their own.
    """
    place = np.where(np.isfinite(force).all(axis=1), np.arange(len(force)), -1)
    last = np.maximum.accumulate(place)
    return np.where(last[:, None] >= 0, force[last], before)


# ---- The samples with the errors taken out, batch by batch, however long the log.


@dataclass(frozen=True)
class CompensatedStream(Stream):
    """A stream of samples whose six channels are compensated; all else stays as it is.

    What is masked has no compensated reading.
    """

    mounted: Mapping[str, Sequence[Mounted]]  # by log
    masks: Masks
    repairs: Repairs

    def columns(self, names: list[str]) -> Iterator[pa.RecordBatch]:
        """Batch by batch, of some columns only."""
        needed = dict.fromkeys([*names, "log", "record", "time", "temperature", *CHANNELS])
        forces: dict[tuple[str, int], Array] = {}  # the last one of each log and mount
        for batch in super().columns(list(needed)):
            truth = self._truth(batch, forces)
            arrays = [
                pa.array(truth[:, CHANNELS.index(name)], from_pandas=True)
                if name in CHANNELS
                else batch.column(name)
                for name in names
            ]
            yield pa.RecordBatch.from_arrays(arrays, names)

    def _truth(self, batch: pa.RecordBatch, forces: dict[tuple[str, int], Array]) -> Array:
        """The six channels of a batch with the errors taken out, (n, 6)."""
        readings = np.column_stack(
            [batch.column(channel).to_numpy(zero_copy_only=False) for channel in CHANNELS]
        )
        record = batch.column("record").to_numpy()
        time, temperature = (
            batch.column(name).to_numpy(zero_copy_only=False) for name in ("time", "temperature")
        )
        logs = batch.column("log").dictionary_encode()
        names, index = logs.dictionary.to_pylist(), logs.indices.to_numpy()
        truth = np.full(readings.shape, np.nan)
        for number, log in enumerate(names):
            for part in self.mounted.get(log, ()):
                selected = (index == number) & (record >= part.first) & (record < part.after)
                if not selected.any():
                    continue
                masked = self.masks.of(log, record[selected])
                set_right = self.repairs.readings(log, readings[selected])
                kept = np.where(masked.channels, np.nan, set_right)
                kept[masked.whole] = np.nan
                motion = part.motion(time[selected], temperature[selected])
                force = part.measurement.force(kept[:, :3], motion)
                felt = held(force, forces.get((log, part.first), UNKNOWN))
                forces[log, part.first] = felt[-1]
                truth[selected, :3] = force
                truth[selected, 3:] = part.measurement.rate(kept[:, 3:], motion, felt)
        return truth


# ---- The extremes of the compensated samples between the edges that the traces of segment have.


def envelope(samples: CompensatedStream, traces: pd.DataFrame) -> pd.DataFrame:
    """The same stretches as in `traces`, so that before, after and difference can be drawn."""
    edges = {
        str(log): (rows["from_record"].to_numpy(np.int64), rows["to_record"].to_numpy(np.int64))
        for log, rows in traces.groupby("log", sort=False)
    }
    selected = dict(list(traces.groupby("log", sort=False)))
    frames = [
        selected[log][["log", "from_record", "to_record", "from_s", "to_s"]].assign(
            **{f"least_{c}": total.least[:, i] for i, c in enumerate(tables.CHANNELS)},
            **{f"most_{c}": total.most[:, i] for i, c in enumerate(tables.CHANNELS)},
        )
        for log, total in extremes_over(samples, edges).items()
    ]
    return pd.concat(frames) if frames else tables.TRACES.empty()
