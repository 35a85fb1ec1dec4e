"""The white noise of a record as the stage `noise` reads it, from pieces of its spectrum.

python -m benchmarks.own.spectrum <record.npy> <samples per second> <runs>
"""

import sys

import numpy as np

from benchmarks.answering import answer
from benchmarks.timing import timed
from inertial.estimation.spectrum import band_levels, white_level
from stages.noise.stage import MAX_SAMPLES

BAND = (0.5, 5.0)  # Hz, as in config.yaml


def main(path: str, rate: str, runs: str) -> None:
    """Answer with the level, its sigma, and the seconds of every run."""
    record = np.load(path)[:, None]

    def level() -> tuple[float, float]:
        parts = [
            record[start : start + MAX_SAMPLES] for start in range(0, len(record), MAX_SAMPLES)
        ]
        found = [band_levels(part, float(rate), BAND) for part in parts if len(part) == MAX_SAMPLES]
        white, sigma = white_level(np.concatenate(found))
        return float(white[0]), float(sigma[0])

    seconds = timed(level, int(runs))
    white, sigma = level()
    answer(white=white, sigma=sigma, seconds=seconds.runs, cpu=seconds.cpu)


main(*sys.argv[1:])
