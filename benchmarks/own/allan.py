"""The overlapping Allan deviation of a record, piece by piece, and the terms of its noise.

python -m benchmarks.own.allan <record.npy> <samples per second> <runs> <factors.npy>
"""

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.lib.format import read_array_header_1_0, read_magic
from numpy.typing import NDArray

from benchmarks.answering import answer
from benchmarks.timing import timed
from inertial.estimation.allan import AllanSums
from inertial.estimation.multiresolution import Powers
from inertial.estimation.noise_model import STOCHASTIC
from inertial.estimation.noise_terms import noise_terms

PIECE = 1 << 16  # samples, as they come from a file


def main(path: str, rate: str, runs: str, factors: str) -> None:
    """Answer with the deviations, the terms with their sigmas, and the seconds of every run."""
    interval = 1 / float(rate)
    deviations, found = [], []

    def deviation() -> None:
        sums = AllanSums(1, np.load(factors))
        for piece in _pieces(path):
            sums.add(piece)
        sums.end()
        deviations.append(sums.result(interval))

    def terms() -> None:
        powers = Powers(1, interval)
        for piece in _pieces(path):
            powers.add(piece)
        powers.end()
        found.append(noise_terms(powers)[0])

    seconds, of_terms = timed(deviation, int(runs)), timed(terms, int(runs))
    fit, curve = found[-1], deviations[-1]
    assert fit is not None
    answer(
        factors=curve.factor.tolist(),
        deviations=curve.deviation[:, 0].tolist(),
        terms={
            name: (fit.terms[name].value, fit.terms[name].sigma, fit.terms[name].upper)
            for name in STOCHASTIC
        },
        seconds=seconds.runs,
        cpu=seconds.cpu,
        seconds_of_terms=of_terms.runs,
        cpu_of_terms=of_terms.cpu,
    )


def _pieces(path: str) -> Iterator[NDArray[np.float64]]:
    with Path(path).open("rb") as file:
        read_magic(file)
        read_array_header_1_0(file)
        while len(piece := np.fromfile(file, np.float64, PIECE)):
            yield piece[:, None]


main(*sys.argv[1:])
