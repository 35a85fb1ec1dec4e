"""allantools' overlapping Allan deviation of a record, and the white noise that it shows at 1 s.

python -m benchmarks.peers.allan <record.npy> <samples per second> <runs>
"""

import sys

import allantools
import numpy as np

from benchmarks.answering import answer
from benchmarks.timing import timed

TAUS = 50


def main(path, rate, runs):
    """Answer with the deviations and their averaging times, that at 1 s, and the seconds."""
    record, rate = np.load(path), float(rate)
    taus = np.geomspace(1 / rate, len(record) / rate / 10, TAUS)
    taus[np.argmin(np.abs(np.log(taus)))] = 1.0
    results = []

    def deviation():
        results.append(allantools.oadev(record, rate, data_type="freq", taus=taus)[:2])

    seconds = timed(deviation, int(runs))
    found, deviations = results[-1]
    at_one = float(deviations[np.argmin(np.abs(found - 1))])
    answer(
        white=at_one,
        taus=len(found),
        factors=np.rint(found * rate).astype(int).tolist(),
        deviations=deviations.tolist(),
        seconds=seconds.runs,
        cpu=seconds.cpu,
    )


main(*sys.argv[1:])
