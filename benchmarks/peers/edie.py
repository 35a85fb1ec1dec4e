"""novatel-edie, NovAtel's own reader: a log of RAWIMUSA lines to an array.

    python -m benchmarks.peers.edie <log>

`get_field_values` is the fastest way found to the numbers of a message in version 2.10.
"""

import sys

import numpy as np
from novatel_edie import oem

from benchmarks.answering import answer
from benchmarks.timing import timed


def main(path):
    """Answer with the number of records and the seconds."""
    values = []

    def read():
        rows = [
            message.get_field_values()
            for message in oem.FileParser(path)
            if type(message).__name__.startswith("RAWIMUS")
        ]
        values.append(np.array(rows, np.float64))

    seconds = timed(read, 1)
    answer(records=len(values[0]), seconds=seconds.runs, cpu=seconds.cpu)


main(*sys.argv[1:])
