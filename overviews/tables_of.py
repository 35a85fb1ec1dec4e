"""The tables of a campaign as the sections of its report get them, and what they are made from."""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from inertial.tables.code import hash_of_file
from inertial.tables.declared import read_declared
from inertial.tables.parquet import provenance
from inertial.text.messages import _
from inertial.text.numbers import shortened
from stages.report.declared import DECLARED
from stages.report.outline import Column, Part, Section, Table, table_row
from stages.report.tables import Tables

RESULT = ("campaign", "causes", "cause_members", "consequences", "verdict", "result")


def tables_of(derived: Path, names: Iterable[str]) -> Tables:
    """Some tables of the campaign whose folder is `derived`, by their names in the report.

    Raises
    ------
    Refusal
        where one is missing, damaged, or of another version
    """
    sources = {name: DECLARED.reads[name] for name in names}
    paths = {name: derived / source.place for name, source in sources.items()}
    frames = read_declared(derived, sources)
    return Tables(frames, {name: provenance(path) for name, path in paths.items()})


def files_of(derived: Path, names: Iterable[str]) -> list[Path]:
    """Where these tables lie."""
    return [derived / DECLARED.reads[name].place for name in names]


def made_from(files: Sequence[Path], code: str) -> Section:
    """The section that names what a page is made from."""

    def parts(_tables: Tables) -> Iterator[Part]:
        yield Table(
            _("Files."),
            (Column(_("File")), Column("SHA-256", "code")),
            [table_row(shortened(str(file), 200), hash_of_file(file)) for file in files],
            note=_("SHA-256 of the code of this page: {code}.", code=code),
        )

    return Section(
        "provenance",
        _("Provenance"),
        _("The tables and files of the archive that this page was made from."),
        "",
        (),
        parts,
    )
