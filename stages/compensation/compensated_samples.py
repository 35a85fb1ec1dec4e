"""The samples with the errors taken out, batch by batch, however long the log."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from inertial.campaign.masked_samples import Masks
from inertial.tables import CHANNELS
from inertial.tables.parquet import Stream
from stages.compensation.correction import Mounted

Array = NDArray[np.float64]


@dataclass(frozen=True)
class CompensatedStream(Stream):
    """A stream of samples whose six channels are compensated; all else stays as it is.

    What is masked has no compensated reading.
    """

    mounted: Mapping[str, Sequence[Mounted]]  # by log
    masks: Masks

    def columns(self, names: list[str]) -> Iterator[pa.RecordBatch]:
        """Batch by batch, of some columns only."""
        needed = dict.fromkeys([*names, "log", "record", *CHANNELS])
        for batch in super().columns(list(needed)):
            truth = self._truth(batch)
            arrays = [
                pa.array(truth[:, CHANNELS.index(name)], from_pandas=True)
                if name in CHANNELS
                else batch.column(name)
                for name in names
            ]
            yield pa.RecordBatch.from_arrays(arrays, names)

    def _truth(self, batch: pa.RecordBatch) -> Array:
        """The six channels of a batch with the errors taken out, (n, 6)."""
        readings = np.column_stack(
            [batch.column(channel).to_numpy(zero_copy_only=False) for channel in CHANNELS]
        )
        record = batch.column("record").to_numpy()
        logs = batch.column("log").dictionary_encode()
        names, index = logs.dictionary.to_pylist(), logs.indices.to_numpy()
        truth = np.full(readings.shape, np.nan)
        for number, log in enumerate(names):
            for part in self.mounted.get(log, ()):
                own = (index == number) & (record >= part.first) & (record < part.after)
                if own.any():
                    masked = self.masks.of(log, record[own])
                    kept = np.where(masked.channels, np.nan, readings[own])
                    kept[masked.whole] = np.nan
                    truth[own] = part.truth(kept)
        return truth
