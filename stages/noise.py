"""White noise of every channel in every manoeuvre, from the data, beside the data sheet's."""

from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts import tables
from stages.contracts.parquet import Stream
from stages.contracts.samples import inside, pieces
from stages.contracts.stage import Stage, Tables
from stages.inference.spectrum import band_levels, white_level

Array = NDArray[np.float64]

LONGEST = 32768  # samples in one periodogram; bounds the memory of a long log
SHORTEST = 16  # samples below which nothing is said about noise


def noise(
    samples: Stream,
    segments: pd.DataFrame,
    clocks: pd.DataFrame,
    gaps: pd.DataFrame,
    masks: pd.DataFrame,
    sensors: pd.DataFrame,
    *,
    from_hz: float,
    to_hz: float,
) -> Tables:
    """One row for each manoeuvre, phase (rest or steady) and channel that is recorded."""
    intervals = dict(zip(clocks["log"], clocks["interval"], strict=True))
    sheet = sensors.set_index("channel")["white_noise"]
    spectra: dict[tuple[str, str], _Spectra] = {}
    quiet = segments[segments["phase"].isin(["rest", "rest-before", "rest-after", "steady"])]
    for log, record, values in _unbroken(samples, gaps, masks):
        rows = quiet[quiet["log"] == log]
        interval = intervals[log]
        if not interval > 0:
            continue
        for row in rows.itertuples():
            chosen = values[(record >= row.from_record) & (record < row.to_record)]
            phase = "steady" if row.phase == "steady" else "rest"
            key = (str(row.manoeuvre), phase)
            for start in range(0, len(chosen), LONGEST):
                part = chosen[start : start + LONGEST]
                if len(part) >= SHORTEST:
                    spectra.setdefault(key, _Spectra()).add(part, 1 / interval, (from_hz, to_hz))
    rows_out = [
        row | {"data_sheet": sheet[row["channel"]]}
        for (manoeuvre, phase), collected in spectra.items()
        for row in collected.rows(manoeuvre, phase)
    ]
    return {"noise": pd.DataFrame(rows_out) if rows_out else tables.NOISE.empty()}


class _Spectra:
    """The band levels of one manoeuvre, piece by piece."""

    def __init__(self) -> None:
        self.levels: list[Array] = []
        self.squares, self.samples = np.zeros(6), 0

    def add(self, values: Array, rate: float, band: tuple[float, float]) -> None:
        self.levels.append(band_levels(values, rate, band))
        self.squares += np.var(values, axis=0) * len(values)
        self.samples += len(values)

    def rows(self, manoeuvre: str, phase: str) -> list[dict[str, Any]]:
        white, sigma = white_level(np.concatenate(self.levels))
        return [
            {
                "manoeuvre": manoeuvre,
                "phase": phase,
                "channel": channel,
                "white_noise": float(white[i]),
                "sigma": float(sigma[i]),
                "per_sample": float(np.sqrt(self.squares[i] / self.samples)),
                "samples": self.samples,
            }
            for i, channel in enumerate(tables.CHANNELS)
            if np.isfinite(white[i])
        ]


def _unbroken(samples: Stream, gaps: pd.DataFrame, masks: pd.DataFrame) -> Any:
    """Records of one log without a gap or a masked record between them: log, numbers, values."""
    for log, piece in pieces(samples, ["record", *tables.CHANNELS]):
        record = piece["record"]
        values = np.column_stack([piece[channel] for channel in tables.CHANNELS])
        cuts = set(np.flatnonzero(np.diff(record) != 1) + 1)
        starts = gaps.loc[gaps["log"] == log, "record"].to_numpy()
        cuts |= set(np.flatnonzero(np.isin(record, starts)))
        masked = masks[masks["log"] == log]
        bad = (
            inside(record, masked["from_record"].to_numpy(), masked["to_record"].to_numpy())
            if len(masked)
            else np.zeros(len(record), bool)
        )
        cuts |= set(np.flatnonzero(np.diff(bad)) + 1)
        edges = [0, *sorted(cuts), len(record)]
        for first, after in zip(edges[:-1], edges[1:], strict=True):
            if after > first and not bad[first]:
                yield log, record[first:after], values[first:after]


STAGE = Stage(
    noise,
    reads={
        "samples": tables.SAMPLES,
        "segments": tables.SEGMENTS,
        "clocks": tables.CLOCKS,
        "gaps": tables.GAPS,
        "masks": tables.MASKS,
        "sensors": tables.SENSORS,
    },
    streams=("samples",),
    writes={"noise": tables.NOISE},
)

if __name__ == "__main__":
    STAGE.command_line()
