"""Real readings of the campaign, on which users try whether their own code applies the equation.

Of each mount two: the mean over the first rest, and one sample out of the middle of the first
turn, of those that hold most of the six channels. Nothing that was masked is taken.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.masked_samples import Masks, pieces
from inertial.campaign.records import Manoeuvre
from inertial.tables import CHANNELS
from inertial.tables.parquet import Stream

Array = NDArray[np.float64]

AT_REST = ("rest", "rest-before", "rest-after")
TURNING = ("steady", "turning")
# Where the sensors come in records of their own, a turn is shown by its gyros.
WORTH = np.array([1, 1, 1, 4, 4, 4])


@dataclass(frozen=True)
class Worked:
    """A reading, and where it stands: records [first, after) of a log.

    reading : (6,) in the order of CHANNELS, m/s² and rad/s, NaN where not recorded
    line : number of the line of a single sample, from 1; none for a mean
    """

    what: str
    manoeuvre: str
    log: str
    first: int
    after: int
    line: int | None
    reading: Array


def worked(
    plan: Sequence[Manoeuvre], blocks: pd.DataFrame, samples: Stream, masks: Masks
) -> dict[str, list[Worked]]:
    """Mount → the mean of its first rest and a sample of its first turn, as far as they exist."""
    found: dict[str, list[Worked]] = {}
    wanted: dict[str, tuple[str, str, int, int]] = {}
    there = blocks[blocks["count"] > 0]
    for mount in dict.fromkeys(m.mount for m in plan):
        own = [m for m in plan if m.mount == mount]
        rest = _first(own, there, AT_REST)
        turn = _first([m for m in own if m.do == "turn"], there, TURNING)
        found[mount] = [] if rest is None else [_mean(rest)]
        if turn is not None:
            middle = turn.iloc[len(turn) // 2]
            edges = int(middle["from_record"]), int(middle["to_record"])
            wanted[mount] = (str(middle["manoeuvre"]), str(middle["log"]), *edges)
    for mount, sample in _samples(samples, masks, wanted).items():
        found[mount].append(sample)
    return found


def _first(
    plan: Sequence[Manoeuvre], blocks: pd.DataFrame, phases: Sequence[str]
) -> pd.DataFrame | None:
    """The blocks of one phase of a manoeuvre: the first that has most of the channels."""
    parts = [
        blocks[(blocks["manoeuvre"] == m.name) & (blocks["phase"] == phase)]
        for phase in phases
        for m in plan
    ]
    there = [part.sort_values("from_record") for part in parts if len(part)]
    return max(there, key=_recorded, default=None)


def _recorded(blocks: pd.DataFrame) -> int:
    """How many of the channels are in every block."""
    return int(blocks[list(CHANNELS)].notna().all().sum())


def _mean(blocks: pd.DataFrame) -> Worked:
    """The mean over the blocks of one phase, which are means themselves."""
    first = blocks.iloc[0]
    values = blocks[list(CHANNELS)].to_numpy(np.float64)
    mean = np.average(values, axis=0, weights=blocks["count"].to_numpy(np.float64))
    return Worked(
        what=f"mean over {first['phase']}",
        manoeuvre=str(first["manoeuvre"]),
        log=str(first["log"]),
        first=int(first["from_record"]),
        after=int(blocks.iloc[-1]["to_record"]),
        line=None,
        reading=np.asarray(mean),
    )


def _samples(
    samples: Stream, masks: Masks, wanted: Mapping[str, tuple[str, str, int, int]]
) -> dict[str, Worked]:
    """Mount → a sample out of the stretch that is wanted; the logs are read no further."""
    found: dict[str, Worked] = {}
    if not wanted:
        return found
    for log, piece in pieces(samples, ["record", "line", *CHANNELS]):
        record = piece["record"]
        readings = np.column_stack([piece[channel] for channel in CHANNELS])
        masked = masks.of(log, record)
        readings[masked.channels | masked.whole[:, None]] = np.nan
        for mount, (manoeuvre, wanted_log, first, after) in wanted.items():
            worth = np.isfinite(readings) @ WORTH * ((record >= first) & (record < after))
            if mount in found or log != wanted_log or not worth.any():
                continue
            i = int(np.argmax(worth))
            number, line = int(record[i]), int(piece["line"][i])
            found[mount] = Worked(
                "one sample of a turn", manoeuvre, log, number, number + 1, line, readings[i]
            )
        if len(found) == len(wanted):
            break
    return found
