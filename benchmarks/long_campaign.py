"""The campaign of the benchmarks with rests of any length, in binary logs; written piece by piece.

The laboratory simulates the short one. Each rest is then extended with what the sensors read in it
and white noise of the same size, rounded to counts as in the receiver. Later logs are delayed by as
much.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.campaign import RATE, RESTS, document, log_of, performed
from laboratory.folder import campaign_yaml
from laboratory.rawimu import Samples, log_bytes
from laboratory.recording import LogTruth, Recording
from laboratory.sensor import Reading

PIECE = 200_000  # samples that are drawn and written at a time


def record(folder: Path, samples: int, rate: float = RATE) -> tuple[int, int]:
    """A campaign of at least so many samples into its folder; its samples and the logs' bytes.

    `rate`: samples per second.
    """
    specified, step = document(1, rate=rate), round(1e9 / rate)  # ns
    short = performed(specified)
    there = sum(len(truth.time) for truth in short.truth.values())
    more = -(-max(0, samples - there) // len(RESTS))  # of every rest
    folder.mkdir(parents=True)
    written, later = 0, 0
    for log, truth in short.truth.items():
        longer = more if log in map(log_of, RESTS) else 0
        with (folder / log).open("wb") as file:
            for piece in _pieces(short, log, truth, longer, later, step):
                written += file.write(log_bytes(piece, "RAWIMUSXB", "00000077"))
        later += longer * step
    plan = [
        {**one, "seconds": one["seconds"] + more / rate} if one["do"] == "rest" else one
        for one in specified["campaign"]["plan"]
    ]
    (folder / "campaign.yaml").write_bytes(campaign_yaml({**specified["campaign"], "plan": plan}))
    return there + more * len(RESTS), written


def _pieces(
    short: Recording, log: str, truth: LogTruth, longer: int, later: int, step: int
) -> Iterator[Samples]:
    """A log, so many samples longer at its end, and so many ns later; `step`: ns between them."""
    stamps = short.records[log].stamps + later
    yield Samples(stamps, truth.accelerometer, truth.gyro)
    chance = np.random.default_rng([1, list(short.truth).index(log)])
    means, sigmas = _increments(short, truth)
    over = np.zeros(6)  # remainder that is not yet counted
    for first in range(0, longer, PIECE):
        size = min(PIECE, longer - first)
        felt = over + np.cumsum(chance.normal(means, sigmas, (size, 6)), axis=0)
        counted = np.rint(felt).astype(np.int64)
        over = felt[-1] - counted[-1]
        counts = np.diff(counted, axis=0, prepend=0)
        after = stamps[-1] + step * (first + 1 + np.arange(size))
        yield Samples(after, counts[:, :3], counts[:, 3:])


def _increments(short: Recording, truth: LogTruth) -> tuple[NDArray[np.float64], ...]:
    """Mean without noise and standard deviation of the increments in counts, (6,).

    Accelerometers, gyros. The mean of the readings would add their noise to hours as a bias.
    """
    receiver = short.receiver

    def counted(felt: Reading) -> NDArray[np.float64]:
        accelerometer = felt.accelerometer / receiver.accelerometer_count
        return np.diff(np.hstack([accelerometer, felt.gyro / receiver.gyro_count]), axis=0)

    return counted(truth.noiseless).mean(axis=0), counted(truth.noisy).std(axis=0)
