"""The declared tables: documented, each input the output of an earlier stage."""

from importlib import import_module

import pytest

from commands.tables import PAGE, page
from inertial.tables.declared import Declared
from inertial.tables.table import Column
from stages import ORDER


def declared(stage: str) -> Declared:
    """What a stage declares."""
    found: Declared = import_module(f"stages.{stage}.declared").DECLARED
    return found


def test_the_page_of_tables_is_that_of_the_declarations() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), "run `make docs`"


@pytest.mark.parametrize("stage", ORDER)
def test_what_a_stage_reads_an_earlier_stage_writes(stage: str) -> None:
    earlier = ORDER[: ORDER.index(stage)]
    for argument, source in declared(stage).reads.items():
        assert source.stage in earlier, argument
        assert declared(source.stage).writes[source.file or source.table.name] is source.table


@pytest.mark.parametrize("stage", ORDER)
def test_every_column_says_what_it_is(stage: str) -> None:
    def check(column: Column, place: str) -> None:
        assert column.meaning, place
        assert column.type != "double" or column.unit, f"{place}: a number without a unit"
        for inner in () if isinstance(column.type, str) else column.type:
            assert inner.meaning, f"{place}.{inner.name}"

    for name, table in declared(stage).writes.items():
        names = [column.name for column in table.columns]
        assert len(names) == len(set(names)), name
        for column in table.columns:
            check(column, f"{stage}/{name}.{column.name}")
