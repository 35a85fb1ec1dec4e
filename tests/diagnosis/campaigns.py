"""A campaign of the simulated laboratory through the stages, without bytes on disk."""

import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import chain
import in_memory
import pandas as pd

import laboratory

SHARED_MEMORY = Path("/dev/shm")
BESIDE = ("studies", "comparison")  # nothing of the diagnosis rests on them in these campaigns
TABLES = ("causes", "members", "consequences", "verdict", "result")


def performed(document: Mapping[str, Any]) -> laboratory.Recording:
    """What the laboratory records."""
    return laboratory.perform(laboratory.specify(document))


@contextmanager
def results_of(document: Mapping[str, Any], until: str = "diagnosis") -> Iterator[chain.Results]:
    """The tables of a campaign, as long as they are looked at."""
    recording = performed(document)
    folder = Path(tempfile.mkdtemp(dir=SHARED_MEMORY if SHARED_MEMORY.is_dir() else None))
    try:
        with in_memory.recorded(recording, folder / "raw") as raw:
            yield chain.run(raw, folder / "derived", until, BESIDE)
    finally:
        shutil.rmtree(folder)


def diagnosed(document: Mapping[str, Any]) -> dict[str, pd.DataFrame]:
    """The tables of the stage diagnosis."""
    with results_of(document) as results:
        return {table: results[f"diagnosis/{table}"] for table in TABLES}
