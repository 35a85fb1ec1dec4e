"""What one would write with zlib and pyarrow: each line's checksum, then all fields at once.

python -m benchmarks.peers.line_by_line <log> <Parquet file>
"""

import sys
import zlib
from pathlib import Path

import pyarrow as pa
from pyarrow import csv
from pyarrow import parquet as pq

from benchmarks.answering import answer
from benchmarks.timing import timed

ONES = 0xFFFFFFFF
COLUMNS = ["message", "header week", "header seconds", "week", "seconds", "status"]
COLUMNS += ["accel z", "accel y", "accel x", "gyro z", "gyro y", "gyro x", "checksum"]
TYPES = {"status": pa.string(), "checksum": pa.string()}


def right_lines(path):
    """The lines with the right checksum."""
    with Path(path).open("rb") as log:
        for line in log:
            text, _, stated = line.strip().partition(b"*")
            if zlib.crc32(text[1:], ONES) ^ ONES == int(stated, 16):
                yield line


def convert(path, made):
    """The log as a Parquet file."""
    text = b"".join(right_lines(path)).translate(bytes.maketrans(b";*", b",,"))
    table = csv.read_csv(
        pa.BufferReader(text),
        csv.ReadOptions(column_names=COLUMNS),
        convert_options=csv.ConvertOptions(column_types=TYPES, include_columns=COLUMNS[3:-1]),
    )
    pq.write_table(table, made, compression="lz4")


def main(path, made):
    """Answer with the number of records and the seconds."""
    seconds = timed(lambda: convert(path, made), 1)
    answer(records=pq.read_metadata(made).num_rows, seconds=seconds.runs, cpu=seconds.cpu)


main(*sys.argv[1:])
