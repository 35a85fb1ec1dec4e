"""A long text log to Parquet: speed and memory beside others, and beside a copy of the same bytes.

The log has 100 MB (10⁶ byte); BENCH_LOG_MB sets another size.
"""

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from ruamel.yaml import YAML

from benchmarks.campaign import RATE, document
from benchmarks.processes import Answer, in_own, in_peers
from benchmarks.tables import Table, told
from benchmarks.timing import HEADS, REMARK, Seconds
from laboratory.rawimu import Samples, log_bytes

LINES = 100_000  # of the log that are written at a time
LONG = 300  # MB above which one round is enough
START = 1_477_530_018_009_998_762  # ns of GPS time
UNIX = 2_000_000  # byte of the log with line ends LF: enough to see that nothing is found in it
COPY = "copy in memory"


@dataclass(frozen=True)
class Reader:
    """A reader of logs, the size of what it reads, and its runs."""

    name: str
    size: int  # byte
    read: Callable[[], Answer]
    runs: list[Answer] = field(default_factory=list)


def measured() -> list[Table]:
    """Every reader in turn, round after round, each in a process of its own."""
    megabytes = int(os.environ.get("BENCH_LOG_MB", "100"))
    rounds = 1 if megabytes > LONG else 3
    with TemporaryDirectory() as name:
        folder = Path(name)
        log, campaign, parquet = folder / "long.asc", folder / "campaign.yaml", folder / "p.parquet"
        size = write_log(log, megabytes * 10**6)
        write_campaign(campaign, log.name)
        unix = folder / "unix.asc"
        with log.open("rb") as file:
            unix.write_bytes(file.read(UNIX).replace(b"\r\n", b"\n"))
        tables = folder / "tables"
        readers = [
            Reader("this project, decode", size, lambda: in_own("decoding", campaign, log, tables)),
            Reader("novatel-edie, to an array", size, lambda: in_peers("edie", log)),
            Reader("novatel-edie, line ends LF", UNIX, lambda: in_peers("edie", unix)),
            Reader(
                "zlib line by line, pyarrow",
                size,
                lambda: in_peers("line_by_line", log, parquet),
            ),
            Reader("pandas, no checksums", size, lambda: in_peers("by_pandas", log, parquet)),
            Reader(COPY, size, lambda: in_own("copying", log)),
        ]
        for _ in range(rounds):
            for reader in readers:
                reader.runs.append(reader.read())
    return [_table(readers, rounds)]


def _table(readers: list[Reader], rounds: int) -> Table:
    table = Table(
        f"Decoding {readers[0].size / 1e6:.0f} MB of RAWIMUSA text",
        ("reader", "records", *HEADS, "MB/s", "memory\nMB", "times\na copy"),
    )
    speeds = {reader.name: reader.size / Seconds.answered(reader.runs).best for reader in readers}
    for reader in readers:
        table.add(
            reader.name,
            f"{reader.runs[0]['records']:,}" if reader.name != COPY else "",
            *Seconds.answered(reader.runs).cells(),
            told(speeds[reader.name] / 1e6),
            f"{max(run['memory'] for run in reader.runs) / 1e6:,.0f}",
            told(speeds[COPY] / speeds[reader.name]),
        )
    table.remarks.append(
        f"{REMARK} {rounds} rounds, each reader in a process of its own; MB/s by the best. Memory:"
        " the whole process, Python and its packages among it. Ours also hashes the log, keeps line"
        " and byte of every record, and accounts for every byte. The log with line ends LF has"
        f" {UNIX / 1e6:.0f} MB."
    )
    return table


def write_log(path: Path, size: int) -> int:
    """A log of at least `size` byte as a receiver writes it; returns its size."""
    chance = np.random.default_rng(1)
    step = round(1e9 / RATE)
    written, first = 0, START
    with path.open("wb") as file:
        while written < size:
            stamps = first + step * np.arange(LINES)
            first += step * LINES
            counts = chance.normal(0, 300, (2, LINES, 3)).astype(np.int64)
            written += file.write(log_bytes(Samples(stamps, *counts), "RAWIMUSA", "00000077"))
    return written


def write_campaign(path: Path, log: str) -> None:
    """The file of a campaign that has this log alone."""
    own = document(0)["campaign"]
    rest = {"id": "x-up", "do": "rest", "up": "+x", "seconds": 100, "log": log}
    with path.open("w", encoding="utf-8") as file:
        YAML().dump({**own, "plan": [rest]}, file)
