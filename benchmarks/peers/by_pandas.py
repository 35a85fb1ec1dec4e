"""pandas on a log of RAWIMUSA lines as on any table of commas: no checksum is looked at.

python -m benchmarks.peers.by_pandas <log> <Parquet file>
"""

import sys

import pandas as pd
from pyarrow import parquet as pq

from benchmarks.answering import answer
from benchmarks.timing import timed

COLUMNS = ["message", "header week", "header seconds and week", "seconds", "status"]
COLUMNS += ["accel z", "accel y", "accel x", "gyro z", "gyro y", "gyro x and checksum"]


def convert(path, made):
    """The log as a Parquet file."""
    table = pd.read_csv(path, header=None, names=COLUMNS, dtype={"status": str})
    both = table.pop("header seconds and week").str.split(";", expand=True)
    table["week"] = both[1].astype(int)
    last = table.pop("gyro x and checksum").str.split("*", expand=True)
    table["gyro x"] = last[0].astype(int)
    table.drop(columns=["message", "header week"]).to_parquet(made, compression="lz4")


def main(path, made):
    """Answer with the number of records and the seconds."""
    seconds = timed(lambda: convert(path, made), 1)
    answer(records=pq.read_metadata(made).num_rows, seconds=seconds.runs, cpu=seconds.cpu)


main(*sys.argv[1:])
