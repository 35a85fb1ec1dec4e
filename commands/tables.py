"""docs/tables.md, from the declarations: every table, every column with unit, frame and meaning.

python -m commands.tables        writes the page; a test compares it with the declarations
"""

from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

from inertial.tables.declared import Declared
from inertial.tables.fleet import FLEET
from inertial.tables.table import Column, Table
from stages import ORDER

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "docs/tables.md"
HEAD = """# Tables

Written by `make docs` from the declarations in `inertial/tables/` and `stages/*/declared.py`. Each
table is a Parquet file, `data/derived/<campaign>/<stage>/<table>.parquet`; unit, frame and meaning
of each column are in its metadata too. A column may be null only where it says so. Null means: not
known, not tested, or not applicable.
"""


def page() -> str:
    """The whole page."""
    return "\n".join([HEAD, *_stages(), *_fleet()])


def _stages() -> Iterator[str]:
    for stage in ORDER:
        declared: Declared = import_module(f"stages.{stage}.declared").DECLARED
        if not declared.writes:
            continue
        yield f"## {stage}\n"
        yield f"Reads {_reads(declared)}.\n" if declared.reads else "Reads no table.\n"
        for name, table in declared.writes.items():
            yield from _table(name, table)


def _fleet() -> Iterator[str]:
    yield "## fleet\n"
    yield "What several campaigns show together, `data/derived/.fleets/<name>/<table>.parquet`.\n"
    for name, table in FLEET.items():
        yield from _table(name, table)


def _reads(declared: Declared) -> str:
    return ", ".join(
        f"`{source.place.removesuffix('.parquet')}`" for source in declared.reads.values()
    )


def _table(name: str, table: Table) -> Iterator[str]:
    contract = "" if name == table.name else f", columns of `{table.name}`"
    yield f"### {name} (version {table.version}{contract})\n"
    yield "| column | type | unit | frame | null | meaning |"
    yield "|---|---|---|---|---|---|"
    for column in table.columns:
        yield from _rows(column, column.name)
    yield ""


def _rows(column: Column, name: str) -> Iterator[str]:
    kind = column.type if isinstance(column.type, str) else "rows"
    null = "yes" if column.nullable else ""
    meaning = column.meaning.replace("|", "\\|")
    yield f"| {name} | {kind} | {column.unit} | {column.frame} | {null} | {meaning} |"
    if not isinstance(column.type, str):
        for inner in column.type:
            yield from _rows(inner, f"{name}.{inner.name}")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
