"""Worked examples: readings of the campaign, on which users check their own code.

For each mount two: the mean over the first static position, and one sample from the middle of the
first turn, of those that hold most of the six channels. Masked samples are not taken.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.masked_samples import Masks, Repairs, pieces
from inertial.campaign.records import Manoeuvre
from inertial.tables import CHANNELS, STATIC_PHASES
from inertial.tables.parquet import Stream
from inertial.text.messages import _

TURN_PHASES = ("steady", "turning")
# Where the sensors come in records of their own, a turn is shown by its gyros.
CHANNEL_WEIGHTS = np.array([1, 1, 1, 4, 4, 4])


@dataclass(frozen=True)
class Example:
    """A reading, and where it stands: records [first, after) of a log.

    reading : (6,) in the order of CHANNELS, m/s² and rad/s, NaN where not recorded
    line : number of the line of a single sample, from 1; none for a mean
    time, temperature : s and K, of the middle of a mean; NaN where not recorded
    """

    what: str
    manoeuvre: str
    log: str
    first: int
    after: int
    line: int | None
    reading: Array
    time: float = np.nan
    temperature: float = np.nan


def examples_of(
    plan: Sequence[Manoeuvre],
    blocks: pd.DataFrame,
    samples: Stream,
    masks: pd.DataFrame,
    repairs: Repairs,
) -> dict[str, list[Example]]:
    """Mount → the mean of its first rest and a sample of its first turn, as far as they exist."""
    examples: dict[str, list[Example]] = {}
    turn_blocks: dict[str, pd.Series] = {}
    blocks = blocks[blocks["count"] > 0]
    for mount in dict.fromkeys(m.mount for m in plan):
        on_mount = [m for m in plan if m.mount == mount]
        rest = _most_complete(on_mount, blocks, STATIC_PHASES)
        turn = _most_complete([m for m in on_mount if m.do == "turn"], blocks, TURN_PHASES)
        examples[mount] = [] if rest is None else [_mean(rest)]
        if turn is not None:
            turn_blocks[mount] = turn.iloc[len(turn) // 2]
    for mount, example in _samples(samples, masks, repairs, turn_blocks).items():
        examples[mount].append(example)
    return examples


def _most_complete(
    plan: Sequence[Manoeuvre], blocks: pd.DataFrame, phases: Sequence[str]
) -> pd.DataFrame | None:
    """The blocks of one phase of a manoeuvre: the first that has most of the channels."""
    candidates = [
        blocks[(blocks["manoeuvre"] == m.name) & (blocks["phase"] == phase)]
        for phase in phases
        for m in plan
    ]
    recorded = [part.sort_values("from_record") for part in candidates if len(part)]
    in_every_block = [blocks[list(CHANNELS)].notna().all().sum() for blocks in recorded]
    return recorded[int(np.argmax(in_every_block))] if recorded else None


def _mean(blocks: pd.DataFrame) -> Example:
    """The mean over the blocks of one phase, which are means themselves."""
    first = blocks.iloc[0]
    values = blocks[[*CHANNELS, "time", "temperature"]].to_numpy(np.float64)
    mean = np.average(values, axis=0, weights=blocks["count"].to_numpy(np.float64))
    return Example(
        what=_("mean over {phase}", phase=first["phase"]),
        manoeuvre=str(first["manoeuvre"]),
        log=str(first["log"]),
        first=int(first["from_record"]),
        after=int(blocks.iloc[-1]["to_record"]),
        line=None,
        reading=np.asarray(mean[: len(CHANNELS)]),
        time=float(mean[-2]),
        temperature=float(mean[-1]),
    )


def _samples(
    samples: Stream, masks: pd.DataFrame, repairs: Repairs, blocks: Mapping[str, pd.Series]
) -> dict[str, Example]:
    """Mount → the first most complete sample of its block; the logs are read no further."""
    examples: dict[str, Example] = {}
    known = Masks(masks, repairs)
    columns = ["record", "line", "time", "temperature", *CHANNELS]
    if not blocks:
        return examples
    for log, piece in pieces(samples, columns, repairs):
        record = piece["record"]
        readings = np.column_stack([piece[channel] for channel in CHANNELS])
        masked = known.of(log, record)
        readings[masked.channels | masked.whole[:, None]] = np.nan
        for mount, block in blocks.items():
            in_block = (record >= block["from_record"]) & (record < block["to_record"])
            weights = np.isfinite(readings) @ CHANNEL_WEIGHTS * in_block
            if mount in examples or log != block["log"] or not weights.any():
                continue
            i = int(np.argmax(weights))
            number, line = int(record[i]), int(piece["line"][i])
            examples[mount] = Example(
                _("one sample of a turn"),
                str(block["manoeuvre"]),
                log,
                number,
                number + 1,
                line,
                readings[i],
                float(piece["time"][i]),
                float(piece["temperature"][i]),
            )
        if len(examples) == len(blocks):
            break
    return examples
