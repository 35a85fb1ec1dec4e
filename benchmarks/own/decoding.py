"""The stage `decode` on one log: bytes to Parquet, checksums verified, every byte accounted for.

python -m benchmarks.own.decoding <folder of derived tables> <log> [one]

"one": on one processor, where the system can restrict a process to it.
"""

import gc
import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import pyarrow.parquet as pq

from benchmarks.answering import answer
from benchmarks.timing import timed
from stages.decode.stage import STAGE as DECODE

WARM_UP = 100_000  # byte of the log


def main(derived: str, log: str, processors: str = "all") -> None:
    """Answer with the number of records and the seconds that the stage took."""
    if processors == "one":
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    # Before the clock starts, compiled code is loaded, as it is for the peers.
    with TemporaryDirectory() as folder, Path(log).open("rb") as file:
        beginning = Path(folder, Path(log).name)
        beginning.write_bytes(file.read(WARM_UP))
        DECODE.run(Path(derived), {"raw": [beginning]}, {})
    gc.freeze()
    seconds = timed(lambda: DECODE.run(Path(derived), {"raw": [Path(log)]}, {}), 1)
    records = pq.read_metadata(Path(derived, "decode", "samples.parquet")).num_rows
    answer(records=records, seconds=seconds.runs, cpu=seconds.cpu)


main(*sys.argv[1:])
