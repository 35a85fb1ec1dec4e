"""A copy of the bytes of a file in memory: nothing that touches them all is faster.

python -m benchmarks.own.copying <file>
"""

import sys
from pathlib import Path

from benchmarks.answering import answer
from benchmarks.timing import timed

RUNS = 5


def main(path: str) -> None:
    """Answer with the seconds of every copy."""
    data = bytearray(Path(path).read_bytes())
    seconds = timed(lambda: bytes(data), RUNS)
    answer(records=0, seconds=seconds.runs, cpu=seconds.cpu)


main(*sys.argv[1:])
