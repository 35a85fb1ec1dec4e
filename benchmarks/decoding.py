"""A long log to Parquet, text and binary: speed and memory of several programs and of a copy.

The text log has 100 MB (10⁶ byte); BENCH_LOG_MB sets another size. The binary one has the same
records in half of that.
"""

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from ruamel.yaml import YAML

from benchmarks.campaign import RATE, document
from benchmarks.processes import Answer, in_own, in_peers
from benchmarks.tables import Table, digits
from benchmarks.timing import HEADS, REMARK, Seconds
from laboratory.rawimu import Samples, log_bytes

LINES = 100_000  # of the log, written at once
ROUNDS = 3
LONG = 10  # s; what takes longer has one round
START = 1_477_530_018_009_998_762  # ns of GPS time
UNIX = 2_000_000  # byte of the log with line ends LF: enough to show that it is not read
COPY = "copy in memory"
OURS = "this project, decode"


@dataclass(frozen=True)
class Reader:
    """A reader of logs, the size of what it reads, and its runs."""

    name: str
    size: int  # byte
    read: Callable[[], Answer]
    runs: list[Answer] = field(default_factory=list)

    @property
    def long(self) -> bool:
        """Whether it has run, and took long."""
        return bool(self.runs) and max(self.runs[0]["seconds"]) > LONG


def measured() -> Iterator[Table]:
    """Every reader in turn, round after round, each in a process of its own."""
    megabytes = int(os.environ.get("BENCH_LOG_MB", "100"))
    with TemporaryDirectory() as name:
        folder = Path(name)
        records = write_log(folder / "text.asc", "RAWIMUSA", megabytes * 10**6)
        write_log(folder / "binary.bin", "RAWIMUSXB", 0, records)
        text, binary = _of_text(folder), _of_binary(folder)
        for _ in range(ROUNDS):
            for reader in (*text, *binary):
                if not reader.long:
                    reader.runs.append(reader.read())
        yield _table(text, "RAWIMUSA text")
        yield _table(binary, "RAWIMUSX binary")


def _of_text(folder: Path) -> list[Reader]:
    log, unix, parquet = folder / "text.asc", folder / "unix.asc", folder / "p.parquet"
    with log.open("rb") as file:
        unix.write_bytes(file.read(UNIX).replace(b"\r\n", b"\n"))
    size = log.stat().st_size
    return [
        *_ours(folder, log),
        Reader("novatel-edie, to an array", size, lambda: in_peers("edie", log)),
        Reader("novatel-edie, line ends LF", UNIX, lambda: in_peers("edie", unix)),
        Reader("zlib line by line, pyarrow", size, lambda: in_peers("line_by_line", log, parquet)),
        Reader("pandas, no checksums", size, lambda: in_peers("by_pandas", log, parquet)),
        Reader(COPY, size, lambda: in_own("copying", log)),
    ]


def _of_binary(folder: Path) -> list[Reader]:
    log = folder / "binary.bin"
    size = log.stat().st_size
    return [
        *_ours(folder, log),
        Reader("novatel-edie, to an array", size, lambda: in_peers("edie", log)),
        Reader(COPY, size, lambda: in_own("copying", log)),
    ]


def _ours(folder: Path, log: Path) -> list[Reader]:
    campaign, derived, size = folder / f"{log.stem}.yaml", folder / log.stem, log.stat().st_size
    write_campaign(campaign, log.name)
    in_own("planning", campaign, log, derived)
    ours = [Reader(OURS, size, lambda: in_own("decoding", derived, log))]
    if hasattr(os, "sched_setaffinity"):  # Linux
        name = f"{OURS}, one processor"
        ours.append(Reader(name, size, lambda: in_own("decoding", derived, log, "one")))
    return ours


def _table(readers: list[Reader], of: str) -> Table:
    table = Table(
        f"Decoding {readers[0].size / 1e6:.0f} MB of {of}",
        (
            "reader",
            "records",
            *HEADS,
            "MB/s",
            "MB/s of a\nprocessor",
            "memory\nMB",
            "times\na copy",
        ),
    )
    seconds = {reader.name: Seconds.answered(reader.runs) for reader in readers}
    speeds = {reader.name: reader.size / seconds[reader.name].best for reader in readers}
    for reader in readers:
        table.add(
            reader.name,
            f"{reader.runs[0]['records']:,}" if reader.name != COPY else "",
            *seconds[reader.name].cells(),
            digits(speeds[reader.name] / 1e6),
            digits(reader.size / min(seconds[reader.name].cpu) / 1e6),
            f"{max(run['memory'] for run in reader.runs) / 1e6:,.0f}",
            digits(speeds[COPY] / speeds[reader.name]),
        )
    table.remarks.append(
        f"{REMARK} {ROUNDS} rounds, one where a run takes over {LONG} s, each reader in a process"
        " of its own; MB/s by the best. Memory: the whole process, Python and its packages among"
        " it. Ours also hashes the log, keeps line and byte of every record, and accounts for every"
        " byte."
    )
    if any(reader.size == UNIX for reader in readers):
        table.remarks.append(f"The log with line ends LF has {UNIX / 1e6:.0f} MB.")
    return table


def write_log(path: Path, message: str, size: int, records: int = 0) -> int:
    """A log of at least so many byte, or records, as a receiver writes it; returns its records."""
    chance = np.random.default_rng(1)
    step = round(1e9 / RATE)
    written = count = 0
    with path.open("wb") as file:
        while written < size or count < records:
            stamps = START + step * (count + np.arange(LINES))
            counts = chance.normal(0, 300, (2, LINES, 3)).astype(np.int64)
            written += file.write(log_bytes(Samples(stamps, *counts), message, "00000077"))
            count += LINES
    return count


def write_campaign(path: Path, log: str) -> None:
    """The file of a campaign that has this log alone."""
    own = document(0)["campaign"]
    rest = {"id": "x-up", "do": "rest", "up": "+x", "seconds": 100, "log": log}
    with path.open("w", encoding="utf-8") as file:
        YAML().dump({**own, "plan": [rest]}, file)
