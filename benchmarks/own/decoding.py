"""The stage `decode` on one log: bytes to Parquet, checksums verified, every byte accounted for.

python -m benchmarks.own.decoding <logs.parquet of the plan> <log> <folder for the tables> [one]

"one": on one processor, where the system can be told so.
"""

import gc
import os
import shutil
import sys
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

from benchmarks.answering import answer
from benchmarks.timing import timed
from stages.decode.stage import STAGE as DECODE
from stages.formats.novatel_scan import scan


def main(logs: str, log: str, folder: str, processors: str = "all") -> None:
    """Answer with the number of records and the seconds that the stage took."""
    if processors == "one":
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    made, read = Path(folder), {"logs": Path(logs)}
    shutil.rmtree(made, ignore_errors=True)
    # Before the clock starts, what is compiled is loaded, as by the peers; and as for every stage
    # of the workflow, what is loaded is no garbage.
    scan(np.frombuffer(b"", np.uint8), 0, last=True)
    gc.freeze()
    seconds = timed(lambda: DECODE.run(read, {"raw": [Path(log)]}, made, {}), 1)
    records = pq.read_metadata(made / "samples.parquet").num_rows
    answer(records=records, seconds=seconds.runs, cpu=seconds.cpu)


main(*sys.argv[1:])
