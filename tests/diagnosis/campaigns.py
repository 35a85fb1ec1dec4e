"""A campaign of the simulated laboratory through the stages, in memory."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import chain
import pandas as pd

import laboratory

TABLES = ("causes", "members", "consequences", "verdict", "result")


def performed(document: Mapping[str, Any]) -> laboratory.Recording:
    """What the laboratory records."""
    return laboratory.perform(laboratory.specify(document))


def tables_of(document: Mapping[str, Any], until: str = "diagnosis") -> chain.Tables:
    """The tables of a campaign up to and with the stage `until`."""
    return chain.in_memory(performed(document), until, chain.BESIDE)


@contextmanager
def results_of(document: Mapping[str, Any]) -> Iterator[chain.Tables]:
    """The same, as long as they are looked at."""
    yield tables_of(document)


def diagnosed(document: Mapping[str, Any]) -> dict[str, pd.DataFrame]:
    """The tables of the stage diagnosis."""
    tables = tables_of(document)
    return {table: tables[f"diagnosis/{table}"] for table in TABLES}
