"""One part of the page of costs, measured: processor time, memory, files."""

from collections.abc import Callable, Iterator
from dataclasses import asdict
from datetime import date, timedelta
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import chain
import pyarrow.parquet as pq

from benchmarks.dry_run import planned, planned_alone
from benchmarks.long_campaign import record
from benchmarks.processes import in_own
from inertial.tables.code import code_of, hash_of
from stages import ORDER

KILOHERTZ = 1000.0  # samples per second
KEPT = {  # what one campaign leaves, by its pattern in the folder
    "tables": "data/derived/*/**/*",
    "reports": "reports/**/*",
    "archive": "data/history/**/*",
    "Snakemake": ".snakemake/**/*",
}

Outcome = dict[str, Any]


@cache
def code() -> str:
    """A hash of the code that an outcome rests on, as it was at the start."""
    files = {file for stage in ORDER for file in code_of(stage)}
    mine = {Path(__file__), *(chain.ROOT / "benchmarks").rglob("[a-z]*.py")}
    snakefile = chain.ROOT / "Snakefile"
    return hash_of(sorted({*files, *mine, snakefile}))[:16]


def outcome(part: str, size: int) -> Outcome:
    """Measure a part at one size."""
    return {"part": part, "size": size, "code": code(), **PARTS[part](size)}


def _planned(campaigns: int) -> Outcome:
    """A dry run of so many campaigns, and that of a bare Snakefile."""
    own, bare = planned(campaigns)
    return {"own": asdict(own), "bare": asdict(bare)}


def _folder(campaigns: int) -> Outcome:
    """A dry run for one campaign in a folder of so many."""
    return asdict(planned_alone(campaigns))


def _small(campaigns: int) -> Outcome:
    """So many campaigns of two minutes on two processors."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        names = [f"c{number:03}" for number in range(campaigns)]
        for seed, campaign in enumerate(names):
            chain.simulate(chain.short(seed=seed), folder / "data/raw" / campaign)
        return _run(folder, names)


def _long(samples: int, rate: float = 200.0) -> Outcome:
    """A campaign of so many samples."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        record(folder / "data/raw/long", samples, rate)
        return _run(folder, ["long"])


def _kilohertz(samples: int) -> Outcome:
    return _long(samples, KILOHERTZ)


def _run(folder: Path, names: list[str]) -> Outcome:
    """The workflow on campaigns; what it took, and what it left."""
    logs_bytes = sum(size for _, size in _files(folder, "data/raw/*/*"))
    answer = in_own("running", folder, *names)
    samples = [
        pq.read_metadata(folder / f"data/derived/{name}/decode/samples.parquet").num_rows
        for name in names
    ]
    kept = {kind: [size for _, size in _files(folder, pattern)] for kind, pattern in KEPT.items()}
    return {
        **answer,
        "samples": sum(samples) / len(names),
        "logs": logs_bytes / len(names),
        "files": {kind: len(sizes) / len(names) for kind, sizes in kept.items()},
        "bytes": {kind: sum(sizes) / len(names) for kind, sizes in kept.items()},
    }


def _archive(earlier: int) -> Outcome:
    """The stage `history` with so many earlier calibrations of the IMU, each of one campaign."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        chain.run(chain.simulate(chain.short(), folder / "last"), folder / "derived", "history")
        (last,) = (folder / "history").rglob("*.parquet")
        row = pq.read_table(last)
        for number in range(earlier):
            day = date.fromisoformat(row["date"][0].as_py()) - timedelta(number + 1)
            other = row
            for name, value in {"campaign": f"c{number:05}", "date": day.isoformat()}.items():
                place = row.schema.get_field_index(name)
                other = other.set_column(place, row.schema.field(place), [[value]])
            pq.write_table(other, last.with_name(last.name.replace("last", f"c{number:05}")))
        stage = chain.stage_of("history")
        start = process_time()
        stage.run(folder / "derived", {"archive": [folder / "history"]}, chain.SETTINGS["history"])
        took = process_time() - start
        found = pq.read_table(folder / "derived/history/earlier.parquet")["campaign"].unique()
        return {"cpu": took, "found": len(found)}


def _files(folder: Path, pattern: str) -> Iterator[tuple[Path, int]]:
    for path in folder.glob(pattern):
        if path.is_file():
            yield path, path.stat().st_size


PARTS: dict[str, Callable[[int], Outcome]] = {
    "planned": _planned,
    "folder": _folder,
    "archive": _archive,
    "long": _long,
    "kilohertz": _kilohertz,
    "small": _small,
}
